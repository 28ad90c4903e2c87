#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the structure of a results folder; prints what is wrong and returns 1, or nothing and 0.

frames.xmf is XML whose every reference leads to an HDF5 array of the stated shape and number type with
finite values, and which says nothing that frames.h5 does not; history.csv is a table with times that
increase, history.h5 is the same table; summary.json is JSON. NaN is the documented value of a measure
that selects no point. Fields that may be infinite or NaN on purpose are named with --allow-nonfinite.
"""

import argparse
import csv
import json
import math
import os
import sys
import xml.etree.ElementTree as ET

import h5py
import numpy as np

NUMBER_TYPES = {("Float", 8): "f8", ("Float", 4): "f4", ("Int", 8): "i8", ("Int", 4): "i4"}
COMPONENTS = {"Scalar": 1, "Vector": 3, "Tensor": 9}
CORNERS = {"Polyvertex": 1, "Quadrilateral": 4, "Hexahedron": 8}


def sizes(text):
    return tuple(int(n) for n in text.split())


class Checker:
    def __init__(self, folder, allowed, killed):
        self.folder = folder
        self.killed = killed
        self.allowed = allowed
        self.errors = []
        self.files = {}
        self.count = 0
        self.measures = set()  # columns that may be NaN: nothing was selected

    def error(self, message):
        self.errors.append(message)

    def path(self, name):
        return os.path.join(self.folder, name)

    def open_file(self, name):
        if name not in self.files:
            self.files[name] = h5py.File(self.path(name), "r")
        return self.files[name]

    # ------------------------------------------------------------------------------------- frames

    def array(self, item, name):
        """The array a <DataItem> stands for, or None with the reason recorded."""
        if item.get("ItemType") == "HyperSlab":
            return self.slab(item, name)
        reference = (item.text or "").strip()
        file_name, _, path = reference.partition(":")
        try:
            dataset = self.open_file(file_name)[path]
        except (OSError, KeyError) as error:
            return self.error(f"frames.xmf: {reference}: {error}")
        kind = NUMBER_TYPES.get((item.get("NumberType"), int(item.get("Precision", 4))))
        if sizes(item.get("Dimensions", "")) != dataset.shape:
            return self.error(f"frames.xmf: {reference}: {item.get('Dimensions')} stated, "
                              f"shape is {dataset.shape}")
        if kind is None or dataset.dtype != np.dtype("<" + kind):
            return self.error(f"frames.xmf: {reference}: {item.get('NumberType')} "
                              f"{item.get('Precision')} stated, type is {dataset.dtype}")
        values = dataset[()]
        if name not in self.allowed and not np.isfinite(values).all():
            bad = int(np.count_nonzero(~np.isfinite(values)))
            self.error(f"{reference}: {bad} values are not finite")
        self.count += 1
        return values

    def slab(self, item, name):
        parts = item.findall("DataItem")
        if len(parts) != 2:
            return self.error("frames.xmf: a HyperSlab needs two DataItems")
        start, stride, extent = np.array(sizes(parts[0].text or "")).reshape(3, -1)
        values = self.array(parts[1], name)
        if values is None:
            return None
        if (start + stride * (extent - 1) >= values.shape).any():
            return self.error(f"frames.xmf: {name}: HyperSlab outside of its array")
        index = tuple(slice(b, b + s * n, s) for b, s, n in zip(start, stride, extent))
        values = values[index].reshape(sizes(item.get("Dimensions", "")))
        return values

    def grid(self, grid):
        """One body in one frame."""
        body = grid.get("Name")
        topology, geometry = grid.find("Topology"), grid.find("Geometry")
        corners = CORNERS.get(topology.get("TopologyType")) if topology is not None else None
        if corners is None or geometry is None:
            return self.error(f"frames.xmf: {body}: a topology of {', '.join(CORNERS)} and a geometry expected")
        rows = {"Cell": int(topology.get("NumberOfElements", -1))}
        coordinates = self.array(geometry.find("DataItem"), "coordinates")
        if coordinates is not None and coordinates.shape[1:] != (3,):
            self.error(f"frames.xmf: {body}: coordinates have shape {coordinates.shape}")
        rows["Node"] = rows["Cell"] if corners == 1 or coordinates is None else len(coordinates)
        self.cells(body, self.array(topology.find("DataItem"), "cells"), corners, rows)
        names = set()
        for attribute in grid.findall("Attribute"):
            name, kind, centre = attribute.get("Name"), attribute.get("AttributeType"), attribute.get("Center")
            if (name, centre) in names:
                self.error(f"frames.xmf: {body}: {name} twice")
            names.add((name, centre))
            if centre not in rows or kind not in COMPONENTS:
                self.error(f"frames.xmf: {body}: {name}: unknown centre or type")
                continue
            values = self.array(attribute.find("DataItem"), name)
            wanted = (rows[centre],) if kind == "Scalar" else (rows[centre], COMPONENTS[kind])
            if values is not None and values.shape != wanted:
                self.error(f"frames.xmf: {body}: {name} is {kind} at each {centre} but has shape {values.shape}")
        if ("id", "Node" if corners == 1 else "Cell") not in names:
            self.error(f"frames.xmf: {body}: no id")
        return None

    def cells(self, body, cells, corners, rows):
        """A vertex per point, or corners that are nodes, each used by some cell and none twice by one."""
        if cells is None:
            return
        if corners == 1:
            if not np.array_equal(cells, np.arange(rows["Cell"])):
                self.error(f"frames.xmf: {body}: cells are not 0 ... {rows['Cell'] - 1}")
        elif cells.shape != (rows["Cell"], corners):
            self.error(f"frames.xmf: {body}: cells of shape {cells.shape}")
        elif not np.array_equal(np.unique(cells), np.arange(rows["Node"])):
            self.error(f"frames.xmf: {body}: cells do not use the nodes 0 ... {rows['Node'] - 1}")
        elif (np.diff(np.sort(cells, axis=1), axis=1) == 0).any():
            self.error(f"frames.xmf: {body}: a cell has a node twice")

    def index(self, times):
        """frames.h5 leads to the same frames as frames.xmf; every field says its unit and meaning."""
        frames = self.open_file("frames.h5")["frames"]
        ahead = len(frames) - len(times)
        if ahead != 0 and not (self.killed and ahead == 1):  # frames.h5 is replaced before frames.xmf
            self.error(f"frames.h5 has {len(frames)} frames, frames.xmf {len(times)}")
        for name, time in zip(sorted(frames), times):
            frame = frames[name]
            if frame.attrs["time"] != time:
                self.error(f"frame {name}: time {frame.attrs['time']}, in frames.xmf {time}")
            for body in frame.values():
                if len(np.unique(body["id"][()])) != len(body["id"]):
                    self.error(f"{body.name}: an id occurs twice")
                for field in [*body.values(), *body.get("nodes", {}).values()]:
                    if isinstance(field, h5py.Dataset):
                        self.attributes(field)

    def attributes(self, field):
        if field.name.endswith("/cells"):
            return
        for attribute in ("unit", "meaning"):
            if not isinstance(field.attrs.get(attribute), str):
                self.error(f"{field.file.filename}:{field.name}: no {attribute}")
        names = field.attrs.get("component_names", [])
        if len(names) and (field.ndim != 2 or len(names) != field.shape[1]):
            self.error(f"{field.file.filename}:{field.name}: {len(names)} names of components, "
                       f"shape {field.shape}")

    def frames(self):
        try:
            root = ET.parse(self.path("frames.xmf")).getroot()
        except (OSError, ET.ParseError) as error:
            return self.error(f"frames.xmf: {error}")
        series = root.find("Domain/Grid")
        if root.tag != "Xdmf" or series is None or series.get("CollectionType") != "Temporal":
            return self.error("frames.xmf: no temporal collection")
        times = []
        for frame in series.findall("Grid"):
            times.append(float(frame.find("Time").get("Value")))
            for grid in frame.findall("Grid"):
                self.grid(grid)
        if not times:
            self.error("frames.xmf: no frame")
        if any(b <= a for a, b in zip(times, times[1:])):
            self.error(f"frames.xmf: times do not increase: {times}")
        try:
            self.index(times)
        except (OSError, KeyError) as error:
            self.error(f"frames.h5: {error}")
        return None

    # ------------------------------------------------------------------------- history, summary

    def history(self):
        try:
            with open(self.path("history.csv"), newline="", encoding="utf-8") as file:
                rows = list(csv.reader(file))
        except OSError as error:
            return self.error(f"history.csv: {error}")
        if len(rows) < 2 or rows[0][0] != "time [s]":
            return self.error("history.csv: a header that begins with 'time [s]', and rows, expected")
        table = []
        for number, row in enumerate(rows[1:], start=2):
            try:
                table.append([float(cell) for cell in row])
            except ValueError as error:
                return self.error(f"history.csv:{number}: {error}")
            if len(row) != len(rows[0]):
                return self.error(f"history.csv:{number}: {len(row)} columns, {len(rows[0])} titles")
            for title, value in zip(rows[0], table[-1]):
                name = title.split(" [")[0]
                if not (math.isfinite(value) or name in self.allowed or (math.isnan(value) and name in self.measures)):
                    self.error(f"history.csv:{number}: {title} is {value}")
        table = np.array(table)
        if (np.diff(table[:, 0]) <= 0).any():
            self.error("history.csv: times do not increase")
        return self.history_copy([title.split(" [")[0] for title in rows[0]], table)

    def history_copy(self, names, table):
        if not os.path.exists(self.path("history.h5")):
            return  # killed before the first flush
        file = self.open_file("history.h5")
        if sorted(names) != sorted(set(file) - {"gauges"}):
            self.error("history.h5: other columns than history.csv")
            return
        for name, column in zip(names, table.T):
            values = file[name][()]
            # A run that was killed leaves the copy of its last flush.
            if not np.array_equal(values, column[:len(values)], equal_nan=True):
                self.error(f"history.h5: {name} differs from history.csv")

    def summary(self):
        try:
            with open(self.path("summary.json"), encoding="utf-8") as file:
                summary = json.load(file)
            if not isinstance(summary, dict):
                self.error("summary.json: not an object")
            elif isinstance(summary.get("measures"), dict):
                self.measures = set(summary["measures"])
        except (OSError, ValueError) as error:
            self.error(f"summary.json: {error}")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--allow-nonfinite", action="append", default=[], metavar="FIELD")
    parser.add_argument("--killed", action="store_true", help="the run was killed: summary.json need not be there")
    arguments = parser.parse_args()
    checker = Checker(arguments.folder, set(arguments.allow_nonfinite), arguments.killed)
    checker.frames()
    if not arguments.killed or os.path.exists(checker.path("summary.json")):
        checker.summary()
    checker.history()
    if checker.count == 0:
        checker.error("no array was checked")
    for message in checker.errors:
        print(f"{arguments.folder}: {message}", file=sys.stderr)
    return 1 if checker.errors else 0


if __name__ == "__main__":
    sys.exit(main())
