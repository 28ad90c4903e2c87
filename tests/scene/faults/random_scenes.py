# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that are legal and that nobody would think of: made by chance, one for each seed.

A run of one may end (0), or end as a numerical failure (3) that says why. It may not be refused after `check` let it
pass, nor die, hang, reach twice the energy that came in, or write a number that is none; the ledger closes to
round-off, and an energy error is said in a warning. A file with the scene of a seed:

    /usr/bin/python3 tests/scene/faults/random_scenes.py 17 > 17.yaml
"""

import json
import math
import pathlib
import random
import sys

import numpy as np

from faults_support import fault
from scene_support import check, history, krater, summary

CELL = 1e-3
SHOCK = {"mie_gruneisen_shock": {"c0": 3940, "S1": 1.49, "gamma0": 2}}
TILLOTSON = {"tillotson": {"a": 0.5, "b": 1.63, "A": 75e9, "B": 65e9, "E0": 5e6, "E_iv": 3e6, "E_cv": 15e6}}
JOHNSON_COOK = {"johnson_cook": {"A": 90e6, "B": 292e6, "n": 0.31, "C": 0.025, "epsdot0": 1.0, "m": 1.09, "T_melt": 1356,
                                 "T_ref": 294}}


def metal(draw):
    m = {"density": 8960, "shear_modulus": 46e9, "eos": draw.choice([SHOCK, {"linear": {"K": 140e9}}]),
         "strength": draw.choice([{"elastic": {}}, {"von_mises": {"Y": 2e8, "H": 1e8}}, JOHNSON_COOK])}
    if "johnson_cook" in m["strength"]:
        m["heating"] = {"plastic_work": {"fraction": 0.9, "cp": 385}}
        m["initial_temperature"] = 294
    return m


def aluminium(draw):
    return {"density": 2700, "shear_modulus": 26e9, "eos": TILLOTSON,
            "strength": draw.choice([{"elastic": {}}, {"von_mises": {"Y": 3e8, "H": 0}}])}


def fluid(draw):
    return draw.choice([
        {"density": 1000, "eos": {"mie_gruneisen_shock": {"c0": 1480, "S1": 1.9, "gamma0": 0.1}}},
        {"density": 1000, "eos": {"stiffened_gas": {"gamma": 4.4, "p_inf": 6e8, "p0": 1e5}}},
        {"density": 1.2, "eos": {"ideal_gas": {"gamma": 1.4, "p0": 1e5}}}])


def rubber(_):
    return {"density": 1000, "strength": {"neo_hookean": {"lame_lambda": 1e8}}, "shear_modulus": 1e7}


def material(draw):
    m = draw.choice([metal, metal, metal, aluminium, fluid, rubber])(draw)
    solid = "strength" in m and "neo_hookean" not in m["strength"]
    if "eos" in m and "linear" not in m["eos"] and draw.random() < 0.8:
        m["viscosity"] = {}
    yields = solid and "elastic" not in m["strength"]
    if yields and draw.random() < 0.4:
        m["damage"] = draw.choice([{"maximum_plastic_strain": {"eps_max": 0.3}}, {"cockcroft_latham": {"W_c": 5e7}}])
        if draw.random() < 0.3:
            m["failure"] = {"action": "remove"}
    if solid and draw.random() < 0.3:
        m["spall"] = {"strength": 1.5e9, "action": draw.choice(["fail", "limit"])}
    return m


def shape(draw, axes, low, high):
    """A shape within the box from `low` to `high` along the grid's axes."""
    middle, half = [(a + b) / 2 for a, b in zip(low, high)], [(b - a) / 2 for a, b in zip(low, high)]
    around = axes == "rz"
    kind = draw.choice(["box", "cylinder", "sphere", "tube", "cone"] if axes != "xz" else ["box", "cylinder", "sphere"])
    radius = high[0] if around else min(half[:-1])
    height, base = high[-1] - low[-1], [0.0 if around else middle[0], *middle[1:-1], low[-1]]
    if kind == "sphere":
        r = min(radius, half[-1])
        return {"sphere": {"radius": r, "center": [*base[:-1], middle[-1]]}}
    if kind == "tube" and radius > 3 * CELL:
        return {"tube": {"inner_radius": radius / 2, "outer_radius": radius, "height": height, "base": base}}
    if kind == "cone" and radius > 2 * CELL:
        return {"cone": {"radius": radius, "top_radius": draw.choice([0, radius / 2]), "height": height, "base": base}}
    if kind == "box" and not around:
        return {"box": {"min": [*low], "max": [*high]}}
    return {"cylinder": {"radius": radius, "height": height, "base": base}}


METHODS = [
    {}, {}, {"update": "musl"}, {"update": "usf"}, {"transfer": "apic"}, {"transfer": "flip"},
    {"transfer": {"xpic": {"order": 2}}}, {"shape": "gimp"}, {"shape": "gimp", "update": "musl"},
    {"shape": "gimp", "transfer": "apic"}, {"shape": "linear", "update": "musl", "transfer": "flip"},
    {"points_per_direction": 3}, {"jitter": 0.2}, {"stagger": False}, {"cell_averaging": False}, {"reference": "initial"},
    {"reference": "adaptive"}]


def fastest_of(body):
    return max(map(abs, body.get("velocity", [0])))


def calm(m):
    """Without yield or viscosity no matter goes through a shock: that is no legal scene but a wrong one."""
    if m.get("strength") == {"elastic": {}}:
        m["strength"] = {"von_mises": {"Y": 2e8, "H": 0}}
    if "eos" in m and "linear" not in m["eos"]:
        m["viscosity"] = {}


def scene(seed):
    draw = random.Random(seed)
    frame = draw.choice(["axisymmetric", "axisymmetric", "plane_strain", "3d"])
    axes = {"axisymmetric": "rz", "plane_strain": "xz", "3d": "xyz"}[frame]
    cells = {"rz": 14, "xz": 14, "xyz": 9}[axes]
    places = draw.randint(1, 3)
    layer = {"rz": 6, "xz": 6, "xyz": 4}[axes] + draw.choice([0, 0.3, 0.5])
    gap = draw.choice([0.0, 0.0, 0.1, 1.0])
    low = 0.0 if axes == "rz" else -cells / 2
    sides = {}
    for side in [a + end for a in axes for end in ("_min", "_max")]:
        speed = [0.0] * len(axes)
        speed[axes.index(side[0])] = draw.uniform(1, 300) * (1 if side.endswith("min") else -1)
        kind = draw.choice(["open", "open", "open", "wall", {"wall": {"friction": 0.3}}, "sticky", "symmetry",
                            {"velocity": speed}])
        if side == "r_min":
            kind = "axis"
        if kind != "open":
            sides[side] = kind
    height = places * (layer + gap) + draw.choice([0, 2, 4])
    box = {"min": [low * CELL] * (len(axes) - 1) + [0.0],
           "max": [(low + cells) * CELL] * (len(axes) - 1) + [round(height + 0.5) * CELL]}
    materials, bodies = {}, {}
    fastest = 0.0
    for i in range(places):
        materials[f"m{i}"] = material(draw)
        width = draw.choice([0.3, 0.6, 0.9, 1.0]) * cells / 2
        bottom = (i * (layer + gap)) * CELL
        a = [0.0 if axes == "rz" else -width * CELL] * (len(axes) - 1) + [bottom]
        b = [(2 * width if axes == "rz" else width) * CELL] * (len(axes) - 1) + [bottom + layer * CELL]
        body = {"material": f"m{i}", "shape": shape(draw, axes, a, b)}
        gas = materials[f"m{i}"]["density"] < 10
        if draw.random() < 0.7 and not gas:
            speed = 10 ** draw.uniform(0, 3.9)
            if "neo_hookean" in materials[f"m{i}"].get("strength", {}):
                speed = min(speed, 100)
            body["velocity"] = [0.0] * (len(axes) - 1) + [-speed if i > 0 or draw.random() < 0.7 else speed]
            if axes != "rz" and draw.random() < 0.5:
                body["velocity"][0] = speed * draw.uniform(-1, 1)
            fastest = max(fastest, speed)
        if fastest_of(body) > 300:
            calm(materials[f"m{i}"])
        bodies[f"b{i}"] = body
    driven = any(isinstance(side, dict) and "velocity" in side for side in sides.values())
    method = dict(draw.choice([m for m in METHODS if not (driven and ("reference" in m or "xpic" in str(m)))]))
    meets = places > 1 and "reference" not in method and "xpic" not in str(method) and draw.random() < 0.6
    tree = {"title": f"By chance, seed {seed}", "frame": frame,
            "grid": {"cell": CELL, "box": box, "boundary": sides},
            # By chance the layer of cells that a wall stops is most of an elastic body: said, but no end.
            "time": {"end": min(2 * height * CELL / max(fastest, 200), 15e-6), "energy_error": "off"},
            "materials": materials, "bodies": bodies, "output": {"frames": 0, "history": 0}}
    for name, side in sides.items():  # check refuses planes that would meet before the end
        if isinstance(side, dict) and "velocity" in side:
            a = axes.index(name[0])
            most = 0.2 * (box["max"][a] - box["min"][a]) / tree["time"]["end"]
            side["velocity"][a] = max(-most, min(most, side["velocity"][a]))
    if method:
        tree["method"] = method
    if meets:
        tree["contact"] = {"friction": draw.choice([0, 0.2])}
        if draw.random() < 0.2:
            tree["contact"]["normal"] = "logistic_regression"
    return tree


def numbers(tree, path=""):
    """Path and value of every number in a tree of JSON."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield from numbers(value, f"{path}.{key}")
    elif isinstance(tree, (int, float)):
        yield path, tree


def look_at_results(seed, out):
    rows, audit = history(out), summary(out)["audit"]
    broken = [name for name, values in rows.items() if not np.all(np.isfinite(values))]
    broken += [path for path, value in numbers(audit) if not math.isfinite(value)]
    check(not broken, f"seed {seed}: every number is one", broken)
    driven = rows["external_work"] + np.maximum(rows["wall_work"], 0)
    came_in = rows["total_energy"][0] + np.maximum.accumulate(driven)
    energy = rows["kinetic_energy"] + rows["internal_energy"] + rows["removed_energy"]
    least = 1e-12 * max(came_in[-1], 1e-300)
    check(np.all(np.maximum(energy, rows["kinetic_energy"]) <= 2 * came_in + least),
          f"seed {seed}: never twice the energy that came in", np.max(energy / np.maximum(came_in, 1e-300)))
    through = abs(audit["transfer_loss"]) + abs(audit["transfer_gain"]) + abs(energy[-1]) + came_in[-1]
    check(abs(audit["energy_residual"]) <= 1e-9 * through, f"seed {seed}: the ledger closes",
          f"{audit['energy_residual']} of {through}")
    told = [warning["kind"] for warning in summary(out)["warnings"]]
    check(abs(audit["energy_error_fraction"]) < 0.01 or "energy" in " ".join(told),
          f"seed {seed}: an energy error is said", f"{audit['energy_error_fraction']}: {told}")


def by_chance(seeds, failures_allowed):
    ended = 0
    for seed in seeds:
        pathlib.Path(f"{seed}.yaml").write_text(json.dumps(scene(seed), indent=1), encoding="utf-8")
        done = krater("check", f"{seed}.yaml", timeout=60)
        if not check(done.returncode == 0, f"seed {seed}: check", done.stderr[-300:]):
            continue
        done = krater("run", f"{seed}.yaml", "-o", f"{seed}", "-j", 1, "--quiet", timeout=60)
        ended += done.returncode == 0
        why = [line for line in done.stderr.splitlines() if "warning:" not in line]
        check(done.returncode == 0 or (done.returncode == 3 and " point " in " ".join(why)),
              f"seed {seed}: done, or why not", f"{done.returncode}: {why}")
        look_at_results(seed, f"{seed}")
    check(ended >= len(seeds) - failures_allowed, "most run to their end", f"{ended} of {len(seeds)}")


@fault("random", "scenes made by chance run to their end with a sound ledger")
def ten():
    by_chance(range(10), 0)


@fault("random-long", "200 of them, of which 10 may fail with a reason", long=True)
def two_hundred():
    by_chance(range(100, 300), 10)


if __name__ == "__main__":
    print(json.dumps(scene(int(sys.argv[1])), indent=1))
