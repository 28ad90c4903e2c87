# SPDX-License-Identifier: GPL-3.0-or-later
"""A fluid at rest stays at rest, keeps its volume and does not leak."""

import h5py
import numpy as np

from faults_support import fault, scene
from scene_support import check, history, krater, settings

DEFAULT = "the default"


def run(source, *changes, timeout=600):
    done = krater("run", source, "-o", "out", "-j", 2, "--quiet", *settings(changes), timeout=timeout)
    check(done.returncode == 0, f"{source.name if hasattr(source, 'name') else source}: exit code", done.stderr[-200:])
    return history("out")


def write(text, name="scene.yaml"):
    with open(name, "w", encoding="utf-8") as file:
        file.write(text)
    return name


def at_rest(rows, what, joules=0.02):
    """Energy 200 J, density 1.2: the criteria of fault 01 in every row."""
    energy = np.max(np.abs(rows["internal_energy"] / 200 - 1))
    check(energy < 1e-3, f"{what}: internal energy", f"off by {energy:.2e}")
    density = np.max(np.abs(rows["rho"] / 1.2 - 1))
    check(density < 1e-2, f"{what}: density", f"off by {density:.2e}")
    check(np.max(rows["kinetic_energy"]) < joules, f"{what}: kinetic energy", f"{np.max(rows['kinetic_energy']):.2e} J")


@fault("01", "a gas at rest in a closed box stays at rest")
def rest():
    at_rest(run(scene("01")), DEFAULT)
    at_rest(run(scene("01"), "method.jitter=0.1"), "jitter")


@fault("01-long", "and for ten times as long, for all transfers, updates and shapes", long=True)
def rest_long():
    at_rest(run(scene("01"), "time.end=50 ms", "method.jitter=0.1"), "50 ms")
    for change in (["method.stagger=false"], ["method.update=musl"], ["method.update=usf"], ["method.transfer=flip"],
                   ["method.transfer=apic"], ["method.shape=gimp"], ["method.points_per_direction=3"]):
        at_rest(run(scene("01"), "method.jitter=0.1", *change), " ".join(change))


BOX = """
frame: {frame}
grid:
  cell: 2 mm
  box: {{min: {low}, max: {high}}}
  boundary: {{{boundary}}}
time: {{end: {end}}}
materials:
  air: {{density: 1.2, eos: {{ideal_gas: {{gamma: 1.4, initial_pressure: 0.1 MPa}}}}}}
bodies:
  gas: {{material: air, shape: {{box: {{min: [-100 mm, -100 mm, -1 mm], max: [100 mm, 100 mm, 100 mm]}}}}}}
method: {{jitter: 0.1}}
output: {{history: 0.1 ms}}
measures:
  rho: {{kind: mean, body: gas, field: density}}
"""
FRAMES = {
    "axisymmetric": ("[0, 0]", "[16 mm, 20 mm]", "r_min: axis, r_max: symmetry, z_min: symmetry, z_max: symmetry"),
    "3d": ("[0, 0, 0]", "[8 mm, 10 mm, 12 mm]", "x_min: symmetry, x_max: symmetry, y_min: symmetry, "
           "y_max: symmetry, z_min: symmetry, z_max: symmetry"),
}


@fault("gas-box", "a gas at rest about the axis and in space")
def boxes():
    for frame, (low, high, boundary) in FRAMES.items():
        body = BOX.format(frame=frame, low=low, high=high, boundary=boundary, end="1 ms")
        if frame == "axisymmetric":
            body = body.replace("box: {min: [-100 mm, -100 mm, -1 mm], max: [100 mm, 100 mm, 100 mm]}",
                                "cylinder: {radius: 100 mm, height: 100 mm, base: [0, -1 mm]}")
        rows = run(write(body))
        energy = rows["internal_energy"]
        check(np.max(np.abs(energy / energy[0] - 1)) < 1e-6, f"{frame}: energy", np.max(np.abs(energy / energy[0] - 1)))
        check(np.max(rows["kinetic_energy"]) < 1e-8 * energy[0], f"{frame}: rest", np.max(rows["kinetic_energy"]))


SOD = """
frame: plane_strain
grid:
  cell: {cell}
  box: {{min: [0, 0], max: [{width}, 1]}}
  boundary: {{x_min: symmetry, x_max: symmetry, z_min: symmetry, z_max: symmetry}}
time: {{end: 0.2}}
materials:
  dense: {{density: 1, eos: {{ideal_gas: {{gamma: 1.4, initial_pressure: 1}}}}, viscosity: {{}}}}
  thin: {{density: 0.125, eos: {{ideal_gas: {{gamma: 1.4, initial_pressure: 0.1}}}}, viscosity: {{}}}}
bodies:
  left: {{material: dense, shape: {{box: {{min: [-1, -1, -1], max: [1, 1, 0.5]}}}}}}
  right: {{material: thin, shape: {{box: {{min: [-1, -1, 0.5], max: [1, 1, 1]}}}}}}
"""


def points(*fields, body=None):
    """Fields of the points of the last frame, bodies one after the other, or of one."""
    with h5py.File("out/frames.h5", "r") as file:
        frame = file["frames"][sorted(file["frames"])[-1]]
        return [np.concatenate([frame[one][field][:] for one in frame if body in (None, one)]) for field in fields]


def sod_density(z, t=0.2, gamma=1.4):
    """Exact, shared/data/exact.md D4: p* = 0.30313, u* = 0.927453."""
    p, u, left, right = 0.303130, 0.927453, 0.426319, 0.265574
    c = np.sqrt(gamma)
    xi = (z - 0.5) / t
    shock = np.sqrt(gamma * 0.1 / 0.125) * np.sqrt((gamma + 1) / (2 * gamma) * p / 0.1 + (gamma - 1) / (2 * gamma))
    fan = np.maximum(2 / (gamma + 1) - (gamma - 1) / (gamma + 1) / c * xi, 0) ** (2 / (gamma - 1))
    return np.select([xi < -c, xi < u - np.sqrt(gamma * p / left), xi < u, xi < shock], [1, fan, left, right], 0.125)


@fault("sod", "Sod's tube keeps its volume and converges with order one")
def sod():
    errors = []
    for cells in (100, 200, 400):
        run(write(SOD.format(cell=1 / cells, width=2 / cells)))
        x, mass, density = points("coordinates", "mass", "density")
        volume = mass / density
        drift = np.sum(volume) / (2 / cells) - 1
        check(abs(drift) < 1e-4, f"Sod, {cells} cells: volume", f"{drift:.2e} (0.12 to 0.33 % over the points)")
        errors.append(np.sum(volume * np.abs(density - sod_density(x[:, 2]))) / np.sum(volume))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    check(orders[-1] > 0.85, "Sod: order of the density", f"{orders}, errors {errors} (0.54 over the points)")


@fault("09", "detonation products stay in a copper tube of 20 cells at default points")
def tube():
    run(scene("09"), timeout=1200)
    place, density = points("coordinates", "density", body="charge")
    (inner,) = points("coordinates", body="tube")
    face = np.min(inner[:, 0]) if len(inner) else 0
    beyond = np.count_nonzero(place[:, 0] > face + 0.125e-3)
    check(beyond == 0, "09: gas points a cell beyond the tube's inner face", beyond)
    near = np.mean(np.abs(np.log2(density / density.mean())) < 1)
    check(near >= 0.95, "09: share of the gas within half and twice its mean density", near)
