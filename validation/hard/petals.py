# SPDX-License-Identifier: GPL-3.0-or-later
"""A cone through a thin plate with a cross of slits: do points, split points, a fixed reference and elements make the same petals?

The gate of design practice G2: petals in the same number, residual velocities within 3 % of each other. A quarter of the scene. What
fails (plastic strain 0.8) is taken away by all of them, so that they differ in kinematics alone.
"""

import os

import h5py
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from scipy.signal import find_peaks  # noqa: E402
from scipy.sparse import coo_matrix  # noqa: E402
from scipy.sparse.csgraph import connected_components  # noqa: E402
from scipy.spatial import cKDTree  # noqa: E402

GATE = 0.03          # of the residual velocity
SECTORS = 48         # in which the rim of the hole is looked at
PLATE, THICKNESS, SLIT = 28e-3, 2e-3, (5e-3, 1e-3)  # half its side; half a slit: length and width
SCENE = """
title: A cone through a slit plate
frame: 3d
grid:
  cell: {cell}
  box: {{min: [0, 0, -30 mm], max: [32 mm, 32 mm, 18 mm]}}
  boundary: {{x_min: symmetry, y_min: symmetry}}
time: {{end: 105 us}}
method: {{{method}}}
materials:
  steel: {{density: 7850, youngs_modulus: 210 GPa, poisson_ratio: 0.3, strength: elastic, viscosity: {{}},
          eos: {{mie_gruneisen_shock: {{c0: 4570, S1: 1.49, gamma0: 1.9}}}}}}
  aluminium: {{density: 2700, shear_modulus: 26.9 GPa, viscosity: {{}}, strength: {{von_mises: {{Y: 150 MPa, H: 150 MPa}}}},
              eos: {{mie_gruneisen_shock: {{c0: 5240, S1: 1.4, gamma0: 2}}}}, damage: {{maximum_plastic_strain: {{eps_max: 0.8}}}},
              failure: {{action: remove}}}}
bodies:
  plate:
    material: aluminium
    {plate}
  striker:
    material: steel
    shape:
      union:
        - {{cone: {{radius: 7 mm, top_radius: 0, height: 12 mm, base: [0, 0, 12.1 mm], axis: -z}}}}
        - {{cylinder: {{radius: 7 mm, height: 4 mm, base: [0, 0, 12.1 mm], axis: z}}}}
    velocity: [0, 0, -250]
contact: {{friction: 0}}
output: {{frames: 35 us, history: 1 us}}
measures:
  velocity: {{kind: mean_velocity, body: striker, axis: z}}
"""
SOLID = """thin: allowed
    shape:
      difference:
        - {box: {min: [-28 mm, -28 mm, -2 mm], max: [28 mm, 28 mm, 0]}}
        - {box: {min: [-5 mm, -1 mm, -3 mm], max: [5 mm, 1 mm, 1 mm]}}
        - {box: {min: [-1 mm, -5 mm, -3 mm], max: [1 mm, 5 mm, 1 mm]}}"""
MESH = """kinematics: {{lagrangian_mesh: {{failure: {{action: erode, when: {{plastic_strain: 0.8}}}}}}}}
    shape: {{mesh: {{file: {file}, unit: m}}}}"""
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
# Label, cell, method, whether the plate is of elements.
RUNS = [("points, left alone", 1e-3, "numerical_fracture: watch", False), ("points, split", 1e-3, "numerical_fracture: split", False),
        ("points, reference initial", 1e-3, "reference: initial", False), ("elements", 1e-3, "", True),
        ("points, split", 0.5e-3, "numerical_fracture: split", False), ("elements", 0.5e-3, "", True)]


def write_mesh(path, h):
    """The quarter plate without its slits, elements of size h."""
    across, through = round(PLATE / h), round(THICKNESS / h)
    length, width = (round(s / h) for s in SLIT)
    nodes, elements = {}, []
    for i in range(across):
        for j in range(across):
            if min(i, j) < width and max(i, j) < length:
                continue
            elements += [[nodes.setdefault((i + a, j + b, k + c), len(nodes) + 1) for a, b, c in CORNERS] for k in range(through)]
    with open(path, "w", encoding="utf-8") as file:
        file.write("*NODE\n")
        for (i, j, k), number in nodes.items():
            file.write(f"{number}, {i * h:.9g}, {j * h:.9g}, {k * h - THICKNESS:.9g}\n")
        file.write("*ELEMENT, TYPE=C3D8R\n")
        for number, corners in enumerate(elements, 1):
            file.write(f"{number}, {', '.join(map(str, corners))}\n")


def scene_of(study, cell, method, elements):
    plate = SOLID
    if elements:
        os.makedirs(os.path.join(study.folder, "runs_out"), exist_ok=True)
        name = f"plate_{cell * 1e3:g}.inp"
        write_mesh(os.path.join(study.folder, "runs_out", name), cell)
        plate = MESH.format(file=name)
    return SCENE.format(cell=cell, method=method, plate=plate)


def last_frame(run):
    """Places of the plate and striker at the end, sound matter only."""
    with h5py.File(os.path.join(run.folder, "frames.h5"), "r") as file:
        frame = file["frames"][max(file["frames"])]
        return frame["plate"]["coordinates"][()], frame["striker"]["coordinates"][()]


def pieces_of(places, reach):
    pairs = cKDTree(places).query_pairs(reach, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(places),) * 2)
    return connected_components(links, directed=False)[1]


def petals_of(places, cell):
    """(petals, share of points that broke off). The rim of the hole: by angle, the lowest of the plate that still hangs together;
    a petal is a place of it that lies a thickness deeper than the rim on both its sides."""
    whole = np.concatenate([places * (sx, sy, 1) for sx in (1, -1) for sy in (1, -1)])
    piece = pieces_of(whole, 1.9 * cell)
    plate = piece == np.argmax(np.bincount(piece))
    x, y, z = whole[plate].T
    sector = np.floor((np.arctan2(y, x) / (2 * np.pi) + 1) * SECTORS).astype(int) % SECTORS
    depth = np.array([-np.min(z[sector == k], initial=0.0) for k in range(SECTORS)])
    depth = np.roll(depth, -np.argmin(depth))  # no petal is cut by the ends
    peaks, _ = find_peaks(np.append(depth, depth[0]), prominence=THICKNESS)
    return len(peaks), np.mean(~plate)


def picture(study, shown):
    figure, axes = plt.subplots(2, 3, figsize=(9, 6), constrained_layout=True)
    for axis, (label, run) in zip(axes.flat, shown):
        places = last_frame(run)[0]
        whole = np.concatenate([places * (sx, sy, 1) for sx in (1, -1) for sy in (1, -1)])
        whole = whole[np.argsort(-whole[:, 2])]
        dots = axis.scatter(whole[:, 0] * 1e3, whole[:, 1] * 1e3, c=whole[:, 2] * 1e3, s=2, vmin=-14, vmax=0, linewidths=0)
        axis.set(title=label, xlim=(-13, 13), ylim=(-13, 13), aspect="equal", xlabel="x, mm")
    figure.colorbar(dots, ax=axes, label="z, mm")
    figure.savefig(os.path.join(study.folder, "petals.png"), dpi=75)
    plt.close(figure)


def petals(study):
    """The section of the report; what it finds about the gate is in its table."""
    found = []
    for label, cell, method, elements in RUNS:
        name = f"petals {label} {cell * 1e3:g}".replace(",", "").replace(" ", "_")
        run = study.run_text(name, scene_of(study, cell, method, elements), 60)
        if run is not None:
            found.append((label, cell, run, -run.measure("velocity"), *petals_of(last_frame(run)[0], cell)))
    rows, shown = [], []
    for label, cell, run, speed, count, broken in found:
        best = next(s for other, h, _, s, *_ in found if other == "elements" and h == cell)
        rows.append([f"{label}, {cell * 1e3:g} mm", f"{THICKNESS / cell:g}", count, f"{100 * broken:.2f}", f"{speed:.1f}",
                     f"{100 * (speed / best - 1):+.1f}", "yes" if abs(speed / best - 1) <= GATE else "**no**"])
        shown.append((f"{label}, {cell * 1e3:g} mm", run))
    study.add("## Petals", "A cone of steel at 250 m/s through 2 mm of aluminium with a cross of slits, a quarter of the scene "
              "(`petals.py`). What reaches a plastic strain of 0.8 is taken away. Petals: places of the hole's rim that lie 2 mm deeper "
              f"than it does on both their sides. The gate asks the same number of all and speeds within {100 * GATE:g} %.")
    study.add_table(["plate of", "cells through it", "petals", "broken off, % of points", "residual speed, m/s",
                     "of elements of that size, %", f"within {100 * GATE:g} %"], rows)
    picture(study, shown)
    study.add("![Plates at 105 us, from below.](petals.png)", "Plates at 105 us, by depth.")
