#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures of a run as a user gets them: columns, fragment list, field, tools; against an independent sum in Python."""

import subprocess

import h5py
import numpy as np

from scene_support import ROOT, Folder, check, finish, history, krater, results_errors, run, summary

BAR = ROOT / "inputs" / "bar_pulled_apart.yaml"
BALLS = """
frame: axisymmetric
grid: {cell: 0.5 mm, box: {min: [0, -12 mm], max: [8 mm, 8 mm]}, boundary: {r_min: axis}}
time: {end: 3 us, energy_error: off}
materials:
  metal: {density: 7850, youngs_modulus: 200 GPa, poisson_ratio: 0.3, eos: linear, strength: {von_mises: {Y: 300 MPa}},
          viscosity: {}}
bodies:
  plate: {material: metal, shape: {cylinder: {radius: 6 mm, height: 4 mm, base: [0, -4 mm]}}}
  ball: {material: metal, shape: {sphere: {radius: 2 mm, center: [0, 2.2 mm]}}, velocity: [0, -900 m/s]}
contact: {friction: 0}
output: {history: 0.1 us}
measures:
  depth: {kind: penetration_depth, body: ball, target: plate, face: z_max}
  deepest: {kind: penetration_depth, body: ball, target: plate, face: z_max, keep: largest}
  crater: {kind: crater_depth, body: plate, face: z_max, history: true}
  opening: {kind: crater_diameter, body: plate, face: z_max}
  hole: {kind: hole_diameter, body: plate}
  push: {kind: deceleration, body: ball, axis: z}
  peak: {kind: deceleration, body: ball, axis: z, keep: largest}
  momentum: {kind: momentum, body: [ball, plate], axis: z}
  energy: {kind: kinetic_energy, body: plate}
  bulk: {kind: mass, body: plate, region: {z_min: -4 mm, z_max: -2 mm}}
references: {depth: {value: 2 mm, source: none}}
"""


def value(s, name):
    return s["measures"][name]["value"]


def last(output, body):
    with h5py.File(f"{output}/frames.h5", "r") as file:
        group = file["frames"][sorted(file["frames"])[-1]][body]
        return {name: np.array(group[name]) for name in group}


def fragments():
    """The bar breaks: every piece of the list has the mass, points and velocity of its points in the frame."""
    done = run("apart", "grid.cell=0.5 mm", "output.fields=[fragment, mass]", "measures.pieces={kind: fragments, body: bar, least_points: 6}",
               "measures.all={kind: mass, body: bar}", "measures.lost={kind: mass_lost, body: bar}",
               "measures.top={kind: mean_velocity, body: bar, axis: z, region: {z_min: 4 mm}, piece: largest}", scene=BAR)
    if not check(done.returncode == 0, "bar pulled apart, with measures", done.stderr[-300:]):
        return
    s, f = summary("apart"), last("apart", "bar")
    pieces, dust = s["fragments"]["pieces"]["pieces"], s["fragments"]["pieces"]["dust"]
    number, mass = f["fragment"].ravel().astype(int), f["mass"].ravel()
    check(len(pieces) >= 2 and value(s, "pieces") == len(pieces), f"{len(pieces)} pieces, value and list agree")
    check(all(a["mass"] >= b["mass"] for a, b in zip(pieces, pieces[1:])), "the list is sorted by mass")
    good = True
    for piece in pieces:
        mine = number == piece["number"]
        v = (mass[mine, None] * f["velocity"][mine]).sum(0) / mass[mine].sum()
        size = np.ptp(f["coordinates"][mine], axis=0) + 0.25e-3
        good &= bool(mine.sum() == piece["points"] and np.isclose(mass[mine].sum(), piece["mass"], rtol=1e-12)
                     and np.isclose(v[2], piece["velocity"]["z"], rtol=1e-9, atol=1e-9)
                     and np.isclose(size[2], piece["size"]["z"], rtol=1e-9))
    check(good, "mass, points, velocity, size of every piece are those of its points in the last frame")
    check(np.isclose(sum(p["mass"] for p in pieces) + dust["mass"], value(s, "all"), rtol=1e-12)
          and sum(p["points"] for p in pieces) + dust["points"] == len(mass), "pieces and dust make up the bar")
    check(np.isclose(value(s, "lost"), (mass * (f["failed"].ravel() > 0.5)).sum(), rtol=1e-12), "mass lost: what failed",
          f"{value(s, 'lost'):.3g} kg")
    beyond = f["coordinates"][:, 2] >= 4e-3
    v = (mass[beyond] * f["velocity"][beyond, 2]).sum() / mass[beyond].sum()
    check(abs(value(s, "top") - v) < 1, "mean velocity of the largest piece beyond a plane", f"{value(s, 'top'):.4g} m/s")
    shown = subprocess.run([ROOT / "tools" / "show_summary", "apart"], capture_output=True, text=True, check=False)
    check(shown.returncode == 0 and f"pieces: {len(pieces)} pieces of at least 6 points" in shown.stdout,
          "show_summary lists the fragments", shown.stderr)


def impact():
    with open("ball.yaml", "w", encoding="utf-8") as file:
        file.write(BALLS)
    done = run("ball", scene="ball.yaml")
    if not check(done.returncode == 0, "ball on plate", done.stderr[-300:]):
        return
    s, h = summary("ball"), history("ball")
    ball = last("ball", "ball")
    check(abs(s["measures"]["depth"]["face"]) < 0.02 * 0.5e-3, "the original face is where the scene put it")
    front = ball["coordinates"][:, 2].min() - 0.125e-3
    check(abs(value(s, "depth") + front) < 0.1e-3, "penetration depth is the ball's lowest point",
          f"{value(s, 'depth'):.4g} and {-front:.4g} m")
    check(value(s, "deepest") == np.nanmax(h["depth"]) and value(s, "peak") == np.nanmax(h["push"]),
          "keep: largest is the largest of the rows")
    check("difference_percent" in s["measures"]["depth"], "the reference stands beside the value")
    check(0.8 < value(s, "crater") / value(s, "depth") < 1.15 and h["crater"][-1] == value(s, "crater")
          and "opening" not in h, "the crater is as deep as the ball went; history as asked",
          f"{value(s, 'crater'):.4g} m")
    check(1.5e-3 < value(s, "opening") < 5.5e-3 and value(s, "hole") < 0.1e-3, "crater's opening, no hole",
          f"{value(s, 'opening'):.4g} m")
    check(np.ptp(h["momentum"]) < 1e-9 * abs(h["momentum"][0]), "momentum of both is constant")
    speed = np.abs(np.diff(np.abs(h["ball.mean_velocity_z"])) / np.diff(h["time"]))
    check(np.allclose(np.abs(h["push"][1:]), speed, rtol=1e-6, atol=1), "deceleration from row to row")
    check(0.95 < value(s, "bulk") / (7850 * np.pi * 6e-3**2 * 2e-3) < 1.05, "mass in a region",
          f"{value(s, 'bulk'):.4g} kg")
    errors = results_errors("ball")
    check(not errors, "results are whole", errors)


def refused():
    for text, part in (("kind: internal_energy, body: [ball, nobody]", "unknown body 'nobody'"),
                       ("kind: mean, body: [ball, plate], field: damage", "no field 'damage'"),
                       ("kind: hole_diametre, body: plate", "did you mean hole_diameter")):
        done = krater("run", "ball.yaml", "-o", "no", "--set", f"measures.bad={{{text}}}")
        check(done.returncode == 2 and part in done.stderr and "measures.bad" in done.stderr, f"refused: {text}",
              done.stderr.strip()[-200:])


with Folder():
    fragments()
    impact()
    refused()
finish()
