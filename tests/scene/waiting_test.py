#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""On a machine whose cores others want, too, threads that wait for each other do not burn them, and a small scene takes few."""

import os
import pathlib
import subprocess
import sys
import time

from scene_support import KRATER, TAYLOR, Folder, check, differences, finish, settings, summary

BUSY = [sys.executable, "-c", "while True: pass"]
# Of one thread. Looking for milliseconds at the end of every loop costs ten to thirty times as much.
MOST = 4


# As a user has it: nothing set about how threads wait.
PLAIN = {k: v for k, v in os.environ.items() if k not in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")}


def command(name, threads):
    return [KRATER, "run", TAYLOR, "-o", name, "-j", str(threads), "--quiet", *settings(["time.end=10 us"])]


def processor_seconds(name, threads):
    done = subprocess.run(command(name, threads), env=PLAIN, capture_output=True, text=True, timeout=300, check=False)
    check(done.returncode == 0, f"{name} runs", done.stderr.strip())
    return summary(name)["machine"]["processor_seconds"]


def setting_in(name, **own):
    """GOMP_SPINCOUNT that a run works with; None: not set."""
    with subprocess.Popen(command(name, 2), env={**PLAIN, **own}, stdout=subprocess.DEVNULL) as process:
        while process.poll() is None and not pathlib.Path(name).is_dir():
            time.sleep(0.01)
        words = pathlib.Path(f"/proc/{process.pid}/environ").read_bytes().split(b"\0")
        process.kill()
    return next((word.split(b"=")[1].decode() for word in words if word.startswith(b"GOMP_SPINCOUNT=")), None)


def main():
    with Folder():
        cores = len(os.sched_getaffinity(0))
        busy = [subprocess.Popen(BUSY) for _ in range(2 * cores)]
        try:
            one = processor_seconds("one", 1)
            two = min(processor_seconds(f"two_{n}", 2) for n in range(3))
            check(two < MOST * one, "two threads among other programs", f"{two:.2f} s of processor, one alone {one:.2f} s")
        finally:
            for process in busy:
                process.kill()
                process.wait()
        many = {**PLAIN, "OMP_NUM_THREADS": "64"}
        for name, asked in (("fitting", ()), ("asked", ("-j", "5"))):
            done = subprocess.run([KRATER, "run", TAYLOR, "-o", name, *asked, *settings(["time.end=1 us"])], env=many,
                                  capture_output=True, text=True, timeout=300, check=False)
            used = summary(name)["machine"]["threads"]
            check(done.returncode == 0 and (used == 5 if asked else 1 < used < 15), f"{name}: threads of 64 for 15 patches", used)
        check(not differences("fitting", "asked"), "the bits do not depend on it")
        check(int(setting_in("plain") or 0) > 0, "a limit is set where a user sets nothing")
        check(setting_in("active", OMP_WAIT_POLICY="active") is None and setting_in("own", GOMP_SPINCOUNT="77") == "77",
              "what a user sets about it stays")
    finish()


if __name__ == "__main__":
    main()
