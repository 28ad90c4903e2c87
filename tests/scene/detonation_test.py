#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Programmed burn as a user gets it: a front round an obstacle, account, threads, restart, and what is refused."""

import pathlib

from scene_support import Folder, check, differences, finish, krater, run, summary

CHARGE = """
frame: plane_strain
grid: {cell: 1 mm, box: {min: [-4 mm, -4 mm], max: [34 mm, 24 mm]}}
time: {end: 8 us}
output: {frames: 4 us, fields: [burn_fraction, since_lighting]}
materials:
  tnt:
    density: 1630
    eos: {jwl_burn: {A: 371.2 GPa, B: 3.231 GPa, R1: 4.15, R2: 0.95, omega: 0.3, E0: 7 GPa, D: 6930, p_CJ: 21 GPa,
                     bulk_modulus: 10.8 GPa}}
    viscosity: {}
  steel: {density: 7850, shear_modulus: 80 GPa, eos: {linear: {bulk_modulus: 160 GPa}}, strength: {von_mises: {Y: 1 GPa}}}
bodies:
  charge: {material: tnt, shape: {box: {min: [0, -1, 0], max: [30 mm, 1, 20 mm]}}}
  wall: {material: steel, wins_over: [charge], shape: {box: {min: [13 mm, -1, 0], max: [17 mm, 1, 14 mm]}}}
contact: {friction: 0}
detonators:
  cap: {point: [4 mm, 2 mm], time: 1 us}
measures:
  burnt: {kind: mean, body: charge, field: burn_fraction}
  behind: {kind: mean, body: charge, field: since_lighting, region: {x_min: 19 mm, z_max: 4 mm}, history: true}
"""

WRONG = {
    "nothing lights": (["detonators=none"], "nothing lights this explosive"),
    "no explosive near": (["detonators.cap.point=[-3 mm, 2 mm]"], "no explosive is within half a cell"),
    "cut off": (["bodies.wall.shape.box.max=[17 mm, 1, 20 mm]"], "no detonation reaches the explosive"),
    "two places": (["detonators.cap.line=[[0, 0], [1 mm, 0]]"], "expected one of point, line and plane"),
    "no direction": (["detonators.b={plane: {through: [0, 0], normal: [0, 0]}}"], "the normal has no direction"),
    "before the start": (["detonators.cap.time=-1 us"], "lights at the start"),
    "a unit of the wrong kind": (["detonators.cap.time=1 mm"], "detonators.cap.time"),
    "one end": (["detonators.b={line: [[0, 0]]}"], "the two ends of the line"),
    "D of another explosive": (["materials.tnt.eos.jwl_burn.D=8000"], "off the Chapman-Jouguet velocity"),
    "temperature of the unburnt": (["materials.tnt.heating={energy: {c_v: 1000}}"], "knows the temperature of products only"),
    "an unknown word": (["materials.tnt.eos.jwl_burn.burn=slowly"], "slowly"),
}


def main():
    with Folder() as folder:
        scene = pathlib.Path(folder, "charge.yaml")
        scene.write_text(CHARGE, encoding="utf-8")
        checked = krater("check", scene)
        check(checked.returncode == 0, "the scene passes its check", checked.text[-300:])
        done = run("one", scene=scene)
        s = summary("one")
        check(done.returncode == 0, "it runs", done.text[-300:])
        audit = s["audit"]
        check(abs(audit["energy_residual_fraction"]) < 1e-10, "the account closes", audit["energy_residual_fraction"])
        check(s["measures"]["burnt"]["value"] > 0.999, "all of it burns", s["measures"]["burnt"])
        run("two", scene=scene, threads=2)
        check(not differences("one", "two"), "the same bits on two threads", differences("one", "two"))
        run("parts", "time.end=4 us", scene=scene)
        run("parts", scene=scene, extra=["--restart", "parts/checkpoint.h5"])
        found = [d for d in differences("one", "parts") if "summary" not in d]
        check(not found, "the same bits across a restart in the middle of the burn", found)
        other = run("parts", "detonators.cap.time=0", scene=scene, extra=["--restart", "parts/checkpoint.h5"])
        check(other.returncode == 2 and "detonators.cap.time" in other.text, "a restart refuses another detonator", other.text)
        for name, (values, said) in WRONG.items():
            done = krater("check", scene, *(x for v in values for x in ("--set", v)))
            check(done.returncode == 2 and said in done.text, f"refused: {name}", done.text[-300:])
    finish()


main()
