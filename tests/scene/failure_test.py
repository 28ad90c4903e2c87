#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A computation that breaks: exit code 3, a message that says where and what, the last state readable."""

import re

import h5py
import numpy as np

from scene_support import (Folder, check, checkpoint_is_whole, differences, finish, history, results_errors, run,
                           summary)

NUMBER = r"-?[\d.]+(e[-+]\d+)?"
PLACE = {"body": r"body 'rod'", "point": r"point \d+ at", "position": rf"r = {NUMBER} m, z = {NUMBER} m",
         "time": rf"time {NUMBER} s", "step": r"step \d+"}
LAST_FIELDS = ("velocity", "pressure", "density", "internal_energy", "stress")


def readable(output, names):
    """The last state can be opened with what a user has: the frames, the history, the summary."""
    s = summary(output)
    check(s["status"] == "failed" and re.search(PLACE["body"], s.get("message", "")),
          f"{output}: summary says failed, with the message")
    with h5py.File(f"{output}/frames.h5", "r") as file:
        frames = sorted(file["frames"])
        body = file["frames"][frames[-1]]["rod"]
        fields = all(name in body and len(body[name]) == len(body["id"]) for name in LAST_FIELDS)
        times = [file["frames"][name].attrs["time"] for name in frames]
        count = len(file["frames"][frames[0]]["rod"]["id"])
        check(fields and len(body["id"]) == count and np.all(np.diff(times) > 0),
              f"{output}: frames.h5 opens", f"{len(frames)} frames, the last of {len(body['id'])} points at {times[-1]:.3e} s")
    check(checkpoint_is_whole(f"{output}/checkpoint.h5"), f"{output}: checkpoint.h5 opens")
    check(len(history(output)["time"]) >= 1, f"{output}: history.csv can be read")
    errors = [line for line in results_errors(output).splitlines()
              if not re.search(r"values are not finite|is -?(nan|inf)$", line)]
    check(not errors, f"{output}: results are whole but for values that are not finite", "; ".join(errors[:3]))
    print(f"      {output}: broken fields: {names}")


def fails(output, reason, field, *values):
    done = run(output, *values)
    message = next((line for line in done.stderr.splitlines() if "body '" in line), done.stderr.strip())
    missing = [what for what, text in {**PLACE, "reason": reason, "field": field}.items()
               if not re.search(text, message)]
    check(done.returncode == 3 and not missing, f"{output}: exit code {done.returncode}",
          (f"message lacks {', '.join(missing)}: " if missing else "") + message)
    if done.returncode == 3:
        readable(output, re.findall(r"field '(\w+)'", message))
    return done.returncode == 3


def good_again(output, *values):
    """checkpoint.h5 is the last whole state: with a sound setting it runs on."""
    done = run(f"{output} mended", *values, extra=["--restart", f"{output}/checkpoint.h5"])
    errors = results_errors(f"{output} mended")
    check(done.returncode == 0 and not errors, f"{output}: continued from its checkpoint with {', '.join(values)}",
          done.stderr.strip().splitlines()[-1] + errors)


COARSE = ("grid.cell=0.762 mm",)
END = "time.end=2 us"

with Folder():
    # A part of the rod without a velocity, z < 10 mm; an infinite one at a single row of points; steps that are not
    # stable. These can be known before the first step: bad input.
    for name, text, *values in (
            ("planted NaN", r"bodies\.rod\.velocity is not finite at", "bodies.rod.velocity=[0, \"-190 + 0 * sqrt(z - 0.01)\"]"),
            ("planted infinity", r"bodies\.rod\.velocity is not finite at", *COARSE,
             "bodies.rod.velocity=[0, \"-190 - 1e-9 / (z > 0.0252 ? 0 : 1)\"]"),
            ("long first step", r"first_step, 1e-06 s, is longer than the stable step", "time.first_step=1 us"),
            ("vanishing step", r"min_step, 1e-06 s, is longer than the stable step", "time.min_step=1 us")):
        done = run(name, END, *values)
        check(done.returncode == 2 and re.search(text, done.stderr), f"{name}: refused", done.stderr.strip())
    # In mid-run: the body force has a pole in time.
    fails("NaN in mid-run", "not finite", "field '\\w+' component \\d is -?nan", END, *COARSE, "output.frames=0.5 us",
          "body_force=[0, \"0 * sqrt(1.3e-6 - t)\"]")
    with h5py.File("NaN in mid-run/frames.h5", "r") as h5:
        check(len(h5["frames"]) == 4, "the frames at 0, 0.5 and 1 us came before it")
    # The stable step of this scene is about 28 ns, the first steps are shorter.
    done = run("small steps", END, "time.min_step=15 ns")
    check(done.returncode == 0, "time.min_step between the first step and the stable step does no harm",
          done.stderr.strip())
    # Later: a body force crushes the rod, and the step gets shorter.
    force = "body_force=[0, -4e9]"
    if fails("vanishing later", r"time step vanished", r"field '\w+' is", END, *COARSE, force, "time.min_step=45 ns"):
        check(summary("vanishing later")["steps"] > 10, "it was under way", str(summary("vanishing later")["steps"]))
        good_again("vanishing later", END, *COARSE, force)
    # The same failure again: a second run and another number of threads.
    done = run("again", END, *COARSE, "body_force=[0, \"0 * sqrt(1.3e-6 - t)\"]", "output.frames=0.5 us", threads=2)
    found = [d for d in differences("NaN in mid-run", "again") if "summary" not in d]
    check(done.returncode == 3 and not found, "with 2 threads it fails with the same bits", ", ".join(found[:5]))
finish()
