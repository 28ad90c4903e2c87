# SPDX-License-Identifier: GPL-3.0-or-later
"""The strength of a pressure-dependent material as a laboratory finds it, by `krater point`: meridians, deviatoric
sections, pressure over compression with releases, softening. For tools/plot_point --surface and validation/concrete.

A meridian is the largest q of triaxial tests at several confinements; a section the largest q of straight paths at
constant volume after compression to a pressure, at seven Lode angles, mirrored to the full circle. Strains grow at
1e-6 /s, so no law adds a rate.
"""

import os
import subprocess

import h5py
import numpy as np
import yaml

RATE = 1e-6
CONFINED = (0, 0.1, 0.25, 0.5, 1, 2, 4)  # lateral pressures over the scale
SECTIONS = (0.5, 1, 3)                   # pressures over the scale
RELEASED = (1, 3, 8, 20)                 # pressures of the hydrostat over the scale
ANGLES = (0, 10, 20, 30, 40, 50, 60)     # degrees from the tensile meridian


class Laboratory:
    """Tests of one material: flow YAML without braces. `scale` [Pa]: the unconfined strength, or P_HEL of a ceramic;
    `strain`: how far a test goes at the scale."""

    def __init__(self, krater, folder, material, scale, strain=0.01, length=5e-3):
        self.krater, self.folder, self.material = krater, folder, material
        self.scale, self.strain, self.length = scale, strain, length
        self.notes = []
        os.makedirs(folder, exist_ok=True)

    def test(self, label, path, steps=2000):
        """Columns of `krater point` along a path; of what it reached where it ended early, None where it did not run."""
        scene = os.path.join(self.folder, label + ".yaml")
        out = os.path.join(self.folder, label + "_out")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(f"materials: {{m: {{{self.material}}}}}\n"
                       f"point: {{path: {{{path}}}, steps: {steps}, length: {self.length:g}}}\n")
        table = os.path.join(out, "point.h5")
        if os.path.exists(table):
            os.remove(table)
        done = subprocess.run([self.krater, "point", scene, "-o", out], capture_output=True, text=True, check=False)
        said = [line for line in done.stderr.splitlines() if "snaps back" in line or done.returncode]
        self.notes += [f"{label}: {line.split(': ', 3)[-1]}" for line in said]
        if not os.path.exists(table):
            return None
        with h5py.File(table, "r") as file:
            return {name: item[()] for name, item in file.items()}

    def triaxial(self, share, sign, factor=1.0):
        """Compression (-1) or extension (+1) under a lateral pressure."""
        name = "compression" if sign < 0 else "extension"
        strain = sign * factor * self.strain * (1 + 3 * share if sign < 0 else 0.5 + share)
        lateral = f", lateral_stress: {-share * self.scale:g} Pa" if share else ""
        kind = "triaxial" if share else "uniaxial_stress"
        return self.test(f"{name}_{share:g}", f"{kind}: {{strain: {strain:g}, rate: {RATE:g}{lateral}}}")

    def meridian(self, sign):
        """p and q [Pa] at the largest q of each test."""
        found = []
        for share in CONFINED:
            table = self.triaxial(share, sign)
            if table is None:
                continue
            turned = table["stress_xx"] < table["stress_yy"] if sign < 0 else table["stress_xx"] > table["stress_yy"]
            q = np.where(turned, table["von_mises"], 0)
            k = int(q.argmax())
            found.append((table["pressure"][k], q[k]))
        return np.array(sorted(found))

    def hydrostat(self):
        turns = ", ".join(f"{share * self.scale:g} Pa, 0 Pa" for share in RELEASED)
        return self.test("hydrostat", f"hydrostatic: {{pressure: [{turns}], rate: {RATE:g}}}", 4000)

    def section(self, hydrostat, share):
        """Angles [degrees] over the full circle and the largest q [Pa] there, near a pressure of `share` scales."""
        p = np.maximum.accumulate(hydrostat["pressure"])
        volume = float(np.interp(share * self.scale, *unique(p, np.log(hydrostat["density"] / hydrostat["density"][0]))))
        strain, found = self.strain * (0.5 + share), []
        for angle in ANGLES:
            d = [strain * np.cos(np.radians(angle - 120 * k)) for k in range(3)]
            f = ", ".join(f"exp({-volume / 3:.12g}*min(t/1e6,1)+({x:.12g})*max(t/1e6-1,0))" for x in d)
            quoted = ", ".join(f'"{x}"' for x in f.split(", "))
            table = self.test(f"section_{share:g}_{angle}", f"stretch: {{F: [{quoted}], time: 2e6}}")
            found.append(np.nan if table is None else table["von_mises"].max())
        half = np.array(found)
        angles = np.array(ANGLES, float)
        third = np.concatenate([half, half[-2::-1]])  # 0 to 120 degrees
        turned = np.concatenate([angles, 120 - angles[-2::-1]])
        return np.concatenate([turned + 120 * k for k in range(3)]), np.tile(third, 3)


def laboratory_of(krater, material, folder):
    """Tests of a material whose scale is read from its law; ValueError where it has no strength that depends on p."""
    os.makedirs(folder, exist_ok=True)
    scene, out = os.path.join(folder, "law.yaml"), os.path.join(folder, "law_out")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(f"materials: {{m: {{{material}}}}}\n"
                   "point: {path: {uniaxial_stress: {strain: -1e-5, rate: 1}}, steps: 1, length: 1 mm}\n")
    done = subprocess.run([krater, "point", scene, "-o", out, "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode:
        raise ValueError(done.stderr.strip())
    with open(os.path.join(out, "resolved.yaml"), encoding="utf-8") as file:
        law = next(iter(yaml.safe_load(file)["materials"]["m"].get("model", {"": {}}).values()))
    for key, strain in (("compressive_strength", 0.01), ("P_HEL", 0.1), ("c0", 0.01)):
        if key in law:
            return Laboratory(krater, folder, material, float(law[key]), strain)
    raise ValueError(f"{material}: no law of concrete or ceramic (model:)")


def unique(x, y):
    """Increasing x for np.interp."""
    kept = np.concatenate([[True], np.diff(x) > 0])
    return x[kept], y[kept]


def measure(laboratory):
    """All that the picture shows."""
    hydrostat = laboratory.hydrostat()
    sections = {share: laboratory.section(hydrostat, share) for share in SECTIONS} if hydrostat is not None else {}
    return {"hydrostat": hydrostat, "sections": sections,
            "compression": laboratory.meridian(-1), "extension": laboratory.meridian(+1),
            "unconfined": laboratory.triaxial(0, -1, 2), "confined": laboratory.triaxial(1, -1, 2),
            "tension": laboratory.test("tension", f"uniaxial_stress: {{strain: {0.2 * laboratory.strain:g}, "
                                                  f"rate: {RATE:g}}}")}


def draw(figure, results, title, unit=1e6, name="MPa"):
    """Four panels of one or several materials: label -> measure(...)."""
    import matplotlib.pyplot as plt
    grid = figure.subplots(2, 2)
    round_one = figure.add_subplot(2, 2, 2, projection="polar")
    grid[0][1].remove()
    colours = plt.rcParams["axes.prop_cycle"].by_key()["color"]
    for colour, (label, r) in zip(colours, results.items()):
        for meridian, style in (("compression", "o-"), ("extension", "s--")):
            if len(r[meridian]):
                grid[0][0].plot(r[meridian][:, 0] / unit, r[meridian][:, 1] / unit, style, color=colour, ms=4,
                                label=f"{label}, {'compressive' if meridian == 'compression' else 'tensile'} meridian")
        for share, (angles, q) in r["sections"].items():
            round_one.plot(np.radians(angles), q / unit, color=colour, lw=0.8 + 0.3 * share)
        if r["hydrostat"] is not None:
            h = r["hydrostat"]
            grid[1][0].plot(h["density"] / h["density"][0] - 1, h["pressure"] / unit, color=colour, label=label)
        for test, style in (("unconfined", "-"), ("confined", "--"), ("tension", ":")):
            if r[test] is not None:
                t = r[test]
                grid[1][1].plot(100 * np.abs(t["strain_xx"]), t["von_mises"] / unit, style, color=colour)
    grid[0][0].set(xlabel=f"p at the peak [{name}]", ylabel=f"q [{name}]", title="meridians")
    round_one.set_title("deviatoric sections, q; 0: tensile, 60: compressive", fontsize=10)
    round_one.tick_params(labelsize=7)
    grid[1][0].set(xlabel="density/density at rest - 1", ylabel=f"p [{name}]", title="pressure and its release")
    grid[1][1].set(xlabel="axial strain [%]", ylabel=f"q [{name}]",
                   title="unconfined (-), confined by one scale (--), tension (:)")
    grid[0][0].legend(frameon=False, fontsize=8)
    figure.suptitle(title, fontsize=12)
