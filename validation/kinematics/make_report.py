#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The same problems with points, elements, particles, and mixed: bars, Taylor, plugging, Spear's plate.

Writes README.md and pictures into its folder. `tools/validate kinematics` builds first.

A script, not a template: it reads gauges and asks some thirty scenes, of which each is run once.
"""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_impacts import Scale, discussion, histories, shapes, value  # noqa: E402
from validate_runs import Study  # noqa: E402

ESTIMATED_SECONDS = 1700  # on two quiet cores

COSTS = ["points, elements at the end", "steps", "unphysical energy %", "hourglass share %", "processor seconds"]
TAYLOR = {10: ("0.381 mm", 1), 20: ("0.1905 mm", 6), 40: ("0.09525 mm", 45)}
# Quarters in 3d, by the spacing of particles and points [mm]; cells are two of them.
TAYLOR_QUARTER = {5: (0.762, 2), 10: (0.381, 20), 20: (0.1905, 320)}
PLUGGING_QUARTER = {5: (1.6, 10), 10: (0.8, 180)}
SPEAR_QUARTER = {6: (2.03, 20), 12: (1.015, 300)}
PLUGGING = {10: ("0.8 mm", 5), 20: ("0.4 mm", 30)}
SPEAR = {6: ("2.1167 mm", 1), 12: ("1.0583 mm", 4), 24: ("0.52917 mm", 25)}
ROUND = ["frame=axisymmetric", "grid.box={min: [0, -60 mm], max: [125 mm, 40 mm]}",
         "bodies.plate.shape={cylinder: {radius: 101.5 mm, height: 12.7 mm, base: [0, 0, -12.7 mm]}}",
         "bodies.projectile.velocity=[0, -970 m/s]"]
HELD = "  boundary: {y_min: sticky, y_max: sticky}"
QUARTER = ["grid.box={min: [0, 0, -60 mm], max: [121.8 mm, 101.5 mm, 40 mm]}",
           "grid.boundary.x_min=symmetry", "grid.boundary.y_min=symmetry"]
BARS = """frame: plane_strain
title: Two elastic bars
grid: {{cell: {cell} mm, box: {{min: [0, -50 mm], max: [2 mm, 50 mm]}}, boundary: {{x_min: symmetry, x_max: symmetry}}}}
time: {{end: 17.9 us, energy_error: off}}
materials: {{metal: {{density: 8000, youngs_modulus: 200 GPa, poisson_ratio: 0.3, eos: linear, strength: elastic}}}}
contact: {{friction: 0}}
bodies:
  striker: {{material: metal, shape: {{box: {{min: [0, {low} mm], max: [2 mm, {place} mm]}}}}, velocity: [0, 58.02 m/s]{a}}}
  target: {{material: metal, shape: {{box: {{min: [0, {place} mm], max: [2 mm, {high} mm]}}}}{b}}}
measures: {{target_velocity: {{kind: mean_velocity, body: target, axis: z}}}}
"""
GAUGES = ("gauges={edge: {body: plate, at: [8.35 mm, 0], fields: [plastic_strain], every: 0.1 us}, "
          "front: {body: projectile, at: [0, 0], fields: [velocity_z, strain_zz], every: 0.1 us}, "
          "rear: {body: projectile, at: [0, 24.7 mm], fields: [strain_zz], every: 0.1 us}}")


def elements(body, erode="", size="", reference="current", action="erode"):
    parts = [f"reference: {reference}", *([f"element: {size}"] if size else []),
             *([f"failure: {{action: {action}, when: {{{erode}}}}}"] if erode else [])]
    return f"bodies.{body}.kinematics={{lagrangian_mesh: {{{', '.join(parts)}}}}}"


def particles(body, spacing):
    return f"bodies.{body}.kinematics={{sph: {{spacing: {spacing} mm}}}}"


def costs(run):
    if run is None:
        return ["failed or left out"] + ["-"] * (len(COSTS) - 1)
    share = run.summary["audit"].get("hourglass_share")
    return [run.summary["points"], run.summary["steps"], f"{run.error:.2f}",
            "-" if share is None else f"{100 * share:.1f}", f"{run.summary['machine']['processor_seconds']:.1f}"]


def speed_at(run, time):
    if run is None:
        return "-"
    history = run.history()
    speed = -np.interp(time, history["time"], history["projectile_velocity"])
    return f"{speed:.0f}" if np.isfinite(speed) else "no element left"


def eroded(run):
    if run is None or "eroded_elements" not in run.summary["audit"]:
        return "-"
    audit = run.summary["audit"]
    word = "converted" if audit["converted_elements"] else "eroded"
    causes = [f"{n} {name}" for name, n in audit.get(f"{word}_by", {}).items() if n]
    return f"{audit[f'{word}_elements']}" + (" to points" if word == "converted" else "") + (
        f" ({', '.join(causes)})" if len(causes) > 1 else "")


def gauge(run, name, field):
    """Times [s] and values of a gauge's field."""
    path = os.path.join(run.folder, f"gauge_{name}.csv")
    with open(path, encoding="utf-8") as file:
        titles = [title.split(" ")[0].strip('"') for title in next(file).split(",")]
    table = np.genfromtxt(path, delimiter=",", skip_header=1)
    return table[:, 0], table[:, titles.index(field)]


def spear_figures(runs):
    """What SPEAR's Figures 12 to 17 draw, all models in one picture."""
    figure, grid = plt.subplots(2, 3, figsize=(15, 8), layout="constrained")
    axes = grid.ravel()
    for name, run in runs.items():
        if run is None:
            continue
        history = run.history()
        for panel, gauge_name, field, sign in ((0, "front", "velocity_z", -1), (2, "edge", "plastic_strain", 1),
                                               (3, "front", "strain_zz", 1), (4, "rear", "strain_zz", 1)):
            time, values = gauge(run, gauge_name, field)
            axes[panel].plot(1e6 * time, sign * values, label=name, lw=1)
        time = np.linspace(0, history["time"][-1], 601)
        speed = -np.interp(time, history["time"], history["projectile_velocity"])
        axes[1].plot(1e6 * time, np.gradient(np.convolve(np.pad(speed, 5, "edge"), np.ones(11) / 11, "valid"), time) / 1e6, label=name, lw=1)
        line, = axes[5].plot(1e6 * history["time"], 1e-3 * history["kinetic_energy"], label=name, lw=1)
        axes[5].plot(1e6 * history["time"], 1e-3 * history["internal_energy"], "--", color=line.get_color(), lw=1)
    titles = ("12: velocity of the projectile's front, on the axis [m/s]", "13: acceleration of the projectile, mean over 1 µs [10^6 m/s^2]",
              "14: plastic strain of the plate at the edge of contact", "15: strain of the front face, on the axis, ln(l/l0)",
              "16: strain of the rear face, on the axis, ln(l/l0)", "17: kinetic (full) and internal (dashed) energy [kJ]")
    for panel, title in zip(axes, titles):
        panel.set_title(title, fontsize=10)
        panel.set_xlabel("time [µs]")
        panel.grid(alpha=0.3)
    axes[0].legend(fontsize=8)
    figure.savefig(os.path.join(os.path.dirname(os.path.abspath(__file__)), "spear_figures.png"), dpi=110)
    plt.close(figure)


def bars(study):
    here = ", kinematics: {lagrangian_mesh: {element: 1 mm}}"
    rows = []
    for a, b in (("elements", "elements"), ("elements", "points"), ("points", "elements"), ("points", "points")):
        for cell in (0.5, 1):
            taken, heat = [], []
            for place in (0, 0.3, 0.5, 0.7):
                text = BARS.format(cell=cell, place=place, low=place - 40, high=place + 40,
                                   a=here if a == "elements" else "", b=here if b == "elements" else "")
                run = study.run_text(f"bars_{a}_{b}_{cell}_{place}".replace(".", "_"), text, 1)
                if run:
                    taken.append(run.measure("target_velocity") / 58.02)
                    heat.append(100 * run.audit("contact_heat") / run.summary["audit"]["initial_energy"])
            rows.append([f"{a} on {b}, cell {cell} element", f"{min(taken):.3f} to {max(taken):.3f}",
                         f"{min(heat):.2f} to {max(heat):.2f}"])
    study.add("## Two elastic bars", "A bar of 40 elements of 1 mm meets its like end on at a hundredth of the wave's speed; the joint at "
              "four places of its cell. Exact: the target takes 1 and nothing is lost; the dispersion of the elements alone leaves 0.99.")
    study.add_table(["bars", "target takes", "contact takes of the energy %"], rows)


def taylor(study):
    study.use("inputs/taylor_copper.yaml")
    rows, finest = [], {}
    for n, (cell, seconds) in TAYLOR.items():
        for name, more in (("points", []), ("elements", [elements("rod")]),
                           ("elements, initial reference", [elements("rod", reference="initial")])):
            run = study.run(f"taylor_{name.split(',')[0]}_{'initial' if 'initial' in name else 'current'}_{n}",
                            [f"grid.cell={cell}", *more], seconds)
            rows.append([f"{name}, {n} on the radius", value(run, "final_length", 1e3, 3), value(run, "w_diameter", 1e3, 3),
                         value(run, "foot_diameter", 1e3, 3), value(run, "foot_contact_diameter", 1e3, 3), *costs(run)])
            finest[name] = run
    study.add("## Taylor impact, copper at 190 m/s",
              "[inputs/taylor_copper.yaml](../../inputs/taylor_copper.yaml), axisymmetric, frictionless anvil, one thread.")
    study.add_table(["run", "length mm", "W mm", "foot mm", "lowest plane mm", *COSTS], rows)
    rows.clear()
    study.use("inputs/taylor_copper_sph.yaml")
    for n, (spacing, seconds) in TAYLOR_QUARTER.items():
        cell = [f"grid.cell={2 * spacing} mm", "measures.foot_contact_diameter={kind: diameter, body: rod, at: {from_lower_end: 0}}"]
        for name, more in (("particles", [particles("rod", spacing)]), ("points", ["bodies.rod.kinematics=mpm"])):
            run = study.run(f"taylor_quarter_{name}_{n}", [*cell, *more], seconds)
            rows.append([f"{name}, {n} on the radius", value(run, "final_length", 1e3, 3), value(run, "w_diameter", 1e3, 3),
                         value(run, "foot_diameter", 1e3, 3), value(run, "foot_contact_diameter", 1e3, 3), *costs(run)])
    study.add("A quarter in 3d ([inputs/taylor_copper_sph.yaml](../../inputs/taylor_copper_sph.yaml)), for particles know no axial symmetry; "
              "points two to the cell, so that n points, not n cells, lie on the radius.")
    study.add_table(["run", "length mm", "W mm", "foot mm", "lowest plane mm", *COSTS], rows)
    shapes(study, finest, (20e-6, 80e-6), "taylor.png", lambda run: Scale(run, "plastic_strain", 2.0), [-8, 8, 0, 26],
           "Plastic strain, 40 on the radius")
    study.add("![taylor](taylor.png)")


def plugging(study):
    study.use("inputs/ccf_plugging.yaml")
    erode = "failed: true, jacobian: 0.05"
    rows, finest = [], {}
    for n, (cell, seconds) in PLUGGING.items():
        for name, more in (("points", []), ("elements", [elements("plate", erode), elements("projectile")]),
                           ("projectile of elements, plate of points", [elements("projectile")])):
            run = study.run(f"plugging_{name.split()[0]}_{n}", [f"grid.cell={cell}", *more], seconds)
            rows.append([f"{name}, {n} through the plate", value(run, "residual_velocity", -1),
                         value(run, "hole", 1e3, 2), value(run, "mass_lost", 1e3, 2), eroded(run), *costs(run)])
            finest[name] = run
    study.add("## Plugging of a Weldox plate, 298 m/s",
              "[inputs/ccf_plugging.yaml](../../inputs/ccf_plugging.yaml): experiment 241.4 m/s; with points 236 and 238 m/s at 40 and 80 cells "
              "(../ccf_plugging). Elements erode when they fail, or when a corner has collapsed.")
    study.add_table(["run", "residual velocity m/s", "hole mm", "failed mass g", "eroded", *COSTS], rows)
    rows.clear()
    quarter = ["frame=3d", "grid.box={min: [0, 0, -40 mm], max: [105.6 mm, 105.6 mm, 88 mm]}",
               "grid.boundary={x_min: symmetry, y_min: symmetry}", "bodies.projectile.velocity=[0, 0, -298 m/s]",
               "bodies.plate.shape={cylinder: {radius: 100 mm, height: 8 mm, base: [0, 0, -8 mm]}}", "time.end=60 us"]
    for n, (spacing, seconds) in PLUGGING_QUARTER.items():
        here = [f"grid.cell={2 * spacing} mm", *quarter]
        for name, more in (("particles", [particles(body, spacing) for body in ("plate", "projectile")]),
                           ("projectile of elements, plate of particles",
                            [particles("plate", spacing), elements("projectile", size=f"{spacing} mm")]),
                           ("points", [])):
            run = study.run(f"plugging_quarter_{name.replace(', ', ' ').replace(' ', '_')}_{n}", [*here, *more], seconds)
            rows.append([f"{name}, {n} through the plate", value(run, "residual_velocity", -1),
                         value(run, "hole", 1e3, 2), value(run, "mass_lost", 1e3, 2), eroded(run), *costs(run)])
    study.add("A quarter in 3d of a plate of 200 mm (free at its edge; waves come back from there after 30 µs), to 60 µs; n particles or "
              "points, not cells, through the plate. Failed particles stay, without tension.")
    study.add_table(["run", "residual velocity m/s", "hole mm", "failed mass g", "eroded", *COSTS], rows)
    shapes(study, finest, (20e-6, 60e-6, 100e-6), "plugging.png", lambda run: Scale(run, "plastic_strain", 1.0),
           [-30, 30, -35, 60], "Plastic strain, 20 through the plate")
    study.add("![plugging](plugging.png)")


def spear(study):
    study.use("inputs/spear_plate.yaml")
    rows, drawn = [], {}

    def add(name, label, settings, seconds, without=(HELD,)):
        run = study.run(f"spear_{label}", settings, seconds, without=list(without))
        rows.append([name, speed_at(run, 12e-6), speed_at(run, 60e-6), eroded(run), *costs(run)])
        return run

    def both(erode, size="", action="erode"):
        return [elements("plate", erode, size, action=action), elements("projectile", erode, size, action=action)]

    kept = "plastic_strain: 1.0, jacobian: 0.05"
    for n, (cell, seconds) in SPEAR.items():
        here = [f"grid.cell={cell}", *ROUND, GAUGES]
        models = {"points": ([], "points"), "elements": (both(kept), "elements"),
                  "projectile of elements, plate of points": ([elements("projectile", kept)], "mixed"),
                  "points removed when they fail": (["materials.aluminium.failure.action=remove"], "removed"),
                  "elements eroded when they fail": (both("failed: true, jacobian: 0.05"), "failed"),
                  "elements that become points": (both(kept, action="convert"), "converted"),
                  "elements that become points when they fail": (both("failed: true, jacobian: 0.05", action="convert"), "converted_failed")}
        for name, (settings, label) in models.items():
            run = add(f"{name}, {n} through the plate", f"{label}_{n}", [*here, *settings], seconds)
            if n == 12:
                drawn[name] = run
    study.add("## A 6061-T6 cylinder on a plate, 970 m/s",
              "[inputs/spear_plate.yaml](../../inputs/spear_plate.yaml) in axial symmetry (free round plate). Velocity of the whole projectile at "
              "12 µs, when the paper reads it and the projectile is still in the plate, and at 60 µs. Elements erode at a plastic "
              "strain of 1, as the paper's, or when a corner has collapsed (0.05).")
    titles = ["run", "12 µs m/s", "60 µs m/s", "eroded", *COSTS]
    study.add_table(titles, rows)
    shapes(study, drawn, (12e-6, 36e-6, 60e-6), "spear.png", lambda run: Scale(run, "plastic_strain", 1.0),
           [-35, 35, -45, 28], "Plastic strain, 12 through the plate")
    histories(study, drawn, {"projectile_velocity": "whole projectile"}, "spear_velocities.png", "velocity [m/s]", -1.0)
    spear_figures(drawn)
    study.add("![spear](spear.png)", "![velocities](spear_velocities.png)",
              "What SPEAR's Figures 12 to 17 draw, by our models at 12 through the plate (its curves are pictures, and not copied):",
              "![figures](spear_figures.png)")

    rows.clear()
    cell, seconds = SPEAR[12]
    here = [f"grid.cell={cell}", *ROUND]
    for mu in (0.1, 0.2, 0.3):
        add(f"friction {mu}", f"friction_{mu}".replace(".", "_"), [*here, *both(kept), f"contact.friction={mu}"], seconds)
    for strain in (0.3, 0.5, 2.0):
        add(f"erosion at {strain}", f"strain_{strain}".replace(".", "_"),
            [*here, *both(f"plastic_strain: {strain}, jacobian: 0.05")], seconds)
    add("erosion of collapsed elements only", "collapsed", [*here, *both("jacobian: 0.05")], seconds)
    add("eroded at a corner of 0.2", "corner", [*here, *both("plastic_strain: 1.0, jacobian: 0.2")], seconds)
    add("no damage law", "no_damage", [*here, *both(kept)], seconds, (HELD, "    damage: card"))
    for name, label, settings in (
            ("velocity at the start on the rear nodes only", "rear_nodes", ['bodies.projectile.velocity=[0, "-970*(z>0.0242)"]']),
            ("velocity on the rear face at all times, from rest", "rear_driven",
             ["bodies.projectile.velocity=[0, 0]", "loads={drive: {body: projectile, face: z_max, velocity: [free, -970 m/s]}}"]),
            ("velocity on all nodes, and on the rear face at all times", "all_driven",
             ["loads={drive: {body: projectile, face: z_max, velocity: [free, -970 m/s]}}"])):
        add(name, label, [*here, *both(kept), *settings], seconds)
    study.add("What moves it, elements at 12 through the plate, friction 0 and erosion at 1 where not said:")
    study.add_table(titles, rows)

    rows.clear()
    mesh = [elements("plate", kept, "2.03 mm"), elements("projectile", kept, "0.88 mm")]
    add("elements, full", "full", [*mesh, "output.frames=12 us"], 60, ())
    add("elements, a quarter", "quarter", [*mesh, *QUARTER, "output.frames=12 us"], 15, ())
    study.add("In 3D, the paper's sizes: 2.03 mm in the plate (6 through it), 0.88 mm in the projectile, an O-grid; plate held at two edges.")
    study.add_table(titles, rows)

    rows.clear()
    for n, (spacing, seconds) in SPEAR_QUARTER.items():
        here = [f"grid.cell={2 * spacing} mm", *QUARTER, "output.frames=12 us"]
        for name, label, more in (
                ("projectile of elements, plate of particles", "mixed", [particles("plate", spacing),
                                                                         elements("projectile", kept, f"{spacing} mm")]),
                ("both of particles", "particles", [particles("plate", spacing), particles("projectile", spacing)]),
                ("points", "points", [])):
            add(f"{name}, {n} through the plate", f"quarter_{label}_{n}", [*here, *more], seconds, ())
    study.add("The same quarter with the paper's mixed model, a target of particles and a projectile of elements, with particles "
              "alone and with points alone; n particles or points, not cells, through the plate, elements of that size. Failed particles stay, without tension.")
    study.add_table(titles, rows)


def main():
    study = Study(__file__, "inputs/taylor_copper.yaml", ESTIMATED_SECONDS, __doc__)
    study.add("One set of materials, one contact law, one account of energy: what does the kinematics alone change, and what does it cost? "
              "Points (`kinematics: mpm`), elements (`lagrangian_mesh`), particles (`sph`), and two of them in one scene. One thread everywhere.")
    bars(study)
    taylor(study)
    plugging(study)
    spear(study)
    discussion(study)
    study.write("Kinematics: points, elements and particles")


if __name__ == "__main__":
    main()
