# SPDX-License-Identifier: GPL-3.0-or-later
"""Sections of the report of speed on a user's wait, from what tools/bench_users.py measured; and what was asked."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import bench_users as users  # noqa: E402


def number(value, form=".2f", times=1.0):
    return "-" if value is None else format(value * times, form)


def asked(parts):
    """Rows of [what, asked, measured, verdict] of issue 25, for the parts that there are."""
    rows = []

    def add(what, limit, value, form, more=False):
        if value is not None:
            good = value >= limit if more else value <= limit
            rows.append([what, f"{'>=' if more else '<='} {limit:g}", format(value, form), "met" if good else "**missed**"])
    if "peers" in parts:
        add("steps of the Taylor rod in 3d at h", 1250, parts["peers"]["steps_3d"], "d")
    if "wait" in parts:
        wait = parts["wait"]["rows"]
        add("whole run over its steps, 3d", 1.05, wait["3d, h, 1 thread"]["whole_over_steps"], ".3f")
        add("whole run over its steps, 2670 axisymmetric points", 1.2, wait["axisymmetric, h, 1 thread"]["whole_over_steps"], ".2f")
        add("peak memory over what the points hold, 3d", 1.1, wait["3d, h, 1 thread"]["memory_over_points"], ".2f")
    if "scenes" in parts:
        cpu = {name: row["ns"]["cpu"] for name, row in parts["scenes"]["rows"].items()}
        add("axisymmetric point-step [ns]", 45, cpu["Taylor axisymmetric, h/4, 1 thread"], ".1f")
        add("3d point-step [ns]", 65, cpu["Taylor 3d, 1 thread"], ".1f")
    if "small" in parts:
        add("two threads at 10,680 axisymmetric points", 1.7, parts["small"]["two_threads"], ".2f", True)
    if "peers" in parts and parts["peers"]["probe_ns"]:
        scale = parts["peers"]["probe_ns"] / users.PEERS_PROBE_NS
        one = parts["peers"]["cost"]["0.01"]
        add(f"time to 1 % over that of {users.PEERS_ONE_PER_CENT[0]}", 0.2,
            one["cpu"] / (scale * users.PEERS_ONE_PER_CENT[1]) if one else None, ".2f")
    return rows


def add_asked(study, parts):
    study.add("## What was asked", "Limits that were set when a 3d point-step of the probe took 80 ns; nothing is scaled but the peers' "
              "times, which were measured beside that probe.")
    study.add_table(["", "asked", "measured", "verdict"], asked(parts))


def add_wait(study, part, calibration):
    study.add("## A user's wait", "`krater run inputs/taylor_copper.yaml`, output and measures included.", calibration)
    study.add_table(["run", "points", "steps", "wall time s", "of it steps s", "whole over steps", "set up s", "rows s", "frames s",
                     "checkpoints s", "processor s", "ns per point-step of the steps", "peak memory over points'"],
                    [[name, r["points"], r["steps"], f"{r['wall_seconds']:.2f}", f"{r['steps_seconds']:.2f}",
                      f"{r['whole_over_steps']:.3f}",
                      *(f"{r['outside_seconds'].get(k, 0):.2f}" for k in ("setup", "history_and_measures", "frames", "checkpoints")),
                      f"{r['processor_seconds']:.2f}", f"{sum(r['ns'].values()):.1f}", f"{r['memory_over_points']:.2f}"]
                     for name, r in part["rows"].items()])
    study.add("Others, 3d at h, one core, measured for this project on one machine in one run (not in this one): " +
              ", ".join(f"{name} {s} s" for name, s in part["peers_seconds_3d"].items()) + ".")


def add_small(study, part, calibration):
    study.add("## Few points", calibration)
    study.add_table(["run", "points", "us per step", "ns per point-step", "cpu ns"],
                    [[name, r["points"], f"{r['us']:.0f}", f"{r['step']:.1f}", f"{r['cpu']:.1f}"] for name, r in part["small"].items()])


def add_cores(study, part, calibration):
    threads = ("2", "4", "8", "16", "32", "64")
    study.add("## More cores, by a model", "From a run on one thread: what is outside parallel loops stays, each loop is dealt out by its items "
              "(patches or blocks of nodes; all of one loop alike), and wakes its threads by a tree whose one branch is what an empty loop "
              "takes on two. Memory is not in it: what 64 cores would ask for stands beside it.", calibration)
    study.add_table(["scene", "points", "patches", "serial %", "empty loop us", "2 measured", *(f"{p} threads" for p in threads), "GB/s at 64"],
                    [[name, r["points"], r["patches"], f"{100 * r['serial_share']:.2f}", f"{r['empty_us']:.1f}", f"{r['measured_two']:.2f}",
                      *(f"{r['speedup'][p]:.1f}" for p in threads),
                      f"{1e-3 * r['bytes'] * r['points'] / (r['step_us'] / r['speedup']['64']):.0f}"] for name, r in part["cores"].items()])


def add_peers(study, part, calibration):
    study.add("## An error, and what it costs", "The copper rod about its axis, no frames: length and W against their limit (the finest cell and "
              "once more its last change), whole run, one thread.", calibration)
    study.add_table(["cell mm", "points", "steps", "length mm", "off its limit %", "W mm", "off its limit %", "processor s"],
                    [[f"{1e3 * r['cell']:.4g}", r["points"], r["steps"],
                      *(x for m in ("final_length", "w_diameter")
                        for x in (f"{1e3 * r[m]:.4f}", f"{100 * (r[m] / part['limit'][m] - 1):+.2f}")), f"{r['cpu']:.2f}"] for r in part["runs"]])
    costs = [f"{100 * float(share):g} %: {r['cpu']:.2f} s" if r else f"{100 * float(share):g} %: no cell" for share, r in part["cost"].items()]
    study.add("Both within " + ", ".join(costs) + " (all finer cells, too).")
    if part["probe_ns"]:
        scale = part["probe_ns"] / users.PEERS_PROBE_NS
        (peer_3d, s_3d), (peer, s) = users.PEERS_3D, users.PEERS_ONE_PER_CENT
        study.add(f"The probe takes {part['probe_ns']:.1f} ns here, {users.PEERS_PROBE_NS:g} where peers were measured, so that their times are "
                  f"taken {scale:.2f} times as long: {peer} to 1 % {scale * s:.2f} s; {peer_3d} for the 3d run at h {scale * s_3d:.0f} s, "
                  f"Krater {part['three']:.0f} s ({part['three'] / (scale * s_3d):.2f} of it). Peers' runs to 0.3 % are not on record here.")


def add_inputs(study, part, calibration):
    study.add("## Shipped scenes, and the time step", f"Scenes that are estimated to take less than {users.LONGEST:.0f} s: as they are (CFL 0.9 of "
              "the limit of stability), with half of that (about the 0.5 of before), and with cells 1.25 times as large, which says what "
              "the cell's own error is of the order of. Largest relative change of any measure.", calibration)

    def change(pair):
        return "-" if pair[0] is None else f"{100 * pair[0]:.2f} ({pair[1]})"
    study.add_table(["scene", "steps", "steps, half", "processor s", "half", "moved by the step %", "by the cell %"],
                    [[name, r["now"]["steps"], r["half"]["steps"], f"{r['now']['cpu']:.2f}", f"{r['half']['cpu']:.2f}",
                      change(r["by_step"]), change(r["by_cell"])] for name, r in part["inputs"].items()])
    if part["left_out"]:
        study.add("Not run (longer, or studies): " + ", ".join(f"`{name}`" for name in part["left_out"]) + ".")
