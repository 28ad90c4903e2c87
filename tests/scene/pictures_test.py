#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tools/plot_run with options: what is asked for is drawn, at its size, in its format, with one scale for all times; named errors."""

import argparse
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np

from scene_support import ROOT, Folder, check, environment, finish, run

sys.path.insert(0, str(ROOT / "tools"))
import matplotlib  # noqa: E402
matplotlib.use("Agg")
from PIL import Image  # noqa: E402
from plot_run_one import Picture  # noqa: E402
from plot_run_raster import Fraction, Raster  # noqa: E402
from plot_run_solid import LONE, at_corner, voxels  # noqa: E402
from run_reader import Run  # noqa: E402

COARSE = ["grid.cell=0.762mm", "time.end=16us", "output.frames=4us"]
SOLID = ["frame=3d", "grid.cell=1.27mm", "time.end=4us", "output.frames=2us"]


def plot(*arguments):
    done = subprocess.run([str(ROOT / "tools" / "plot_run"), *map(str, arguments)], capture_output=True, text=True, check=False,
                          env=environment())
    check("Traceback" not in done.stderr, f"plot_run {' '.join(map(str, arguments))}", done.stderr[-300:])
    return done


def formats():
    plot("flat", "--field", "pressure", "--time", "8us", "--size", "640x500", "-o", "a.png")
    with Image.open("a.png") as image:
        check(image.size == (640, 500), "a picture of its size", image.size)
        colours = np.unique(np.asarray(image.convert("RGB")).reshape(-1, 3), axis=0)
        check(len(colours) > 100, "and in colour", len(colours))
    for name, first in (("a.pdf", b"%PDF"), ("a.svg", b"<?xml")):
        plot("flat", "--field", "speed", "-o", name)
        check(pathlib.Path(name).read_bytes()[:5].startswith(first), name)
    done = plot("flat", "--field", "stress_zz", "--format", "svg", "--time", "first")
    check(done.stdout.strip() == "flat/pictures/stress_zz_first.svg" and os.path.exists("flat/pictures/stress_zz_first.svg"),
          "its place is printed", done.stdout)


def films():
    plot("flat", "--field", "body", "--film", "gif", "--size", "300x300", "-o", "a.gif")
    with Image.open("a.gif") as film:
        check(film.n_frames == 5, "a GIF of all times", film.n_frames)
    if not shutil.which("ffmpeg"):
        print("skipped: no ffmpeg, so no MP4 (tools/setup --pictures)")
        done = plot("flat", "--film", "mp4")
        check(done.returncode == 2 and "tools/setup --pictures" in done.stderr, "and plot_run says what to do", done.stderr)
        return
    plot("flat", "--film", "mp4", "--size", "301x300", "-o", "a.mp4")
    count = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream=nb_frames", "-of", "csv=p=0", "a.mp4"],
                           capture_output=True, text=True, check=False).stdout
    check(count.strip() == "5", "an MP4 of all times", count)


def options(**changes):
    return argparse.Namespace(**{"field": "pressure", "view": "section", "size": (600, 500), "range": None, **changes})


def one_scale():
    flat = Run("flat")
    scales = [Picture(flat, options(), [number]).colouring.norm for number in (flat.numbers[1], flat.numbers[-1])]
    check((scales[0].vmin, scales[0].vmax) == (scales[1].vmin, scales[1].vmax), "one scale for all times")
    top = max(np.abs(body.values("pressure")).max() for number in flat.numbers for body in flat.bodies(number))
    colouring = Picture(flat, options(), flat.numbers).colouring
    check(0.8 * top < colouring.norm.vmax * colouring.factor <= top, "that holds them", (colouring.norm.vmax, top))
    check("grid.cell=0.762mm" in flat.title() and "output.frames" not in flat.title(), "the title says what --set changed", flat.title())


def fields():
    body = Run("solid").bodies("000002")[0]
    v, s = body.fields["velocity"][()], body.fields["stress"][()]
    check(np.array_equal(body.values("velocity_z"), v[:, 2]) and np.array_equal(body.values("stress_yz"), s[:, 3]), "components")
    check(np.allclose(body.values("speed"), np.sqrt((v ** 2).sum(axis=1)), rtol=1e-14), "speed")
    mises = body.fields["von_mises"][()]
    check(np.allclose(body.values("stress"), mises, rtol=1e-10, atol=1e-9 * mises.max()), "of a stress the equivalent one")


def sections():
    """Of a rod along z across z there is a disc, off its middle a narrower strip."""
    solid = Run("solid")

    def section(where):
        solid.cut_at(where)
        picture = Picture(solid, options(), ["000000"])
        return picture.box * picture.mm, solid.axis_names(), 0.5 * np.ptp(picture.box[2:]) * picture.mm
    box, names, half = section("z=10mm")
    check(names == ("x", "y") and abs(half - 3.81e-3) < 3e-4, "a section across z", (box, names))
    box, names, _ = section("x=0")
    check(names == ("y", "z") and abs(box[3] - 25.4e-3) < 1e-3, "and across x", (box, names))
    image = {}
    for place in ("y=0", "y=3mm"):
        plot("solid", "--section", place, "--field", "body", "--time", "first", "--size", "400x800", "-o", "s.png")
        with Image.open("s.png") as picture:
            rgb = np.asarray(picture.convert("RGB")).astype(int)
        image[place] = (np.abs(rgb - [76, 120, 168]).max(axis=2) < 8)[:720].sum()
    share = image["y=3mm"] / image["y=0"]
    check(abs(share - np.sqrt(1 - (3 / 3.81) ** 2)) < 0.06, "a section off the middle is as wide as the chord there", share)


def debris():
    """What is loose is drawn by itself; the corners of a body, which its outline rounds off, are no debris."""
    def lattice(*counts):
        return np.stack(np.meshgrid(*((np.arange(n) + 0.5) / 2 for n in counts), indexing="ij"), axis=-1).reshape(-1, len(counts))

    raster = Raster((0, 20, 0, 20), 1.0, 400)
    block, sheet, lone = lattice(20, 12) + [3.13, 3.37], lattice(20, 1) + [3.2, 13.1], np.array([[17.3, 17.6]])
    flat = np.concatenate([block, sheet, lone])
    inside = Fraction(raster, "plane_strain", np.insert(flat, 1, 0.0, axis=1), np.full(len(flat), 0.25), [])
    alone = set(inside.isolated())
    check(alone == set(range(len(block), len(flat))), "drawn alone: the sheet of one point and the lone point, no corner of the block",
          f"{len(alone)} of {len(sheet) + 1}; corners {sorted(alone & set(range(len(block))))}")
    cube, lone = lattice(8, 8, 8) * 1.03 + 3.1, np.array([[12.0, 5.0, 5.0]])
    x = np.concatenate([cube, lone])
    low, pixel, shape, field = voxels(x, np.full(len(x), 0.125), 1.0, [])
    phi = field(np.full(len(x), 0.125))
    here = np.clip(np.rint((x - low) / pixel).astype(int), 0, shape - 1)
    left_out = (phi[tuple(here.T)] < LONE) & ~at_corner(phi, here, 1 / pixel)
    check((phi[tuple(here.T)] < LONE).sum() > 8 and list(np.flatnonzero(left_out)) == [len(cube)], "the same in space",
          f"{left_out.sum()} of {(phi[tuple(here.T)] < LONE).sum()} points below {LONE}")


def views():
    if importlib.util.find_spec("vtk") is None or not (shutil.which("Xvfb") or os.environ.get("DISPLAY")):
        print("skipped: no VTK or no screen, so no surfaces (tools/setup --pictures)")
        done = plot("solid", "--view", "iso")
        check(done.returncode == 2 and "tools/setup --pictures" in done.stderr, "and plot_run says what to do", done.stderr)
        return
    for folder, view in (("solid", "+x"), ("flat", "iso")):
        plot(folder, "--view", view, "--field", "body", "--time", "first", "--size", "500x900", "-o", "v.png")
        with Image.open("v.png") as picture:
            rgb = np.asarray(picture.convert("RGB")).astype(int)[100:800]
        blue = rgb[:, :, 2] > rgb[:, :, 0] + 25
        wide, tall = np.ptp(np.flatnonzero(blue.any(axis=0))), np.ptp(np.flatnonzero(blue.any(axis=1)))
        # From the side a rod is 25.4 mm tall for 7.62 mm; `iso` looks down by 24 degrees.
        wanted = 25.4 / 7.62 if view == "+x" else (25.4 * np.cos(np.radians(24)) + 7.62 * np.sin(np.radians(24))) / 7.62
        check(abs(tall / wide / wanted - 1) < 0.06, f"a rod of its proportions from {view}", f"{tall / wide} for {wanted}")


def errors():
    for arguments, texts in (
            (["flat", "--field", "damage"], ["no field 'damage'", "plastic_strain", "stress_zz", "output: {fields: [damage]}"]),
            (["flat", "--field", "velocity_y"], ["no field 'velocity_y'", "velocity_z"]),
            (["flat", "--field", "presure"], ["no field 'presure'", "Did you mean pressure?"]),
            (["flat", "--body", "plate"], ["no body 'plate'", "rod"]),
            (["flat", "--time", "90us"], ["time 90 µs", "5 frames from 0", "16 µs", "time: {end"]),
            (["flat", "--time", "soon"], ["'soon'", "30 us", "`first`, `last`"]),
            (["flat", "--section", "x=0"], ["axisymmetric", "leave --section out"]),
            (["solid", "--section", "w=0"], ["no axis 'w'", "y=0"]),
            (["solid", "--section", "x=80mm"], ["x = 80 mm", "no material", "reach from"]),
            (["solid", "--section", "x=2GPa"], ["'2GPa'", "5 mm"]),
            (["flat", "--field", "pressure", "--range", "3GPa:1GPa"], ["--range", "not below"]),
            (["flat", "--field", "pressure", "--range", "0:3mm"], ["--range", "'3mm'", "GPa"]),
            (["flat", "--size", "wide"], ["1600x1200"]),
            (["flat", "--view", "+z"], ["--view +z", "axisymmetric"]),
            (["gone", "--field", "pressure"], ["gone"])):
        done = plot(*arguments)
        check(done.returncode == 2 and all(text in done.stderr for text in texts), f"plot_run {' '.join(arguments)}",
              done.stderr.strip()[-400:])


def main():
    with Folder():
        run("flat", *COARSE)
        run("solid", *SOLID)
        for test in (formats, films, one_scale, fields, sections, debris, views, errors):
            test()
    finish()


if __name__ == "__main__":
    main()
