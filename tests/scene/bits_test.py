#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The same bits for 1, 2, 3 threads, across a restart in mid-run, and for every instruction set."""

import os
import shutil
import signal

from scene_support import (Folder, check, checkpoint_is_whole, differences, finish, run, start, summary,
                           wait_for_rows)

CASES = {
    "axisymmetric": ["time.end=8 us", "output.frames=2 us"],
    "adaptive": ["method.reference={adaptive: {strain: 0.1}}", "time.end=6 us", "output.frames=2 us"],
    "3d": ["frame=3d", "grid.cell=0.762 mm", "time.end=2 us", "output.frames=0.5 us"],
    # What measures remember from row to row must survive a restart.
    "measures": ["time.end=6 us", "output.frames=2 us", "output.fields=[fragment]",
                 "measures.slows={kind: deceleration, body: rod, axis: z}",
                 "measures.peak={kind: deceleration, body: rod, axis: z, keep: largest}",
                 "measures.settled={kind: settling_time, body: rod, axis: z}",
                 "measures.shortest={kind: extent, body: rod, axis: z, keep: smallest, piece: largest}",
                 "measures.pieces={kind: fragments, body: rod, history: true}",
                 "measures.lost={kind: mass_lost, body: rod}"],
}


def same(one, other, what):
    found = differences(one, other)
    check(not found, f"{what}: frames, history, summary identical", ", ".join(found[:6]))


def threads(name, values):
    for n in (1, 2, 3):
        done = run(f"{name}_{n}", *values, threads=n)
        check(done.returncode == 0, f"{name}, {n} threads", done.stderr.strip().splitlines()[-1])
        check(summary(f"{name}_{n}")["machine"]["threads"] == n, f"{name} ran with {n} threads")
        if n > 1:
            same(f"{name}_1", f"{name}_{n}", f"{name}, 1 and {n} threads")


def interrupted(output, values, rows):
    """A run stopped by SIGTERM after so many rows of history; tries again if it was too fast."""
    for _ in range(5):
        process = start(output, *values, threads=2)
        if wait_for_rows(output, rows, process):
            process.send_signal(signal.SIGTERM)
        _, text = process.communicate(timeout=60)
        if process.returncode == 4:
            return text
    return None


def restart(name, values, rows):
    output = f"{name}_restarted"
    text = interrupted(output, values, rows)
    if not check(text is not None, f"{name}: SIGTERM in mid-run ends with exit code 4"):
        return
    s = summary(output)
    total = summary(f"{name}_1")["steps"]
    check(s["status"] == "interrupted" and 0 < s["steps"] < total and checkpoint_is_whole(f"{output}/checkpoint.h5"),
          f"{name}: interrupted at step {s['steps']} of {total}")
    shutil.copytree(output, f"{output}_elsewhere")
    done = run(output, *values, extra=["--restart", f"{output}/checkpoint.h5"])
    check(done.returncode == 0 and "changed since" not in done.stderr, f"{name}: continued",
          done.stderr.strip().splitlines()[-1])
    same(f"{name}_1", output, f"{name}, restarted in its folder with another number of threads")
    other = f"{output}_elsewhere"
    os.rename(f"{other}/checkpoint.h5", f"{name}.h5")
    done = run(other, *values, threads=3, extra=["--restart", f"{name}.h5"])
    same(f"{name}_1", other, f"{name}, restarted from a moved checkpoint")


def instruction_sets():
    values = ["time.end=2 us", "output.frames=1 us"]
    frames = {"2d": values, "adaptive": [*values, "method.reference={adaptive: {strain: 0.1}}"],
              # a few steps: without vector instructions a processor may take 5 s for one of them
              "3d": ["time.end=0.1 us", "frame=3d", "grid.cell=0.762 mm"]}
    for name, settings in frames.items():
        ran = []
        for level in ("portable", "v3", "v4"):
            done = run(f"isa_{name}_{level}", *settings, env={"KRATER_ISA": level})
            if done.returncode == 2 and "does not have it" in done.stderr:
                print(f"skip  {level}: not on this machine or in this build")
                continue
            check(done.returncode == 0 and level in summary(f"isa_{name}_{level}")["machine"]["instruction_set"],
                  f"{name} with {level}", done.stderr.strip().splitlines()[-1])
            ran.append(level)
            if level != "portable":
                same(f"isa_{name}_portable", f"isa_{name}_{level}", f"{name}, portable and {level}")
        check("portable" in ran, f"{name}: compared {', '.join(ran)}")


with Folder():
    for case, options in CASES.items():
        threads(case, options)
        restart(case, options, 5 if case == "3d" else 17)
    instruction_sets()
finish()
