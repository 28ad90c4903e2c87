#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The limit of eight_mm.yaml at 0.56 mm as one finds it by hand: plain runs of the scene, ten m/s apart where it gets
narrow, and a straight line through v_r^2 over v^2 (Recht and Ipson with p = 2: v_r^2 = a^2 (v^2 - v_bl^2)). Shares nothing
with `krater study` but the program.

usage: KRATER=build/krater by_hand.py FOLDER
"""

import json
import os
import subprocess
import sys
import time

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
SETTINGS = ["grid.cell=0.56 mm", "time.end=3 ms", "time.stop_when={settled: projectile}", "time.energy_error=off",
            "grid.box={min: [0, -200 mm], max: [120 mm, 100 mm]}", "output={frames: 1 ms, history: 2 us}",
            "bodies.plate.shape.cylinder.radius=100 mm", "outcomes.shot={projectile: projectile, target: plate}"]
COARSE, FINE = range(160, 300, 40), 10  # [m/s]


def shot(folder, speed):
    """(perforated, residual speed) of a plain run."""
    place = os.path.join(folder, f"v{speed}")
    words = [os.environ.get("KRATER", "krater"), "run", os.path.join(HERE, "../../inputs/ccf_plugging.yaml"), "-j", "1",
             "--quiet", "-o", place, "--set", f"bodies.projectile.velocity={{towards: -z, speed: {speed} m/s}}"]
    for text in SETTINGS:
        words += ["--set", text]
    subprocess.run(words, check=True)
    with open(os.path.join(place, "summary.json"), encoding="utf-8") as file:
        told = json.load(file)["outcomes"]["shot"]
    print(f"{speed} m/s: {told['outcome']}, {told['residual_speed']:.1f} m/s, {os.times().children_user:.0f} s so far",
          flush=True)
    return told["outcome"] == "perforated", told["residual_speed"]


def main():
    start = time.monotonic()
    found = {speed: shot(sys.argv[1], speed) for speed in COARSE}
    low = max(v for v, (through, _) in found.items() if not through)
    for speed in range(low + FINE, low + 4 * FINE, FINE):
        found[speed] = shot(sys.argv[1], speed)
    through = sorted((v, r) for v, (perforated, r) in found.items() if perforated)
    v, r = np.array(through).T
    slope, offset = np.polyfit(v**2, r**2, 1)
    stopped = max(v for v, (perforated, _) in found.items() if not perforated and v < through[0][0])
    print(f"limit between {stopped} and {through[0][0]:.0f} m/s; line through {len(v)} points: "
          f"{np.sqrt(-offset / slope):.1f} m/s, a = {np.sqrt(slope):.3f}; {len(found)} runs, "
          f"{os.times().children_user:.0f} core-seconds, {time.monotonic() - start:.0f} s")


main()
