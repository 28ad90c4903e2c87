# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and pictures that the reports of impact scenes share, for validation/*/make_report.py."""

import os

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import run_pictures  # noqa: E402
from plot_run_shapes import view_from_outside  # noqa: E402
from run_pictures import Scale, nearest  # noqa: E402, F401
from run_reader import Run as Shapes  # noqa: E402

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


def outside(study, runs, time, target, scale, title="", **view):
    """{name: run} seen from outside, lit."""
    runs = {name: run for name, run in runs.items() if run}
    if not runs:
        return
    figure, line = plt.subplots(1, len(runs), squeeze=False, layout="constrained",
                                figsize=(6.2 * len(runs) + 0.8, 5.6))
    for axes, (name, run) in zip(line[0], runs.items()):
        run_shapes = Shapes(run.folder)
        colouring = scale(run_shapes)
        number = nearest(run_shapes, time)
        view_from_outside(axes, run_shapes.bodies(number), colouring, 1e-3, **view)
        axes.set_title(f"{name}, {1e6 * run_shapes.time(number):.4g} µs")
    colouring.bar(figure, ax=line, fraction=0.03)
    figure.suptitle(title)
    figure.savefig(os.path.join(study.folder, target), dpi=110)
    plt.close(figure)


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


def fragments(study, run, name, most=8):
    """Table of the pieces of a run, the heaviest first, and what is too small to be resolved."""
    found = run.summary.get("fragments", {}).get(name) if run else None
    if not found:
        return
    rows = [[piece["body"], f"{1e3 * piece['mass']:.3f}", piece["points"],
             f"{piece['velocity']['z']:.1f}", " x ".join(f"{1e3 * s:.1f}" for s in piece["size"].values())]
            for piece in found["pieces"][:most]]
    study.add_table(["piece of", "mass g", "points", "velocity z m/s", "size mm"], rows)
    dust, left = found["dust"], len(found["pieces"]) - most
    study.add((f"{left} more pieces. " if left > 0 else "") +
              f"Pieces of fewer than {found['least_points']} points are not resolved: {dust['pieces']} of them, "
              f"{1e3 * dust['mass']:.3f} g together.")
