#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The audit of a short Taylor impact: energy residual, energy error, mass, momentum; the price of each scheme."""

from scene_support import Folder, check, finish, history, run, summary

VALUES = ["time.end=20 us", "grid.cell=0.762 mm", "output.frames=0"]
# Scheme -> settings, greatest energy error (a fraction, measured, with a margin), greatest gap of axial momentum.
CLOSED = 1e-10
SCHEMES = {
    "tflip (default)": ([], 0.01, CLOSED),
    "flip": (["method.transfer=flip"], 0.03, CLOSED),
    "apic": (["method.transfer=apic"], 0.05, CLOSED),
    "xpic 2": (["method.transfer={xpic: {order: 2}}"], 0.10, CLOSED),
    "xpic 4": (["method.transfer={xpic: {order: 4}}", "time.energy_error=off"], 0.25, CLOSED),
    "flip, musl": (["method.transfer=flip", "method.update=musl"], 0.02, CLOSED),
    "flip, usf": (["method.transfer=flip", "method.update=usf"], 0.02, CLOSED),
    "apic, musl": (["method.transfer=apic", "method.update=musl"], 0.05, CLOSED),
    "alpha 0": (["method.energy_alpha=0"], 0.01, CLOSED),  # of Algorithm 1: the ledger closes whatever it is
    "alpha 1": (["method.energy_alpha=1"], 0.01, CLOSED),
    "flip, no cell averages": (["method.transfer=flip", "method.cell_averaging=false"], 0.03, CLOSED),
}


def momentum_gap(rows, axis, scale):
    change = rows[f"momentum_{axis}"] - rows[f"momentum_{axis}"][0]
    return float(max(abs(change - rows[f"wall_impulse_{axis}"]))) / scale


def audit(name, values, most, momentum):
    done = run(name, *values)
    if not check(done.returncode == 0, f"{name} runs", done.stderr.strip().splitlines()[-1]):
        return
    rows, a = history(name), summary(name)["audit"]
    scale = abs(rows["momentum_z"][0])
    residual = float(max(abs(rows["energy_residual"]))) / a["initial_energy"]
    mass = float(max(abs(rows["mass"] / rows["mass"][0] - 1)))
    gap = momentum_gap(rows, "z", scale)
    print(f"      {name:<24} energy error {100 * a['energy_error_fraction']:+7.3f} %   residual {residual:.1e}   "
          f"mass {mass:.1e}   axial momentum {gap:.1e}")
    check(residual < 1e-10, f"{name}: energy residual at round-off", f"{residual:.1e}")
    check(abs(a["energy_error_fraction"]) < most, f"{name}: energy error below {100 * most:g} %")
    check(mass < 1e-12 and a["events"]["removed_points"] == 0, f"{name}: mass is exact", f"{mass:.1e}")
    if momentum is not None:
        check(gap < momentum, f"{name}: momentum changes by the wall's impulse, within {momentum:g}", f"{gap:.1e}")


# Matter whose pressure does not know its energy (gamma0 = 0): an equation of state of that kind, and more settings.
SHOCK = "{mie_gruneisen_shock: {c0: 3933 m/s, S1: 1.5, gamma0: 0}}"
CRUSHED = ("{p_alpha: {solid_density: 8940 kg/m^3, c0: 3933 m/s, S1: 1.5, gamma0: 0, elastic_pressure: 0.1 GPa, "
           "compaction_pressure: 1 GPa}}")
POLYNOMIAL = "{mie_gruneisen_polynomial: {a0: 138.3 GPa, b0: 270 GPa, c0: 400 GPa, gamma0: 0}}"
MESH = ["bodies.rod.kinematics={lagrangian_mesh: {element: 0.762 mm}}"]
UNHEATED = {
    "linear": ("{linear: {bulk_modulus: 138.3 GPa}}", []),
    "shock": (SHOCK, []),
    "polynomial": (POLYNOMIAL, []),
    "porous, spall": (CRUSHED, ["materials.copper.density=8500 kg/m^3", "materials.copper.spall_strength=1 GPa"]),
    "linear, elements": ("{linear: {bulk_modulus: 138.3 GPa}}", MESH),
    "shock, elements": (SHOCK, MESH),
}
# Of the kinetic energy at the start; as for elastic discs against W of their law (verification/discs_and_spin). Plastic
# work is tens of percent of it and is no numerical heat.
UNFELT = 5e-3


def unheated(name, eos, settings):
    """Without a pressure of heat numerical_heat is what the ledger made heat, and nothing that the laws did."""
    values = ["materials.copper.card=copper_karamelo", f"materials.copper.eos={eos}", "time.energy_error=off"]
    done = run(name, *VALUES, *values, *settings)
    if not check(done.returncode == 0, f"{name} runs", done.stderr.strip().splitlines()[-1:]):
        return
    a = summary(name)["audit"]
    made = a["transfer_loss"] + a["transfer_gain"] + a["wall_heat"] + a["contact_heat"]
    off, work = (x / a["initial_energy"] for x in (a["numerical_heat"] - made, a["plastic_work"]))
    print(f"      {name:<24} numerical heat {a['numerical_heat']:+.4f} J, of the ledger {made:+.4f} J, plastic {work:.2f}")
    check(work > 0.1, f"{name}: flows")
    check(abs(off) < UNFELT, f"{name}: numerical heat is the ledger's, within {100 * UNFELT:g} % of KE0", f"{off:+.1e}")


with Folder():
    for test, (eos, settings) in UNHEATED.items():
        unheated(test, eos, settings)
    for scheme, (settings, most, momentum) in SCHEMES.items():
        audit(scheme, VALUES + settings, most, momentum)
    found = [summary(name)["measures"]["final_length"]["value"] for name in ("alpha 0", "tflip (default)", "alpha 1")]
    check(len(set(found)) == 3 and max(found) - min(found) < 1e-3 * found[1], "alpha is felt, but little", found)
    space = ["frame=3d", "grid.cell=0.762 mm", "time.end=3 us", "output.frames=0", "method.transfer=flip"]
    audit("3d flip", space, 0.03, CLOSED)
    across = history("3d flip")
    check(all(momentum_gap(across, axis, abs(across["momentum_z"][0])) < 1e-10 for axis in "xy"),
          "3d flip: momentum across the axis stays zero")
finish()
