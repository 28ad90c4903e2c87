#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Contact on a fixed reference with what stands beside it: loads on faces, walls, friction, three bodies, restart."""

import pathlib

from scene_support import Folder, check, differences, finish, krater, run, summary

STACK = """
frame: axisymmetric
grid: {cell: 0.5 mm, box: {min: [0, 0], max: [10 mm, 14 mm]}, boundary: {r_min: axis, z_min: {wall: {friction: 0.1}}}}
time: {end: 6 us}
method: {reference: initial}
output: {frames: 3 us}
materials:
  soft: {density: 2700, shear_modulus: 26 GPa, strength: {von_mises: {Y: 200 MPa, H: 100 MPa}},
         eos: {mie_gruneisen_shock: {c0: 5240 m/s, S1: 1.4, gamma0: 2}}}
bodies:
  base: {material: soft, shape: {cylinder: {radius: 8 mm, height: 3 mm}}}
  middle: {material: soft, shape: {cylinder: {radius: 6 mm, height: 3 mm, base: [0, 3.2 mm]}}}
  top: {material: soft, shape: {cylinder: {radius: 4 mm, height: 3 mm, base: [0, 6.4 mm]}}, velocity: [0, -300 m/s]}
contact: {friction: 0.2}
loads:
  push: {body: top, face: z_max, pressure: {table: [[0, 1 GPa], [4 us, 0]]}}
"""


def main():
    with Folder() as folder:
        scene = pathlib.Path(folder, "stack.yaml")
        scene.write_text(STACK, encoding="utf-8")
        for name, value in (("initial", "initial"), ("adaptive", "{adaptive: {strain: 0.1}}")):
            one = run(f"{name}_1", f"method.reference={value}", scene=scene)
            check(one.returncode == 0, f"{name}: runs", one.text[-300:])
            audit = summary(f"{name}_1")["audit"]
            check(abs(audit["energy_residual_fraction"]) < 1e-10, f"{name}: the account closes",
                  audit["energy_residual_fraction"])
            check(audit["contact_heat"] > 0 and audit["friction_work"] < 0, f"{name}: bodies meet and rub", audit["contact_heat"])
            run(f"{name}_2", f"method.reference={value}", scene=scene, threads=2)
            found = differences(f"{name}_1", f"{name}_2")
            check(not found, f"{name}: the same bits on two threads", found)
            run(f"{name}_3", f"method.reference={value}", "time.end=3 us", scene=scene)
            run(f"{name}_3", f"method.reference={value}", scene=scene, extra=["--restart", f"{name}_3/checkpoint.h5"])
            found = [d for d in differences(f"{name}_1", f"{name}_3") if "summary" not in d]
            check(not found, f"{name}: the same bits across a restart", found)
        for what, values, said in (
                ("a rigid body", ["bodies.top.rigid=free", "bodies.top.velocity=[0, 0]", "loads=none"], "reference: current only"),
                ("xpic", ["method.transfer={xpic: {order: 2}}", "loads=none"], "reference: current"),
                ("musl", ["method.update=musl"], "reference: current"),
                ("a driven side", ["grid.boundary.z_max={velocity: [0, -1]}"], "reference: current")):
            done = krater("check", scene, *(x for v in values for x in ("--set", v)))
            check(done.returncode == 2 and said in done.text, f"refused on a fixed reference: {what}", done.text[-400:])
    finish()


main()
