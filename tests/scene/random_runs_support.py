# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs scenes made by chance (random_support.py) and says what became of each. Not a test.

    tests/scene/random_runs_support.py N --seed S [--finer] [--smaller] [-j J] [-o DIR]   (tools/hard --random)

classes: sound (energy error below 1 %), loose (below 10 %), poor (above), failed (exit 3, which says why and where), refused
(exit 2 with the key), broken: a signal, a hang, silence, a number that is none, a ledger that does not close, energy from nowhere
that nobody told. Scenes that are not sound stay in the folder.

Two questions, two figures. Is all energy accounted for? `residual`: what the ledger does not know of all that went through it; 1e-9
and more is broken. Is all of it physical? the energy error: heat that a law cannot feel, of a known entry. The second falls with
the cell where contact or a wall stops a layer of cells at once (theory: 0.58 h/L of two elastic bars), and --finer runs what is loose
or poor again with half the cell, in two dimensions with a quarter too.
"""

import argparse
import collections
import dataclasses
import json
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

from random_support import finite, numbers, scene, write
from random_smaller_support import smaller
from scene_support import KRATER, ODD, ROOT, environment, history, summary

ORDER = ["sound", "loose", "poor", "failed", "refused", "broken"]
KIND = re.compile(r"^krater: (?:[^:]*: )?([a-z][^:;,(0-9-]*)")


@dataclasses.dataclass
class Fate:
    seed: int
    kind: str
    why: str
    seconds: float
    error: float = 0.0     # the energy error, of the energy in the scene
    residual: float = 0.0  # what the ledger does not know, of all that went through it


def execute(*arguments, timeout):
    """(exit code, standard error); the code is None where it did not end."""
    try:
        done = subprocess.run([KRATER, *map(str, arguments)], capture_output=True, text=True, timeout=timeout, check=False,
                              env=environment({"KRATER_CARDS": str(ROOT / "inputs" / "materials")}))
        return done.returncode, done.stderr
    except subprocess.TimeoutExpired:
        return None, f"no end within {timeout} s"


def rows_of(out, ended):
    """The history; the last row of a run that failed is its state as it broke."""
    rows = history(out)
    return rows if ended else {name: values[:-1] for name, values in rows.items()}


def energies(rows):
    """Of the scene, and what came in until then."""
    driven = rows["external_work"] + np.maximum(rows["wall_work"], 0)
    came_in = rows["total_energy"][0] + np.maximum.accumulate(driven)
    return rows["kinetic_energy"] + rows["internal_energy"] + rows["removed_energy"], came_in


def residual(rows):
    """The most that the ledger does not know, of all that went through it."""
    energy, came_in = energies(rows)
    through = np.abs(rows["transfer_loss"]) + np.abs(rows["transfer_gain"]) + np.abs(energy) + came_in
    return np.max(np.abs(rows["energy_residual"]) / np.maximum(through, 1e-300))


def faults_of_results(out, ended):
    """What no run may leave behind, whatever its scene."""
    rows, audit = rows_of(out, ended), summary(out)["audit"]
    broken = [name for name, values in rows.items() if not np.all(np.isfinite(values))]
    broken += [path for path, value in numbers(audit) if ended and not finite(value)]
    if broken:
        yield f"not a number: {broken[:4]}"
        return
    energy, came_in = energies(rows)
    least = 1e-12 * max(came_in[-1], 1e-300)
    if np.any(np.maximum(energy, rows["kinetic_energy"]) > 2 * came_in + least):
        yield f"{np.max(energy / np.maximum(came_in, 1e-300)):.3g} times the energy that came in"
    off = residual(rows)
    if not off <= 1e-9:
        yield f"the ledger is off by {off:.3g}"
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
    return fate_of_scene(seed, write(seed, folder), str(pathlib.Path(folder, f"{seed}_out")), timeout)


def fate_of_scene(seed, path, out, timeout=600):
    begin = time.monotonic()

    def fate(kind, why=""):
        return Fate(seed, kind, why, time.monotonic() - begin)

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
    found = fate(kind, "" if kind == "sound" else f"{100 * error:.1f} %: {largest_entry(out)}")
    found.error, found.residual = error, residual(history(out))
    return found


def finer(tree, times):
    """The scene with cells and elements so many times smaller."""
    tree["grid"]["cell"] /= times
    for body in tree["bodies"].values():
        mesh = body.get("kinematics", {}).get("lagrangian_mesh", {})
        if "element" in mesh:
            mesh["element"] /= times
    return tree


def error_with(seed, times, folder, timeout=600):
    """The energy error of a seed's scene with cells so many times smaller, None where it does not end."""
    path, out = pathlib.Path(folder, f"{seed} finer.yaml"), pathlib.Path(folder, f"{seed}_finer_out")
    path.write_text(json.dumps(finer(scene(seed), times)), encoding="utf-8")
    code, _ = execute("run", path, "-o", out, "-j", 1, "--quiet", timeout=timeout)
    error = abs(summary(out)["audit"]["energy_error_fraction"]) if code == 0 else None
    shutil.rmtree(out, ignore_errors=True)
    path.unlink()
    return error


def finer_errors(seed, folder, timeout=600):
    """With half the cell, and in two dimensions with a quarter."""
    return [error_with(seed, times, folder, timeout) for times in ((2,) if scene(seed)["frame"] == "3d" else (2, 4))]


def minimised(seed, folder):
    """The seed's scene without what its fate does not need, as a file beside it; returns the file and what went."""
    path, out = pathlib.Path(folder, f"{seed} small.yaml"), pathlib.Path(folder, f"{seed}_small_out")

    def fate(tree):
        path.write_text(json.dumps(tree, indent=1), encoding="utf-8")
        shutil.rmtree(out, ignore_errors=True)
        return fate_of_scene(seed, path, str(out))

    tree, gone = smaller(scene(seed), fate)
    fate(tree)
    shutil.rmtree(out, ignore_errors=True)
    return path, gone


def percent(error):
    return "-" if error is None else f"{100 * error:.1f}"


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


def ledger(fates):
    """Whether all energy is accounted for, in a word."""
    ended = [fate for fate in fates if fate.kind in ("sound", "loose", "poor")]
    return f"all energy of {len(ended)} that ended is accounted for to {max((f.residual for f in ended), default=0):.1e} of it"


def counts(fates):
    found = collections.Counter(fate.kind for fate in fates)
    return ", ".join(f"{found[kind]} {kind}" for kind in ORDER if found[kind])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", type=int)
    parser.add_argument("--seed", type=int, default=1000, help="the first (default: %(default)s)")
    parser.add_argument("-j", type=int, default=min(os.cpu_count() or 1, 2), metavar="N", help="runs at a time")
    parser.add_argument("-o", metavar="DIR", help="where scenes that are not sound stay (default: a folder of /tmp)")
    parser.add_argument("--smaller", action="store_true", help="of what is poor, failed or broken, the least scene that is so too")
    parser.add_argument("--finer", action="store_true", help="what is loose or poor again with half and a quarter of the cell")
    options = parser.parse_args()
    folder = options.o or tempfile.mkdtemp(prefix="krater random ")
    os.makedirs(folder, exist_ok=True)

    def say(fate):
        if fate.kind != "sound":
            print(f"{fate.seed:7} {fate.kind:8} {fate.seconds:5.1f} s  {fate.why[:300]}", flush=True)

    fates = run_seeds(range(options.seed, options.seed + options.count), folder, options.j, say)
    for fate in fates if options.finer else ():
        if fate.kind in ("loose", "poor"):
            errors = [fate.error, *finer_errors(fate.seed, folder)]
            print(f"{fate.seed:7} {', '.join(map(percent, errors))} % with the cell, its half and quarter: {fate.why[:100]}", flush=True)
    for fate in fates if options.smaller else ():
        if fate.kind in ("poor", "failed", "broken"):
            path, gone = minimised(fate.seed, folder)
            print(f"{fate.seed:7} is so in '{path}' too, without {', '.join(gone) or 'nothing'}", flush=True)
    print(f"{len(fates)} scenes from seed {options.seed}: {counts(fates)}; {ledger(fates)}; what is not sound lies in {folder}")
    sys.exit(1 if any(fate.kind == "broken" for fate in fates) else 0)


if __name__ == "__main__":
    main()
