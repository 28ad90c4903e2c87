# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs scenes made by chance (random_support.py) and says what became of each. Not a test.

    tests/scene/random_runs_support.py N --seed S [-j J] [-o DIR]        (tools/hard --random)

classes: sound (energy error below 1 %), loose (below 10 %), poor (above), failed (exit 3, which says why and where), refused
(exit 2 with the key), broken: a signal, a hang, silence, a number that is none, a ledger that does not close, energy from nowhere
that nobody told. Scenes that are not sound stay in the folder.
"""

import argparse
import collections
import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from random_support import finite, numbers, write
from scene_support import KRATER, ODD, ROOT, environment, history, summary

ORDER = ["sound", "loose", "poor", "failed", "refused", "broken"]
KIND = re.compile(r"^krater: (?:[^:]*: )?([a-z][^:;,(0-9-]*)")


@dataclasses.dataclass
class Fate:
    seed: int
    kind: str
    why: str
    seconds: float


def execute(*arguments, timeout):
    """(exit code, standard error); the code is None where it did not end."""
    try:
        done = subprocess.run([KRATER, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, check=False,
                              env=environment({"KRATER_CARDS": str(ROOT / "inputs" / "materials")}))
        return done.returncode, done.stderr
    except subprocess.TimeoutExpired:
        return None, f"no end within {timeout} s"


def faults_of_results(out, ended):
    """What no run may leave behind, whatever its scene. The last row of one that failed is its state as it broke."""
    rows, audit = history(out), summary(out)["audit"]
    if not ended:
        rows = {name: values[:-1] for name, values in rows.items()}
    broken = [name for name, values in rows.items() if not np.all(np.isfinite(values))]
    broken += [path for path, value in numbers(audit) if ended and not finite(value)]
    if broken:
        yield f"not a number: {broken[:4]}"
        return
    driven = rows["external_work"] + np.maximum(rows["wall_work"], 0)
    came_in = rows["total_energy"][0] + np.maximum.accumulate(driven)
    energy = rows["kinetic_energy"] + rows["internal_energy"] + rows["removed_energy"]
    least = 1e-12 * max(came_in[-1], 1e-300)
    if np.any(np.maximum(energy, rows["kinetic_energy"]) > 2 * came_in + least):
        yield f"{np.max(energy / np.maximum(came_in, 1e-300)):.3g} times the energy that came in"
    through = np.abs(rows["transfer_loss"]) + np.abs(rows["transfer_gain"]) + np.abs(energy) + came_in
    off = np.abs(rows["energy_residual"]) / np.maximum(through, 1e-300)
    if not np.max(off) <= 1e-9:
        yield f"the ledger is off by {np.max(off):.3g}"
    mass = np.max(np.abs(rows["mass"] + rows["removed_mass"] - rows["mass"][0])) / rows["mass"][0]
    if not mass <= 1e-11:
        yield f"{mass:.3g} of the mass is gone"
    told = [warning["kind"] for warning in summary(out)["warnings"]]
    if ended and abs(audit["energy_error_fraction"]) >= 0.01 and "energy" not in " ".join(told):
        yield f"an energy error of {audit['energy_error_fraction']:.3g} is not said: {told}"


def words_of(said):
    return [line for line in said.splitlines() if "warning:" not in line and line.strip()]


def fate_of(seed, folder, timeout=600):
    """Checks and runs the scene of a seed in `folder`."""
    begin = time.monotonic()

    def fate(kind, why=""):
        return Fate(seed, kind, why, time.monotonic() - begin)

    path, out = write(seed, folder), str(pathlib.Path(folder, f"{seed}_out"))
    code, said = execute("check", path, timeout=timeout)
    if code == 2 and re.search(r"\.yaml:\d+: \w", said):
        return fate("refused", words_of(said)[0])
    if code != 0 or ODD.search(said):
        return fate("broken", f"check: {code}: {said[-300:]}")
    code, said = execute("run", path, "-o", out, "-j", 1, "--quiet", timeout=timeout)
    why = " ".join(words_of(said))
    if code not in (0, 3) or ODD.search(said):
        return fate("broken", f"run: {code}: {why[-300:]}")
    if code == 3 and not re.search(r"\b(point|particle|element|rigid body) ", why):
        return fate("broken", f"does not say where: {why[-300:]}")
    faults = list(faults_of_results(out, code == 0))
    if faults:
        return fate("broken", "; ".join(faults) + (f" ({why[-200:]})" if why else ""))
    if code == 3:
        return fate("failed", why)
    error = abs(summary(out)["audit"]["energy_error_fraction"])
    kind = "sound" if error < 0.01 else "loose" if error < 0.1 else "poor"
    return fate(kind, "" if kind == "sound" else f"{100 * error:.1f} %: {largest_entry(out)}")


def largest_entry(out):
    text = next((w["text"] for w in summary(out)["warnings"] if w["kind"] == "energy_error"), "")
    found = re.search(r"most of it ([^,]*), .*mostly of ([^(]*)\(", text) or re.search(r"most of it ([^(,]*)", text)
    return " of ".join(part.strip() for part in found.groups()) if found else text[:120]


def run_seeds(seeds, folder, workers=1, say=None):
    fates = []
    with ThreadPoolExecutor(workers) as pool:
        for fate in pool.map(lambda seed: fate_of(seed, folder), seeds):
            if fate.kind == "sound":
                pathlib.Path(folder, f"{fate.seed}.yaml").unlink()
            if fate.kind in ("sound", "loose", "refused"):
                shutil.rmtree(pathlib.Path(folder, f"{fate.seed}_out"), ignore_errors=True)
            if say:
                say(fate)
            fates.append(fate)
    return fates


def counts(fates):
    found = collections.Counter(fate.kind for fate in fates)
    return ", ".join(f"{found[kind]} {kind}" for kind in ORDER if found[kind])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", type=int)
    parser.add_argument("--seed", type=int, default=1000, help="the first (default: %(default)s)")
    parser.add_argument("-j", type=int, default=min(os.cpu_count() or 1, 2), metavar="N", help="runs at a time")
    parser.add_argument("-o", metavar="DIR", help="where scenes that are not sound stay (default: a folder of /tmp)")
    options = parser.parse_args()
    folder = options.o or tempfile.mkdtemp(prefix="krater random ")
    os.makedirs(folder, exist_ok=True)

    def say(fate):
        if fate.kind != "sound":
            print(f"{fate.seed:7} {fate.kind:8} {fate.seconds:5.1f} s  {fate.why[:300]}", flush=True)

    fates = run_seeds(range(options.seed, options.seed + options.count), folder, options.j, say)
    print(f"{len(fates)} scenes from seed {options.seed}: {counts(fates)}; what is not sound lies in {folder}")
    sys.exit(1 if any(fate.kind == "broken" for fate in fates) else 0)


if __name__ == "__main__":
    main()
