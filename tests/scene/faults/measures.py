# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run says about itself."""

import h5py
import numpy as np

from faults_support import fault, scene
from scene_support import check, history, run, summary

CELL, FASTEST, OUTSIDE = 1e-3, 256.2e-3, 300e-3  # of fault 06: cell, the gas front at 2 c0/(gamma - 1), the box's end


def surface_within_points(output, what):
    """`front` of every frame's time is within two cells of the farthest point, never faster than a gas can be."""
    rows = history(output)
    check(np.nanmax(rows["front"]) <= min(FASTEST, OUTSIDE), f"{what}: front", f"{1e3 * np.nanmax(rows['front']):.1f} mm")
    beyond = -np.inf
    with h5py.File(f"{output}/frames.h5", "r") as file:
        for frame in file["frames"].values():
            row = int(np.argmin(np.abs(rows["time"] - frame.attrs["time"])))
            if abs(rows["time"][row] - frame.attrs["time"]) < 1e-9:
                beyond = max(beyond, rows["front"][row] - frame["gas/coordinates"][:, 2].max())
    check(-np.inf < beyond <= 2 * CELL, f"{what}: beyond the farthest point", f"{1e3 * beyond:.2f} mm")
    final = summary(output)["measures"]["front"]
    check(final.get("rarefied") is True, f"{what}: the front is marked rarefied", final)
    return summary(output)["measures"]


@fault("06", "the front of a gas that expands is where its points are, and marked rarefied")
def rarefied_front():
    more = ("output={history: 1 us, frames: 5 us}", "measures.width={kind: extent, body: gas, axis: z}",
            "measures.low={kind: min, body: gas, axis: z}")
    for points in (2, 4):
        name = f"points_{points}"
        end = "150 us" if points == 2 else "80 us"
        done = run(name, f"method.points_per_direction={points}", f"time.end={end}", *more, scene=scene("06"))
        if not check(done.returncode == 0, f"06: {points} points per direction run", done.stderr[-300:]):
            continue
        measures = surface_within_points(name, f"06, {points} points per direction")
        exact = 1e5 * float(end.split()[0]) * 1e-6 / (1.2 * 0.1)
        check(abs(measures["v"]["value"] / exact - 1) < 0.004, "06: mean velocity p t/(rho L)", measures["v"]["value"])
        check("rarefied" not in measures["low"] and measures["width"].get("rarefied") is True,
              "06: of the gas's two ends the one at the wall is dense")
