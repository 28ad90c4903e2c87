#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reference configurations: the Taylor impact on the current, initial and adaptive reference.

Writes README.md and pictures into its folder. `tools/validate reference_configuration` builds first.
"""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_runs import Study, outline, widest  # noqa: E402

ESTIMATED_SECONDS = 150  # on two quiet cores

H = 0.381e-3
NAMES = ("final_length", "foot_contact_diameter", "w_diameter")
REFERENCES = {"current": "current", "initial": "initial", "adaptive, 0.3": "adaptive",
              "adaptive, 0.1": "{adaptive: {strain: 0.1}}", "adaptive, 1": "{adaptive: {strain: 1}}"}
SPEEDS = (190, 300, 400)
CELLS = {"h": H, "h/2": H / 2}


def settings(reference, speed, cell):
    return [f"method.reference={REFERENCES[reference]}", f"bodies.rod.velocity=[0, {-speed} m/s]",
            f"grid.cell={cell!r}", "grid.box={min: [0, 0], max: [24 mm, 27 mm]}", "time.end=60 us"]


def row(name, run):
    if not run:
        return [name, "failed", *["-"] * 7]
    seconds = sum(run.summary["machine"]["seconds"].values())
    points = run.summary["points"] * run.summary["steps"]
    return [name, run.summary["steps"], *(f"{1e3 * run.measure(n):.3f}" for n in NAMES), f"{widest(run):.3f}",
            f"{run.error:.2f}", run.summary['audit']['events']['new_references'], f"{seconds:.1f} ({1e9 * seconds / points:.0f})"]


def picture(study, runs):
    figure, axes = plt.subplots(1, len(SPEEDS), figsize=(13, 4.8), layout="constrained")
    colours = {"current": "black", "initial": "#d62728", "adaptive, 0.3": "#1f77b4"}
    for plot, speed in zip(axes, SPEEDS):
        for name, colour in colours.items():
            run = runs.get((name, speed, "h"))
            if run:
                outline(plot, run, colors=[colour], linewidths=1.4)
            plot.plot([], [], color=colour, label=name)
        plot.set_title(f"{speed} m/s")
        plot.set_xlabel("r [mm]")
    axes[0].set_ylabel("z [mm]")
    axes[0].legend(frameon=False)
    figure.suptitle("Outlines (volume fraction 1/2) at 60 µs, cell h")
    figure.savefig(os.path.join(study.folder, "outlines.png"), dpi=130)
    plt.close(figure)


def main():
    study = Study(__file__, "inputs/taylor_copper.yaml", ESTIMATED_SECONDS, __doc__)
    jobs, keys = {}, {}
    for speed in SPEEDS:
        for cell in CELLS if speed == 190 else ("h",):
            for reference in REFERENCES:
                label = "".join(c if c.isalnum() else "_" for c in f"{speed}_{cell}_{reference}")
                keys[label] = (reference, speed, cell)
                jobs[label] = (settings(reference, speed, CELLS[cell]), 20 if cell == "h" else 90)
    runs = {keys[label]: run for label, run in study.run_all(jobs).items()}
    study.add("The copper rod of [inputs/taylor_copper.yaml](../../inputs/taylor_copper.yaml), axisymmetric, h = 0.381 mm, "
              "60 µs. `current`: weights at the present positions (updated-Lagrangian MPM). `initial`: for ever at the "
              "positions of the start (total-Lagrangian MPM). `adaptive`: on a reference that is renewed when the "
              "Green-Lagrange strain since then exceeds the number. By Theorem 1 of the CCF paper all are the same weak "
              "form. Time: seconds on one thread (ns per point-step).")
    for speed in SPEEDS:
        for cell in CELLS:
            rows = [row(name, runs[(name, speed, cell)]) for name in REFERENCES if (name, speed, cell) in runs]
            if rows:
                study.add(f"## {speed} m/s, cell {cell}")
                study.add_table(["reference", "steps", "length mm", "foot mm", "W mm", "largest mm", "energy error %",
                                 "new references", "time s (ns)"], rows)
    study.add("![outlines](outlines.png)")
    with open(os.path.join(study.folder, "discussion.md"), encoding="utf-8") as file:
        study.add(file.read().strip())
    picture(study, runs)
    study.write("Reference configurations in the Taylor impact")


if __name__ == "__main__":
    main()
