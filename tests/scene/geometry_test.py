#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes, surfaces and bodies as a user meets them: scenes with STL files, mistakes in them, krater check, plot_scene."""

import os
import pathlib
import re
import struct
import subprocess
import sys

import h5py
import numpy as np

from scene_support import KRATER, ROOT, Folder, check, finish, krater, results_errors

BRACKET = {  # an L of two boxes with a hole, in mm
    "difference": "[{union: [{box: {min: [0, 0, 0], max: [40 mm, 20 mm, 8 mm]}}, "
                  "{box: {min: [0, 0, 0], max: [8 mm, 20 mm, 30 mm]}}]}, "
                  "{cylinder: {radius: 5 mm, height: 1, base: [25 mm, 10 mm, -0.5]}}]"}
SCENE = """title: shapes
frame: 3d
grid: {cell: 2 mm, box: {min: [-50 mm, -50 mm, -50 mm], max: [50 mm, 50 mm, 50 mm]}}
time: {end: 1 us}
materials:
  steel: {density: 7850, shear_modulus: 80 GPa, eos: {linear: {bulk_modulus: 160 GPa}}}
bodies:
  part:
    material: steel
    shape: SHAPE
"""


def scene(name, shape, extra=""):
    pathlib.Path(name).write_text(SCENE.replace("SHAPE", shape) + extra, encoding="utf-8")
    return name


def tetrahedron_stl(name, *, scale=1.0, drop=0, flip=False):
    """A corner of a cube of 30 units: volume 4500."""
    p = np.array([[0, 0, 0], [30, 0, 0], [0, 30, 0], [0, 0, 30]]) * scale
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)][drop:]
    with open(name, "wb") as file:
        file.write(b"\0" * 80 + struct.pack("<I", len(faces)))
        for a, b, c in faces:
            if flip:
                b, c = c, b
            file.write(struct.pack("<12fH", 0, 0, 0, *p[a], *p[b], *p[c], 0))


def volume_of(text):
    match = re.search(r"body part: .*? mass ([0-9.e+-]+) kg.*?volume ([0-9.e+-]+) m\^3", text, re.S)
    return (float(match[1]) / 7850, float(match[2])) if match else (0.0, 0.0)


def expect(name, shape, volume, *settings, extra=""):
    done = krater("check", scene(f"{name}.yaml", shape, extra), *settings)
    points, solid = volume_of(done.stdout)
    check(done.returncode == 0 and abs(solid / volume - 1) < 5e-4 and abs(points / volume - 1) < 1e-3,
          f"{name}: volume", f"{points:.6g} of points, {solid:.6g} of the solid, {volume:.6g} m^3; {done.stderr.strip()}")
    return done.stdout


def ogive_volume(a, length, crh):
    """By its radius y(z) = sqrt(S^2 - z^2) - (S - a), z from the shank on, in closed form."""
    s, n = 2 * crh * a, a * np.sqrt(4 * crh - 1)
    c = s - a
    square = s * s * n - n ** 3 / 3 + c * c * n - c * (n * np.sqrt(s * s - n * n) + s * s * np.arcsin(n / s))
    return np.pi * (square + a * a * (length - n))


def refused(name, expected, shape, extra="", *settings):
    done = krater("check", scene(f"{name}.yaml", shape, extra), *settings)
    missing = [e for e in (rf"{name}\.yaml", *expected) if not re.search(e, done.stderr)]
    check(done.returncode == 2 and not missing and not done.stdout, f"refused: {name}",
          f"{missing} {done.stderr.strip()}")


def shapes():
    pi = np.pi
    expect("tube", "{tube: {inner_radius: 10 mm, outer_radius: 15 mm, height: 30 mm, axis: x}}", pi * 125e-6 * 30e-3)
    expect("ogive", "{ogive: {radius: 8 mm, length: 60 mm, crh: 6, base: [0, 0, 30 mm], axis: -z}}",
           ogive_volume(8e-3, 60e-3, 6))
    bracket = "{" + ", ".join(f"{k}: {v}" for k, v in BRACKET.items()) + "}"
    volume = (40 * 20 * 8 + 8 * 20 * 22 - 25 * pi * 8) * 1e-9
    expect("bracket", bracket, volume)
    expect("turned", f"{{rotate: {{axis: y, angle: 30 degree, shape: {{scale: {{by: 0.8, shape: {bracket}}}}}}}}}",
           0.512 * volume)
    out = expect("ellipsoid", "{ellipsoid: {semi_axes: [30 mm, 20 mm, 10 mm]}}", 4 * pi / 3 * 6e-6)
    mass = 7850 * 4 * pi / 3 * 6e-6
    wanted = [mass / 5 * v for v in (400e-6 + 100e-6, 900e-6 + 100e-6, 900e-6 + 400e-6)]
    found = [float(v) for v in re.search(r"xx ([0-9.e+-]+), yy ([0-9.e+-]+), zz ([0-9.e+-]+)", out).groups()]
    check(np.allclose(found, wanted, rtol=1e-4), "ellipsoid: inertia in krater check", f"{found} {wanted}")
    check("closed form" in out and "thickness" in out, "ellipsoid: by closed form, with thickness")
    expect("half_space", "{intersection: [{sphere: {radius: 40 mm}}, {slab: {axis: z, max: 0}}]}", 2 * pi / 3 * 64e-6)
    expect("zones", "{box: {min: [-20 mm, -20 mm, 0], max: [20 mm, 20 mm, 20 mm]}}", 32e-6, extra="""\
    points: {per_direction: [1, 2, 3], jitter: 0.1, seed: 3,
             zones: [{min: [-5 mm, -5 mm, 10 mm], max: [5 mm, 5 mm, 20 mm], per_direction: 4, falloff: 1}]}
""")


def surfaces():
    tetrahedron_stl("part.stl")
    expect("stl", "{surface: {file: part.stl, unit: mm}}", 4.5e-6)
    expect("inch", "{scale: {by: 0.5, shape: {surface: {file: part.stl, unit: inch}}}}",
           4500 * 0.0254 ** 3 / 8, "--set", "grid.box={min: [-0.4, -0.4, -0.4], max: [0.4, 0.4, 0.4]}", "--set",
           "grid.cell=10 mm")
    expect("cut", "{difference: [{surface: {file: part.stl, unit: mm}}, {slab: {axis: x, max: 15 mm}}]}", 4.5e-6 / 8)
    refused("no_unit", ["missing key 'unit'", "not stated"], "{surface: {file: part.stl}}")
    refused("bad_unit", ["surface.unit", "parsec"], "{surface: {file: part.stl, unit: parsec}}")
    refused("no_file", ["nothing.stl: no such file"], "{surface: {file: nothing.stl, unit: mm}}")
    tetrahedron_stl("open.stl", drop=1)
    refused("open", ["open.stl bounds no volume: 3 open edges", r"\(15, 0, 0\)", "mm", "close_holes"],
            "{surface: {file: open.stl, unit: mm}}")
    text = expect("closed", "{surface: {file: open.stl, unit: mm, repair: {close_holes: 50 mm}}}", 4.5e-6)
    check("1 holes closed" in text, "a repair is told")
    tetrahedron_stl("inverted.stl", flip=True)
    refused("inverted", ["turned inside out", "orient: true"], "{surface: {file: inverted.stl, unit: mm}}")
    expect("turned_out", "{surface: {file: inverted.stl, unit: mm, repair: {orient: true}}}", 4.5e-6)
    data = pathlib.Path("part.stl").read_bytes()
    pathlib.Path("lie.stl").write_bytes(data[:80] + b"\xff\xff\xff\x7f" + data[84:])
    refused("lie", ["lie.stl", "cut short"], "{surface: {file: lie.stl, unit: mm}}")
    refused("axisymmetric", ["body of revolution"], "{surface: {file: part.stl, unit: mm}}", "", "--set",
            "frame=axisymmetric", "--set", "grid.box={min: [0, -50 mm], max: [50 mm, 50 mm]}")


SECOND = """\
  second:
    material: steel
    shape: {box: {min: [0, 0, 0], max: [30 mm, 30 mm, 30 mm]}}
"""


def bodies():
    box = "{box: {min: [-20 mm, -20 mm, -20 mm], max: [10 mm, 10 mm, 10 mm]}}"
    refused("overlap", ["bodies.second: overlaps body 'part' by 1e-06 m", r"\(0.005, 0.005, 0.005\)", "wins_over"],
            box, SECOND)
    done = krater("check", scene("winner.yaml", box, SECOND + "    wins_over: [part]\n"))
    points, solid = volume_of(done.stdout)
    check(done.returncode == 0 and abs(solid / 26e-6 - 1) < 1e-4 and abs(points / 26e-6 - 1) < 1e-3,
          "the loser gives way", f"{points} {solid} {done.stderr}")
    refused("both_win", ["wins over"], box, "    wins_over: [second]\n" + SECOND + "    wins_over: [part]\n")
    refused("win_nobody", ["unknown body 'nobody'"], box, "    wins_over: [nobody]\n")
    refused("outside", ["bodies.part", "outside"], "{move: {by: [1, 0, 0], shape: " + box + "}}")
    refused("thin", ["bodies.part", "0.5 cells thick", "grid.cell"],
            "{box: {min: [-20 mm, -20 mm, 0], max: [20 mm, 20 mm, 1 mm]}}")
    expect("thin_allowed", "{box: {min: [-20 mm, -20 mm, 0], max: [20 mm, 20 mm, 1 mm]}}", 1.6e-6,
           extra="    thin: allowed\n")
    refused("thin_tube", ["cells thick"], "{tube: {inner_radius: 19 mm, outer_radius: 20 mm, height: 30 mm}}")
    refused("polygon", [r"shape\.revolution", "corner 1.*corner 3|cross"],
            "{revolution: {polygon: [[0, 0], [10 mm, 10 mm], [10 mm, 0], [0, 10 mm]]}}")
    refused("nose", [r"shape\.ogive", "nose alone is 0.0265"], "{ogive: {radius: 8 mm, length: 10 mm, crh: 3}}")
    refused("shape", ["unknown shape 'elipsoid'", "did you mean ellipsoid"], "{elipsoid: {semi_axes: [1, 1, 1]}}")
    refused("operand", ["two shapes or more"], "{union: [{sphere: {radius: 20 mm}}]}")
    refused("list", ["expected a list of shapes"], "{union: {sphere: {radius: 20 mm}}}")
    refused("nested", [r"difference\[1\]|difference", "missing key 'radius'"],
            "{difference: [{sphere: {radius: 20 mm}}, {sphere: {}}]}")
    refused("per_direction", ["per_direction", "whole number from 1 to 8"], box, "    points: {per_direction: 2.5}\n")
    refused("fitted_zones", ["no zones"], box,
            "    points: {lattice: body, zones: [{min: [0, 0, 0], max: [1 mm, 1 mm, 1 mm]}]}\n")


def round_trip():
    """resolved.yaml makes the same points again; check -o writes them; plot_scene draws them."""
    path = ROOT / "inputs" / "ogive_layered_plate.yaml"
    done = krater("check", path, "-o", "one")
    check(done.returncode == 0 and not results_errors("one", "--help"), "check -o writes a folder", done.stderr)
    done = krater("check", "one/resolved.yaml", "-o", "two")
    check(done.returncode == 0, "resolved.yaml of shapes, points and winners can be read", done.stderr)
    with h5py.File("one/frames.h5", "r") as a, h5py.File("two/frames.h5", "r") as b:
        same = all(np.array_equal(body["coordinates"][()], b["frames/000000"][name]["coordinates"][()])
                   and np.array_equal(body["mass"][()], b["frames/000000"][name]["mass"][()])
                   for name, body in a["frames/000000"].items())
        check(same and len(a["frames/000000"]) == 5, "and makes the same points")
    tetrahedron_stl("part.stl")
    scene("stl.yaml", "{surface: {file: part.stl, unit: mm}}")
    one = krater("check", "stl.yaml", "-o", "three")
    two = krater("check", "three/resolved.yaml")
    check(one.returncode == 0 and volume_of(one.stdout) == volume_of(two.stdout), "resolved.yaml finds the surface's file",
          two.stderr)
    for frame in ("axisymmetric", "plane_strain", "3d"):
        drawn = subprocess.run([sys.executable, str(ROOT / "tools" / "plot_scene"), str(path), "--set", f"frame={frame}",
                                "--set", "grid.cell=2 mm", "-o", f"{frame}.png"], capture_output=True, text=True,
                               env={**os.environ, "KRATER": KRATER}, check=False)
        check(drawn.returncode == 0 and os.path.getsize(f"{frame}.png") > 20000, f"plot_scene, {frame}", drawn.stderr)
    drawn = subprocess.run([sys.executable, str(ROOT / "tools" / "plot_scene"), "nothing.yaml"], capture_output=True,
                           text=True, env={**os.environ, "KRATER": KRATER}, check=False)
    check(drawn.returncode == 2 and "no such file" in drawn.stderr, "plot_scene of nothing", drawn.stderr.strip())


with Folder():
    shapes()
    surfaces()
    bodies()
    round_trip()
finish()
