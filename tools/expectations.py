# SPDX-License-Identifier: GPL-3.0-or-later
"""What a scene expects of its results, its block `expect:`, judged from the results folder.

    expect:
      exit: 0                              # 0 if left out; another code needs `says`
      says: words of the message
      energy_error: 0.01                   # a quantity of QUANTITIES: at most
      density: [0.9, 4]                    # or within a band
      rebound: {of: "upper_velocity[-1]", within: [0.97, 1.03]}      # or an expression
      pieces: {of: pieces, within: [1, 1], for: [fine]}              # in these runs only
      misses: {rebound: "why it does so today"}                      # or "fine: rebound", of that run only
      runs: {fine: [grid.cell=1 mm]}       # each is a run of its own, judged alike; one run if left out
      quick: [coarse]                      # of these, those that a short test takes
      figures: {work: load_work}           # told beside, not judged

Expressions know the columns of the history (arrays over its rows; dots in names are underscores), the measures and
audit of summary.json by name, `steps`, `cell`, and numpy as `np`.
"""

import csv
import json
import math
import os

import h5py
import numpy as np
import yaml

WORDS = {"exit", "says", "misses", "runs", "quick", "figures"}
BUILTINS = {"max": max, "min": min, "sum": sum, "len": len, "list": list}
BINS = 20  # of a run's time, over which its steps are averaged: single steps are cut by output


def with_numbers(tree):
    """A tree of YAML 1.1 as krater means it: 1e-6 is a number there."""
    if isinstance(tree, dict):
        return {key: with_numbers(value) for key, value in tree.items()}
    if isinstance(tree, list):
        return [with_numbers(value) for value in tree]
    try:
        return float(tree) if isinstance(tree, str) else tree
    except ValueError:
        return tree


class Results:
    """A results folder."""

    def __init__(self, folder):
        self.folder = str(folder)
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            self.summary = json.load(file)
        self.audit = self.summary["audit"]
        with open(os.path.join(folder, "resolved.yaml"), encoding="utf-8") as file:
            self.scene = with_numbers(yaml.safe_load(file))
        with open(os.path.join(folder, "history.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        self.history = {title.partition(" [")[0]: np.array([float(v) for v in column])
                        for title, column in zip(rows[0], zip(*rows[1:]))}

    def frames(self):
        """(body -> field -> values) of each frame in turn."""
        with h5py.File(os.path.join(self.folder, "frames.h5"), "r") as file:
            for name in sorted(file["frames"]):
                yield {body: {field: data[()] for field, data in group.items() if isinstance(data, h5py.Dataset)}
                       for body, group in file["frames"][name].items()}

    def moved(self, body, *place):
        """Displacement of the point of a body that was nearest to a place (x, y, z) at the start."""
        first, *_, last = (frame[body] for frame in self.frames())
        at = np.argmin(np.sum((first["coordinates"] - place) ** 2, axis=1))
        return last["coordinates"][last["id"] == first["id"][at]][0] - first["coordinates"][at]

    def names(self):
        """What expressions know."""
        known = {name: value for name, value in self.audit.items() if isinstance(value, (int, float))}
        known |= self.audit.get("events", {})
        known |= {name: one["value"] for name, one in self.summary.get("measures", {}).items()}
        known |= {name.replace(".", "_"): values for name, values in self.history.items()}
        return {**known, "np": np, "abs": np.abs, "steps": self.summary["steps"], "cell": float(self.scene["grid"]["cell"]),
                "status": self.summary["status"], "outcomes": self.summary.get("outcomes", {}), "frames": self.frames, "moved": self.moved}


def axes(results):
    return [name.rpartition("_")[2] for name in results.history if name.startswith("momentum_")]


def energy_residual(r):
    """Greatest kinetic + internal + removed - work - start, by the greatest energy in the scene."""
    most = np.max(np.abs(r.history["total_energy"]) + np.abs(r.history["removed_energy"]))
    return np.max(np.abs(r.history["energy_residual"])) / most


def energy_error(r):
    """energy_error_fraction at the end."""
    return abs(r.audit["energy_error_fraction"])


def momentum(r):
    """Change of momentum at the end that nothing has booked, by sqrt(2 m E) and the greatest impulse from outside. Along r
    there is none to keep."""
    gap = [r.audit[f"momentum_{a}"] - r.history[f"momentum_{a}"][0] + r.audit[f"removed_momentum_{a}"] -
           r.audit[f"wall_impulse_{a}"] - r.audit[f"external_impulse_{a}"] for a in axes(r) if a != "r"]
    given = [np.max(np.abs(r.history[f"{kind}_impulse_{a}"])) for kind in ("wall", "external") for a in axes(r)]
    return max(map(abs, gap)) / (math.sqrt(2 * r.history["mass"][0] * np.max(np.abs(r.history["total_energy"]))) + max(given))


def mass(r):
    """Change of mass that did not leave, by the mass."""
    return abs(r.audit["mass"] + r.audit["removed_mass"] - r.history["mass"][0]) / r.history["mass"][0]


def step_fall(r):
    """Mean step of the first twentieth of the run over that of the worst twentieth."""
    time, step = r.history["time"], r.history["step"]
    at = np.interp(np.linspace(0, time[-1], BINS + 1), time, step)
    steps = np.maximum(np.diff(at), 1e-9)
    return float(np.max(steps) / steps[0])


def ratio_of_density(r):
    """Least and greatest density of any point in any frame, by that of its material."""
    rest = {name: float(r.scene["materials"][body["material"]]["density"]) for name, body in r.scene["bodies"].items()}
    found = [fields["density"] / rest[body] for frame in r.frames() for body, fields in frame.items()
             if body in rest and len(fields.get("density", ()))]
    return [float(min(map(np.min, found))), float(max(map(np.max, found)))]


def temperature(r):
    """Least and greatest temperature of any point in any frame."""
    found = [fields["temperature"] for frame in r.frames() for fields in frame.values() if len(fields.get("temperature", ()))]
    return [float(min(map(np.min, found))), float(max(map(np.max, found)))]


def mirror(axis):
    def apart(r):
        """Greatest distance between a point and the image of its partner across the plane, in cells."""
        first, *_, last = r.frames()
        return max(image_distance(first[b], last[b], axis) for b in last) / float(r.scene["grid"]["cell"])
    return apart


def image_distance(first, last, axis):
    """Partners are found at the start, where they are images of each other."""
    sign = np.ones(3)
    sign[axis] = -1
    if set(first["id"]) != set(last["id"]):
        return math.inf
    x, y = first["coordinates"][np.argsort(first["id"])], last["coordinates"][np.argsort(last["id"])]
    near = np.max(np.abs(x))
    keys = [np.round(places / near * 2 ** 24).astype(np.int64) for places in (x * sign, x)]
    partner = np.empty(len(x), int)
    partner[np.lexsort(keys[0].T)] = np.lexsort(keys[1].T)
    if np.max(np.abs(x[partner] - x * sign)) > 1e-6 * near:
        return math.inf  # not symmetric to begin with
    return float(np.max(np.abs(y[partner] - y * sign)))


def angular_momentum(r):
    """Greatest change of the angular momentum, by that of the start."""
    spin = r.history["angular_momentum"]
    return np.max(np.abs(spin / spin[0] - 1))


QUANTITIES = {
    "energy_residual": energy_residual, "energy_error": energy_error, "momentum": momentum, "mass": mass,
    "step_fall": step_fall, "density": ratio_of_density, "temperature": temperature, "mirror_x": mirror(0),
    "mirror_y": mirror(1), "mirror_z": mirror(2), "angular_momentum": angular_momentum}


class Judgement:
    """One expectation and what was found: name, text of the band, value, and whether it holds."""

    def __init__(self, name, wanted, found, held):
        self.name, self.wanted, self.found, self.held = name, wanted, found, held

    def __str__(self):
        return f"{self.name} {show(self.found)} ({self.wanted})"


def show(value):
    if isinstance(value, (list, tuple)):
        return " to ".join(map(show, value))
    return f"{value:.3g}" if isinstance(value, (int, float)) else str(value)


def band_of(wanted):
    """(low, high) of `wanted`: a number is an upper bound of a magnitude."""
    if isinstance(wanted, list):
        return tuple(-math.inf if w is None else float(w) for w in wanted)
    return (-math.inf, float(wanted))


def judge_one(name, wanted, results):
    low, high = band_of(wanted["within"] if isinstance(wanted, dict) else wanted)
    try:
        if isinstance(wanted, dict):
            found = evaluate(wanted["of"], results)
        else:
            found = QUANTITIES[name](results)
        values = [float(v) for v in np.ravel(found)]
        found = values if len(values) > 1 else values[0]
    except (ArithmeticError, KeyError, NameError, TypeError, ValueError, IndexError) as error:
        return Judgement(name, "a value", f"{type(error).__name__}: {error}", False)
    text = f"at most {show(high)}" if low == -math.inf else f"{show(low)} to {show(high)}"
    return Judgement(name, text, found, all(low <= v <= high for v in values))


def mistakes(expect):
    """What is wrong with the block itself."""
    for name, wanted in expect.items():
        if name in WORDS:
            continue
        if isinstance(wanted, dict) and not {"of", "within"} <= set(wanted) <= {"of", "within", "for"}:
            yield f"expect.{name}: an expression needs `of` and `within`, and may have `for`"
        for run in wanted.get("for", []) if isinstance(wanted, dict) else []:
            if run not in expect.get("runs", {}):
                yield f"expect.{name}: no run '{run}'"
        if not isinstance(wanted, dict) and name not in QUANTITIES:
            yield f"expect.{name}: no such quantity; known: {', '.join(sorted(QUANTITIES))}, or {{of: ..., within: ...}}"
    for miss in expect.get("misses", {}):
        run, _, name = miss.rpartition(": ")
        if name not in expect and name != "exit" or run and run not in expect.get("runs", {}):
            yield f"expect.misses.{miss}: nothing of that name is expected, or there is no such run"


def evaluate(text, results):
    """The user's own scene says what: names of the results, and little else."""
    return eval(text, {"__builtins__": BUILTINS, **results.names()})


def figures(expect, folder):
    """name -> value of what is told and not judged."""
    if not os.path.exists(os.path.join(folder, "summary.json")):
        return {}
    results = Results(folder)
    return {name: float(evaluate(text, results)) for name, text in expect.get("figures", {}).items()}


def concerns(wanted, run):
    return not isinstance(wanted, dict) or run in wanted.get("for", [run])


def judge(expect, run, folder, code, said):
    """Judgements of a run of this name that ended with `code` and said `said`."""
    wanted = expect.get("exit", 0)
    verdict = [Judgement("exit", str(wanted), code, code == wanted)]
    if "says" in expect:
        verdict.append(Judgement("says", expect["says"], said.strip()[-200:], expect["says"] in said))
    if code == wanted and os.path.exists(os.path.join(folder, "summary.json")):
        results = Results(folder)
        verdict += [judge_one(name, one, results) for name, one in expect.items()
                    if name not in WORDS and concerns(one, run)]
    return verdict
