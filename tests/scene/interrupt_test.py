#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""SIGTERM and Ctrl-C write a checkpoint and say how to go on; kill -9 leaves what was written readable."""

import os
import shlex
import signal
import subprocess

from scene_support import (KRATER, TAYLOR, Folder, check, checkpoint_is_whole, finish, krater, results_errors, run, start,
                           summary, wait_for_rows)

VALUES = ["time.end=400 us", "output.frames=1 us"]


def stop(output, number, rows=6, values=VALUES):
    process = start(output, *values)
    check(wait_for_rows(output, rows, process), f"{output} is under way")
    process.send_signal(number)
    if number == signal.SIGINT:
        process.send_signal(number)  # an impatient user
    _, text = process.communicate(timeout=60)
    return process.returncode, text


def polite(number):
    output = f"{number.name} out"
    code, text = stop(output, number)
    check(code == 4, f"{number.name}: exit code 4", f"{code}: {text.strip()}")
    check(checkpoint_is_whole(f"{output}/checkpoint.h5"), f"{number.name}: checkpoint.h5 is whole")
    errors = results_errors(output)
    check(not errors, f"{number.name}: results are sound", errors)
    s = summary(output)
    check(s["status"] == "interrupted" and "--restart" in s["message"], f"{number.name}: summary says so")
    # The command the message gives, as a user pastes it into a shell; only the end is brought nearer.
    line = next((x for x in text.splitlines() if "continue with: " in x), "")
    words = shlex.split(line.partition("continue with: ")[2])
    if not check(words[:2] == ["krater", "run"] and "--restart" in words, f"{number.name}: says how to continue",
                 line):
        return
    end = f"time.end={s['time'] + 1e-6}"
    done = krater(*words[1:], "--set", end)
    check(done.returncode == 0 and summary(output)["status"] == "done", f"{number.name}: that command continues it",
          done.stderr.strip().splitlines()[-1])
    errors = results_errors(output)
    check(not errors, f"{number.name}: results of the continued run are sound", errors)
    check(not [n for n in os.listdir(output) if n.endswith(".part") or n == ".running"],
          f"{number.name}: nothing half-written is left")


def killed():
    for rows in (1, 12):
        code, _ = stop("killed", signal.SIGKILL, rows)
        check(code == -9, f"kill -9 after {rows} rows")
        errors = results_errors("killed", "--killed")
        check(not errors, "killed: results are readable", errors)
        check(rows == 1 or checkpoint_is_whole("killed/checkpoint.h5"), "killed: a checkpoint is there and whole")
    done = run("killed", "time.end=1 us")
    check(done.returncode == 0, "a second run into that folder", done.stderr.strip())
    errors = results_errors("killed")
    check(not errors and summary("killed")["status"] == "done", "its results are its own and sound", errors)
    done = run("killed", "time.end=0.5 us")
    errors = results_errors("killed")
    check(done.returncode == 0 and not errors and summary("killed")["time"] == 0.5e-6,
          "a third run replaces the second", errors)


def two_at_once():
    process = start("shared", *VALUES)
    check(wait_for_rows("shared", 3, process), "a first run writes into a folder")
    done = run("shared", "time.end=1 us")
    check(done.returncode == 2 and "shared: another run" in done.stderr and "-o" in done.stderr,
          "a second run into the same folder is refused", done.stderr.strip())
    check(process.poll() is None, "and the first goes on")
    process.terminate()
    process.communicate(timeout=60)
    errors = results_errors("shared")
    check(process.returncode == 4 and not errors, "the first run's results are sound", errors)


def deaf_output():
    for name, redirection in {"closed": "2>&-", "full": "2>/dev/full"}.items():
        script = f"exec {shlex.quote(KRATER)} run {shlex.quote(str(TAYLOR))} --set time.end=0.4us -o {name} {redirection}"
        done = subprocess.run(["bash", "-c", script], check=False)
        check(done.returncode == 0 and not results_errors(name), f"standard error {name}: the run does not mind",
              str(done.returncode))


with Folder():
    polite(signal.SIGTERM)
    polite(signal.SIGINT)
    killed()
    two_at_once()
    deaf_output()
finish()
