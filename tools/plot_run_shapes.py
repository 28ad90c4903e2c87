# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawing the shapes of the bodies of a run, for tools/plot_run."""

import math
import textwrap

import numpy as np
from matplotlib import cm, colormaps, colors, patches, patheffects

from plot_run_elements import draw_elements, draw_surfaces
from plot_run_raster import box_mean, stamp
from plot_run_section import Section
from run_reader import reference_error, reference_of, uncertainty_of
from units import quantity, scale_of

ABSENT = -1e300
REFERENCE = "#d6006c"  # far from every colour of the maps below


SIGNED = ("pressure", "stress_", "velocity_", "deviatoric_stress_", "strain_")  # white at zero
FIRST_CHOICE = ("plastic_strain", "pressure", "density", "temperature")
BODY_COLOURS = ["#4c78a8", "#f58518", "#54a24b", "#b279a2", "#e45756", "#72b7b2", "#eeca3b", "#9d755d", "#79706e"]
MOST_NAMES = 11  # in a legend


class BodyColours:
    """Every body in a colour of its own."""

    field = "body"

    def __init__(self, names):
        self.names = names

    def colour(self, name):
        return BODY_COLOURS[self.names.index(name) % len(BODY_COLOURS)]

    def values(self, body):
        return np.full(len(body.x), float(self.names.index(body.name)))

    def rgba(self, values):
        table = np.array([colors.to_rgba(BODY_COLOURS[n % len(BODY_COLOURS)]) for n in range(len(self.names))])
        return table[np.clip(np.rint(values).astype(int), 0, len(table) - 1)]

    def of(self, body):
        return self.rgba(self.values(body))

    def handles(self, label=str):
        """For a legend."""
        found = [patches.Patch(color=self.colour(name), label=label(name)) for name in self.names[:MOST_NAMES]]
        if len(self.names) > MOST_NAMES:
            found.append(patches.Patch(color="none", label=f"and {len(self.names) - MOST_NAMES} more bodies"))
        return found


class Spread:
    """What the values of a field span over frames."""

    def __init__(self, field, run=None, numbers=()):
        self.field, self.unit = field, ""
        self.low, self.high, self.top = math.inf, -math.inf, 0.0
        for number in numbers:
            for body in run.bodies(number):
                self.add(body)

    def add(self, body):
        values = body.values(self.field)
        if values is None:
            return
        self.unit = str(body.unit(self.field))
        values = values[np.isfinite(values)]
        if len(values):
            self.low, self.high = min(self.low, float(values.min())), max(self.high, float(values.max()))
            self.top = max(self.top, float(np.quantile(np.abs(values), 0.999)))

    @property
    def signed(self):
        return self.field.startswith(SIGNED) and self.low < 0

    def limits(self):
        """Where the scale of a picture begins and ends: single points beyond it do not set it."""
        if self.low > self.high:
            return 0.0, 1.0
        if self.signed:
            return -self.top, self.top
        if self.low >= 0 and self.low < 0.5 * self.high:
            return 0.0, max(min(self.high, 1.25 * self.top), 1e-12)
        return self.low, max(self.high, self.low + 1e-300)


class Colouring:
    """One field with one scale for all pictures of a run."""

    def __init__(self, run, numbers, field=None, span=None):
        """`span`: texts of the least and the largest value, as "0", "20 GPa"; else all times of `numbers` set them."""
        self.field = field or next((name for name in FIRST_CHOICE if name in run.fields()), None)
        self.norm, self.factor, self.label, self.extend = colors.Normalize(0, 1), 1.0, "", "neither"
        self.map = colormaps["viridis"]
        if self.field is None:
            return
        spread = Spread(self.field, run, numbers)
        low, high = spread.limits() if span is None else (quantity(end, spread.unit) for end in span)
        if not low < high:
            raise ValueError(f"'{span[0]}' is not below '{span[1]}'")
        self.factor, text = scale_of(max(abs(low), abs(high)), spread.unit)
        if spread.signed and low == -high:
            self.map = colormaps["RdBu_r"]
        self.norm = colors.Normalize(low / self.factor, high / self.factor)
        above, below = spread.high > high, spread.low < low
        self.extend = ("both" if below else "max") if above else ("min" if below else "neither")
        self.label = self.field.replace("_", " ") + (f" [{text}]" if text else "")
        if above:
            self.label += f", largest {spread.high / self.factor:.3g}"

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
    """Elements as they are; points where there is material (plot_run_section), debris no smaller than three pixels."""
    for body in bodies:
        if body.cells is not None:
            draw_elements(axes, run, body, colouring, mm)
    axes.set_aspect("equal")
    bodies = [body for body in bodies if body.cells is None]
    if not bodies:
        return
    window = axes.get_window_extent()
    drawn = max((box[1] - box[0]) / window.width, (box[3] - box[2]) / window.height) * mm
    section = Section(run, bodies, box * mm, pixels, [colouring.values], least=3.0, drawn=drawn)
    image, there = np.ones(section.cover.shape + (4,)), section.which >= 0
    image[there] = colouring.rgba(section.values[0][there])
    axes.imshow(image, origin="lower", extent=section.raster.extent(mm), interpolation="antialiased")


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
        band = uncertainty_of(measure)
        text = f"{name.replace('_', ' ')}\n{value / mm:#.5g}" + ("" if band is None else f" ± {band / mm:.2g}") + f" {unit}"
        if wanted:
            bar = "" if reference_error(measure) is None else f" ± {reference_error(measure) / mm:.2g}"
            text += f"\nreference {wanted / mm:#.5g}{bar} {unit} ({100 * (value / wanted - 1):+.1f} %)"
            sources.append(source)
        labels.append((z, text))
    place_labels(axes, labels)
    if labels:
        axes.plot([], [], "-", color="black", label="computed")
    if sources:
        told = "\n".join(textwrap.fill(source, 72, subsequent_indent="  ") for source in dict.fromkeys(sources))
        axes.plot([], [], "--", color=REFERENCE, lw=2, label="reference: " + told)
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
