#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The numerical error that tools/three_cells states: of sequences with known limits, and of a run as a user sees it."""

import os
import subprocess
import sys

import numpy as np

from scene_support import KRATER, ROOT, Folder, check, finish

sys.path.insert(0, str(ROOT / "tools"))
from cell_error import error  # noqa: E402

SCENE = ROOT / "inputs" / "plate_impact.yaml"


def sequences():
    """f = limit + a h^p, without and with noise: the limit lies in the band in at least 90 % of the cases."""
    for order in (0.7, 1.0, 1.4):
        values = [3.0 + 0.4 * h**order for h in (0.4, 0.2, 0.1)]
        band, found, _ = error(values)
        off, last = abs(values[-1] - 3.0), abs(values[-1] - values[-2])
        check(abs(found - order) < 1e-9 and off < band < 1.001 * max(1.25 * off, last),
              f"order {order} is found; the band is a quarter more than the distance to the limit", f"{band:.3g}")
    band, found, _ = error([3.0 + 0.4 * h**2 for h in (0.4, 0.2, 0.1)])
    check(abs(found - 2) < 1e-9 and band > 3 * 0.4 * (0.2**2 - 0.1**2) * 0.999, "order 2 is not believed of an impact", band)
    random = np.random.default_rng(1)
    inside = []
    for _ in range(4000):
        order, noise = random.uniform(0.6, 2.0), 10 ** random.uniform(-4, -1)  # from smooth to noise alone
        values = [1 + 0.1 * h**order + noise * random.normal() for h in (1.0, 0.5, 0.25)]
        inside.append(abs(values[-1] - 1) <= error(values)[0])
    share = np.mean(inside)
    check(share >= 0.9, "of noisy sequences nine in ten limits lie in the band", f"{share:.3f}")
    # Taylor copper, 2h, h, h/2 and then h/4 (validation/taylor_copper): wavering values.
    for name, values, finer in (("length", (17.296, 17.319, 17.317), 17.334), ("W", (9.491, 9.497, 9.472), 9.447),
                                ("foot", (14.882, 14.545, 14.464), 14.615)):
        check(abs(finer - values[-1]) <= error(values)[0], f"{name} at h/4 lies in the band of the three coarser cells")
    check(error((2.0, 2.0, 2.0))[0] == 0, "what does not depend on the cell has no error of it")


def run_of_three():
    """tools/three_cells on the plate impact, whose answers are exact."""
    done = subprocess.run([ROOT / "tools" / "three_cells", SCENE, "--set", "grid.cell=0.25 mm", "-o", "out"],
                          capture_output=True, text=True, check=False, env={**os.environ, "KRATER": KRATER})
    if not check(done.returncode == 0, "three_cells runs", done.stderr[-500:]):
        return
    rows = [line.split() for line in done.stdout.splitlines() if line.startswith("  ")]
    lines = {row[0]: row for row in rows if row}
    for name, exact in (("velocity", -333.4), ("thickness", 18.0)):
        value, band = float(lines[name][4]), float(lines[name][5])
        check(abs(value - exact) <= band + 1e-3 * abs(exact), f"{name}: {value} +- {band}, exact {exact}")
    check(os.path.exists("out_cells/h_2/summary.json"), "the runs lie beside")
    check("nine of ten" in done.stdout, "the words explain")


with Folder():
    sequences()
    run_of_three()
finish()
