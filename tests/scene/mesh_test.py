#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of elements as a user gets them: answers, energy, threads, instruction sets, restart, what is refused."""

import os
import pathlib

from scene_support import Folder, check, differences, finish, krater, run, summary

BAR = """
frame: axisymmetric
grid: {cell: 0.8 mm, box: {min: [0, 0], max: [12 mm, 35.2 mm]}, boundary: {z_min: symmetry, r_min: axis}}
time: {end: 80 us}
output: {frames: 40 us}
materials:
  copper: {density: 8930, youngs_modulus: 117 GPa, poisson_ratio: 0.35, eos: linear,
           strength: {von_mises: {Y: 400 MPa, H: 100 MPa}}}
bodies:
  bar: {material: copper, shape: {cylinder: {radius: 3.2 mm, height: 32.4 mm}}, velocity: [0, -227 m/s],
        kinematics: {lagrangian_mesh: {element: 0.8 mm}}}
measures:
  length: {kind: extent, body: bar, axis: z}
  foot: {kind: max, body: bar, axis: x}
  foot_diameter: {kind: diameter, body: bar, at: {from_lower_end: 0}}
  widest: {kind: largest_diameter, body: bar}
"""

TAYLOR = """
frame: axisymmetric
grid: {cell: 0.2 mm, box: {min: [0, 0], max: [12 mm, 26 mm]}, boundary: {z_min: {wall: {friction: 0.1}}, r_min: axis}}
time: {end: 6 us}
output: {frames: 2 us}
materials: {copper: {card: ofhc_copper, viscosity: {}}}
bodies:
  rod: {material: copper, shape: {cylinder: {radius: 3.81 mm, height: 25.4 mm}}, velocity: [0, -190 m/s],
        kinematics: lagrangian_mesh}
measures: {length: {kind: extent, body: rod, axis: z}}
"""

REFUSED = {
    "a shape that is no block": ("bodies.bar.shape={sphere: {radius: 3 mm, center: [0, 0, 8 mm]}}", "kinematics: mpm"),
    "points": ("bodies.bar.points={per_direction: 3}", "has elements, no points"),
    "a rigid body": ("bodies.bar.rigid=free", "cannot be rigid"),
    "a fixed reference": ("method.reference=initial", "current configuration only"),
    "a side that drives": ("grid.boundary.z_max={velocity: [0, -1 m/s]}", "no side that drives"),
    "a load": ("damping={mass: 1e3 1/s}", "neither body_force, damping nor loads"),
    "an unknown kinematics": ("bodies.bar.kinematics=sph", "lagrangian_mesh"),
    "an unknown hourglass": ("bodies.bar.kinematics={lagrangian_mesh: {hourglass: stiff}}", "assumed_strain"),
    "no length": ("bodies.bar.kinematics={lagrangian_mesh: {element: 0}}", "element"),
}


def answers(scene):
    checked = krater("check", scene)
    check(checked.returncode == 0 and "4 elements of 0.0008 m along r" in checked.text, "check tells of the elements",
          checked.text[-400:])
    for hourglass in ("assumed_strain", "{viscous: 0.1}"):
        done = run("bar", f"bodies.bar.kinematics.lagrangian_mesh.hourglass={hourglass}", scene=scene)
        if not check(done.returncode == 0, f"the bar runs, {hourglass}", done.text[-300:]):
            continue
        s = summary("bar")
        m = {name: value["value"] for name, value in s["measures"].items()}
        # The continuum's 7.22 and 21.43 mm; four elements across are 3 % off in the foot.
        check(abs(m["foot"] - 7.22e-3) < 0.05 * 7.22e-3 and abs(m["length"] - 21.43e-3) < 0.01 * 21.43e-3,
              f"foot and length, {hourglass}", m)
        check(abs(m["widest"] - 2 * m["foot"]) < 1e-12, "the widest section is that of the largest radius", m)
        start = s["audit"]["initial_energy"]
        check(abs(s["audit"]["energy_residual"]) < 1e-11 * start, "energy closes", s["audit"]["energy_residual"] / start)
        check(0 < s["audit"]["hourglass_energy"] < 0.1 * s["audit"]["internal_energy"], "the hourglass holds a little",
              s["audit"]["hourglass_energy"] / s["audit"]["internal_energy"])
        check(s["audit"]["energy_error_fraction"] < 0.01, "and what the law cannot give back is below 1 %",
              s["audit"]["energy_error_fraction"])


def strains(scene):
    """A gauge's strain of an element is that of its own deformation: a column that only a gauge asks for."""
    gauge = "gauges={foot: {body: rod, at: [1 mm, 2 mm], fields: [strain_zz], every: 1 us}}"
    done = run("gauge", gauge, scene=scene)
    rows = pathlib.Path("gauge/gauge_foot.csv").read_text(encoding="utf-8").splitlines() if done.returncode == 0 else ["nan"]
    check(done.returncode == 0 and float(rows[-1].split(",")[-1]) < -0.05, "a gauge records an element's strain",
          done.text[-300:] + rows[-1])


def same_bits(scene):
    for threads in (1, 2, 3):
        done = run(f"rod{threads}", scene=scene, threads=threads)
        check(done.returncode == 0, f"the rod on {threads} threads", done.text[-300:])
    for threads in (2, 3):
        found = differences("rod1", f"rod{threads}")
        check(not found, f"the same bits on 1 and {threads} threads", found)
    run("parts", "time.end=4 us", scene=scene)
    done = run("parts", scene=scene, extra=["--restart", "parts/checkpoint.h5"])
    found = [d for d in differences("rod1", "parts") if "summary" not in d]
    check(done.returncode == 0 and not found, "the same bits across a restart", found or done.text[-300:])
    other = run("parts", "bodies.rod.kinematics={lagrangian_mesh: {element: 0.4 mm}}", scene=scene,
                extra=["--restart", "parts/checkpoint.h5"])
    check(other.returncode == 2 and "mesh" in other.text, "a restart refuses another mesh", other.text)
    os.environ["KRATER_ISA"] = "portable"
    run("portable", "time.end=1 us", scene=scene)
    del os.environ["KRATER_ISA"]
    run("best", "time.end=1 us", scene=scene)
    found = differences("best", "portable")
    check(not found, "the same bits of every instruction set", found)


def main():
    with Folder() as folder:
        bar, rod = pathlib.Path(folder, "bar.yaml"), pathlib.Path(folder, "rod.yaml")
        bar.write_text(BAR, encoding="utf-8")
        rod.write_text(TAYLOR, encoding="utf-8")
        answers(bar)
        strains(rod)
        same_bits(rod)
        for what, (value, word) in REFUSED.items():
            done = run("refused", value, scene=bar)
            check(done.returncode == 2 and word in done.text, f"refused: {what}", done.text[-300:])
        done = run("refused", "materials.copper.spall={strength: 1 GPa, action: fail}",
                   "materials.copper.failure={action: remove}", scene=bar)
        check(done.returncode == 2 and "keeps its failed elements" in done.text, "refused: elements that failure removes",
              done.text[-300:])
        two = BAR.replace("measures:", "  other: {material: copper, shape: {cylinder: {radius: 1 mm, height: 1 mm, base: "
                                       "[0, 33 mm]}}}\nmeasures:").replace("max: [12 mm, 35.2 mm]", "max: [12 mm, 40 mm]")
        bar.write_text(two, encoding="utf-8")
        done = run("refused", scene=bar)
        check(done.returncode == 2 and "does not meet bodies of points yet" in done.text and "bar.yaml:" in done.text,
              "refused: elements and points in one scene", done.text)
    finish()


if __name__ == "__main__":
    main()
