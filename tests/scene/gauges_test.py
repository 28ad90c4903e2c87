#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Gauges of a run as a user gets them: a free surface, points of the material and of space, filters, restart, errors."""

import csv
import os
import pathlib

import h5py
import numpy as np

from scene_support import Folder, check, finish, krater, run, summary

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
gauges:
  visar: {body: plate, at: [0, 10 mm], fields: [velocity_z, speed], every: 20 ns, filter: {butterworth: 5 MHz}}
  inside: {body: plate, from: [0, 2 mm], to: [0, 8 mm], count: 3, fields: [stress_zz, velocity_z, pressure_rate]}
  space: {body: plate, fixed: true, at: [0.1 mm, 5 mm], fields: [velocity_z, von_mises]}
  above: {body: plate, fixed: true, at: [0.1 mm, 11 mm], fields: [velocity_z]}
"""
C = np.sqrt((163.5e9 + 4 / 3 * 80e9) / 7850)
V = 1e6 / (7850 * C)


def table(folder, name):
    with open(os.path.join(folder, f"gauge_{name}.csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    values = np.array([[float(x) for x in row] for row in rows[1:]])
    return {title.split(" [")[0]: values[:, k] for k, title in enumerate(rows[0])}


def near(values, exact, tolerance, what):
    check(abs(np.mean(values) / exact - 1) < tolerance, what, (float(np.mean(values)), exact))


def main():
    with Folder() as folder:
        scene = pathlib.Path(folder, "plate.yaml")
        scene.write_text(PLATE, encoding="utf-8")
        done = run("one", scene=scene)
        check(done.returncode == 0, "the scene runs", done.text[-400:])
        visar, inside, space = (table("one", name) for name in ("visar", "inside", "space"))
        t = visar["time"]
        near(visar["velocity_z"][(t > 12e-3 / C) & (t < 27e-3 / C)], 2 * V, 0.01, "the free surface moves with 2 p/(rho c)")
        check(np.all(np.abs(visar["velocity_z"][t < 8e-3 / C]) < 0.02 * V), "and not before the wave is there")
        check(np.max(np.abs(visar["speed"] - np.abs(visar["velocity_z"]))) < 0.01 * V, "speed is the size of the velocity")
        check(np.allclose(np.diff(t), 20e-9, rtol=1e-6) and "velocity_z_filtered" in visar, "filtered samples are even")
        said = summary("one")["gauges"]["visar"]
        check(said["filter_frequency"] == 5e6 and said["nothing_there_since"] == [None], "the filter's frequency is told", said)
        with h5py.File("one/gauge_visar.h5", "r") as file:
            meaning = file["velocity_z_filtered"].attrs["meaning"]
        check("5e+06 Hz" in str(meaning), "in the columns too", meaning)
        for k, z in enumerate((2e-3, 5e-3, 8e-3)):
            here = (inside["time"] > (z + 1.5e-3) / C) & (inside["time"] < (18.5e-3 - z) / C)
            near(inside[f"stress_zz_{k}"][here], -1e6, 0.01, f"stress at {z} m behind the front")
            near(inside[f"velocity_z_{k}"][here], V, 0.01, f"velocity at {z} m behind the front")
        rise = inside["pressure_rate_1"]
        check(abs(inside["time"][np.argmax(rise)] - 5e-3 / C) < 0.05e-6, "the pressure rises when the wave passes",
              inside["time"][np.argmax(rise)])
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
        for setting, part in (("gauges.visar.body=plat", "did you mean plate"), ("gauges.visar.at=[0, 14 mm]", "lies outside"),
                              ("gauges.visar.fields=[velocity_q]", "carry no 'velocity_q'"), ("gauges.visar.fields=[]", "a list of fields"),
                              ("gauges.visar.every=1 mm", "wrong dimension"), ("gauges.visar.filter={cfc: 1e8}", "four samples a period"),
                              ("gauges.visar.filter={median: 3}", "known: butterworth"), ("gauges.inside.at=[0, 1 mm]", "expected at")):
            done = krater("check", scene, "--set", setting)
            check(done.returncode == 2 and part in done.text and "gauges." in done.text, f"{setting} is refused", done.text[:300])
    finish()


def every():
    """Of 1/1000 of the end by default, which the parts do not share."""
    return ["gauges.inside.every=3 ns", "gauges.space.every=3 ns", "gauges.above.every=3 ns"]


main()
