# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of cells in the pictures of tools/plot_run and tools/plot_scene: points among coarse cells drawn as what they would
be split into, and the blocks that hold points."""

import os

import numpy as np
import yaml
from matplotlib.collections import LineCollection

MOST_POINTS = 4_000_000  # of all bodies of a picture, after splitting
EDGE = {"3d": 4}         # cells of a block; 8 in two dimensions


def finest_level(bodies):
    """Of the points of a picture, as far down as it may split them."""
    most = max((int(body.level.max(initial=0)) for body in bodies), default=0)
    while most > 0:
        total = sum((parts_of(body, most) ** 2 if body.flat else parts_of(body, most) ** 3).sum() for body in bodies)
        if total <= MOST_POINTS:
            break
        most -= 1
    return most


def parts_of(body, finest):
    """Along an axis, of each point."""
    return 2 ** np.maximum(finest - body.level, 0)


def split(body, finest):
    """(index of the point, place, its side over that of the point) of all parts."""
    parts = parts_of(body, finest)
    axes = (0, 2) if body.flat else (0, 1, 2)
    order, places, shares = [], [], []
    for n in np.unique(parts):
        chosen = np.flatnonzero(parts == n)
        steps = (np.arange(n) + 0.5) / n - 0.5
        grid = np.stack(np.meshgrid(*[steps] * len(axes), indexing="ij"), axis=-1).reshape(-1, len(axes))
        x = np.repeat(body.x[chosen], len(grid), axis=0)
        x[:, axes] += np.tile(grid, (len(chosen), 1)) * np.repeat(body.side[chosen], len(grid))[:, None]
        order.append(np.repeat(chosen, len(grid)))
        places.append(x)
        shares.append(np.full(len(x), 1 / n))
    return np.concatenate(order), np.concatenate(places), np.concatenate(shares)


def spread(bodies):
    """Points among coarser cells become the parts that they would be split into; the finest level."""
    finest = finest_level(bodies)
    for body in bodies:
        if body.cells is None and (body.level < finest).any():
            body.parts, body.x, share = split(body, finest)
            body.side = body.side[body.parts] * share
            body.volume = body.volume[body.parts] * share ** (2 if body.flat else 3)
    return finest


def lower_corner(folder):
    """Of the box of the grid, from the resolved scene; None where it is not told."""
    try:
        with open(os.path.join(folder, "resolved.yaml"), encoding="utf-8") as file:
            low = yaml.safe_load(file)["grid"]["box"]["min"]
    except (OSError, ValueError, KeyError, TypeError, yaml.YAMLError):
        return None
    low = [float(str(value).split()[0]) for value in low]
    return low if len(low) == 3 else [low[0], 0.0, low[1]]


def draw_blocks(axes, run, bodies, mm):
    """Outlines of the blocks that hold points; none on one level."""
    low, cell = lower_corner(run.folder), float(run.summary.get("cell") or 0)
    if low is None or not cell or not any(body.level.any() for body in bodies):
        return
    edge = EDGE.get(run.frame, 8)
    plane = (0, 1, 2) if run.frame == "3d" else (0, 2)
    segments, widths = [], []
    for level in sorted({int(n) for body in bodies for n in np.unique(body.level)}):
        h = cell / 2 ** level
        x = np.concatenate([body.whole[body.level == level] for body in bodies])
        knots = np.floor(2 ** level * ((x - low) / cell + 0.5) / edge).astype(int)
        if run.frame == "3d":  # those that the section cuts
            here = np.floor(2 ** level * ((run.section_y - low[1]) / cell + 0.5) / edge)
            knots = knots[knots[:, 1] == here]
        for block in np.unique(knots[:, plane][:, [0, -1]], axis=0):
            corner = [low[a] + (block[i] * edge - 2 ** level / 2) * h for i, a in enumerate((0, 2))]
            u0, v0 = corner[0] / mm, corner[1] / mm
            u1, v1 = u0 + edge * h / mm, v0 + edge * h / mm
            segments += [[(u0, v0), (u1, v0)], [(u1, v0), (u1, v1)], [(u1, v1), (u0, v1)], [(u0, v1), (u0, v0)]]
            widths += [0.9 / (1 + level)] * 4
    axes.add_collection(LineCollection(segments, colors="k", linewidths=widths, alpha=0.5), autolim=False)
