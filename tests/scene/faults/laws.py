# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials that part and that crush."""

import pathlib

import numpy as np

from faults_support import fault, scene
from scene_support import check, history, krater, summary


# What lies between has failed in a layer (src/README.md: both release fans pass it at once); its rubble is no piece.
@fault("04-pieces", "the spalled target is two pieces and no rubble")
def spall_pieces():
    krater("run", scene("04"), "-o", "out", "-j", 2, "--quiet", timeout=300)
    rows = history("out")
    check(rows["pieces"][-1] == 2, "04: pieces at the end", rows["pieces"][-1])


@fault("04", "a spalled lid is free: it flies on, in a piece of its own")
def spall():
    done = krater("run", scene("04"), "-o", "out", "-j", 2, "--quiet", timeout=300)
    check(done.returncode == 0, "04: exit code", done.returncode)
    rows = history("out")
    time, top = rows["time"], rows["top"]
    at = lambda t: np.interp(t, time, top)
    speed = (at(3e-6) - at(1.5e-6)) / 1.5e-6
    check(speed >= 266, "04: mean speed of the free surface after spall", f"{speed:.1f} m/s, at least 266")
    velocity = np.gradient(top, time)
    ringing = velocity[time > 1.6e-6]
    check(ringing.min() > 255 and ringing.max() < 411, "04: it rings between 266 and 400 m/s",
          f"{ringing.min():.0f} to {ringing.max():.0f}")
    large = [one for one in summary("out")["fragments"]["pieces"]["pieces"] if one["points"] > 100]
    check(len(large) == 2, "04: two large pieces", [one["points"] for one in large])
    speeds = sorted(one["velocity"]["z"] for one in large)
    check(speeds[1] - speeds[0] > 300, "04: they part", speeds)


@fault("spall-keys", "spall: short and long form are one; what cannot be is refused by name")
def spall_keys():
    text = scene("04").read_text(encoding="utf-8")
    short = "spall_strength: 1 GPa"

    def check_scene(name, words, code=0, said=()):
        pathlib.Path(name).write_text(text.replace(short, words), encoding="utf-8")
        done = krater("check", name)
        check(done.returncode == code and all(word in done.text for word in said), f"spall: {words}",
              f"exit {done.returncode} {done.stderr.strip().splitlines()[:1]}")

    check_scene("a.yaml", short)
    check_scene("b.yaml", "spall: {strength: 1 GPa, action: fail}")
    check_scene("c.yaml", "spall: 1 GPa")
    check_scene("d.yaml", "spall: {strength: 1 GPa, action: limit}")
    check_scene("e.yaml", f"{short}\n    failure: {{action: remove}}")
    check_scene("f.yaml", f"{short}\n    spall: {{action: limit}}", 2, ["spall", "keep one"])
    check_scene("g.yaml", "spall: {strength: 1 GPa, action: part}", 2, ["action", "fail"])
    check_scene("h.yaml", "spall: {action: fail}", 2, ["strength"])
    check_scene("i.yaml", "spall: {strength: 1 GPa, action: limit}\n    failure: {action: remove}", 2, ["spall that fails"])
    bad = text.replace("{mie_gruneisen_shock: {c0: 5328 m/s, S1: 1.338, gamma0: 2.0}}",
                       "{p_alpha: {solid_density: 2700, c0: 5328 m/s, S1: 1.338, gamma0: 2.0, "
                       "elastic_pressure: 1 MPa, compaction_pressure: 600 MPa}}")
    assert bad != text
    pathlib.Path("p.yaml").write_text(bad, encoding="utf-8")
    done = krater("check", "p.yaml")
    check(done.returncode == 2 and "denser than its solid" in done.stderr and "p.yaml:" in done.stderr,
          "p_alpha denser than its solid", done.stderr.strip().splitlines()[:1])
    limited = text.replace(short, "spall: {strength: 1 GPa, action: limit}")
    pathlib.Path("limit.yaml").write_text(limited, encoding="utf-8")
    krater("run", "limit.yaml", "-o", "limit", "--quiet", "--set", "time.end=2 us", timeout=120)
    rows = history("limit")
    check(summary("limit")["status"] == "done" and rows["pieces"][-1] == 1, "a limit of tension parts nothing")


FLUID = """
frame: 3d
grid: {cell: 1 mm, box: {min: [-20 mm, -20 mm, -20 mm], max: [20 mm, 20 mm, 20 mm]}}
time: {end: 1 us}
materials: {m: {density: 1000, eos: {linear: {K: 2 GPa}}}}
bodies: {a: {material: m, shape: {box: {min: [-4 mm, -4 mm, -4 mm], max: [4 mm, 4 mm, 4 mm]}}, kinematics: {KINEMATICS}}}
contact: {friction: 0}
output: {frames: 0, history: 0}
"""


@fault("fluid-elements", "elements and particles of a fluid at rest in 3d stay at rest: a stress that is not there is zero")
def fluid_of_elements():
    """A random scene: six components were read from an array of one, and elements at rest flew to 1e228 m in a step."""
    for kinematics in ("lagrangian_mesh: {element: 1 mm}", "sph: {}"):
        pathlib.Path("fluid.yaml").write_text(FLUID.replace("KINEMATICS", kinematics), encoding="utf-8")
        done = krater("run", "fluid.yaml", "-o", "out", "-j", 1, "--quiet")
        check(done.returncode == 0, f"{kinematics}: exit code", done.text)
        rows = history("out")
        check(np.max(np.abs(rows["kinetic_energy"])) < 1e-20, f"{kinematics}: at rest", np.max(rows["kinetic_energy"]))
