# SPDX-License-Identifier: GPL-3.0-or-later
"""Total energy: kinetic + internal + removed stays what it was (kinematics/mpm/ledger.hpp)."""

import numpy as np

from faults_support import fault, scene
from scene_support import ROOT, check, history, krater, run, summary

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


@fault("energy-error", "a run ends where more than 10 % of its energy is not physical, and goes on where it is told to")
def energy_error():
    discs, limit = ROOT / "inputs" / "two_discs.yaml", "time.energy_error=0.02"
    done = run("stopped", limit, scene=discs)
    words = done.stderr
    check(done.returncode == 3 and summary("stopped")["status"] == "failed", "exit 3", done.returncode)
    for word in ("energy error 2.", "2 % allowed", "numerical_heat (+0.", "grid.cell", "time.energy_error: off", "; time "):
        check(word in words, f"it says '{word}'", words)
    told = {warning["kind"]: warning["text"] for warning in summary("stopped")["warnings"]}
    check("most of it numerical_heat" in told.get("energy_error", ""), "past 1 % a warning names the largest entry", told)
    done = run("stopped", "time.energy_error=off", scene=discs, extra=("--restart", "stopped/checkpoint.h5"))
    check(done.returncode == 0, "its checkpoint goes on with another limit", done.stderr)
    run("whole", "time.energy_error=off", scene=discs)
    last = {name: values[-1] for name, values in history("whole").items()}
    check(last == {name: values[-1] for name, values in history("stopped").items()}, "with the same bits", last)
    check(abs(last["energy_error_fraction"]) > 0.04, "and ends with the error it was stopped for",
          last["energy_error_fraction"])


@fault("piston-start", "a body that a piston sets in motion is judged when its energy has come")
def piston_start():
    done = krater("run", scene("energy"), "-o", "out", "-j", 1, "--quiet")
    check(done.returncode == 0, "it runs to its end", done.stderr)
    error = history("out")["energy_error_fraction"]
    check(max(error[:5]) > 0.3, "the first layer takes half", max(error[:5]))
    done = krater("run", scene("energy"), "-o", "early", "-j", 1, "--quiet", "--set",
                  "time.stop_when=energy_error_fraction > 0.3")
    check(done.returncode == 3 and "10 % allowed" in done.stderr, "nor is it spared by an end of its own", done.stderr)
    check(error[-1] < 0.01, "a hundredth at the end", error[-1])
