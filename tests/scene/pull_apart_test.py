#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A bar pulled apart fails in its neck; nothing of it is lost, and a restart continues with the same bits."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
KRATER = os.environ.get("KRATER", str(ROOT / "build" / "krater"))
SCENE = ROOT / "inputs" / "bar_pulled_apart.yaml"
failures = []


def check(condition, what, detail=""):
    print(("ok    " if condition else "FAIL  ") + what + (f": {detail}" if detail else ""), flush=True)
    if not condition:
        failures.append(what)


def run(output, *values, scene=SCENE, extra=()):
    settings = [text for value in ("grid.cell=0.5 mm", *values) for text in ("--set", value)]
    done = subprocess.run([KRATER, "run", scene, "-o", output, "-j", "1", *settings, *extra],
                          capture_output=True, text=True, timeout=600, check=False)
    check(done.returncode == 0, f"{output}: exit code {done.returncode}", done.stderr[-300:] if done.returncode else "")
    with open(f"{output}/summary.json", encoding="utf-8") as file:
        return json.load(file)


def last_frame(output):
    with h5py.File(f"{output}/frames.h5", "r") as file:
        frames = file["frames"]
        body = frames[sorted(frames)[-1]]["bar"]
        return {name: np.array(body[name]) for name in body}


def find(tree, key):
    """The first value of that name anywhere in nested dictionaries."""
    if isinstance(tree, dict):
        if key in tree:
            return tree[key]
        for value in tree.values():
            found = find(value, key)
            if found is not None:
                return found
    return None


with tempfile.TemporaryDirectory(prefix="krater scene ") as scratch:
    os.chdir(scratch)
    summary = run("apart")
    f = last_frame("apart")
    failed = f["failed"].ravel() > 0.5
    check(0.005 < failed.mean() < 0.5, "a part of the bar has failed", f"{failed.sum()} of {failed.size} points")
    check(find(summary, "failures") == failed.sum(), "each failure is counted once")
    check(np.all(f["damage"].ravel()[failed] >= 0.5) and f["damage"].max() <= 0.5, "failed at phi_c, no damage beyond")
    check(not f["stress"][failed][:, 3:].any() and np.all(f["von_mises"].ravel()[failed] == 0)
          and np.all(f["pressure"].ravel()[failed] >= 0), "failed points carry neither deviator nor tension")
    check(abs(find(summary, "energy_residual_fraction")) < 1e-10, "the audit closes",
          f"{find(summary, 'energy_residual_fraction'):.1e}")
    check(abs(find(summary, "energy_error_fraction")) < 0.05, "energy error", f"{find(summary, 'energy_error_fraction'):.4f}")
    z = f["coordinates"][:, 2] if "coordinates" in f else None
    v = f["velocity"][:, 2]
    check(v.max() > 60 and v.min() < -60, "the halves part", f"{v.min():.0f} and {v.max():.0f} m/s")
    gone = run("removed", "materials.weldox.failure.action=remove")
    r = last_frame("removed")
    removed = find(gone, "removed_failed_points")
    check(removed > 0 and find(gone, "failures") == removed == find(gone, "removed_points"),
          "action remove: every failed point is taken out and counted", f"{removed}")
    check(r["id"].size + removed == f["id"].size and not r["failed"].any(), "none of them is left")
    check(np.all(np.diff(r["id"]) > 0) and r["id"].max() >= r["id"].size, "the others keep their ids")
    check(abs(find(gone, "energy_residual_fraction")) < 1e-10
          and abs((find(gone, "mass") + find(gone, "removed_mass")) / find(summary, "mass") - 1) < 1e-13,
          "and the audit closes with what was removed")
    lines = SCENE.read_text(encoding="utf-8").splitlines(keepends=True)
    sound = ("damage", "failure:", "failed_share", "spall_strength")
    pathlib.Path("sound.yaml").write_text("".join(l for l in lines if not any(w in l for w in sound)), encoding="utf-8")
    without = run("whole", scene="sound.yaml")
    g = last_frame("whole")
    check("damage" not in g and "failed" not in g, "without damage there is no such column")
    check(find(without, "failures") == 0, "and no failure")
    # Ends at the time of a frame: the whole run steps onto it too.
    run("half", "time.end=10 us")
    run("rest", "time.end=25 us", extra=["--restart", "half/checkpoint.h5"])
    r = last_frame("rest")
    check(all(np.array_equal(r[name], f[name]) for name in ("damage", "failed", "velocity", "internal_energy")),
          "a restart in the middle gives the same bits")
sys.exit(1 if failures else 0)
