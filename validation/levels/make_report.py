#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of cells: what an edge between them does to waves, shocks, turning and contact, and what they save.

Writes README.md and pictures into its folder. `tools/validate levels` builds first.
"""

import os
import sys

import h5py
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_impacts import Scale, discussion, shapes, value  # noqa: E402
from validate_runs import Study  # noqa: E402

ESTIMATED_SECONDS = 900  # on two quiet cores
WIDTHS = (6, 10, 12, 14, 20)  # of a pulse, full width at half maximum in fine cells
EDGE = 236                    # of the fine cells; blocks of 8 cells end at 239

BAR = """
frame: plane_strain
grid:
  cell: {cell}
  box: {{min: [0, 0], max: [8, {length}]}}
  boundary: {{x_min: symmetry, x_max: symmetry}}
{refine}time: {{end: {end}, cfl: 0.5}}
method: {{stagger: false, cell_averaging: false}}
materials: {{m: {{density: 1, youngs_modulus: 1 Pa, poisson_ratio: 0, strength: elastic, eos: linear}}}}
bodies:
  bar: {{material: m, shape: {{box: {{min: [-1, -1, 0], max: [9, 1, {length}]}}}},
        velocity: [0, "abs(z-{start})<{width} ? 1e-3*(cos(1.570796326794897*(z-{start})/{width}))^2 : 0"]}}
output: {{frames: {end}}}
"""

# A plane wave at an angle to the edge, from its fine side; free sides reach the middle last.
OBLIQUE = """
frame: plane_strain
grid:
  cell: {cell}
  box: {{min: [-8, -8], max: [328, 360]}}
{refine}time: {{end: 120, cfl: 0.5}}
method: {{stagger: false, cell_averaging: false}}
materials: {{m: {{density: 1, youngs_modulus: 1 Pa, poisson_ratio: 0, strength: elastic, eos: linear}}}}
bodies:
  slab: {{material: m, shape: {{box: {{min: [0, -1, 0], max: [320, 1, 350]}}}},
         velocity: ["{pulse}*{sin}", "{pulse}*{cos}"]}}
output: {{frames: 120}}
"""

# A free bar in its first mode of vibration, its middle at rest; the edge lies there.
RINGING = """
frame: plane_strain
grid:
  cell: {cell}
  box: {{min: [0, -16], max: [8, 144]}}
  boundary: {{x_min: symmetry, x_max: symmetry}}
{refine}time: {{end: 1e4, cfl: 0.5}}
method: {{stagger: false}}
materials: {{m: {{density: 1, youngs_modulus: 1 Pa, poisson_ratio: 0, strength: elastic, eos: linear}}}}
bodies:
  bar: {{material: m, shape: {{box: {{min: [-1, -1, 0], max: [9, 1, 128]}}}},
        velocity: [0, "1e-3*cos(3.141592653589793*z/128)"]}}
output: {{frames: 1e4, history: 100}}
"""

DISC = """
frame: plane_strain
grid:
  cell: 1 mm
  box: {{min: [-24 mm, -24 mm], max: [24 mm, 24 mm]}}
{refine}time: {{end: 1.95 s}}
materials: {{rubber: {{density: 1000, youngs_modulus: 1e3, poisson_ratio: 0.3, strength: neo_hookean}}}}
bodies:
  disc: {{material: rubber, velocity: ["9.67*z", "-9.67*x"],
         shape: {{cylinder: {{radius: 12 mm, height: 1, axis: y, base: [0, -0.5, 0]}}}}}}
output: {{frames: 0.65 s, history: 0.1 s}}
"""

# Two aluminium bars at 1 km/s each way; the front in one of them crosses an edge.
SHOCK = """
frame: plane_strain
grid:
  cell: {cell} mm
  box: {{min: [0, 0], max: [8 mm, 480 mm]}}
  boundary: {{x_min: symmetry, x_max: symmetry, z_min: {{wall: {{friction: 0}}}}}}
{refine}time: {{end: 45 us}}
materials: {{al: {{density: 2703, shear_modulus: 27 GPa, viscosity: {{}},
            strength: {{von_mises: {{yield_stress: 200 MPa}}}},
            eos: {{mie_gruneisen_shock: {{c0: 5350 m/s, S1: 1.34, gamma0: 2}}}}}}}}
bodies: {{bar: {{material: al, shape: {{box: {{min: [-1, -1, 0], max: [1, 1, 480 mm]}}}}, velocity: [0, -1000 m/s]}}}}
output: {{frames: 45 us}}
"""

LANDING = """
frame: plane_strain
grid:
  cell: 1 mm
  box: {{min: [0, 0], max: [48 mm, 48 mm]}}
  boundary: {{z_min: {{wall: {{friction: 0}}}}}}
{refine}time: {{end: 60 us}}
materials: {{metal: {{density: 2700, youngs_modulus: 70 GPa, poisson_ratio: 0.3, strength: elastic,
            eos: {{mie_gruneisen_shock: {{c0: 5350 m/s, S1: 1.34, gamma0: 2}}}}}}}}
bodies: {{block: {{material: metal, velocity: [0, -50 m/s],
         shape: {{box: {{min: [8 mm, -1, {gap} mm], max: [40 mm, 1, {top} mm]}}}}}}}}
output: {{frames: 60 us}}
"""


def rule(low, high, level=1):
    """Lines of the grid: finer cells between two corners."""
    return (f"  refine: [{{region: {{box: {{min: [{low[0]}, {low[1]}], max: [{high[0]}, {high[1]}]}}}}, "
            f"level: {level}}}]\n")


def points(run, body, number=-1):
    """Fields of the points of a body in a frame."""
    folder = os.path.join(run.folder, "frames")
    name = sorted(os.listdir(folder))[number]
    with h5py.File(os.path.join(folder, name)) as file:
        group = file[body]
        return {key: group[key][:] for key in group if isinstance(group[key], h5py.Dataset)}


def per_cent(number, digits=2):
    return f"{100 * number:.{digits}f}"


def pulses(study):
    """A pulse starts 60 cells from the edge and travels 130."""
    schemes = {"fine cells everywhere": (1, ""), "coarse cells everywhere": (2, ""),
               "fine to coarse": (2, rule((0, 0), (8, EDGE))), "coarse to fine": (2, rule((0, 244), (8, 480)))}
    rows = []
    for name, (cell, refine) in schemes.items():
        row = [name]
        for width in WIDTHS:
            text = BAR.format(cell=cell, length=480, refine=refine, end=130, start=180, width=width)
            run = study.run_text(f"pulse_{name.replace(' ', '_')}_{width}", text, 1)
            if not run:
                row += ["-", "-"]
                continue
            found = points(run, "bar")
            z, v = found["coordinates"][:, 2], np.abs(found["velocity"][:, 2]) / 0.5e-3
            near = 2 * width + 8
            row += [per_cent(v[np.abs(z - 170) < near].max()), f"{v[np.abs(z - 310) < near].max():.3f}"]
        rows.append(row)
    study.add("## Waves",
              "A Hann pulse in an elastic bar without lateral contraction (CFL 0.5) meets an edge at normal incidence: "
              "what comes back, in per cent of its amplitude, and what passes, for pulses of 6 to 20 fine cells (full "
              "width at half maximum). Demanded: less than 1 % from 12 cells on. Uniform grids are the background of the "
              "measure; a pulse that passes is flattened by the dispersion of the coarse cells it then travels in.")
    study.add_table(["", *(f"{w} cells: {what}" for w in WIDTHS for what in ("back %", "on"))], rows)


def many_faces(study):
    """Bands of fine cells, a block wide, a block apart."""
    bands = "".join(f"    - {{region: {{box: {{min: [0, {low}], max: [8, {low + 12}]}}}}, level: 1}}\n"
                    for low in (32 * k + 17 for k in range(4, 19)))
    rows = []
    for name, cell, refine in (("coarse cells everywhere", 2, ""),
                               ("15 bands of fine cells: 30 faces", 2, "  refine:\n" + bands)):
        text = BAR.format(cell=cell, length=800, refine=refine, end=560, start=100, width=40)
        run = study.run_text("faces_" + ("none" if not refine else "30"), text, 5)
        if not run:
            continue
        found = points(run, "bar")
        z, v, m = found["coordinates"][:, 2], found["velocity"][:, 2], found["mass"]
        window = np.abs(z - 660) < 120
        rows.append([name, f"{np.abs(v[window]).max() / 0.5e-3:.4f}",
                     f"{1e6 * float(np.sum(0.5 * m[window] * v[window] ** 2)):.4f}", f"{run.error:.1e}"])
    study.add("A pulse of 40 fine cells passes 30 faces, a block (16 fine cells) from each other: demanded, more than "
              "85 % of its energy left.")
    study.add_table(["", "amplitude", "kinetic energy of what arrives µJ", "energy error %"], rows)
    if len(rows) == 2:
        kept = float(rows[1][2]) / float(rows[0][2])
        study.add(f"Of the energy that arrives without faces {100 * kept:.1f} % arrives through them "
                  f"(**{'met' if kept > 0.85 else 'missed'}**).")


def oblique(study):
    """Velocities behind the edge where the mirrored pulse is, in the middle of the slab."""
    angle = np.radians(20)
    n, start, edge, end = np.array([np.sin(angle), np.cos(angle)]), np.array([135.0, 190.0]), 240.0, 120.0
    met = (edge - start[1]) / n[1]  # when its middle line meets the edge above its start
    schemes = {"fine cells everywhere": (1, ""), "fine to coarse": (2, rule((-8, -8), (328, 236)))}
    rows = []
    for name, (cell, refine) in schemes.items():
        row = [name]
        for width in (10, 14):
            across = f"(x*{n[0]:.15g}+z*{n[1]:.15g}-{start @ n:.15g})"
            pulse = f"(abs({across})<{width} ? 1e-3*(cos(1.570796326794897*{across}/{width}))^2 : 0)"
            text = OBLIQUE.format(cell=cell, refine=refine, pulse=pulse, sin=n[0], cos=n[1])
            run = study.run_text(f"oblique_{name.replace(' ', '_')}_{width}", text, 20)
            if not run:
                row.append("-")
                continue
            found = points(run, "slab")
            x, v = found["coordinates"][:, [0, 2]], found["velocity"][:, [0, 2]]
            back = (x - [start[0], edge]) @ [n[0], -n[1]] - (end - met)
            near = (np.abs(back) < 2 * width + 8) & (np.abs(x[:, 0] - start[0] - (end - met) * n[0]) < 25)
            row.append(per_cent(np.hypot(*v[near].T).max() / 0.5e-3))
        rows.append(row)
    study.add("The same pulses at 20 degrees to the edge, in a slab of 320 x 350 fine cells: what comes back, in per cent. "
              "Demanded: less than 1 % from 14 cells on.")
    study.add_table(["", "10 cells %", "14 cells %"], rows)


def followed(study):
    """Fine cells where the pressure of the pulse is, which leaves the region of fine cells it starts in."""
    rows = []
    look = "{{where: {{field: pressure, above: {}}}, level: 1}}"
    start = "{region: {box: {min: [0, 100], max: [8, 236]}}, level: 1}"
    for name, cell, refine in (("fine cells everywhere", 1, ""), ("coarse cells everywhere", 2, ""),
                               ("fine cells that follow it", 2, f"  refine: [{start}, {look.format(1e-8)}]\n"),
                               ("the same, closer to it", 2, f"  refine: [{start}, {look.format(1e-6)}]\n"),
                               ("the same, merged behind it", 2,
                                f"  refine: [{start}, {look.format(1e-6)}]\n  merge: true\n")):
        text = BAR.format(cell=cell, length=480, refine=refine, end=220, start=180, width=12)
        run = study.run_text("followed_" + name.replace(" ", "_"), text, 2)
        if not run:
            continue
        found = points(run, "bar")
        z, v = found["coordinates"][:, 2], np.abs(found["velocity"][:, 2]) / 0.5e-3
        rows.append([name, f"{v[np.abs(z - 400) < 32].max():.5f}", run.summary["points"], f"{run.error:.1e}"])
    study.add("A pulse of 12 fine cells runs 220 of them; where the rules look for its pressure the fine cells go with it. "
              "Demanded: the amplitude of fine cells everywhere to four digits.")
    study.add_table(["", "amplitude", "points at the end", "energy error %"], rows)


def ringing(study):
    rows = []
    for name, cell, refine in (("fine cells everywhere", 1, ""), ("coarse cells everywhere", 2, ""),
                               ("the edge in the middle", 2, rule((0, -16), (8, 62)))):
        run = study.run_text("ringing_" + name.replace(" ", "_"), RINGING.format(cell=cell, refine=refine), 10)
        if not run:
            continue
        data = run.history()
        start = data["total_energy"][0]
        scale = np.sqrt(2 * start * 8 * 128)  # all its energy as that of one motion
        drift = np.abs(data["momentum_z"] - data["momentum_z"][0]).max()
        rows.append([name, run.summary["steps"], per_cent(run.audit("numerical_heat") / start, 3),
                     f"{run.audit('energy_residual') / start:.0e}",
                     f"{drift / scale:.0e}"])
    study.add("A free bar of 128 fine cells in its first mode, its middle at rest: 39 periods.")
    study.add_table(["", "steps", "energy that became heat %", "residual", "change of momentum"], rows)


def discs(study):
    rows = []
    for name, refine, more in (("coarse cells everywhere", "", []), ("fine cells everywhere", "", ["grid.cell=0.5 mm"]),
                               ("half of it in fine cells", rule(("0", "-24 mm"), ("24 mm", "24 mm")), []),
                               ("half of it in fine cells, merged",
                                rule(("0", "-24 mm"), ("24 mm", "24 mm")) + "  merge: true\n", []),
                               ("a box of fine cells in its middle", rule(("-4 mm", "-4 mm"), ("4 mm", "4 mm")), []),
                               ("three levels", rule(("0", "-24 mm"), ("24 mm", "24 mm"), 2), [])):
        run = study.run_text("disc_" + name.replace(" ", "_"), DISC.format(refine=refine), 5, more)
        if not run:
            continue
        data = run.history()
        found = points(run, "disc")
        start, turn = data["total_energy"][0], data["angular_momentum"]
        rows.append([name, per_cent(run.audit("numerical_heat") / start, 3),
                     f"{100 * (turn[-1] / turn[0] - 1):+.3f}", f"{run.audit('energy_residual') / start:.0e}",
                     f"{np.std(found['pressure']) / (1000 * 1.16 ** 2):.4f}", run.summary["points"]])
    study.add("## Turning", "An elastic disc of 24 coarse cells, its rim at 0.1 c, after three turns, so that all its "
              "points pass the edge six times. Demanded: 0.3 % of the energy, 0.05 % of the angular momentum.")
    study.add_table(["", "energy that became heat %", "angular momentum %", "residual", "pressure scatter / rho c²",
                     "points"], rows)


def shocks(study):
    """Against the uniform fine grid: with strength the jump has no closed form as short as this."""
    rows, fine = [], None
    us, up, edge = 5350 + 1.34 * 1000.0, 1000.0, 120.0
    x0 = edge * (1 - up / us)  # where matter of the edge is behind the front
    for name, cell, refine in (("fine everywhere", 0.5, ""), ("coarse everywhere", 1, ""),
                               ("fine to coarse", 1, rule((0, 0), ("8 mm", "118 mm"))),
                               ("coarse to fine", 1, rule((0, "122 mm"), ("8 mm", "480 mm"))),
                               ("three levels, finest to coarsest", 1, rule((0, 0), ("8 mm", "108 mm"), 2))):
        run = study.run_text("shock_" + name.replace(" ", "_").replace(",", ""), SHOCK.format(cell=cell, refine=refine), 5)
        if not run:
            continue
        found = points(run, "bar")
        z, p, e = found["coordinates"][:, 2] * 1e3, found["pressure"], found["internal_energy"]
        behind = (z > 25) & (z < 190)
        away, at = behind & (np.abs(z - x0) > 25), behind & (np.abs(z - x0) < 25)
        means = np.array([p[away].mean(), e[away].mean()])
        fine = means if fine is None else fine
        dose = float(np.sum((e[at] / fine[1] - 1) * found["mass"][at])) / (2703 * 8e-3 * 1e-3)
        rows.append([name, f"{1e-9 * means[0]:.4f}", f"{100 * (means[0] / fine[0] - 1):+.3f}",
                     f"{100 * p[away].std() / means[0]:.2f}", f"{100 * p[at].std() / means[0]:.2f}",
                     f"{100 * (means[1] / fine[1] - 1):+.3f}", f"{dose:+.2f}"])
    study.add("## Shocks", "Aluminium (von Mises, 200 MPa) at 1 km/s against a wall: the front crosses the edge at 120 mm. Away "
              "from it and within 25 mm of the matter that lay at it, beside the uniform fine grid; e at the edge as a dose: "
              "how many coarse cells' worth of the energy behind the front is missing or too much. Demanded: p within 0.1 %, "
              "scatter below 2 %, a dose below 2 cells.")
    study.add_table(["cells", "p GPa", "p %", "scatter away %", "scatter at the edge %", "e %", "dose, coarse cells"], rows)


def walls(study):
    rows = []
    for name, refine in (("coarse cells", ""),
                         ("the edge in the middle of its foot", rule((0, 0), ("22 mm", "48 mm")))):
        for gap in (0, 2):
            run = study.run_text(f"landing_{'edge' if refine else 'none'}_{gap}",
                                 LANDING.format(refine=refine, gap=gap, top=gap + 16), 2)
            if not run:
                continue
            found = points(run, "block")
            m, x, v = found["mass"], found["coordinates"], found["velocity"]
            centre = (m[:, None] * x).sum(0) / m.sum()
            mean = (m[:, None] * v).sum(0) / m.sum()
            r, u = x - centre, v - mean
            spin = np.sum(m * (r[:, 0] * u[:, 2] - r[:, 2] * u[:, 0])) / np.sum(m * (r[:, 0] ** 2 + r[:, 2] ** 2))
            rows.append([name, gap, f"{mean[2]:.4f}", f"{mean[0]:.1e}", f"{spin * 8e-3 / 50:+.4f}",
                         f"{run.audit('energy_residual') / run.audit('initial_energy'):.0e}"])
    study.add("## At a wall", "An elastic block of 32 x 16 mm stands at a wall and is pressed on it at 50 m/s, or "
              "flies there from 2 mm. Its spin after the impact, times its half height, over its speed: a fine half feels "
              "the wall later than a coarse one.")
    study.add_table(["", "from mm", "thrown back at m/s", "sideways m/s", "spin", "residual"], rows)


def taylor(study):
    study.use("inputs/taylor_copper.yaml")
    box = "grid.box={min: [0, 0], max: [12.192 mm, 27.432 mm]}"
    jobs = {"uniform 0.762 mm": ["grid.cell=0.762 mm"], "uniform 0.381 mm": ["grid.cell=0.381 mm"],
            "all at level 1 (planes on knots)": ["grid.cell=0.762 mm", REGION.format("[0, 0]", "[1, 1]", 1)],
            "foot at level 1": ["grid.cell=0.762 mm", REGION.format("[0, 0]", "[1, 8 mm]", 1)],
            "where plastic strain > 0.05":
                ["grid.cell=0.762 mm", "grid.refine=[{where: {field: plastic_strain, above: 0.05}, level: 1}]"],
            "uniform 0.1905 mm": ["grid.cell=0.1905 mm"],
            "foot at level 2": ["grid.cell=0.762 mm", REGION.format("[0, 0]", "[1, 8 mm]", 2)]}
    rows = []
    for name, settings in jobs.items():
        run = study.run("taylor_" + "".join(c if c.isalnum() else "_" for c in name), [box, *settings], 10)
        rows.append([name, value(run, "final_length", 1e3, 3), value(run, "foot_diameter", 1e3, 3),
                     value(run, "w_diameter", 1e3, 3), *cost(run)])
    study.add("## Taylor's rod", "Copper, 190 m/s, axisymmetric, 80 µs. Planes of the domain lie on nodes of a uniform "
              "grid and on knots of a finer level.")
    study.add_table(["cells", "length mm", "foot mm", "W mm", *COSTS], rows)


REGION = "grid.refine=[{{region: {{box: {{min: {}, max: {}}}}}, level: {}}}]"
COSTS = ["points at the end", "steps", "processor s", "energy error %"]


def cost(run):
    if not run:
        return ["failed or left out", "-", "-", "-"]
    return [run.summary["points"], run.summary["steps"], f"{seconds_of(run):.1f}", f"{run.error:.2f}"]


def seconds_of(run):
    return run.summary["machine"]["processor_seconds"]


def impacts(study):
    """{picture: {name: run}} of the scenes that levels are for."""
    drawn = {}
    cases = {
        "ccf_plugging": ("Plugging (Børvik's plate, 298 m/s), axisymmetric", 0.5, "residual_velocity",
                         {"uniform 0.32 mm": [], "uniform 0.64 mm": ["grid.cell=0.64 mm"],
                          "0.64 mm, level 1 in r < 20, z < 32 mm":
                              ["grid.cell=0.64 mm", REGION.format("[0, -80 mm]", "[20 mm, 32 mm]", 1)],
                          "1.28 mm, level 2 in r < 14, z < 20 mm":
                              ["grid.cell=1.28 mm", REGION.format("[0, -40 mm]", "[14 mm, 20 mm]", 2)]}),
        "hiermaier_al": ("Aluminium sphere at 6.18 km/s on a 4 mm plate, axisymmetric", 0.5, "crater",
                         {"uniform 0.25 mm": [], "uniform 0.5 mm": ["grid.cell=0.5 mm"],
                          "0.5 mm, level 1 in r < 20 mm":
                              ["grid.cell=0.5 mm", REGION.format("[0, -140 mm]", "[20 mm, 60 mm]", 1)],
                          "0.5 mm, level 1 in r < 20, z > -12 mm":
                              ["grid.cell=0.5 mm", REGION.format("[0, -12 mm]", "[20 mm, 60 mm]", 1)],
                          "0.5 mm, level 1 in r < 16, -6 < z < 12 mm":
                              ["grid.cell=0.5 mm", REGION.format("[0, -6 mm]", "[16 mm, 12 mm]", 1)],
                          "the same, merged":
                              ["grid.cell=0.5 mm", REGION.format("[0, -6 mm]", "[16 mm, 12 mm]", 1), "grid.merge=true"]}),
        "spear_plate": ("Spear's cylinder on a plate at 970 m/s, 3D, a quarter, to 30 µs", 0.2, "residual_velocity",
                        {"uniform 1.015 mm": ["grid.cell=1.015 mm"], "uniform 2.03 mm": [],
                         "2.03 mm, level 1 within 24 mm":
                             [REGION.format("[-24 mm, -24 mm, -60 mm]", "[24 mm, 24 mm, 40 mm]", 1)],
                         "4.06 mm, level 2 within 16 mm":
                             ["grid.cell=4.06 mm",
                              REGION.format("[-16 mm, -16 mm, -60 mm]", "[16 mm, 16 mm, 40 mm]", 2)]})}
    quarter = ["grid.box={min: [0, 0, -60.9 mm], max: [121.8 mm, 101.5 mm, 40.6 mm]}",
               "grid.boundary.x_min=symmetry", "grid.boundary.y_min=symmetry", "time.end=30 us", "output.frames=15 us"]
    study.add("## What it saves", "One thread each, dormancy on. Demanded: the accuracy of the uniform fine grid at half "
              "its time in 2D and a fifth in 3D.")
    for scene, (title, goal, measure, jobs) in cases.items():
        study.use(f"inputs/{scene}.yaml")
        more = {"spear_plate": quarter, "ccf_plugging": ["output.frames=50 us"]}.get(scene, ["output.frames=5 us"])
        runs = {name: study.run(f"{scene}_" + "".join(c if c.isalnum() else "_" for c in name),
                                [*more, *settings], 100) for name, settings in jobs.items()}
        drawn[scene] = runs
        names = [m for m in next(r for r in runs.values() if r).summary["measures"]][:4]
        study.add(f"### {title}")
        fine = next(iter(runs.values()))
        study.add_table(["cells", *names, *COSTS, "time over uniform fine"],
                        [[name, *(f"{run.measure(m):.5g}" if run and run.measure(m) is not None else "-" for m in names),
                          *cost(run), f"{seconds_of(run) / seconds_of(fine):.2f}" if run and fine else "-"]
                         for name, run in runs.items()])
        study.add(f"Goal: {goal:g} of the time.")
    return drawn


def main():
    study = Study(__file__, "inputs/taylor_copper.yaml", ESTIMATED_SECONDS, __doc__)
    pulses(study)
    oblique(study)
    many_faces(study)
    followed(study)
    ringing(study)
    discs(study)
    shocks(study)
    walls(study)
    taylor(study)
    drawn = impacts(study)
    discussion(study)

    def strain(run):
        return Scale(run, "plastic_strain", 1.5)

    def levels(run):
        return Scale(run, "level", 2)

    plug = {name: run for name, run in drawn["ccf_plugging"].items() if "level" in name}
    shapes(study, {**{k: v for k, v in drawn["ccf_plugging"].items() if "0.32" in k}, **plug}, (50e-6, 100e-6),
           "plugging.png", strain, [-40, 40, -45, 45], "Plastic strain")
    shapes(study, plug, (0.0, 100e-6), "plugging_levels.png", levels, [-40, 40, -45, 85],
           "Level of the cells about each point")
    plates = drawn["spear_plate"]
    shapes(study, {k: v for k, v in plates.items() if k != "uniform 2.03 mm"}, (15e-6, 30e-6), "plate.png", strain,
           [-50, 50, -45, 28], "Plastic strain, section y = 0")
    study.add("![plugging](plugging.png)", "![levels](plugging_levels.png)", "![plate](plate.png)")
    study.write("Levels of cells: what an edge does, and what they save")


if __name__ == "__main__":
    main()
