# SPDX-License-Identifier: GPL-3.0-or-later
"""Command line of `krater study` and `krater run --accuracy`. Exit codes are krater's: 0 done, 2 bad input, 3 nothing
to answer with, 4 stopped before its end (the same command goes on), 5 an accuracy that was not reached."""

import argparse
import dataclasses
import fcntl
import hashlib
import os
import signal
import sys

import accuracy
import results
from answer import missing_sentences
from ballistic_limit import BallisticLimit
from calibrate import Calibrate
from members import Engine, text_of, write_json
from refinement import Convergence
from settings import Ablation, Pareto, Sweep
from study_file import InputError, Study, flow, load, seconds

KINDS = {"convergence": Convergence, "pareto": Pareto, "ablation": Ablation, "sweep": Sweep,
         "ballistic_limit": BallisticLimit, "calibrate": Calibrate}
# What makes the members; the rest of a study file only asks of them, and may change.
MAKES = ("set", "truth", "vary", "repeats", "effects", "design", "seed", "outcome", "speed", "cells")
DONE, BAD_INPUT, NOTHING, STOPPED, WARNED = 0, 2, 3, 4, 5


def say(line):
    print(line, file=sys.stderr, flush=True)


def options(words):
    parser = argparse.ArgumentParser(
        prog="krater study", description="Many runs of one scene: convergence, pareto, ablation, sweep, "
        "ballistic_limit, "
        "calibrate (inputs/studies/ has an example of each). A study goes on from what lies in its folder.")
    parser.add_argument("file", help="study file (YAML), or template of a report of several (Markdown, .md)")
    parser.add_argument("-j", type=int, default=os.cpu_count(), metavar="N", help="cores (default: all)")
    parser.add_argument("-o", "--output", metavar="DIR", help="folder (default: FILE_study; of a report FILE_report)")
    parser.add_argument("--budget", metavar="TIME", help="wall time, as 20min; what does not fit is left for another "
                        "time")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE",
                        help="override a value of every member")
    parser.add_argument("--list", action="store_true", help="print one shell command per member that is not done, and "
                        "stop")
    parser.add_argument("--collect", action="store_true", help="run nothing: answer with what is done")
    return parser.parse_args(words)


def digest(path):
    with open(path, "rb") as file:
        return f"{os.path.basename(path)} {hashlib.sha256(file.read()).hexdigest()}"


def words_of(tree):
    if isinstance(tree, dict):
        tree = tree.values()
    elif isinstance(tree, str):
        return [tree]
    return [word for item in tree for word in words_of(item)]


def files_of(scene):
    """Files beside a scene that it names: meshes and surfaces. A scene that cannot be read is left to krater."""
    try:
        words = words_of(load(scene))
    except InputError:
        return []
    paths = [os.path.join(os.path.dirname(scene), word) for word in dict.fromkeys(words) if "." in word]
    return [path for path in paths if os.path.isfile(path)]


def makes(study):
    """Digests of what makes the members."""
    return {"study": study.kind, "scene": digest(study.scene),
            **{f"file {os.path.basename(path)}": digest(path) for path in files_of(study.scene)},
            **{key: flow(study.keys[key]) for key in MAKES if key in study.keys},
            **{f"--set {path}": value for path, value in study.said.items()}}


def require_same(study, folder):
    """Members of another study, or of this one before it was edited, must not be taken for its own."""
    os.makedirs(os.path.join(folder, "members"), exist_ok=True)
    before, now = results.stamp(folder), makes(study)
    changed = [key for key in dict.fromkeys([*before, *now]) if before.get(key) != now.get(key)]
    if before and changed and any(os.scandir(os.path.join(folder, "members"))):
        key = changed[0]
        study.fail(key, f"changed since the members in {folder} were made ({', '.join(changed)}): their results would "
                   f"be told of other runs; choose another folder with -o, or remove {folder}")
    write_json(os.path.join(folder, "study.lock.json"), now)


def lock(folder):
    """One study at a time in a folder; held until the process ends."""
    os.makedirs(folder, exist_ok=True)
    handle = open(os.path.join(folder, ".running"), "w", encoding="utf-8")  # noqa: SIM115
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise InputError(f"{folder}: another study writes there; wait for it, or choose another folder with "
                         "-o") from None
    return handle


def locate(study, error):
    """An error that krater found in an override, told at the line of the study file that made it."""
    message = str(error)
    if "repeats" in study.keys and "must lie on a node line" in message:
        return InputError(f"{study.path}:{study.line('repeats')}: repeats: this scene has conditions at both sides of "
                          f"an axis, so "
                          f"its cell cannot be a little smaller or larger; leave repeats out\n  {message}")
    if message.startswith("--set "):
        path = message[6:].split("=", 1)[0]
        for key in ("vary", "set", "truth"):
            for name in study.block(key):
                if name == path or path == f"references.{name}":
                    return InputError(f"{study.path}:{study.line(f'{key}/{name}')}: {key}.{name}: {message}")
        named = [("effects", study.block("effects"))] + [("vary", study.block("vary"))] * (study.keys.get("design") == "cases")
        for key, block in named:
            for name, changes in block.items():
                if path in changes:
                    return InputError(f"{study.path}:{study.line(f'{key}/{name}/{path}')}: {key}.{name}: {message}")
        if "speed" in study.keys:
            return InputError(f"{study.path}:{study.line('speed/path')}: speed.path: {message}")
    return error


def gather(question, engine, run):
    """(rows, whether more would be run): what lies on disk and, with `run`, what is run now."""
    rows = []
    while new := question.next(rows):
        if run:
            engine.check(new)
            if not rows:
                foretell_all(question, engine)
            if not rows or engine.estimate(new)[0] > 1:
                foretell(engine, new)
            found = engine.run(new)
        else:
            found = {one.name: engine.row(one) for one in new}
        rows += [found[one.name] for one in new]
        if any(row.status in ("left", "interrupted") for row in rows):
            return rows, True
    return rows, False


def foretell_all(question, engine):
    """What all of it will take, of a kind that asks for members one after the other and can know how many. The dearest
    is checked now: a cell that a scene cannot have is an error before the first run, not after hours."""
    expected = question.expected() if hasattr(question, "expected") else []
    engine.check([one for one, _ in expected])
    if sum(count for _, count in expected) > 2:
        core = sum(count * engine.seconds(one) for one, count in expected)
        say(f"krater study: about {sum(count for _, count in expected)} runs in all, at most {text_of(core)} of core time by "
            "the forecast of krater check: less where time.stop_when ends them")


def foretell(engine, members):
    """The estimate, before anything is run; a budget that is below one run is refused."""
    count, core, memory = engine.estimate(members)
    if not count:
        return
    cheapest = min(engine.seconds(one) for one in members if engine.row(one).status not in ("done", "failed"))
    if engine.budget and not engine.measured and cheapest / engine.jobs > engine.budget:
        raise InputError(f"budget: {text_of(engine.budget)} is below one run: the cheapest member takes about "
                         f"{text_of(cheapest)}; "
                         "give more, or coarser cells")
    say(f"krater study: {count} of {len(members)} members to run, about {text_of(core)} of core time "
        f"({text_of(core / engine.jobs)} on {engine.jobs} cores), at most {memory / 1e6:.0f} MB each"
        f"{', by what was measured' if engine.measured else ', by the forecast of krater check'}")


@dataclasses.dataclass
class Asked:
    """A study with what it has found so far."""
    study: Study
    question: object
    engine: Engine
    folder: str
    rows: list = dataclasses.field(default_factory=list)
    more: bool = False  # would be run


def ask(study, question, folder, jobs, budget, run=True):
    """Runs what the question wants (`run`), or reads what is done. A budget of 0 s, that others have used up, leaves all;
    one below one run is an error."""
    held = lock(folder)
    require_same(study, folder)
    engine = question.engine = Engine(study.scene, folder, study.fixed(), jobs, study.threads, budget, say)
    asked = Asked(study, question, engine, folder)
    try:
        asked.rows, asked.more = gather(question, engine, run and budget != 0)
    except InputError as error:
        raise locate(study, error) from None
    held.close()
    return asked


def budget_of(given, otherwise=None):
    """Of --budget, else of the file."""
    if given.budget is None:
        return otherwise
    budget = seconds(given.budget)
    if budget is None or budget <= 0:
        raise InputError(f"--budget {given.budget}: a time above 0 is expected, as 20min")
    return budget


def run_study(words):
    given = options(words)
    if given.j < 1:
        raise InputError("-j: at least one core is needed")
    if given.file.endswith(".md"):
        import report  # here, not above: it asks studies by this module
        return report.run(given)
    study = Study(given.file, given.set)
    budget = budget_of(given, study.budget)
    folder = given.output or os.path.splitext(os.path.basename(given.file))[0] + "_study"
    try:
        asked = ask(study, KINDS[study.kind](study), folder, given.j, budget, not (given.list or given.collect))
        return print_list(asked) if given.list else tell(asked)
    except KeyboardInterrupt:
        say(f"krater study: interrupted; what is done lies in {folder}; the same command goes on")
        return STOPPED


def run_accuracy(words):
    study, question, folder, jobs, budget = accuracy.prepare(words)
    try:
        asked = ask(study, question, folder, jobs, budget)
    except KeyboardInterrupt:
        say(f"krater run: interrupted; what is done lies in {folder}; the same command goes on")
        return STOPPED
    code = tell(asked)
    if not any(row.done for row in asked.rows):
        return code
    answer = question.answer(asked.rows)
    accuracy.publish(folder, asked.rows, answer)
    return DONE if answer.data["met"] else WARNED


def print_list(asked):
    """One line per member for GNU parallel, a SLURM array or any queue."""
    waiting = [row.member for row in asked.rows if not row.done and row.status != "failed"]
    try:
        asked.engine.check(waiting)
    except InputError as error:
        raise locate(asked.study, error) from None
    for one in waiting:
        print(asked.engine.shell_line(one))
    return DONE


def conclude(asked):
    """(answer, page) of members that are done, written into the folder; (None, None) where none is."""
    study, done = asked.study, [row for row in asked.rows if row.done]
    if not done:
        for row in asked.rows:
            say(f"krater study: {row.member.name} {row.status}: {row.reason or 'not run'}")
        say(f"krater study: no member is done, so there is nothing to answer with; logs lie in "
            f"{asked.folder}/members")
        return None, None
    for name in list(study.measures):
        if all(row.measure(name) is None for row in done):
            if study.kind == "accuracy" and len(study.measures) > 1:
                study.measures.remove(name)
                say(f"krater run: {name} has no value in any run; it is left out")
                continue
            study.fail("measures", f"'{name}' has no value in any of the {len(done)} members that are done (the body "
                       f"is gone, or the outcome is open); leave it out, or change `time.end`")
    answer = asked.question.answer(asked.rows)
    answer.sentences += missing_sentences(asked.rows, study.measures)
    return answer, results.write(asked.folder, study, asked.rows, answer)


def tell(asked):
    answer, page = conclude(asked)
    if answer is None:
        return STOPPED if asked.more else NOTHING
    for line in answer.sentences:
        print(line)
    for table in answer.tables:
        print(f"\n{table.caption}")
        for line in aligned([table.titles, *table.rows]):
            print("  " + line)
    tell_left(asked.rows)
    say(f"krater study: {page}")
    return STOPPED if asked.more else DONE


def tell_left(rows):
    left = [row for row in rows if row.status in ("left", "interrupted")]
    if left:
        say(f"krater study: {len(left)} members are left ({', '.join(row.member.name for row in left[:5])}"
            f"{', ...' if len(left) > 5 else ''}); the same command goes on")


def aligned(rows):
    widths = [max(len(str(row[k])) for row in rows) for k in range(len(rows[0]))]
    return ["  ".join(str(cell).ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]


def on_terminate(*_):
    raise KeyboardInterrupt


def main(words):
    """`words`: study FILE ... or accuracy SCENE SHARE ...; returns an exit code."""
    signal.signal(signal.SIGTERM, on_terminate)
    signal.signal(signal.SIGHUP, on_terminate)
    try:
        return {"study": run_study, "accuracy": run_accuracy}[words[0]](words[1:])
    except InputError as error:
        say(str(error))
        return BAD_INPUT
    except OSError as error:
        say(f"krater study: {error}")
        return BAD_INPUT
