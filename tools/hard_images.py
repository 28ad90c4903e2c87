# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of a scene, from the tree of its resolved.yaml: turned or mirrored, and in other units (tools/hard --invariance).

What cannot be transformed raises NotImplementedError with its name.
"""

import re
import subprocess

import numpy as np


class Turn:
    """x' = M x of the scene's axes, a signed permutation of (x, y, z)."""

    def __init__(self, frame, matrix):
        self.frame, self.M = frame, np.array(matrix)
        self.places = [0, 2] if frame != "3d" else [0, 1, 2]  # of a vector of the frame
        self.mirrors = np.linalg.det(self.M) < 0

    def vector(self, v):
        """Of numbers or expressions, with the frame's components or three."""
        full = list(v) if len(v) == 3 else [v[0], 0, v[1]]
        out = [self.component(row, full) for row in self.M]
        return out if len(v) == 3 else [out[a] for a in self.places]

    def component(self, row, full):
        a = int(np.flatnonzero(row)[0])
        if isinstance(full[a], str):
            return f"{'-' if row[a] < 0 else ''}({self.expression(full[a])})"
        return float(row[a]) * full[a] + 0.0

    def expression(self, text):
        """Of places: x stands for the first component of M^T x'."""
        names = {}
        for a, letter in enumerate("xyz"):
            column = self.M[:, a]
            b = int(np.flatnonzero(column)[0])
            names[letter] = f"({'-' if column[b] < 0 else ''}{'xyz'[b]})"
        if self.frame == "axisymmetric":
            names["r"] = "(r)"
        return re.sub(r"\b[xyzr]\b", lambda m: names.get(m.group(0), m.group(0)), text)

    def direction(self, word):
        sign, letter = (-1, word[1]) if word[0] == "-" else (1, word[0])
        v = self.M @ (sign * np.eye(3)["xyz".index(letter)])
        a = int(np.flatnonzero(v)[0])
        return ("-" if v[a] < 0 else "") + "xyz"[a]

    def axis(self, axis):
        return self.direction(axis) if isinstance(axis, str) else self.vector(axis)

    def corners(self, low, high):
        a, b = self.vector(low), self.vector(high)
        return [min(p, q) for p, q in zip(a, b)], [max(p, q) for p, q in zip(a, b)]

    def side(self, name):
        letter, end = name.split("_")
        v = self.direction(("-" if end == "min" else "") + ("x" if letter == "r" else letter))
        found = ("r" if letter == "r" else v[-1]) + ("_min" if v[0] == "-" else "_max")
        return name if letter == "r" else found

    def shape(self, tree):
        (kind, value), = tree.items()
        if kind in ("union", "difference", "intersection"):
            return {kind: [self.shape(one) for one in value]}
        out = {key: one for key, one in value.items()}
        for key in ("base", "center", "by", "about"):
            if key in out and isinstance(out[key], list) and kind != "scale":
                out[key] = self.vector(out[key])
        if kind in ("box", "slab") and isinstance(out.get("min"), list):
            out["min"], out["max"] = self.corners(out["min"], out["max"])
        elif kind in ("cylinder", "cone", "tube", "ogive", "torus", "rotate") and "axis" in out:
            out["axis"] = self.axis(out["axis"])
            if kind in ("cylinder", "tube", "torus") and out["axis"][0] == "-":  # the same both ways
                out["axis"] = out["axis"][1]
                along = "xyz".index(out["axis"])
                out["base" if "base" in out else "center"][along] -= out.get("height", 0)
        elif kind in ("extrusion", "revolution", "surface", "mesh", "scale", "slab", "ellipsoid"):
            raise NotImplementedError(kind)
        if kind == "rotate":
            out["angle"] = -out["angle"] if self.mirrors else out["angle"]
            if out["axis"][0] == "-":
                out["axis"], out["angle"] = out["axis"][1], -out["angle"]
        if "shape" in out:
            out["shape"] = self.shape(out["shape"])
        return {kind: out}

    def scene(self, tree):
        grid = tree["grid"]
        grid["box"]["min"], grid["box"]["max"] = self.corners(grid["box"]["min"], grid["box"]["max"])
        grid["boundary"] = {self.side(name): self.boundary(kind) for name, kind in grid["boundary"].items()}
        for one in grid.get("refine", []):
            if "region" in one:
                one["region"] = self.shape(one["region"])
        for body in tree["bodies"].values():
            body["shape"] = self.shape(body["shape"])
            if "velocity" in body:
                body["velocity"] = self.vector(body["velocity"])
            if {"turn", "mesh"} & set(body) or isinstance(body.get("rigid"), dict):
                raise NotImplementedError("turn or rigid")
            points = body.get("points", {})
            if isinstance(points.get("per_direction"), list):
                points["per_direction"] = [int(abs(v)) for v in self.vector(points["per_direction"])]
            if points.get("zones"):
                raise NotImplementedError("zones")
        if "body_force" in tree:
            tree["body_force"] = self.vector(tree["body_force"])
        for load in tree.get("loads", {}).values():
            self.load(load)
        for one in tree.get("detonators", {}).values():
            if "point" not in one:
                raise NotImplementedError("detonator")
            one["point"] = self.vector(one["point"])
        return tree

    def boundary(self, kind):
        if isinstance(kind, dict) and "velocity" in kind:
            raise NotImplementedError("piston")
        return kind

    def load(self, load):
        if "face" in load:
            load["face"] = self.side(load["face"])
        if {"where", "inside", "traction", "velocity"} & set(load):
            raise NotImplementedError("load")


# ------------------------------------------------------------------------------------------------- other units

UNITS = {"m": 2.0 ** 7, "s": 2.0 ** 5, "kg": 2.0 ** 9, "K": 1.0}
POWERS = {  # of m, s, kg
    "1": (0, 0, 0), "K": (0, 0, 0), "m": (1, 0, 0), "s": (0, 1, 0), "1/s": (0, -1, 0), "Pa": (-1, -2, 1), "1/Pa": (1, 2, -1),
    "kg/m^3": (-3, 0, 1), "m/s": (1, -1, 0), "J/(kg.K)": (2, -2, 0), "J/kg": (2, -2, 0), "1/K": (0, 0, 0), "J/m^2": (0, -2, 1),
    "m/s^2": (1, -2, 0), "Pa s": (-1, -1, 1), "Pa/K": (-1, -2, 1)}


def factor(unit):
    m, s, kg = POWERS[unit]
    return UNITS["m"] ** m * UNITS["s"] ** s * UNITS["kg"] ** kg


class Units:
    """The same scene with other numbers: a metre is 2^7 of the new unit of length."""

    def __init__(self, krater):
        self.krater, self.known = krater, {}

    def parameters(self, law):
        """name -> unit, as `krater models` says."""
        if law not in self.known:
            text = subprocess.run([self.krater, "models", law], capture_output=True, text=True, check=True).stdout
            self.known[law] = dict(re.findall(r"^  (\w+) +\[([^\]]+)\]", text, re.MULTILINE))
        return self.known[law]

    def law(self, name, values):
        units = self.parameters(name)
        return {key: value * factor(units[key]) if key in units and isinstance(value, (int, float)) else value
                for key, value in values.items()}

    def material(self, m):
        single = {"density": "kg/m^3", "shear_modulus": "Pa", "bulk_modulus": "Pa", "youngs_modulus": "Pa", "spall_strength": "Pa"}
        out = {}
        for key, value in m.items():
            if key in single:
                out[key] = value * factor(single[key])
            elif key == "spall" and isinstance(value, dict):
                out[key] = {**value, "strength": value["strength"] * factor("Pa")}
            elif key == "viscosity" or not isinstance(value, dict):
                out[key] = value
            else:
                out[key] = {law: self.law(law, v) if isinstance(v, dict) else v for law, v in value.items()}
                if key == "eos" and "linear" in value and "bulk_modulus" in value["linear"]:
                    out[key]["linear"]["bulk_modulus"] = value["linear"]["bulk_modulus"] * factor("Pa")
        return out

    def lengths(self, tree, but=("angle", "axis", "crh", "per_direction", "jitter", "seed", "hourglass", "smoothing", "failure")):
        if isinstance(tree, dict):
            return {key: value if key in but else self.lengths(value, but) for key, value in tree.items()}
        if isinstance(tree, list):
            return [self.lengths(value, but) for value in tree]
        return tree * UNITS["m"] if isinstance(tree, float) or (isinstance(tree, int) and not isinstance(tree, bool)) else tree

    def values(self, v, unit):
        """A vector of numbers or expressions of places."""
        scaled = {"x": "m", "y": "m", "z": "m", "r": "m", "t": "s"}

        def one(value):
            if not isinstance(value, str) or value == "free":
                return value * factor(unit) if not isinstance(value, str) else value
            text = re.sub(r"\b[xyzrt]\b", lambda m: f"({m.group(0)}/{UNITS[scaled[m.group(0)]]})", value)
            return f"{factor(unit)!r}*({text})"
        return [one(value) for value in v]

    def load(self, load):
        table = load.get("pressure", {})
        if {"where", "inside", "traction", "velocity"} & set(load):
            raise NotImplementedError("load")
        load["pressure"] = ({"table": [[t * UNITS["s"], p * factor("Pa")] for t, p in table["table"]]}
                            if isinstance(table, dict) else self.values([table], "Pa")[0])

    def scene(self, tree):
        grid = tree["grid"]
        grid["cell"] *= UNITS["m"]
        grid["box"] = self.lengths(grid["box"])
        for one in grid.get("refine", []):
            if "where" in one:
                raise NotImplementedError("a field has a unit")
            one.update({key: self.lengths(one[key]) for key in ("region", "margin") if key in one})
        for key in ("end", "max_step", "min_step", "first_step"):
            tree["time"][key] *= UNITS["s"]
        tree["materials"] = {name: self.material(m) for name, m in tree["materials"].items()}
        for body in tree["bodies"].values():
            if {"mesh", "surface"} & set(body["shape"]):
                raise NotImplementedError("a file has a unit of its own")
            body["shape"] = self.lengths(body["shape"])
            if "velocity" in body:
                body["velocity"] = self.values(body["velocity"], "m/s")
            if "kinematics" in body and not isinstance(body["kinematics"], str):
                body["kinematics"] = self.lengths(body["kinematics"], ("hourglass", "smoothing", "zero_energy", "artificial_stress",
                                                                       "failure"))
            if body.get("points", {}).get("zones") or isinstance(body.get("rigid"), dict) or "turn" in body:
                raise NotImplementedError("zones, turn or rigid")
        for key in ("frames", "history"):
            tree["output"][key] *= UNITS["s"]
        if "body_force" in tree:
            tree["body_force"] = self.values(tree["body_force"], "m/s^2")
        for load in tree.get("loads", {}).values():
            self.load(load)
        for one in tree.get("detonators", {}).values():
            one.update({key: self.lengths(value) for key, value in one.items() if key != "time"})
            one["time"] = one.get("time", 0) * UNITS["s"]
        if "damping" in tree:
            tree["damping"]["mass"] *= factor("1/s")
        return tree
