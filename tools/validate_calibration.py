# SPDX-License-Identifier: GPL-3.0-or-later
"""Problems with known answers for validation/calibration: scenes by cell, and what their measures are exactly.

A problem is text by cells along its length, the cells, and {measure: (kind as YAML, exact)}. Strips are as wide as four
cells between planes of symmetry, so only means and lengths along z are asked of them."""

import dataclasses
import pathlib
import re

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import j0, j1

import validate_calibration_more as more
from validate_energy import MATERIALS, NOH_SIDES, behind_shock
from validate_energy_exact import sod_exact

FINE = (25, 50, 100, 200)
SOLUTIONS = pathlib.Path(__file__).resolve().parents[1] / "validation" / "solutions"


@dataclasses.dataclass
class Problem:
    name: str
    scene: object  # cells -> text without measures
    measures: dict  # name -> (YAML, exact)
    cells: tuple = FINE
    free: bool = False  # no axis has conditions at both sides: cells may be a few per cent off
    asked: dict = None  # measures of the scene (YAML), where they are not the ones that are judged
    found: object = None  # (run, name) -> value, where it is no measure of the scene
    point: bool = False  # a file for `krater point`, cells are steps, measures columns of point.csv at the end

    def text(self, cells):
        asked = self.asked or {name: kind for name, (kind, _) in self.measures.items()}
        return self.scene(cells) + ("" if self.point else "measures:\n" + "".join(
            f"  {name}: {{{kind}}}\n" for name, kind in asked.items()))


def mean(body, field, region=""):
    return f"kind: mean, body: {body}, field: {field}{', region: {' + region + '}' if region else ''}"


def velocity(body, region=""):
    return f"kind: mean_velocity, body: {body}, axis: z{', region: {' + region + '}' if region else ''}"


def strip(cells, end, materials, bodies, length=1.0, room=0.1, low=0.0, side="symmetry", more=""):
    """Bodies {name: (material, z from, z to, velocity)} in a strip of `length` from `low`, open above."""
    h = length / cells
    steps = int(np.ceil(room * length / h))
    lines = "".join(f"  {name}: {{material: {m}, shape: {{box: {{min: [-1e3, -1e3, {a!r}], max: [1e3, 1e3, {b!r}]}}}}, "
                    f"velocity: [0, {v}]}}\n" for name, (m, a, b, v) in bodies.items())
    bottom = low - (steps * h if side == "open" else 0)
    return (f"frame: plane_strain\ngrid: {{cell: {h!r}, box: {{min: [0, {bottom!r}], max: [{4 * h!r}, "
            f"{low + length + steps * h!r}]}}, boundary: {{x_min: symmetry, x_max: symmetry, z_min: {side}}}}}\n"
            f"time: {{end: {end!r}}}\nmaterials:\n{materials}bodies:\n{lines}output: "
            f"{{frames: 0, history: {end / 20!r}}}\n{more}")


def shock(name, u):
    """A plate against a plane: Hugoniot states while the shock is on its way."""
    x = MATERIALS[name]
    exact = behind_shock(x, u)
    length, end = 0.02, 0.75 * 0.02 / exact["U"]
    front = (exact["U"] - u) * end
    inside = f"z_min: {0.3 * front!r}, z_max: {0.7 * front!r}"
    material = (f"  m: {{density: {x['rho0']!r}, initial_temperature: 300, heating: {{energy: {{c_v: {x['c_v']!r}}}}}, "
                f"viscosity: {{q_lin: 0.5, q_quad: 2.0}}, eos: {{mie_gruneisen_shock: {{c0: {x['c0']!r}, "
                f"S1: {x['s']!r}, gamma0: {x['Gamma0']!r}}}}}}}\n")
    return Problem(f"shock in {name}, {1e-3 * u:g} km/s",
                   lambda cells: strip(cells, end, material, {"plate": ("m", 0.0, length, -u)}, length),
                   {"velocity": (velocity("plate"), -0.25 * u),
                    "thickness": ("kind: extent, body: plate, axis: z", length - u * end),
                    "density": (mean("plate", "density", inside), exact["rho"]),
                    "pressure": (mean("plate", "pressure", inside), x["rho0"] * exact["U"] * u),
                    "energy": (mean("plate", "internal_energy", inside), exact["e"]),
                    "temperature": (mean("plate", "temperature", inside), exact["T"])})


def noh(kind):
    d = {"planar": 1, "cylindrical": 2, "spherical": 3}[kind]
    frame = "axisymmetric" if d == 3 else "plane_strain"
    a = "r" if d == 3 else "x"
    shape = ("{box: {min: [-1, 0, 0], max: [1, 1, 1]}}" if d == 1 else "{sphere: {radius: 1, center: [0, 0, 0]}}"
             if d == 3 else
             "{cylinder: {radius: 1, height: 1, axis: y, base: [0, -0.5, 0]}}")
    speed = "[0, -1]" if d == 1 else f'["-{a}/sqrt({a}^2+z^2)", "-z/sqrt({a}^2+z^2)"]'

    def scene(cells):
        h = 1 / cells
        wide = 8 * h if d == 1 else 1 + 4 * h
        return (f"frame: {frame}\ngrid: {{cell: {h!r}, box: {{min: [0, 0], max: [{wide!r}, {1 + 4 * h!r}]}}, boundary: "
                f"{{{NOH_SIDES[kind]}}}}}\ntime: {{end: 0.6}}\nmaterials: {{gas: "
                f"{{density: 1, eos: {{ideal_gas: {{gamma: "
                f"1.6666666666667, initial_pressure: "
                f"1e-6}}}}, viscosity: {{}}}}}}\nbodies: {{a: {{material: gas, shape: {shape}, "
                f"velocity: {speed}}}}}\noutput: {{frames: 0, history: 0.1}}\n")
    inside = "z_min: 0.05, z_max: 0.12" + ("" if d == 1 else f", {a}_max: 0.12")
    return Problem(f"Noh, {kind}", scene,
                   {"energy": (mean("a", "internal_energy"), 0.5 * 4.0**d * 0.2**d),
                    "density": (mean("a", "density", inside), 4.0**d),
                    "edge": ("kind: max, body: a, axis: z", 0.4)}, FINE if d == 1 else (20, 40, 80), d > 1)


def sod():
    gas = "density: {}, eos: {{ideal_gas: {{gamma: 1.4, initial_pressure: {}}}}}, viscosity: {{q_lin: 0.3, q_quad: 2}}"
    contact = 0.5 + 0.927452620 * 0.2

    def scene(cells):
        return strip(cells, 0.2, f"  a: {{{gas.format(1, 1)}}}\n  b: {{{gas.format(0.125, 0.1)}}}\n",
                     {"high": ("a", 0.0, 0.5, 0), "low": ("b", 0.5, 1.0, 0)}, room=0).replace(
                         "z_min: symmetry", "z_min: symmetry, z_max: symmetry")
    energy = quad(lambda z: np.prod(sod_exact(np.array(z))), 0, contact, points=[0.26, 0.49], limit=400)[0] / 0.5
    return Problem("Sod's tube", scene, {
        "velocity": (velocity("[high, low]"), 0.18 / 0.5625), "contact": ("kind: max, body: high, axis: z", contact),
        "energy": (mean("high", "internal_energy"), energy),
        "shocked_density": (mean("low", "density", "z_min: 0.72, z_max: 0.82"), float(sod_exact(np.array(0.77))[0])),
        "plateau": (velocity("high", "z_min: 0.55, z_max: 0.65"), 0.927452620)})


RHO, K, G = 7850.0, 163.5e9, 80e9
C = float(np.sqrt((K + 4 / 3 * G) / RHO))


def elastic(name="steel", rho=RHO, k=K, more="strength: elastic"):
    return (f"  {name}: {{density: {rho!r}, bulk_modulus: {k!r}, shear_modulus: {G!r}, eos: linear, {more}, viscosity: "
            "{q_lin: 0.1, q_quad: 2}}\n")


def bar_mode():
    """The free bar's first mode at an eighth of its period: v = V cos(pi z/L) cos(w t)."""
    end = 0.25 / C  # w = pi C/L, L = 1: w t = pi/4
    return Problem("bar, first mode", lambda cells: strip(
        cells, end, elastic().replace("viscosity: {q_lin: 0.1, q_quad: 2}", "viscosity: none"),
        {"bar": ("steel", 0.0, 1.0, '"cos(pi*z)"')}, side="open"),
        {"lower_half": (velocity("bar", "z_max: 0.5"), 2 / np.pi * np.sqrt(0.5)),
         "length": ("kind: extent, body: bar, axis: z", 1 - 2 / (np.pi * C) * np.sqrt(0.5))})


def bar_wall():
    return Problem("bar against a plane", lambda cells: strip(
        cells, 0.6 / C, elastic(), {"bar": ("steel", 0.0, 1.0, -1.0)}),
        {"velocity": (velocity("bar"), -0.4), "stress": (mean("bar", "pressure", "z_min: 0.1, z_max: 0.4"), K / C)})


def plastic_wall():
    """Two waves: elastic to the Hugoniot limit, plastic with sqrt(K/rho) behind it; strains of 1e-4."""
    v, slow = 1.0, np.sqrt(K / RHO)
    stress = 0.4 * RHO * C * v  # of the elastic limit
    y = stress * 2 * G / (K + 4 / 3 * G)
    behind = stress + RHO * slow * 0.6 * v
    end = 0.6 / C
    return Problem("two waves, elastic and plastic", lambda cells: strip(
        cells, end, elastic(more=f"strength: {{von_mises: {{Y: {y!r}, H: 0}}}}"), {"bar": ("steel", 0.0, 1.0, -v)}),
        {"velocity": (velocity("bar"), -v + behind * end / RHO),
         "precursor": (velocity("bar", "z_min: 0.5, z_max: 0.57"), -0.6 * v),
         "pressure": (mean("bar", "pressure", "z_min: 0.1, z_max: 0.35"), behind - 2 / 3 * y)})


def bars(name, k_other):
    """A bar strikes one at rest, with `contact:`; both half a metre. The struck bar's impulse while no wave is back."""
    other = np.sqrt((k_other + 4 / 3 * G) / RHO)
    z1, z2 = RHO * C, RHO * other
    v = z1 / (z1 + z2)  # of the joint, striker at 1 m/s
    end = 0.4 / max(C, other)
    return Problem(f"contact of {name} bars", lambda cells: strip(
        cells, end, elastic() + elastic("other", k=k_other),
        {"low": ("other", 0.0, 0.5, 0), "up": ("steel", 0.5, 1.0, -1)},
        side="open", more="contact: {friction: 0}\n"),
        {"struck": (velocity("low"), -z2 * v * end / (RHO * 0.5)),
         "striker": (velocity("up"), -1 + z2 * v * end / (RHO * 0.5)),
         "joint": (velocity("low", "z_min: 0.3, z_max: 0.45"), -v)})


def gas_wall():
    """A gas at Mach 1.69 against a wall: Rankine-Hugoniot."""
    gamma, u = 1.4, 2.0
    b = (gamma + 1) / 4 * u
    speed = b + np.sqrt(b * b + gamma)  # of the shock in the gas ahead, p = rho = 1
    p, rho = 1 + speed * u, speed / (speed - u)
    end = 0.7 / speed
    front = (speed - u) * end
    inside = f"z_min: {0.3 * front!r}, z_max: {0.8 * front!r}"
    material = (f"  gas: {{density: 1, eos: {{ideal_gas: {{gamma: {gamma}, initial_pressure: 1}}}}, "
                "viscosity: {q_lin: 0.3, q_quad: 2}}\n")
    return Problem("gas against a wall", lambda cells: strip(cells, end, material, {"gas": ("gas", 0.0, 1.0, -u)},
                                                             room=1).replace(
        "z_min: symmetry", "z_min: wall, z_max: open"),
        {"pressure": (mean("gas", "pressure", inside), p), "density": (mean("gas", "density", inside), rho)})


def pushed():
    """A pressure on the end of a fluid rod: velocity behind the wave p/(rho c), impulse p t."""
    c, rho, p = 1500.0, 1000.0, 1e5
    end = 0.6 / c
    material = (f"  water: {{density: {rho!r}, eos: {{mie_gruneisen_shock: {{c0: {c!r}, S1: 0, gamma0: 0}}}}, "
                "viscosity: {}}\n")
    return Problem("pressure on a face", lambda cells: strip(
        cells, end, material, {"rod": ("water", 0.0, 1.0, 0)}, side="open",
        more=f"loads: {{push: {{body: rod, face: z_max, pressure: {p!r}, where: {{z_min: 0.7}}}}}}\n"),
        {"velocity": (velocity("rod"), -p * end / rho),
         "behind": (velocity("rod", "z_min: 0.6, z_max: 0.9"), -p / (rho * c)),
         "pressure": (mean("rod", "pressure", "z_min: 0.6, z_max: 0.9"), p)})


def breathing(kind):
    """Radial mode of an elastic sphere or cylinder (plane strain), nu = 1/4, at an eighth of its period: u ~ j1, J1(xi
    r)."""
    k, g, rho = 5 / 3, 1.0, 1.0
    c, amplitude = np.sqrt((k + 4 / 3 * g) / rho), 1e-4
    sphere = kind == "sphere"
    if sphere:
        xi = brentq(lambda x: x / np.tan(x) - 1 + 0.75 * x * x, 2.3, 2.8)
        series = [1 / 3, -1 / 30, 1 / 840, -1 / 45360, 1 / 3991680, -1 / 518918400]  # j1(x)/x in x^2
    else:
        xi = brentq(lambda x: x * j0(x) / j1(x) - 2 / 3, 1.5, 2.4)
        series = [1 / 2, -1 / 16, 1 / 384, -1 / 18432, 1 / 1474560, -1 / 176947200]  # J1(x)/x
    frame, a = ("axisymmetric", "r") if sphere else ("plane_strain", "x")
    end = 0.25 * np.pi / (xi * c)
    form = "+".join(f"({s * xi ** (2 * n)!r})*({a}^2+z^2)^{n}" if n else repr(s) for n, s in enumerate(series))
    shape = ("{sphere: {radius: 1, center: [0, 0, 0]}}" if sphere else
             "{cylinder: {radius: 1, height: 1, axis: y, base: [0, -0.5, 0]}}")

    def mode(r):
        return r * sum(s * (xi * r) ** (2 * n) for n, s in enumerate(series))
    # Mean of v_z over the upper half (of the quarter that is modelled): v_r z/r, weights of the volume.
    share = (quad(lambda r: mode(r) * r**2, 0, 1)[0] * 0.5 / (1 / 3) if sphere else
             quad(lambda r: mode(r) * r, 0, 1)[0] * (2 / np.pi) / 0.5)

    def scene(cells):
        h = 1 / cells
        return (f"frame: {frame}\ngrid: "
                f"{{cell: {h!r}, box: {{min: [0, 0], max: [{1 + 3 * h!r}, {1 + 3 * h!r}]}}, boundary: "
                f"{{{a}_min: {'axis' if sphere else 'symmetry'}, z_min: symmetry}}}}\ntime: {{end: "
                f"{end!r}}}\nmaterials: {{m: "
                f"{{density: {rho}, bulk_modulus: {k!r}, shear_modulus: {g}, eos: linear, strength: elastic}}}}\n"
                f"bodies: {{b: {{material: m, shape: {shape}, velocity: [\"{amplitude}*{a}*({form})\", "
                f"\"{amplitude}*z*({form})\"]}}}}\noutput: {{frames: 0, "
                f"history: {end / 10!r}}}\n")
    exact = amplitude * np.sqrt(0.5) * share
    return Problem(f"breathing {kind}", scene, {"velocity": (velocity("b"), exact)}, (10, 20, 40, 80), True)


def solved(title, file, length, measures, kinematics, cells):
    """A scene of validation/solutions; `cells` in `length` [m]."""
    text = (SOLUTIONS / f"{file}_scene.yaml").read_text(encoding="utf-8").partition("\nmeasures:")[0] + "\n"
    text = text.replace("\n  body:\n", f"\n  body:\n    kinematics: {kinematics}\n")
    text = text.replace("\n  body: {", f"\n  body: {{kinematics: {kinematics}, ")
    return Problem(f"{title}, {'points' if kinematics == 'mpm' else 'elements'}",
                   lambda n: re.sub(r"cell: [\d.]+ mm", f"cell: {length / n!r}", text), measures, cells)


def solutions():
    """A plate that bends in its first mode (Rayleigh and Lamb), the same nearly incompressible, a disc that turns: its
    angular momentum and energy of motion per metre, m r^2 w/2 and m r^2 w^2/4 of 1000 kg/m^3, 10 mm, 100 1/s."""
    half = velocity("body", "x_max: 5 mm")
    spin = 0.5 * np.pi * 1e3 * 0.01**4 * 100
    for kinematics in ("mpm", "lagrangian_mesh"):
        yield solved("plate that bends", "bending", 2e-3, {"velocity": (half, 0.0447401483)}, kinematics,
                     (2, 4, 8, 16))
        yield solved("the same, Poisson 0.499", "incompressible", 2e-3, {"velocity": (half, 0.0443911008)},
                     kinematics, (2, 4, 8))
        yield solved("spinning disc", "spin", 1e-2, {
            "spin": ("kind: angular_momentum, body: body", -spin),
            "motion": ("kind: kinetic_energy, body: body", 0.5 * spin * 100)}, kinematics, (4, 8, 16))


def others():
    """Hertz, Verney, and isentropes of Algorithm 1."""
    scene, asked, exact, found = more.hertz_wall()
    yield Problem("sphere on a wall (Hertz)", scene, {name: (None, value) for name, value in exact.items()}, (10, 20, 40, 80),
                  asked=asked, found=found)
    scene, measures = more.verney()
    yield Problem("shell that collapses (Verney)", scene, measures, (10, 20, 40, 80))
    for name, law in (("gas", (1.4, 0.0, 1.2, 1e5, 300.0)), ("stiffened gas", (3.8, 20.805e9, 2785.0, 1e5, 1000.0))):
        scene, exact = more.release(*law)
        yield Problem(f"release of a {name} (Algorithm 1)", scene, {column: (None, value) for column, value in exact.items()},
                      (5, 10, 20, 40), point=True)


def problems():
    return [*(shock(name, u) for name, u in zip(MATERIALS, (1000, 2000, 3000, 1500))), shock("copper", 500),
            *map(noh, NOH_SIDES), sod(), bar_mode(), bar_wall(), plastic_wall(), bars("equal", K),
            bars("unequal", 0.3 * K), gas_wall(), pushed(), breathing("sphere"), breathing("cylinder"),
            *solutions(), *others()]
