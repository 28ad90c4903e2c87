# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of several runs, {name: folder}: sections over time, outlines in one picture, histories. Each is a figure, to
be saved by who asked for it. Lengths are in mm, times in µs."""

import textwrap

import numpy as np
from matplotlib import colormaps, colors
from matplotlib.figure import Figure

from plot_run_raster import Fraction, Raster
from plot_run_shapes import Colouring, draw_section, limits
from run_reader import Run, read_history
from units import said, scale_of

REFERENCE = {"color": "#d6006c", "ls": (0, (6, 3)), "lw": 1.2}


class Scale(Colouring):
    """A field with a scale that is given, the same in every picture."""

    def __init__(self, run, field, top, bottom=0.0, factor=1.0, label=None):
        super().__init__(run, run.numbers[-1:])
        self.field, self.factor, self.extend = field, factor, "max"
        self.map, self.norm = colormaps["viridis"], colors.Normalize(bottom, top)
        self.label = label or field.replace("_", " ")


def nearest(run, time):
    """Number of the frame."""
    return min(run.numbers, key=lambda number: abs(run.time(number) - time))


def horizontal(run):
    return "r [mm]" if run.frame == "axisymmetric" else "x [mm]"


def sections(rows, times, scale, box=None, title="", pixels=700):
    """Runs in rows, times in columns, coloured by `scale(run)`; box in mm: x, x, z, z."""
    wide = (box[1] - box[0]) / (box[3] - box[2]) if box else 1.0
    width = float(np.clip(3.6 * wide, 2.2, 6.0))
    figure = Figure(layout="constrained",
                    figsize=(width * len(times) + 1.4, (width / wide + 0.35) * len(rows) + 0.8))
    grid = figure.subplots(len(rows), len(times), squeeze=False, sharex=True, sharey=True)
    for line, (name, folder) in zip(grid, rows.items()):
        run = Run(folder)
        colouring = scale(run)
        for axes, time in zip(line, times):
            number = nearest(run, time)
            whole = np.array(box) if box else limits(run, [number], 1e-3)
            draw_section(axes, run, run.bodies(number), colouring, 1e-3, whole, pixels)
            axes.set_xlim(whole[0], whole[1])
            axes.set_ylim(whole[2], whole[3])
            axes.grid(False)
            axes.set_title(textwrap.fill(f"{name}, {1e6 * run.time(number):.4g} µs", int(12 * width)), fontsize=10)
        line[0].set_ylabel("z [mm]")
    for axes in grid[-1]:
        axes.set_xlabel(horizontal(run))
    colouring.bar(figure, ax=grid, fraction=0.03)
    figure.suptitle(title)
    return figure


def drawn(run, number):
    """(raster, [(body, its volume fraction)]) of a frame."""
    raster = Raster(limits(run, [number], 1.0), float(run.summary["cell"]), 1000)
    return raster, [(body, Fraction(raster, run.frame, body.x, body.volume, run.planes, run.section_y))
                    for body in run.bodies(number)]


def noise(folder, field, time):
    """Root of the mean square difference between the points of a 2d run and their mean over a cell (B-spline of
    width h), weighted by mass: what smooth fields do not have."""
    run = Run(folder)
    run.require_field(field)
    raster, bodies = drawn(run, nearest(run, time))
    total = weight = 0.0
    for body, fraction in bodies:
        values, mass = body.values(field), body.values("mass")
        apart = values - raster.at(fraction.mean(values), fraction.places[:len(values)])
        total, weight = total + np.sum(mass * apart ** 2), weight + np.sum(mass)
    return float(np.sqrt(total / weight))


def outline(axes, run, number, **options):
    """Lines of volume fraction 1/2 of the bodies of a 2d run, or in the section of a 3d run."""
    raster, bodies = drawn(run, number)
    low, high, bottom, top = raster.extent(1e-3)
    rows, columns = raster.shape
    x = low + (np.arange(columns) + 0.5) * (high - low) / columns
    z = bottom + (np.arange(rows) + 0.5) * (top - bottom) / rows
    for _, fraction in bodies:
        phi = np.ma.array(fraction.phi, mask=fraction.beyond)
        if phi.min() < 0.5 < phi.max():  # else it is nowhere, or everywhere
            axes.contour(x, z, phi, levels=[0.5], **options)


def outlines(rows, time, boxes=(None,), title=""):
    """All runs in one picture at a time, drawn once for each box (in mm: x, x, z, z; None: all of it)."""
    figure = Figure(figsize=(5.8 * len(boxes), 6.4), layout="constrained")
    line = figure.subplots(1, len(boxes), squeeze=False)[0]
    for k, (name, folder) in enumerate(rows.items()):
        run = Run(folder)
        for axes in line:
            outline(axes, run, nearest(run, time), colors=[f"C{k}"], linewidths=1.4)
        line[0].plot([], [], color=f"C{k}", label=name)
    for axes, box in zip(line, boxes):
        axes.set_aspect("equal")
        axes.grid(False)
        axes.set_xlabel(horizontal(run))
        if box:
            axes.set_xlim(box[0], box[1])
            axes.set_ylim(box[2], box[3])
    line[0].set_ylabel("z [mm]")
    figure.get_layout_engine().set(rect=(0, 0.06, 1, 0.94))
    figure.legend(*line[0].get_legend_handles_labels(), loc="lower center", ncol=4, frameon=False)
    figure.suptitle(title)
    return figure


def histories(rows, columns, unit, factor=1.0, lines=(), title="", values=None, span=None):
    """Columns {name: words} of the histories over time; lines: (value, words) across the picture; `values(folder,
    name)` where a column is no column of the history; span: least and largest value that is shown."""
    figure = Figure(figsize=(8, 4.6), layout="constrained")
    axes = figure.subplots()
    styles = dict(zip(columns, ("-", "--", ":", "-.")))
    read = {folder: read_history(f"{folder}/history.csv") for folder in rows.values()}
    scale, second = scale_of(max(history["time"][1][-1] for history in read.values()), "s")
    for k, (name, folder) in enumerate(rows.items()):
        for column, words in columns.items():
            found = values(folder, column) if values else read[folder][column][1]
            axes.plot(read[folder]["time"][1] / scale, factor * found, styles[column], color=f"C{k}", lw=1.4,
                      label=f"{words}, {name}" if words else name)
    for number, words in lines:
        axes.axhline(number, label=words, **REFERENCE)
    axes.set_xlabel(f"time [{second}]")
    axes.set_ylabel(unit)
    if span:
        axes.set_ylim(*span)
    axes.legend(frameon=False, fontsize=9)
    axes.set_title(title)
    bare(axes)
    return figure


def bare(axes):
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def scatter(rows, times, values, labels, span=None, box=None, lines=(), title=""):
    """Points of runs: `values(folder, time)` gives (time, {"x": ..., "y": ..., "colour": ...}). With colours runs in rows
    and times in columns, x and y alike (`box`: x, x, y, y; span: of the colours); else all in one picture (span: of y)."""
    if "colour" not in labels:
        figure = Figure(figsize=(8, 4.6), layout="constrained")
        axes = figure.subplots()
        for name, folder in rows.items():
            for time in times:
                at, found = values(folder, time)
                label = name if len(times) == 1 else f"{name}, {said(at, 's')}"
                axes.plot(found["x"], found["y"], ".", ms=3, label=label)
        for number, words in lines:
            axes.axhline(number, label=words, **REFERENCE)
        axes.set(xlabel=labels["x"], ylabel=labels["y"], title=title)
        if box:
            axes.set(xlim=box[:2], ylim=box[2:])
        axes.legend(frameon=False, fontsize=9)
        bare(axes)
        return figure
    figure = Figure(figsize=(3.4 * len(times) + 1.2, 3.5 * len(rows) + 0.6), layout="constrained")
    grid = figure.subplots(len(rows), len(times), squeeze=False, sharex=True, sharey=True)
    every = {(name, time): values(folder, time) for name, folder in rows.items() for time in times}
    low, high = span or (min(found["colour"].min(initial=0) for _, found in every.values()),
                         max(found["colour"].max(initial=0) for _, found in every.values()))
    for line, name in zip(grid, rows):
        for axes, time in zip(line, times):
            at, found = every[name, time]
            drawn = axes.scatter(found["x"], found["y"], c=found["colour"], s=2, linewidths=0, cmap="viridis", vmin=low, vmax=high)
            axes.set_aspect("equal")
            if box:
                axes.set(xlim=box[:2], ylim=box[2:])
            axes.set_title(textwrap.fill(f"{name}, {said(at, 's')}", 38), fontsize=9)
        line[0].set_ylabel(labels["y"])
    for axes in grid[-1]:
        axes.set_xlabel(labels["x"])
    figure.colorbar(drawn, ax=grid, fraction=0.03, label=labels["colour"])
    figure.suptitle(title)
    return figure
