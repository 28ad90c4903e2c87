#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of effects: who calls for them, what they cost, what the last ablation says, what speed lets expect."""

import os
import pathlib
import re

from scene_support import Folder, check, differences, finish, krater, summary

SCENE = """
frame: axisymmetric
grid: {cell: 1 mm, box: {min: [0, 0], max: [12 mm, 27 mm]}, boundary: {z_min: wall, r_min: axis}}
time: {end: 20 us}
materials:
  copper:
    density: 8960
    shear_modulus: 46 GPa
    eos: {mie_gruneisen_shock: {c0: 3940 m/s, S1: 1.489, gamma0: 2.02}}
    strength: {johnson_cook: {A: 90 MPa, B: 292 MPa, n: 0.31, C: 0.025, m: 1.09, T_ref: 294 K, T_melt: 1356 K,
                              epsdot0: 1 s^-1}}
    initial_temperature: 294 K
    heating: {plastic_work: {cp: 383}}
    damage: {maximum_plastic_strain: {eps_max: 0.5}}
    spall: {strength: 1.2 GPa}
    viscosity: {}
bodies: {rod: {material: copper, shape: {cylinder: {radius: 3.81 mm, height: 25.4 mm}}, velocity: [0, -1 m/s]}}
measures: {final_length: {kind: extent, body: rod, axis: z}}
"""
PAID_FOR_NOTHING = ["damage", "heating", "spall", "viscosity"]


def idle(text):
    return sorted(re.findall(r"advice: copper: (\w+) cannot be felt", text))


def at_rest_nearly():
    said = krater("check", "slow.yaml").stdout
    check(idle(said) == PAID_FOR_NOTHING, "a 1 m/s impact that pays for what it cannot feel is told so", said)
    check("0.0013 K of the 1062 K" in said, "with the rise of temperature, v^2/(2 cp)")
    check("35.3 MPa of the 1200 MPa" in said, "with the stress of the impact, rho c0 v")
    check("strain of 5e-05" in said, "with the plastic strain, rho v^2/(2 Y)")
    check("11 MPa (q_lin rho c0 v), 12 % of the yield stress" in said, "with the viscosity of a front")
    fast = krater("check", "slow.yaml", "--set", "bodies.rod.velocity=[0, -190 m/s]").stdout
    check(idle(fast) == [], "at 190 m/s all of it is felt", idle(fast))
    brief = krater("check", "slow.yaml", "--set", "bodies.rod.velocity=[0, -190 m/s]", "--set", "time.end=1 us").stdout
    check(idle(brief) == [], "however short the run", idle(brief))
    crawl = krater("check", "slow.yaml", "--set", "bodies.rod.velocity=[0, -0.1 m/s]").stdout
    check("strength" in idle(crawl), "at 0.1 m/s nothing flows", idle(crawl))
    driven = krater("check", "slow.yaml", "--set", "loads={push: {body: rod, face: z_max, pressure: 1 GPa}}").stdout
    check(idle(driven) == [], "a load may do what the speed cannot", idle(driven))


def who_calls():
    line = 1 + SCENE.split("\n").index("    heating: {plastic_work: {cp: 383}}")
    said = krater("check", "slow.yaml").stdout
    check(re.search(rf"^  heating: plastic_work +slow.yaml:{line} +\d+ +- +- +cannot be felt$", said, re.MULTILINE),
          "an effect names the line that calls for it", said)
    check("  off: contact" in said, "and what is off is said")
    none = krater("check", "slow.yaml", "--set", "materials.copper.damage=none", "--set",
                  "materials.copper.spall=none").stdout
    check("off: damage, spall" in none, "without a block it is off", none)


def cost():
    krater("run", "slow.yaml", "-o", "out", "-j", 1)
    s = summary("out")
    rows = {row["effect"]: row for row in s["effects"]}
    check(rows["viscosity"]["bytes_per_point"] == 8 and rows["damage"]["bytes_per_point"] == 8,
          "viscosity and damage cost a column each", rows)
    times = s["machine"]["ns_per_point_step"]
    check(set(times) >= {f"copper.{name}" for name in (*PAID_FOR_NOTHING, "strength", "eos", "all_stages")},
          "the time of each effect is measured", times)
    check(0 < times["copper.damage"] < times["copper.all_stages"] < times["whole_step"], "of a step's", times)
    check(rows["heating"]["advice"] == "cannot be felt", "scripts get the advice")
    krater("run", "slow.yaml", "-o", "two", "-j", 2)
    check(not differences("out", "two"), "the samples leave the bits alone", differences("out", "two"))


def influence():
    pathlib.Path("abl").mkdir()
    text = "# scene slow.yaml 0.001\nmaterials.copper.damage\t1.2\tfinal_length\tkeep\n" \
           "materials.copper.eos materials.steel.eos\t0.3\tfinal_length\tcould go\n"
    pathlib.Path("abl/influence.tsv").write_text(text, encoding="utf-8")
    said = krater("check", "slow.yaml").stdout
    check(re.search(r"damage: maximum_plastic_strain .* 1.2 % of final_length +", said),
          "the last ablation is told", said)
    check(re.search(r"eos: .* 0.3 % of final_length, with others +could go$", said, re.MULTILINE),
          "what it says is the advice", said)
    coarse = krater("check", "slow.yaml", "--set", "grid.cell=1.5 mm").stdout
    check("final_length, at 0.001 m" in coarse, "that it is of another cell is said")
    later = os.stat("abl/influence.tsv").st_mtime + 10
    os.utime("slow.yaml", (later, later))
    check("scene changed since" in krater("check", "slow.yaml").stdout, "that the scene is younger is said")
    pathlib.Path("abl/influence.tsv").write_text(text.replace("slow.yaml", "other.yaml"), encoding="utf-8")
    check("of final_length" not in krater("check", "slow.yaml").stdout, "another scene's does not count")


with Folder():
    pathlib.Path("slow.yaml").write_text(SCENE, encoding="utf-8")
    at_rest_nearly()
    who_calls()
    cost()
    influence()
finish()
