#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the cases of validation/hard/cases, each a scene that says what must hold (tools/expectations.py), and judges.

    tools/hard                   all cases: about a quarter of an hour on two cores
    tools/hard --quick           of each case what a test takes: a minute
    tools/hard bars noh          the cases named
    tools/hard --list            their names and titles

Exit code 1 where something is missed that the scene does not list under `misses`, or no longer is.
"""

import argparse
import dataclasses
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

import yaml

import expectations

ROOT = pathlib.Path(__file__).resolve().parents[1]
CASES = ROOT / "validation" / "hard" / "cases"


@dataclasses.dataclass
class Case:
    name: str
    path: pathlib.Path
    title: str
    expect: dict
    runs: dict  # name -> settings

    @staticmethod
    def read(path):
        tree = yaml.safe_load(path.read_text(encoding="utf-8"))
        expect = tree.get("expect", {})
        wrong = list(expectations.mistakes(expect))
        if wrong:
            sys.exit(f"{path}: " + f"\n{path}: ".join(wrong))
        return Case(path.stem, path, tree.get("title", path.stem), expect, expect.get("runs", {"": []}))

    def shortened(self):
        """The runs that a test takes."""
        quick = self.expect.get("quick", [])
        return dataclasses.replace(self, runs={name: self.runs[name] for name in quick})


def all_cases():
    return [Case.read(path) for path in sorted(CASES.glob("*.yaml"))]


def command_of(krater, case, settings, folder, threads=1):
    words = [krater, "run", str(case.path), "-o", str(folder), "-j", str(threads), "--quiet"]
    for setting in settings:
        words += ["--set", setting]
    return words


@dataclasses.dataclass
class Outcome:
    """What became of a run of a case."""
    case: Case
    run: str
    verdict: list
    seconds: float
    figures: dict = dataclasses.field(default_factory=dict)

    def label(self):
        return f"{self.case.name} {self.run}".strip()

    def excused(self, judgement):
        misses = self.case.expect.get("misses", {})
        return judgement.name in misses or f"{self.run}: {judgement.name}" in misses

    def surprises(self):
        """What is missed without the scene's saying so."""
        return [one for one in self.verdict if not one.held and not self.excused(one)]

    def misses(self):
        return [one for one in self.verdict if not one.held and self.excused(one)]


def judged(case, run, folder, ended):
    """The outcome of a run that has ended: (exit code, what it said, seconds)."""
    code, said, seconds = ended
    verdict = expectations.judge(case.expect, run, folder, code, said)
    if not verdict[0].held:
        verdict[0].found = f"{code}: {said.strip()[-300:]}"
    figures = expectations.figures(case.expect, folder) if verdict[0].held else {}
    return Outcome(case, run, verdict, seconds, figures)


def execute(krater, case, run, folder, timeout=1200):
    """(exit code, what it said, seconds); the code is None where it did not end."""
    begin = time.monotonic()
    try:
        done = subprocess.run(command_of(krater, case, case.runs[run], folder), capture_output=True, text=True, check=False,
                              env={"OMP_WAIT_POLICY": "passive", **os.environ}, timeout=timeout)
        code, said = done.returncode, done.stderr
    except subprocess.TimeoutExpired:
        code, said = None, f"no end within {timeout} s"
    return code, said, time.monotonic() - begin


def run_case(krater, case, run, folder):
    return judged(case, run, folder, execute(krater, case, run, folder))


def no_longer_missed(outcomes):
    """Excuses of scenes that nothing needs any more."""
    for case in {one.case.name: one.case for one in outcomes}.values():
        mine = [one for one in outcomes if one.case.name == case.name]
        if {one.run for one in mine} != set(case.expect.get("runs", {"": []})):
            continue  # only a part was run
        for name in case.expect.get("misses", {}):
            if not any(j.name == name or f"{one.run}: {j.name}" == name for one in mine for j in one.misses()):
                yield f"{case.name}: {name} holds now: take it from `misses`"


def say(outcome):
    wrong = outcome.surprises()
    word = "FAIL" if wrong else "miss" if outcome.misses() else "ok"
    print(f"{word:5}{outcome.label()} ({outcome.seconds:.1f} s)", flush=True)
    for one in outcome.verdict:
        mark = "" if one.held else "  <- missed, as the scene says" if outcome.excused(one) else "  <- MISSED"
        if not one.held or one.name != "exit":
            print(f"       {one}{mark}", flush=True)
    for name, value in outcome.figures.items():
        print(f"       {name} {expectations.show(value)}", flush=True)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("-j", type=int, default=min(os.cpu_count() or 1, 2), metavar="N", help="runs at a time")
    parser.add_argument("-o", metavar="DIR", help="keep results here")
    options = parser.parse_args(arguments)
    cases = all_cases()
    unknown = set(options.names) - {case.name for case in cases}
    if unknown:
        sys.exit(f"tools/hard: no case {', '.join(sorted(unknown))}; known: {' '.join(case.name for case in cases)}")
    cases = [case for case in cases if not options.names or case.name in options.names]
    cases = [case.shortened() for case in cases] if options.quick else cases
    if options.list:
        for case in cases:
            print(f"{case.name:24}{case.title}")
        return 0
    krater = os.environ.get("KRATER", str(ROOT / "build" / "krater"))
    root = pathlib.Path(options.o or tempfile.mkdtemp(prefix="krater hard "))
    jobs = [(case, run) for case in cases for run in case.runs]
    outcomes = []
    with ThreadPoolExecutor(options.j) as pool:
        for outcome in pool.map(lambda job: run_case(krater, *job, root / job[0].name / (job[1] or "run")), jobs):
            say(outcome)
            outcomes.append(outcome)
    if not options.o:
        shutil.rmtree(root, ignore_errors=True)
    idle = list(no_longer_missed(outcomes))
    for text in idle:
        print(text)
    wrong = [one.label() for one in outcomes if one.surprises()]
    print(f"{len(outcomes)} runs of {len(cases)} cases; missed: {', '.join(wrong) or 'none'}")
    return 1 if wrong or idle else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
