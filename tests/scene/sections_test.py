#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Gauges over sections of a body: its force, what passes it, means; lines of them; restart, errors."""

import pathlib

import numpy as np

from scene_support import Folder, check, finish, gauge_table, krater, run, summary

# Uniaxial strain behind a pressure step of 1 MPa; the section of a strip 0.2 mm wide and a metre deep.
STRIP = """
frame: plane_strain
grid: {cell: 0.1 mm, box: {min: [0, -1 mm], max: [0.2 mm, 12 mm]}, boundary: {x_min: symmetry, x_max: symmetry}}
time: {end: 2.4 us}
output: {frames: 1.2 us}
materials:
  steel: {density: 7850, bulk_modulus: 163.5 GPa, shear_modulus: 80 GPa, eos: linear, strength: elastic,
          viscosity: {q_lin: 0.3, q_quad: 0}}
bodies: {plate: {material: steel, shape: {box: {min: [-1, -1, 0], max: [1, 1, 10 mm]}}}}
loads: {push: {body: plate, face: z_min, pressure: 1 MPa}}
gauges:
  cuts: {body: plate, from: [0, 2 mm], to: [0, 8 mm], count: 3, section: z, fields: [force_z, area, stress_zz, velocity_z, force_z_rate], every: 3 ns}
  down: {body: plate, at: [0, 5 mm], section: -z, fixed: true, fields: [force_z, mass_flux], every: 3 ns}
  slant: {body: plate, at: [0.1 mm, 5 mm], section: [3, 4], fields: [force_x, force_z, area], every: 3 ns}
  above: {body: plate, at: [0, 11 mm], section: z, fixed: true, fields: [force_z], every: 0.1 us}
"""
WIDTH, STIFF, ACROSS = 0.2e-3, 163.5e9 + 4 / 3 * 80e9, 163.5e9 - 2 / 3 * 80e9
C = np.sqrt(STIFF / 7850)

# What is beyond a plane of the Taylor rod, by points that lie there; its layers are half or a third of a cell.
ROD = ["time.end=20 us", "grid.cell=0.762 mm", "output.frames=0",
       "measures.P={kind: momentum, body: rod, axis: z, region: {z_min: 10 mm}}", "measures.M={kind: mass, body: rod, region: {z_min: 10 mm}}",
       "gauges={beyond: {measures: [P, M], every: 1 ns}, "
       "cut: {body: rod, at: [0, 10 mm], section: z, fixed: true, fields: [force_z, momentum_flux_z, mass_flux, area], every: 1 ns}, "
       "carried: {body: rod, at: [0, 10 mm], section: z, fields: [force_z, mass_flux, position_z], every: 1 ns}}"]

# A bar of 3 x 30 mm at 30 degrees whose lower half flies along it: the middle takes the wave, and no force across.
LEANING = """
frame: plane_strain
grid: {cell: 0.5 mm, box: {min: [-12 mm, -18 mm], max: [12 mm, 18 mm]}}
time: {end: 2 us, energy_error: off}
output: {frames: 0}
materials: {steel: {density: 7850, bulk_modulus: 163.5 GPa, shear_modulus: 80 GPa, eos: linear, strength: elastic}}
bodies:
  bar: {material: steel, shape: {rotate: {axis: y, angle: 30 degree, shape: {box: {min: [-1.5 mm, -1, -15 mm], max: [1.5 mm, 1, 15 mm]}}}},
        velocity: ["x*sin(pi/6) + z*cos(pi/6) < 0 ? 10*sin(pi/6) : 0", "x*sin(pi/6) + z*cos(pi/6) < 0 ? 10*cos(pi/6) : 0"]}
gauges: {middle: {body: bar, at: [0, 0], section: [0.5, 0.8660254037844386], fields: [force_x, force_z, area], every: 5 ns}}
"""


def near(values, exact, tolerance, what):
    check(abs(np.mean(values) / exact - 1) < tolerance, what, (float(np.mean(values)), exact))


def strip(scene):
    done = run("one", scene=scene)
    if not check(done.returncode == 0, "the strip runs", done.text[-400:]):
        return
    cuts, down, slant = (gauge_table("one", name) for name in ("cuts", "down", "slant"))
    t = cuts["time"]
    for k, z in enumerate((2e-3, 5e-3, 8e-3)):
        here = (t > (z + 1.5e-3) / C) & (t < (18.5e-3 - z) / C)
        near(cuts[f"force_z_{k}"][here], -1e6 * WIDTH, 0.01, f"force through the section at {z} m")
        near(cuts[f"stress_zz_{k}"][here], -1e6, 0.01, f"mean stress of the section at {z} m")
        check(np.max(np.abs(cuts[f"area_{k}"] / WIDTH - 1)) < 1e-4, f"area of the section at {z} m", cuts[f"area_{k}"][0])
    fastest = t[np.argmin(cuts["force_z_rate_1"])]
    check(abs(fastest - 5e-3 / C) < 0.05e-6, "the force rises when the wave passes", (fastest, 5e-3 / C))
    here = (t > 6.5e-3 / C) & (t < 13.5e-3 / C)
    near(down["force_z"][here], 1e6 * WIDTH, 0.01, "seen from the other side it is its reaction")
    near(down["mass_flux"][here], -1e6 / C * WIDTH, 0.01, "mass passes a plane of space with rho v")
    near(slant["area"], WIDTH / 0.8, 0.01, "area of an oblique section")
    near(slant["force_z"][here], -1e6 * WIDTH, 0.01, "the same force passes an oblique section")
    near(slant["force_x"][here], -1e6 * ACROSS / STIFF * WIDTH * 0.6 / 0.8, 0.01, "and what the stress across does")
    again = krater("check", "one/resolved.yaml")
    check(again.returncode == 0, "the resolved scene reads again", again.text[:300])
    said = summary("one")["gauges"]
    check(said["above"]["nothing_there_since"] == [0] and said["cuts"]["nothing_there_since"] == [None] * 3,
          "a section without matter says since when", said["above"])


def rod():
    done = run("rod", *ROD)
    if not check(done.returncode == 0, "the rod runs", done.text[-400:]):
        return
    cut, carried, beyond = (gauge_table("rod", name) for name in ("cut", "carried", "beyond"))
    step = np.diff(cut["time"])

    def total(rate):
        return np.concatenate([[0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * step)])

    check(abs(cut["area"][0] / (np.pi * 3.81e-3**2) - 1) < 1e-12, "area of the round section", cut["area"][0])
    layer = 0.762 / 3 / 15.4  # of what is beyond at the start
    passed, pushed, moved = total(cut["momentum_flux_z"]), total(-cut["force_z"]), beyond["P"] - beyond["P"][0]
    off = np.max(np.abs(passed + pushed - moved)) / abs(beyond["P"][0])
    check(off < layer and abs(passed[-1] + pushed[-1] - moved[-1]) < 0.01 * abs(moved[-1]),
          "what passes and the force make up the momentum beyond the section", (off, layer))
    check(min(abs(passed[-1]), abs(pushed[-1])) > 0.1 * abs(beyond["P"][0]), "each of them its part", (passed[-1], pushed[-1]))
    off = np.max(np.abs(total(cut["mass_flux"]) - (beyond["M"] - beyond["M"][0]))) / beyond["M"][0]
    check(off < layer, "mass that passes is missing beyond", (off, layer))
    drift = abs(total(carried["mass_flux"])[-1] / total(cut["mass_flux"])[-1])
    check(abs(carried["position_z"][0] - 10e-3) < 1e-12, "a section lies where it was asked for, not at its point", carried["position_z"][0])
    check(drift < 0.05 and carried["position_z"][0] - carried["position_z"][-1] > 3e-3, "through a section of the material none passes",
          (drift, carried["position_z"][-1]))


def leaning(folder):
    scene = pathlib.Path(folder, "leaning.yaml")
    scene.write_text(LEANING, encoding="utf-8")
    done = run("leaning", scene=scene)
    if not check(done.returncode == 0, "the leaning bar runs", done.text[-400:]):
        return
    rows = gauge_table("leaning", "middle")
    along, across = (rows["force_x"] * a + rows["force_z"] * b for a, b in ((0.5, np.sqrt(0.75)), (np.sqrt(0.75), -0.5)))
    shear, bulk = 80e9, 163.5e9
    E, nu = 9 * bulk * shear / (3 * bulk + shear), (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear)
    late = rows["time"] > 1e-6
    near(along[late], -np.sqrt(7850 * E / (1 - nu**2)) * 10 / 2 * 3e-3, 0.03, "the wave's force in a bar that leans, rho c v/2")
    across = np.max(np.abs(across[late])) / np.max(np.abs(along))  # the jump itself lies in steps over the cells
    check(across < 0.02, "and none across", across)


def removed(scene):
    """The point that carried a section is taken away."""
    values = ["materials.steel.strength={von_mises: {Y: 0.1 MPa}}", "materials.steel.damage={maximum_plastic_strain: {eps_max: 1e-6}}",
              "materials.steel.failure={action: remove}", "gauges.cuts.from=[0, 0.05 mm]", "loads.push.pressure=10 MPa", "time.end=1 us"]
    done = run("gone", *values, scene=scene)
    gone, rows = summary("gone")["gauges"]["cuts"]["nothing_there_since"][0], gauge_table("gone", "cuts")
    check(gone is not None and gone == rows["time"][np.argmax(np.isnan(rows["force_z_0"]))] and f"nothing is there since {gone:.4g} s" in done.text,
          "a section whose point was removed says when", (gone, done.text[-300:]))


def main():
    with Folder() as folder:
        scene = pathlib.Path(folder, "strip.yaml")
        scene.write_text(STRIP, encoding="utf-8")
        strip(scene)
        run("two", scene=scene, threads=2)
        run("parts", "time.end=1.2 us", scene=scene)
        run("parts", scene=scene, extra=["--restart", "parts/checkpoint.h5"])
        for name in ("cuts", "down", "slant"):
            files = [pathlib.Path(f, f"gauge_{name}.csv").read_bytes() for f in ("one", "two", "parts")]
            check(files[0] == files[1], f"{name}: the same bits on two threads")
            check(files[0] == files[2], f"{name}: the same bits across a restart")
        removed(scene)
        rod()
        leaning(folder)
        for setting, part in (("gauges.down.section=y", "no direction"), ("gauges.down.section=[0, 0]", "no direction"),
                              ("gauges.cuts.to=[0, 14 mm]", "place 2 lies outside plate"), ("gauges.down.fields=[force_q]", "area, force_z"),
                              ("gauges.more={body: plate, at: [0, 5 mm], fields: [force_z]}", "with section: area"),
                              ("gauges.down.count=5", "expected at")):
            done = krater("check", scene, "--set", setting)
            check(done.returncode == 2 and part in done.text and "gauges." in done.text, f"{setting} is refused", done.text[:300])
    finish()


main()
