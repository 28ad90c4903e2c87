# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of validation/energy and what is read from their frames."""

import os

import h5py
import numpy as np


# Shock laws of cards of inputs/materials, and their heat capacities [J/(kg K)]; tantalum's from memory.
MATERIALS = {
    "aluminium 2024": {"rho0": 2770.0, "c0": 5328.0, "s": 1.338, "Gamma0": 2.0, "c_v": 875.0},
    "copper": {"rho0": 8960.0, "c0": 3940.0, "s": 1.489, "Gamma0": 2.02, "c_v": 383.0},
    "steel 4340": {"rho0": 7830.0, "c0": 4570.0, "s": 1.49, "Gamma0": 1.93, "c_v": 477.0},
    "tantalum": {"rho0": 16690.0, "c0": 3410.0, "s": 1.2, "Gamma0": 1.67, "c_v": 140.0},
}
LENGTH = 20e-3


def behind_shock(x, speed, start=300.0):
    """U_s, density, e, T behind a shock of particle speed u (theory 8; T by quadrature of the isentrope)."""
    shock = x["c0"] + x["s"] * speed
    eta = speed / shock
    y = (np.arange(4000) + 0.5) * eta / 4000
    g = x["Gamma0"]
    p = x["c0"] ** 2 * y / (1 - x["s"] * y) ** 2
    cold = np.exp(g * eta) * np.sum(np.exp(-g * y) * p * (1 - 0.5 * g * y)) * eta / 4000
    e = 0.5 * speed ** 2
    return {"U": shock, "rho": x["rho0"] / (1 - eta), "e": e, "T": start * np.exp(g * eta) + (e - cold) / x["c_v"]}


def strip(x, speed, cells, boost=None):
    """A plate of 20 mm against the plane z = 0, a fluid in plane strain, until the shock has taken three quarters
    of it; with `boost` another plate in place of the plane, both moving on, for half that time."""
    h = LENGTH / cells
    end = (0.75 if boost is None else 0.375) * LENGTH / (x["c0"] + x["s"] * speed)
    body = "  {}: {{material: m, shape: {{box: {{min: [-1, 0, {!r}], max: [1, 1, {!r}]}}}}, velocity: [0, {!r}]}}\n"
    bodies = body.format("plate", 0.0, LENGTH, (boost or 0) - speed)
    low, high, side = 0.0, LENGTH + 4 * h, "symmetry"
    if boost is not None:
        bodies += body.format("other", -LENGTH, 0.0, boost + speed)
        low, high, side = -LENGTH - 4 * h, (cells + int(np.ceil(boost * end / h)) + 4) * h, "open"
    return f"""title: shock at {speed:g} m/s
frame: plane_strain
grid: {{cell: {h!r}, box: {{min: [0, {low!r}], max: [{8 * h!r}, {high!r}]}},
  boundary: {{x_min: symmetry, x_max: symmetry, z_min: {side}}}}}
time: {{end: {end!r}, max_step: {0.5 * h / 25e3 if boost is not None else 0!r}}}
materials:
  m: {{density: {x['rho0']!r}, initial_temperature: 300, heating: {{energy: {{c_v: {x['c_v']!r}}}}},
    eos: {{mie_gruneisen_shock: {{c0: {x['c0']!r}, S1: {x['s']!r}, gamma0: {x['Gamma0']!r}}}}},
    viscosity: {{q_lin: 0.5, q_quad: 2.0}}}}
bodies:
{bodies}output: {{frames: 0, history: {end / 20!r}, fields: [temperature]}}
"""


NOH_SIDES = {"planar": "x_min: symmetry, x_max: symmetry, z_min: symmetry",
             "cylindrical": "x_min: symmetry, z_min: symmetry", "spherical": "r_min: axis, z_min: symmetry"}


def noh(kind, cells):
    """Noh's problem of a cold gas, gamma 5/3, at t = 0.6: the shock stands at r = 0.2. `cells` to r = 1."""
    h = 1 / cells
    frame = "axisymmetric" if kind == "spherical" else "plane_strain"
    if kind == "planar":
        shape, wide = "{box: {min: [-1, 0, 0], max: [1, 1, 1]}}", 8 * h
        velocity = "[0, -1]"
    else:
        shape = ("{sphere: {radius: 1, center: [0, 0, 0]}}" if kind == "spherical" else
                 "{cylinder: {radius: 1, height: 1, axis: y, base: [0, -0.5, 0]}}")
        wide = 1 + 4 * h
        a = "r" if kind == "spherical" else "x"
        velocity = f'["-{a}/sqrt({a}^2+z^2)", "-z/sqrt({a}^2+z^2)"]'
    return f"""frame: {frame}
grid: {{cell: {h!r}, box: {{min: [0, 0], max: [{wide!r}, {1 + 4 * h!r}]}}, boundary: {{{NOH_SIDES[kind]}}}}}
time: {{end: 0.6}}
materials: {{gas: {{density: 1, eos: {{ideal_gas: {{gamma: 1.6666666666667, initial_pressure: 1e-6}}}}, viscosity: {{}}}}}}
bodies: {{a: {{material: gas, shape: {shape}, velocity: {velocity}}}}}
output: {{frames: 0, history: 0.1}}
"""


def expansion(cells):
    """A gas drawn out to twice its length, v = z, free at one end: no shock, so its entropy stays."""
    h = 1 / cells
    return f"""frame: plane_strain
grid: {{cell: {h!r}, box: {{min: [0, 0], max: [{4 * h!r}, 8]}}, boundary: {{x_min: symmetry, x_max: symmetry, z_min: symmetry}}}}
time: {{end: 1}}
materials: {{gas: {{density: 1, eos: {{ideal_gas: {{gamma: 1.4, initial_pressure: 1}}}}, viscosity: {{}}}}}}
bodies: {{a: {{material: gas, shape: {{box: {{min: [-1, 0, 0], max: [1, 1, 1]}}}}, velocity: [0, z]}}}}
output: {{frames: 0, history: 0.1}}
"""


def spin(cells, cfl, method):
    """An elastic disc of radius 1, its rim at 0.1 sqrt(E/rho), for three turns."""
    h, speed = 2 / cells, 0.1
    return f"""frame: plane_strain
grid: {{cell: {h!r}, box: {{min: [{-1 - 4 * h!r}, {-1 - 4 * h!r}], max: [{1 + 4 * h!r}, {1 + 4 * h!r}]}}}}
time: {{end: {3 * 2 * np.pi / speed!r}, cfl: {cfl}}}
method: {{{method}}}
materials: {{rubber: {{density: 1000, youngs_modulus: 1000, poisson_ratio: 0.3, strength: neo_hookean}}}}
bodies:
  disc:
    material: rubber
    shape: {{cylinder: {{radius: 1, height: 1, axis: y, base: [0, -0.5, 0]}}}}
    velocity: ["-{speed}*z", "{speed}*x"]
output: {{frames: 1000, history: 2}}
"""


def sod(cells):
    h = 1 / cells
    gas = ("{{density: {}, eos: {{ideal_gas: {{gamma: 1.4, initial_pressure: {}}}}}, "
           "viscosity: {{q_lin: 0.3, q_quad: 2}}}}")
    return f"""frame: plane_strain
grid: {{cell: {h!r}, box: {{min: [0, 0], max: [{4 * h!r}, 1]}},
  boundary: {{x_min: symmetry, x_max: symmetry, z_min: symmetry, z_max: symmetry}}}}
time: {{end: 0.2}}
materials: {{high: {gas.format(1, 1)}, low: {gas.format(0.125, 0.1)}}}
bodies:
  high: {{material: high, shape: {{box: {{min: [-1, 0, 0], max: [1, 1, 0.5]}}}}}}
  low: {{material: low, shape: {{box: {{min: [-1, 0, 0.5], max: [1, 1, 1]}}}}}}
output: {{frames: 0, history: 0.1}}
"""


WHIPPLE = """title: Whipple shield, aluminium sphere of 3.2 mm at 6.7 km/s
frame: axisymmetric
grid: {{cell: {cell} mm, box: {{min: [0, -75 mm], max: [40 mm, 10 mm]}}}}
time: {{end: 25 us}}
materials:
  al: {{card: al2024_t351, damage: card, heating: {{energy: {{c_v: 875}}}}, viscosity: {{q_lin: 0.5, q_quad: 2.0}}}}
bodies:
  bumper: {{material: al, shape: {{cylinder: {{radius: 35 mm, height: 1 mm, base: [0, -1 mm]}}}}}}
  wall: {{material: al, shape: {{cylinder: {{radius: 35 mm, height: 2.5 mm, base: [0, -53.5 mm]}}}}}}
  sphere: {{material: al, shape: {{sphere: {{radius: 1.6 mm, center: [0, 1.6 mm]}}}}, velocity: [0, -6.7 km/s]}}
contact: {{friction: 0}}
output: {{frames: 2.5 us, history: 0.25 us, fields: [velocity, temperature, density, mass, failed]}}
measures:
  wall_momentum: {{kind: momentum, body: wall, axis: z}}
  hole: {{kind: hole_diameter, body: bumper}}
  crater: {{kind: crater_depth, body: wall, face: z_max}}
  sphere_T: {{kind: mean, body: sphere, field: temperature}}
  bumper_cloud_T: {{kind: mean, body: bumper, field: temperature, region: {{z_max: -5 mm}}}}
  wall_T: {{kind: mean, body: wall, field: temperature, region: {{r_max: 10 mm}}}}
  wall_failed: {{kind: failed_mass, body: wall}}
"""


class Frame:
    """A frame of a run: body -> field -> values."""

    def __init__(self, run, time=None):
        with h5py.File(os.path.join(run.folder, "frames.h5"), "r") as file:
            names = sorted(file["frames"])
            times = np.array([float(file["frames"][name].attrs["time"]) for name in names])
            at = -1 if time is None else int(np.argmin(np.abs(times - time)))
            self.time = times[at]
            self.bodies = {body: {field: data[()] for field, data in group.items() if field not in ("cells", "nodes")}
                           for body, group in file["frames"][names[at]].items()}

    def all(self, field):
        values = [np.asarray(body[field]) for body in self.bodies.values()]
        return np.concatenate([v.reshape(len(v), -1) for v in values])

    def radius(self, axes):
        return np.sqrt(sum(self.all("coordinates")[:, a] ** 2 for a in axes))


def cell_means(at, values, weights, h):
    """(centres of the cells that hold points, means by weight)."""
    cell = np.floor(at / h).astype(int)
    cell -= (low := cell.min())
    total = np.bincount(cell, weights)
    used = total > 0
    return (np.flatnonzero(used) + low + 0.5) * h, np.bincount(cell, weights * values)[used] / total[used]
