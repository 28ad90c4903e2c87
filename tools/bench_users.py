# SPDX-License-Identifier: GPL-3.0-or-later
"""What `tools/bench` measures of a user's wait: whole runs, small scenes, all shipped scenes, and a model of more cores.

As bench_suite.py: each function takes a Bench and returns plain data for bench.json.
"""

import json
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess

import bench_scenes as scenes

ROOT = pathlib.Path(__file__).resolve().parents[1]
TAYLOR = ROOT / "inputs" / "taylor_copper.yaml"
PEERS = {  # the same rod, wall seconds on one core, measured for this project in one run (issue 4)
    "MPM3D-F90, linear": 69, "MPM3D-F90, quadratic B-splines": 175, "Karamelo": 258, "NairnMPM": 1022}
# Measured once for this project, on one core on which the probe took so many ns per point-step (issue 25): processor
# seconds of the whole 3d run at h, and of an axisymmetric run whose length and W are within 1 % of the code's own limit.
PEERS_PROBE_NS, PEERS_3D, PEERS_ONE_PER_CENT = 80.3, ("MPM3D-F90", 94.5), ("Karamelo", 0.5)


def thread_counts():
    return [1, 2] if (os.cpu_count() or 1) > 1 else [1]


def of_threads(name, n):
    return f"{name}, {n} thread{'s' if n > 1 else ''}"


def whole_run(bench, scene, settings, threads, name):
    """summary.json of a run as a user starts it, its folder removed; None: it did not end well."""
    out = bench.folder / name
    command = [bench.krater, "run", scene, "-o", out, "-j", str(threads), "--quiet"]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, check=False, capture_output=True)
    path = out / "summary.json"
    summary = json.loads(path.read_text(encoding="utf-8")) if path.exists() else None
    shutil.rmtree(out, ignore_errors=True)
    return summary if done.returncode == 0 else None


def wait_row(summaries):
    """Of the run with the median wall time: its parts, and what the whole costs over its steps."""
    s = sorted(summaries, key=lambda one: one["machine"]["wall_seconds"])[len(summaries) // 2]
    machine, work = s["machine"], s["points"] * s["steps"]
    steps = sum(machine["seconds"].values())
    own = machine["bytes_per_point"] * s["points"]
    return {"points": s["points"], "steps": s["steps"], "wall_seconds": machine["wall_seconds"], "steps_seconds": steps,
            "processor_seconds": machine["processor_seconds"], "outside_seconds": machine["seconds_outside_steps"],
            "whole_over_steps": statistics.median(o["machine"]["wall_seconds"] / sum(o["machine"]["seconds"].values())
                                                  for o in summaries),
            "ns": {k: 1e9 * v / work for k, v in machine["seconds"].items()},
            "bytes_per_point": machine["bytes_per_point"],
            "memory_over_points": machine["peak_resident_bytes"] / own}


def wait(bench):
    """Whole runs as a user starts them, output and measures included [s]."""
    cases = {"axisymmetric, h": ([], 3 * bench.repetitions), "axisymmetric, h/4": (["grid.cell=0.09525 mm"], 1),
             "3d, h": (["frame=3d"], 1)}
    rows = {}
    for n in thread_counts():
        for name, (settings, times) in cases.items():
            rows[of_threads(name, n)] = wait_row([whole_run(bench, TAYLOR, settings, n, "wait") for _ in range(times)])
    return {"rows": rows, "peers_seconds_3d": PEERS}


def small_row(results):
    one = sorted(results, key=lambda r: r["ns"]["step"]["median"])[len(results) // 2]
    step = one["ns"]["step"]["median"]
    return {"points": one["points"], "us": 1e-3 * step * one["points"], "cpu": one["ns"]["cpu"]["median"], "step": step}


def small(bench):
    """Few points: what a step costs beside its points, and what two threads give (asked 1.7 at 10,000 points)."""
    jobs = {of_threads(f"Taylor axisymmetric, {name}", n):
            lambda cell=cell, n=n: bench.steps(scenes.taylor("axisymmetric", cell), 400, 40, n)
            for n in thread_counts() for name, cell in (("h", scenes.H), ("h/2", scenes.H / 2))}
    results = bench.interleaved(jobs)
    rows = {name: small_row(r) for name, r in results.items()}
    one, two = (results.get(f"Taylor axisymmetric, h/2, {n}") for n in ("1 thread", "2 threads"))
    gain = statistics.median(a["ns"]["step"]["median"] / b["ns"]["step"]["median"] for a, b in zip(one, two)) if two else None
    return {"small": rows, "two_threads": gain, "rows": {}}


def seconds_with(run, threads):
    """Wall seconds of a step by the model: what for_each was given is dealt out item by item, as many at a time as there
    are threads, the rest stays; a loop wakes its threads, two in `empty_us`, more by a tree."""
    shared = sum(region["us"] for region in run["shared"])
    total = 1e-3 * run["ns"]["step"]["mean"] * run["points"]
    after = total - shared
    for region in run["shared"]:
        workers = min(threads, region["items"])
        rounds = math.ceil(region["items"] / workers)
        after += region["us"] * rounds / region["items"]
        if workers > 1:
            after += region["calls"] * run["empty_us_two"] * math.log2(threads)
    return 1e-6 * after, 1e-6 * total


def cores(bench):
    """A model of more cores than there are: what is serial, how many items share the rest, and the waking of threads."""
    cases = {"Taylor axisymmetric, h/2": (scenes.taylor("axisymmetric", scenes.H / 2), 300),
             "Taylor 3d, h": (scenes.taylor("3d"), 30),
             "Taylor 3d, 1e6 points": (scenes.taylor("3d", scenes.H * (168692 / 1e6) ** (1 / 3)), 6)}
    rows = {}
    for name, (text, steps) in cases.items():
        one, two = bench.steps(text, steps, 5, 1), bench.steps(text, steps, 5, 2)
        one["empty_us_two"] = two["empty_us"]
        total = seconds_with(one, 1)[1]
        shared = sum(region["us"] for region in one["shared"] if region["items"] > 1)
        rows[name] = {"points": one["points"], "patches": one["patches"], "serial_share": 1 - 1e-6 * shared / total,
                      "bytes": 2 * one["record_bytes"], "empty_us": two["empty_us"], "step_us": 1e6 * total,
                      "speedup": {str(p): total / seconds_with(one, p)[0] for p in (2, 4, 8, 16, 32, 64)},
                      "measured_two": one["ns"]["step"]["median"] / two["ns"]["step"]["median"]}
    return {"cores": rows, "rows": {}}


def number_of(summary, name):
    measure = summary["measures"].get(name, {})
    value = measure.get("value") if isinstance(measure, dict) else None
    return value if isinstance(value, (int, float)) else None


def moved(one, other):
    """Largest change of a measure that both have and that is not about nothing, and whose it is."""
    worst, whose = None, ""
    for name in one["measures"]:
        a, b = number_of(one, name), number_of(other, name)
        if a is None or b is None or a == 0:
            continue
        change = abs(b / a - 1)
        if worst is None or change > worst:
            worst, whose = change, name
    return worst, whose


CELLS = (1.27e-3, 0.762e-3, 0.508e-3, 0.381e-3, 0.254e-3, 0.1905e-3, 0.127e-3)


def cheapest(runs, limit, share):
    """Processor seconds of the coarsest run from which on all are within `share` of the limit; None: none is."""
    within = [max(abs(run[m] / limit[m] - 1) for m in limit) <= share for run in runs]
    good = [k for k in range(len(runs)) if all(within[k:])]
    return runs[good[0]] if good else None


def peers(bench):
    """What an error costs in the Taylor rod about its axis, each code against its own limit; peers as they were measured."""
    runs = []
    for cell in CELLS:
        s = [whole_run(bench, TAYLOR, [f"grid.cell={cell!r} m", "output.frames=1 s"], 1, "peers") for _ in range(bench.repetitions)]
        runs.append({"cell": cell, "points": s[0]["points"], "steps": s[0]["steps"],
                     "cpu": statistics.median(one["machine"]["processor_seconds"] for one in s),
                     **{m: number_of(s[0], m) for m in ("final_length", "w_diameter")}})
    limit = {m: runs[-1][m] + (runs[-1][m] - runs[-2][m]) for m in ("final_length", "w_diameter")}
    three = whole_run(bench, TAYLOR, ["frame=3d"], 1, "peers")
    probe = bench.run_probe(1, bench.probe_cpu)["step"] if bench.probe else None
    return {"runs": runs, "limit": limit, "probe_ns": probe, "three": three["machine"]["processor_seconds"],
            "steps_3d": three["steps"], "cost": {str(share): cheapest(runs, limit, share) for share in (0.01, 0.003)}, "rows": {}}


LONGEST = 25.0  # estimated seconds of a scene that takes part


def estimate(bench, scene):
    text = subprocess.run([bench.krater, "check", scene], capture_output=True, text=True, check=False).stdout
    found = re.search(r"memory, ([0-9.]+) (s|min|h) on one core", text)
    return float(found[1]) * {"s": 1, "min": 60, "h": 3600}[found[2]] if found else None


def cell_of(scene):
    """`grid.cell` in metres as the scene writes it; None where it is not one plain length."""
    found = re.search(r"^\s*(?:grid:\s*\{)?\s*cell:\s*([0-9.e-]+)\s*(mm|um|cm|m)?\s*[,}#\n]", scene.read_text(encoding="utf-8"), re.M)
    return float(found[1]) * {"mm": 1e-3, "um": 1e-6, "cm": 1e-2, "m": 1, None: 1}[found[2]] if found else None


def inputs(bench):
    """Shipped scenes with the time step they have, with half of it (the CFL of before), and with a coarser cell."""
    rows, left_out = {}, []
    for scene in sorted(path for path in (ROOT / "inputs").rglob("*.yaml") if "time:" in path.read_text(encoding="utf-8")):
        name = str(scene.relative_to(ROOT / "inputs"))
        seconds = estimate(bench, scene)
        if seconds is None or seconds > LONGEST:
            left_out.append(name)
            continue
        cell = cell_of(scene)
        settings = {"now": [], "half": ["time.cfl=0.45"], "coarser": [f"grid.cell={1.25 * cell!r} m"] if cell else None}
        runs = {kind: whole_run(bench, scene, s, 1, "input") if s is not None else None for kind, s in settings.items()}
        if runs["now"] is None or runs["half"] is None:
            left_out.append(name)
            continue
        row = {kind: {"steps": r["steps"], "cpu": r["machine"]["processor_seconds"]} for kind, r in runs.items() if r}
        row["by_step"] = moved(runs["now"], runs["half"])
        row["by_cell"] = moved(runs["now"], runs["coarser"]) if runs["coarser"] else (None, "")
        rows[name] = row
    return {"inputs": rows, "left_out": left_out, "rows": {}}
