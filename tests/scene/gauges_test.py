#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Gauges of a run as a user gets them: a free surface, points of the material and of space, filters, restart, errors."""

import os
import pathlib

import h5py
import numpy as np

from scene_support import Folder, check, finish, gauge_table, history, krater, results_errors, run, summary

# A plate of 10 mm in uniaxial strain: a pressure of 1 MPa from below reaches the free surface after L/c.
PLATE = """
frame: plane_strain
grid: {cell: 0.1 mm, box: {min: [0, -1 mm], max: [0.2 mm, 12 mm]}, boundary: {x_min: symmetry, x_max: symmetry}}
time: {end: 3 us}
output: {frames: 1.5 us}
materials:
  steel: {density: 7850, bulk_modulus: 163.5 GPa, shear_modulus: 80 GPa, eos: linear, strength: elastic,
          viscosity: {q_lin: 0.3, q_quad: 0}}
bodies: {plate: {material: steel, shape: {box: {min: [-1, -1, 0], max: [1, 1, 10 mm]}}}}
loads: {push: {body: plate, face: z_min, pressure: 1 MPa}}
measures: {weight: {kind: mass, body: plate}, late: {kind: settling_time, body: plate, axis: z}, slows: {kind: deceleration, body: plate, axis: z}}
gauges:
  visar: {body: plate, at: [0, 10 mm], fields: [velocity_z, speed], every: 20 ns, filter: {butterworth: 5 MHz}}
  inside: {body: plate, from: [0, 2 mm], to: [0, 8 mm], count: 3, fields: [stress_zz, velocity_z, pressure_rate, strain_zz, strain_xx]}
  space: {body: plate, fixed: true, at: [0.1 mm, 5 mm], fields: [velocity_z, von_mises]}
  above: {body: plate, fixed: true, at: [0.1 mm, 11 mm], fields: [velocity_z]}
"""
C = np.sqrt((163.5e9 + 4 / 3 * 80e9) / 7850)
V = 1e6 / (7850 * C)


def near(values, exact, tolerance, what):
    check(abs(np.mean(values) / exact - 1) < tolerance, what, (float(np.mean(values)), exact))


def main():
    with Folder() as folder:
        scene = pathlib.Path(folder, "plate.yaml")
        scene.write_text(PLATE, encoding="utf-8")
        done = run("one", scene=scene)
        check(done.returncode == 0, "the scene runs", done.text[-400:])
        visar, inside, space = (gauge_table("one", name) for name in ("visar", "inside", "space"))
        t = visar["time"]
        near(visar["velocity_z"][(t > 12e-3 / C) & (t < 27e-3 / C)], 2 * V, 0.01, "the free surface moves with 2 p/(rho c)")
        check(np.all(np.abs(visar["velocity_z"][t < 8e-3 / C]) < 0.02 * V), "and not before the wave is there")
        check(np.max(np.abs(visar["speed"] - np.abs(visar["velocity_z"]))) < 0.01 * V, "speed is the size of the velocity")
        check(np.allclose(np.diff(t), 20e-9, rtol=1e-6) and "velocity_z_filtered" in visar, "filtered samples are even")
        said = summary("one")["gauges"]["visar"]
        check(said["filter_frequency"] == 5e6 and said["nothing_there_since"] == [None], "the filter's frequency is told", said)
        with h5py.File("one/history.h5", "r") as file:
            visar_group = file["gauges/visar"]
            meaning, unit = (visar_group["velocity_z_filtered"].attrs[a] for a in ("meaning", "unit"))
            check(visar_group.attrs["filter_frequency"] == 5e6 and np.array_equal(visar_group["velocity_z"][()], visar["velocity_z"]),
                  "history.h5 holds the same", dict(visar_group.attrs))
        check("5e+06 Hz" in str(meaning) and unit == "m/s", "in the columns too", (meaning, unit))
        for k, z in enumerate((2e-3, 5e-3, 8e-3)):
            here = (inside["time"] > (z + 1.5e-3) / C) & (inside["time"] < (18.5e-3 - z) / C)
            near(inside[f"stress_zz_{k}"][here], -1e6, 0.01, f"stress at {z} m behind the front")
            near(inside[f"velocity_z_{k}"][here], V, 0.01, f"velocity at {z} m behind the front")
        rise = inside["pressure_rate_1"]
        check(abs(inside["time"][np.argmax(rise)] - 5e-3 / C) < 0.05e-6, "the pressure rises when the wave passes",
              inside["time"][np.argmax(rise)])
        # Behind the front of a uniaxial wave h_zz = ln(1 + eps), eps = sigma/(rho c^2); the rest of the tensor is nothing.
        here = (inside["time"] > 6.5e-3 / C) & (inside["time"] < 13.5e-3 / C)
        near(inside["strain_zz_1"][here], np.log(1 - 1e6 / (7850 * C * C)), 0.01, "logarithmic strain behind the front")
        check(np.max(np.abs(inside["strain_xx_1"])) < 1e-2 * 1e6 / (7850 * C * C), "and none across", np.max(np.abs(inside["strain_xx_1"])))
        here = (space["time"] > 7e-3 / C) & (space["time"] < 13e-3 / C)
        near(space["velocity_z"][here], V, 0.01, "velocity at a place in space")
        check(summary("one")["gauges"]["above"]["nothing_there_since"] == [0], "a place without matter says since when")
        run("two", scene=scene, threads=2)
        run("parts", "time.end=1.5 us", *every(), scene=scene)
        run("parts", *every(), scene=scene, extra=["--restart", "parts/checkpoint.h5"])
        run("whole", *every(), scene=scene)
        for name in ("visar", "inside", "space"):
            files = [pathlib.Path(f, f"gauge_{name}.csv").read_bytes() for f in ("one", "two", "parts", "whole")]
            check(files[0] == files[1], f"{name}: the same bits on two threads")
            check(files[2] == files[3], f"{name}: the same bits across a restart")
        pathlib.Path("two/gauge_other.csv").write_text("of another scene", encoding="utf-8")
        run("two", "time.end=0.1 us", scene=scene)
        check(not os.path.exists("two/gauge_other.csv") and os.path.exists("two/gauge_visar.csv"), "a fresh run clears what gauges left")
        check(results_errors("one") == "", "the results are whole", results_errors("one"))
        removed(scene)
        bent(folder)
        for setting, part in (("gauges.visar.body=plat", "did you mean plate"), ("gauges.visar.at=[0, 14 mm]", "lies outside"),
                              ("gauges.visar.fields=[velocity_q]", "carry no 'velocity_q'"), ("gauges.visar.fields=[]", "a list of fields"),
                              ("gauges.visar.every=1 mm", "wrong dimension"), ("gauges.visar.filter={cfc: 1e8}", "four samples a period"),
                              ("gauges.visar.filter={median: 3}", "known: butterworth"), ("gauges.inside.at=[0, 1 mm]", "expected at"),
                              ("gauges.visar={measures: [size]}", "size"), ("gauges.visar={measures: [weight, late]}", "whole history"),
                              ("gauges.visar={measures: [slows_rate]}", "a rate already"), ("gauges.visar={measures: []}", "a list of"),
                              ("gauges.visar.fields=[strain_qq]", "carry no 'strain_qq'")):
            done = krater("check", scene, "--set", setting)
            check(done.returncode == 2 and part in done.text and "gauges." in done.text, f"{setting} is refused", done.text[:300])
    finish()


def removed(scene):
    """A point that fails is taken away, and the gauge says when."""
    values = ["materials.steel.strength={von_mises: {Y: 0.1 MPa}}", "materials.steel.damage={maximum_plastic_strain: {eps_max: 1e-6}}",
              "materials.steel.failure={action: remove}", "gauges.inside.every=3 ns", "gauges.inside.from=[0, 0.05 mm]", "loads.push.pressure=10 MPa", "output.frames=0"]
    done = run("gone", *values, scene=scene)
    said = summary("gone")["gauges"]["inside"]["nothing_there_since"]
    rows = gauge_table("gone", "inside")
    first = rows["time"][np.argmax(np.isnan(rows["velocity_z_0"]))]
    check(done.returncode == 0 and said[0] is not None and said[0] == first and f"gauge inside, place 0: nothing is there since {first:.4g} s" in done.text,
          "a gauge whose point was removed says when", (said, first, done.text[-300:]))


TURN = """
frame: plane_strain
grid: {cell: 1 mm, box: {min: [-20 mm, -30 mm], max: [20 mm, 20 mm]}}
time: {end: 20 us}
output: {frames: 0}
materials: {soft: {density: 2700, bulk_modulus: 75 GPa, shear_modulus: 26 GPa, eos: linear, strength: elastic}}
bodies:
  rod: {material: soft, shape: {rotate: {axis: y, angle: 30 degree, shape: {box: {min: [-2 mm, -1, -10 mm], max: [2 mm, 1, 10 mm]}}}},
        velocity: {speed: 300 m/s, angle: 10 degree}, turn: {axis: y, rate: 500 1/s}}
measures:
  tip: {kind: tilt, body: rod, axis: z}
  yaw: {kind: yaw, body: rod}
  way: {kind: obliquity, body: rod, axis: z}
  spin: {kind: angular_momentum, body: rod}
  along: {kind: mean_velocity, body: rod, axis: [0.17364817766693, -0.98480775301221]}
  sound: {kind: sound_mass, body: rod}
  foot: {kind: bulge, body: rod, face: z_min, history: true}
gauges: {flight: {measures: [yaw, spin, along, foot_rate], every: 1 us}}
"""


def bent(folder):
    """A rod of 4 x 20 mm at 30 degrees, on a way at 10 degrees, turning slowly."""
    scene = pathlib.Path(folder, "turn.yaml")
    scene.write_text(TURN, encoding="utf-8")
    done = run("turn", scene=scene)
    if not check(done.returncode == 0, "a turning rod flies", done.text[-400:]):
        return
    rows, degree = history("turn"), np.pi / 180
    turned = 500 * rows["time"]
    check(abs(rows["way"][0] - 10 * degree) < 1e-9 and abs(rows["along"][0] - 300) < 1e-9, "obliquity of its way", rows["way"][0] / degree)
    for name, exact in (("tip", 30 * degree + turned), ("yaw", 40 * degree + turned)):
        off = max(abs(abs(rows[name] - rows[name][0]) - turned))
        check(off < 0.02 * turned[-1], f"{name} turns as the rod does", off / degree)
        check(min(abs(rows[name][0] - a * degree) for a in (20, 30, 40)) < 0.5 * degree, f"{name} at the start", rows[name][0] / degree)
    inertia = rows["sound"][0] * (4e-3**2 + 20e-3**2) / 12
    check(abs(rows["spin"][0] / (500 * inertia) - 1) < 0.02 and np.ptp(rows["spin"]) < 1e-3 * rows["spin"][0], "its own angular momentum",
          (rows["spin"][0], 500 * inertia))
    check(np.isfinite(gauge_table("turn", "flight")["foot_rate"]).all() and abs(rows["foot"][-1] - 300 * np.cos(10 * degree) * 20e-6) < 2e-4,
          "a bulge is counted from the face at the start", rows["foot"][-1])


def every():
    """Of 1/1000 of the end by default, which the parts do not share."""
    return ["gauges.inside.every=3 ns", "gauges.space.every=3 ns", "gauges.above.every=3 ns"]


main()
