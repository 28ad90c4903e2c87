# SPDX-License-Identifier: GPL-3.0-or-later
"""Contact of bodies."""

import numpy as np

from faults_support import fault, scene
from scene_support import check, history, krater


@fault("03", "no force before bodies touch, in plane strain and 3d")
def phantom():
    for frame in ("plane_strain", "3d"):
        more = []
        if frame == "3d":  # the section of the input, smaller
            more = ["--set", "frame=3d", "--set", "grid.box.min=[-20 mm, -6 mm, -20 mm]",
                    "--set", "grid.box.max=[20 mm, 6 mm, 20 mm]",
                    "--set", "bodies.plate.shape.box.min=[-12 mm, -4 mm, -5 mm]",
                    "--set", "bodies.plate.shape.box.max=[12 mm, 4 mm, 0]",
                    "--set", "bodies.block.shape.box.min=[-3 mm, -2 mm, 1.5 mm]",
                    "--set", "bodies.block.shape.box.max=[3 mm, 2 mm, 4.5 mm]"]
        done = krater("run", scene("03"), "-o", frame, "-j", 2, "--quiet", *more, timeout=300)
        check(done.returncode == 0, f"03 {frame}: exit code", done.stderr)
        rows = history(frame)
        check(np.max(np.abs(rows["vz"] + 20)) < 1e-6, f"03 {frame}: block", np.max(rows["vz"]))
        check(np.max(np.abs(rows["vp"])) < 1e-6, f"03 {frame}: plate", np.min(rows["vp"]))
