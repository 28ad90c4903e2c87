#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The quick runs of validation/hard/cases hold what their scenes say, three scenes of inputs/ are the same whoever looks, and
what is expected is judged: a scene that asks for more than there is fails."""

import os
import pathlib
import subprocess
import sys

from scene_support import KRATER, ROOT, Folder, check, environment, finish, krater

SCENE = """
frame: plane_strain
grid: {cell: 1, box: {min: [0, 0], max: [16, 16]}}
time: {end: 1e-4}
materials: {m: {density: 1000, youngs_modulus: 1.0e9, poisson_ratio: 0.3, eos: linear, strength: elastic}}
bodies: {a: {material: m, shape: {box: {min: [4, -1, 4], max: [9, 1, 9]}}, velocity: [100, 0]}}
output: {frames: 0, history: 0}
expect:
  mass: 1.0e-14
  density: [0.99, 1.01]
  step_fall: 2
  speed: {of: "a_mean_velocity_x[-1]", within: [99.99, 100.01]}
"""


def judged(text):
    """Names of what is missed."""
    sys.path.insert(0, str(ROOT / "tools"))
    import hard_cases
    pathlib.Path("case.yaml").write_text(text, encoding="utf-8")
    case = hard_cases.Case.read(pathlib.Path("case.yaml"))
    return [one.name for one in hard_cases.run_case(KRATER, case, "", pathlib.Path("case_out")).surprises()]


def judges():
    check(judged(SCENE) == [], "a scene that holds what it says")
    for word, other, name in (("density: [0.99, 1.01]", "density: [1.1, 2]", "density"), ("[99.99, 100.01]", "[0, 99]", "speed"),
                              ("a_mean_velocity_x[-1]", "no_such_column", "speed"), ("expect:", "expect:\n  exit: 3", "exit"),
                              ("time: {end: 1e-4}", "time: {end: 1e-4, cfl: 2}", "exit")):
        found = judged(SCENE.replace(word, other))
        check(found == [name], f"{other}: missed", found)
    check(judged(SCENE.replace("density: [0.99, 1.01]", "density: [1.1, 2]") + "  misses: {density: known}\n") == [],
          "what is known to be missed is no surprise")
    done = krater("check", "case.yaml", "--set", "expect=fast")
    check(done.returncode == 2 and "expect: expected a block" in done.stderr, "expect that is no block", done.stderr)


def tool(name, *arguments):
    done = subprocess.run([sys.executable, str(ROOT / "tools" / name), *arguments, "-j", "1"], text=True, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment({"KRATER": os.path.abspath(KRATER)}))
    check(done.returncode == 0, f"{name} {' '.join(arguments)}",
          done.stdout[-1500:] if done.returncode else done.stdout.splitlines()[-1])


with Folder():
    judges()
    tool("hard_cases.py", "--quick")
    tool("hard_invariance.py", "two_discs", "ccf_plugging", "bar_pulled_apart")
finish()
