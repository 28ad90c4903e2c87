# SPDX-License-Identifier: GPL-3.0-or-later
"""How wide softening spreads on the grid: a bar with a weak cell is pulled until it parts.

Laws with a fracture energy take the cell as that width. The work of the bar per area, over that of one point along the same
path (uniaxial strain) times the cell, is by how many cells it really spreads, where the work of the bar is spent slowly.
"""

import numpy as np

SPEED = 0.05  # m/s at the end of the bar
LAWS = {
    "HJC, fracture_energy 68 J/m^2": (
        "card: concrete_snl_conventional, rate: jaumann, model: {{holmquist_johnson_cook: {{fracture_energy: 68 J/m^2, "
        "tensile_strength: {} MPa}}}}", 3.887, 3.7),
    "K&C 39.3 MPa": ("card: {{concrete: {{fc: {} MPa, model: karagozian_case}}}}, density: 2243, rate: jaumann, "
                     "model: {{karagozian_case: {{rate_factor: none}}}}", 39.3, 37.5)}
KERNELS = {"2 points": "", "3 points": "points_per_direction: 3", "4 points": "points_per_direction: 4",
           "gimp, 2 points": "shape: gimp", "apic, 2 points": "transfer: apic"}
BARS = ((1e-3, 32), (2.5e-3, 32), (2.5e-3, 12))  # cell m, cells

BAR = """
frame: plane_strain
grid:
  cell: {cell}
  box: {{min: [0, 0], max: [{width}, {top}]}}
  boundary: {{x_min: symmetry, x_max: symmetry, z_min: sticky}}
time: {{end: {end}, energy_error: off}}
method: {{{method}}}
materials: {{sound: {{{sound}}}, weak: {{{weak}}}}}
bodies:
  low: {{material: sound, shape: {{box: {{min: [-1, -1, 0], max: [1, 1, {low}]}}}}}}
  middle: {{material: weak, thin: allowed, shape: {{box: {{min: [-1, -1, {low}], max: [1, 1, {high}]}}}}}}
  upper: {{material: sound, shape: {{box: {{min: [-1, -1, {high}], max: [1, 1, {length}]}}}}}}
loads: {{pull: {{body: upper, face: z_max, velocity: [free, {speed}]}}}}
output: {{frames: {end}, history: {every}}}
"""


def work_of_point(study, name, material, cell):
    """[J/m^2] of one point, times the cell."""
    strain = min(0.2, 3e-4 / cell)
    point = study.point(f"spread_point_{name}_{1e3 * cell:g}",
                        f"materials: {{m: {{{material}}}}}\npoint: {{path: {{uniaxial_strain: {{strain: {strain}, rate: 20}}}}, "
                        f"steps: 20000, length: {cell}}}\n")
    return cell * float(np.trapz(point["stress_xx"], np.exp(point["strain_xx"]))) if point else None


def add(study):
    rows = []
    for law, (text, strong, weak) in LAWS.items():
        short = law.split()[0].strip(",").replace("&", "")
        for cell, cells in BARS:
            row = [f"{law}: {cells} cells of {1e3 * cell:g} mm"]
            expected = work_of_point(study, short, text.format(weak), cell)
            for k, method in enumerate(KERNELS.values()):
                low = (cells / 2 - 0.5) * cell
                run = study.run_text(f"spread_{short}_{1e3 * cell:g}_{cells}_{k}", BAR.format(
                    cell=cell, width=2 * cell, top=(cells + 3) * cell, end=5e-3, every=2.5e-5, method=method, low=low, high=low + cell,
                    length=cells * cell, speed=SPEED, sound=text.format(strong), weak=text.format(weak)), 20)
                spent = run.audit("external_work") / (2 * cell) if run else None
                row.append(f"{spent / expected:.2f}" if spent and expected else "-")
            rows.append(row)
    study.add("## How wide softening spreads", "A bar with one cell 5 % weaker is pulled at 0.05 m/s until it parts: its work over that of one point times the "
              "cell, which would be 1 if softening kept to a cell as the laws suppose. **It is no constant of the kernel**: it depends on the law, on the points "
              "in a cell and on how suddenly the bar parts, so that no factor stands in the code: the fracture energy of a run is that of the law times "
              "a number of this table.")
    study.add_table(["bar", *KERNELS], rows)
