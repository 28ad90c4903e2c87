# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the results folder of a run of krater into numpy and pandas.

    import krater_results
    run = krater_results.read("taylor_copper_out")

    run.summary["measures"]["final_length"]["value"]    # what summary.json holds
    run.measures                                        # DataFrame: value, unit, reference, difference_percent
    run.history.plot("time", "kinetic_energy")          # DataFrame, one row per time
    run.gauges["visar"]                                 # DataFrame, one for each gauge
    run.frames[-1]["rod"]["plastic_strain"]             # numpy array, one row per point
    run.frames[-1].table("rod")                         # DataFrame, one row per point
    run.units["kinetic_energy"], run.frames[-1].units["rod"]["velocity"]

All values are SI. Nothing of the frames is read before it is asked for. A folder that is no result raises
FileNotFoundError, a body, field or gauge that is not there KeyError with the names that are. The layout of the files is
that of the page RESULTS.md (in the sources src/output/README.md). `history` of a run that is still going on ends with
the last row written.
"""

import collections.abc
import functools
import json
import pathlib

import h5py
import numpy as np


def read(folder):
    """The results in `folder` (text or path) as a Run."""
    return Run(folder)


def _pandas():
    try:
        import pandas  # pylint: disable=import-outside-toplevel
    except ImportError as error:
        raise ImportError("krater_results needs pandas for tables (Debian: python3-pandas)") from error
    return pandas


def _text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def _table(titles, columns):
    """DataFrame of named columns; the units of `name [unit]` titles in its attrs["units"]."""
    names = [title.partition(" [")[0] for title in titles]
    frame = _pandas().DataFrame(dict(zip(names, columns)), columns=names)
    frame.attrs["units"] = {name: title.partition(" [")[2].rstrip("]") or "1" for name, title in zip(names, titles)}
    return frame


def _csv(path):
    frame = _pandas().read_csv(path, float_precision="round_trip")
    return _table(list(frame.columns), [frame[name].to_numpy() for name in frame.columns])


class Run:
    """One results folder.

    summary    dict, summary.json; {} while the run goes on
    history    DataFrame, history.csv: `time` [s] and a column per quantity; units in history.attrs["units"]
    units      {column of the history: unit}
    measures   DataFrame by name: value, unit, reference, difference_percent, uncertainty
    gauges     {name: DataFrame}: `time` [s] and a column per field
    frames     sequence of Frame; its `times` [s] without opening them all twice
    """

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        if not (self.folder / "history.csv").is_file() and not (self.folder / "frames.h5").is_file():
            raise FileNotFoundError(f"{self.folder} holds no results of krater (no history.csv, no frames.h5)")

    def __repr__(self):
        return f"<krater run {self.folder}: {len(self.frames)} frames>"

    @functools.cached_property
    def summary(self):
        path = self.folder / "summary.json"
        return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}

    @functools.cached_property
    def history(self):
        return _csv(self.folder / "history.csv")

    @property
    def units(self):
        return self.history.attrs["units"]

    @functools.cached_property
    def measures(self):
        keys = ["value", "unit", "reference", "difference_percent", "uncertainty"]
        found = self.summary.get("measures", {})
        rows = {name: [_plain(measure.get(key)) for key in keys] for name, measure in found.items()}
        return _pandas().DataFrame.from_dict(rows, orient="index", columns=keys)

    @functools.cached_property
    def gauges(self):
        files = sorted(self.folder.glob("gauge_*.csv"))
        return _Named("gauge", {path.stem[len("gauge_"):]: _csv(path) for path in files})

    @functools.cached_property
    def frames(self):
        return Frames(self.folder)


def _plain(value):
    """A reference may be a block with its value."""
    return value.get("value") if isinstance(value, dict) else value


class _Named(dict):
    """A dict whose KeyError says what is there."""

    def __init__(self, what, values):
        super().__init__(values)
        self.what = what

    def __missing__(self, key):
        raise KeyError(f"no {self.what} {key!r}; there are: {', '.join(self) or 'none'}")


class Frames(collections.abc.Sequence):
    """The frames of a run by number; negative numbers count from the end, slices give lists."""

    def __init__(self, folder):
        self.files = sorted((pathlib.Path(folder) / "frames").glob("[0-9]*.h5"))
        self._opened = {}

    def __len__(self):
        return len(self.files)

    def __getitem__(self, number):
        if isinstance(number, slice):
            return [self[k] for k in range(*number.indices(len(self)))]
        path = self.files[number]
        if path not in self._opened:
            self._opened[path] = Frame(path)
        return self._opened[path]

    @property
    def times(self):
        """Times of all frames [s], shape (n,)."""
        return np.array([frame.time for frame in self])

    def at(self, time):
        """The frame nearest to a time [s]."""
        return self[int(np.argmin(np.abs(self.times - time)))]


class Frame(collections.abc.Mapping):
    """One frame: body -> fields, a mapping from name to numpy array.

    time [s], step, path, and units: {body: {field: unit}}. Scalars have shape (n,), vectors (n, 3), symmetric tensors
    (n, 6): xx yy zz yz xz xy. `coordinates` (n, 3) [m] are x y z; in the axisymmetric frame r 0 z, in plane strain x 0 z.
    A body of elements has its elements as points, and a group `nodes`.
    """

    def __init__(self, path):
        self.path = pathlib.Path(path)
        with h5py.File(self.path, "r") as file:
            self.time, self.step = float(file.attrs["time"]), int(file.attrs["step"])
            self._names = [name for name in file if isinstance(file[name], h5py.Group)]
        self._bodies = {}

    def __repr__(self):
        return f"<frame at {self.time:.6g} s: {', '.join(self)}>"

    def __iter__(self):
        return iter(self._names)

    def __len__(self):
        return len(self._names)

    def __getitem__(self, body):
        if body not in self._names:
            raise KeyError(f"no body {body!r} in {self.path.name}; there are: {', '.join(self)}")
        if body not in self._bodies:
            self._bodies[body] = _Fields(self.path, body)
        return self._bodies[body]

    @property
    def units(self):
        return {body: self[body].units for body in self}

    def table(self, body):
        """DataFrame of one body, one row per point; vectors and tensors in a column per component (velocity_z,
        coordinates_x); units in attrs["units"]."""
        fields, titles, columns = self[body], [], []
        for name in fields:
            values = fields[name]
            if values.ndim == 1 and len(values) == len(fields["coordinates"]):
                titles.append(f"{name} [{fields.units[name]}]")
                columns.append(values)
            elif values.ndim == 2 and name != "connectivity":
                for k, component in enumerate(fields.components[name] or range(values.shape[1])):
                    titles.append(f"{name}_{component} [{fields.units[name]}]")
                    columns.append(values[:, k])
        return _table(titles, columns)


class _Fields(collections.abc.Mapping):
    """Fields of a body in a frame, read as they are asked for."""

    def __init__(self, path, body):
        self.path, self.body = path, body
        self.units, self.components, self._read = {}, {}, {}
        with h5py.File(path, "r") as file:
            for name, item in file[body].items():
                if not isinstance(item, h5py.Dataset) or name == "cells":  # numbers for XDMF
                    continue
                attributes = item.attrs
                unit = "m" if name == "coordinates" else "1"
                self.units[name] = _text(attributes.get("unit", unit))
                names = attributes.get("component_names")
                self.components[name] = None if names is None else [_text(word) for word in names]

    def __iter__(self):
        return iter(self.units)

    def __len__(self):
        return len(self.units)

    def __getitem__(self, name):
        if name not in self.units:
            raise KeyError(f"no field {name!r} of {self.body!r}; written were: {', '.join(self)} "
                           "(output.fields of the scene chooses)")
        if name not in self._read:
            with h5py.File(self.path, "r") as file:
                self._read[name] = file[self.body][name][()]
        return self._read[name]
