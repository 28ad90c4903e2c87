#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Spheres at 3 to 7 km/s: craters in thick aluminium and copper, holes in plates, debris clouds, beside formulas.

Writes README.md and pictures into its folder. `tools/validate hypervelocity` builds first. The same runs for anyone:
`krater study inputs/hypervelocity/craters.yaml` and `holes.yaml`.

A script, not a template: each shot stands beside formulas of its own (formulas.py).
"""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from formulas import ALUMINIUM, COPPER, CRATERS, HOLES, SPHERES  # noqa: E402
from validate_impacts import COST_TITLES, Scale, costs, discussion, shapes, value  # noqa: E402
from validate_runs import Study  # noqa: E402

ESTIMATED_SECONDS = 600  # on two quiet cores

D = 10e-3  # of every sphere [m]
CELLS = {5: 1e-3, 10: 0.5e-3, 20: 0.25e-3}  # cells in the sphere's radius
CARDS = {ALUMINIUM: ("al2024_t351", "al6061_t6", 875, 896), COPPER: ("ofhc_copper", "ofhc_copper", 383, 383)}
SHOTS = [(ALUMINIUM, 3000), (ALUMINIUM, 5000), (ALUMINIUM, 7000), (COPPER, 3000), (COPPER, 5000)]
FINER = (ALUMINIUM, 5000)  # a crater with 20 cells in the radius
PLATES = [(ALUMINIUM, V, t) for V in (4000, 7000) for t in (2e-3, 4e-3, 8e-3)] + \
         [(COPPER, V, t) for V in (3000, 5000) for t in (2e-3, 4e-3)]
NAMES = {ALUMINIUM: "aluminium", COPPER: "copper"}


def settings(metal, speed, hit, cells):
    sphere, target, of_sphere, of_target = CARDS[metal]
    return [f"grid.cell={CELLS[cells]!r}", f"bodies.sphere.velocity=[0, {-speed}]", f"materials.sphere.card={sphere}",
            f"materials.{hit}.card={target}", f"materials.sphere.heating.energy.c_v={of_sphere}",
            f"materials.{hit}.heating.energy.c_v={of_target}"]


def crater(study, metal, speed, cells):
    return study.run(f"crater_{NAMES[metal]}_{speed}_{cells}", [f"title=Crater in {NAMES[metal]}, {speed / 1000:g} km/s",
                     *settings(metal, speed, "block", cells)], {5: 8, 10: 50, 20: 400}[cells], study.cores)


def hole(study, metal, speed, thickness, cells):
    plate = f"bodies.plate.shape.cylinder={{radius: 60 mm, height: {thickness}, base: [0, 0, {-thickness}]}}"
    return study.run(f"hole_{NAMES[metal]}_{speed}_{1e3 * thickness:g}_{cells}",
                     [f"title=Plate of {1e3 * thickness:g} mm {NAMES[metal]}, {speed / 1000:g} km/s", plate,
                      *settings(metal, speed, "plate", cells)], {5: 1, 10: 3, 20: 15}[cells], study.cores)


def off(found, expected):
    """How far beyond the nearest of the formulas, in per cent; 0 among them."""
    if found is None:
        return "-"
    low, high = min(expected), max(expected)
    nearest = low if found < low else high if found > high else found
    return f"{100 * (found / nearest - 1):+.0f}"


def craters(study):
    rows, drawn = [], []
    for metal, speed in SHOTS:
        expected = [law(D, speed, SPHERES[metal], metal) for law in CRATERS.values()]
        runs = {n: crater(study, metal, speed, n) for n in (5, 10, *((20,) if (metal, speed) == FINER else ()))}
        for n, run in runs.items():
            depth = run.measure("depth") if run else None
            rows.append([f"{NAMES[metal]}, {speed / 1000:g} km/s, {n} cells", value(run, "depth", 1e3, 2), value(run, "width", 1e3, 1),
                         *(f"{1e3 * x:.1f}" for x in expected), off(depth, expected), *costs(run)])
        drawn.append((f"{NAMES[metal]}\n{speed / 1000:g} km/s", expected, list(runs.values())[-1], "depth"))
    study.add("## Craters", "A 10 mm sphere on a block 200 mm wide and 120 mm thick ([inputs/hypervelocity/crater.yaml]"
              "(../../inputs/hypervelocity/crater.yaml)): depth and width of the crater at 60 µs, 1 mm below the face. \"Off\" is the "
              "distance to the nearest formula in per cent, 0 between them.")
    study.add_table(["shot, cells in the sphere's radius", "depth mm", "width mm", *(f"{name} mm" for name in CRATERS), "off %",
                     *COST_TITLES], rows)
    return drawn


def holes(study):
    study.use("inputs/hypervelocity/hole.yaml")
    rows, clouds, drawn = [], [], []
    for metal, speed, thickness in PLATES:
        expected = [law(D, thickness, speed, SPHERES[metal], metal) for law in HOLES.values()]
        for n in (5, 10, 20):
            run = hole(study, metal, speed, thickness, n)
            found = run.measure("hole") if run else None
            name = f"{NAMES[metal]}, {1e3 * thickness:g} mm, {speed / 1000:g} km/s, {n} cells"
            rows.append([name, value(run, "hole", 1e3, 2), *(f"{1e3 * x:.1f}" for x in expected), off(found, expected), *costs(run)])
            if n < 20:
                continue
            length, width = (run.measure(k) if run else None for k in ("cloud_length", "cloud_width"))
            clouds.append([name, value(run, "cloud_length", 1e3), value(run, "cloud_width", 1e3),
                           f"{length / width:.2f}" if length and width else "-"])
            drawn.append((f"{NAMES[metal]} {1e3 * thickness:g} mm\n{speed / 1000:g} km/s", expected, run, "hole"))
    study.add("## Holes", "A 10 mm sphere through a plate ([inputs/hypervelocity/hole.yaml](../../inputs/hypervelocity/hole.yaml)): the "
              "narrowest diameter of the hole at 25 µs. Maiden's formula is of aluminium on aluminium.")
    study.add_table(["plate, cells in the sphere's radius", "hole mm", *(f"{name} mm" for name in HOLES), "off %", *COST_TITLES],
                    rows)
    study.add("## Debris clouds", "99 % of the mass below z = -8 mm at 25 µs. Only Hiermaier's shot has a measured one (length to width 1.39; "
              "[hiermaier_al](../hiermaier_al/README.md): 1.31); of copper none is in our sources.")
    study.add_table(["plate", "length mm", "width mm", "length/width"], clouds)
    return drawn


def picture(study, cases, name, what):
    figure, axes = plt.subplots(figsize=(1.2 * len(cases) + 2, 4.2), dpi=110)
    for x, (label, expected, run, measure) in enumerate(cases):
        axes.plot([x, x], [1e3 * min(expected), 1e3 * max(expected)], color="0.75", linewidth=14, solid_capstyle="butt",
                  label="between the formulas" if x == 0 else None)
        for e in expected:
            axes.plot([x - 0.16, x + 0.16], [1e3 * e] * 2, color="0.35", linewidth=1)
        if run and run.measure(measure):
            axes.plot(x, 1e3 * run.measure(measure), "o", color="C3", label="Krater, finest cells" if x == 0 else None)
    axes.set_xticks(range(len(cases)), [case[0] for case in cases], fontsize=8)
    axes.set_ylabel(what)
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False, loc="lower right")
    axes.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(os.path.join(study.folder, name))
    plt.close(figure)
    study.add(f"![{what}]({name})")


def main():
    study = Study(__file__, "inputs/hypervelocity/crater.yaml", ESTIMATED_SECONDS, __doc__)
    deep = craters(study)
    picture(study, deep, "craters.png", "depth of the crater [mm]")
    wide = holes(study)
    picture(study, wide, "holes.png", "diameter of the hole [mm]")

    def strain(run):
        return Scale(run, "plastic_strain", 2)

    shapes(study, {case[0].replace("\n", ", "): case[2] for case in deep}, (10e-6, 60e-6), "shapes.png", strain, [-50, 50, -45, 45],
           "Plastic strain")
    study.add("![shapes](shapes.png)")
    discussion(study)
    study.write("Spheres at 3 to 7 km/s: craters, holes, debris clouds")


if __name__ == "__main__":
    main()
