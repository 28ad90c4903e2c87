# SPDX-License-Identifier: GPL-3.0-or-later
"""Total energy: kinetic + internal + removed stays what it was (kinematics/mpm/ledger.hpp)."""

import numpy as np

from faults_support import fault, scene
from scene_support import check, history, krater

CLOSED = 1e-10


def energy_stays(name, start):
    """kinetic + internal + removed begins at `start` [J] and stays there to round-off in every row."""
    done = krater("run", scene(name), "-o", "out", "-j", 2, "--quiet", timeout=600)
    check(done.returncode == 0, f"{name}: exit code", done.returncode)
    rows = history("out")
    energy = rows["kinetic_energy"] + rows["internal_energy"] + rows["removed_energy"]
    check(abs(energy[0] / start - 1) < 1e-3, f"{name}: energy at the start", energy[0])
    worst = np.max(np.abs(energy / energy[0] - 1))
    check(worst < CLOSED, f"{name}: energy", f"{worst:.1e} of the start")
    return rows


@fault("b10", "Noh's problem keeps its energy; rho within 1 % of 4, p of 4/3")
def noh():
    energy_stays("b10", 0.02)


@fault("b11", "Sedov's blast keeps its energy")
def sedov():
    energy_stays("b11", 0.07786)


@fault("b24", "bars at 8 km/s gain no energy", long=True)
def bars():
    energy_stays("b24", 77500.0)


@fault("02", "a Whipple shield keeps its energy", long=True)
def whipple():
    done = krater("run", scene("02"), "-o", "out", "-j", 2, "--quiet", timeout=1200)
    check(done.returncode == 0, "02: exit code", done.returncode)
    rows = history("out")
    energy = rows["kinetic_energy"] + rows["internal_energy"] + rows["removed_energy"]
    worst = np.max(np.abs(energy / energy[0] - 1))
    check(worst < CLOSED, "02: energy", f"{worst:.1e} of the start")
