# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of validation/energy."""

import os

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib import cm, collections, colors  # noqa: E402

from validate_energy import Frame  # noqa: E402

LEAST = 0.15  # [mm], radius at which a point is drawn at least: debris must be seen


def noh(study, profiles, target):
    """Density over radius, all resolutions."""
    figure, line = plt.subplots(1, len(profiles), figsize=(13, 4), layout="constrained")
    for axes, (kind, found) in zip(line, profiles.items()):
        d = {"planar": 1, "cylindrical": 2, "spherical": 3}[kind]
        for k, (cells, f) in enumerate(found.items()):
            axes.plot(f["at"], f["mean_rho"], color=cm.viridis(0.85 - 0.85 * k / max(len(found) - 1, 1)), lw=1.3,
                      label=f"{cells} cells")
        r = np.linspace(1e-3, 0.4, 800)
        axes.plot(r, np.where(r < 0.2, 4.0 ** d, (1 + 0.6 / r) ** (d - 1)), "k--", lw=0.9, label="exact")
        axes.set(xlim=(0, 0.4), ylim=(0, 1.15 * 4 ** d), xlabel="r", title=kind)
        axes.legend(frameon=False, fontsize=9)
    line[0].set_ylabel("density")
    figure.savefig(os.path.join(study.folder, target), dpi=110)
    plt.close(figure)


def draw(axes, frame, colour, norm, palette, mirror):
    """Points in the section as discs of their own size, at least LEAST; by chance which lie on top."""
    x, V = 1e3 * frame.all("coordinates"), frame.all("mass")[:, 0] / frame.all("density")[:, 0]
    r, z = x[:, 0], x[:, 2]
    own = 0.56 * np.sqrt(1e9 * V / (2 * np.pi * np.maximum(r, 1e-3)))  # half the side of a ring's section, to touch
    size = np.clip(own, LEAST, 0.6)
    order = np.random.default_rng(1).permutation(len(r))
    r, z, size, colour = r[order], z[order], size[order], colour[order]
    discs = collections.EllipseCollection(2 * size, 2 * size, 0, units="xy", transOffset=axes.transData,
                                          offsets=np.stack([(-1 if mirror else 1) * r, z], 1),
                                          facecolors=palette(norm(colour)), edgecolors="none", rasterized=True)
    axes.add_collection(discs)


def halves(axes, frame, speed, heat):
    """Left half by speed, right half by temperature."""
    v = 1e-3 * np.sqrt((frame.all("velocity") ** 2).sum(axis=1))
    draw(axes, frame, v, speed, cm.viridis, True)
    draw(axes, frame, frame.all("temperature")[:, 0], heat, cm.inferno, False)
    axes.axvline(0, color="0.6", lw=0.6)
    axes.set_aspect("equal")


def bars(figure, line, speed, heat):
    half = (len(line) + 1) // 2
    for axes, norm, palette, label in ((line[:half], speed, cm.viridis, "left halves: speed [km/s]"),
                                       (line[half:], heat, cm.inferno, "right halves: temperature [K]")):
        figure.colorbar(cm.ScalarMappable(norm, palette), ax=list(axes), location="bottom", extend="max", label=label,
                        fraction=0.05, aspect=40, shrink=0.9)


def pictured(study, frames, box, target, size):
    """{title: frame} side by side."""
    speed, heat = colors.Normalize(0, 7), colors.Normalize(294, 3000)
    figure, line = plt.subplots(1, len(frames), figsize=size, layout="constrained", sharey=True, squeeze=False)
    for axes, (title, frame) in zip(line[0], frames.items()):
        axes.set_facecolor("#d9dee4")
        halves(axes, frame, speed, heat)
        axes.set(xlim=box[:2], ylim=box[2:], xlabel="r [mm]")
        axes.set_title(title, fontsize=10)
    line[0][0].set_ylabel("z [mm]")
    bars(figure, line[0], speed, heat)
    figure.savefig(os.path.join(study.folder, target), dpi=120)
    plt.close(figure)


def finest(runs):
    done = {cell: run for cell, run in runs.items() if run}
    return (min(done), done[min(done)]) if done else (None, None)


def shield(study, runs, target):
    """The finest run over time."""
    cell, run = finest(runs)
    if run:
        frames = {f"{t:g} µs, cell {cell} mm": Frame(run, 1e-6 * t) for t in (2.5, 5, 7.5, 10, 15, 25)}
        pictured(study, frames, (-22, 22, -60, 8), target, (17, 5.8))


def debris(study, runs, target):
    """All cells before the debris meets the wall."""
    frames = {f"cell {cell} mm, 7.5 µs": Frame(run, 7.5e-6) for cell, run in runs.items() if run}
    if frames:
        pictured(study, frames, (-22, 22, -50, 4), target, (11, 6))
