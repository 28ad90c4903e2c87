#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""kill -9 at any moment, a disk that is full, a folder that may not be written, memory that ends: nothing that was there is
lost, a restart gives the same bits, and each has its message. (Flipped bits of a checkpoint: faults_test.py b18. Two runs in
one folder: interrupt_test.py.)"""

import contextlib
import os
import pathlib
import random
import signal
import subprocess
import time

from scene_support import (KRATER, ODD, TAYLOR, Folder, check, checkpoint_is_whole, differences, environment, finish,
                           results_errors, run, start)

VALUES = ["time.end=20 us", "output.frames=2 us", "output.checkpoint=0.02"]


def killed_anywhere(moments, restarts):
    begin = time.monotonic()
    run("whole", *VALUES)
    whole = time.monotonic() - begin
    draw = random.Random(9)
    continued = 0
    for k in range(moments):
        output = f"killed {k}"
        process = start(output, *VALUES)
        time.sleep(draw.uniform(0, whole))
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=60)
        if process.returncode == 0 or not os.path.exists(output):
            continue
        if os.path.exists(f"{output}/history.csv"):
            errors = results_errors(output, "--killed")
            check(not errors, f"kill -9, moment {k}: results are readable", errors)
        checkpoint = f"{output}/checkpoint.h5"
        if not os.path.exists(checkpoint):
            continue
        check(checkpoint_is_whole(checkpoint), f"kill -9, moment {k}: the checkpoint is whole")
        if continued < restarts:
            continued += 1
            done = run(output, *VALUES, extra=["--restart", checkpoint])
            found = [d for d in differences("whole", output) if "resolved" not in d]
            check(done.returncode == 0 and not found, f"kill -9, moment {k}: the same bits after a restart",
                  f"{done.returncode} {found[:5]} {done.stderr[-200:]}")
    check(continued == restarts, f"{restarts} of {moments} moments had a checkpoint to go on from", continued)


@contextlib.contextmanager
def disk(options):
    """A small disk at ./disk, or None where this user may not mount one."""
    os.makedirs("disk", exist_ok=True)
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", "disk"], capture_output=True, check=False)
    try:
        yield "disk/out" if mounted.returncode == 0 else None
    finally:
        if mounted.returncode == 0:
            subprocess.run(["umount", "disk"], check=True)


def bad_disks():
    for size in (20, 200, 400, 800):
        with disk(f"size={size}k") as output:
            if output is None:
                print("skip  a full disk, a folder that may not be written: this user may not mount one")
                return
            done = run(output, *VALUES)
            check(done.returncode == 2 and "No space left" in done.stderr and "-o" in done.stderr,
                  f"{size} kB: says which file found no space", f"{done.returncode} {done.stderr.strip()[-200:]}")
            if os.path.exists(f"{output}/history.csv"):
                errors = results_errors(output, "--killed")
                check(not errors, f"{size} kB: what was written is readable", errors)
            if os.path.exists(f"{output}/checkpoint.h5"):
                check(checkpoint_is_whole(f"{output}/checkpoint.h5"), f"{size} kB: the checkpoint is whole")
                done = run("elsewhere", *VALUES, extra=["--restart", f"{output}/checkpoint.h5"])
                check(done.returncode == 0, f"{size} kB: the run goes on elsewhere", done.stderr[-200:])
    with disk("size=9m,ro") as output:
        done = run(output, *VALUES)
        check(done.returncode == 2 and "Read-only" in done.stderr and output in done.stderr, "read-only: refused, by name",
              done.stderr)
    with disk("size=64m") as output:
        process = start(output, *VALUES)
        while process.poll() is None and not os.path.exists(f"{output}/frames/000002.h5"):
            time.sleep(0.002)
        subprocess.run(["mount", "-o", "remount,ro", "disk"], check=False, capture_output=True)
        _, said = process.communicate(timeout=60)
        subprocess.run(["mount", "-o", "remount,rw", "disk"], check=False, capture_output=True)
        if process.returncode != 0:  # where a file was open for writing the disk does not become read-only
            check(process.returncode == 2 and "Read-only" in said, "read-only on the way: says so", said)
        errors = results_errors(output, "--killed")
        check(not errors, "read-only on the way: results are readable", errors)


def little_memory():
    """Enough, or a message; what is refused leaves nothing."""
    fits = 0
    for megabytes in range(40, 180, 40):
        command = f'ulimit -v {1000 * megabytes}; exec "{KRATER}" run "{TAYLOR}" -o memory{megabytes} -j 1 --set time.end=2us ' \
                  "--set grid.cell=0.1mm"
        done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False, env=environment(), timeout=120)
        fits += done.returncode == 0
        said = done.stdout + done.stderr
        check(done.returncode == 0 or (done.returncode in (2, 3) and "memory" in said and not ODD.search(said)) or
              (done.returncode == 127 and "error while loading shared libraries" in said),
              f"{megabytes} MB: runs, or says why not", f"{done.returncode} {said.strip()[-150:]}")
        if done.returncode == 2:
            check(not pathlib.Path(f"memory{megabytes}").exists(), f"{megabytes} MB: nothing is left behind")
    check(fits > 0, "it runs where there is memory", fits)


with Folder():
    killed_anywhere(20, 3)
    bad_disks()
    little_memory()
finish()
