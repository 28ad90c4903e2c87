#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Several processes compute one scene with the bits of one: frames, history, summary and checkpoint, with
blocks dealt out by their work or at random; a restart on another number of them; errors that all hear of.
Skipped where the packages of tools/setup --mpi are missing."""

import os
import pathlib
import shutil
import subprocess
import sys

from scene_support import KRATER, ROOT, Folder, check, differences, environment, finish, run, settings, summary

PROGRAM = pathlib.Path(KRATER).with_name("krater_on_ranks")
if not PROGRAM.exists():
    PROGRAM = pathlib.Path(KRATER)
INPUTS = ROOT / "inputs"
LAUNCHER = ["mpirun", "--oversubscribe", "--bind-to", "none", "-np"]
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
CASES = {
    # a wall with friction, symmetry at the axis, blocks that sleep
    "taylor": ("taylor_copper.yaml", ["time.end=8 us", "output.frames=2 us", "grid.cell=0.3 mm"]),
    # contact, damage, failed points that go, open sides
    "plugging": ("ccf_plugging.yaml", ["grid.cell=1 mm", "time.end=40 us", "output.frames=20 us"]),
    # planes of symmetry along two axes, contact in space
    "bars": ("ccf_two_bars.yaml", ["grid.cell=1.25 mm", "time.end=6 us", "output.frames=3 us"]),
    # debris
    "bumper": ("hiermaier_al.yaml", ["grid.cell=1 mm", "time.end=3 us", "output.frames=1 us"]),
    # points that leave the box
    "leaves": ("taylor_copper.yaml", ["time.end=6 us", "output.frames=3 us", "grid.cell=0.3 mm",
                                      "bodies.rod.velocity=[0, 400 m/s]", "grid.box.max=[12 mm, 26 mm]"]),
    # impulses of contact, a body force, another update
    "measured": ("ccf_plugging.yaml", ["grid.cell=1.5 mm", "time.end=20 us", "output.frames=10 us",
                                       "method.update=musl", "body_force=[0, 1e6]",
                                       "measures.given={kind: impulse, body: projectile, axis: z, by: plate}"]),
    # a free rigid body that strikes, loses points at an open side, and feels a body force
    "rigid": ("ccf_plugging.yaml", ["grid.cell=1.5 mm", "time.end=30 us", "output.frames=15 us", "contact.friction=0.2",
                                    "bodies.projectile.rigid=free", "body_force=[0, 1e6]"]),
    # a filtered transfer; a reference configuration that stays
    "xpic": ("taylor_copper.yaml", ["time.end=6 us", "output.frames=3 us", "grid.cell=0.5 mm", "method.transfer=xpic"]),
    "initial": ("taylor_copper.yaml", ["time.end=6 us", "output.frames=3 us", "grid.cell=0.5 mm",
                                       "method.reference=initial"]),
}


def on_ranks(count, scene, output, *values, extra=(), env=None, threads=1):
    words = [*LAUNCHER, str(count), str(PROGRAM), "run", str(INPUTS / scene), "-o", output,
             "-j", str(threads), *settings(values), *map(str, extra)]
    return subprocess.run(words, capture_output=True, text=True, timeout=300, check=False,
                          env=environment({**AS_ROOT, **(env or {})}))


def last_line(done):
    return (done.stderr.strip().splitlines() or [""])[-1]


def same(one, other, what):
    found = differences(one, other)
    check(not found, f"{what}: frames, history, summary identical", ", ".join(found[:6]))


def bits():
    for name, (scene, values) in CASES.items():
        done = run(f"{name}_alone", *values, scene=INPUTS / scene)
        check(done.returncode == 0, f"{name} alone", last_line(done))
        # cuts of two and four go through the middle, where bodies meet; scattered blocks change hands every few steps
        for count, deal in ((4, ""), (2, "scattered")):
            output = f"{name}_{count}{deal}"
            done = on_ranks(count, scene, output, *values, env={"KRATER_DEAL": deal})
            check(done.returncode == 0, f"{name} on {count} ranks {deal}", done.stderr[-300:] if done.returncode else "")
            if done.returncode == 0:
                check(summary(output)["machine"]["ranks"] == count, f"{output} ran on {count} ranks")
                same(f"{name}_alone", output, f"{name}, one and {count} ranks {deal}")


def restarts():
    scene, values = CASES["taylor"]
    done = on_ranks(3, scene, "first", *values, "time.end=4 us")
    check(done.returncode == 0, "a shorter run on three ranks", last_line(done))
    for count in (1, 2):
        output = f"restarted_{count}"
        shutil.copytree("first", output)
        done = on_ranks(count, scene, output, *values, extra=["--restart", f"{output}/checkpoint.h5"])
        check(done.returncode == 0, f"continued on {count} ranks", last_line(done))
        one, other = summary("taylor_alone"), summary(output)
        check(one["measures"] == other["measures"] and one["audit"] == other["audit"] and one["steps"] >= 1,
              f"continued on {count} ranks: the same answer")


def errors():
    scene, values = CASES["taylor"]
    done = on_ranks(2, scene, "refused", *values, "method.transfer=xpic")
    check(done.returncode == 2 and "several ranks" in done.stderr, "what cannot be distributed is refused by name",
          done.stderr[:200])
    done = subprocess.run([*LAUNCHER, "2", str(PROGRAM), "check", str(INPUTS / scene)], capture_output=True, text=True,
                          timeout=60, check=False, env=environment(AS_ROOT))
    check(done.returncode == 0 and done.stdout.count("Taylor anvil") == 1, "what is no run is done once",
          done.stderr[-200:])
    other = [str(PROGRAM), "run", str(INPUTS / scene), "-o", "uneven", "-j", "1", *settings(values)]
    done = subprocess.run([*LAUNCHER, "1", *other, ":", "-np", "1", *other, "--set", "grid.cells=1 mm"], timeout=60,
                          capture_output=True, text=True, check=False, env=environment(AS_ROOT))
    check(done.returncode == 2 and "grid.cells" in done.stderr and "another rank" in done.stderr,
          "what keeps one rank from beginning ends all and is heard", done.stderr[:300])
    alone = subprocess.run([KRATER, "--version"], capture_output=True, text=True, check=False,
                           env=environment({"OMPI_COMM_WORLD_SIZE": "4"}))
    if PROGRAM != pathlib.Path(KRATER):
        check(alone.returncode == 2 and "KRATER_MPI" in alone.stderr, "a program without MPI does not run several times",
              alone.stderr)
    done = on_ranks(2, scene, "unknown", "grid.cells=1 mm")
    check(done.returncode == 2 and done.stderr.count("grid.cells") >= 1, "a wrong key ends all ranks", last_line(done))
    pathlib.Path("blocked").write_text("a file")
    done = on_ranks(3, scene, "blocked", *values)
    check(done.returncode == 2, "a folder that cannot be written ends all ranks", last_line(done))
    broken = ["body_force=[0, \"0 * sqrt(1.3e-6 - t)\"]"]
    alone = run("broken_alone", *values, *broken, scene=INPUTS / scene)
    done = on_ranks(3, scene, "broken", *values, *broken)
    reason = summary("broken_alone")["message"]
    check(alone.returncode == done.returncode == 3 and summary("broken")["message"] == reason and reason in done.stderr,
          "a run that breaks ends on all ranks with the same words", reason)
    same("broken_alone", "broken", "its last frame")


if not PROGRAM.exists() or shutil.which("mpirun") is None:
    print("skipped: no krater_on_ranks or no mpirun (tools/setup --mpi)")
    sys.exit(77)
with Folder():
    bits()
    restarts()
    errors()
finish()
