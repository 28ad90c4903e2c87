#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""krater point: closed forms through the whole program, every file of inputs/points/, and mistakes of users."""

import csv
import itertools
import os
import pathlib
import re
import subprocess
import sys

import h5py
import numpy as np

from scene_support import Folder, ROOT, check, finish, krater, settings, summary, table

POINTS = ROOT / "inputs" / "points"
counter = itertools.count()

ELASTIC = "density: 7850, youngs_modulus: 200 GPa, poisson_ratio: 0.3, eos: linear"
K, G = 200e9 / 1.2, 200e9 / 2.6


def run(scene, *values, code=0):
    """Result of a point file; None where the exit code is another."""
    folder = f"point_{next(counter)}"
    done = krater("point", scene, "-o", folder, "--quiet", *settings(values))
    if done.returncode != code:
        check(False, f"exit code {code} of {scene} {values}", f"{done.returncode}: {done.stderr.strip()}")
        return None
    return table(folder, "point.csv"), summary(folder)


def point(material, path, *, steps=1000, more="", values=(), code=0):
    """Result of `material` (flow YAML without braces) along `path`."""
    name = f"p{next(counter)}.yaml"
    pathlib.Path(name).write_text(
        f"materials: {{m: {{{material}}}}}\npoint: {{path: {{{path}}}, steps: {steps}{more}}}\n", encoding="utf-8")
    return run(name, *values, code=code)


def near(what, value, expected, tolerance):
    error = np.max(np.abs(np.asarray(value) - expected)) / max(np.max(np.abs(expected)), 1e-300)
    check(error <= tolerance, what, f"{np.max(np.abs(np.asarray(value))):.6g}, off by {error:.1e} (allowed {tolerance:.0e})")


def order(what, errors, expected, spread):
    """Errors of steps halved once and twice."""
    found = [np.log2(a / b) for a, b in zip(errors, errors[1:])]
    check(all(abs(f - expected) < spread for f in found), what,
          f"orders {', '.join(f'{f:.2f}' for f in found)}, errors {', '.join(f'{e:.1e}' for e in errors)}")


# ---- the examples

def examples():
    """Each runs, closes its energy, writes sound files, and runs again from its resolved.yaml with the same bits."""
    files = sorted(POINTS.glob("*.yaml"))
    check(len(files) >= 5, f"{len(files)} files in inputs/points/")
    for path in files:
        done = krater("point", path)
        folder = path.stem + "_out"
        if not check(done.returncode == 0 and f"results in {folder}" in done.stdout, f"{path.name} runs", done.stderr):
            continue
        t, s = table(folder, "point.csv"), summary(folder)
        check(s["status"] == "done" and all(np.isfinite(v).all() for v in t.values()), f"{path.name}: done, finite",
              f"{len(next(iter(t.values())))} rows, {s['machine']['ns_per_update'] or 0:.0f} ns per update")
        if "energy_balance" in t:
            worst = np.abs(t["energy_balance"]).max() / np.abs(t["work"]).max()
            check(worst < 1e-12, f"{path.name}: the energy is the work of the stresses carried", f"{worst:.1e}")
        with h5py.File(f"{folder}/point.h5", "r") as file:
            same = all(np.array_equal(file[name][()], values) for name, values in t.items())
            named = all(item.attrs["unit"] and len(item.attrs["meaning"]) > 5 for item in file.values())
            check(same and named and len(file) == len(t) and list(file.attrs["columns"]) == list(t),
                  f"{path.name}: point.h5 is point.csv with units and meanings")
        again = krater("point", f"{folder}/resolved.yaml", "-o", "again", "--quiet")
        equal = pathlib.Path("again/point.csv").read_bytes() == pathlib.Path(f"{folder}/point.csv").read_bytes()
        check(again.returncode == 0 and equal, f"{path.name}: resolved.yaml gives the same bits", again.stderr)
    texts = set()
    for level in ("portable", "v3", "v4"):
        done = krater("point", POINTS / "weldox_damage.yaml", "-o", level, "--quiet", env={"KRATER_ISA": level})
        if done.returncode == 0:
            texts.add(pathlib.Path(f"{level}/point.csv").read_bytes())
    check(len(texts) == 1, "every instruction set gives the same bits")


# ---- closed forms

def shear_forms(rate, g):
    """theory 13: s12 and s11 over G."""
    b, k = np.arctan(g / 2), np.sqrt(2 / 3)
    return {"truesdell": (g, 2 * g**2 / 3),
            "truesdell_projected": (np.sin(k * g) / k, 2 * (1 - np.cos(k * g))),
            "jaumann": (np.sin(g), 1 - np.cos(g)),
            "green_naghdi": (2 * (np.cos(2 * b) * (2 * b - np.tan(b)) - 2 * np.sin(2 * b) * np.log(np.cos(b))),
                             4 * (np.cos(2 * b) * np.log(np.cos(b)) + b * np.sin(2 * b) - np.sin(b) ** 2))}[rate]


def shear():
    """All rates to gamma 8. Theory 13 and theory D9 as printed, at gamma .5, 1, 2, 4, 8: s12 alone."""
    printed = {"jaumann": (.479426, .841471, .909297, -.756802, .989358),
               "green_naghdi": (.480513, .869784, 1.386294, 2.317944, 5.046021), "truesdell": (.5, 1, 2, 4, 8),
               "truesdell_projected": (.486226, .892534, 1.222377, -.151958, .301567)}
    tolerance = {"truesdell": 1e-12, "truesdell_projected": 8e-4, "jaumann": 6e-4, "green_naghdi": 4e-6}
    scene = POINTS / "shear_rates.yaml"
    for rate, values in printed.items():
        errors, at_printed = [], []
        for steps in (2000, 4000, 8000):
            t, _ = run(scene, f"materials.solid.rate={rate}", f"point.steps={steps}", f"point.every={steps // 400}")
            s12, s11 = shear_forms(rate, t["F_xy"])
            errors.append(max(np.abs(t["stress_xy"] - s12).max(), np.abs(t["stress_xx"] - s11).max()))
            at_printed.append(t["stress_xy"][[25, 50, 100, 200, 400]])
        near(f"simple shear to gamma 8, {rate}", [t["stress_xy"], t["stress_xx"]], np.array([s12, s11]), tolerance[rate])
        if rate in ("jaumann", "truesdell_projected"):  # first order: Richardson's extrapolation, once more than the rest
            at_printed = [2 * fine - coarse for coarse, fine in zip(at_printed, at_printed[1:])]
        end = at_printed[-1] if rate == "truesdell" else (4 * at_printed[-1] - at_printed[-2]) / 3
        near(f"{rate}: the printed s12, extrapolated", end, np.array(values), 1e-6)
        if rate != "truesdell":
            order(f"{rate} converges", errors, 2 if rate == "green_naghdi" else 1, 0.15)


def elastic():
    t, _ = point(f"{ELASTIC}, strength: elastic", "uniaxial_stress: {strain: 1e-5, rate: 1}", steps=10)
    near("uniaxial stress: Young's modulus", t["stress_xx"][-1] / 1e-5, 200e9, 2e-5)
    near("uniaxial stress: Poisson's ratio", -t["strain_yy"][-1] / 1e-5, 0.3, 2e-5)
    t, _ = point(f"{ELASTIC}, strength: elastic", "uniaxial_strain: {strain: 0.3, rate: 1}", steps=7)
    stretch = np.exp(0.3)
    s11 = 2 / 3 * G * (stretch ** (4 / 3) - stretch ** (-2 / 3))
    near("uniaxial stretch: truesdell, any step", t["stress_xx"][-1] + t["pressure"][-1], s11, 1e-12)
    near("F is the stretch", t["F_xx"][-1], stretch, 1e-12)
    for rate, exact in (("jaumann", 4 / 3 * 0.3), ("truesdell_projected", 4 * (np.exp(0.1) - 1))):
        errors = []
        for steps in (100, 200, 400):
            t, _ = point(f"{ELASTIC}, strength: elastic, rate: {rate}", "uniaxial_strain: {strain: 0.3, rate: 1}",
                         steps=steps)
            errors.append(abs((t["stress_xx"][-1] + t["pressure"][-1]) / G - exact))
        order(f"uniaxial stretch: {rate}", errors, 2 if rate == "jaumann" else 1, 0.15)
    t, _ = point(f"{ELASTIC}, strength: elastic", "uniaxial_strain: {strain: [0.2, -0.1, 0], rate: 1}", steps=300)
    check(abs(t["internal_energy"][-1]) < 1e-9 * t["internal_energy"].max() and abs(t["F_xx"][-1] - 1) < 1e-13,
          "a closed elastic cycle returns its energy", f"{t['internal_energy'][-1]:.1e} of {t['internal_energy'].max():.1e}")


def plastic():
    metal = f"{ELASTIC}, strength: {{von_mises: {{Y: 300 MPa}}}}"
    for strain in (0.05, -0.05):
        t, _ = point(metal, f"uniaxial_stress: {{strain: {strain}, rate: 1}}", steps=50)
        near(f"perfect plasticity in uniaxial stress, {strain:+}", t["stress_xx"][-1], np.sign(strain) * 300e6, 1e-9)
        check(np.abs(t["stress_yy"]).max() < 0.1, "no stress on the sides", f"{np.abs(t['stress_yy']).max():.1e} Pa")
    t, _ = point(metal, "uniaxial_strain: {strain: -0.02, rate: 1}", steps=50)
    near("uniaxial strain: sigma = -p - 2Y/3", t["stress_xx"][-1], -t["pressure"][-1] - 200e6, 1e-12)
    t, _ = point(metal, "triaxial: {strain: -0.05, rate: 1, lateral_stress: -500 MPa}", steps=200)
    near("triaxial: the lateral stress", t["stress_yy"][20:], -500e6, 1e-9)
    near("triaxial: hydrostatic first", t["stress_xx"][20], -500e6, 1e-9)
    near("triaxial: then yield on top of it", t["stress_xx"][-1], -800e6, 1e-9)
    for x in (0, 1 / 3, 1, 2):
        t, _ = point(metal, f"triaxial: {{strain: 0.02, rate: 1, triaxiality: {x}}}", steps=200)
        near(f"triaxiality {x:.3g}", t["triaxiality"][1:] + 1, x + 1, 1e-9)
    t, _ = point(metal + ", heating: {plastic_work: {fraction: 0.9, cp: 450}}",
                 "uniaxial_stress: {strain: 0.5, rate: 1}", steps=400, more=", temperature: 400 K")
    rise = 0.9 * 300e6 * t["plastic_strain"] / (t["density"] * 450)
    near("heating: the plastic work, from the temperature given", t["temperature"][-1] - 400, rise[-1], 1e-6)


def motions():
    stiff = f"{ELASTIC}, strength: elastic"
    spin = "[[0, -6e5, 0], [6e5, 0, 0], [0, 0, 0]]"
    t, _ = point(stiff, f"velocity_gradient: {{L: {spin}, time: 10 us}}", steps=20)
    check(np.abs(t["stress_xx"]).max() < 1e-3 and abs(t["density"][-1] / 7850 - 1) < 1e-12, "a spin strains nothing",
          f"{np.abs(t['stress_xx']).max():.1e} Pa")
    errors = []
    for steps in (20, 40, 80):  # F = exp(int L) along x: int_0^T 2e4 sin(pi t/T) dt = 4e4 T/pi
        t, _ = point(stiff, "velocity_gradient: {L: [[2e4*sin(pi*t/1e-5), 0, 0], [0, 0, 0], [0, 0, 0]], time: 10 us}",
                     steps=steps)
        errors.append(abs(t["F_xx"][-1] - np.exp(0.4 / np.pi)))
    order("velocity gradient in t: second order", errors, 2, 0.05)
    t, s = point(stiff, "stretch: {F: [[1, 2e5*t, 0], [0, 1, 0], [0, 0, 1 + 0.1*sin(pi*t/1e-5)]], time: 10 us}", steps=9)
    near("stretch: F as given", [t["F_xy"][-1], t["F_zz"][-1], t["F_yz"][-1]], np.array([2, 1, 0]), 1e-12)
    near("stretch: truesdell needs no small steps", t["stress_xy"][-1], 2 * G, 1e-9)
    check(s["path"] == "stretch" and s["steps"] == 9, "summary: path and steps")
    t, _ = point(stiff, "stretch: {F: [1 + 1e4*t, 1, 1], time: 10 us}", steps=2)
    near("the diagonal alone", [t["F_xx"][-1], t["F_yy"][-1]], np.array([1.1, 1]), 1e-12)
    viscous = stiff + ", viscosity: {q_lin: 0.5, q_quad: 2}"
    t, _ = point(viscous, "uniaxial_strain: {strain: -1e-3, rate: 1e6}", steps=10, more=", length: 1 mm")
    q = t["density"][-1] * 1e-3 * (2 * 1e-3 * 1e12 + 0.5 * np.sqrt(K / 7850) * 1e6)
    near("viscosity: Decision 7 with the length given", t["viscous_pressure"][-1], q, 2e-3)
    near("viscosity: in the stress", (t["stress_xx"] + t["stress_yy"] + t["stress_zz"])[-1] / -3,
         t["pressure"][-1] + t["viscous_pressure"][-1], 1e-12)


# ---- damage

def damage():
    printed = {"1/3": 1.5172, "shear": 1.8025, "1.5": .8410}  # theory D10; failure at eps_F (.8 + .99 .2)
    for case, strain in printed.items():
        path = "point.path={simple_shear: {shear: 3.3, rate: 1.7320508}}" if case == "shear" else \
               f"point.path.triaxial.triaxiality={0.3333333333 if case == '1/3' else 1.5}"
        t, s = run(POINTS / "weldox_damage.yaml", path, "point.steps=8000")
        near(f"Weldox, fracture strain, {case}", s["failure"]["plastic_strain"], .998 * strain, 5e-4)
        check(s["events"]["failures"] == 1 and t["von_mises"][-1] == 0 and t["damage"][-1] == .99,
              f"Weldox, {case}: failed once, for ever")
    # theory D10 is of small strain; Y and strain scaled by k and S by k^3 leave its damage as it is.
    k, strains, expected = 1e-3, (0.01, 0.02), (.009714, .075179)
    for strain, phi in zip(strains, expected):
        errors = []
        for steps in (500, 1000, 2000, 4000):
            t, _ = point(f"{ELASTIC}, strength: {{von_mises: {{Y: {300e6 * k}}}}}, damage: {{lemaitre_energy: {{S: "
                         f"{2e6 * k**3}, s: 1, eps_d: 0, phi_c: 0.99}}, degrade_pressure: none}}",
                         f"uniaxial_strain: {{strain: {strain * k}, rate: 1}}", steps=steps)
            errors.append(t["damage"][-1])
        order(f"Lemaitre in uniaxial strain to {strain}: first order", -np.diff(errors), 1, 0.1)
        near(f"Lemaitre in uniaxial strain to {strain}: theory D10", 2 * errors[-1] - errors[-2], phi, 1e-4)
    t, s = point(f"{ELASTIC}, spall: {{strength: 1 GPa, action: limit}}, strength: {{von_mises: {{Y: 300 MPa}}}}",
                 "uniaxial_strain: {strain: [0.05, 0, 0.05], rate: 1}", steps=300)
    check(s["events"]["spalls"] > 100 and t["pressure"].min() == -1e9, "spall: cut off and counted",
          f"{s['events']['spalls']} updates")
    check(np.abs(t["energy_balance"]).max() < 1e-12 * t["work"].max(), "spall: the pressure carried does the work")
    t, s = point(f"{ELASTIC}, spall: {{strength: 0.3 GPa, action: limit}}, strength: {{von_mises: {{Y: 300 MPa}}}}",
                 "triaxial: {strain: 0.01, rate: 1, triaxiality: 2}", steps=100)
    cut = int(np.sum(t["pressure"] == -0.3e9))
    check(80 < cut == s["events"]["spalls"] and t["trials"].max() > 2, "events of trials that are taken back do not count",
          f"{cut} updates at the limit, {s['events']['spalls']} counted, up to {t['trials'].max():.0f} trials")


def concrete():
    """Peaks of triaxial tests by quadrature along their paths: what the lateral pressure has crushed counts."""
    for lateral, peak in ((50e6, 151.2507e6), (100e6, 190.4822e6)):
        found = run(POINTS / "concrete_triaxial.yaml", f"point.path.triaxial.lateral_stress={-lateral}")
        if found:
            near(f"concrete at {lateral / 1e6:g} MPa: peak", found[0]["von_mises"].max(), peak, 1e-3)


def couplings():
    """The yield condition of `coupling: rate`, q = (1 - phi) sigma_Y, and that of `effective`, at the end of a path."""
    soft = "damage: {{lemaitre_energy: {{S: 0.1 MPa, s: 1, eps_d: 0, phi_c: 0.9}}, coupling: {}}}"
    for coupling in ("rate", "effective"):
        t, _ = point(f"{ELASTIC}, strength: {{von_mises: {{Y: 300 MPa, H: 1 GPa}}}}, {soft.format(coupling)}",
                     "uniaxial_stress: {strain: 0.2, rate: 1}", steps=2000)
        near(f"coupling {coupling}: q = (1 - phi) (Y + H eps)", t["von_mises"][-1],
             (1 - t["damage"][-1]) * (300e6 + 1e9 * t["plastic_strain"][-1]), 1e-9)
        check(0.3 < t["damage"][-1] < 0.9, f"coupling {coupling}: damaged", f"{t['damage'][-1]:.4f}")


def stress_rates():
    """(32) and (43): the path of `coupling: rate` in shear against the rate equations, dq = 3G (1 - phi)(d strain - d eps)
    with q = (1 - phi) sigma_Y kept, and that of `effective`; first order as dt -> 0. Strains so small that shear is
    radial loading; a yield stress that hardens fast, softened by damage as fast."""
    Y, H, end = 3e5, 2e9, 1.3e-5
    R = 3 * K / (3 * K + G)  # triaxiality 0
    S = Y**2 * R / (2 * 200e9) / 4e4  # d phi/d eps = 4e4 at q~ = Y

    def exact(coupling, steps=20000):
        state, h = np.zeros(2), (end - Y / (3 * G)) / steps

        def slope(x):
            eps, phi = x
            flow = Y + H * eps
            k = flow**2 * R / (2 * 200e9 * S)
            growth = 3 * G / (3 * G + H - (k * flow / (1 - phi) if coupling == "rate" else 0))
            return np.array([growth, k * growth])
        for _ in range(steps):
            a = slope(state)
            b = slope(state + 0.5 * h * a)
            c = slope(state + 0.5 * h * b)
            state = state + h / 6 * (a + 2 * b + 2 * c + slope(state + h * c))
        return (1 - state[1]) * (Y + H * state[0])

    reached = {}
    for coupling in ("rate", "effective"):
        q, errors = exact(coupling), []
        for steps in (500, 1000, 2000):
            t, _ = point(f"{ELASTIC}, strength: {{von_mises: {{Y: {Y}, H: {H}}}}}, damage: {{lemaitre_energy: {{S: {S}, s: 1,"
                         f" eps_d: 0, phi_c: 0.95}}, coupling: {coupling}}}",
                         f"simple_shear: {{shear: {np.sqrt(3) * end}, rate: 1}}", steps=steps)
            errors.append(abs(t["von_mises"][-1] / q - 1))
        reached[coupling] = q
        check(0.3 < t["damage"][-1] < 0.94, f"stress rate of coupling {coupling}: damaged", f"{t['damage'][-1]:.3f}")
        order(f"stress rate of coupling {coupling}: first order", errors, 1, 0.1)
    check(abs(reached["rate"] / reached["effective"] - 1) > 0.02, "stress rate: the couplings differ",
          f"{reached['rate']:.6g} and {reached['effective']:.6g} Pa")


# ---- shocks

def hugoniots():
    with open(ROOT / "tests" / "data" / "hugoniot_all.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    check(len(rows) == 40, f"{len(rows)} rows of hugoniot_all.csv")
    for name in dict.fromkeys(row["material"] for row in rows):
        mine = [row for row in rows if row["material"] == name]
        column = {key: np.array([float(row[key]) for row in mine]) for key in mine[0]
                  if key not in ("material", "source", "certainty")}
        constants = {key: column[key][0] for key in ("rho0", "c0", "s", "Gamma0")}
        material = "density: {rho0}, eos: {{mie_gruneisen_shock: {{c0: {c0}, S1: {s}, gamma0: {Gamma0}}}}}".format(
            **constants)
        speeds = ", ".join(row["u_p_m_s"] for row in mine)
        t, _ = point(material, f"hugoniot: {{particle_speed: [{speeds}]}}")
        near(f"Hugoniot of {name}: U_s", t["shock_speed"] / column["U_s_m_s"], 1, 1e-6)
        near("  rho/rho0", t["compression"] / column["rho_over_rho0"], 1, 1e-6)
        near("  e", t["internal_energy"] / column["e_minus_e0_J_kg"], 1, 1e-6)
        near("  p, six digits as printed", t["pressure"] / column["P_Pa"], 1, 5e-6)
        near("  p = rho0 Us up", t["pressure"] / (column["rho0"] * (column["c0"] + column["s"] * column["u_p_m_s"])
                                                  * column["u_p_m_s"]), 1, 1e-12)
        back, _ = point(material, "hugoniot: {density: [" + ", ".join(map(repr, t["density"])) + "]}")
        near("  from the densities back", back["particle_speed"] / column["u_p_m_s"], 1, 1e-9)
    for card, pressures in (("ccf_steel", (9.656, 20.774, 47.535, 212.97)),
                            ("ccf_aluminium", (3.877, 8.227, 18.363, 77.768))):
        t, _ = point(f"card: {ROOT}/inputs/materials/{card}.yaml", "hugoniot: {particle_speed: [250, 500, 1000, 3000]}")
        near(f"cubic Hugoniot of {card}, theory D1", t["pressure"] / (1e9 * np.array(pressures)), 1, 6e-5)
        jump = t["pressure"] * (t["compression"] - 1) / t["density"]
        near("  momentum and energy", [jump / t["particle_speed"] ** 2, jump / (2 * t["internal_energy"])], 1, 1e-10)
    gas = "density: 1.2, eos: {ideal_gas: {gamma: 1.4, initial_pressure: 1e5}}"
    t, _ = point(gas, "hugoniot: {particle_speed: [100, 1e4]}")
    M = t["shock_speed"] / np.sqrt(1.4e5 / 1.2)
    near("ideal gas: pressure of the Mach number", t["pressure"] / 1e5, 1 + 2.8 / 2.4 * (M**2 - 1), 1e-10)


def releases():
    """Algorithm 1 along an isentrope at second order, and twice the particle speed at the free surface."""
    scene, ends = POINTS / "aluminium_release.yaml", []
    for steps in (20, 40, 80, 160):
        t, _ = run(scene, f"point.steps={steps}")
        ends.append([t["density"][-1], t["internal_energy"][-1], t["particle_speed"][-1]])
    near("release: ends at the pressure asked for", abs(t["pressure"][-1]) + 1e9, 1e9, 1e-11)
    for k, what in enumerate(("density", "energy", "particle speed")):
        order(f"release: second order in {what}", np.abs(np.diff([e[k] for e in ends])), 2, 0.1)
    near("release: free surface at twice the particle speed, 2 %", t["particle_speed"][-1], 4000, 2.5e-2)
    gas = "density: 1.2, eos: {ideal_gas: {gamma: 1.4, initial_pressure: 1e5}}"
    t, _ = point(gas, "release_isentrope: {particle_speed: 300, pressure: 1e5}", steps=400)
    entropy = t["pressure"] / t["density"] ** 1.4
    near("release of a gas: p rho^-gamma", entropy / entropy[0], 1, 1e-5)


# ---- mistakes and failures

def refused(what, expected, text, *values, file="bad.yaml"):
    pathlib.Path(file).write_text(text, encoding="utf-8")
    before = set(os.listdir("."))
    done = krater("point", file, "-o", "left_behind", *settings(values))
    missing = [e for e in expected if not re.search(e, done.stderr)]
    left = sorted(set(os.listdir(".")) - before)
    check(done.returncode == 2 and not missing and not left and not done.stdout, f"refused: {what}",
          f"exit {done.returncode}, missing {missing}, left {left}; {done.stderr.strip().splitlines()[:2]}")


def mistakes():
    good = "materials:\n  m:\n    density: 7850\n    shear_modulus: 80 GPa\n    bulk_modulus: 160 GPa\n" \
           "    eos: linear\n    strength: {von_mises: {Y: 300 MPa}}\n" \
           "point:\n  path:\n    uniaxial_stress:\n      strain: 0.1\n      rate: 1 s^-1\n"

    def edited(what, expected, old, new, *values):
        assert old in good, old
        refused(what, expected, good.replace(old, new), *values)

    edited("unknown path", [r"bad\.yaml:10: point\.path: ", "did you mean uniaxial_stress"], "uniaxial_stress:",
           "uniaxial_stres:")
    edited("unknown key of a path", [r"bad\.yaml:11: point\.path\.uniaxial_stress\.strian", "did you mean strain"],
           "strain:", "strian:")
    edited("missing rate", ["missing key 'rate'", "s\\^-1"], "      rate: 1 s^-1\n", "")
    edited("negative rate", [r"bad\.yaml:12: .*rate: must be positive"], "rate: 1", "rate: -1")
    edited("a unit of another kind", [r"bad\.yaml:12: .*rate"], "1 s^-1", "1 m/s")
    edited("no strain at all", [r"bad\.yaml:11: .*turns of the path are the same"], "strain: 0.1", "strain: 0")
    edited("empty list", [r"bad\.yaml:11: .*empty"], "strain: 0.1", "strain: []")
    edited("no path", ["point: missing key 'path'"], good[good.index("  path:"):], "  steps: 3\n")
    edited("no point", ["missing key 'point'"], good[good.index("point:"):], "")
    edited("a scene", ["missing key 'point' .*krater run"], good[good.index("point:"):], "bodies: {}\n")
    edited("a scene's block", ["unknown key 'grid'"], "point:", "grid: {}\npoint:")
    edited("unknown material", [r"bad\.yaml:9: point\.material: .*did you mean m|known: m"], "  path:",
           "  material: x\n  path:")
    edited("which of two materials", ["missing key 'material'", "known: m, n"], "point:",
           "  n: {density: 1, bulk_modulus: 1 Pa, eos: linear}\npoint:")
    edited("steps", [r"bad\.yaml:13: point\.steps: must be a whole number"], "rate: 1 s^-1\n", "rate: 1\n  steps: 0\n")
    edited("viscosity without a length", ["missing key 'length'", "element"], "    eos: linear",
           "    eos: linear\n    viscosity: {}")
    edited("material: unknown model", [r"bad\.yaml:7: materials\.m\.strength", "did you mean von_mises"], "von_mises",
           "von_mise")
    edited("material: no such card", [r"bad\.yaml:3: materials\.m\.card", "no card"], "density: 7850", "card: nocard")
    edited("--set of an unknown path", ["--set point.pth"], "strain: 0.1", "strain: 0.1", "point.pth=1")

    def path(what, expected, text, material="eos: linear, bulk_modulus: 1 GPa, density: 1000"):
        refused(what, expected, f"materials: {{m: {{{material}}}}}\npoint:\n  path: {{{text}}}\n")

    path("two lateral conditions", ["one of lateral_stress and triaxiality"],
         "triaxial: {strain: 1, rate: 1, triaxiality: 1, lateral_stress: 1 MPa}")
    path("no lateral condition", ["one of lateral_stress and triaxiality"], "triaxial: {strain: 1, rate: 1}")
    path("L of two rows", [r"bad\.yaml:3: .*three rows"], "velocity_gradient: {L: [[0, 0, 0], [0, 0, 0]], time: 1}")
    path("a row of two", ["expected 3 components"], "velocity_gradient: {L: [[0, 0], 1, 1], time: 1}")
    path("variable of a field", ["unknown variable 'x'", "known: t, pi"], "stretch: {F: [1 + x, 1, 1], time: 1}")
    path("no expression", ["neither a number nor an expression"], "stretch: {F: [1 + *, 1, 1], time: 1}")
    path("F not I at the start", ["identity at t = 0", "component 11 is 2"], "stretch: {F: [2 + t, 1, 1], time: 1}")
    path("speed and density", ["one of particle_speed and density"], "hugoniot: {particle_speed: 1, density: 2000}")
    path("release of two states", ["must be one value"], "release_isentrope: {particle_speed: [1, 2]}")
    path("density below that at rest", [r"bad\.yaml:3: point\.path\.hugoniot: .*below that at rest"],
         "hugoniot: {density: 900}")
    path("more than one shock compresses", ["one shock cannot compress it so far"], "hugoniot: {density: 10}",
         "density: 1.2, eos: {ideal_gas: {gamma: 1.4, initial_pressure: 1e5}}")
    path("Hugoniot of a law of F", ["hugoniot needs an eos"], "hugoniot: {particle_speed: 10}",
         "density: 1, shear_modulus: 1, bulk_modulus: 2, strength: neo_hookean")
    done = krater("point", POINTS / "copper_cycle.yaml", "-o", "/proc/nothing")
    check(done.returncode == 2 and "/proc/nothing" in done.stderr, "unwritable output", done.stderr.strip())


def failures():
    """Numerical failures: exit code 3, the place and a remedy, what was reached in the files."""
    t, s = point(f"{ELASTIC}, strength: elastic", "stretch: {F: [1 - t, 1, 1], time: 2}", steps=10, code=3)
    check(s["status"] == "failed" and len(t["time"]) == 5 and "inside out" in s["message"] and "step 5" in s["message"],
          "turned inside out", s["message"])
    gas = "density: 1.2, eos: {ideal_gas: {gamma: 1.4, initial_pressure: 1e5}}"
    t, s = point(gas, "uniaxial_stress: {strain: -0.1, rate: 1}", code=3)
    check("no lateral stretch gives the lateral stress" in s["message"] and re.search(r"p\d+\.yaml:2: point\.path",
          s["message"]), "a gas has no state without lateral stress", s["message"])


def pictures():
    run_plot = lambda *words: subprocess.run([sys.executable, str(ROOT / "tools" / "plot_point"), *words],
                                             capture_output=True, text=True, check=False)
    for name in ("copper_flow_curve", "weldox_damage", "aluminium_hugoniot", "aluminium_release"):
        done = run_plot(f"{name}_out")
        path = pathlib.Path(name + "_out", "pictures", "point.png")
        check(done.returncode == 0 and done.stdout.strip() == str(path) and path.read_bytes()[:4] == b"\x89PNG",
              f"plot_point {name}", done.stderr)
    done = run_plot("copper_flow_curve_out", "weldox_damage_out", "-o", "deep/both.png")
    check(done.returncode == 0 and os.path.getsize("deep/both.png") > 10000, "plot_point of two runs", done.stderr)
    for words, expected in ((("nothing",), "nothing"), (("copper_flow_curve_out", "aluminium_hugoniot_out"), "common")):
        done = run_plot(*words)
        check(done.returncode == 2 and expected in done.stderr and "Traceback" not in done.stderr,
              f"plot_point {' '.join(words)} is refused", done.stderr.strip())


with Folder():
    examples()
    shear()
    elastic()
    plastic()
    motions()
    damage()
    couplings()
    concrete()
    stress_rates()
    hugoniots()
    releases()
    mistakes()
    failures()
    pictures()
finish()
