#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Contact against closed forms (figures of tests/verification/contact_test.cpp), its cost, and a restart.

Writes README.md and pictures into its folder. `tools/validate contact` builds first; needs krater_tests beside krater
(`tools/build --target krater_tests`).
"""

import os
import re
import subprocess
import sys

import h5py
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_impacts import discussion, nanoseconds  # noqa: E402
from validate_runs import ROOT, Study  # noqa: E402

ESTIMATED_SECONDS = 120  # on two quiet cores

NUMBER = r"(-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)"
APART = ["bodies.striker.shape={box: {min: [-1.25 mm, -1.25 mm, -90 mm], max: [1.25 mm, 1.25 mm, -40 mm]}}",
         "grid.box={min: [-20 mm, -20 mm, -110 mm], max: [20 mm, 20 mm, 80 mm]}", "time.end=8 us"]
TOUCHING = ["time.end=8 us"]
FINE = ["output={frames: 8 us, history: 1 us}"]
REPEATS = 3


def messages(study):
    """What the verification tests print, in order; None if they could not run."""
    tests = os.environ.get("KRATER_TESTS") or os.path.join(ROOT, "build", "krater_tests")
    if not os.path.exists(tests):
        study.failed.append(("contact_test", 2, f"no {tests}: run tools/build --target krater_tests"))
        return None
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "KRATER_SOURCE_DIR": ROOT,
                   "KRATER_BUILD_DIR": os.path.dirname(tests)}
    done = subprocess.run([tests, "-sf=*verification/contact_test*", "--no-colors"], capture_output=True, text=True,
                          env=environment, check=False)
    if done.returncode:
        study.failed.append(("contact_test", done.returncode, "its tests fail"))
    return re.findall(r"MESSAGE: (.*)", done.stdout)


def found(lines, pattern):
    """Numbers of all messages that match a pattern with '#' for a number."""
    expression = re.escape(pattern).replace(r"\#", NUMBER)
    matches = (re.search(expression, line) for line in lines)
    return [[float(x) for x in match.groups()] for match in matches if match]


def verification(study, lines):
    bars = found(lines, "joint # of 1/#: target # m/s, striker # m/s; contact work / E0 #, energy error #")
    gaps = found(lines, "joint at # h: first contact at a gap of # h, least gap # h")
    [impulse], [release] = found(lines, "impulse # of the exact"), found(lines, "striker after release # m/s, exact #")
    [slide] = found(lines, "velocity lost / (mu g t): #, #; friction work / exact #, #")
    [three] = found(lines, "velocities #, #, #")
    [foam] = found(lines, "steel # m/s, exact #")
    hertz = found(lines, "# cells per radius: peak force #, duration # of Hertz'")
    coarse, fine = [b for b in bars if b[1] == 50], [b for b in bars if b[1] == 100]
    rows = [["equal bars, 50 cells/m: the struck bar takes", f"{min(b[2] for b in coarse):.4f}-{max(b[2] for b in coarse):.4f}", "1"],
            ["the same, 100 cells/m", f"{fine[0][2]:.4f}", "1"],
            ["lost by contact, share of the energy, 50 and 100 cells/m", f"{coarse[-1][4]:.4f}, {fine[0][4]:.4f}", "0"],
            ["unequal bars: transmitted impulse", f"{impulse[0]:.4f}", "1"],
            ["striker after the release (m/s)", f"{release[0]:.4f}", f"{release[1]:.4f}"],
            ["block on a base, mu = 0.2: velocity lost, h and h/2", f"{slide[0]:.4f}, {slide[1]:.4f}", "1"],
            ["friction work, h and h/2", f"{slide[2]:.4f}, {slide[3]:.4f}", "1"],
            ["steel into foam, stiffness 1000:1, velocity (m/s)", f"{foam[0]:.4f}", f"{foam[1]:.4f}"],
            *([f"Hertz, {h[0]:.0f} cells per radius: peak force", f"{h[1]:.4f}", "1"] for h in hertz),
            *([f"Hertz, {h[0]:.0f} cells per radius: duration", f"{h[2]:.4f}", "1"] for h in hertz),
            ["gap at first contact (cells), 8 places of the joint", f"{min(g[1] for g in gaps):.3f}-{max(g[1] for g in gaps):.3f}",
             "0 (demanded < 0.25)"],
            ["three plates in the cells of one: velocities (m/s)", ", ".join(f"{v:.2f}" for v in three), "increasing"]]
    for line in lines:
        grazing = re.search(rf"(\w+): lower plate {NUMBER} m/s along, {NUMBER} m/s across", line)
        if grazing:
            rows.append([f"oblique plates 1e-3 cell apart at 1000 m/s, {grazing[1].replace('_', ' ')}: lower plate moves (m/s)",
                         f"{grazing[2]} along, {grazing[3]} across", "0"])
    study.add_table(["case", "found", "exact"], rows)
    [drift] = found(lines, "drift by transfer #")
    study.add("Momentum, linear and along every axis that no wall holds, is kept to 1e-12 of its size in each of these, as the "
              "tests demand. Bodies apart have the same bits as without `contact:`.",
              "Angular momentum: contact itself changes neither it nor the linear one by more than 1e-13 of its size (two discs that meet "
              "off centre with friction, summed over the nodes before and after the impulses). The way of the points to the nodes and "
              f"back drifts, with contact or without ({drift[0]:.1e} of it by the middle of this collision; "
              "[spin_and_discs](../spin_and_discs/README.md)).")
    return gaps


def picture(study, gaps):
    figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
    axes.bar([g[0] for g in gaps], [g[1] for g in gaps], 0.05, label="first contact")
    axes.bar([g[0] + 0.05 for g in gaps], [g[2] for g in gaps], 0.05, label="least gap")
    axes.axhline(0.25, color="#d6006c", ls="--", label="demanded at first contact")
    axes.set_xlabel("place of the joint in its cell")
    axes.set_ylabel("gap between the surfaces [cells]")
    axes.legend(frameon=False, fontsize=9)
    figure.savefig(os.path.join(study.folder, "gap.png"), dpi=110)
    plt.close(figure)


def cost(study):
    """ns per point-step, least of several runs that alternate."""
    rows = []
    for words, settings, limit in (("bars 40 mm apart", APART, 1.02), ("bars that meet", TOUCHING, 1.3)):
        times = {True: [], False: []}
        for k in range(REPEATS):
            for on in (True, False):
                run = study.run(f"{words.replace(' ', '_')}_{'on' if on else 'off'}_{k}", [*FINE, *settings], 8, 1,
                                without=() if on else ["contact: {friction: 0}"])
                if run:
                    times[on].append(nanoseconds(run))
        if times[True] and times[False]:
            a, b = min(times[True]), min(times[False])
            rows.append([words, f"{a:.1f}", f"{b:.1f}", f"{a / b:.3f}", f"<= {limit}", "met" if a / b <= limit else "**missed**",
                         " ".join(f"{x / y:.2f}" for x, y in zip(times[True], times[False]))])
    study.add_table(["scene", "with contact ns", "single field ns", "ratio", "demanded", "", "ratios of the pairs of runs"], rows)


def restart(study):
    """Whole run against one that is continued from a checkpoint in the middle."""
    common = ["grid.cell=0.625 mm", "output={frames: 5 us, history: 1 us, checkpoint: 0 s}"]
    whole = study.run("restart_whole", [*common, "time.end=10 us"], 3, 1)
    half = study.run("restart_half", [*common, "time.end=5 us"], 2, 1)
    if not whole or not half:
        return
    folder = os.path.join(study.folder, "runs_out", "restart_continued")
    command = [study.krater, "run", study.scene, "-o", folder, "-j", "2", "--quiet", "--restart",
               os.path.join(half.folder, "checkpoint.h5")]
    for setting in [*common, "time.end=10 us"]:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        study.failed.append(("restart_continued", done.returncode, (done.stderr.strip().splitlines() or [""])[-1]))
        return
    same, compared = True, 0
    files = [h5py.File(os.path.join(f, "frames.h5"), "r")["frames"] for f in (whole.folder, folder)]
    last = [file[sorted(file)[-1]] for file in files]
    for body in last[0]:
        for field in last[0][body]:
            a, b = last[0][body][field][()], last[1][body][field][()]
            same, compared = same and a.tobytes() == b.tobytes(), compared + 1
    study.add(f"Two bars to 10 µs on one thread, and continued from 5 µs on two: the {compared} fields of the last frame are "
              f"{'the same, bit for bit' if same else '**not the same**'}.")


def main():
    study = Study(__file__, "inputs/ccf_two_bars.yaml", ESTIMATED_SECONDS, __doc__)
    study.add("## Closed forms",
              "Printed by the tests (`build/krater_tests -sf='*verification/contact_test*'`), which say how each case is made and "
              "fail beyond their tolerances.")
    lines = messages(study)
    if lines:
        picture(study, verification(study, lines))
        study.add("![gap](gap.png)")
    study.add("## Cost",
              "[inputs/ccf_two_bars.yaml](../../inputs/ccf_two_bars.yaml) with 40,100 points in 3D for 8 µs, one thread: the sum of "
              "all stages per point-step, with `contact:` and without (one velocity field), the least of the runs, which "
              "alternate. Scenes of shocks and penetration: the reports of the impact scenes.")
    cost(study)
    study.add("## Restart in the middle of contact")
    restart(study)
    discussion(study)
    study.write("Contact")


if __name__ == "__main__":
    main()
