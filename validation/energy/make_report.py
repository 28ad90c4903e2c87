#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Energy: states behind shocks, Noh, Sod, Sedov, moving observers, expansion, a Whipple shield at three cells.

Writes README.md and pictures into its folder. `tools/validate energy` builds first.
"""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import numpy as np  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
import validate_energy as scenes  # noqa: E402
import validate_energy_exact as exact  # noqa: E402
import validate_energy_pictures as pictures  # noqa: E402
from validate_impacts import discussion, value  # noqa: E402
from validate_runs import ROOT, Study  # noqa: E402

ESTIMATED_SECONDS = 600  # on two quiet cores

SPEEDS, CELLS = (1000, 2000, 3000, 6000), (100, 200)
NOH = {"planar": (100, 200, 400, 800), "cylindrical": (50, 100, 200), "spherical": (50, 100, 200)}
SOD, SEDOV, EXPANSION = (100, 200, 400, 800), (0.04, 0.02, 0.01), (50, 100, 200)
WHIPPLE = (0.5, 0.25, 0.125)
BOOST = 10e3
SPIN = {"tflip": "", "apic": "transfer: apic", "flip musl": "transfer: flip, update: musl"}


def sign(number, digits=2):
    return f"{number:+.{digits}f}" if np.isfinite(number) else "-"


def shocks(study):
    study.add("## Behind a shock", "A plate of 20 mm, a fluid with the card's shock law, moves at u_p against the "
              "plane "
              "of symmetry z = 0 (plane strain, 8 cells wide, q_lin 0.5, q_quad 2). Means by mass over 0.3 to 0.7 "
              "of the shock's "
              "way; exact: e = u_p²/2, T by quadrature of the isentrope (theory 8). `wall`: e of the first two cells, "
              "wall heating, which does not fall with the cell but covers fewer millimetres. Demanded at 200 cells: e "
              "within 0.2 %, T within 0.5 %.")
    rows = []
    for name, x in scenes.MATERIALS.items():
        for speed in SPEEDS:
            found = []
            for cells in CELLS:
                label = f"shock_{name.replace(' ', '_')}_{speed}_{cells}"
                done = study.run_text(label, scenes.strip(x, speed, cells), 3)
                found.append(done and exact.plateau(done, x, speed, scenes.LENGTH / cells))
            if None in found:
                continue
            met = abs(found[1]["e"]) <= 0.2 and abs(found[1]["T"]) <= 0.5
            rows.append([f"{name}, {1e-3 * speed:g} km/s", f"{found[0]['exact']['T']:.0f}",
                         *(sign(f["e"]) for f in found), *(sign(f["T"]) for f in found),
                         *(sign(f["wall"], 0) for f in found), "met" if met else "missed"])
    study.add_table(["errors in %", "T K", "e, 100", "e, 200", "T, 100", "T, 200", "wall, 100", "wall, 200",
                     "demanded"], rows)


def noh(study):
    study.add("## Noh's problem", "A cold gas (gamma 5/3) that falls together at speed 1; at t = 0.6 the shock "
              "stands at 0.2, "
              "density behind it 4, 16, 64. `cells` to r = 1. L1 of means over cells (rings one cell wide) for r < "
              "0.4, "
              "by that of the solution; orders between neighbours. `plateau`: density from 0.08 to 0.16; `wall`: e "
              "of the first cell.")
    rows, profiles = [], {}
    for kind, all_cells in NOH.items():
        found = {}
        for cells in all_cells:
            done = study.run_text(f"noh_{kind}_{cells}", scenes.noh(kind, cells), cells ** 2 / 2000)
            if done:
                found[cells] = exact.noh_errors(done, kind, 1 / cells)
        rho, e = ([f[key] for f in found.values()] for key in ("rho", "e"))
        for (cells, f), order_rho, order_e in zip(found.items(), exact.observed(rho), exact.observed(e)):
            rows.append([f"{kind}, {cells}", f"{f['rho']:.4f}", order_rho, f"{f['e']:.4f}", order_e, sign(f["plateau"]),
                         sign(f["front"]), sign(f["wall"], 0)])
        profiles[kind] = found
    study.add_table(["Noh", "L1 rho", "order", "L1 e", "order", "plateau %", "front %", "wall e %"], rows)
    pictures.noh(study, profiles, "noh.png")
    study.add("![Noh](noh.png)")


def tube_and_blast(study):
    study.add("## Sod's tube", "q_lin 0.3, q_quad 2; L1 of means over cells by that of the solution at t = 0.2.")
    found = {}
    for cells in SOD:
        done = study.run_text(f"sod_{cells}", scenes.sod(cells), cells / 50)
        if done:
            found[cells] = exact.sod_errors(done, 1 / cells)
    rho, e = ([f[key] for f in found.values()] for key in ("rho", "e"))
    study.add_table(["cells", "L1 rho", "order", "L1 e", "order"],
                    [[cells, f"{f['rho']:.5f}", a, f"{f['e']:.5f}", b] for (cells, f), a, b in
                     zip(found.items(), exact.observed(rho), exact.observed(e))])
    study.add("## Sedov's blast", "Cylindrical, gamma 1.4 (fault b11), t = 0.5. The hot gas takes 0.0895 of volume "
              "by its "
              "isentrope; m/rho of its points says what the strain made of it.")
    rows = [["exact", "0.530", "6", "0.0874", "0.0895", ""]]
    for cell in SEDOV:
        path = os.path.join(ROOT, "tests", "scene", "faults", "b11-sedov-energy.yaml")
        with open(path, encoding="utf-8") as file:
            done = study.run_text(f"sedov_{cell}", file.read(), 0.01 / cell ** 2, (f"grid.cell={cell}",))
        if done:
            f = exact.sedov(done, cell)
            rows.append([cell, f"{f['front']:.3f}", f"{f['rho']:.2f}", f"{f['p']:.4f}", f"{f['volume']:.4f}",
                         f"{done.audit('energy_residual_fraction'):.0e}"])
    study.add_table(["cell", "densest ring at", "its density", "pressure r < .2", "volume of the hot gas",
                     "energy - start"], rows)


def observers(study):
    study.add("## A moving observer", f"Two aluminium plates that meet at ±3 km/s, 100 cells each, at rest on the "
              f"grid and "
              f"with {1e-3 * BOOST:g} km/s added to everything, with the same steps: e from 0.3 to 0.7 of the "
              f"shocks' way. "
              "One step from any state is invariant to 2e-10 (`verification/ledger`); over a run the points cross the "
              "grid's lines at other times, so their noise differs, but not their mean.")
    x = scenes.MATERIALS["aluminium 2024"]
    rest, moving = (study.run_text(f"boost_{boost:g}", scenes.strip(x, 3000, 100, boost), 10)
                    for boost in (0.0, BOOST))
    if rest and moving:
        at_rest, in_motion, apart, noise = exact.boosted(rest, moving, x, 3000)
        study.add_table(["% of u²/2", "mean error at rest", "in motion", "point by point (rms)", "noise at rest (rms)"],
                        [["e", sign(at_rest), sign(in_motion), f"{apart:.2f}", f"{noise:.2f}"]])
    study.add("## Expansion", "A gas that is drawn out to twice its length, v = z, with a free end: no shock, so "
              "p/rho^1.4 of "
              "its points should stay 1.")
    rows = []
    for cells in EXPANSION:
        done = study.run_text(f"expansion_{cells}", scenes.expansion(cells), 1)
        if done:
            mean, least, most, outer, outermost = exact.entropy_gain(done)
            heat = done.audit("transfer_loss") + done.audit("transfer_gain")
            rows.append([cells, sign(mean), sign(least), sign(most), sign(outer, 1), sign(outermost, 0),
                         f"{100 * heat / done.audit('initial_energy'):.2f}"])
    study.add_table(["gain of p/rho^1.4 in %, cells", "half by the plane: mean", "least", "greatest",
                     "half by the end: mean", "greatest", "heat of the transfer, % of E0"], rows)


def spin(study):
    study.add("## Spin", "The neo-Hookean disc of [spin_and_discs](../spin_and_discs/README.md), 20 cells across, "
              "after three "
              "turns, in % of the start; before the ledger (there) tflip kept angular momentum to -0.038, -0.091, "
              "-0.141 % at CFL "
              "0.2, 0.5, 0.8.")
    rows = []
    for name, method in SPIN.items():
        for cfl in (0.2, 0.5, 0.8):
            done = study.run_text(f"spin_{name.replace(' ', '_')}_{cfl}", scenes.spin(20, cfl, method), 5)
            if done:
                h = done.history()
                spun, kinetic, total = (100 * (h[k][-1] / h[k][0] - 1) for k in
                                        ("angular_momentum", "kinetic_energy", "total_energy"))
                heat = 100 * done.audit("numerical_heat") / h["total_energy"][0]
                rows.append([f"{name}, CFL {cfl}", sign(spun, 3), sign(kinetic, 3), f"{total:.0e}", sign(heat, 3)])
    study.add_table(["", "angular momentum", "kinetic energy", "total", "numerical heat"], rows)


def whipple(study):
    study.add("## Whipple shield", "Aluminium 2024-T351, a sphere of 3.2 mm at 6.7 km/s, a bumper of 1 mm, a wall "
              "of 2.5 mm behind a "
              "gap of 50 mm; contact of three bodies, Johnson-Cook strength and failure, at 25 µs. Energies in % of "
              "the start; "
              "momentum of the wall by that of the sphere.")
    runs = {cell: study.run_text(f"whipple_{cell}", scenes.WHIPPLE.format(cell=cell), 5 * (0.5 / cell) ** 2.3)
            for cell in WHIPPLE}
    rows = []
    for cell, done in runs.items():
        if not done:
            continue
        E, h = done.audit("initial_energy"), done.history()
        total = h["kinetic_energy"] + h["internal_energy"] + h["removed_energy"]
        flight = (h["time"] > 2e-6) & (h["time"] < 9e-6)
        heat = (h["transfer_loss"] + h["transfer_gain"])[flight]
        rows.append([f"{cell} mm", *(f"{100 * done.audit(k) / E:.1f}" for k in ("kinetic_energy", "internal_energy",
                                                                               "removed_energy")),
                     f"{np.max(np.abs(total / total[0] - 1)):.0e}", f"{100 * (heat[-1] - heat[0]) / E:.2f}",
                     f"{done.measure('wall_momentum') / h['momentum_z'][0]:.3f}", value(done, "hole", 1e3, 2),
                     value(done, "crater", 1e3, 2), value(done, "wall_failed", 1e3, 2)])
    study.add_table(["cell", "KE", "IE", "removed", "sum - start", "transfer, 2-9 µs", "momentum of wall",
                     "hole mm", "crater mm", "failed of wall g"], rows)
    rows = []
    for cell, done in runs.items():
        if done:
            h = done.history()
            at = [int(np.argmin(np.abs(h["time"] - t))) for t in (5e-6, 10e-6, 25e-6)]
            rows.append([f"{cell} mm", *(f"{h[name][k]:.0f}" for name in ("sphere_T", "bumper_cloud_T", "wall_T")
                                         for k in at)])
    study.add("Mean temperatures in K of the sphere, of the bumper's debris below -5 mm, and of the wall within 10 "
              "mm of the axis, "
              "at 5, 10 and 25 µs (no melting, no vapour: the card has neither).")
    study.add_table(["cell", *(f"{what}, {t} µs" for what in ("sphere", "debris", "wall") for t in (5, 10, 25))], rows)
    pictures.shield(study, runs, "whipple.png")
    pictures.debris(study, runs, "debris.png")
    study.add("![Whipple shield](whipple.png)", "![debris at three cells](debris.png)")


def main():
    study = Study(__file__, "inputs/plate_impact.yaml", ESTIMATED_SECONDS, __doc__)
    discussion(study)
    for part in (shocks, noh, tube_and_blast, observers, spin, whipple):
        part(study)
    study.write("Energy")


if __name__ == "__main__":
    main()
