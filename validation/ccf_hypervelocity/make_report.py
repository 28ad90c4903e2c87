#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A steel cylinder strikes an aluminium cylinder at 6 km/s (CCF 4.3).

Writes README.md and pictures into its folder. `tools/validate ccf_hypervelocity` builds first.
"""

import os
import sys

import h5py
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_impacts import (COST_TITLES, Scale, costs, discussion, fragments, histories,  # noqa: E402
                              shapes, value)
from validate_runs import Study  # noqa: E402

ESTIMATED_SECONDS = 500  # on two quiet cores

EXACT = 118.57e9  # theory D1, flow of one dimension
CELLS = {10: 0.355e-3, 20: 0.1775e-3, 40: 0.08875e-3}  # cells in the projectile's radius
SECONDS = {10: 3, 20: 15, 40: 120}
EARLY = ["time.end=0.3 us", "output={frames: 0.05 us, history: 0.005 us, fields: [pressure]}"]
SPACE = ["frame=3d", "grid.box={min: [0, 0, -44 mm], max: [36 mm, 36 mm, 36 mm]}",
         "grid.boundary={x_min: symmetry, y_min: symmetry}", "bodies.projectile.velocity=[0, 0, -6 km/s]",
         "time.end=4 us"]


def plateau(run):
    """(mean pressure [Pa], scatter, points) at 0.25 us: points within 1 mm of the axis, from 1 mm below the interface to
    0.7 mm above it, which is between the two shocks and ahead of the release from the edge."""
    with h5py.File(os.path.join(run.folder, "frames.h5"), "r") as file:
        names = sorted(file["frames"])
        name = min(names, key=lambda n: abs(float(file["frames"][n].attrs["time"]) - 0.25e-6))
        frame, z, p = file["frames"][name], {}, {}
        for body in ("target", "projectile"):
            x = frame[body]["coordinates"][()]
            near = x[:, 0] < 1e-3
            z[body], p[body] = x[near, 2], frame[body]["pressure"][()].ravel()[near]
    interface = 0.5 * (z["target"].max() + z["projectile"].min())
    values = np.concatenate([p["target"][z["target"] > interface - 1e-3],
                             p["projectile"][z["projectile"] < interface + 0.7e-3]])
    return float(values.mean()), float(values.std()), len(values)


def row(name, run):
    return [name, value(run, "peak_pressure", 1e-9), value(run, "penetration", 1e3, 2),
            value(run, "crater_diameter", 1e3, 2), value(run, "projectile_velocity", -1, 0), *costs(run)]


TITLES = ["run", "peak pressure GPa", "penetration mm", "crater diameter mm", "projectile's velocity m/s", *COST_TITLES]


def first_contact(study, early):
    study.add("## Pressure of first contact",
              f"Exact for plane flow: {1e-9 * EXACT:.2f} GPa (Hugoniots of the two cards, equal pressure and velocity). "
              "Mean over the points within 1 mm of the axis at 0.25 µs, from 1 mm below the interface to 0.7 mm above it: "
              "between the two shocks and ahead of the release from the edge.")
    rows = []
    for n, run in early.items():
        if run:
            p, scatter, count = plateau(run)
            rows.append([f"{n} cells in the radius", f"{1e-9 * p:.2f}", f"{100 * (p / EXACT - 1):+.2f}",
                         f"{1e-9 * scatter:.2f}", count])
    study.add_table(["run", "pressure GPa", "error %", "scatter of points GPa", "points"], rows)


def profile(study, early):
    figure, axes = plt.subplots(figsize=(8, 4.4), layout="constrained")
    for n, run in early.items():
        if not run:
            continue
        with h5py.File(os.path.join(run.folder, "frames.h5"), "r") as file:
            name = min(file["frames"], key=lambda k: abs(float(file["frames"][k].attrs["time"]) - 0.25e-6))
            frame, z, p = file["frames"][name], [], []
            for body in ("target", "projectile"):
                x = frame[body]["coordinates"][()]
                near = x[:, 0] < 1e-3
                z.append(x[near, 2])
                p.append(frame[body]["pressure"][()].ravel()[near])
        order = np.argsort(np.concatenate(z))
        axes.plot(1e3 * np.concatenate(z)[order], 1e-9 * np.concatenate(p)[order], ".", ms=3, label=f"{n} cells")
    axes.axhline(1e-9 * EXACT, color="#d6006c", ls="--", label="exact, one dimension")
    axes.set_xlim(-5, 5)
    axes.set_xlabel("z [mm]")
    axes.set_ylabel("pressure [GPa]")
    axes.set_title("Points within 1 mm of the axis at 0.25 µs")
    axes.legend(frameon=False)
    figure.savefig(os.path.join(study.folder, "first_contact.png"), dpi=110)
    plt.close(figure)


def main():
    study = Study(__file__, "inputs/ccf_hypervelocity.yaml", ESTIMATED_SECONDS, __doc__)
    early = {n: study.run(f"early_{n}", [f"grid.cell={cell!r}", *EARLY], SECONDS[n] / 10, study.cores)
             for n, cell in CELLS.items()}
    runs = {n: study.run(f"cells_{n}", [f"grid.cell={CELLS[n]!r}"], SECONDS[n], study.cores) for n in (10, 20)}
    single = study.run("single_field", [f"grid.cell={CELLS[20]!r}"], SECONDS[20], study.cores,
                       without=["contact: {friction: 0}"])
    space = {n: study.run(f"space_{n}", [*SPACE, f"grid.cell={cell!r}"], seconds, study.cores)
             for n, cell, seconds in ((5, 0.71e-3, 15), (10, 0.355e-3, 200))}
    runs[40] = study.run("cells_40", [f"grid.cell={CELLS[40]!r}"], SECONDS[40], study.cores)

    study.add("A steel cylinder of 7.1 x 7.47 mm strikes an aluminium cylinder of 32 x 20 mm at 6 km/s: "
              "[inputs/ccf_hypervelocity.yaml](../../inputs/ccf_hypervelocity.yaml), Zhou, Sha, Tamma, Miller, "
              "AIAA-2006-1758, section 4.3, Table 1. There is no experiment; the paper's Figure 3 shows 0.4, 0.8 and 2.0 µs. "
              "All runs go to 10 µs but 3D (4 µs).", "## Refinement, axisymmetric, at 10 µs")
    study.add_table(TITLES, [row(f"{n} cells in the radius", run) for n, run in runs.items()])
    study.add("![shapes](shapes.png)", "![late](late.png)", "![velocity](velocity.png)")
    first_contact(study, early)
    study.add("![pressure](first_contact.png)")
    study.add("## 3D quarter, at 4 µs")
    study.add_table(TITLES, [row(f"3D, {n} cells", run) for n, run in space.items()])
    study.add("![3D](space.png)")
    study.add("## Without contact",
              "Without `contact:` the two bodies share one velocity field: they stick, in tension too.")
    study.add_table(TITLES, [row("contact, 20 cells", runs[20]), row("single field, 20 cells", single)])
    if single and runs[20]:
        study.add("What contact costs per point-step is in [contact](../contact/README.md).", "![single field](single_field.png)")
    finest = [run for run in runs.values() if run][-1]
    study.add("Pieces at 10 µs, finest run:")
    fragments(study, finest, "pieces")
    discussion(study)

    def strain(run):
        return Scale(run, "plastic_strain", 3.0)

    named = {f"{n} cells": run for n, run in runs.items()}
    shapes(study, named, (0.4e-6, 0.8e-6, 2e-6), "shapes.png", strain, [-18, 18, -22, 10], "Times of the paper's Figure 3")
    shapes(study, named, (4e-6, 6e-6, 10e-6), "late.png", strain, [-26, 26, -38, 26], "Later")
    shapes(study, {"contact": runs[20], "single field": single}, (2e-6, 10e-6), "single_field.png", strain,
           [-26, 26, -38, 26], "20 cells in the radius")
    shapes(study, {f"3D, {n} cells": run for n, run in space.items()}, (0.8e-6, 2e-6, 4e-6), "space.png", strain,
           [0, 22, -28, 14], "3D quarter, section y = 0")
    histories(study, named, {"projectile_velocity": "projectile"}, "velocity.png", "velocity [m/s]", -1.0)
    profile(study, early)
    study.write("Steel on aluminium at 6 km/s (CCF 4.3)")


if __name__ == "__main__":
    main()
