# SPDX-License-Identifier: GPL-3.0-or-later
"""The film of tools/report: sections of a run as compact arrays that the page colours itself.

A page could hold pictures, or the points. Pictures fix field and colours (30 times x 8 fields are 240 of them); points grow
with the run, and leave gaps where material is strained. So it holds rasters, a few pixels to the cell: of each time the
volume fraction and the body, of each field its value in 255 steps between that frame's least and largest. The volume
fraction is smooth, so the page draws a sharp surface (1/2) at any size of the window. Rows as differences, deflated: about a
third of a byte a pixel, whatever the number of points.
"""

import base64
import zlib

import numpy as np

from plot_run_section import Section
from plot_run_shapes import Spread, limits
from units import scale_of

MOST_FIELDS = 8
LIKED = ["plastic_strain", "pressure", "von_mises", "speed", "temperature", "damage", "density", "burn_fraction", "failed",
         "internal_energy"]
DULL = {"mass", "level", "sound_speed", "carried_energy", "viscous_pressure", "stress", "velocity"}
FAINT = 0.02  # volume fraction from which on a pixel belongs to a body: beyond 1/2, for the page to draw the surface


def packed(array):
    """Bytes of a raster: differences along rows, deflated, as text."""
    array = np.ascontiguousarray(array, dtype=np.uint8)
    left = np.zeros_like(array)
    left[:, 1:] = array[:, :-1]
    return base64.b64encode(zlib.compress((array - left).tobytes(), 9)).decode("ascii")


def quantised(values, there):
    """(least, largest, bytes): 0 where there is no value, else 1 to 255 between the two."""
    good = there & np.isfinite(values)
    if not good.any():
        return [0.0, 0.0, packed(np.zeros(values.shape))]
    low, high = float(values[good].min()), float(values[good].max())
    scaled = 1 + 254 * (np.where(good, values, low) - low) / ((high - low) or 1.0)
    return [float(f"{low:.6g}"), float(f"{high:.6g}"), packed(np.where(good, np.rint(scaled), 0))]


def evenly(numbers, most):
    """So many of a list, the first and the last among them."""
    picks = np.unique(np.linspace(0, len(numbers) - 1, min(most, len(numbers))).round().astype(int))
    return [numbers[k] for k in picks]


def choose_fields(run, numbers, asked):
    """Names of the fields of the film; those that say nothing (one value everywhere) are left out unless asked."""
    for name in asked or ():
        run.require_field(name)
    if asked:
        return asked
    names = []
    for name in [n for n in LIKED if n in run.fields()] + [n for n in run.fields() if n not in LIKED and n not in DULL]:
        span = Spread(name, run, numbers)
        if span.high > span.low:
            names.append(name)
        if len(names) == MOST_FIELDS:
            break
    return names


def film(run, options, pixels):
    """Everything that the page needs to play one run: see the module's text."""
    shown = run.shown()
    if not shown:
        return None
    numbers = evenly(shown, options.frames)
    spans = {name: Spread(name) for name in choose_fields(run, evenly(shown, 3), options.fields)}
    box = limits(run, numbers, 1.0)
    mirrored = run.frame == "axisymmetric"
    if mirrored:
        box[0] = 0.0
    side = np.sqrt((box[1] - box[0]) * (box[3] - box[2]))  # so that as many pixels serve a rod and a plate
    across = pixels * max(box[1] - box[0], box[3] - box[2]) / side
    names, frames = run.names, []
    for number in numbers:
        frames.append(frame_of(run, number, box, across, spans, names))
    return {"frame": run.frame, "axes": run.axis_names(), "mirrored": mirrored, "bodies": names,
            "fields": {name: field_of(span) for name, span in spans.items()}, **frames[0].pop("place"),
            "section": None if run.frame != "3d" else [run.normal, run.section_y],
            "frames": [{k: v for k, v in frame.items() if k != "place"} for frame in frames]}


def field_of(span):
    low, high = span.limits()
    divisor, unit = scale_of(max(abs(low), abs(high)), span.unit)
    return {"low": low, "high": high, "divisor": divisor, "unit": unit, "signed": span.signed}


def frame_of(run, number, box, across, spans, names):
    bodies = run.bodies(number)
    for span in spans.values():
        for body in bodies:
            span.add(body)
    section = Section(run, bodies, box, across, [lambda body, name=name: body.values(name) for name in spans],
                      least=2.0, half=FAINT)
    raster = section.raster
    low = raster.low + 0.0
    first = 0
    if box[0] == 0.0 and run.frame == "axisymmetric":  # the other half is the image of this one
        first = int(round(-low[0] / raster.pixel))
    inside = (slice(None), slice(first, None))
    there = section.which[inside] >= 0
    body = np.array([names.index(b.name) + 1 for b in bodies] + [0])
    cover = np.clip(np.rint(128 + 4 * 127 * (section.cover[inside] - 0.5)), 0, 255)
    return {"place": {"low": [float(low[0] + first * raster.pixel), float(low[1])], "pixel": float(raster.pixel),
                      "rows": int(raster.shape[0]), "columns": int(raster.shape[1] - first)},
            "time": run.time(number), "cover": packed(np.where(there, cover, 0)),
            "body": packed(np.where(there, body[section.which[inside]], 0)),
            "values": [quantised(values[inside], there) for values in section.values]}


def curve(time, values, most=700):
    """[times, values] with no more than so many points: of each stretch its least and its largest."""
    good = np.isfinite(time) & np.isfinite(values)
    time, values = time[good], values[good]
    if len(time) > most:
        kept = {0, len(time) - 1}
        for part in np.array_split(np.arange(len(time)), most // 2):
            kept |= {int(part[np.argmin(values[part])]), int(part[np.argmax(values[part])])}
        kept = sorted(kept)
        time, values = time[kept], values[kept]
    return [[float(f"{t:.6g}") for t in time], [float(f"{v:.6g}") for v in values]]
