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

import numpy as np

from scene_support import (KRATER, ROOT, Folder, check, datasets, differences, environment, finish, run, same_bits,
                           settings, summary)

PROGRAM = pathlib.Path(KRATER).with_name("krater_on_ranks")
if not PROGRAM.exists():
    PROGRAM = pathlib.Path(KRATER)
INPUTS = ROOT / "inputs"
LAUNCHER = ["mpirun", "--oversubscribe", "--bind-to", "none", "-np"]
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
PLAIN = "plain.yaml"  # written here: Taylor's rod without its measures
# Scene, what is set, and on how many ranks: cuts of four go through the middle, where bodies meet; scattered blocks change
# hands every few steps.
CUT, SCATTERED = (4, ""), (2, "scattered")
CASES = {
    # a wall with friction, symmetry at the axis, blocks that sleep
    "taylor": ("taylor_copper.yaml", ["time.end=8 us", "output.frames=2 us", "grid.cell=0.3 mm"], [CUT, SCATTERED]),
    # contact, damage, failed points that go, open sides
    "plugging": ("ccf_plugging.yaml", ["grid.cell=1 mm", "time.end=40 us", "output.frames=20 us"], [CUT, SCATTERED]),
    # planes of symmetry along two axes, contact in space
    "bars": ("ccf_two_bars.yaml", ["grid.cell=1.25 mm", "time.end=6 us", "output.frames=3 us"], [CUT]),
    # points that leave the box; no measures, so that no rank ever has all points
    "leaves": (PLAIN, ["time.end=6 us", "output.frames=3 us", "grid.cell=0.3 mm", "bodies.rod.velocity=[0, 400 m/s]",
                       "grid.box.max=[12 mm, 26 mm]"], [SCATTERED]),
    # a free rigid body that feels a body force, impulses of contact, another update
    "rigid": ("ccf_plugging.yaml", ["grid.cell=1.5 mm", "time.end=30 us", "output.frames=15 us", "contact.friction=0.2",
                                    "bodies.projectile.rigid=free", "body_force=[0, 1e6]", "method.update=musl",
                                    "measures.given={kind: impulse, body: projectile, axis: z, by: plate}"], [SCATTERED]),
    # finer cells that follow debris and strain; points that split and merge
    "levels": ("hiermaier_al.yaml", ["grid.cell=1 mm", "time.end=3 us", "output.frames=1 us", "grid.merge=true",
                                     "grid.refine=[{follow: sphere, margin: 2 mm, level: 1}, "
                                     "{where: {field: plastic_strain, above: 0.3}, level: 2}]"], [CUT, SCATTERED]),
    # the same along a path, with a rigid body and a gauge
    "penetration": ("snl/penetration.yaml", ["grid.cell=76.2 mm", "time.end=0.4 ms", "output.frames=0.2 ms"], [SCATTERED]),
    # finer cells of two bodies in contact, in space; long points in halves
    "levels_space": ("ccf_two_bars.yaml", ["grid.cell=1.25 mm", "time.end=4 us", "output.frames=2 us",
                                           "method.numerical_fracture=split",
                                           "grid.refine=[{where: {field: plastic_strain, above: 0.2}, level: 1}]"],
                     [SCATTERED]),
    # a filtered transfer; a reference configuration that is renewed; loads on faces; pressure on the grid
    "xpic": ("taylor_copper.yaml", ["time.end=4 us", "output.frames=2 us", "grid.cell=0.5 mm", "method.transfer=xpic"],
             [SCATTERED]),
    "adaptive": ("taylor_copper.yaml", ["time.end=8 us", "output.frames=4 us", "grid.cell=0.5 mm",
                                        "method.reference=adaptive"], [SCATTERED]),
    "loaded": ("copper_spall.yaml", ["grid.cell=0.04 mm", "grid.box.min=[0, -1.12 mm]", "time.end=0.4 us", "output.frames=0.2 us",
                                    "grid.box.max=[0.08 mm, 6 mm]"], [SCATTERED]),
    "fluid": ("plate_impact.yaml", ["time.end=0.3 us", "output.frames=0.1 us"], [SCATTERED]),
}


def place_of(scene):
    return pathlib.Path(scene) if scene == PLAIN else INPUTS / scene


def write_plain():
    text = (INPUTS / "taylor_copper.yaml").read_text(encoding="utf-8")
    pathlib.Path(PLAIN).write_text(text[:text.index("\nmeasures:") + 1], encoding="utf-8")


def on_ranks(count, scene, output, *values, extra=(), env=None, threads=1):
    words = [*LAUNCHER, str(count), str(PROGRAM), "run", str(place_of(scene)), "-o", output,
             "-j", str(threads), *settings(values), *map(str, extra)]
    return subprocess.run(words, capture_output=True, text=True, timeout=300, check=False,
                          env=environment({**AS_ROOT, **(env or {})}))


def last_line(done):
    return (done.stderr.strip().splitlines() or [""])[-1]


def same(one, other, what):
    found = differences(one, other)
    a, b = (datasets(f"{name}/checkpoint.h5") for name in (one, other))
    found += [f"checkpoint: {name}" for name in sorted(a.keys() | b.keys())
              if name not in a or name not in b or not same_bits(np.asarray(a[name]), np.asarray(b[name]))]
    check(not found, f"{what}: frames, history, summary, checkpoint identical", ", ".join(found[:6]))


def bits():
    for name, (scene, values, deals) in CASES.items():
        done = run(f"{name}_alone", *values, scene=place_of(scene))
        check(done.returncode == 0, f"{name} alone", last_line(done))
        for count, deal in deals:
            output = f"{name}_{count}{deal}"
            done = on_ranks(count, scene, output, *values, env={"KRATER_DEAL": deal})
            check(done.returncode == 0, f"{name} on {count} ranks {deal}", done.stderr[-300:] if done.returncode else "")
            if done.returncode == 0:
                check(summary(output)["machine"]["ranks"] == count, f"{output} ran on {count} ranks")
                same(f"{name}_alone", output, f"{name}, one and {count} ranks {deal}")


def restarts():
    scene, values, _ = CASES["taylor"]
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
    scene, values, _ = CASES["taylor"]
    done = on_ranks(2, "taylor_copper_sph.yaml", "refused")
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
    write_plain()
    bits()
    restarts()
    errors()
finish()
