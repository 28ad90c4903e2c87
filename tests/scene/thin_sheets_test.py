#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A bar that stretches eightfold by its own motion: it tears where points are not split, and holds with the exact force
where they are, in both frames, across an edge of finer cells, with the same bits for any threads and across a restart."""

import pathlib

import h5py
import numpy as np

from scene_support import Folder, check, differences, finish, history, run, summary

RATE, HALF, DENSITY, YIELD = 3e4, 4e-3, 7850.0, 18e6  # 1/s, m, kg/m^3, Pa

BAR = f"""
frame: plane_strain
grid:
  cell: 1 mm
  box: {{min: [0, 0], max: [12 mm, 280 mm]}}
  boundary: {{x_min: symmetry, z_min: symmetry}}
time: {{end: 233.3333 us}}
method: {{numerical_fracture: split, stagger: false}}
materials:
  metal: {{density: {DENSITY}, youngs_modulus: 4 GPa, poisson_ratio: 0.3, eos: linear, viscosity: {{}},
          strength: {{von_mises: {{Y: {YIELD}}}}}}}
bodies:
  bar: {{material: metal, shape: {{box: {{min: [-4 mm, -1, -30 mm], max: [4 mm, 1, 30 mm]}}}},
        velocity: [{-RATE}*x, {RATE}*z]}}
output: {{frames: 25 us, history: 2.5 us}}
"""


def fracture(name):
    return summary(name)["audit"]["numerical_fracture"]


def force_errors(name):
    """{stretch: force over the exact one - 1}, of the stress of what was between a third and two thirds of the bar.
    The bar is perfectly plastic and slows its sides down: F = A [2 Y/sqrt 3 - 2/3 rho (rate a)^2], a = a_0/stretch, and
    rate = RATE/stretch."""
    found = {}
    with h5py.File(f"{name}/frames.h5", "r") as file:
        for frame in file["frames"].values():
            stretch, bar = 1 + RATE * float(frame.attrs["time"]), frame["bar"]
            z, volume = bar["coordinates"][:, 2], (bar["mass"][()] / bar["density"][()]).ravel()
            middle = (z > 10e-3 * stretch) & (z < 20e-3 * stretch)
            force = np.sum((volume * bar["stress"][:, 2])[middle]) / (10e-3 * stretch)
            exact = HALF / stretch * (2 * YIELD / np.sqrt(3) - 2 / 3 * DENSITY * (RATE * HALF / stretch**2) ** 2)
            found[round(stretch, 2)] = force / exact - 1
    return found


def bar():
    pathlib.Path("bar.yaml").write_text(BAR, encoding="utf-8")
    run("watched", "method.numerical_fracture=watch", scene="bar.yaml")
    told = fracture("watched")
    first = 1 + RATE * history("watched")["time"][np.argmax(history("watched")["torn_points"] > 0)]
    check(told["torn_points"] > 50 and 3 < first < 4.3, "left alone the bar is torn", (first, told))
    errors = force_errors("watched")
    check(errors[8.0] < -0.9, "and bears nothing", {k: round(v, 3) for k, v in errors.items()})

    run("split", scene="bar.yaml")
    told, audit = fracture("split"), summary("split")["audit"]
    torn = history("split")["torn_points"]
    check(torn.max() == 0 and told["greatest_stretch"] < 0.4, "split it holds to a stretch of 8", told)
    errors = force_errors("split")
    check(all(abs(errors[stretch]) < 0.01 for stretch in (4.75, 5.5, 6.25, 7.0, 7.75, 8.0)), "with the exact force to 1 %",
          {k: round(v, 4) for k, v in errors.items()})
    check(abs(audit["mass"] / (DENSITY * HALF * 30e-3) - 1) < 1e-12, "no mass is lost", audit["mass"])
    check(abs(audit["energy_residual_fraction"]) < 1e-12 and audit["energy_error_fraction"] < 1e-3, "nor energy",
          (audit["energy_residual_fraction"], audit["energy_error_fraction"]))
    check(audit["split_points"] == summary("split")["points"] - 480, "every new point is counted", audit["split_points"])

    run("three", scene="bar.yaml", threads=3)
    check(not differences("split", "three"), "the same bits on 1 and 3 threads", differences("split", "three"))
    run("parts", "time.end=100 us", scene="bar.yaml")
    done = run("parts", scene="bar.yaml", extra=["--restart", "parts/checkpoint.h5"])
    other = [d for d in differences("split", "parts") if "summary" not in d]
    check(done.returncode == 0 and not other, "the same bits across a restart", other or done.text[-300:])


def rubber():
    """Almost incompressible, so that its pressure is integrated as a fluid's, and yet it bears a tension."""
    begin, end = BAR.index("  metal:"), BAR.index("bodies:")
    law = "  metal: {density: 1000, shear_modulus: 1 MPa, strength: {neo_hookean: {lame_lambda: 100 MPa}}}\n"
    pathlib.Path("rubber.yaml").write_text(BAR[:begin] + law + BAR[end:], encoding="utf-8")
    run("rubber_watched", "method.numerical_fracture=watch", scene="rubber.yaml")
    stretch = history("rubber_watched")["greatest_stretch"].max()
    check(stretch > 0.75, "rubber left alone: how far its points are stretched is told", stretch)
    run("rubber", scene="rubber.yaml")
    told, audit = fracture("rubber"), summary("rubber")["audit"]
    with h5py.File("rubber/frames.h5", "r") as file:
        last = file["frames"][sorted(file["frames"])[-1]]["bar"]
        z, mass = last["coordinates"][:, 2], last["mass"][()].ravel()
    inner = 0.6 * z.max()
    spread, _ = np.histogram(z, bins=8, range=(0, inner), weights=mass)
    check(history("rubber")["torn_points"].max() == 0 and audit["split_points"] > 480, "split it holds", told)
    check(np.max(np.abs(spread / np.mean(spread) - 1)) < 0.1, "and thins evenly", [round(x, 3) for x in spread / np.mean(spread)])
    check(abs(audit["mass"] / (1000 * HALF * 30e-3) - 1) < 1e-12, "no point of it flies off", audit["mass"])


def others():
    """A round bar, a bar across finer cells, and one whose halves may become one again."""
    round_bar = BAR.replace(f"{-RATE}*x", f"{-RATE / 2}*x").replace("x_min: symmetry", "r_min: axis")
    begin, end = round_bar.index("shape:"), round_bar.index("},\n        velocity")
    shape = "shape: {cylinder: {radius: 4 mm, height: 60 mm, base: [0, -30 mm]}"
    pathlib.Path("round.yaml").write_text(round_bar[:begin].replace("plane_strain", "axisymmetric") + shape
                                          + round_bar[end:], encoding="utf-8")
    finer = "grid.refine=[{region: {box: {min: [0, 24 mm], max: [12 mm, 64 mm]}}, level: 1}]"
    for name, (scene, *more) in {"round": ["round.yaml"], "levels": ["bar.yaml", finer],
                                 "merged": ["bar.yaml", "grid.merge=true"]}.items():
        done = run(name, *more, scene=scene)
        audit = summary(name)["audit"] if done.returncode == 0 else {}
        holds = done.returncode == 0 and audit["numerical_fracture"]["torn_points"] == 0
        check(holds and abs(audit["energy_residual_fraction"]) < 1e-12, f"{name}: it holds, and the account closes",
              (summary(name)["points"], audit["numerical_fracture"]["greatest_stretch"]) if holds else done.text[-300:])


def refused():
    for words, settings in {"split are for reference: current": ["method.reference=initial"],
                            "two points per direction": ["method.points_per_direction=1"],
                            "grid.refine": ["method.numerical_fracture=watch", "grid.merge=true"]}.items():
        done = run("refused", *settings, scene="bar.yaml")
        check(done.returncode == 2 and words in done.text, f"refused: {', '.join(settings)}")


with Folder():
    bar()
    rubber()
    others()
    refused()
finish()
