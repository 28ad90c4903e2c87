#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points, elements and particles beside solutions that are known, in one table: errors at three cells, order, cost.

The problems are studies (kind `sweep`) beside this file. Writes README.md into its folder. `tools/validate solutions`
builds first.
"""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_impacts import discussion  # noqa: E402
from validate_runs import Run, Study  # noqa: E402

ESTIMATED_SECONDS = 60  # on two quiet cores
PROBLEMS = ("bar", "bending", "incompressible", "spin", "plate", "verney")
IDEAL = ("verney",)  # their reference is that of other matter: the order is that of the differences
KINDS = {"mpm": "points", "lagrangian_mesh": "elements", "sph": "particles"}


def error(run, measure):
    """Per cent of the reference; without one, of the value at the start."""
    told = run.summary["measures"][measure]
    if "difference_percent" in told:
        return told["difference_percent"]
    history = run.history()[measure]
    return 100 * (history[-1] / history[0] - 1)


def order(errors, ideal):
    """By the last halving of the cell; none where the sign changes or nothing is left."""
    first, last = (errors[0] - errors[1], errors[1] - errors[2]) if ideal else errors[-2:]
    return f"{math.log2(first / last):.1f}" if first * last > 0 and abs(last) > 1e-10 else "-"


def add_rows(rows, name, told, folder):
    measures = list(told["answer"]["spread"])
    for measure in measures:
        for kind, word in KINDS.items():
            members = [m for m in told["members"] if kind in m["settings"][0]]
            runs = [Run(os.path.join(folder, "members", m["member"])) for m in members]
            errors = [error(run, measure) for run in runs]
            title = told["title"] + (f": {measure.replace('_', ' ')}" if len(measures) > 1 else "")
            rows.append([title, word, *(f"{e:+.3g}" for e in errors), order(errors, name in IDEAL),
                         " / ".join(f"{m['core_seconds']:.2g}" for m in members)])


def main():
    study = Study(__file__, "inputs/plate_impact.yaml", ESTIMATED_SECONDS, __doc__)
    rows = []
    for name in PROBLEMS:
        scene = os.path.join(study.folder, name + "_scene.yaml")
        told, folder = study.ask(name, beside=[scene] if os.path.exists(scene) else [])
        if told:
            add_rows(rows, name, told, folder)
    study.add("Plane strain, for particles know no axial symmetry. One scene for all three: elements of the size of the cell, points and "
              "particles two to the cell along each axis. Studies: " + ", ".join(f"[{name}]({name}.yaml)" for name in PROBLEMS)
              + ", to be run by anybody with `krater study`; solutions and their sources are in the scenes.")
    study.add_table(["problem", "body of", "error %, coarse", "half the cell", "a quarter", "order", "core seconds"], rows)
    discussion(study)
    study.write("Three kinematics beside solutions")
    return 1 if study.failed else 0


if __name__ == "__main__":
    sys.exit(main())
