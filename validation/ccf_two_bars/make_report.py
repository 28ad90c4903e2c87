#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two square bars meet end on at 2000 m/s (CCF 4.1): 3D at three resolutions, single field, peers.

Writes README.md and pictures into its folder. `tools/validate ccf_two_bars` builds first.
"""

import os
import sys

import h5py
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_impacts import (COST_TITLES, Scale, costs, discussion, histories, outside,  # noqa: E402
                              shapes, value)
from validate_runs import Study  # noqa: E402

ESTIMATED_SECONDS = 450  # on two quiet cores

QUARTER = ["grid.box={min: [0, 0, -60 mm], max: [60 mm, 60 mm, 330 mm]}",
           "grid.boundary={x_min: symmetry, y_min: symmetry}"]
CELLS = {"4 cells across": (0.625e-3, [], 25), "5 cells across": (0.5e-3, [], 60),
         "10 cells across, a quarter": (0.25e-3, QUARTER, 150),
         "16 cells across, a quarter, to 20 µs": (0.15625e-3, [*QUARTER, "time.end=20 us"], 120)}


TIMES = (5e-6, 10e-6, 20e-6)


def head(run, time):
    """Width of the impact end along the sides of the bar and along its diagonals [m]: of the target's points within
    3 mm of its lower end, twice the largest distance that all but the outermost 1 % have in each direction (within 10
    degrees of it)."""
    with h5py.File(os.path.join(run.folder, "frames.h5"), "r") as file:
        names = sorted(file["frames"])
        name = min(names, key=lambda n: abs(float(file["frames"][n].attrs["time"]) - time))
        x = file["frames"][name]["target"]["coordinates"][()]
    near = x[x[:, 2] < x[:, 2].min() + 3e-3]
    radius, angle = np.hypot(near[:, 0], near[:, 1]), np.degrees(np.arctan2(near[:, 1], near[:, 0])) % 90
    sides = radius[np.minimum(angle, 90 - angle) < 10]
    diagonals = radius[np.abs(angle - 45) < 10]
    return tuple(2 * float(np.quantile(r, 0.99)) for r in (sides, diagonals))


def velocities(run):
    return run.measure("striker_velocity"), run.measure("target_velocity")


def row(name, run):
    if run is None:
        return [name, *["-"] * (4 + len(TIMES)), *costs(None)]
    striker, target = velocities(run)
    last = ["-"] * 4 if "to 20" in name else [f"{striker:.1f}", f"{target:.1f}", value(run, "striker_length", 1e3, 2),
                                              value(run, "target_length", 1e3, 2)]
    return [name, *last,
            *(" / ".join(f"{1e3 * w:.1f}" for w in head(run, time)) for time in TIMES), *costs(run)]


TITLES = ["run", "striker m/s", "target m/s", "striker mm", "target mm",
          *(f"head, sides / diagonals mm, {1e6 * time:.0f} µs" for time in TIMES), *COST_TITLES]


def heads(study, runs):
    runs = {name: run for name, run in runs.items() if run}
    times = (5e-6, 10e-6, 15e-6, 20e-6)
    figure, grid = plt.subplots(len(runs), len(times), squeeze=False, layout="constrained",
                                figsize=(3.6 * len(times), 3.8 * len(runs)))
    for line, (name, run) in zip(grid, runs.items()):
        with h5py.File(os.path.join(run.folder, "frames.h5"), "r") as file:
            frames = file["frames"]
            for axes, time in zip(line, times):
                frame = frames[min(frames, key=lambda n: abs(float(frames[n].attrs["time"]) - time))]
                x, strain = frame["target"]["coordinates"][()], frame["target"]["plastic_strain"][()].ravel()
                near = x[:, 2] < x[:, 2].min() + 3e-3
                x, strain = 1e3 * x[near, :2], strain[near]
                if "quarter" in name:
                    x = np.concatenate([x * s for s in ((1, 1), (-1, 1), (1, -1), (-1, -1))])
                    strain = np.tile(strain, 4)
                axes.scatter(x[:, 0], x[:, 1], c=strain, s=2, linewidths=0, cmap="viridis", vmin=0, vmax=4)
                axes.plot([-1.25, 1.25, 1.25, -1.25, -1.25], [-1.25, -1.25, 1.25, 1.25, -1.25], color="#d6006c", lw=1)
                axes.set_aspect("equal")
                axes.set_title(f"{name}, {1e6 * float(frame.attrs['time']):.0f} µs", fontsize=9)
        line[0].set_ylabel("y [mm]")
    for axes in grid[-1]:
        axes.set_xlabel("x [mm]")
    figure.suptitle("Points of the target's impact end, seen along the bar (red: the bar before)")
    figure.savefig(os.path.join(study.folder, "heads.png"), dpi=70)
    plt.close(figure)


def verdicts(study, runs):
    run = runs["5 cells across"]
    if not run:
        return
    striker, target = velocities(run)
    side, diagonal = head(run, TIMES[-1])
    memory = run.memory
    checks = [("survives to 0.13 ms without erosion", run.summary["audit"]["events"]["removed_points"] == 0, "0 points removed"),
              ("the bars part", target > striker, f"target {target:.0f} m/s, striker {striker:.0f} m/s"),
              ("impact ends are squares turned by 45 degrees", side > 1.3 * diagonal,
               f"at 20 µs {1e3 * side:.1f} mm along the bar's sides, {1e3 * diagonal:.1f} mm along its diagonals; a turned "
               "square would be 1.41 times as wide along the sides, a disc equal"),
              ("energy error below 1 %", abs(run.error) < 1, f"{run.error:.2f} %"),
              ("under 200 MB", memory is not None and memory < 200e6, f"{1e-6 * memory:.0f} MB" if memory else "not known")]
    study.add("At the paper's cell of 0.5 mm (40,100 points):")
    study.add_table(["demanded", "met", "found"], [[a, "yes" if b else "**no**", c] for a, b, c in checks])
    ends = [f"{name.split(',')[0]}: {', '.join(f'{side / diagonal:.2f}' for side, diagonal in (head(r, t) for t in TIMES))}"
            for name, r in runs.items() if r]
    study.add(f"Width along the sides over width along the diagonals at {', '.join(f'{1e6 * t:.0f}' for t in TIMES)} µs "
              f"(a disc 1, a turned square 1.41): {'; '.join(ends)}.")


def main():
    study = Study(__file__, "inputs/ccf_two_bars.yaml", ESTIMATED_SECONDS, __doc__)
    single = study.run("single_field", ["grid.cell=0.625e-3"], 25, study.cores, without=["contact: {friction: 0}"])
    runs = {name: study.run("cells_" + name.split()[0], [f"grid.cell={cell!r}", *more], seconds, study.cores)
            for name, (cell, more, seconds) in CELLS.items()}

    study.add("Two bars of 2.5 x 2.5 x 50 mm meet end on, 2000 m/s on rest: [inputs/ccf_two_bars.yaml]"
              "(../../inputs/ccf_two_bars.yaml), Zhou, Sha, Tamma, Miller, AIAA-2006-1758, section 4.1, to 0.13 ms. The paper "
              "gives pictures, no measures.", "## Results at 0.13 ms")
    study.add_table(TITLES, [row(name, run) for name, run in runs.items()])
    study.add("A quarter has a quarter of the points; its measures are those of the whole bars.")
    verdicts(study, runs)
    study.add("![heads](heads.png)", "![shapes](shapes.png)", "![outside](outside.png)", "![velocities](velocities.png)",
              "## Contact off",
              "Without `contact:` the bars share one velocity field: they weld where they meet.")
    study.add_table(TITLES, [row("contact, 4 cells", runs["4 cells across"]), row("single field, 4 cells", single)])
    if single and runs["4 cells across"]:
        study.add("What contact costs per point-step is in [contact](../contact/README.md).", "![single field](single_field.png)")
    study.add("## Other codes", "On this case (figures collected for this project, not checked here) one open MPM code stops at "
              "39 µs, another gains 2.4 % energy, a third takes 13.4 GB.")
    discussion(study)

    def strain(run):
        return Scale(run, "plastic_strain", 4.0)

    box = [-20, 20, -45, 60]
    shapes(study, runs, (5e-6, 10e-6, 20e-6, 40e-6), "shapes.png", strain, box, "Plastic strain, section y = 0")
    outside(study, {"5 cells": runs["5 cells across"]}, 20e-6, "outside.png", strain)
    shapes(study, {"contact": runs["4 cells across"], "single field": single}, (10e-6, 20e-6, 40e-6), "single_field.png",
           strain, box)
    heads(study, runs)
    histories(study, runs, {"striker_velocity": "striker", "target_velocity": "target"}, "velocities.png", "velocity [m/s]",
              1.0, [(1000, "centre of mass")])
    study.write("Two bars at 2000 m/s (CCF 4.1)")


if __name__ == "__main__":
    main()
