# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading a results folder and drawing the shapes of its bodies, for tools/plot_run."""

import csv
import json
import math
import os
import sys
import textwrap

import h5py
import numpy as np
from matplotlib import cm, colormaps, colors, patheffects

from plot_run_elements import draw_elements, draw_surfaces
import plot_run_levels as levels
from plot_run_raster import HALF, Fraction, Raster, box_mean, closed_planes, stamp

ABSENT = -1e300
REFERENCE = "#d6006c"  # far from every colour of the maps below
SCALES = [(1e9, "G"), (1e6, "M"), (1e3, "k"), (1, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n")]


# ------------------------------------------------------------------------------------------ reading

class Body:
    """Points of a body in the plane of the picture (2D frames and sections) or in space."""

    def __init__(self, name, group, summary):
        self.name = name
        x = group["coordinates"][()]
        self.kept = np.isfinite(x).all(axis=1)  # a broken run may hold points that are nowhere
        self.x = x[self.kept]
        self.fields, self.parts = group, None  # parts: of which point each is one
        self.side = self.spacing(summary)  # of the square or cube that each point stands for
        self.volume = self.volumes(frame_of(summary, self.x))
        self.flat = frame_of(summary, self.x) != "3d"
        self.level = np.round(self.values("level")).astype(int) if "level" in group else np.zeros(len(self.x), int)
        self.whole = self.x  # places of the points, whatever is drawn of them
        self.nodes = group["nodes"]["coordinates"][()] if "nodes" in group else None
        self.cells = group["connectivity"][()][self.kept] if "nodes" in group else None  # corners of each element

    def volumes(self, frame):
        """Of a full ring in axisymmetry, per length in plane strain."""
        if "mass" in self.fields and "density" in self.fields:
            return self.values("mass") / self.values("density")
        return {"axisymmetric": 2 * math.pi * self.x[:, 0] * self.side ** 2,
                "3d": self.side ** 3}.get(frame, self.side ** 2)

    def spacing(self, summary):
        """From the volumes of the points; else half a cell; else the box of the body shared out."""
        if "mass" not in self.fields or "density" not in self.fields:
            side = 0.5 * float(summary.get("cell") or 0)
            if not side:
                widths = np.ptp(self.x, axis=0)
                widths = widths[widths > 0]
                side = (np.prod(widths) / len(self.x)) ** (1 / len(widths)) if len(widths) else 1e-3
            return np.full(len(self.x), side)
        volume = self.values("mass") / self.values("density")
        frame = frame_of(summary, self.x)
        if frame == "3d":
            return np.cbrt(volume)
        if frame == "axisymmetric":  # mass of the full ring
            volume = volume / (2 * math.pi * np.maximum(self.x[:, 0], 1e-300))
        return np.sqrt(volume)

    def values(self, field):
        if field not in self.fields:
            return None
        values = self.fields[field][()][self.kept]
        return values if self.parts is None else values[self.parts]


def frame_of(summary, x):
    return str(summary.get("frame") or ("3d" if np.abs(x[:, 1]).max(initial=0) > 0 else "plane_strain"))


class Run:
    def __init__(self, folder):
        self.folder = folder
        try:
            with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
                self.summary = json.load(file)
        except (OSError, ValueError) as error:
            print(f"plot_run: no summary ({error})", file=sys.stderr)
            self.summary = {}
        self.file = h5py.File(os.path.join(folder, "frames.h5"), "r")
        self.numbers = sorted(self.file["frames"])
        if not self.numbers:
            raise OSError("no frame in frames.h5")
        if "frame" not in self.summary and "frame_of_reference" in self.file.attrs:
            self.summary["frame"] = self.file.attrs["frame_of_reference"]
        self.names = sorted({name for number in (self.numbers[0], self.numbers[-1]) for name in self.file["frames"][number]})
        start = [b.x for b in self.bodies(self.numbers[0])]
        x = np.concatenate(start) if start else np.zeros((0, 3))
        self.frame = frame_of(self.summary, x)
        self.summary["frame"] = self.frame
        self.history = read_history(os.path.join(folder, "history.csv"))
        self.planes = closed_planes(folder)
        y = x[:, 1]
        through = len(y) == 0 or y.min() <= 0 <= y.max() or (1, 0.0, 1) in self.planes
        self.section_y = 0.0 if through else 0.5 * (y.min() + y.max())

    def time(self, number):
        return float(self.file["frames"][number].attrs["time"])

    def bodies(self, number):
        group = self.file["frames"][number]
        bodies = [Body(name, group[name], self.summary) for name in group if len(group[name]["id"])]
        bodies = [body for body in bodies if len(body.x)]
        self.finest = levels.spread(bodies)
        return bodies

    def title(self):
        return str(self.summary.get("title") or os.path.basename(os.path.abspath(self.folder)))


def read_history(path):
    """name -> (unit, values); values are numbers, or texts where a column has any."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except OSError:
        return {}
    columns = {}
    whole = [row for row in rows[1:] if len(row) == len(rows[0])]
    for k, title in enumerate(rows[0] if whole else []):
        name, _, unit = title.partition(" [")
        texts = [row[k] for row in whole]
        try:
            columns[name] = (unit.rstrip("]"), np.array([float(text) for text in texts]))
        except ValueError:
            columns[name] = (unit.rstrip("]"), np.array(texts))
    return columns


def scale_of(largest, unit):
    """Divisor and unit that make `largest` readable: 3.1e8 Pa -> 1e6, MPa."""
    if unit in ("", "1") or not largest > 0 or not math.isfinite(largest):
        return 1.0, ""
    for factor, prefix in SCALES:
        if largest >= factor * (0.1 if unit == "m" and prefix == "m" else 1):
            if unit == "m" and prefix in ("k", "M", "G"):
                continue
            return factor, prefix + unit
    return 1.0, unit


class Colouring:
    """One field with one scale for all pictures of a run."""

    def __init__(self, run, numbers):
        last = [b for n in numbers for b in run.bodies(n)]
        names = ("plastic_strain", "pressure", "density", "temperature")
        self.field = next((n for n in names if any(n in b.fields for b in last)), None)
        self.norm, self.factor, self.label, self.extend = colors.Normalize(0, 1), 1.0, "", "neither"
        self.map = colormaps["viridis"]
        if self.field is None:
            return
        arrays = [b.values(self.field) for n in numbers for b in run.bodies(n) if self.field in b.fields]
        values = np.concatenate(arrays)
        values = values[np.isfinite(values)]
        low, high = (values.min(), values.max()) if len(values) else (0.0, 1.0)
        top = np.quantile(np.abs(values), 0.999) if len(values) else 1.0
        unit = next(b.fields[self.field].attrs.get("unit", "") for b in last if self.field in b.fields)
        self.factor, text = scale_of(max(abs(low), abs(high)), str(unit))
        if self.field == "pressure":
            self.map = colormaps["RdBu_r"]
            self.norm = colors.Normalize(-top / self.factor, top / self.factor)
        elif self.field == "plastic_strain":
            self.norm = colors.Normalize(0, max(min(high, 1.25 * top), 1e-12))
        else:
            self.norm = colors.Normalize(low / self.factor, max(high, low + 1e-300) / self.factor)
        above, below = high / self.factor > self.norm.vmax, low / self.factor < self.norm.vmin
        self.extend = ("both" if below else "max") if above else ("min" if below else "neither")
        self.label = self.field.replace("_", " ") + (f" [{text}]" if text else "")
        if above:
            self.label += f", largest {high / self.factor:.3g}"

    def values(self, body):
        """Of the points; ABSENT in a body without the field."""
        values = body.values(self.field) if self.field else None
        return np.full(len(body.x), ABSENT) if values is None else values

    def rgba(self, values):
        rgba = self.map(self.norm(values / self.factor))
        rgba[~np.isfinite(values)] = colors.to_rgba("red")
        rgba[np.abs(values / ABSENT - 1) < 1e-6] = colors.to_rgba("0.7")
        return rgba

    def of(self, body):
        return self.rgba(self.values(body))

    def bar(self, figure, **place):
        """Draws the colour bar; False when the bodies have no field to colour them by."""
        if self.field:
            mappable = cm.ScalarMappable(self.norm, self.map)
            figure.colorbar(mappable, label=self.label, extend=self.extend, **place)
        return self.field is not None


# ------------------------------------------------------------------------------------------ shapes

def draw_section(axes, run, bodies, colouring, mm, box, pixels=1000):
    """Elements as they are; points: material where the volume fraction of a body is above 1/2, coloured by the mean
    about each pixel; points that it does not show, or whose value is no number, as squares of their own area."""
    for body in bodies:
        if body.cells is not None:
            draw_elements(axes, run, body, colouring, mm)
    axes.set_aspect("equal")
    bodies = [body for body in bodies if body.cells is None]
    if not bodies:
        return
    cell = float(run.summary.get("cell") or 2 * np.median(bodies[0].side)) / 2 ** run.finest
    raster = Raster(box * mm, cell, pixels)
    image, most = np.ones(raster.shape + (4,)), np.full(raster.shape, HALF)
    for body in bodies:
        body_in = Fraction(raster, run.frame, body.x, body.volume, run.planes, run.section_y)
        values = colouring.values(body)
        shown = body_in.phi >= most
        most[shown] = body_in.phi[shown]
        image[shown] = colouring.rgba(body_in.mean(values))[shown]
        alone = np.union1d(body_in.isolated(), np.flatnonzero(~np.isfinite(values[body_in.index])))
        if run.frame == "3d":  # of those beside the plane, the nearest
            alone = alone[np.abs(body.x[body_in.index[alone], 1] - run.section_y) <= 0.5 * raster.h]
        if len(alone):
            u, v = (body_in.places[alone] + 0.5).T
            half = np.maximum(0.5 * body.side[body_in.index[alone]] / raster.pixel, 0.5)
            nearest, away = stamp(u, v, np.ceil(half), raster.shape, np.arange(len(alone)),
                                  lambda points, rows, columns, u=u, v=v, half=half: np.maximum(
                                      np.abs(columns + 0.5 - u[points]), np.abs(rows + 0.5 - v[points]))
                                  / half[points])
            bad = ~np.isfinite(values[body_in.index[alone]])
            marked = (away <= 1) & ((most <= HALF) | bad[nearest])
            marked &= ~body_in.beyond
            image[marked] = colouring.rgba(values[body_in.index[alone]])[nearest[marked]]
    axes.imshow(image, origin="lower", extent=raster.extent(mm), interpolation="antialiased")


def limits(run, numbers, mm):
    """Picture box that holds every frame drawn: x low, x high, z low, z high."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for number in numbers:
        for body in run.bodies(number):
            half = 0.5 * body.side[:, None] if body.cells is None else 0.0
            x = body.x if body.cells is None else body.nodes
            low = np.minimum(low, np.nanmin(x - half, axis=0))
            high = np.maximum(high, np.nanmax(x + half, axis=0))
    if run.frame == "axisymmetric":
        low[0] = -high[0]
    return np.array([low[0], high[0], low[2], high[2]]) / mm


def set_box(axes, box, margin=0.06):
    pad = margin * max(box[1] - box[0], box[3] - box[2])
    axes.set_xlim(box[0] - pad, box[1] + pad)
    axes.set_ylim(box[2] - pad, box[3] + pad)


def view_from_outside(axes, bodies, colouring, mm, azimuth=-60.0, elevation=22.0):
    """Orthographic picture with light from the viewer's left: nearest point per pixel, normals from
    the depths, which are smoothed over the lattice of points."""
    a, e = math.radians(azimuth), math.radians(elevation)
    towards = np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])
    right = np.array([-math.sin(a), math.cos(a), 0.0])
    up = np.cross(towards, right)
    if all(body.cells is not None for body in bodies):
        draw_surfaces(axes, bodies, colouring, mm, np.array([right, up, towards]))
        return
    x = np.concatenate([b.x for b in bodies])
    side = np.concatenate([b.side for b in bodies])
    rgba = np.concatenate([colouring.of(b) for b in bodies])
    u, v, depth = x @ right, x @ up, x @ towards
    pad = 2 * side.max()
    pixel = max(np.ptp(u), np.ptp(v), 1e-300) / 900
    shape = (int((np.ptp(v) + 2 * pad) / pixel) + 2, int((np.ptp(u) + 2 * pad) / pixel) + 2)
    order = np.argsort(depth)
    nearest, key = stamp((u - u.min() + pad) / pixel, (v - v.min() + pad) / pixel,
                         np.ceil(0.6 * side / pixel), shape, order, lambda p, r, c: -depth[p])
    hit = nearest >= 0
    smooth, reach = np.where(hit, -key, 0.0), int(np.ceil(1.2 * np.median(side) / pixel))
    for _ in range(3):  # the lattice of points would show as steps; only pixels of bodies count
        smooth = np.where(hit, box_mean(smooth, reach) / np.maximum(box_mean(hit * 1.0, reach), 1e-9), 0)
    slope_v, slope_u = np.gradient(smooth, pixel)
    normal = np.stack([-slope_u, -slope_v, np.ones(shape)], -1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    light = np.clip(normal @ np.array([-0.45, 0.35, 0.82]), 0, 1)
    image = np.ones(shape + (4,))
    image[hit] = rgba[nearest[hit]]
    image[hit, :3] *= (0.7 + 0.3 * light[hit])[:, None]
    extent = np.array([u.min() - pad, u.min() - pad + shape[1] * pixel,
                       v.min() - pad, v.min() - pad + shape[0] * pixel]) / mm
    axes.imshow(image, origin="lower", extent=extent, interpolation="antialiased")
    axes.set_axis_off()


# ------------------------------------------------------------------------------------------ measures

def position_of(measure):
    at = measure.get("at")
    if isinstance(at, dict):
        at = next(iter(at.values()), None)
    return at if isinstance(at, (int, float)) else None


def reference_of(measure):
    """Value and source of a measure's reference; value None when there is none."""
    reference = measure.get("reference")
    if not isinstance(reference, dict):
        reference = {"value": reference}
    value = reference.get("value")
    return (value if isinstance(value, (int, float)) else None), str(reference.get("source") or "reference")


def line(axes, x, z, reference=False, style="-", **options):
    """Black for what was computed, coloured and dashed for a reference; a white rim on any ground."""
    colour = {"color": REFERENCE, "lw": 2.4, "dashes": (2.5, 1)} if reference else \
        {"color": "black", "lw": 1.6}
    rim = patheffects.withStroke(linewidth=4, foreground="white", alpha=0.75)
    axes.plot(x, z, "--" if reference else style, path_effects=[rim], clip_on=False, **colour, **options)


def draw_diameter(axes, centre, z, value, wanted, height):
    line(axes, [centre - value / 2, centre + value / 2], [z, z], style="|-", ms=13, mew=1.8)
    for side in (-0.5, 0.5) if wanted is not None else ():
        line(axes, [centre + side * wanted] * 2, [z - 0.035 * height, z + 0.035 * height], True)


def draw_measure(axes, run, bodies, measure, box, mm):
    """Draws one measure if it is a length that can be shown, and returns its height in the picture."""
    # Of several bodies, a piece or a past extreme: not to be seen in this picture.
    if not isinstance(measure.get("body", ""), str) or measure.get("piece") or measure.get("keep"):
        return None
    mine = [b for b in bodies if b.name == measure.get("body", b.name)]
    if measure.get("unit") != "m" or not mine:
        return None
    points = np.concatenate([b.x for b in mine]) / mm
    half = 0.5 * np.concatenate([b.side for b in mine]) / mm
    value, wanted = measure["value"] / mm, reference_of(measure)[0]
    wanted = wanted / mm if wanted is not None else None
    kind = measure.get("kind")
    at = position_of(measure) if kind == "diameter" else None
    if kind == "largest_diameter":  # where it was found is not told: at the widest row of points
        low = points[points[:, 2] <= points[:, 2].min() + measure.get("within", np.inf) / mm]
        at = mm * low[np.argmax(np.abs(low[:, 0] - points[:, 0].mean() * (run.frame != "axisymmetric"))), 2]
    if at is not None:
        z = at / mm
        cut = [at / mm for axis, at, _ in run.planes
               if axis == 0 and np.abs(points[:, 0] - at / mm).min() < 2 * np.median(half)]  # half a body is drawn
        centre = cut[0] if cut else 0.5 * (points[:, 0].min() + points[:, 0].max())
        draw_diameter(axes, centre, z, value, wanted, box[3] - box[2])
        return z
    if kind not in ("extent", "max", "min") or measure.get("axis", "z") != "z":
        return None
    floor = max((at / mm for axis, at, inside in run.planes if (axis, inside) == (2, 1)), default=-np.inf)
    base = max(np.min(points[:, 2] - half), floor) if kind == "extent" else 0.0
    line(axes, box[:2], [base + value] * 2)
    if wanted is not None:
        line(axes, box[:2], [base + wanted] * 2, True)
    return base + value


def draw_measures(axes, run, bodies, box, mm, unit):
    """Computed lengths as black lines with caps, references as dashed marks, a label for each."""
    labels, sources = [], []
    for name, measure in (run.summary.get("measures") or {}).items():
        if not isinstance(measure, dict) or not isinstance(measure.get("value"), (int, float)):
            continue
        z = draw_measure(axes, run, bodies, measure, box, mm)
        if z is None:
            continue
        value, (wanted, source) = measure["value"], reference_of(measure)
        text = f"{name.replace('_', ' ')}\n{value / mm:#.5g} {unit}"
        if wanted:
            text += f"\nreference {wanted / mm:#.5g} {unit} ({100 * (value / wanted - 1):+.1f} %)"
            sources.append(source)
        labels.append((z, text))
    place_labels(axes, labels)
    if labels:
        axes.plot([], [], "-", color="black", label="computed")
    for source in dict.fromkeys(sources):
        axes.plot([], [], "--", color=REFERENCE, lw=2, label=textwrap.fill("reference: " + source, 60))
    if labels:
        axes.legend(loc="upper left", bbox_to_anchor=(0, -0.95 / axes.bbox.height * axes.figure.dpi),
                    frameon=False, fontsize=10, borderaxespad=0)


def place_labels(axes, labels):
    """Texts right of the axes at their heights, moved apart where they would overlap."""
    low, high = axes.get_ylim()
    floor = -1.0
    for z, text in sorted(labels):
        at = (z - low) / (high - low)
        floor = max(at, floor + 0.115)
        axes.annotate(text, xy=(1.0, at), xytext=(1.06, floor), xycoords="axes fraction", va="center",
                      fontsize=10.5, arrowprops={"arrowstyle": "-", "color": "0.4", "lw": 0.8,
                                                 "relpos": (0, 0.5)})
