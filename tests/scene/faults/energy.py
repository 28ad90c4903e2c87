# SPDX-License-Identifier: GPL-3.0-or-later
"""Total energy. The issue that keeps it to round-off mends these."""

import numpy as np

from faults_support import fault, scene
from scene_support import check, history, krater

LEDGER = "issue 24 (total energy kept to round-off)"


def energy_stays(name, start, share, removed=True):
    """kinetic + internal (+ removed) within `share` of `start` [J] in every row."""
    done = krater("run", scene(name), "-o", "out", "-j", 2, "--quiet", timeout=600)
    check(done.returncode == 0, f"{name}: exit code", done.returncode)
    rows = history("out")
    energy = rows["kinetic_energy"] + rows["internal_energy"] + (rows["removed_energy"] if removed else 0)
    worst = np.max(np.abs(energy / start - 1))
    check(worst < share, f"{name}: energy", f"{worst:.2e} of the start, allowed {share:g}")
    return rows


@fault("b10", "Noh's problem keeps its energy; rho within 1 % of 4, p of 4/3", until=LEDGER)
def noh():
    energy_stays("b10", 0.02, 1e-3, removed=False)


@fault("b11", "Sedov's blast keeps its energy", until=LEDGER)
def sedov():
    energy_stays("b11", 0.07786, 0.01, removed=False)


@fault("b24", "bars at 8 km/s gain no energy", until=LEDGER, long=True)
def bars():
    rows = energy_stays("b24", 77500.0, 0.01)
    energy = rows["kinetic_energy"] + rows["internal_energy"] + rows["removed_energy"]
    check(np.max(energy) < 1.001 * 77500.0, "b24: energy never grows", np.max(energy))


@fault("02", "a Whipple shield loses less than 5 % of its energy", until=LEDGER, long=True)
def whipple():
    done = krater("run", scene("02"), "-o", "out", "-j", 2, "--quiet", timeout=1200)
    check(done.returncode == 0, "02: exit code", done.returncode)
    rows = history("out")
    energy = rows["kinetic_energy"] + rows["internal_energy"] + rows["removed_energy"]
    check(energy[-1] > 0.95 * energy[0], "02: energy left", energy[-1] / energy[0])
