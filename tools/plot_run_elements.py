# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawing bodies of elements for tools/plot_run: elements as they are, not volume fractions of points."""

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]  # seen from outside
MOST_LINES = 6000  # elements or faces whose edges are still told apart in a picture


def cut_by_plane(corners, y):
    """Section of a hexahedron by a plane of constant y: its polygon (x, z) about its middle, or None."""
    a, b = (corners[[edge[k] for edge in EDGES]] for k in (0, 1))
    crossed = (a[:, 1] < y) != (b[:, 1] < y)
    if crossed.sum() < 3:
        return None
    a, b = a[crossed], b[crossed]
    points = (a + ((y - a[:, 1]) / (b[:, 1] - a[:, 1]))[:, None] * (b - a))[:, [0, 2]]
    out = points - points.mean(axis=0)
    return points[np.argsort(np.arctan2(out[:, 1], out[:, 0]))]


def outlines(run, body):
    """Polygons of a body's elements in the plane of the picture, and which element each is of."""
    corners = body.nodes[body.cells]
    index = np.arange(len(corners))
    if run.frame != "3d":
        flat = corners[:, :, [0, 2]]
        if run.frame == "axisymmetric":  # both halves
            return np.concatenate([flat, flat * [-1, 1]]), np.tile(index, 2)
        return flat, index
    low, high = corners[:, :, 1].min(axis=1), corners[:, :, 1].max(axis=1)
    nudge = 1e-9 * (high.max() - low.min())  # a section along faces shows the elements at one side of them
    y = run.section_y + (nudge if run.section_y + nudge < high.max() else -nudge)
    cuts = [(cut_by_plane(corners[e], y), e) for e in np.flatnonzero((low < y) & (high >= y))]
    return [cut for cut, _ in cuts if cut is not None], np.array([e for cut, e in cuts if cut is not None], int)


def fill(axes, polygons, colours):
    lines = {"edgecolors": (0, 0, 0, 0.35), "linewidths": 0.3} if len(polygons) < MOST_LINES else \
        {"edgecolors": "face", "linewidths": 0.1}
    axes.add_collection(PolyCollection(polygons, facecolors=colours, **lines))


def draw_elements(axes, run, body, colouring, mm):
    polygons, index = outlines(run, body)
    fill(axes, [np.asarray(polygon) / mm for polygon in polygons], colouring.of(body)[index])


def paint(run, body, raster):
    """Element in each pixel of a raster, -1 where none: polygons are filled with their numbers as colours."""
    polygons, index = outlines(run, body)
    if not len(polygons):
        return np.full(raster.shape, -1)
    rows, columns = raster.shape
    figure = Figure(figsize=(columns, rows), dpi=1, facecolor=(0, 0, 0))
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes([0, 0, 1, 1])
    axes.set_axis_off()
    left, right, low, high = raster.extent(1.0)
    axes.set_xlim(left, right)
    axes.set_ylim(low, high)
    number = index + 1
    colours = np.stack([number >> 16 & 255, number >> 8 & 255, number & 255], -1) / 255
    axes.add_collection(PolyCollection(polygons, facecolors=colours, edgecolors="face", linewidths=36,  # half a pixel
                                       antialiased=False))
    canvas.draw()
    red, green, blue = np.asarray(canvas.buffer_rgba())[::-1, :, :3].astype(int).transpose(2, 0, 1)
    return (red << 16) + (green << 8) + blue - 1


def exposed(cells):
    """Faces that no two elements share, and whose they are."""
    faces = np.concatenate([cells[:, face] for face in FACES])
    _, first, counts = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    alone = first[counts == 1]
    return faces[alone], alone % len(cells)


def draw_surfaces(axes, bodies, colouring, mm, view):
    """Faces from outside, far ones first, with light from the viewer's left; the rows of `view` are the picture's two
    axes and the direction towards the viewer."""
    found = [(exposed(body.cells), body) for body in bodies]
    corners = np.concatenate([body.nodes[faces] for (faces, _), body in found]) @ view.T
    colours = np.concatenate([colouring.of(body)[index] for (_, index), body in found])
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    order = np.argsort(corners[:, :, 2].mean(axis=1))
    order = order[normal[order, 2] > 0]
    colours[:, :3] *= (0.7 + 0.3 * np.clip(normal @ np.array([-0.45, 0.35, 0.82]), 0, 1))[:, None]
    fill(axes, corners[order][:, :, :2] / mm, colours[order])
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_axis_off()
