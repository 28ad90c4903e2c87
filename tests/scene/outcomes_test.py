#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What became of a projectile, and a run that ends when its answer is there."""

import pathlib

from scene_support import Folder, check, differences, finish, krater, results_errors, run, summary

SHOT = """
frame: axisymmetric
grid:
  cell: 0.5 mm
  box: {min: [0, -14 mm], max: [12 mm, 8 mm]}
  boundary: {r_min: axis}
time: {end: 60 us, stop_when: {settled: rod}}
materials:
  steel: {density: 7850, shear_modulus: 80 GPa, strength: {von_mises: {Y: 1.5 GPa, H: 100 MPa}},
          eos: {mie_gruneisen_shock: {c0: 4569 m/s, S1: 1.49, gamma0: 2.17}}}
  soft: {density: 2700, shear_modulus: 26 GPa, strength: {von_mises: {Y: 200 MPa, H: 100 MPa}},
         eos: {mie_gruneisen_shock: {c0: 5240 m/s, S1: 1.4, gamma0: 2}}, damage: none, failure: none}
bodies:
  rod:
    material: steel
    shape: {cylinder: {radius: 2 mm, height: 5 mm, base: [0, 0.3 mm]}}
    velocity: {speed: 600 m/s, towards: -z}
  plate: {material: soft, shape: {cylinder: {radius: 10 mm, height: 2 mm, base: [0, -2 mm]}}}
outcomes: {shot: {projectile: rod, target: plate}}
"""
FAILS = "damage: {maximum_plastic_strain: {eps_max: 0.8}}, failure: {action: remove}"
THIN = SHOT.replace("damage: none, failure: none", FAILS) + "contact: {friction: 0}\n"
THICK = ["bodies.plate.shape={cylinder: {radius: 10 mm, height: 12 mm, base: [0, -12 mm]}}", "bodies.rod.velocity.speed=300"]
OBLIQUE = ["frame=plane_strain", "grid.box={min: [-40 mm, -14 mm], max: [40 mm, 16 mm]}", "grid.boundary={r_min: open}",
           "bodies.rod.shape={sphere: {radius: 2 mm, center: [-10 mm, 2.3 mm]}}",
           "bodies.plate.shape={box: {min: [-25 mm, -2 mm, -6 mm], max: [25 mm, 2 mm, 0]}}"]


def at_angle(angle):
    return [*OBLIQUE, f"bodies.rod.velocity={{speed: 500 m/s, angle: {angle} degree}}"]


def outcome(folder):
    return summary(folder)["outcomes"]["shot"]


def fates(thin, stick):
    for name, scene, values, word in (("through", thin, [], "perforated"), ("off", thin, at_angle(75), "ricocheted"),
                                      ("in", stick, THICK, "stopped")):
        done = run(name, *values, scene=scene)
        found = outcome(name) if done.returncode == 0 else {"outcome": done.text}
        check(found["outcome"] == word and found["settled"], f"{name} is told as {word}", found)
        check("stopped at" in done.text and summary(name).get("stopped", {}).get("when") == "rod has settled",
              f"{name} ends when the answer is there, and says so", done.text)
        check(results_errors(name) == "", f"{name} leaves whole results", results_errors(name))
    found = outcome("through")
    check(300 < found["residual_speed"] < 600 and found["residual_velocity"]["z"] < 0 and found["mass_through"] == 1,
          "what went through has lost speed and kept its way", found)
    check(found["drift"] < 0.01 * (600 - found["residual_speed"]), "its velocity no longer drifts", found)
    run("later", "time.stop_when={energy: 0}", "time.end=25 us", scene=thin)
    change = abs(outcome("later")["residual_speed"] - found["residual_speed"])
    check(change < 0.01 * (600 - found["residual_speed"]), "the run that went on says the same velocity", change)
    off = outcome("off")
    check(off["residual_velocity"]["z"] > 0 and off["residual_velocity"]["x"] > 300 and off["mass_before"] > 0.9,
          "a ricochet leaves upwards and onwards", off)
    check(outcome("in")["relative_speed"] < 0.2 * 300, "what was stopped goes with the target", outcome("in"))


def misses(thin):
    """It flies past the plate, whose velocity it never had; and at the start it only moves."""
    values = [*OBLIQUE, "bodies.rod.velocity={speed: 500 m/s, angle: 0}", "time={end: 40 us, stop_when: {energy: 0}}",
              "bodies.rod.shape={sphere: {radius: 2 mm, center: [30 mm, 2.3 mm]}}"]
    run("past", *values, scene=thin)
    check(outcome("past")["outcome"] == "missed" and not outcome("past")["settled"], "a miss is told", outcome("past"))
    run("early", "time.end=1 us", scene=thin)
    found = outcome("early")
    check(found["outcome"] == "moving" and not found["settled"] and "stopped" not in summary("early"),
          "one that still moves is no answer", found)


def stops(thin):
    run("through_only", "time.stop_when={perforated: {projectile: rod, target: plate}}", scene=thin)
    check(outcome("through_only")["outcome"] == "perforated" and summary("through_only")["time"] < 59e-6,
          "the run ends when the plate is perforated", summary("through_only")["time"])
    run("energy", "time.stop_when={energy: 80 %}", scene=thin)
    s = summary("energy")
    check(s["audit"]["kinetic_energy"] < 0.8 * s["audit"]["initial_energy"] and s["time"] < 20e-6, "by energy", s["time"])
    run("words", "time.stop_when=rod.mean_velocity_z > -550 && time > 1e-6", scene=thin)
    s = summary("words")
    check(s["time"] < 10e-6 and s["outcomes"]["shot"]["residual_velocity"]["z"] > -551, "by an expression", s["time"])


def restarts(thin):
    """The looks are kept: a run in two parts ends in the same step with the same words, on any threads."""
    run("whole", scene=thin)
    run("parts", "time.end=9 us", "output.frames=0", scene=thin)
    again = run("parts", scene=thin, extra=["--restart", "parts/checkpoint.h5"], threads=2)
    run("both", "time.end=9 us", scene=thin)
    check(again.returncode == 0 and summary("parts")["steps"] > summary("both")["steps"], "it goes on", again.text)
    a, b = summary("whole"), summary("parts")
    # The first part ended at 9 us, and its step there was cut.
    check(abs(a["time"] - b["time"]) < 0.35e-6 and b["outcomes"]["shot"]["outcome"] == "perforated" and
          abs(a["outcomes"]["shot"]["settled_time"] - b["outcomes"]["shot"]["settled_time"]) < 0.35e-6,
          "a run in two parts finds the same", (a["time"], b["time"]))
    done = run("parts", scene=thin, extra=["--restart", "parts/checkpoint.h5"])
    check(summary("parts")["steps"] == b["steps"], "one that has its answer takes no step more", done.text)
    run("threads", scene=thin, threads=2)
    check(not differences("whole", "threads"), "the same bits on two threads", differences("whole", "threads"))


def errors(thin):
    for values, part in ((["outcomes.shot.target=rod"], "own target"), (["outcomes.shot.projectile=rot"], "did you mean rod"),
                         (["time.stop_when={settled: rot}"], "did you mean rod"), (["time.stop_when=foo < 3"], "unknown variable 'foo'"),
                         (["time.stop_when={speed: 3}"], "known: settled"), (["time.stop_when={energy: 3}"], "between 0 and 1"),
                         (["time.stop_when=rod.kinetic_energy = 3"], "cannot assign"),
                         (["bodies.rod.velocity=[0, 0]"], "same velocity at the start")):
        done = run("bad", *values, scene=thin)
        check(done.returncode == 2 and part in done.text, f"{values[0]} is refused", done.text)


def main():
    with Folder() as folder:
        thin, stick = pathlib.Path(folder, "thin.yaml"), pathlib.Path(folder, "stick.yaml")
        thin.write_text(THIN, encoding="utf-8")
        stick.write_text(SHOT.replace(", damage: none, failure: none", ""), encoding="utf-8")
        check(krater("check", thin).returncode == 0, "the scene passes its check")
        fates(thin, stick)
        misses(thin)
        stops(thin)
        restarts(thin)
        errors(thin)
    finish()


main()
