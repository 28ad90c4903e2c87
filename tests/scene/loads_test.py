#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads and damping of a run as a user gets them: account, restart, threads, sides of the box, faces that wear away."""

import pathlib

from scene_support import Folder, check, differences, finish, krater, run, summary

BLAST = """
frame: axisymmetric
grid: {cell: 0.5 mm, box: {min: [0, -8 mm], max: [10 mm, 4 mm]}, boundary: {r_min: axis}}
time: {end: 6 us}
output: {frames: 3 us}
materials:
  soft: {density: 2700, shear_modulus: 26 GPa, strength: {von_mises: {Y: 200 MPa, H: 100 MPa}},
         eos: {mie_gruneisen_shock: {c0: 5240 m/s, S1: 1.4, gamma0: 2}}}
bodies:
  plate: {material: soft, shape: {cylinder: {radius: 8 mm, height: 3 mm}}}
  block: {material: soft, shape: {cylinder: {radius: 8 mm, height: 4 mm, base: [0, -4.5 mm]}}}
contact: {friction: 0}
damping: {mass: 1e4 1/s}
loads:
  blast: {body: plate, face: z_max, where: {r_max: 5 mm}, pressure: {table: [[0, 2 GPa], [4 us, 0]]}}
  edge: {body: plate, face: r_max, velocity: [0, free]}
"""


def main():
    with Folder() as folder:
        scene = pathlib.Path(folder, "blast.yaml")
        scene.write_text(BLAST, encoding="utf-8")
        check(krater("check", scene).returncode == 0, "the scene passes its check")
        done = run("one", scene=scene)
        audit = summary("one")["audit"]
        work = audit["external_work"]
        check(done.returncode == 0 and work > 0, "the plate is driven", done.text[-300:])
        check(abs(audit["energy_residual"]) < 1e-10 * work, "the account closes", audit["energy_residual"] / work)
        check(abs(audit["load_work"] + audit["damping_work"] - work) < 1e-12 * work and audit["damping_work"] < 0,
              "loads and damping make up the work from outside", audit)
        check(audit["momentum_z"] < 0 and audit["contact_heat"] > 0, "the plate meets the block", audit["contact_heat"])
        run("two", scene=scene, threads=2)
        check(not differences("one", "two"), "the same bits on two threads", differences("one", "two"))
        run("parts", "time.end=3 us", scene=scene)
        run("parts", scene=scene, extra=["--restart", "parts/checkpoint.h5"])
        found = [d for d in differences("one", "parts") if "summary" not in d]
        check(not found, "the same bits across a restart", found)
        other = run("parts", "loads.blast.pressure=1 GPa", scene=scene, extra=["--restart", "parts/checkpoint.h5"])
        check(other.returncode == 2 and "loads.blast.pressure" in other.text, "a restart refuses another load", other.text)
        # The same on the side of the box that the plate reaches.
        sides = ["loads=none", "grid.box={min: [0, -8 mm], max: [10 mm, 3 mm]}", "grid.boundary.z_max={pressure: 2 GPa}"]
        done = run("side", *sides, scene=scene)
        audit = summary("side")["audit"] if done.returncode == 0 else {"load_work": 0, "energy_residual": 0}
        check(audit["load_work"] > work and abs(audit["energy_residual"]) < 1e-10 * audit["load_work"],
              "a side presses on what reaches it", done.text[-300:])
        # A face whose points are removed: the load goes on with what is left of it.
        wears = ["materials.soft.damage={maximum_plastic_strain: {eps_max: 0.05}}",
                 "materials.soft.failure={action: remove}", "loads.blast.pressure={table: [[0, 6 GPa], [4 us, 0]]}"]
        done = run("wears", *wears, scene=scene)
        audit = summary("wears")["audit"] if done.returncode == 0 else {"events": {"removed_failed_points": 0}}
        check(audit["events"]["removed_failed_points"] > 0 and
              abs(audit["energy_residual"]) < 1e-10 * audit["load_work"], "a face that wears away stays loaded", done.text[-300:])
        for setting in ("loads.blast.where={z_min: 30 mm}", "loads.blast.where={r_min: 4 mm, r_max: 4.01 mm}",
                        "loads.more={body: block, pressure: 1 GPa, inside: {sphere: {radius: 1 mm, center: [0, 20 mm]}}}"):
            done = krater("check", scene, "--set", setting)
            check(done.returncode == 2 and "loads." in done.text and "nothing to act on" in done.text,
                  f"{setting}: a face that no body has is refused", done.text[:300])
    finish()


main()
