# SPDX-License-Identifier: GPL-3.0-or-later
"""krater study REPORT.md: a page of several studies, made of a template (template.py). Runs what its studies still lack,
then writes README.md and pictures into the folder.

Members lie in FOLDER/runs_out, in a folder of their own for every program, study file and scene: a page never mixes
versions, and an old one is not told of a new scene."""

import datetime
import fnmatch
import hashlib
import os
import shlex
import shutil
import subprocess
import sys
import time

import columns
import command
import results
from answer import failed_sentences
from members import KRATER, LEAST, text_of
from study_file import InputError, Study, flow
from template import Template

STANDARD = ("final_shape", "shapes", "energy", "dt", "measures")  # pictures that tools/plot_run draws unasked


class Members:
    """What a study has found: rows, where their results lie, its answer."""

    def __init__(self, name, asked, answer):
        self.name, self.rows, self.folder, self.answer = name, asked.rows, asked.folder, answer


def digest(*paths):
    total = hashlib.sha256()
    for path in paths:
        with open(path, "rb") as file:
            total.update(file.read())
    return total.hexdigest()[:16]


class Report:
    def __init__(self, template, folder):
        self.template, self.folder, self.studies, self.lines = template, folder, {}, []
        self.pictures = 0

    # ---- studies

    def study(self, name, settings):
        path = self.template.file_of(name)
        study = Study(path, [*self.template.settings, *settings])
        place = os.path.join(self.folder, "runs_out", f"{name}_{digest(KRATER, path, study.scene)}")
        return study, command.KINDS[study.kind](study), place

    def ask(self, name, given, budget):
        study, question, place = self.study(name, given.set)
        command.say(f"krater study: {name}")
        asked = command.ask(study, question, place, given.j, budget, not (given.list or given.collect))
        if given.list:
            command.print_list(asked)
            return asked.more
        answer, _ = command.conclude(asked)
        command.tell_left(asked.rows)
        self.studies[name] = Members(name, asked, answer)
        return asked.more

    # ---- members of a block

    def rows(self, piece):
        """[(study, row)] of a block, of its `members` where it names any."""
        every = [(self.studies[name], row) for name in piece.studies for row in self.studies[name].rows]
        patterns = piece.items("members")
        if not patterns:
            return every
        for pattern in patterns:
            if not any(matches(study, row, pattern) for study, row in every):
                piece.fail("members", f"no member is called {flow(pattern)} (there are: "
                           f"{', '.join(row.member.name for _, row in every)}; * stands for anything)")
        return [(study, row) for study, row in every if any(matches(study, row, one) for one in patterns)]

    def place(self, study, row):
        return os.path.join(study.folder, "members", row.member.name)

    def folders(self, piece):
        """{label: folder} of the members that are done."""
        pairs = [(study, row) for study, row in self.rows(piece) if row.done]
        labels = labels_of([row for _, row in pairs])
        if len(piece.studies) > 1:
            labels = [f"{study.name}, {label}" for label, (study, _) in zip(labels, pairs)]
        return {label: self.place(study, row) for label, (study, row) in zip(labels, pairs)}

    def folder_of(self, row):
        return next(self.place(study, row) for study in self.studies.values() if any(row is one for one in study.rows))

    # ---- blocks

    def table(self, piece):
        chosen = [row for _, row in self.rows(piece)]
        every = [row for name in piece.studies for row in self.studies[name].rows]
        titles, lines = [], [[] for _ in chosen]
        for name in piece.items("columns"):
            found, cells = self.mended(piece, "columns", columns.column, name, every, self.folder_of,
                                       piece.keys.get("off") in ("yes", "true"))
            titles += found
            for line, row in zip(lines, chosen):
                line += cells[next(k for k, one in enumerate(every) if one is row)]
        self.lines += ["| " + " | ".join(titles) + " |", "| " + " | ".join(["---"] + ["---:"] * (len(titles) - 1)) + " |"]
        self.lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines]
        self.lines.append("")
        self.paragraphs(f"**{line}**" for line in failed_sentences(chosen))

    @staticmethod
    def mended(piece, key, call, *words):
        """An error of a column told at its block."""
        try:
            return call(*words)
        except InputError as error:
            return piece.fail(key, str(error))

    def answer(self, piece):
        """Sentences, tables and pictures of the study itself."""
        leave_out = piece.items("leave_out")
        for name in piece.studies:
            answer = self.studies[name].answer
            if answer is None:
                self.paragraphs([f"**{name}: no member is done.**"])
                continue
            said = failed_sentences(self.studies[name].rows) if "sentences" in leave_out else answer.sentences
            self.lines += [*(f"- {line}" for line in said), ""]
            for table in answer.tables if "tables" not in leave_out else ():
                self.paragraphs([table.caption + ":"])
                self.lines += ["| " + " | ".join(map(str, line)) + " |"
                               for line in (table.titles, ["---"] * len(table.titles), *table.rows)]
                self.lines.append("")
            for picture in answer.pictures if "pictures" not in leave_out else ():
                source = os.path.join(self.studies[name].folder, "pictures", picture.name + ".png")
                target = f"{name}_{picture.name}.png"
                shutil.copyfile(source, os.path.join(self.folder, target))
                self.paragraphs([f"![{picture.caption}]({target})", picture.caption])

    def demand(self, piece):
        """What was asked for beside the worst of what was found."""
        every = [row for name in piece.studies for row in self.studies[name].rows]
        expression = self.mended(piece, "value", columns.Expression, str(piece.keys["value"]), every, self.folder_of)
        found = [self.mended(piece, "value", expression.of, row) for _, row in self.rows(piece)]
        number, unit = self.number(piece, "below"), str(piece.keys.get("unit", ""))
        known = [value for value in found if value is not None]
        told = f"{max(known):.3g} {unit}".strip() + f", **{'met' if max(known) < number else 'missed'}**" if known \
            else "**not known**"
        self.paragraphs([f"Demanded: {piece.keys['says']}. Found: {told}."])

    def sections(self, piece):
        import run_pictures
        from plot_run_shapes import Colouring
        span = piece.items("range") or None

        def scale(run):
            return Colouring(run, run.numbers, str(piece.keys["field"]) if "field" in piece.keys else None, span)
        self.draw(piece, run_pictures.sections, [self.time(piece, "times", text) for text in piece.items("times")], scale,
                  self.box(piece, "box", piece.items("box")))

    def outlines(self, piece):
        import run_pictures
        boxes = [self.box(piece, "boxes", box) for box in piece.items("boxes")]
        self.draw(piece, run_pictures.outlines, self.time(piece, "time", piece.keys["time"]), [None, *boxes])

    def histories(self, piece):
        import run_pictures
        names = piece.items("measures")
        units = {row.unit(name) for _, row in self.rows(piece) for name in names if row.done}
        if len(units - {""}) > 1:
            piece.fail("measures", f"one picture shows one unit, these have {', '.join(sorted(units))}")
        unit = next(iter(units - {""}), "")
        largest = max((abs(row.measure(name) or 0) for _, row in self.rows(piece) for name in names), default=0)
        scale, shown = columns.scale_of(largest, unit)
        lines = [(self.number(piece, "lines", value), words) for line in piece.items("lines")
                 for words, value in line.items()]
        words = dict(zip(names, [""] if len(names) == 1 else (name.replace("_", " ") for name in names)))
        title = names[0].replace("_", " ") if len(names) == 1 else ""
        self.draw(piece, run_pictures.histories, words, f"{title} [{shown}]".strip(), 1 / scale, lines)

    def picture(self, piece):
        """`tools/plot_run` of a member: one of its standard pictures by name, or what its options ask for."""
        words = shlex.split(str(piece.keys.get("plot", STANDARD[0])))
        for name, folder in self.folders(piece).items():
            target = self.target(piece)
            path = os.path.join(self.folder, target)
            standard = len(words) == 1 and words[0] in STANDARD
            done = subprocess.run([sys.executable, os.path.join(columns.TOOLS, "plot_run"), folder,
                                   *(() if standard else (*words, "-o", path))], capture_output=True, text=True, check=False)
            if done.returncode:
                piece.fail("plot", done.stderr.strip())
            if standard:
                shutil.copyfile(os.path.join(folder, "pictures", words[0] + ".png"), path)
            self.paragraphs([f"![{name}]({target})"])

    def draw(self, piece, picture, *words):
        rows = self.folders(piece)
        if rows:
            target = self.target(piece)
            title = str(piece.keys.get("title", ""))
            picture(rows, *words, title=title).savefig(os.path.join(self.folder, target), dpi=110)
            self.paragraphs([f"![{title or piece.kind}]({target})"])

    # ---- values of a template

    def target(self, piece):
        self.pictures += 1
        return f"{piece.studies[0]}_{piece.kind}_{self.pictures}.png"

    @staticmethod
    def number(piece, key, text=None):
        try:
            return float(piece.keys[key] if text is None else text)
        except (TypeError, ValueError):
            return piece.fail(key, f"a number is expected, found {flow(text or piece.keys[key])}")

    @staticmethod
    def time(piece, key, text):
        try:
            return columns.quantity(text, "s")
        except ValueError as error:
            return piece.fail(key, str(error))

    @staticmethod
    def box(piece, key, texts):
        """[x, x, z, z] in mm, or None."""
        if not texts:
            return None
        try:
            box = [1e3 * columns.quantity(text, "m") for text in texts]
        except ValueError as error:
            piece.fail(key, str(error))
        if len(box) != 4 or not (box[0] < box[1] and box[2] < box[3]):
            piece.fail(key, "a box is [least x, largest x, least z, largest z]")
        return box

    # ---- the page

    def paragraphs(self, texts):
        for text in texts:
            self.lines += [text, ""]

    def write(self):
        for piece in self.template.pieces:
            if piece.kind:
                getattr(self, piece.kind)(piece)
            else:
                self.lines += [piece.text.strip("\n"), ""]
        text = "\n".join(line for line in self.lines).strip("\n")
        title, _, rest = text.partition("\n")
        made = (f"{datetime.date.today()}, {results.version()}, {os.cpu_count()} cores of "
                f"{results.machine()['processor']}, load average {os.getloadavg()[2]:.0f} "
                f"(core-seconds are user and system time). Made by `krater study "
                f"{os.path.basename(self.template.path)}`; do not edit.")
        path = os.path.join(self.folder, "README.md")
        with open(path + ".part", "w", encoding="utf-8") as file:
            file.write(squeezed(f"{title}\n\n{made}\n{rest}\n"))
        os.replace(path + ".part", path)
        return path


def matches(study, row, pattern):
    return any(fnmatch.fnmatchcase(name, str(pattern)) for name in (row.member.name, f"{study.name}/{row.member.name}"))


def labels_of(rows):
    """What a picture calls members: the values that tell them apart."""
    paths = list(dict.fromkeys(path for row in rows for path in row.member.values))
    apart = [path for path in paths if len({row.member.values.get(path) for row in rows}) > 1]
    return [", ".join(row.member.values[path] for path in apart or paths if path in row.member.values) or
            row.member.name for row in rows]


def squeezed(text):
    """One empty line, where blocks leave several."""
    while "\n\n\n" in text:
        text = text.replace("\n\n\n", "\n\n")
    return text


def remaining(budget, start, more):
    """Of a budget [s]; less than a look at the next study takes is none, and none goes on where one study had too little."""
    left = budget - (time.monotonic() - start)
    return 0 if more or left < LEAST else left


def run(given):
    """Exit code of `krater study REPORT.md`."""
    template = Template(given.file)
    budget = command.budget_of(given)
    begin = start = time.monotonic()
    folder = given.output or os.path.splitext(os.path.basename(given.file))[0] + "_report"
    report = Report(template, folder)
    for name in template.studies:  # errors of input now, not after hours
        report.study(name, given.set)
    if template.takes and not (given.list or given.collect):
        command.say(f"krater study: about {text_of(template.takes)} on two quiet cores, as its author says")
    more = False
    try:
        for name in template.studies:
            more = report.ask(name, given, budget) or more
            budget = budget and remaining(budget, start, more)
            start = time.monotonic()
    except KeyboardInterrupt:
        command.say(f"krater study: interrupted; what is done lies in {folder}/runs_out; the same command goes on")
        return command.STOPPED
    if given.list:
        return command.DONE
    command.say(f"krater study: {report.write()} ({text_of(time.monotonic() - begin)})")
    if any(study.answer is None for study in report.studies.values()):
        return command.STOPPED if more else command.NOTHING
    return command.STOPPED if more else command.DONE
