#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two records as an experimenter reads them: the pull-back of a spalling plate, the deceleration of a penetrator."""

import pathlib

import numpy as np

from scene_support import Folder, ROOT, check, finish, gauge_table, run, summary

# A blunt rod of hard steel that aluminium stops. A body's own deceleration, and the force on it by its mass.
PENETRATOR = """
frame: axisymmetric
grid: {cell: 1 mm, box: {min: [0, -60 mm], max: [20 mm, 42 mm]}, boundary: {r_min: axis}}
time: {end: 120 us, energy_error: off}
materials:
  steel: {density: 7850, shear_modulus: 80 GPa, strength: {von_mises: {Y: 1.5 GPa, H: 100 MPa}},
          eos: {mie_gruneisen_shock: {c0: 4569 m/s, S1: 1.49, gamma0: 2.17}}}
  soft: {density: 2700, shear_modulus: 26 GPa, strength: {von_mises: {Y: 200 MPa, H: 100 MPa}},
         eos: {mie_gruneisen_shock: {c0: 5240 m/s, S1: 1.4, gamma0: 2}}}
bodies:
  rod: {material: steel, shape: {cylinder: {radius: 4 mm, height: 40 mm, base: [0, 0.5 mm]}}, velocity: [0, -300 m/s]}
  block: {material: soft, shape: {cylinder: {radius: 16 mm, height: 50 mm, base: [0, -50 mm]}}}
contact: {friction: 0}
output: {frames: 0, history: 1 us}
measures:
  v: {kind: mean_velocity, body: rod, axis: z}
  a: {kind: deceleration, body: rod, axis: z}
  F: {kind: force, body: rod, by: block, axis: z}
gauges:
  trace: {measures: [v, a, F], every: 0.5 us, filter: {cfc: 30000}}
  tail: {body: rod, at: [0, 40.5 mm], fields: [velocity_z_rate], every: 0.5 us, filter: {cfc: 30000}}
"""


def first_valley(t, u):
    """Peak and the first minimum after it from which u rises by a tenth of the peak."""
    peak = int(np.argmax(u[: int(np.searchsorted(t, 1.3e-6))]))
    low = peak
    for i in range(peak, len(u)):
        low = i if u[i] < u[low] else low
        if u[i] > u[low] + 0.1 * u[peak]:
            break
    return peak, low


def spall():
    """sigma = rho0 c_b (du + delta)/2 against the strength of the scene; see the input."""
    done = run("spall", scene=ROOT / "inputs" / "copper_spall.yaml")
    if not check(done.returncode == 0, "the plate spalls", done.text[-400:]):
        return
    density, c0, shear, strength = 8960, 3940, 46e9, 1.2e9
    c_l = np.sqrt((density * c0**2 + 4 / 3 * shear) / density)
    visar = gauge_table("spall", "visar")
    t, u = visar["time"], visar["velocity_z"]
    peak, low = first_valley(t, u)

    def slope(after):  # over 40 ns beside the minimum, 20 ns off it
        ends = np.interp(t[low] + after * np.array([20e-9, 60e-9]), t, u)
        return abs(ends[1] - ends[0]) / 40e-9

    next_peak = low + int(np.argmax(u[low: low + int(0.3e-6 / 2e-9)]))
    next_low = next_peak + int(np.argmin(u[next_peak: next_peak + int(0.6e-6 / 2e-9)]))
    h = 0.5 * c0 * (t[next_low] - t[low])
    u1, u2 = slope(-1), slope(1)
    delta = h * (1 / c0 - 1 / c_l) * u1 * u2 / (u1 + u2)
    pull_back = u[peak] - u[low]
    plain, corrected = 0.5 * density * c0 * pull_back, 0.5 * density * c0 * (pull_back + delta)
    print(f"      pull-back {pull_back:.1f} m/s, correction {delta:.1f} m/s, spall of {1e3 * h:.2f} mm: "
          f"{1e-9 * plain:.3f} GPa, corrected {1e-9 * corrected:.3f} GPa for {1e-9 * strength} GPa")
    check(abs(corrected / strength - 1) < 0.1, "the pull-back tells the spall strength within a tenth", corrected / strength)
    check(plain < corrected, "the usual correction is not nothing", delta)
    smooth = visar["velocity_z_filtered"]
    check(abs(smooth[low] - u[low]) < 0.1 * pull_back, "50 MHz leave the valley", smooth[low] - u[low])


def penetrator(folder):
    scene = pathlib.Path(folder, "penetrator.yaml")
    scene.write_text(PENETRATOR, encoding="utf-8")
    done = run("rod", scene=scene)
    if not check(done.returncode == 0, "the rod is stopped", done.text[-400:]):
        return
    trace, tail = gauge_table("rod", "trace"), gauge_table("rod", "tail")
    mass = 7850 * np.pi * 4e-3**2 * 40e-3
    inside = (trace["time"] > 5e-6) & (trace["time"] < 60e-6)
    check(np.max(np.abs(trace["F"] / mass - trace["a"])[inside]) < 1e-3 * np.max(trace["a"]), "force by mass is the deceleration")
    lost = trace["v"][-1] - trace["v"][0]
    t = trace["time"]
    area = np.sum(0.5 * (trace["a_filtered"][1:] + trace["a_filtered"][:-1]) * np.diff(t))
    check(abs(area / lost - 1) < 0.03 and lost > 250, "the filtered trace adds up to the change of velocity", (area, lost))
    plateau = np.mean(trace["a_filtered"][(t > 15e-6) & (t < 55e-6)])
    ringing = [np.std(x[(t > 15e-6) & (t < 55e-6)]) for x in (tail["velocity_z_rate"], tail["velocity_z_rate_filtered"])]
    check(ringing[1] < 0.5 * ringing[0], "the filter takes the bar's ringing at its tail", ringing)
    # A cavity opens against 2/3 Y (1 + ln(2E/3Y)) = 0.86 GPa (Bishop, Hill, Mott 1945), a flat punch needs up to twice it.
    stress = plateau * 7850 * 40e-3
    check(0.86e9 < stress < 2 * 0.86e9, "the plateau lies between the pressures of a cavity and of a punch", stress)
    said = summary("rod")["gauges"]["trace"]
    check(said["filter"] == "cfc 30000" and abs(said["filter_frequency"] - 5e4) < 1, "and says its filter", said)


with Folder() as where:
    spall()
    penetrator(where)
finish()
