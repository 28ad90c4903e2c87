#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetric plate impact against the exact Hugoniot: 4 materials, 500 to 6000 m/s, three resolutions.

Writes README.md and pictures into its folder. `tools/validate plate_impact` builds first.
"""

import csv
import os
import sys

import h5py
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_runs import ROOT, Study  # noqa: E402

ESTIMATED_SECONDS = 60  # on two quiet cores

LENGTH = 20e-3
CELLS = (50, 100, 200)  # over the plate's thickness
SPEEDS = (500, 1000, 2000, 4000, 6000)
SECONDS = {50: 0.5, 100: 1, 200: 4}
WIDTH = 8  # cells; the lattice is not staggered across a plane of symmetry: a strip of 2 has twice the noise
EARLY, LATE = 0.4, 0.75  # times, in L / U_s: the shock has taken this share of the plate
BAND = (0.2, 0.7)        # the plateau, in shares of the front's exact position
PROFILES = (("Al 2024", 2000), ("Ta", 6000))


def hugoniot():
    with open(os.path.join(ROOT, "tests", "data", "hugoniot.csv"), newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    cases = {}
    for row in rows:
        x = {key: float(row[key]) for key in ("rho0", "c0", "s", "Gamma0", "u_p_m_s", "U_s_m_s", "P_Pa",
                                              "rho_over_rho0")}
        material = row["material"].partition(" (")[0].replace("4340/", "4340 ")
        cases[material, int(float(row["impact_velocity_symmetric_m_s"]))] = x
    return cases


def settings(x, speed, cells):
    h = LENGTH / cells
    late = LATE * LENGTH / x["U_s_m_s"]
    return [f"grid.cell={h:.9g}", f"grid.box={{min: [0, 0], max: [{WIDTH * h:.9g}, {LENGTH + 4 * h:.9g}]}}",
            f"time.end={late:.9g}", f"materials.al2024.density={x['rho0']}",
            f"materials.al2024.eos={{mie_gruneisen_shock: {{c0: {x['c0']}, S1: {x['s']}, gamma0: {x['Gamma0']}}}}}",
            f"materials.al2024.viscosity={{q_lin: {0.5 if speed > 4000 else 0.3}, q_quad: 2.0}}",
            f"bodies.plate.shape={{box: {{min: [-1, 0], max: [1, {LENGTH}]}}}}",
            f"bodies.plate.velocity=[0, {-x['u_p_m_s']}]",
            f"output={{frames: {late / 15:.9g}, history: {late / 100:.9g}, fields: [pressure, density]}}"]


class Profile:
    """Means over the points of one cell each, along z."""

    def __init__(self, run, time, h):
        with h5py.File(os.path.join(run.folder, "frames.h5"), "r") as file:
            names = sorted(file["frames"])
            times = [float(file["frames"][name].attrs["time"]) for name in names]
            nearest = int(np.argmin(np.abs(np.array(times) - time)))
            self.time = times[nearest]
            body = file["frames"][names[nearest]]["plate"]
            self.z, self.p, self.rho = (body["coordinates"][()][:, 2], body["pressure"][()].ravel(),
                                        body["density"][()].ravel())
        cell = (self.z / h).astype(int)
        count = np.bincount(cell)
        used = count > 0
        self.h, self.at = h, (np.arange(len(count))[used] + 0.5) * h
        self.mean_p = np.bincount(cell, self.p)[used] / count[used]
        self.mean_rho = np.bincount(cell, self.rho)[used] / count[used]

    def front(self, pressure):
        behind = np.nonzero(self.mean_p > 0.5 * pressure)[0][-1]
        high, low = self.mean_p[behind], self.mean_p[behind + 1]
        return self.at[behind] + self.h * (high - 0.5 * pressure) / (high - low)


def judge(run, x, cells):
    """Errors in per cent, and the profile."""
    h, late = LENGTH / cells, LATE * LENGTH / x["U_s_m_s"]
    early, end = Profile(run, EARLY / LATE * late, h), Profile(run, late, h)
    front = (x["U_s_m_s"] - x["u_p_m_s"]) * end.time
    band = (end.at > BAND[0] * front) & (end.at < BAND[1] * front)
    speed = (end.front(x["P_Pa"]) - early.front(x["P_Pa"])) / (end.time - early.time) + x["u_p_m_s"]
    inside = end.at < 1.3 * front
    exact = x["P_Pa"] * np.clip((front - end.at) / h + 0.5, 0, 1)
    near = end.z > BAND[1] * front
    wall = end.mean_rho[0]
    return {"p": 100 * (end.mean_p[band].mean() / x["P_Pa"] - 1),
            "rho": 100 * (end.mean_rho[band].mean() / (x["rho0"] * x["rho_over_rho0"]) - 1),
            "U": 100 * (speed / x["U_s_m_s"] - 1),
            "noise": 100 * end.p[(end.z > BAND[0] * front) & (end.z < BAND[1] * front)].std() / x["P_Pa"],
            "over": 100 * (end.p[near].max() / x["P_Pa"] - 1),
            "wall": 100 * (wall / (x["rho0"] * x["rho_over_rho0"]) - 1),
            "L1": np.abs(end.mean_p - exact)[inside].sum() * h / (front * x["P_Pa"]),
            "energy": run.error, "residual": run.audit("energy_residual_fraction"), "wall_time": run.wall,
            "profile": end, "front": front}


def draw(name, target, x, results):
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), constrained_layout=True)
    finest = max(results)
    for cells, r in sorted(results.items()):
        end = r["profile"]
        axes[0].plot(1e3 * end.z, 1e-9 * end.p, ".", ms=2.5, label=f"{cells} cells, every point")
        axes[1].plot(1e3 * end.z, 1e-3 * end.rho, ".", ms=2.5, label=f"{cells} cells, every point")
    front, edge = 1e3 * results[finest]["front"], 1e3 * (LENGTH - x["u_p_m_s"] * results[finest]["profile"].time)
    for plot, behind, ahead in ((axes[0], 1e-9 * x["P_Pa"], 0), (axes[1], 1e-3 * x["rho0"] * x["rho_over_rho0"],
                                                               1e-3 * x["rho0"])):
        plot.plot([0, front, front, edge], [behind, behind, ahead, ahead], "k-", lw=1, label="exact")
        plot.axvspan(BAND[0] * front, BAND[1] * front, color="0.93", zorder=0, label="plateau measured here")
        plot.set_xlabel("z [mm]")
    axes[0].set_ylabel("pressure [GPa]")
    axes[1].set_ylabel("density [g/cm³]")
    axes[0].legend(fontsize=8)
    figure.suptitle(name)
    figure.savefig(target, dpi=110)
    plt.close(figure)


def main():
    study = Study(__file__, "inputs/plate_impact.yaml", ESTIMATED_SECONDS, __doc__)
    cases = {key: x for key, x in hugoniot().items() if key[1] in SPEEDS}
    label = "{}_{}_{}".format
    jobs = {label(material.replace(" ", "_"), speed, cells): (settings(x, speed, cells), SECONDS[cells])
            for (material, speed), x in cases.items() for cells in CELLS}
    runs = study.run_all(jobs)
    results = {}
    for (material, speed), x in cases.items():
        for cells in CELLS:
            run = runs[label(material.replace(" ", "_"), speed, cells)]
            if run:
                results[material, speed, cells] = judge(run, x, cells)

    study.add("One plate of 20 mm moves at u_p = v/2 against the plane of symmetry z = 0: plane strain, a strip "
              "8 cells wide, default scheme, no strength, q_lin 0.3 (0.5 above 4 km/s), q_quad 2. Exact: "
              "Rankine-Hugoniot with linear U_s(u_p), tests/data/hugoniot.csv. At the end the shock has taken 3/4 of "
              "the plate.",
              "**Plateau**: mean over cells from 0.2 to 0.7 of the front's exact position; this leaves out the wall "
              "heating at the plane (last columns) and the front. **U_s**: from the positions where p falls through "
              "half the plateau, at 0.40 and 0.75 L/U_s. **Noise**: standard deviation of p over points in the band. "
              "**Overshoot**: the highest single point near the front. **Wall**: density of the cell at the plane, "
              "low by wall heating (Noh 1987), which every scheme with artificial viscosity has.")
    worst = {key: max((abs(r[key]), case) for case, r in results.items() if case[2] == 100)
             for key in ("p", "rho", "U", "energy")}
    study.add("At 100 cells the largest error is " + ", ".join(
        f"{worst[key][0]:.2f} % in {name} ({worst[key][1][0]}, {worst[key][1][1]} m/s)"
        for key, name in (("p", "pressure"), ("rho", "density"), ("U", "shock speed"), ("energy", "energy"))) +
        ". The issue allows 1 % in pressure and density: " +
        ("met in every case at every resolution." if all(abs(r[k]) < 1 for r in results.values() for k in ("p", "rho"))
         else "**missed** by " + ", ".join(f"{m} {v} m/s, {n} cells (p {r['p']:+.2f}, rho {r['rho']:+.2f})"
                                          for (m, v, n), r in results.items()
                                          if max(abs(r["p"]), abs(r["rho"])) >= 1) + "."))
    rows = []
    for (material, speed, cells), r in results.items():
        rows.append([f"{material}, {speed} m/s, {cells}", *(f"{r[k]:+.2f}" for k in ("p", "rho", "U")),
                     f"{r['noise']:.2f}", f"{r['over']:+.1f}", f"{r['wall']:+.1f}", f"{r['L1']:.4f}",
                     f"{r['energy']:+.2f}", f"{r['residual']:.0e}", f"{r['wall_time']:.1f}"])
    study.add_table(["material, speed, cells", "p %", "ρ %", "U_s %", "noise %", "overshoot %", "wall ρ %",
                     "L1 of p", "energy error %", "residual", "wall time s"], rows)
    study.add("## Observed order", "Of the L1 error of the pressure profile (a shock: first order at best), "
              "50 to 200 cells.")
    rows = []
    for material, speed in cases:
        errors = [results[material, speed, n]["L1"] for n in CELLS if (material, speed, n) in results]
        if len(errors) == len(CELLS):
            rows.append([f"{material}, {speed} m/s", f"{np.log2(errors[0] / errors[-1]) / 2:.2f}"])
    study.add_table(["case", "order"], rows)
    study.add("## Profiles")
    for material, speed in PROFILES:
        of = {n: results[material, speed, n] for n in CELLS if (material, speed, n) in results}
        if of:
            target = f"{material.replace(' ', '_').lower()}_{speed}.png"
            draw(f"{material}, {speed} m/s", os.path.join(study.folder, target), cases[material, speed], of)
            study.add(f"![{material}, {speed} m/s]({target})")
    study.write("Symmetric plate impact")


if __name__ == "__main__":
    main()
