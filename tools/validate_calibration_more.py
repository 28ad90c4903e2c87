# SPDX-License-Identifier: GPL-3.0-or-later
"""More problems with known answers for validation/calibration: a sphere on a wall (Hertz), a shell that collapses until
its energy is spent (Verney), a material that is released along its isentrope step by step (Algorithm 1 of the CCF
paper, `krater point`). Imports nothing of the others, which are made beside it.

    Hertz     m x'' = -(4/3) E/(1 - nu^2) sqrt(R) x^1.5 of a sphere on a rigid wall. A sphere has its approach from its own
              middle, a half space from far away, so the impact is stiffer in proportion to a/R: the factors at a/R = 0.1
              are those of elements, 80 and 160 to the radius, 1.0437 of the force and 0.9647 of the duration
              (verification/contact_test).
    Verney    sphere of radii 1 and 1.25, v = -u (1/r)^2: the inner radius stops at 0.75 where the plastic work is the
              energy of motion, 4 pi int r0^2 Y 2 ln(r0/r) dr0 = 2 pi rho u^2 (1 - 1/1.25). Rigid, incompressible: what
              elasticity leaves open is Y/E = 1e-4 of the strain.
    release   stiffened gas, p = (gamma - 1) rho e - gamma P: behind a shock of particle speed u, then (p + P)/rho^gamma
              is kept; the simple wave's speed is u + 2/(gamma - 1) (c0 - c1).
"""

import numpy as np
from scipy.integrate import quad, solve_ivp

HERTZ = {"peak_force": 1.0437, "duration": 0.9647}  # of elements, over Hertz' own


def hertz_wall():
    """Text by cells, {name: exact}, and how they are found in a run."""
    modulus, nu, rho, speed = 210e9, 0.3, 7850.0, 8.65
    mass, k = rho * 4 / 3 * np.pi, 4 / 3 * modulus / (1 - nu * nu)

    def motion(_, y):
        return [y[1], -k * max(y[0], 0.0) ** 1.5 / mass]
    deepest = (1.25 * mass * speed**2 / k) ** 0.4
    window = 1e-2
    path = solve_ivp(motion, [0, window], [0, speed], rtol=1e-10, atol=1e-14, max_step=1e-5)
    duration = (np.interp(0.8 * speed, -path.y[1], path.t) - np.interp(-0.8 * speed, -path.y[1], path.t))
    gap, end = 2e-3, 2e-3 / speed + 1.6 * duration

    def scene(cells):
        h = 1 / cells
        return (f"frame: axisymmetric\ngrid: {{cell: {h!r}, box: {{min: [0, 0], max: [1.25, 2.25]}}, boundary: {{r_min: axis, "
                f"z_min: wall}}}}\ntime: {{end: {end!r}, energy_error: off}}\nmaterials: {{steel: {{density: {rho}, "
                f"youngs_modulus: {modulus}, poisson_ratio: {nu}, eos: linear, strength: elastic}}}}\nbodies: {{ball: {{material: "
                f"steel, shape: {{sphere: {{radius: 1, center: [0, 0, {1 + gap}]}}}}, velocity: [0, {-speed}]}}}}\n"
                f"output: {{frames: 0, history: {duration / 100!r}}}\n")

    def found(run, name):
        """Force: the slope of the impulse over a twentieth of the duration; duration: from 10 to 90 % of the impulse."""
        history = run.history()
        t, done = history["time"], history["impulse"] / (2 * mass * speed)
        if name == "duration":
            return float(np.interp(0.9, done, t) - np.interp(0.1, done, t))
        return float(2 * mass * speed * np.max(done[5:] - done[:-5]) / (t[5] - t[0]))
    return scene, {"impulse": "kind: impulse, body: ball, by: z_min, axis: z"}, {
        "peak_force": HERTZ["peak_force"] * k * deepest**1.5, "duration": HERTZ["duration"] * duration}, found


def verney():
    inner, outer, stop, strength = 1.0, 1.25, 0.75, 1e-4

    def now(r0):
        return np.cbrt(r0**3 - inner**3 + stop**3)
    work = quad(lambda r: 2 * r * r * strength * 2 * np.log(r / now(r)), inner, outer)[0]
    u = float(np.sqrt(work / (1 - inner / outer)))
    strain = quad(lambda r: 2 * np.log(r / now(r)) * r * r, inner, outer)[0] / ((outer**3 - inner**3) / 3)

    def scene(cells):
        h = 1 / cells
        shape = (f"{{difference: [{{sphere: {{radius: {outer}, center: [0, 0, 0]}}}}, {{sphere: {{radius: {inner}, center: "
                 "[0, 0, 0]}}]}")
        return (f"frame: axisymmetric\ngrid: {{cell: {h!r}, box: {{min: [0, 0], max: [1.5, 1.5]}}, boundary: {{r_min: axis, "
                f"z_min: symmetry}}}}\ntime: {{end: {0.75 / u!r}, energy_error: off}}\nmaterials: {{m: {{density: 1, youngs_modulus: "
                f"1, poisson_ratio: 0.3, eos: linear, strength: {{von_mises: {{Y: {strength}, H: 0}}}}}}}}\nbodies: {{b: "
                f"{{material: m, shape: {shape}, velocity: [\"-{u!r}*r/(r^2+z^2)^1.5\", \"-{u!r}*z/(r^2+z^2)^1.5\"]}}}}\n"
                f"output: {{frames: 0, history: {0.05 / u!r}}}\n")
    return scene, {"outer_radius": ("kind: max, body: b, axis: z", float(now(outer))),
                   "strain": ("kind: mean, body: b, field: plastic_strain", float(strain))}


def release(gamma, stiff, rho0, p0, u):
    """A file for `krater point` by steps, and {column of point.csv: exact at its end}."""
    b = (gamma + 1) / 4 * u
    c0 = np.sqrt(gamma * (p0 + stiff) / rho0)
    shock = b + np.sqrt(b * b + c0 * c0)
    p, rho = p0 + rho0 * shock * u, rho0 * shock / (shock - u)
    end = rho * ((p0 + stiff) / (p + stiff)) ** (1 / gamma)
    c, c_end = np.sqrt(gamma * (p + stiff) / rho), np.sqrt(gamma * (p0 + stiff) / end)
    energy = (p0 + gamma * stiff) / ((gamma - 1) * end)
    law = (f"ideal_gas: {{gamma: {gamma}, initial_pressure: {p0}}}" if stiff == 0 else
           f"stiffened_gas: {{gamma: {gamma}, p_inf: {stiff}, initial_pressure: {p0}}}")

    def scene(steps):
        return (f"materials: {{m: {{density: {rho0}, eos: {{{law}}}}}}}\npoint: {{path: {{release_isentrope: {{particle_speed: {u}, "
                f"pressure: {p0}}}}}, steps: {steps}}}\n")
    return scene, {"density": end, "internal_energy": energy, "particle_speed": u + 2 / (gamma - 1) * (c - c_end)}
