# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and pictures that the reports of impact scenes share, for validation/*/make_report.py."""

import os

import matplotlib
matplotlib.use("Agg")
import numpy as np  # noqa: E402

import run_pictures  # noqa: E402
from run_pictures import Scale  # noqa: E402, F401

COST_TITLES = ["points", "steps", "energy error %", "change of momentum", "memory MB", "wall time s (threads)"]


def momentum_change(run):
    """Change of the momentum along z from start to end, what left the domain included, in shares of the start's."""
    start = run.history()["momentum_z"][0]
    return abs(run.audit("momentum_z") + run.audit("removed_momentum_z") - start) / abs(start)


def costs(run):
    """Cells of COST_TITLES."""
    if run is None:
        return ["failed or left out"] + ["-"] * (len(COST_TITLES) - 1)
    memory = run.memory
    return [run.summary["points"], run.summary["steps"], f"{run.error:.2f}", f"{momentum_change(run):.0e}",
            f"{1e-6 * memory:.0f}" if memory else "-", f"{run.wall:.1f} ({run.summary['machine']['threads']})"]


def value(run, name, factor=1.0, digits=1):
    """A measure as text; '-' where there is none."""
    found = None if run is None else run.summary["measures"].get(name, {}).get("value")
    return "-" if found is None or not np.isfinite(found) else f"{factor * found:.{digits}f}"


def nanoseconds(run):
    """Time of all stages per point and step, all threads together."""
    seconds = sum(run.summary["machine"]["seconds"].values())
    return 1e9 * seconds * run.summary["machine"]["threads"] / (run.summary["points"] * run.summary["steps"])


def named(runs):
    """{name: folder} of the runs that there are."""
    return {name: run.folder for name, run in runs.items() if run}


def shapes(study, rows, times, target, scale, box=None, title="", pixels=700):
    """{name: run} in rows, times in columns, coloured by `scale(shapes)`; box in mm: x, x, z, z."""
    if named(rows):
        run_pictures.sections(named(rows), times, scale, box, title, pixels).savefig(
            os.path.join(study.folder, target), dpi=110)


def histories(study, runs, columns, target, unit, factor=1.0, lines=(), title=""):
    """Columns of the history of {name: run} over time; lines: (value, words) across the picture."""
    run_pictures.histories(named(runs), columns, unit, factor, lines, title).savefig(
        os.path.join(study.folder, target), dpi=110)


def discussion(study):
    """The words of discussion.md, which a person writes."""
    path = os.path.join(study.folder, "discussion.md")
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            study.add(file.read().strip())
