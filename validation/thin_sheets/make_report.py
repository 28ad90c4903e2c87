#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets, bars and tubes thinner than a cell, points split along their stretch and not.

Writes README.md and pictures into its folder. `tools/validate thin_sheets` builds first.

A script, not a template: it holds points against closed forms of a bar and a tube.
"""

import os
import sys

import h5py
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_impacts import discussion  # noqa: E402
from validate_runs import ROOT, Study  # noqa: E402

ESTIMATED_SECONDS = 500  # on two quiet cores
WORDS = {"watch": "left alone", "split": "split"}

# A bar of 8 x 160 mm whose velocity is linear: a quarter of it.
RATE, HALF, LENGTH, DENSITY = 3e4, 4e-3, 80e-3, 7850.0  # 1/s, m, m, kg/m^3
BAR = """
title: A bar that stretches by its own motion
frame: plane_strain
grid:
  cell: 1 mm
  box: {{min: [0, 0], max: [12 mm, 720 mm]}}
  boundary: {{x_min: symmetry, z_min: symmetry}}
time: {{end: 233.3333 us}}
method: {{stagger: false}}
materials:
  metal: {{density: {density}, youngs_modulus: {modulus}, poisson_ratio: 0.3, eos: linear, viscosity: {{}},
          strength: {{von_mises: {{Y: {strength}}}}}}}
bodies:
  bar: {{material: metal, shape: {{box: {{min: [-4 mm, -1, -80 mm], max: [4 mm, 1, 80 mm]}}}}, velocity: [{side}*x, {rate}*z]}}
output: {{frames: 3.333333 us, history: 1 us}}
"""
SOFT = {"strength": 18e6, "modulus": 4e9}      # the motion is the stronger: no necks
STEEL = {"strength": 500e6, "modulus": 200e9}  # perfectly plastic: it necks by itself
STRETCHES = (4.0, 5.0, 6.0, 7.0, 8.0)

TUBE = """
title: A tube that expands by its own motion
frame: plane_strain
grid:
  cell: 1 mm
  box: {min: [0, 0], max: [200 mm, 200 mm]}
  boundary: {x_min: symmetry, z_min: symmetry}
time: {end: 120 us}
materials:
  copper: {density: 8930, youngs_modulus: 120 GPa, poisson_ratio: 0.34, eos: linear, viscosity: {},
           strength: {von_mises: {Y: 0.1 GPa, H: 0.1 GPa}}}
bodies:
  tube:
    material: copper
    thin: allowed
    shape: {tube: {inner_radius: 20 mm, outer_radius: 24 mm, height: 2, base: [0, -1, 0], axis: y}}
    velocity: ["1000*x*0.022/(x*x+z*z)", "1000*z*0.022/(x*x+z*z)"]
output: {frames: 20 us, history: 2 us}
measures:
  pieces: {kind: fragments, body: tube, least_points: 2}
"""
TUBE_CELLS = (4e-3, 2e-3, 1e-3)

WHIPPLE = """
title: Whipple bumper, 3.2 mm at 6.7 km/s
frame: axisymmetric
grid: {cell: 0.25 mm, box: {min: [0, -55 mm], max: [40 mm, 10 mm]}}
time: {end: 7.5 us}
materials:
  aluminium: {card: al2024_t351, damage: card, heating: {energy: {c_v: 875}}, viscosity: {q_lin: 0.5, q_quad: 2.0}}
bodies:
  bumper: {material: aluminium, shape: {cylinder: {radius: 35 mm, height: 1 mm, base: [0, -1 mm]}}}
  sphere: {material: aluminium, shape: {sphere: {radius: 1.6 mm, center: [0, 1.6 mm]}}, velocity: [0, -6.7 km/s]}
contact: {friction: 0}
output: {frames: 0.75 us, history: 0.25 us}
measures:
  hole: {kind: hole_diameter, body: bumper}
  cloud: {kind: debris_extent, body: [sphere, bumper], axis: r, mass_share: 0.95, region: {z_max: -2 mm}}
"""
WHIPPLE_CELLS = (0.5e-3, 0.25e-3, 0.125e-3)

QUARTER = ["grid.box={min: [0, 0, -60 mm], max: [60 mm, 60 mm, 330 mm]}", "grid.boundary={x_min: symmetry, y_min: symmetry}"]
BARS = {"left alone": ["method.numerical_fracture=watch"], "split": ["method.numerical_fracture=split"],
        "split and merged": ["method.numerical_fracture=split", "grid.merge=true"]}
TIMES = (5e-6, 10e-6, 15e-6, 20e-6)


def frames(run):
    with h5py.File(os.path.join(run.folder, "frames.h5"), "r") as file:
        for name in sorted(file["frames"]):
            yield float(file["frames"][name].attrs["time"]), file["frames"][name]


def frame_at(run, time):
    """Time and {body: {field: values}} of the frame nearest to a time."""
    with h5py.File(os.path.join(run.folder, "frames.h5"), "r") as file:
        group = min(file["frames"].values(), key=lambda frame: abs(float(frame.attrs["time"]) - time))
        return float(group.attrs["time"]), {body: {field: values[()] for field, values in group[body].items()
                                                   if isinstance(values, h5py.Dataset)}
                                            for body in group if isinstance(group[body], h5py.Group)}


def fracture(run):
    return run.audit("numerical_fracture")


def seconds(run):
    """Of the processor in steps, as the run's clock says on one thread [s]."""
    return run.wall


def force_errors(run):
    """(stretch, force over the exact one - 1): of the stress of what was between 25 and 50 mm of the middle."""
    rows = []
    for time, frame in frames(run):
        stretch, bar = 1 + RATE * time, frame["bar"]
        z, volume = bar["coordinates"][:, 2], (bar["mass"][()] / bar["density"][()]).ravel()
        middle = (z > 25e-3 * stretch) & (z < 50e-3 * stretch)
        force = np.sum((volume * bar["stress"][:, 2])[middle]) / (25e-3 * stretch)
        exact = HALF / stretch * (2 * SOFT["strength"] / np.sqrt(3)
                                  - 2 / 3 * DENSITY * (RATE * HALF / stretch ** 2) ** 2)
        rows.append((stretch, force / exact - 1))
    return np.array(rows)


def first_torn(run):
    history = run.history()
    torn = np.flatnonzero(history["torn_points"] > 0)
    return f"{1 + RATE * history['time'][torn[0]]:.2f}" if torn.size else "-"


def bars(study):
    runs = {}
    for name, metal in {"soft": SOFT, "steel": STEEL}.items():
        text = BAR.format(density=DENSITY, side=-RATE, rate=RATE, **metal)
        for word, told in WORDS.items():
            runs[name, told] = study.run_text(f"{name}_{word}", text, 10, [f"method.numerical_fracture={word}"])
    study.add("## A bar that stretches eightfold",
              "8 by 160 mm, cells of 1 mm, plane strain; each point flies at 3e4/s times its place, so the stretch is 1 + 3e4 t. Soft (Y 18 MPa): the "
              "motion is the stronger and the bar stays even; its exact force is F = A [2 Y/√3 - 2/3 ρ (ε̇ a)²], A = A0/λ, a half of the thickness, the "
              "second part from sides that slow down. The force is that of the stress of all points that were between 25 and 50 mm from the middle. "
              "Rows of two points to a cell share no node from a stretch of 4 on.")
    rows = []
    for told in WORDS.values():
        run = runs["soft", told]
        if run is None:
            continue
        errors = force_errors(run)
        rows.append([told, first_torn(run), fracture(run)["torn_points"],
                     *(f"{100 * np.interp(stretch, errors[:, 0], errors[:, 1]):.2f}" for stretch in STRETCHES),
                     run.summary["points"], f"{100 * run.audit('energy_residual_fraction'):.0e}", f"{seconds(run):.1f}"])
    study.add_table(["points", "torn from a stretch of", "torn at 8", *(f"force at {s:.0f}, error %" for s in STRETCHES), "points at the end",
                     "energy not accounted for %", "wall time s (1)"], rows)
    study.add("Before a stretch of 4 the sides still ring of the start, which has no stress, in both runs alike.",
              "![force](force.png)",
              "A bar of steel with a yield stress of 500 MPa and no hardening necks by itself. Left alone its necks stop where points lose each "
              "other; split they go on to threads.", "![bars](bars.png)")
    draw_bars(study, runs)


def draw_bars(study, runs):
    figure, axes = plt.subplots(figsize=(7, 3.6), layout="constrained")
    for told, colour in (("left alone", "#888888"), ("split", "#0b6e99")):
        if runs["soft", told] is None:
            continue
        errors = force_errors(runs["soft", told])
        axes.plot(errors[:, 0], 1 + errors[:, 1], color=colour, label=told)
    axes.axhline(1, color="black", lw=0.6)
    axes.set(xlabel="stretch", ylabel="force over the exact one", ylim=(-0.2, 2), xlim=(1, 8))
    axes.legend(frameon=False)
    figure.savefig(os.path.join(study.folder, "force.png"), dpi=90)
    plt.close(figure)
    shown = [(name, told, time) for name, time in (("soft", 233.3e-6), ("steel", 133.3e-6)) for told in WORDS.values()
             if runs[name, told] is not None]
    figure, lines = plt.subplots(len(shown), 1, figsize=(12, 2.0 * len(shown)), layout="constrained", squeeze=False)
    for axes, (name, told, time) in zip(lines[:, 0], shown):
        time, frame = frame_at(runs[name, told], time)
        x = 1e3 * frame["bar"]["coordinates"]
        dots = axes.scatter(x[:, 2], x[:, 0], s=1.2, c=frame["bar"]["plastic_strain"].ravel(), linewidths=0, cmap="viridis", vmin=0)
        figure.colorbar(dots, ax=axes, label="plastic strain")
        axes.set_title(f"{name}, {told}, {1e6 * time:.0f} µs, stretch {1 + RATE * time:.1f} (x enlarged)", fontsize=9)
        axes.set_ylabel("x [mm]")
    lines[-1, 0].set_xlabel("z [mm]")
    figure.savefig(os.path.join(study.folder, "bars.png"), dpi=70)
    plt.close(figure)


def tubes(study):
    study.add("## A tube that expands sixfold",
              "Copper with hardening, 4 mm thick, 22 mm of mean radius, flying outwards at 1 km/s; no damage law, so it may neck but has no reason to part.")
    rows, runs = [], {}
    for cell in TUBE_CELLS:
        for word, told in WORDS.items():
            run = study.run_text(f"tube_{1e3 * cell:.0f}_{word}", TUBE, 5, [f"grid.cell={cell!r}", f"method.numerical_fracture={word}"])
            runs[cell, told] = run
            if run is not None:
                rows.append([f"{4e-3 / cell:.0f}", told, f"{run.measure('pieces'):.0f}", fracture(run)["torn_points"],
                             f"{fracture(run)['greatest_stretch']:.2f}", run.summary["points"], f"{seconds(run):.1f}"])
    study.add_table(["cells through the tube", "points", "pieces of a quarter", "torn points", "greatest length over the reach", "points at the end",
                     "wall time s (1)"], rows)
    study.add("![tube](tube.png)")
    shown = {told: runs[TUBE_CELLS[-1], told] for told in WORDS.values() if runs[TUBE_CELLS[-1], told] is not None}
    figure, line = plt.subplots(1, len(shown), figsize=(5.5 * len(shown), 5), layout="constrained", squeeze=False)
    for axes, (told, run) in zip(line[0], shown.items()):
        _, frame = frame_at(run, 1)
        x = 1e3 * frame["tube"]["coordinates"]
        dots = axes.scatter(x[:, 0], x[:, 2], s=4, c=frame["tube"]["plastic_strain"].ravel(), linewidths=0, cmap="viridis", vmin=1, vmax=5)
        axes.set(aspect="equal", title=f"{told}, 4 cells through it at the start, 120 µs", xlabel="x [mm]", ylabel="z [mm]")
        figure.colorbar(dots, ax=axes, label="plastic strain", shrink=0.8)
    figure.savefig(os.path.join(study.folder, "tube.png"), dpi=70)
    plt.close(figure)


def front(run):
    """Velocity of the cloud's front between 3 us and the end: of the place that 2 % of the sphere's mass is beyond [m/s]."""
    places = []
    for time in (3e-6, 1.0):
        now, frame = frame_at(run, time)
        z = np.concatenate([frame[body]["coordinates"][:, 2] for body in ("sphere", "bumper")])
        mass = np.concatenate([frame[body]["mass"].ravel() for body in ("sphere", "bumper")])
        order = np.argsort(z)
        beyond = 0.02 * np.sum(frame["sphere"]["mass"])
        places.append((now, z[order][np.searchsorted(np.cumsum(mass[order]), beyond)]))
    return (places[0][1] - places[1][1]) / (places[1][0] - places[0][0])


def whipple(study):
    study.add("## A Whipple bumper",
              "3.2 mm of aluminium at 6.7 km/s on a bumper of 1 mm, with the card's damage, which fails before points are long: little is left to split.")
    rows = []
    for cell in WHIPPLE_CELLS:
        for word, told in WORDS.items():
            run = study.run_text(f"whipple_{1e6 * cell:.0f}_{word}", WHIPPLE, 5, [f"grid.cell={cell!r}", f"method.numerical_fracture={word}"])
            if run is not None:
                rows.append([f"{1e-3 / cell:.0f}", told, f"{front(run):.0f}", f"{1e3 * run.measure('hole'):.2f}", f"{1e3 * run.measure('cloud'):.1f}",
                             fracture(run)["torn_points"], run.summary["points"], f"{100 * run.audit('energy_residual_fraction'):.0e}",
                             f"{seconds(run):.1f}"])
    study.add_table(["cells through the bumper", "points", "front m/s", "hole mm", "cloud mm", "torn points", "points at the end",
                     "energy not accounted for %", "wall time s (1)"], rows)


def head(run, time):
    """Width of the target's end along the bar's sides and its diagonals [m]: twice the radius of the outermost point within
    3 mm of the end and within 10 degrees of either. (validation/ccf_two_bars leaves the outermost hundredth of the points
    out; halves are lighter, and on a diagonal most mass may lie within a hole.)"""
    _, frame = frame_at(run, time)
    x = frame["target"]["coordinates"]
    x = x[x[:, 2] < x[:, 2].min() + 3e-3]
    radius, angle = np.hypot(x[:, 0], x[:, 1]), np.degrees(np.arctan2(x[:, 1], x[:, 0])) % 90
    return tuple(2 * float(radius[chosen].max()) for chosen in (np.minimum(angle, 90 - angle) < 10, np.abs(angle - 45) < 10))


def two_bars(study):
    study.use("inputs/ccf_two_bars.yaml")
    runs = {}
    for name, settings in BARS.items():
        label = "bars_" + name.replace(" ", "_")
        runs[5, name] = study.run(label, [*QUARTER, "time.end=20 us", *settings], 20)
        if name != "split":
            runs["whole", name] = study.run(label + "_whole", [*QUARTER, *settings], 150)
            runs[10, name] = study.run(label + "_10", [*QUARTER, "grid.cell=0.25 mm", "time.end=20 us", *settings], 150)
    study.add("## Two bars at the paper's cell",
              "[inputs/ccf_two_bars.yaml](../../inputs/ccf_two_bars.yaml), a quarter of it: bars of 2.5 mm, 2000 m/s. Sides over diagonals of the target's "
              "end, to the outermost points: a disc has 1, a turned square 1.41 ([ccf_two_bars](../ccf_two_bars/README.md)).")
    rows = []
    for (cells, name), run in runs.items():
        if run is None or cells == "whole":
            continue
        widths = [head(run, time) for time in TIMES]
        rows.append([f"{cells} cells across", name, *(f"{side / diagonal:.2f}" for side, diagonal in widths),
                     " / ".join(f"{1e3 * w:.1f}" for w in widths[-1]), fracture(run)["torn_points"], run.summary["points"],
                     f"{run.error:.2f}", f"{seconds(run):.1f}"])
    study.add_table(["cells", "points", *(f"sides / diagonals, {1e6 * t:.0f} µs" for t in TIMES), "mm at 20 µs", "torn points", "points at 20 µs",
                     "energy error %", "wall time s (1)"], rows)
    rows = [[name, f"{run.measure('target_velocity'):.1f}", f"{run.measure('striker_velocity'):.1f}", fracture(run)["torn_points"],
             f"{fracture(run)['torn_mass'] / run.audit('mass'):.0e}", run.summary["points"], f"{run.error:.2f}", f"{seconds(run):.0f}"]
            for (cells, name), run in runs.items() if cells == "whole" and run is not None]
    study.add("To 0.13 ms, 5 cells across; with ten cells left alone the bars part at 982 and 1018 m/s:")
    study.add_table(["points", "target m/s", "striker m/s", "torn points", "of the mass", "points", "energy error %", "wall time s (1)"], rows)
    study.add("![heads](heads.png)")
    shown = [(key, run) for key, run in runs.items() if run is not None and key[0] != "whole" and key[1] != "split"]
    figure, grid = plt.subplots(len(shown), len(TIMES), figsize=(3.6 * len(TIMES), 3.6 * len(shown)), layout="constrained", squeeze=False)
    for line, ((cells, name), run) in zip(grid, shown):
        for axes, time in zip(line, TIMES):
            now, frame = frame_at(run, time)
            x = frame["target"]["coordinates"]
            near = x[:, 2] < x[:, 2].min() + 3e-3
            axes.scatter(1e3 * x[near, 0], 1e3 * x[near, 1], c=frame["target"]["plastic_strain"].ravel()[near], s=1.5, linewidths=0,
                         cmap="viridis", vmin=0, vmax=5)
            axes.set(aspect="equal", xlim=(0, 16), ylim=(0, 16))
            axes.set_title(f"{cells} cells, {name}, {1e6 * now:.0f} µs", fontsize=9)
    for axes in grid[-1]:
        axes.set_xlabel("x [mm]")
    figure.suptitle("Points of a quarter of the target's end, seen along the bar, by plastic strain (0 to 5)")
    figure.savefig(os.path.join(study.folder, "heads.png"), dpi=60)
    plt.close(figure)


def main():
    study = Study(__file__, "inputs/ccf_two_bars.yaml", ESTIMATED_SECONDS, __doc__)
    os.environ.setdefault("KRATER_CARDS", os.path.join(ROOT, "inputs", "materials"))
    study.add("`method.numerical_fracture: watch` says where sound points lose each other on the grid; `split` cuts them in two along their stretch "
              "before they do (`include/krater/kinematics/mpm/stretch.hpp`).")
    bars(study)
    tubes(study)
    whipple(study)
    two_bars(study)
    discussion(study)
    study.write("Sheets thinner than a cell")


if __name__ == "__main__":
    main()
