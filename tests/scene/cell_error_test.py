#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The numerical error that studies and tools/three_cells state: of sequences with known limits, and of a run as a user
sees it."""

import os
import subprocess
import sys

import numpy as np

from scene_support import KRATER, ROOT, Folder, check, finish

sys.path.insert(0, str(ROOT / "tools"))
from krater_study.uncertainty import error, estimate, validation  # noqa: E402

SCENE = ROOT / "inputs" / "plate_impact.yaml"


def sequences():
    """f = limit + a h^p, without and with noise: the limit lies in the band in at least 90 % of the cases."""
    for order in (0.7, 1.0, 1.4):
        values = [3.0 + 0.4 * h**order for h in (0.4, 0.2, 0.1)]
        band, found, _ = error(values)
        off, last = abs(values[-1] - 3.0), abs(values[-1] - values[-2])
        most = max(1.25 * off, last) if order <= 1 else 1.25 * last  # the scheme's order is 1
        check(abs(found - order) < 1e-9 and off < band < 1.001 * most,
              f"order {order} is found; the band is a quarter more than the distance to the limit", f"{band:.3g}")
    band, found, _ = error([3.0 + 0.4 * h**2 for h in (0.4, 0.2, 0.1)])
    check(abs(found - 2) < 1e-9 and band > 3 * 0.4 * (0.2**2 - 0.1**2) * 0.999, "order 2 is not believed of an impact",
          band)
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


def coverage(make, tries=250):
    """Share of made-up sequences whose limit, 1, lies in the band, and how much wider than their error bands are."""
    found = [estimate(*make()) for _ in range(tries)]
    errors = [abs(one.value - 1) for one in found]
    return (np.mean([e <= one.uncertainty for e, one in zip(errors, found)]),
            np.median([one.uncertainty / max(e, 1e-12) for e, one in zip(errors, found)]))


def more_than_three():
    """Least squares over more cells, and over shifted lattices: exact laws, noise, oscillation."""
    h = 0.5 ** np.arange(5)
    for order in (0.7, 1.0, 1.4):
        found = estimate(h, 3 + 0.4 * h**order)
        off = 0.4 * h[-1]**order
        check(found.behaviour == "converges" and abs(found.order - order) < 1e-3 and abs(found.limit - 3) < 1e-4 and
              off < found.uncertainty <= max(1.3, 2 * order) * max(off, 0.4 * (h[-2]**order - h[-1]**order)),
              f"an exact law of order {order} is found, its band is a quarter more than its error", found)
    found = estimate([1, 0.7, 0.4, 0.1], [1 + 0.1 * x for x in (1, 0.7, 0.4, 0.1)])
    check(abs(found.order - 1) < 1e-3 and abs(found.limit - 1) < 1e-5, "cells need no common ratio", found)
    found = estimate(h, 1 + 0.1 * (-1.0) ** np.arange(5))
    check(found.behaviour in ("wavers", "is noisy") and found.order is None and found.uncertainty >= 0.2,
          "oscillation is said", found)
    lattices = np.concatenate([x * np.array([1, 0.96, 1.04]) for x in h[:3]])
    values = 1 + 0.01 * lattices + 0.002 * np.tile([0, 1, -1], 3)
    found = estimate(lattices, values)
    check(found.scatter > 0.0039 and found.uncertainty >= found.scatter and found.value == values[6],
          "the band is at least the spread of shifted lattices; the answer is the unshifted one's", found)
    check(not estimate([1], [2]).known and not estimate([1, 0.5, 0.25], [1, np.nan, 1]).known,
          "what is not known is said")
    random = np.random.default_rng(2)
    for cells in (4, 5, 6):
        for ratio in (1.5, 2.0):
            def make(cells=cells, ratio=ratio):
                x, order = ratio ** -np.arange(cells), random.uniform(0.6, 2)
                return x, 1 + 0.1 * x**order + 10 ** random.uniform(-4, -1) * random.normal(size=cells)
            share, wide = coverage(make)
            check(share >= 0.9 and wide < 6, f"{cells} cells, ratio {ratio}: nine in ten limits lie in the band",
                  (share, wide))


def model_error():
    found = estimate([0.4, 0.2, 0.1], [1.4, 1.2, 1.1])
    said = validation(found, 2.0, 0.1)
    u = np.sqrt((found.uncertainty / 1.15) ** 2 + 0.01)
    check(said["seen"] and abs(said["difference"] + 0.9) < 1e-12 and abs(said["to"] - said["from"] - 2 * u) < 1e-12,
          "E = S - D, and its band", said)
    check(not validation(found, 1.15, 0.1)["seen"], "no model error is claimed within the band")


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
    more_than_three()
    model_error()
    run_of_three()
finish()
