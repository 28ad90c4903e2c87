#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Concrete and ceramic through the whole program: the tests of a laboratory by krater point, generated cards, what is
said where a law snaps back, mistakes of users, the picture of a surface."""

import itertools
import os
import pathlib
import re
import subprocess
import sys

import numpy as np

from scene_support import Folder, ROOT, check, finish, krater, settings, summary, table

counter = itertools.count()
GENERATED = "card: {concrete: {fc: 39.3 MPa, model: karagozian_case}}, rate: jaumann"
CSCM = "card: {concrete: {fc: 39.3 MPa, model: cscm}}, rate: jaumann"
RHT = "card: concrete_c30_37_rht, rate: jaumann"


def point(material, path, steps=1000, more="", values=(), code=0):
    """Table, summary and what was said."""
    number = next(counter)
    name, folder = f"c{number}.yaml", f"c{number}_out"
    pathlib.Path(name).write_text(
        f"materials: {{m: {{{material}}}}}\npoint: {{path: {{{path}}}, steps: {steps}{more}}}\n", encoding="utf-8")
    done = krater("point", name, "-o", folder, *settings(values))
    if done.returncode != code:
        check(False, f"exit code {code}: {material}: {path}", f"{done.returncode}: {done.stderr.strip()}")
        return None
    return (table(folder, "point.csv"), summary(folder), done.stderr) if code == 0 else done.stderr


def near(what, value, expected, tolerance):
    check(abs(value / expected - 1) <= tolerance, what, f"{value:.6g} for {expected:.6g} (allowed {tolerance:.0e})")


def laboratory():
    """Values of the design's B1.6 (concrete of 48 MPa) and of the anchors of Karagozian and Case."""
    card = "card: concrete_48, rate: jaumann"
    t, _, _ = point(card, "hydrostatic: {compression: [0.05, 0.0416, 0.05], rate: 1}", 2000)
    near("hydrostat at mu = 0.05", t["pressure"][-1], 366.6572e6, 1e-5)
    near("returns on the same line", t["pressure"].max(), t["pressure"][-1], 1e-9)
    t, _, _ = point(card, "hydrostatic: {pressure: [100 MPa, 0 Pa, 50 MPa], rate: 1}", 600)
    near("hydrostat by pressure ends there", t["pressure"][-1], 50e6, 1e-9)
    near("what stays after 100 MPa", (t["density"] / 2440 - 1)[t["pressure"].argmax():][np.abs(
        t["pressure"][t["pressure"].argmax():]).argmin()], 0.0083063, 2e-3)
    t, _, _ = point(card, "hydrostatic: {compression: -0.005, rate: 1}", 100)
    near("triaxial tension ends at T", -t["pressure"].min(), 4e6, 1e-9)
    t, _, _ = point(card, "uniaxial_stress: {strain: 0.0005, rate: 1}", 4000)
    near("direct tension: a stress of 2.28 T", t["stress_xx"].max(), 9.115385e6, 1e-3)
    t, _, _ = point(card, "uniaxial_stress: {strain: -0.005, rate: 1}", 4000)
    near("unconfined", -t["stress_xx"].min(), 95.38146e6, 1e-3)
    length, slow = ", length: 5 mm", "rate: 1e-8"  # no rate factor, whatever flows sideways
    t, _, _ = point(GENERATED, f"biaxial: {{strain: -0.004, {slow}}}", 4000, length)
    near("biaxial compression 1.15 f", -t["stress_xx"].min(), 1.15 * 39.3e6, 2e-3)
    near("nothing holds its face", np.abs(t["stress_zz"]).max() + 1e6, 1e6, 1e-3)
    t, _, _ = point(GENERATED, f"biaxial: {{strain: 0.0005, {slow}}}", 4000, length)
    near("biaxial tension f_t", t["stress_xx"].max(), 3.476398e6, 3e-3)
    t, _, _ = point(GENERATED, f"triaxial: {{strain: 0.002, {slow}, lateral_stress: -40 MPa}}", 4000, length)
    check((t["stress_xx"] > t["stress_yy"] + 1e6).any() and t["von_mises"].max() > 20e6, "extension under 40 MPa",
          f"q {t['von_mises'].max():.4g}")


def energy():
    """Direct tension of the generated cards dissipates G_f (CEB, 68.0 J/m^2) whatever the length."""
    for card, strain in ((GENERATED, 0.04), (CSCM, 0.5)):
        for length in (2.5, 5, 10):
            t, s, _ = point(card, f"uniaxial_stress: {{strain: {strain / length}, rate: 1e-9}}", 8000,
                            f", every: 8, length: {length} mm")
            near(f"work per area at {length} mm", t["work"][-1] * 2300 * length * 1e-3, 68.0, 0.05)
            check(s["events"]["failures"] == 1, "it has failed")


def cap_and_pores():
    """The cap model and RHT by the whole program, and not by its law alone: rows of the cap model, design's B8."""
    whole = CSCM + ", model: {cscm: {softening: none, rate_factor: none}}"
    t, _, _ = point(whole, "uniaxial_stress: {strain: -0.004, rate: 1e-9}", 2000)
    near("unconfined strength of the cap model", t["von_mises"][-1], 1.000514 * 39.3e6, 1e-3)
    t, _, _ = point(whole, "hydrostatic: {pressure: [200 MPa, 0 Pa], rate: 1e-9}", 400)
    near("hydrostat of the cap model", np.log(t["density"].max() / 2300), 0.02423404, 1e-5)
    t, _, _ = point(RHT, "uniaxial_stress: {strain: -0.004, rate: 1e-9}", 2000)
    near("unconfined strength of RHT", t["von_mises"].max(), 35e6, 2e-3)
    for confined, expected in ((10, 53.33), (40, 88.42), (100, 136.0)):  # by the law alone, without the driver
        t, _, _ = point(RHT, f"triaxial: {{strain: -0.03, rate: 1e-9, lateral_stress: -{confined} MPa}}", 2000)
        near(f"strength of RHT under {confined} MPa", t["von_mises"].max(), expected * 1e6, 2e-3)
    t, _, _ = point(RHT, "uniaxial_stress: {strain: 0.0005, rate: 1e-9}", 2000)
    near("direct tension of RHT", t["stress_xx"].max(), 3.5e6, 2e-3)


def said():
    _, s, text = point(GENERATED, "uniaxial_stress: {strain: -0.006, rate: 1e-6}", 2000, ", length: 5 mm")
    check("the law snaps back" in text and s["events"]["snap_backs"] >= 1, "a snap-back is said, not crashed on", text)
    check(re.search(r"generated from the strength, uncalibrated: E = 2.5197e\+10 Pa, Poisson's ratio 0.19", text) is not None,
          "a generated card says so, with what it implies", text)
    _, _, text = point(CSCM, "uniaxial_stress: {strain: -0.001, rate: 1e-6}", 100, ", length: 5 mm")
    check("first cap X0 of set fhwa = 9.5513e+07 Pa, unconfined strength over compressive_strength = 1.0005" in text,
          "the cap model says its set and what it closes at", text)
    _, s, text = point("card: concrete_48", "uniaxial_stress: {strain: -0.005, rate: 1}")
    check("snaps back" not in text and s["events"]["snap_backs"] == 0, "softening alone is no snap-back")


def refused(what, expected, material, path="uniaxial_stress: {strain: 0.1, rate: 1}", more=""):
    text = point(material, path, 10, more, code=2) or ""
    missing = [e for e in expected if not re.search(e, text)]
    check(not missing, what, text.strip() if missing else "")


def mistakes():
    refused("f'c outside the range", [r"c\d+\.yaml:1: materials\.m\.model\.karagozian_case", "10 to 100 MPa",
                                     "holmquist_johnson_cook"],
            "card: {concrete: {fc: 150 MPa, model: karagozian_case}}", more=", length: 5 mm")
    refused("f'c outside the cap model's range", ["fc of a generated card", "20 to 58 MPa", "karagozian_case"],
            "card: {concrete: {fc: 15 MPa, model: cscm}}", more=", length: 5 mm")
    refused("a confinement with the wrong sign", ["does not bear a mean tension of 5e.07 Pa", "negative lateral_stress"],
            "card: concrete_48", "triaxial: {strain: -0.01, rate: 1, lateral_stress: 50 MPa}")
    refused("a strength without its unit", ["10 to 100 MPa", "write 39 MPa"],
            "card: {concrete: {fc: 39, model: karagozian_case}}", more=", length: 5 mm")
    refused("the same of the cap model", ["20 to 58 MPa", "write 39 MPa"], "card: {concrete: {fc: 39, model: cscm}}",
            more=", length: 5 mm")
    refused("a model that has cards, not rules", ["no rule makes the constants of holmquist_johnson_cook", "card: concrete_48"],
            "card: {concrete: {fc: 39 MPa, model: holmquist_johnson_cook}}")
    refused("a card with a wrong key", ["unknown key 'fck'", "did you mean fc"], "card: {concrete: {fck: 39 MPa, model: cscm}}")
    refused("a spall strength beside a model", [r"remove spall \(spall_strength\)"], "card: concrete_48, spall_strength: 3 MPa")
    for key, meant in (("aggregate_size: 9.5", "mm meant"), ("density: 2.3", r"g/cm\^3 meant")):
        _, _, text = point(f"card: {{concrete: {{fc: 39 MPa, model: cscm, {key}}}}}", "uniaxial_stress: {strain: -0.001, rate: 1}",
                           10, ", length: 5 mm")
        check(re.search(f"krater: doubt: m: .*{meant}", text) is not None, f"{key} is doubted", text)
    _, _, text = point("card: concrete_48", "uniaxial_stress: {strain: -0.001, rate: 1}", 10)
    check("doubt" not in text, "a sound card is not doubted", text)
    refused("a model that cannot be generated", [r"materials\.m\.card\.concrete\.model", "known: karagozian_case"],
            "card: {concrete: {fc: 39 MPa, model: holmquist}}")
    refused("no strength to generate from", ["missing key 'fc'", "in Pa"], "card: {concrete: {model: karagozian_case}}")
    refused("a card of neither kind", ["what one is made from", "keywords:"], "card: {steel: {}}")
    refused("a model beside a strength", ["gives strength, pressure and damage: remove strength"],
            "card: concrete_48, strength: {von_mises: {Y: 1 MPa}}")
    whole = (ROOT / "inputs/materials/concrete_48.yaml").read_text(encoding="utf-8")
    pathlib.Path("no_limit.yaml").write_text(re.sub(r"    tensile_strength.*\n", "", whole), encoding="utf-8")
    refused("a card without a tension limit", ["missing key 'tensile_strength'", "mean tension"], "card: ./no_limit.yaml")
    refused("a surface that never closes", ["never closes", "meridians"],
            "density: 2300, model: {karagozian_case: {compressive_strength: 39 MPa, a0: 0, a1: 5}}", more=", length: 5 mm")
    refused("a cap within the first", ["first cap"],
            "density: 2300, youngs_modulus: 30 GPa, poisson_ratio: 0.2, model: {drucker_prager: {compressive_strength: "
            "39 MPa, tensile_strength: 4 MPa, lock_pressure: 20 MPa}}")
    refused("a length that snaps back", [r"point: .*would snap back", "largest is 0.1", "fracture_energy"], GENERATED,
            more=", length: 1 m")
    refused("no length for an energy per area", ["missing key 'length'", "energy"], GENERATED)
    refused("elastic constants beside a model with its own", ["own shear modulus", "remove"],
            GENERATED + ", shear_modulus: 10 GPa", more=", length: 5 mm")
    refused("both kinds of hydrostat", ["one of compression .* and pressure"], "card: concrete_48",
            "hydrostatic: {compression: 0.1, pressure: 1 MPa, rate: 1}")
    refused("stretched beyond nothing", ["must exceed -1"], "card: concrete_48", "hydrostatic: {compression: -1, rate: 1}")
    scene = (ROOT / "inputs" / "taylor_copper.yaml").read_text(encoding="utf-8")
    if "card:" in scene:
        wide = re.sub(r"card: [\w]+", GENERATED.removesuffix(", rate: jaumann"), scene, count=1)
        wide = re.sub(r"cell: [^\n]*", "cell: 1 m", wide, count=1)
        pathlib.Path("wide.yaml").write_text(wide, encoding="utf-8")
        done = krater("check", "wide.yaml")
        check(done.returncode == 2 and "would snap back" in done.stderr, "a cell that snaps back", done.stderr.strip())
        brittle = GENERATED.removesuffix(", rate: jaumann") + "\n    model: {karagozian_case: {fracture_energy: 0.5 J/m^2}}"
        for kinematics, what in (("lagrangian_mesh: {element: 2 mm}", "elements"), ("sph: {spacing: 2 mm}", "particles")):
            other = re.sub(r"card: [\w]+", brittle, scene, count=1)
            other = re.sub(r"    material: copper", f"    kinematics: {{{kinematics}}}\n    material: copper", other, count=1)
            pathlib.Path("wide.yaml").write_text(re.sub(r"cell: [^#]*#", "cell: 2 mm #", other, count=1), encoding="utf-8")
            done = krater("check", "wide.yaml")
            check(done.returncode == 2 and f"in {what} of 0.00" in done.stderr and "would snap back" in done.stderr,
                  f"{what} that snap back", done.stderr.strip())



def picture():
    command = [sys.executable, ROOT / "tools" / "plot_point", "--surface", "copper", "-o", "x.png"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    check(done.returncode == 2 and "no card" in done.stderr, "a surface of no card", done.stderr.strip())
    command[3] = "card: ofhc_copper"
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    check(done.returncode == 2 and "no law of concrete" in done.stderr, "a surface of a metal", done.stderr.strip())


with Folder():
    laboratory()
    energy()
    cap_and_pores()
    said()
    mistakes()
    picture()
finish()
