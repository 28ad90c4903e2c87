# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of the benchmark suite, as YAML text."""

COPPER = {
    "base": "density: 8960, shear_modulus: 46 GPa, bulk_modulus: 129 GPa, initial_temperature: 294 K",
    "eos": "eos: {mie_gruneisen_shock: {c0: 3940 m/s, S1: 1.489, gamma0: 2.02}}",
    "strength": "strength: {johnson_cook: {A: 90 MPa, B: 292 MPa, n: 0.31, C: 0.025, epsdot0: 1 s^-1, m: 1.09, "
                "T_ref: 294 K, T_melt: 1356 K}}",
    "heating": "heating: {plastic_work: {fraction: 0.9, cp: 383 J/(kg K)}}",
    "viscosity": "viscosity: {q_lin: 0.3, q_quad: 2.0}",
}
ALUMINIUM = ("density: 2785, shear_modulus: 27.6 GPa, eos: {mie_gruneisen_shock: {c0: 5328 m/s, S1: 1.338, "
             "gamma0: 2.0}}, strength: {von_mises: {Y: 0.3 GPa, H: 0}}, viscosity: {q_lin: 0.3, q_quad: 2.0}")
H = 0.381e-3  # 10 cells on the radius of the rod: 168,692 points in 3d


def taylor(frame="3d", cell=H, without=(), replace=None, method="", kinematics="mpm", quarter=False):
    """The rod of inputs/taylor_copper.yaml (same constants), some effects left out or replaced."""
    parts = dict(COPPER, **(replace or {}))
    copper = ", ".join(text for name, text in parts.items() if name not in without)
    sides = "x_min: symmetry, y_min: symmetry" if quarter else "r_min: axis, r_max: open, z_max: open"
    box = "min: [0, 0, 0], max: [12 mm, 12 mm, 27 mm]" if quarter else "min: [0, 0], max: [12 mm, 27 mm]"
    return f"""title: Taylor impact
frame: {frame}
grid:
  cell: {cell!r}
  box: {{{box}}}
  boundary: {{z_min: {{wall: {{friction: 0}}}}, {sides}}}
time: {{end: 80 us, cfl: 0.5}}
method: {{points_per_direction: 2{method}}}
materials: {{copper: {{{copper}}}}}
bodies: {{rod: {{material: copper, shape: {{cylinder: {{radius: 3.81 mm, height: 25.4 mm}}}}, velocity: {"[0, 0, -190 m/s]" if quarter else "[0, -190 m/s]"}, kinematics: {kinematics}}}}}
"""


def elastic(frame="3d", cell=H, end="80 us"):
    """One effect: a linear elastic rod, without viscosity, heating, cell averages."""
    return f"""title: Elastic rod
frame: {frame}
grid: {{cell: {cell!r}, box: {{min: [0, 0], max: [12 mm, 27 mm]}}, boundary: {{z_min: symmetry, r_min: axis}}}}
time: {{end: {end}, cfl: 0.5}}
materials: {{metal: {{density: 8960, shear_modulus: 46 GPa, bulk_modulus: 129 GPa, eos: linear, strength: elastic}}}}
bodies: {{rod: {{material: metal, shape: {{cylinder: {{radius: 3.81 mm, height: 25.4 mm}}}}, velocity: [0, -1 m/s]}}}}
"""


def hypervelocity():
    """A block that flies at 7 km/s obliquely into a plane: some 30 % of the points change cell in a step."""
    return f"""title: Hypervelocity impact
frame: 3d
grid:
  cell: 0.5 mm
  box: {{min: [-40 mm, -40 mm, 0], max: [40 mm, 40 mm, 60 mm]}}
  boundary: {{z_min: symmetry}}
time: {{end: 20 us, cfl: 0.6}}
materials: {{aluminium: {{{ALUMINIUM}}}}}
bodies:
  block:
    material: aluminium
    shape: {{box: {{min: [-5 mm, -5 mm, 0], max: [5 mm, 5 mm, 30 mm]}}}}
    velocity: [3 km/s, 3 km/s, -7 km/s]
"""


def flow(speed):
    """A block in free flight along the diagonal of two axes; dormant blocks off, so that rest costs what it
    costs; points at random, so that they do not all cross in the same step."""
    return f"""title: Uniform flow
frame: 3d
grid: {{cell: 0.5 mm, box: {{min: [-20 mm, -20 mm, -20 mm], max: [120 mm, 120 mm, 40 mm]}}}}
time: {{end: 20 us, cfl: 0.5}}
method: {{dormant_blocks: false, jitter: 0.5}}
materials: {{aluminium: {{{ALUMINIUM}}}}}
bodies:
  block:
    material: aluminium
    shape: {{box: {{min: [-7 mm, -7 mm, -7 mm], max: [7 mm, 7 mm, 7 mm]}}}}
    velocity: [{speed} m/s, {speed} m/s, 0]
"""


def wide_target(dormant=True):
    """A penetrator and a target 40 of its diameters wide, most of it at rest for most of the time."""
    return f"""title: Penetrator on a wide target
frame: axisymmetric
grid:
  cell: 0.5 mm
  box: {{min: [0, -60 mm], max: [200 mm, 60 mm]}}
  boundary: {{r_min: axis, r_max: open, z_min: open, z_max: open}}
time: {{end: 40 us, cfl: 0.5}}
method: {{dormant_blocks: {'true' if dormant else 'false'}}}
materials: {{copper: {{{", ".join(COPPER.values())}}}}}
bodies:
  target: {{material: copper, shape: {{cylinder: {{base: [0, -50 mm], radius: 200 mm, height: 50 mm}}}}}}
  penetrator:
    material: copper
    shape: {{cylinder: {{base: [0, 0], radius: 5 mm, height: 30 mm}}}}
    velocity: [0, -1 km/s]
"""


EFFECTS = {  # name: what is changed in the Taylor scene
    "everything": {},
    "no viscosity": {"without": ("viscosity",)},
    "no heating": {"without": ("heating",)},
    "von Mises for Johnson-Cook": {"replace": {"strength": "strength: {von_mises: {Y: 90 MPa, H: 292 MPa}}"},
                                   "without": ("heating",)},
    "elastic for Johnson-Cook": {"replace": {"strength": "strength: elastic"}, "without": ("heating",)},
    "linear for the shock equation of state": {"replace": {"eos": "eos: linear"}},
    "no cell averages": {"method": ", cell_averaging: false"},
    "flip for tflip (no affine part)": {"method": ", transfer: flip"},
    "linear shape functions": {"method": ", shape: linear, update: musl, transfer: flip"},
}
