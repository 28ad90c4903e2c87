#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Taylor impact of OFHC copper at 190 m/s: refinement, frames, and what the choices of method change.

Writes README.md and pictures into its folder. `tools/validate taylor_copper` builds first.
"""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_runs import Study, noise, order, outline, widest, widest_points  # noqa: E402

ESTIMATED_SECONDS = 600  # on two quiet cores

H = 0.381e-3
NAMES = ("final_length", "foot_contact_diameter", "w_diameter")
EXPERIMENT = {"final_length": 16.205, "foot_contact_diameter": 13.564, "w_diameter": 10.10}  # mm, T003
PEERS = {"final_length": (17.2, 17.5), "foot_contact_diameter": (13.9, 14.2), "w_diameter": (9.4, 9.7)}
FE_FOOT = 14.5
HELD = "grid.boundary.z_min=symmetry"
CELLS = {"2h": 2 * H, "h": H, "h/2": H / 2, "h/4": H / 4}
SECONDS = {"2h": 1, "h": 2, "h/2": 16, "h/4": 130}
SCHEMES = {
    "tflip, usl (default)": [],
    "flip, usl": ["method.transfer=flip"],
    "apic, usl": ["method.transfer=apic"],
    "xpic 4, usl": ["method.transfer={xpic: {order: 4}}"],
    "tflip, musl": ["method.update=musl"],
    "flip, musl": ["method.transfer=flip", "method.update=musl"],
    "apic, musl": ["method.transfer=apic", "method.update=musl"],
    "tflip, usf": ["method.update=usf"],
    "flip, usf": ["method.transfer=flip", "method.update=usf"],
    "gimp: tflip, usl": ["method.shape=gimp"],
    "gimp: tflip, musl": ["method.shape=gimp", "method.update=musl"],
    "linear: flip, musl": ["method.shape=linear", "method.transfer=flip", "method.update=musl"],
}
FRACTIONS, AVERAGING = (0.97, 0.99, 0.999, 1.0), (True, False)
DEFAULT = (True, 0.99)


def file_name(text):
    return "".join(c if c.isalnum() else "_" for c in text)


def choice(averaging, fraction):
    return [f"method.cell_averaging={str(averaging).lower()}", f"method.flip_fraction={fraction}"]


def lengths(run, digits=3):
    return [f"{1e3 * run.measure(n):.{digits}f}" for n in NAMES] if run else ["-"] * 3


def lengths_and_width(run):
    """Length, foot, largest diameter, W."""
    values = lengths(run)
    return [*values[:2], f"{widest(run):.3f}" if run else "-", values[2]]


def price(run):
    """Energy: error, and the parts of it that the scheme's transfer and time integration make."""
    if not run:
        return ["-"] * 3
    start = run.audit("initial_energy")
    transfer = 100 * (run.audit("transfer_loss") + run.audit("transfer_gain")) / start
    return [f"{run.error:.2f}", f"{transfer:.2f}", f"{100 * run.audit('wall_heat') / start:.2f}"]


def change(run):
    """Of the whole energy, in per cent: what the error fraction counts, and the work of the wall."""
    return f"{100 * ((run.audit('kinetic_energy') + run.audit('internal_energy')) / run.audit('initial_energy') - 1):.2f}"


def noises(run):
    """Of the pressure, in MPa, at 20 and 80 µs."""
    return [f"{1e-6 * noise(run, 'pressure', number):.0f}" for number in (2, -1)] if run else ["-"] * 2


def refinement(study, runs):
    rows = []
    for name, run in runs.items():
        if run:
            rows.append([f"{name} = {1e3 * CELLS[name]:.4g} mm", run.summary["points"], run.summary["steps"],
                         *lengths_and_width(run), f"{run.error:.2f}", change(run),
                         f"{run.audit('energy_residual_fraction'):.0e}",
                         f"{run.wall:.1f} ({run.summary['machine']['threads']})"])
    study.add("## Refinement, axisymmetric, default scheme")
    study.add_table(["cell", "points", "steps", "length mm", "foot mm", "largest mm", "W mm", "energy error %",
                     "change of total %", "residual", "wall time s (threads)"], rows)
    done = [run for run in runs.values() if run]
    if len(done) == len(runs):
        rows = []
        for name in NAMES:
            values = [run.measure(name) for run in done]
            p = order(values)
            limit = values[-1] + (values[-1] - values[-2]) / (2 ** p - 1) if p and p > 0.3 else None
            rows.append([name.replace("_", " "), *(f"{100 * (values[k + 1] / values[k] - 1):+.2f}" for k in range(3)),
                         f"{p:.1f}" if p is not None else "differences change sign",
                         f"{1e3 * limit:.3f}" if limit else "-"])
        values = [widest(run) for run in done]
        p = order(values)
        rows.append(["largest diameter", *(f"{100 * (values[k + 1] / values[k] - 1):+.2f}" for k in range(3)),
                     f"{p:.1f}" if p is not None else "differences change sign",
                     f"{values[-1] + (values[-1] - values[-2]) / (2 ** p - 1):.3f}" if p and p > 0.3 else "-"])
        study.add_table(["measure", "2h to h %", "h to h/2 %", "h/2 to h/4 %", "observed order", "extrapolated mm"], rows)
        worst = max(abs(run.error) for run in done[1:])
        step = abs(done[-1].measure("final_length") / done[-2].measure("final_length") - 1)
        study.add(f"Demanded: the length changes by less than 1 % in the last step: "
                  f"{100 * step:.2f} %, **{'met' if step < 0.01 else 'missed'}**. `energy_error_fraction` below "
                  f"1 %: largest at h and finer {worst:.2f} %, "
                  f"**{'met' if worst < 1 else 'missed'}**.")


def frames(study, axisymmetric, space, plane):
    study.add("## Frames, at h")
    rows = [["axisymmetric", axisymmetric.summary["points"], *lengths_and_width(axisymmetric), "", *price(axisymmetric),
             f"{axisymmetric.wall:.1f} ({axisymmetric.summary['machine']['threads']})"]]
    if space:
        apart = [100 * (space.measure(n) / axisymmetric.measure(n) - 1) for n in NAMES]
        rows.append(["3d, full cylinder", space.summary["points"], *lengths_and_width(space),
                     " ".join(f"{a:+.2f}" for a in apart), *price(space),
                     f"{space.wall:.0f} ({space.summary['machine']['threads']})"])
    if plane:
        rows.append(["plane strain (another problem)", plane.summary["points"], *lengths_and_width(plane), "", *price(plane),
                     f"{plane.wall:.1f} ({plane.summary['machine']['threads']})"])
    study.add_table(["frame", "points", "length mm", "foot mm", "largest mm", "W mm", "difference to axisymmetric %",
                     "energy error %", "transfer %", "centring %", "wall time s (threads)"], rows)
    if space:
        worst = max(abs(a) for a in apart)
        study.add(f"Demanded: within 1.5 % of each other. Largest difference {worst:.2f} %, "
                  f"**{'met' if worst < 1.5 else 'missed'}**. 3d: "
                  f"{space.summary['machine']['point_steps_per_second'] / 1e6:.2f} million point-steps per second "
                  f"on {space.summary['machine']['threads']} threads.")
    if plane:
        study.add(f"`energy_error_fraction` below 1 %: plane strain has {plane.error:.2f} %, "
                  f"**{'met' if abs(plane.error) < 1 else 'missed'}**.")


def spread(study, runs):
    study.add("## Transfer schemes, updates and shape functions, axisymmetric, at h",
              "Each scheme's price in energy is its `energy_error_fraction`: energy that transfer between points and "
              "grid and the time integration take away or add without any law asking for it. `transfer` is their net "
              "loss to the grid and back, `centring` that of the time integration, both in per cent of the initial "
              "energy. Shapes are quadratic B-splines where none is named.")
    study.add_table(["scheme", "length mm", "foot mm", "largest mm", "W mm", "energy error %", "transfer %", "centring %",
                     "noise at 20 µs MPa", "at 80 µs MPa", "steps"],
                    [[name, *lengths_and_width(run), *price(run), *noises(run),
                      run.summary["steps"] if run else "failed"]
                     for name, run in runs.items()])
    good = [run for run in runs.values() if run]
    text = []
    for name in NAMES:
        values = [1e3 * run.measure(name) for run in good]
        text.append(f"{name.replace('_', ' ')} {min(values):.2f}-{max(values):.2f} mm "
                    f"({100 * (max(values) / min(values) - 1):.1f} %)")
    study.add("Spread: " + ", ".join(text) + ".")


def defaults(study, runs):
    study.add("## Cell averaging and the fraction of TFLIP, axisymmetric",
              "`fraction` is `flip_fraction`, the part of a point's own velocity that is kept; 1.0 is FLIP with the affine "
              "part. `noise` is the rms difference between the pressure of points and its mean over a cell; the yield "
              "stress is 300-450 MPa.")
    for cell in ("h", "h/2"):
        rows = []
        for averaging in AVERAGING:
            for fraction in FRACTIONS:
                run = runs.get((cell, averaging, fraction))
                name = f"{'on' if averaging else 'off'}, {fraction}"
                if (averaging, fraction) == DEFAULT:
                    name = f"**{name}** (default)"
                rows.append([name, *lengths_and_width(run), *price(run), *noises(run)])
        study.add(f"Cell {cell}:")
        study.add_table(["averaging, fraction", "length mm", "foot mm", "largest mm", "W mm", "energy error %",
                         "transfer %", "centring %", "noise at 20 µs MPa", "at 80 µs MPa"], rows)


def distance(study, runs, space, held):
    finest = [run for run in runs.values() if run][-1]
    rows = []
    for name in NAMES:
        value = 1e3 * finest.measure(name)
        low, high = PEERS[name]
        where = "inside" if low <= value <= high else f"{100 * (value / (low if value < low else high) - 1):+.1f} %"
        rows.append([name.replace("_", " "), f"{value:.3f}", f"{EXPERIMENT[name]:.2f}",
                     f"{100 * (value / EXPERIMENT[name] - 1):+.1f}", f"{low}-{high}", where])
    study.add("## Distance to the experiment and to other codes",
              "Finest axisymmetric run beside the experiment T003 (Johnson and Cook 1983; CuZerilli.dat) and three other "
              "open MPM codes with the same Johnson-Cook constants (figures as collected for this project). A "
              f"finite-element run with them has a foot of {FE_FOOT} mm.")
    study.add_table(["measure", "krater mm", "experiment mm", "difference %", "other MPM codes mm",
                     "beside them"], rows)
    rows = []
    for name, run in [*runs.items(), ("3d, h", space),
                      *((f"foot held, {name}", run) for name, run in held.items())]:
        if run:
            foot = 1e3 * run.measure("foot_contact_diameter")
            rows.append([name, f"{foot:.3f}", f"{widest(run):.3f}", f"{1e3 * widest_points(run, 'rod'):.3f}",
                         f"{1e3 * run.measure('final_length'):.3f}"])
    study.add("Where the foot stands depends on how it is measured: the diameter of its lowest plane (`foot_contact_diameter`), "
              "the largest diameter of the surface at volume fraction 1/2, or twice the radius of the outermost point "
              "centre. `foot held` has `z_min: symmetry` instead of the unilateral wall: the foot stays flat on the anvil, "
              "as where a finite-element run fixes the axial displacement of the nodes of its lower end.")
    study.add_table(["run", "lowest plane mm", "largest, surface mm", "largest, point centres mm", "length mm"], rows)
    with open(os.path.join(study.folder, "discussion.md"), encoding="utf-8") as file:
        study.add(file.read().strip())


def overlay(study, runs, space):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.5, 6.6), layout="constrained")
    colours = {"2h": "#ff7f0e", "h": "#1f77b4", "h/2": "#2ca02c", "h/4": "#d62728", "3d, h": "#7f7f7f"}
    for name, run in [("3d, h", space), *runs.items()]:
        if run:
            for axes in (left, right):
                outline(axes, run, colors=[colours[name]], linewidths=3 if name == "3d, h" else 1.5)
            left.plot([], [], color=colours[name], lw=3 if name == "3d, h" else 1.5,
                      label=name if "3d" in name else f"{name} = {1e3 * CELLS[name]:.3g} mm")
    marks = {"color": "#d6006c", "lw": 2, "ls": "--"}
    left.plot([-5, 5], [EXPERIMENT["final_length"]] * 2, **marks, label="experiment")
    for axes in (left, right):
        for side in (-0.5, 0.5):
            axes.plot([side * EXPERIMENT["foot_contact_diameter"]] * 2, [0, 0.6], **marks)
            axes.plot([side * EXPERIMENT["w_diameter"]] * 2, [4.8, 5.4], **marks)
        axes.set_xlabel("r [mm]")
        axes.set_ylabel("z [mm]")
    right.set_xlim(3.5, 8)
    right.set_ylim(0, 6)
    right.set_title("foot, right half")
    figure.get_layout_engine().set(rect=(0, 0.06, 1, 0.94))
    figure.legend(*left.get_legend_handles_labels(), loc="lower center", ncol=6, frameon=False)
    figure.suptitle("Outlines (volume fraction 1/2) at 80 µs")
    figure.savefig(os.path.join(study.folder, "outlines.png"), dpi=130)
    plt.close(figure)


def energy(study, runs):
    figure, (top, bottom) = plt.subplots(2, 1, figsize=(9, 7.5), layout="constrained", sharex=True)
    styles = {"h": ":", "h/2": "--", "h/4": "-"}
    for name, run in runs.items():
        if not run or name not in styles:
            continue
        data = run.history()
        t = 1e6 * data["time"]
        for key, colour in (("total_energy", "black"), ("kinetic_energy", "#1f77b4"),
                            ("internal_energy", "#d62728"), ("plastic_work", "#2ca02c")):
            top.plot(t, data[key], color=colour, ls=styles[name], lw=1.5,
                     label=key.replace("_", " ") if name == "h/4" else None)
        bottom.plot(t, 100 * (data["total_energy"] / data["total_energy"][0] - 1), color="black", ls=styles[name],
                    label=f"change of total, {name}")
    top.set_ylabel("energy [J]")
    top.legend(frameon=False)
    bottom.set_ylabel("[% of the start]")
    bottom.set_xlabel("time [µs]")
    bottom.legend(frameon=False)
    figure.suptitle("Energy at h (dotted), h/2 (dashed), h/4 (solid)")
    figure.savefig(os.path.join(study.folder, "energy.png"), dpi=130)
    plt.close(figure)


def measures(study, runs, space, schemes):
    figure, grid = plt.subplots(1, 3, figsize=(13, 4.6), layout="constrained")
    for axes, name in zip(grid, NAMES):
        axes.axhspan(*PEERS[name], color="#ffd9a0", zorder=0, label="three other MPM codes")
        axes.axhline(EXPERIMENT[name], color="#d6006c", ls="--", label="experiment")
        if name == "foot_contact_diameter":
            axes.axhline(FE_FOOT, color="0.4", ls="-.", label="finite elements")
        done = [(1e3 * CELLS[n], 1e3 * run.measure(name)) for n, run in runs.items() if run]
        axes.plot([1e3 * H] * sum(1 for run in schemes.values() if run),
                  [1e3 * run.measure(name) for run in schemes.values() if run], "o", mfc="none", ms=5,
                  color="0.35", label="other schemes, axisymmetric")
        axes.plot(*zip(*done), "s-", color="black", label="axisymmetric")
        if space:
            axes.plot([1e3 * H], [1e3 * space.measure(name)], "D", ms=9, mfc="none", color="#1f77b4", label="3d")
        axes.set_xlim(left=0)
        axes.set_xlabel("cell [mm]")
        axes.set_title(name.replace("_", " ") + " [mm]")
    figure.get_layout_engine().set(rect=(0, 0.08, 1, 0.92))
    figure.legend(*grid[1].get_legend_handles_labels(), loc="lower center", ncol=6, frameon=False)
    figure.savefig(os.path.join(study.folder, "measures.png"), dpi=130)
    plt.close(figure)


def main():
    study = Study(__file__, "inputs/taylor_copper.yaml", ESTIMATED_SECONDS, __doc__)
    runs = {}
    for name, cell in CELLS.items():
        runs[name] = study.run("axisymmetric_" + file_name(name), [f"grid.cell={cell!r}"], SECONDS[name], study.cores)
    plane = study.run("plane_strain", ["frame=plane_strain"], 3, study.cores)
    schemes = study.run_all({"scheme_" + file_name(name): (settings, 4) for name, settings in SCHEMES.items()})
    schemes = dict(zip(SCHEMES, schemes.values()))
    held = {name: study.run("held_" + file_name(name), [f"grid.cell={CELLS[name]!r}", HELD], SECONDS[name], study.cores)
            for name in ("2h", "h", "h/2")}
    jobs, keys = {}, {}
    for cell in ("h", "h/2"):
        for averaging in AVERAGING:
            for fraction in FRACTIONS:
                label = file_name(f"choice_{cell}_{averaging}_{fraction}")
                keys[label] = (cell, averaging, fraction)
                jobs[label] = ([f"grid.cell={CELLS[cell]!r}", *choice(averaging, fraction)], SECONDS[cell])
    choices = {keys[label]: run for label, run in study.run_all(jobs).items()}
    space = study.run("space", ["frame=3d"], 150, study.cores)

    study.add("A cylinder of 25.4 x 7.62 mm hits a rigid frictionless anvil at 190 m/s: "
              "[inputs/taylor_copper.yaml](../../inputs/taylor_copper.yaml), 80 µs. Measures are those of the scene: "
              "length, diameter of the lowest plane of the foot, and W at 0.2 of the initial length from the foot, all "
              "from the surface where the volume fraction is 1/2. `largest` is the largest diameter of that surface: the "
              "rim of the foot curls up from the anvil.")
    refinement(study, runs)
    study.add("![outlines](outlines.png)", "![measures](measures.png)")
    frames(study, runs["h"], space, plane)
    study.add("![final shape, axisymmetric, h/2](final_shape.png)")
    if space:
        study.add("![final shape, 3d, h](final_shape_3d.png)")
    distance(study, runs, space, held)
    spread(study, schemes)
    defaults(study, choices)
    study.add("## Energy", "![energy](energy.png)")
    overlay(study, runs, space)
    energy(study, runs)
    measures(study, runs, space, schemes)
    study.picture(runs["h/2"] or runs["h"], "final_shape.png", "final_shape.png")
    study.picture(space, "final_shape.png", "final_shape_3d.png")
    study.write("Taylor impact of OFHC copper, 190 m/s")


if __name__ == "__main__":
    main()
