#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""CCF's two bars (4.1) by elements: rates of stress, hourglass and reference at five and ten elements across.

Writes README.md and a picture into its folder. `tools/validate ccf_bars` builds first. The same bars by points:
../ccf_two_bars.

A script, not a template: it reads nodes of elements and their first places, which no block of a template knows.
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
from validate_runs import Study  # noqa: E402

ESTIMATED_SECONDS = 700  # on two quiet cores

METAL = """materials:
  metal:
    density: 7750
    youngs_modulus: 310 GPa
    poisson_ratio: 0.3
    eos: linear
    strength: {{von_mises: {{Y: 0.85 GPa, H: 0.55 GPa}}}}
    viscosity: {{q_lin: 0.3, q_quad: 2.0}}
    rate: {rate}
"""
BAR = """  {name}:
    material: metal
    shape: {{{{box: {{{{min: [-1.25 mm, -1.25 mm, {low} mm], max: [1.25 mm, 1.25 mm, {high} mm]}}}}}}}}
    velocity: [0, 0, {speed} m/s]
    kinematics: {{{{lagrangian_mesh: {{{{element: {{size}} mm, hourglass: {{held}}, reference: {{reference}}}}}}}}}}
"""
BLOCK = """title: {title} (CCF 4.1)
frame: 3d
grid: {{{{cell: 0.5 mm, box: {{{{min: [-20 mm, -20 mm, {low} mm], max: [20 mm, 20 mm, {high} mm]}}}}{sides}}}}}
time: {{{{end: {{end}} us, energy_error: off}}}}
output: {{{{frames: 5 us, history: 0.5 us}}}}
"""
WALL = (BLOCK.format(title="Bar on a wall, 1000 m/s, half", low=0, high=60, sides=", boundary: {{z_min: {{wall: {{friction: 0}}}}}}") + METAL
        + "bodies:\n" + BAR.format(name="bar", low=0, high=50, speed=-1000))
PAIR = (BLOCK.format(title="Two bars of elements, 2000 m/s", low=-60, high=80, sides="") + "contact: {{friction: 0}}\n" + METAL
        + "bodies:\n" + BAR.format(name="target", low=0, high=50, speed=0) + BAR.format(name="bar", low=-50, high=0, speed=2000))
QUARTER_PAIR = PAIR.replace("min: [-20 mm, -20 mm,", "min: [0, 0,").replace(
    ", 80 mm]}}", ", 80 mm]}}, boundary: {{x_min: symmetry, y_min: symmetry}}").replace("min: [-1.25 mm, -1.25 mm,", "min: [0, 0,")


def head(run, number, body="bar"):
    """Widest nodes along the sides over widest along the diagonals, seen from the end."""
    path = os.path.join(run.folder, "frames", f"{number:06d}.h5")
    with h5py.File(path) as file:
        x = file[f"{body}/nodes/coordinates"][()][:, :2]
    turned = x @ np.array([[1, 1], [1, -1]]) / np.sqrt(2)
    return np.abs(x).max() / np.abs(turned).max()


def consumed(run, number, body="bar", depth=5e-3):
    """Nodes that began within `depth` of the impact end: x, y [m]."""
    x = []
    for frame in (0, number):
        with h5py.File(os.path.join(run.folder, "frames", f"{frame:06d}.h5")) as file:
            x.append(file[f"{body}/nodes/coordinates"][()])
    z = x[0][:, 2]
    end = z > z.max() - depth if body == "bar" else z < z.min() + depth
    return x[1][end][:, :2]


def most_of_head(run, number, body="bar"):
    """As head(), of the consumed part but for the outermost 1 % of its nodes."""
    x = consumed(run, number, body)
    turned = x @ np.array([[1, 1], [1, -1]]) / np.sqrt(2)
    return np.quantile(np.abs(x).max(axis=1), 0.99) / np.quantile(np.abs(turned).max(axis=1), 0.99)


def wall_row(study, name, label, seconds, **how):
    run = study.run_text("wall_" + label, WALL.format(**how), seconds)
    if run is None:
        return [name] + ["-"] * 7
    audit = run.summary["audit"]
    at = [f"{head(run, k):.2f}" for k in range(1, 1 + int(how["end"]) // 5)]
    return [name, " / ".join(at), audit["folded_elements"], f"{audit['least_corner_jacobian']:.2f}",
            f"{100 * audit['hourglass_share']:.1f}", f"{audit['energy_residual_fraction']:.0e}", run.summary["steps"],
            f"{run.wall:.1f}"]


def walls(study):
    rows = []
    for rate in ("truesdell", "jaumann", "green_naghdi"):
        for held in ("assumed_strain", "viscous"):
            for reference in ("current", "initial"):
                rows.append(wall_row(study, f"{rate}, {held}, {reference}", f"{rate}_{held}_{reference}", 8, rate=rate, held=held,
                                     reference=reference, size=0.5, end=10))
    for held, reference in (("assumed_strain", "current"), ("viscous", "current"), ("assumed_strain", "initial")):
        rows.append(wall_row(study, f"10 across: truesdell, {held}, {reference}", f"fine_{held}_{reference}", 60,
                             rate="truesdell", held=held, reference=reference, size=0.25, end=5))
    study.add("## CCF's bar on a wall, 1000 m/s",
              "Half of CCF 4.1 by symmetry: 5 x 5 x 100 cubes (the paper's 5 x 5 x 50 elements are twice as long), to 10 µs; 10 x 10 x 200 "
              "to 5 µs. Sides over diagonals of the head: 0.71 a square as it "
              "was, 1 a disc, 1.41 a square turned by 45 degrees.")
    study.add_table(["rate, hourglass, reference", "sides/diagonals at 5 / 10 µs", "folded elements", "least corner", "hourglass share %",
                     "residual", "steps", "wall time s (1 thread)"], rows)


def least_volume(run, body="bar"):
    """Least V/V0 of an element in any frame, by densities."""
    folder = os.path.join(run.folder, "frames")
    densest = 0.0
    for name in sorted(os.listdir(folder)):
        with h5py.File(os.path.join(folder, name)) as file:
            densest = max(densest, file[f"{body}/density"][()].max())
    return 7750 / densest


def hourglass_course(run):
    """Share of the internal energy that holds hourglass modes at 1, 2 and 5 us [%]."""
    history = run.history()
    shares = [np.interp(t, history["time"], history["hourglass_energy"]) / np.interp(t, history["time"], history["internal_energy"])
              for t in (1e-6, 2e-6, 5e-6)]
    return " / ".join(f"{100 * share:.1f}" for share in shares)


def fine_pairs(study):
    """Both bars at 10 elements across, a quarter."""
    rows, drawn = [], {}
    # With dampers on the initial reference the step has fallen to 0.04 ns by 4.4 us.
    cases = [("truesdell", "assumed_strain", "current"), ("truesdell", "assumed_strain", "initial"), ("truesdell", "viscous", "current"),
             ("jaumann", "assumed_strain", "current"), ("green_naghdi", "assumed_strain", "current")]
    for rate, held, reference in cases:
        run = study.run_text(f"quarter_{rate}_{held}_{reference}",
                             QUARTER_PAIR.format(rate=rate, held=held, reference=reference, size=0.25, end=5), 100)
        name = f"{rate}, {held}, {reference}"
        if run is None:
            rows.append([name] + ["-"] * 10)
            continue
        drawn[name] = run
        audit = run.summary["audit"]
        rows.append([name, " / ".join(f"{head(run, 1, body):.2f}" for body in ("bar", "target")),
                     " / ".join(f"{most_of_head(run, 1, body):.2f}" for body in ("bar", "target")), audit["folded_elements"],
                     f"{audit['least_corner_jacobian']:.2f}", f"{least_volume(run):.2f}", hourglass_course(run),
                     f"{100 * audit['contact_heat'] / audit['initial_energy']:.2f}",
                     f"{audit['energy_residual_fraction']:.0e}", run.summary["steps"], f"{run.wall:.1f}"])
    study.add("Ten elements across, a quarter of both bars (5 x 5 x 200 elements each; planes of symmetry shut out motions that turn "
              "the bars), to 5 µs:")
    study.add_table(["rate, hourglass, reference", "sides/diagonals of striker / target", "but for 1 %", "folded elements", "least corner", "least V/V0",
                     "hourglass share % at 1 / 2 / 5 µs", "contact takes of the energy %", "residual", "steps", "wall time s (1 thread)"], rows)
    draw_heads(drawn)
    study.add("![heads](heads.png)")


def draw_heads(runs):
    """The striker's nodes of the part that is consumed, seen along the bar, a quarter mirrored."""
    if not runs:
        return
    figure, grid = plt.subplots(2, (len(runs) + 1) // 2, figsize=(3.1 * ((len(runs) + 1) // 2), 6.6), layout="constrained",
                                sharex=True, sharey=True, squeeze=False)
    for axes, (name, run) in zip(grid.ravel(), runs.items()):
        x = 1e3 * consumed(run, 1)
        for signs in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
            axes.plot(signs[0] * x[:, 0], signs[1] * x[:, 1], ".", ms=2, color="#1f77b4")
        axes.plot([-1.25, 1.25, 1.25, -1.25, -1.25], [-1.25, -1.25, 1.25, 1.25, -1.25], color="#d6006c", lw=1)
        axes.set_aspect("equal")
        axes.set_title(name, fontsize=8)
    for axes in grid.ravel()[len(runs):]:
        axes.set_axis_off()
    for axes in grid[-1]:
        axes.set_xlabel("x [mm]")
    for line in grid:
        line[0].set_ylabel("y [mm]")
    figure.suptitle("Nodes of the striker's first 5 mm at 5 µs, seen along the bar (red: the bar before)", fontsize=9)
    figure.savefig(os.path.join(os.path.dirname(os.path.abspath(__file__)), "heads.png"), dpi=110)
    plt.close(figure)


def pairs(study):
    """Both bars, by contact."""
    rows = []
    end = 5
    for rate, held, reference in ((rate, held, reference) for rate in ("truesdell", "jaumann", "green_naghdi")
                                  for held in ("assumed_strain", "viscous") for reference in ("current", "initial")):
        run = study.run_text(f"pair_{rate}_{held}_{reference}_{end}",
                             PAIR.format(rate=rate, held=held, reference=reference, size=0.5, end=end), 20 * end / 5)
        name = f"{rate}, {held}, {reference}"
        if run is None:
            rows.append([name] + ["-"] * 8)
            continue
        audit = run.summary["audit"]
        heads = " / ".join(f"{head(run, end // 5, body):.2f}" for body in ("bar", "target"))
        rows.append([name, heads, audit["folded_elements"], f"{audit['least_corner_jacobian']:.2f}",
                     f"{100 * audit['hourglass_share']:.1f}", f"{100 * audit['contact_heat'] / audit['initial_energy']:.2f}",
                     f"{audit['energy_residual_fraction']:.0e}", run.summary["steps"], f"{run.wall:.1f}"])
    study.add("## CCF's two bars, 2000 m/s", "CCF 4.1 with both bars, 5 x 5 x 100 elements each, which meet by contact without friction, to 5 µs.")
    study.add_table(["rate, hourglass, reference", "sides/diagonals of striker / target", "folded elements", "least corner",
                     "hourglass share %", "contact takes of the energy %", "residual", "steps", "wall time s (1 thread)"], rows)
    fine_pairs(study)


def main():
    study = Study(__file__, "inputs/ccf_two_bars.yaml", ESTIMATED_SECONDS, __doc__)
    study.add("Bars of 2.5 x 2.5 x 50 mm, 2000 m/s, of elements of one size: Zhou, Sha, Tamma, Miller, AIAA-2006-1758, section 4.1, who claim "
              "that with Truesdell's rate the run survives to 0.13 ms, and that the ends become squares turned by 45 degrees. One thread.")
    walls(study)
    pairs(study)
    discussion(study)
    study.write("CCF's two bars by elements")


if __name__ == "__main__":
    main()
