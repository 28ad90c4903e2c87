# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of `krater study` share: a scene of seconds, and its command line within this process, for to start
Python anew takes longer than most of these studies."""

import contextlib
import io
import os
import pathlib
import sys
import types

from scene_support import KRATER, ROOT

os.environ["KRATER"] = KRATER
sys.path.insert(0, str(ROOT / "tools" / "krater_study"))
import command  # noqa: E402

SCENE = """
frame: plane_strain
grid: {cell: 0.5 mm, box: {min: [0, 0], max: [1 mm, 12 mm]},
       boundary: {z_min: symmetry, x_min: symmetry, x_max: symmetry}}
time: {end: 1 us}
materials: {al: {density: 2785, eos: {mie_gruneisen_shock: {c0: 5328 m/s, S1: 1.338, gamma0: 2.0}}, viscosity: {}}}
bodies: {plate: {material: al, shape: {box: {min: [-1, -1, 0], max: [1, 1, 10 mm]}}, velocity: [0, -1 km/s]}}
measures:
  velocity: {kind: mean_velocity, body: plate, axis: z}
  gone: {kind: mean_velocity, body: plate, axis: z, region: {z_min: 11 mm}}
references: {velocity: {value: -333.4 m/s, source: momentum}}
"""


def write(name, text):
    pathlib.Path(name).write_text(text, encoding="utf-8")
    return name


def study_of(name, *words):
    """`krater study NAME`."""
    out, error = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        code = command.main(["study", name, "-j", "2", *words])
    return types.SimpleNamespace(returncode=code, stdout=out.getvalue(), stderr=error.getvalue(),
                                 text=out.getvalue() + error.getvalue())
