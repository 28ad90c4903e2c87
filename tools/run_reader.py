# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading the results folder of a run: frames and their fields, history, gauges, summary. For every tool that draws.

    run = Run("taylor_copper_out")
    run.title(), run.frame, run.summary, run.history["kinetic_energy"]      # (unit, values)
    for body in run.bodies(run.numbers[-1]):
        body.name, body.x, body.values("pressure"), body.values("velocity_z"), body.values("speed")

All numbers are SI. What is asked for and is not there is an `Unknown` with what is there and what to do.
"""

import csv
import ctypes
import difflib
import glob
import json
import math
import os
import shlex
import sys

import h5py
import numpy as np

import plot_run_levels as levels
from plot_run_raster import closed_planes
from units import quantity, said

def keep_memory():
    """Arrays that are freed stay with the process: asking the system for fresh pages costs more than filling them."""
    try:
        libc = ctypes.CDLL(None)
        libc.mallopt(-3, 1 << 30)  # M_MMAP_THRESHOLD
        libc.mallopt(-1, (1 << 31) - 1)  # M_TRIM_THRESHOLD
    except (OSError, AttributeError):  # another C library
        pass


NO_FIELDS = {"id", "coordinates", "cells", "connectivity", "nodes"}
TENSOR, VECTOR = 6, 3
CUT = {"y": (0, 1, 2), "x": (1, 0, 2), "z": (0, 2, 1)}  # columns of a picture: across, along the normal, up
AXES = {"axisymmetric": "rtz", "plane_strain": "xyz", "3d": "xyz"}


class Unknown(Exception):
    """Something was asked for that the run does not have."""


def frame_of(summary, x):
    return str(summary.get("frame") or ("3d" if np.abs(x[:, 1]).max(initial=0) > 0 else "plane_strain"))


# ------------------------------------------------------------------------------------------ fields

def find_field(group, name):
    """(unit, values) of a field of a body, derived where it is a part of what was written; None where it is not there.

    NAME of a scalar; NAME_zz, NAME_z a component; of a vector its size, of a stress sqrt(3/2 s:s); `speed`."""
    if name == "speed" and "speed" not in group:
        name = "velocity"
    if name in group and name not in NO_FIELDS:
        data = group[name]
        unit, values = str(data.attrs.get("unit", "1")), data[()]
        if values.ndim == 1:
            return unit, values
        if values.shape[1] == VECTOR:
            return unit, np.linalg.norm(values, axis=1)
        if values.shape[1] == TENSOR:
            diagonal = values[:, :3] - values[:, :3].mean(axis=1, keepdims=True)
            return unit, np.sqrt(1.5 * ((diagonal ** 2).sum(axis=1) + 2 * (values[:, 3:] ** 2).sum(axis=1)))
        return None
    stem, _, component = name.rpartition("_")
    if stem in group and stem not in NO_FIELDS:
        names = [str(n) for n in group[stem].attrs.get("component_names", [])]
        if component in names:
            return str(group[stem].attrs.get("unit", "1")), group[stem][:, names.index(component)]
    return None


def offered(group):
    """Names of the fields that a body can show, without those of components."""
    names = [name for name in group if name not in NO_FIELDS and group[name].ndim <= 2
             and (group[name].ndim == 1 or group[name].shape[1] in (1, VECTOR, TENSOR))]
    return ["speed" if name == "velocity" else name for name in names]


def components(group):
    """As velocity_z, of what has components."""
    return [f"{name}_{part}" for name in group if name not in NO_FIELDS
            for part in group[name].attrs.get("component_names", [])]


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
        """Of the points as they are drawn; None in a body without the field."""
        found = find_field(self.fields, field)
        if found is None:
            return None
        values = found[1][self.kept]
        return values if self.parts is None else values[self.parts]

    def unit(self, field):
        found = find_field(self.fields, field)
        return found[0] if found else None

    def turn(self, columns):
        """Exchanges the axes, so that column 1 is along the normal of the section."""
        self.x, self.whole = self.x[:, columns], self.whole[:, columns]
        if self.nodes is not None:
            self.nodes = self.nodes[:, columns]


# ------------------------------------------------------------------------------------------ run

class Run:
    def __init__(self, folder):
        self.folder = folder
        try:
            with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
                self.summary = json.load(file)
        except (OSError, ValueError) as error:
            print(f"{os.path.basename(sys.argv[0])}: no summary ({error})", file=sys.stderr)
            self.summary = {}
        self.file = h5py.File(os.path.join(folder, "frames.h5"), "r")
        self.numbers = sorted(self.file["frames"])
        if not self.numbers:
            raise OSError("no frame in frames.h5")
        if "frame" not in self.summary and "frame_of_reference" in self.file.attrs:
            self.summary["frame"] = self.file.attrs["frame_of_reference"]
        self.names = sorted({name for number in (self.numbers[0], self.numbers[-1]) for name in self.file["frames"][number]})
        self.only, self.normal = None, "y"
        start = [b.x for b in self.bodies(self.numbers[0])]
        x = np.concatenate(start) if start else np.zeros((0, 3))
        self.frame = frame_of(self.summary, x)
        self.summary["frame"] = self.frame
        self.history = read_history(os.path.join(folder, "history.csv"))
        self.start_planes = self.planes = closed_planes(folder)
        self.start_low, self.start_high = (x.min(axis=0), x.max(axis=0)) if len(x) else (np.zeros(3), np.zeros(3))
        self.section_y = self.middle(1)

    def middle(self, axis):
        """Place of a section: 0 where the bodies reach it, else their middle."""
        low, high = self.start_low[axis], self.start_high[axis]
        return 0.0 if low <= 0 <= high or (axis, 0.0, 1) in self.start_planes else 0.5 * (low + high)

    def cut(self, normal, at=None):
        """Takes the section across `normal` (x, y or z), at its middle where no place is told."""
        if self.frame != "3d":
            raise Unknown(f"section: a run in {self.frame.replace('_', ' ')} is a section already; leave --section out")
        if normal not in CUT:
            raise Unknown(f"section: no axis '{normal}'; write it as y=0 or z=5mm")
        axis = "xyz".index(normal)
        low, high = self.reach(axis)
        if at is not None and not low <= at <= high:
            raise Unknown(f"section {normal} = {said(at, 'm')}: no material there at any time; the bodies reach from "
                          f"{said(low, 'm')} to {said(high, 'm')}")
        self.normal, self.section_y = normal, self.middle(axis) if at is None else at
        place = [CUT[normal].index(k) for k in range(3)]
        self.planes = [(place[k], plane, inside) for k, plane, inside in self.start_planes]

    def cut_at(self, text):
        """As `cut`, of "z" or "z=5mm"."""
        normal, _, place = text.partition("=")
        try:
            at = quantity(place, "m") if place else None
        except ValueError as error:
            raise Unknown(f"section: {error}") from None
        self.cut(normal.strip(), at)

    def reach(self, axis):
        found = [group[name]["coordinates"][:, axis] for number in (self.numbers[0], self.numbers[-1])
                 for group in (self.file["frames"][number],) for name in group if len(group[name]["id"])]
        return min(map(np.nanmin, found)), max(map(np.nanmax, found))

    def axis_names(self):
        """Across and up in a picture."""
        names = AXES.get(self.frame, "xyz")
        return names[CUT[self.normal][0]], names[CUT[self.normal][2]]

    def time(self, number):
        return float(self.file["frames"][number].attrs["time"])

    def bodies(self, number):
        group = self.file["frames"][number]
        bodies = [Body(name, group[name], self.summary) for name in group
                  if len(group[name]["id"]) and (self.only is None or name in self.only)]
        bodies = [body for body in bodies if len(body.x)]
        self.finest = levels.spread(bodies)
        if self.normal != "y":
            for body in bodies:
                body.turn(CUT[self.normal])
        return bodies

    def shown(self):
        """Frames that hold anything of the bodies that are drawn."""
        return [number for number in self.numbers
                if any(len(self.file["frames"][number][name]["id"]) for name in self.file["frames"][number]
                       if self.only is None or name in self.only)]

    def choose_bodies(self, names):
        unknown = [name for name in names if name not in self.names]
        if unknown:
            raise Unknown(f"no body '{unknown[0]}' in {self.folder} (there are: {', '.join(self.names)})")
        self.only = set(names)

    def fields(self):
        """Names of what was written, over all bodies that are drawn, in the order of the files."""
        found = {}
        for number in (self.numbers[0], self.numbers[-1]):
            for name, group in self.file["frames"][number].items():
                if self.only is None or name in self.only:
                    found.update(dict.fromkeys(offered(group)))
        return list(found)

    def require_field(self, name):
        groups = [group for number in (self.numbers[0], self.numbers[-1])
                  for body, group in self.file["frames"][number].items() if self.only is None or body in self.only]
        if any(find_field(group, name) for group in groups):
            return
        parts = sorted({part for group in groups for part in components(group)})
        near = difflib.get_close_matches(name, [*self.fields(), *parts], 1, 0.75)
        remedy = f"Did you mean {near[0]}?" if near else f"Where a law of the scene keeps it, `output: {{fields: [{name}]}}` writes " \
            "it: add that and run again (`krater models` lists what laws keep)"
        raise Unknown(f"no field '{name}' was written to {self.folder}. {remedy} Written: {', '.join(self.fields())}; components: "
                      f"{', '.join(parts)}")

    def at(self, text):
        """Number of the frame at a time: `first`, `last`, or the nearest to "30 us"."""
        shown = self.shown() or self.numbers
        if text in ("first", "last"):
            return shown[0 if text == "first" else -1]
        try:
            wanted = quantity(text, "s")
        except ValueError as error:
            raise Unknown(f"time: {error}, or `first`, `last`") from None
        times = np.array([self.time(number) for number in shown])
        gap = 0.5 * np.diff(times).max() if len(times) > 1 else 0
        if not times[0] - gap - 1e-12 <= wanted <= times[-1] + gap + 1e-12:
            raise Unknown(f"time {said(wanted, 's')}: {self.folder} has {len(times)} frames from {said(times[0], 's')} to "
                          f"{said(times[-1], 's')}; a longer run needs `time: {{end: ...}}` of the scene "
                          "(krater run --restart goes on from where it ended)")
        return shown[int(np.argmin(np.abs(times - wanted)))]

    def set_values(self):
        """What `--set` changed: ["frame=3d", ...], from summary.json or the first line of the log."""
        told = (self.summary.get("machine") or {}).get("set")
        if told is not None:
            return [str(text) for text in told]
        words = shlex.split(self.command() or "")
        return [words[k + 1] for k, word in enumerate(words[:-1]) if word == "--set"]

    def command(self):
        told = (self.summary.get("machine") or {}).get("command")
        if told:
            return str(told)
        try:
            with open(os.path.join(self.folder, "log.txt"), encoding="utf-8") as file:
                return file.readline().partition("threads: ")[2].strip()
        except OSError:
            return ""

    def title(self):
        """The scene's own, and what `--set` made other than it says."""
        title = str(self.summary.get("title") or os.path.basename(os.path.abspath(self.folder)))
        changed = [text for text in self.set_values() if not text.startswith(("title=", "output.", "time.checkpoint", "time.energy_error"))]
        return title + (" · with " + ", ".join(changed) if changed else "")


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


def read_gauges(folder):
    """name -> columns as those of a history."""
    return {os.path.basename(path)[len("gauge_"):-len(".csv")]: read_history(path)
            for path in sorted(glob.glob(os.path.join(glob.escape(folder), "gauge_*.csv")))}


def reference_of(measure):
    """Value and source of a measure's reference; value None when there is none."""
    reference = measure.get("reference")
    if not isinstance(reference, dict):
        reference = {"value": reference}
    value = reference.get("value")
    return (value if isinstance(value, (int, float)) else None), str(reference.get("source") or "reference")


def uncertainty_of(measure):
    """Half the band that a study found for a measure, or None."""
    band = measure.get("uncertainty")
    return band if isinstance(band, (int, float)) else None


def reference_error(measure):
    """Half the bar that the source of a measure's reference gives, or None."""
    reference = measure.get("reference")
    error = reference.get("error") if isinstance(reference, dict) else None
    return error if isinstance(error, (int, float)) else None
