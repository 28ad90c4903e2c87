#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Are the bands of `krater study` true? Problems with known answers: how often the true error lies in the stated band.

Writes README.md and calibration.png into its folder. `tools/validate calibration` builds first.
"""

import csv
import os
import re
import subprocess
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from krater_study.uncertainty import estimate  # noqa: E402
from validate_calibration import problems  # noqa: E402
from validate_runs import Study  # noqa: E402

ESTIMATED_SECONDS = 150  # on two quiet cores
SHIFTS = (0.0, -0.04, 0.04)
KINDS = ("two cells", "three cells", "four cells", "three cells, three lattices each")
ROUND = 1e-9  # of the answer: round-off is no error of the cell


class Case:
    """One measure of one problem at some of its cells: the stated band beside the true error."""

    def __init__(self, problem, measure, kind, cells, values):
        self.problem, self.measure, self.kind = problem.name, measure, kind
        self.cells = cells
        exact = problem.measures[measure][1]
        found = estimate([1 / n for n in cells], values)
        self.error = 100 * abs(found.value / exact - 1)
        self.band = 100 * found.uncertainty / abs(exact)
        self.how = found.how
        self.inside = self.error <= self.band + 100 * ROUND

    @property
    def finest(self):
        return max(self.cells)


def values_of(study, problem, cells):
    """{measure: values} at these cells; None where a run failed."""
    if problem.point:
        ends = [end_of_path(study, label_of(problem, n), problem.text(n)) for n in cells]
        return {name: [end[name] for end in ends] for name in problem.measures}
    runs = []
    for n in cells:
        done = study.run_text(label_of(problem, n), problem.text(n), n**2 / 5000)
        if done is None:
            return None
        runs.append(done)
    found = problem.found or (lambda run, name: run.measure(name))
    return {name: [found(run, name) for run in runs] for name in problem.measures}


def label_of(problem, n):
    return f"{problem.name}_{n:.5g}".replace(" ", "_").translate({ord(c): None for c in ",'/()"})


def end_of_path(study, label, text):
    """{column: its last value} of `krater point`."""
    place = os.path.join(study.folder, "runs_out", label)
    os.makedirs(os.path.dirname(place), exist_ok=True)
    with open(place + ".yaml", "w", encoding="utf-8") as file:
        file.write(text)
    subprocess.run([study.krater, "point", place + ".yaml", "-o", place, "--quiet"], check=True)
    with open(os.path.join(place, "point.csv"), encoding="utf-8", newline="") as file:
        lines = list(csv.reader(file))
    return {re.match(r"\w+", title)[0]: float(cell) for title, cell in zip(lines[0], lines[-1])}


def cases_of(study, problem):
    found = []
    values = values_of(study, problem, problem.cells)
    if values is not None:
        count = len(problem.cells)
        for first in range(count):
            for last in range(first + 2, min(first + 4, count) + 1):
                found += [Case(problem, name, KINDS[last - first - 2], problem.cells[first:last], v[first:last])
                          for name, v in values.items()]
    if problem.free:
        cells = [n / (1 + shift) for n in problem.cells[:3] for shift in SHIFTS]
        values = values_of(study, problem, cells)
        if values is not None:
            found += [Case(problem, name, KINDS[3], cells, v) for name, v in values.items()]
    return found


def share(cases):
    return f"{sum(case.inside for case in cases)} of {len(cases)}" if cases else "-"


def per_cent(cases):
    return 100 * np.mean([case.inside for case in cases])


def picture(cases, path):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 4.3), constrained_layout=True)
    for kind, colour in zip(KINDS, ("#c98a1b", "#1f5f99", "#b5402a", "#4c8f5b")):
        chosen = [case for case in cases if case.kind == kind]
        if not chosen:
            continue
        band, error = (np.maximum([getattr(case, key) for case in chosen], 1e-7) for key in ("band", "error"))
        left.loglog(band, error, "o", ms=3.5, color=colour, alpha=0.75, label=kind)
        ratio = np.sort(error / band)
        right.step(np.append(ratio, 1e3), np.append(np.arange(1, len(ratio) + 1) / len(ratio), 1), where="post",
                   color=colour)
    ends = [1e-7, 3e2]
    left.plot(ends, ends, color="#1b2733", lw=1)
    left.set(xlabel="stated band [%]", ylabel="true error [%]", xlim=ends, ylim=ends,
             title="Below the line the band holds")
    left.legend(frameon=False, fontsize=8)
    right.axvline(1, color="#1b2733", lw=1)
    right.axhline(0.9, color="#8794a1", lw=0.8, ls=":")
    right.set(xscale="log", xlim=(1e-2, 1e1), ylim=(0, 1.01), xlabel="true error / stated band",
              ylabel="share of the measures",
              title="At 1 it should reach 0.9")
    figure.savefig(path, dpi=130)


def report(study, cases):
    names = list(dict.fromkeys(case.problem for case in cases))
    by_kind = {kind: [case for case in cases if case.kind == kind] for kind in KINDS}
    study.add(
        f"A band is meant to hold the true answer in nine of ten cases (`tools/krater_study/uncertainty.py` says how "
        f"it is made). "
        f"Here the truth is known: {len(names)} problems, {sum(len(p.measures) for p in problems())} measures, and of "
        f"each every "
        "run of two, three and four neighbouring cells, as if a user had chosen them. Measures were chosen before "
        "their errors were "
        "looked at, but for those of the solutions and the last four; none was left out.",
        f"**{per_cent(cases):.1f} % of {len(cases)} bands hold the truth** (demanded: 90 %). By what the band was made "
        f"from: " +
        "; ".join(f"{kind} {per_cent(chosen):.0f} %" for kind, chosen in by_kind.items() if chosen) + ".",
        "![stated band against true error](calibration.png)", "## By problem")
    study.add_table(["bands that hold", *KINDS, "median band / error"],
                    [[name, *(share([c for c in by_kind[kind] if c.problem == name]) for kind in KINDS),
                      f"{np.median([c.band / max(c.error, 1e-9) for c in cases if c.problem == name]):.2g}"]
                     for name in names])
    study.add("## By word", "What the study said of the values, and how often that band held.")
    words = sorted({case.how.split(",")[0] for case in cases})
    study.add_table(["word", "bands that hold", "median band, %"],
                    [[word, share(chosen), f"{np.median([c.band for c in chosen]):.2g}"] for word in words
                     for chosen in [[c for c in cases if c.how.split(",")[0] == word]]])
    misses = sorted((c for c in cases if not c.inside), key=lambda c: -c.error / max(c.band, 1e-12))
    study.add("## Misses", "All of them, the worst first. `cells` are those along the problem's length.")
    study.add_table(["problem, measure", "cells", "error %", "band %", "error / band", "said"],
                    [[f"{c.problem}: {c.measure}",
                      " ".join(f"{n:.4g}" for n in c.cells[:4]) + (" ..." if len(c.cells) > 4 else ""),
                      f"{c.error:.2g}", f"{c.band:.2g}", f"{c.error / max(c.band, 1e-12):.2g}", c.how] for c in misses])


def main():
    study = Study(__file__, "inputs/plate_impact.yaml", ESTIMATED_SECONDS, __doc__)
    cases = [case for problem in problems() for case in cases_of(study, problem)]
    picture(cases, os.path.join(study.folder, "calibration.png"))
    report(study, cases)
    text = os.path.join(study.folder, "discussion.md")
    if os.path.exists(text):
        with open(text, encoding="utf-8") as file:
            study.add("## What to make of it", file.read().strip())
    study.write("Are the bands true?")
    return 1 if study.failed else 0


if __name__ == "__main__":
    sys.exit(main())
