#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The material laws alone, by krater point: flow curves, damage, Hugoniots, objective rates, energy update.

Writes README.md and pictures into its folder. `tools/validate materials` builds first.
"""

import csv
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
import yaml  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_runs import ROOT, Study, cards  # noqa: E402

ESTIMATED_SECONDS = 30  # on two quiet cores

FLOW, DAMAGE = "inputs/points/copper_flow_curve.yaml", "inputs/points/weldox_damage.yaml"
SHEAR, RELEASE = "inputs/points/shear_rates.yaml", "inputs/points/aluminium_release.yaml"
RATES, TEMPERATURES = (1, 1e3, 1e5), (294, 500, 700)
COLOURS = {294: "#1f77b4", 500: "#ff7f0e", 700: "#d62728"}
STYLES = {1: "-", 1e3: "--", 1e5: ":"}
TRIAXIALITIES = (1 / 3, 2 / 3, 1.5)
# Johnson-Cook damage, with the constants that the cards name in their comments (copper's: Uintah's material data).
DAMAGES = {
    "Weldox 460 E, coupled": {
        "card": "weldox_460e", "D": (0.0705, 1.732, -0.54, -0.015, 0), "gamma_D": 0.8, "phi_c": 0.99},
    "CCF steel, coupled": {
        "card": "ccf_steel", "D": (-0.8, 2.1, -0.5, 0.002, 0.61), "gamma_D": 0.6, "phi_c": 0.3,
        "heat": "epsdot0: 1, T_ref: 294, T_melt: 1793, "},
    "OFHC copper, uncoupled": {"card": "ofhc_copper", "D": (0.54, 4.89, -3.03, 0.014, 1.12),
                               "heat": "epsdot0: 1, T_ref: 294, T_melt: 1356, "},
}
# Cards of a material of hugoniot.csv.
TABLES = {
    "Cu": ("ofhc_copper", "copper_sg", "copper_eakins", "copper_karamelo", "copper_mpm3d"),
    "Al 2024 (Marsh)": ("al2024_t351", "al2024_t4_sg"),
    "Al 6061 (SCG)": ("al6061_t6", "al6061_t6_sg", "al1100_o_sg", "al_kim", "al_howell_ball", "ccf_aluminium", "al7039"),
    "Fe (Marsh, >13GPa only)": ("steel_1006", "armco_iron"),
    "4340/steel (Urtiew)": ("steel_4340", "ccf_steel", "steel_howell_ball", "s7_tool_steel", "steel_42crmo4"),
    "Pb": ("lead_sg", "lead_mpm3d"),
    "Ta": ("tantalum_sg",),
    "W": ("tungsten_alloy",),
}
SPEEDS = (250, 500, 1000, 2000, 3000)
OBJECTIVE = ("truesdell", "truesdell_projected", "jaumann", "green_naghdi")


def read_cards():
    found = {}
    for path in cards():
        with open(path, encoding="utf-8") as file:
            found[os.path.splitext(os.path.basename(path))[0]] = yaml.safe_load(file)
    return found


def only(block):
    """Name and parameters of `{johnson_cook: {...}}`."""
    return next(iter(block.items())) if isinstance(block, dict) else (block, {})


def resolved(point):
    with open(os.path.join(point.folder, "resolved.yaml"), encoding="utf-8") as file:
        return next(iter(yaml.safe_load(file)["materials"].values()))


# ---- flow curves

def johnson_cook(material, eps, rate, T):
    p = {key: float(value) for key, value in material["strength"]["johnson_cook"].items()}
    hot = np.clip((T - p["T_ref"]) / (p["T_melt"] - p["T_ref"]), 0, 1)
    return (p["A"] + p["B"] * eps ** p["n"]) * (1 + p["C"] * np.log(np.maximum(rate / p["epsdot0"], 1))) * \
        (1 - hot ** p["m"])


def off_closed_form(point):
    """Largest relative difference between von Mises stress and flow stress over the steps of plastic flow."""
    d = np.diff(point["plastic_strain"])
    flow = johnson_cook(resolved(point), point["plastic_strain"][1:], d / np.diff(point["time"]),
                        point["temperature"][:-1])
    used = d > 0
    return np.abs(point["von_mises"][1:] / flow - 1)[used].max()


def at_strain(point, eps, name="von_mises"):
    return np.interp(eps, point["plastic_strain"], point[name])


def flow_curves(study, known):
    names = [name for name, card in known.items()
             if "strength" in card and only(card["strength"])[0] == "johnson_cook" and not name.endswith("_as_printed")]
    points = {}
    for name in names:
        for rate in RATES:
            for T in TEMPERATURES:
                settings = [f"materials.copper.card={name}", f"point.path.uniaxial_stress.rate={rate:g}",
                            f"point.temperature={T}"]
                if rate <= 1:
                    settings.append("materials.copper.heating=none")
                point = study.point(f"flow_{name}_{rate:g}_{T}", FLOW, settings)
                if point:
                    points[name, rate, T] = point
    draw_flow_curves(study, names, points)
    rows = []
    for name in names:
        mine = {key: p for key, p in points.items() if key[0] == name}
        if len(mine) < 9:
            continue
        value = lambda rate, T, eps: f"{1e-6 * at_strain(points[name, rate, T], eps):.0f}"  # noqa: E731
        rise = points[name, 1e3, 294]["temperature"][-1] - 294
        rows.append([name, value(1, 294, 0.1), value(1e3, 294, 0.1), value(1e5, 294, 0.1), value(1e3, 700, 0.1),
                     value(1, 294, 0.4), value(1e3, 294, 0.4), f"{rise:.0f}",
                     f"{max(off_closed_form(p) for p in mine.values()):.0e}"])
    study.add("## Flow curves", "Compression in uniaxial stress of every Johnson-Cook card: 1 /s isothermal, 1000 and "
              "1e5 /s adiabatic. Von Mises stress [MPa] at plastic strains of 0.1 and 0.4, rise of the temperature at "
              "a strain of 0.5; last column: the largest relative difference, over all nine curves, from the flow "
              "stress (33) evaluated apart from the program at the strain and rate of each step and the temperature "
              "before it.", "![flow curves](flow_curves.png)")
    study.add_table(["card", "0.1, 1 /s, 294 K", "0.1, 1e3 /s", "0.1, 1e5 /s", "0.1, 1e3 /s, 700 K", "0.4, 1 /s, 294 K",
                     "0.4, 1e3 /s", "rise K", "closed form"], rows)
    study.add("The temperature of a step is that before it (src/THEORY.md 4), so heating softens one step late. `copper_karamelo` "
              "has neither rate nor heat: its three rates are one curve. Where the adiabatic curve falls from the start "
              "(`tungsten_alloy`, `s7_tool_steel`) a real specimen would localise; a single point cannot.")


def draw_flow_curves(study, names, points):
    columns, rows = 4, len(names) // 4 + 1  # the last holds the legend
    figure, grid = plt.subplots(rows, columns, figsize=(14, 2.9 * rows), sharex=True, layout="constrained",
                                squeeze=False)
    for axes in grid.flat[len(names):]:
        axes.set_axis_off()
    for axes, name in zip(grid.flat, names):
        for (card, rate, T), p in points.items():
            if card == name:
                axes.plot(p["plastic_strain"], 1e-6 * p["von_mises"], color=COLOURS[T], ls=STYLES[rate], lw=1.4)
        axes.set_title(name, fontsize=10)
        axes.set_ylim(bottom=0)
        axes.spines[["top", "right"]].set_visible(False)
    for axes in grid[:, 0]:
        axes.set_ylabel("von Mises stress [MPa]")
    for axes in grid[-1]:
        axes.set_xlabel("plastic strain")
    lines = [Line2D([], [], color=COLOURS[T], label=f"{T} K") for T in TEMPERATURES] + \
            [Line2D([], [], color="0.3", ls=STYLES[r], label=f"{r:g} /s" + (", isothermal" if r == 1 else ", adiabatic"))
             for r in RATES]
    grid.flat[-1].legend(handles=lines, loc="center", frameon=False)
    figure.savefig(os.path.join(study.folder, "flow_curves.png"), dpi=100)
    plt.close(figure)


# ---- damage

def fracture_strain(case, chi):
    D1, D2, D3 = case["D"][:3]
    return D1 + D2 * np.exp(D3 * min(chi, 1.5))


def damage_block(case):
    D = ", ".join(f"D{i + 1}: {d}" for i, d in enumerate(case["D"]))
    D = case.get("heat", "") + D
    if "gamma_D" in case:
        return f"{{johnson_cook: {{{D}, phi_c: {case['phi_c']}, gamma_D: {case['gamma_D']}}}}}"
    return f"{{johnson_cook_uncoupled: {{{D}}}}}"


def damage_text(case, chi, strain):
    return (f"materials:\n  metal:\n    card: {os.path.join(ROOT, 'inputs', 'materials', case['card'])}.yaml\n"
            f"    heating: none\n    damage: {damage_block(case)}\n"
            f"point:\n  path: {{triaxial: {{strain: {strain:.6g}, rate: 1, triaxiality: {chi:.12g}}}}}\n"
            "  steps: 4000\n  every: 4\n")


def damage(study):
    figure, grid = plt.subplots(2, len(DAMAGES), figsize=(13, 6.4), sharex="col", layout="constrained")
    rows = []
    for column, (name, case) in enumerate(DAMAGES.items()):
        for k, chi in enumerate(TRIAXIALITIES):
            eps_F = fracture_strain(case, chi)
            expected = eps_F * (case["gamma_D"] + case["phi_c"] * (1 - case["gamma_D"])) if "gamma_D" in case else eps_F
            point = study.point(f"damage_{case['card']}_{chi:.2f}", damage_text(case, chi, 1.05 * expected + 0.02))
            if not point or "failure" not in point.summary:
                rows.append([name, f"{chi:.3f}", f"{eps_F:.4f}", f"{expected:.4f}", "no failure", ""])
                continue
            failed = point.summary["failure"]["plastic_strain"]
            rows.append([name, f"{chi:.3f}", f"{eps_F:.4f}", f"{expected:.4f}", f"{failed:.4f}",
                         f"{100 * (failed / expected - 1):+.2f}"])
            colour = list(COLOURS.values())[k]
            grid[0][column].plot(point["plastic_strain"], point["damage"], color=colour, label=f"triaxiality {chi:.2f}")
            grid[1][column].plot(point["equivalent_strain"], 1e-6 * point["von_mises"], color=colour)
        grid[0][column].set_title(name)
        grid[1][column].set_xlabel("equivalent (plastic) strain")
    grid[0][0].set_ylabel("damage")
    grid[1][0].set_ylabel("von Mises stress carried [MPa]")
    grid[0][0].legend(frameon=False)
    for axes in grid.flat:
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(os.path.join(study.folder, "damage.png"), dpi=100)
    plt.close(figure)
    study.add("## Damage under three triaxialities", "Drawn at a constant triaxiality, 1 /s, isothermal, until failure. "
              "eps_F of (34); failure is expected at eps_D + phi_c (eps_F - eps_D) for the coupled form (41), at eps_F "
              "for the uncoupled one, which does not soften: its stress stands until it falls to zero. The steps are "
              "1/4000 of the path.", "![damage](damage.png)")
    study.add_table(["material", "triaxiality", "eps_F", "failure expected", "failure found", "difference %"], rows)


# ---- Hugoniots

def read_hugoniots():
    path = os.path.join(ROOT, "tests", "data", "hugoniot_all.csv")
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    keys = ("rho0", "c0", "s", "Gamma0", "u_p_m_s", "U_s_m_s", "P_Pa", "rho_over_rho0", "e_minus_e0_J_kg")
    return {name: {key: np.array([float(r[key]) for r in rows if r["material"] == name]) for key in keys}
            for name in dict.fromkeys(row["material"] for row in rows)}


def shocked(study, label, material):
    speeds = ", ".join(map(str, SPEEDS))
    return study.point(label, f"materials: {{m: {{{material}}}}}\n"
                       f"point: {{path: {{hugoniot: {{particle_speed: [{speeds}]}}}}}}\n")


def hugoniots(study, known):
    tables = read_hugoniots()
    study.add("## Hugoniots", "States behind a steady shock, solved from the jump conditions with the equation of "
              "state's own functions. **Against hugoniot.csv** (eight materials, particle speeds 0.25 to 3 km/s, "
              "with the constants of each row; p and rho/rho0 are printed there with 6 and 7 digits): largest "
              "relative differences.")
    rows = []
    for name, table in tables.items():
        constants = f"density: {table['rho0'][0]}, eos: {{mie_gruneisen_shock: {{c0: {table['c0'][0]}, " \
                    f"S1: {table['s'][0]}, gamma0: {table['Gamma0'][0]}}}}}"
        point = shocked(study, "table_" + name.split(" (")[0].replace("/", "_").replace(" ", "_"), constants)
        if point:
            pairs = (("shock_speed", "U_s_m_s"), ("compression", "rho_over_rho0"), ("internal_energy", "e_minus_e0_J_kg"),
                     ("pressure", "P_Pa"))
            linear = table["c0"] + table["s"] * table["u_p_m_s"]
            rows.append([name, *(f"{np.abs(point[a] / table[b] - 1).max():.0e}" for a, b in pairs),
                         f"{np.abs(point['pressure'] / (table['rho0'] * linear * table['u_p_m_s']) - 1).max():.0e}"])
    study.add_table(["material", "U_s", "rho/rho0", "e", "p as printed", "p = rho0 (c0 + s up) up"], rows)
    rows, curves = [], {}
    of = {card: name for name, mine in TABLES.items() for card in mine}
    for card in known:
        if "eos" not in known[card]:
            continue  # a coupled model has a pressure of its own
        point = shocked(study, f"card_{card}", f"card: {os.path.join(ROOT, 'inputs', 'materials', card)}.yaml")
        if not point:
            continue
        curves[card] = point
        law = only(known[card]["eos"])[0]
        table = tables.get(of.get(card))
        row = [card, law.replace("mie_gruneisen_", ""), f"{point['density'][0] / point['compression'][0]:.0f}",
               *(f"{point['shock_speed'][k]:.0f}" for k in (1, 2, 4)),
               *(f"{1e-9 * point['pressure'][k]:.2f}" for k in (1, 2, 4))]
        row += [of.get(card, "-").split(" (")[0]]
        row += [f"{100 * (point['pressure'][k] / table['P_Pa'][k] - 1):+.1f}" for k in (1, 2, 4)] if table else ["-"] * 3
        rows.append(row)
    study.add("**Every card** beside the table of its metal: U_s [m/s] and p [GPa] at particle speeds of 0.5, 1 and "
              "3 km/s, and the difference of p in per cent. Differences are those of the constants, not of the "
              "solution: another alloy or density, a cubic fit for a linear U_s(u_p), or an equation of state that "
              "knows no curvature. **A card with a linear equation of state is not for shocks.**",
              "![Hugoniots](hugoniots.png)")
    study.add_table(["card", "eos", "rho0", "U_s .5", "U_s 1", "U_s 3", "p .5", "p 1", "p 3", "table", "% .5", "% 1", "% 3"],
                    rows)
    draw_hugoniots(study, tables, curves)


def draw_hugoniots(study, tables, curves):
    figure, grid = plt.subplots(2, 4, figsize=(14, 6.8), sharex=True, layout="constrained")
    for axes, (name, table) in zip(grid.flat, tables.items()):
        for card in TABLES[name]:
            if card in curves:
                axes.plot(1e-3 * curves[card]["particle_speed"], 1e-3 * curves[card]["shock_speed"], lw=1.4, label=card)
        axes.plot(1e-3 * table["u_p_m_s"], 1e-3 * table["U_s_m_s"], "ko", ms=4, label="hugoniot.csv")
        axes.set_title(name, fontsize=10)
        axes.legend(frameon=False, fontsize=8)
        axes.spines[["top", "right"]].set_visible(False)
    for axes in grid[:, 0]:
        axes.set_ylabel("shock speed [km/s]")
    for axes in grid[-1]:
        axes.set_xlabel("particle speed [km/s]")
    figure.savefig(os.path.join(study.folder, "hugoniots.png"), dpi=100)
    plt.close(figure)


# ---- objective rates

def closed_shear(rate, g):
    """s12 and s11 over G, theory 13."""
    b, k = np.arctan(g / 2), np.sqrt(2 / 3)
    return {"truesdell": (g, 2 * g ** 2 / 3),
            "truesdell_projected": (np.sin(k * g) / k, 2 * (1 - np.cos(k * g))),
            "jaumann": (np.sin(g), 1 - np.cos(g)),
            "green_naghdi": (2 * (np.cos(2 * b) * (2 * b - np.tan(b)) - 2 * np.sin(2 * b) * np.log(np.cos(b))),
                             4 * (np.cos(2 * b) * np.log(np.cos(b)) + b * np.sin(2 * b) - np.sin(b) ** 2))}[rate]


def shear(study):
    figure, grid = plt.subplots(1, 2, figsize=(12, 4.4), layout="constrained")
    rows, metal = [], []
    for k, rate in enumerate(OBJECTIVE):
        errors = []
        for steps in (1000, 2000, 4000, 8000):
            point = study.point(f"shear_{rate}_{steps}", SHEAR, [f"materials.solid.rate={rate}", f"point.steps={steps}",
                                                                f"point.every={steps // 200}"])
            if point:
                s12, s11 = closed_shear(rate, point["F_xy"])
                errors.append(max(np.abs(point["stress_xy"] - s12).max(), np.abs(point["stress_xx"] - s11).max()))
        if len(errors) < 4:
            continue
        order = "exact" if errors[-1] < 1e-10 else f"{np.log2(errors[-2] / errors[-1]):.2f}"
        rows.append([rate, *(f"{e:.1e}" for e in errors), order])
        for axes, values, exact in ((grid[0], point["stress_xy"], s12), (grid[1], point["stress_xx"], s11)):
            axes.plot(point["F_xy"], values, color=f"C{k}", label=rate)
            axes.plot(point["F_xy"][::20], exact[::20], "o", ms=4, mfc="none", color=f"C{k}")
        copper = study.point(f"shear_copper_{rate}", "inputs/points/copper_flow_curve.yaml", [
            f"materials.copper.rate={rate}", "materials.copper.heating=none", "point.steps=20000", "point.every=100",
            "point.path={simple_shear: {shear: 8, rate: 1}}"])
        if copper:
            at = lambda name, g: np.interp(g, copper["F_xy"], copper[name]) * 1e-6  # noqa: E731
            metal.append([rate, *(f"{at('stress_xy', g):.2f}" for g in (1, 8)),
                          *(f"{at('stress_xx', g) + at('pressure', g):.3f}" for g in (1, 8)), f"{copper['plastic_strain'][-1]:.4f}"])
    grid[0].set_ylabel("shear stress s12 / G")
    grid[1].set_ylabel("normal stress s11 / G")
    grid[1].set_ylim(-1, 12)
    grid[0].legend(frameon=False)
    for axes in grid:
        axes.set_xlabel("shear")
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(os.path.join(study.folder, "shear.png"), dpi=100)
    plt.close(figure)
    study.add("## Objective rates in large shear", "An elastic solid to a shear of 8, against the closed forms "
              "(circles; src/THEORY.md 13): the largest error of s12 and s11 over G along the path, by the number of steps, and "
              "the order between the last two.", "![shear](shear.png)")
    study.add_table(["rate", "1000", "2000", "4000", "8000", "order"], rows)
    study.add("What is left of it in a metal that yields: OFHC copper, isothermal, 1 /s, deviators in MPa.")
    study.add_table(["rate", "s12 at 1", "s12 at 8", "s11 at 1", "s11 at 8", "plastic strain"], metal)


# ---- energy update

def energy_update(study):
    rows = []
    cases = (("release of shocked aluminium, 44.6 GPa", RELEASE, [], "internal_energy"),
             ("copper, elastic-plastic cycle in uniaxial strain", "inputs/points/copper_cycle.yaml",
              ["materials.copper.viscosity=none"], "internal_energy"),
             ("copper, the same with viscosity", "inputs/points/copper_cycle.yaml", [], "internal_energy"))
    for k, (what, file, settings, name) in enumerate(cases):
        ends, balance = [], 0.0
        for steps in (50, 100, 200, 400, 800):
            point = study.point(f"energy_{k}_{steps}", file, [*settings, f"point.steps={steps}"])
            if point:
                ends.append(point[name][-1])
                balance = max(balance, np.abs(point["energy_balance"]).max() / np.abs(point["work"]).max())
        if len(ends) == 5:
            change = np.abs(np.diff(ends))
            rows.append([what, f"{1e-3 * ends[-1]:.3f}", *(f"{x:.2g}" for x in change),
                         f"{np.log2(change[-2] / change[-1]):.2f}", f"{balance:.0e}"])
    study.add("## Energy update", "Internal energy at the end of a path [kJ/kg], and how it changes [J/kg] as the steps "
              "are doubled from 50 to 800, with the order of the last doubling. Balance: the work of the stresses "
              "carried less the change of e, relative to the work: the energy is accounted for at any step.")
    study.add_table(["path", "e", "50-100", "100-200", "200-400", "400-800", "order", "balance"], rows)
    study.add("Algorithm 1 is of second order along an isentrope; along a shock's path with its viscosity given it is too "
              "(`unit/materials/scalar_eos`). Plastic flow is integrated by a backward step, of first order; the "
              "viscosity of a step takes the sound speed before it.")


def main():
    study = Study(__file__, FLOW, ESTIMATED_SECONDS, __doc__)
    known = read_cards()
    study.add("Every result is of `krater point`: one material point, taken by prescribed maps or stresses through the "
              "very stages of a run. Where no closed form is named the figures are results, not checks.")
    flow_curves(study, known)
    damage(study)
    hugoniots(study, known)
    shear(study)
    energy_update(study)
    study.write("Material laws alone")


if __name__ == "__main__":
    main()
