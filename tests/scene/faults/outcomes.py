# SPDX-License-Identifier: GPL-3.0-or-later
"""Twelve shots whose fate is decided by momentum, speeds and places, not by what the outcome's code says.

Each says what must happen and why; what the run then measures of momentum and places, in columns that know nothing of
outcomes, is judged by `verdict`, and only then compared with the word in summary.json.
"""

import dataclasses
import math
import pathlib

import numpy as np

from faults_support import fault
from scene_support import check, history, run, summary

MATERIALS = """
materials:
  steel: {density: 7850, shear_modulus: 80 GPa, strength: {von_mises: {Y: 1.5 GPa, H: 100 MPa}},
          eos: {mie_gruneisen_shock: {c0: 4569 m/s, S1: 1.49, gamma0: 2.17}}}
  soft: {density: 2700, shear_modulus: 26 GPa, strength: {von_mises: {Y: 200 MPa, H: 100 MPa}},
         eos: {mie_gruneisen_shock: {c0: 5240 m/s, S1: 1.4, gamma0: 2}}}
  plate: {density: 2700, shear_modulus: 26 GPa, strength: {von_mises: {Y: 200 MPa, H: 100 MPa}},
          eos: {mie_gruneisen_shock: {c0: 5240 m/s, S1: 1.4, gamma0: 2}},
          damage: {maximum_plastic_strain: {eps_max: 0.8}}, failure: {action: remove}}
  brittle: {density: 7850, shear_modulus: 80 GPa, strength: {von_mises: {Y: 1.5 GPa, H: 100 MPa}},
            eos: {mie_gruneisen_shock: {c0: 4569 m/s, S1: 1.49, gamma0: 2.17}}, spall: {strength: 0.3 GPa},
            damage: {maximum_plastic_strain: {eps_max: 0.1}}}
  elastic: {density: 7850, bulk_modulus: 163.5 GPa, shear_modulus: 80 GPa, eos: linear, strength: elastic}
  water: {density: 1000, eos: {mie_gruneisen_shock: {c0: 1480 m/s, S1: 1.9, gamma0: 0.1}}, viscosity: {q_lin: 0.3, q_quad: 2}}
  hard: {density: 7850}
outcomes: {shot: {projectile: rod, target: plate}}
measures:
  low: {kind: min, body: rod, axis: z}
  high: {kind: max, body: rod, axis: z}
  back: {kind: min, body: plate, axis: z}
  failed: {kind: failed_mass, body: rod}
  left: {kind: mass, body: rod}
"""
ROUND = "frame: axisymmetric\ngrid: {cell: 0.5 mm, box: {min: [0, -40 mm], max: [12 mm, 14 mm]}, boundary: {r_min: axis}}\n"
PLANE = "frame: plane_strain\ngrid: {cell: 0.5 mm, box: {min: [-45 mm, -20 mm], max: [45 mm, 16 mm]}}\n"
STRIP = ("frame: plane_strain\ngrid: {cell: 0.2 mm, box: {min: [0, -30 mm], max: [0.4 mm, 30 mm]}, "
         "boundary: {x_min: symmetry, x_max: symmetry}}\n")
SLIDE, STICK = "contact: {friction: 0}\n", ""
ROD = "{cylinder: {radius: 2 mm, height: 5 mm, base: [0, 0.3 mm]}}"
BALL = "{sphere: {radius: 2 mm, center: [-14 mm, 0, 2.3 mm]}}"


def disc(thickness):
    return f"{{cylinder: {{radius: 10 mm, height: {thickness} mm, base: [0, -{thickness} mm]}}}}"


def slab(thickness):
    return f"{{box: {{min: [-30 mm, -1, -{thickness} mm], max: [30 mm, 1, 0]}}}}"


@dataclasses.dataclass
class Shot:
    why: str
    word: str
    text: str   # frame, contact
    rod: str    # its part of the scene
    plate: str
    end: float  # us
    exact: callable = None  # (velocities of rod and plate along x and z) -> list of (what, found, wanted, share)


def body(material, shape, motion=""):
    return f"{{material: {material}, shape: {shape}{', ' + motion if motion else ''}}}"


def shot(speed, angle=0):
    return f"velocity: {{speed: {speed} m/s, angle: {angle} degree}}"


def mass(density, volume):
    return density * volume


ROD_MASS, BALL_MASS = 7850 * math.pi * 4e-6 * 5e-3, 7850 * 4 / 3 * math.pi * 8e-9
SHOTS = {
    "bounce": Shot("equal elastic bars exchange velocities (one-dimensional waves)", "ricocheted", STRIP + SLIDE,
                   body("elastic", "{box: {min: [-1, -1, 0.1 mm], max: [1, 1, 10.1 mm]}}", shot(20)),
                   body("elastic", "{box: {min: [-1, -1, -10 mm], max: [1, 1, 0]}}"), 30,
                   lambda v: [("rod", v["rod_z"], 0, 0.05), ("plate", v["plate_z"], -20, 0.05)]),
    "lump": Shot("a soft rod that sticks to a free block ends with the common velocity of their momentum", "stopped",
                 ROUND + STICK, body("soft", ROD, shot(150)), body("soft", disc(12)), 150,
                 lambda v: [("both", v["plate_z"], -150 * 4 * 5 / (4 * 5 + 100 * 12), 0.1)]),
    "sheet": Shot("a rigid ball goes through a sheet of water: it cannot lose more than to a plug that it takes along",
                  "perforated", ROUND + SLIDE,
                  body("hard", "{sphere: {radius: 2 mm, center: [0, 0, 2.3 mm]}}", "rigid: free, " + shot(600)),
                  body("water", disc(2)), 25,
                  lambda v: [("residual", v["rod_z"], -600 * (1 + BALL_MASS / (BALL_MASS + 1000 * math.pi * 8e-9)) / 2,
                              (1 - BALL_MASS / (BALL_MASS + 1000 * math.pi * 8e-9)) / 2)]),
    "rod": Shot("steel at 600 m/s through 2 mm of aluminium that fails: far above the limit", "perforated", ROUND + SLIDE,
                body("steel", ROD, shot(600)), body("plate", disc(2)), 40),
    "embedded": Shot("its energy buys 0.5 v^2 rho L/(3 Y) = 2.9 mm of 12: it stops, and sticks", "stopped", ROUND + STICK,
                     body("steel", ROD, shot(300)), body("soft", disc(12)), 150),
    "graze": Shot("at 75 degrees the normal motion, 129 m/s, cannot dig in; without friction 483 m/s go on", "ricocheted",
                  PLANE + SLIDE, body("steel", BALL, shot(500, 75)), body("soft", slab(6)), 60,
                  lambda v: [("along", v["rod_x"], 500 * math.sin(math.radians(75)), 0.3)]),
    "dust": Shot("4 km/s against a spall strength of 0.3 GPa: the ball fails and spreads to more than 1.5 diameters", "broken_up",
                 ROUND + SLIDE, body("brittle", "{sphere: {radius: 2 mm, center: [0, 0, 2.2 mm]}}", shot(4000)),
                 body("plate", disc(1)), 9.5),
    "past": Shot("it flies past the edge", "missed", PLANE + SLIDE,
                 body("steel", "{sphere: {radius: 2 mm, center: [36 mm, 0, 2.3 mm]}}", shot(500)), body("soft", slab(4)), 30),
    "above": Shot("the limit of this plate lies between 300 and 310 m/s; just above it the rod goes through", "perforated",
                  ROUND + SLIDE, body("steel", ROD, shot(315)), body("plate", disc(2)), 120),
    "below": Shot("just below it the plate holds it, and both fly on together", "stopped", ROUND + SLIDE,
                  body("steel", ROD, shot(300)), body("plate", disc(2)), 120),
    "back": Shot("far below it a free plate bounces off the rod", "ricocheted", ROUND + SLIDE,
                 body("steel", ROD, shot(150)), body("plate", disc(2)), 100),
    "turned": Shot("the angle from which the ball leaves the plate lies between 50 and 55 degrees; just beyond it", "ricocheted",
                   PLANE + SLIDE, body("steel", BALL, shot(500, 55)), body("soft", slab(6)), 100),
}


def verdict(rows):
    """Where the rod is at the end of a run that goes on, and how it moved past the plate in the last fifth of its time."""
    late = rows["time"] > 0.8 * rows["time"][-1]
    v = {f"{b}_{a}": np.mean(rows[f"{b}.mean_velocity_{a}"][late]) for b in ("rod", "plate") for a in ("r", "x", "z")
         if f"{b}.mean_velocity_{a}" in rows}
    start = rows["rod.mean_velocity_z"][0]
    w = (v["rod_z"] - v["plate_z"]) / abs(start)
    drift = np.trapezoid(rows["plate.mean_velocity_z"], rows["time"]) if hasattr(np, "trapezoid") else \
        np.trapz(rows["plate.mean_velocity_z"], rows["time"])
    touched = np.max(np.abs(rows["rod.mean_velocity_z"] / start - 1)) > 1e-3
    length = rows["high"] - rows["low"]
    if rows["failed"][-1] > 0.5 * rows["left"][-1] and length[-1] > 1.5 * length[0]:
        return "broken_up", v, w
    if rows["high"][-1] < rows["back"][0] + min(drift, 0) and w < -0.02:
        return ("perforated" if touched else "missed"), v, w
    steady = np.ptp(rows["rod.mean_velocity_z"][late]) < 0.01 * abs(start)
    if w > 0.02 and steady:
        return "ricocheted", v, w
    return ("stopped" if abs(w) < 0.02 else "moving"), v, w


def fire(name):
    one = SHOTS[name]
    text = (f"{one.text}time: {{end: {one.end} us, energy_error: off}}\noutput: {{frames: 0, history: {one.end / 500} us}}\n"
            f"{MATERIALS}bodies:\n  rod: {one.rod}\n  plate: {one.plate}\n")
    pathlib.Path(f"{name}.yaml").write_text(text, encoding="utf-8")
    done = [run(folder, *values, scene=f"{name}.yaml")
            for folder, values in (("short", ["time.stop_when={settled: rod}"]), ("long", []))]
    if not check(all(d.returncode == 0 for d in done), f"{name} runs", "".join(d.text[-400:] for d in done)):
        return
    # Pieces part after the velocity has settled.
    said = summary("long" if one.word == "broken_up" else "short")["outcomes"]["shot"]
    word, v, w = verdict(history("long"))
    print(f"      {name}: rod at {v['rod_z']:.1f}, plate at {v['plate_z']:.1f} m/s, relative {w:.3f}; said {said['outcome']} at "
          f"{1e6 * summary('short')['time']:.1f} us, {said['residual_velocity']['z']:.1f} m/s, main piece {said['main_piece']:.2f}")
    check(word == one.word, f"{name}: {one.why}: {one.word}", word)
    check(said["outcome"] == one.word, f"{name}: and is told so", said)
    check(one.word in ("missed", "broken_up") or (said["settled"] and summary("short")["time"] < 0.9 * summary("long")["time"]), f"{name}: in time", said)
    for what, found, wanted, share in one.exact(v) if one.exact else []:
        scale = abs(wanted) if wanted else abs(history("long")["rod.mean_velocity_z"][0])
        check(abs(found - wanted) < share * scale, f"{name}: velocity of {what}", f"{found:.4g} for {wanted:.4g}")


FAST = ("bounce", "sheet", "dust")
for _name, _shot in SHOTS.items():
    fault(f"outcome-{_name}", f"{_shot.why}: {_shot.word}", long=_name not in FAST)(lambda name=_name: fire(name))
