# SPDX-License-Identifier: GPL-3.0-or-later
"""Where material is in the plane of a picture, for tools/plot_run.

A point of a strongly deformed body no longer fills a square about its centre: at the foot of a Taylor rod
neighbours are more than a cell apart radially and a tenth of one axially. As the measures do
(src/measure/volume_fraction.cpp), the picture shows material where the volume fraction

  phi(x) = sum_p A_p N((x - x_p) / h) / h^2,   N the quadratic B-spline, A_p = V_p / (2 pi r_p), V_p / thickness,
                                               or V_p N(y_p / h) / h in the section of a 3d body

is above 1/2, points being mirrored at closed planes. Points that have phi < 1/2 themselves (fragments, thin sheets,
sharp corners) are drawn as squares of their own area, so that nothing disappears.
"""

import math
import os

import numpy as np

HALF = 0.5
CORNER = 0.2  # the corner point of a square of four points a cell has 0.47, of a cube of eight 0.32; less where strained
BESIDE = 0.7  # cells


def bspline(u):
    u = np.abs(u)
    return np.where(u < 0.5, 0.75 - u * u, np.where(u < 1.5, 0.5 * (1.5 - u) ** 2, 0.0))


def closed_planes(folder):
    """[(axis, coordinate, +1 where the inside is above it)] of the sides that are not open, from resolved.yaml."""
    sides, box, path = {}, {}, []
    try:
        with open(os.path.join(folder, "resolved.yaml"), encoding="utf-8") as file:
            lines = file.read().splitlines()
    except OSError:
        return []
    for text in lines:
        key, colon, value = text.strip().partition(":")
        if not colon or text.strip().startswith("#"):
            continue
        path = path[:(len(text) - len(text.lstrip())) // 2] + [key]
        if path[:3] == ["grid", "boundary", key] and value.strip() != "open":
            sides[key] = value
        if path[:3] == ["grid", "box", key]:
            box[key] = [float(x) for x in value.strip(" []").split(",")]
    planes = []
    for side in sides:
        axis = {"r": 0, "x": 0, "y": 1, "z": 2}[side[0]]
        corner = box.get(side[2:], [])
        if corner:
            planes.append((axis, corner[-1 if axis == 2 else axis], 1 if side[2:] == "min" else -1))
    return planes


def mirrored(x, planes, h):
    """Indices and coordinates of the points and of their images that reach over a closed plane."""
    index = np.arange(len(x))
    for axis, at, _ in planes:
        near = np.abs(x[:, axis] - at) < 1.6 * h
        image = x[near].copy()
        image[:, axis] = 2 * at - image[:, axis]
        x, index = np.concatenate([x, image]), np.concatenate([index, index[near]])
    return index, x


class Raster:
    """Square pixels of h / odd number, so that three box means make the B-spline exactly."""

    def __init__(self, box, h, pixels):
        wanted = max(box[1] - box[0], box[3] - box[2]) / pixels
        self.h = max(h, wanted)
        self.width = 2 * int(0.5 * self.h / wanted) + 1  # of the kernel, in pixels
        self.pixel = self.h / self.width
        margin = 2 * self.width + 2
        self.low = np.array([box[0], box[2]]) - margin * self.pixel
        self.shape = tuple(int(math.ceil((box[k + 1] - box[k]) / self.pixel)) + 2 * margin for k in (2, 0))

    def extent(self, scale):
        rows, columns = self.shape
        return (self.low[0] / scale, (self.low[0] + columns * self.pixel) / scale,
                self.low[1] / scale, (self.low[1] + rows * self.pixel) / scale)

    def places(self, x):
        """Positions in pixels, so that pixel i has its centre at i."""
        return (x[:, [0, 2]] - self.low) / self.pixel - 0.5

    def deposit(self, places, values):
        """Values shared out bilinearly over the four pixels about each place."""
        corner = np.floor(places).astype(int)
        part = places - corner
        total = np.zeros(self.shape[0] * self.shape[1])
        for i in (0, 1):
            for j in (0, 1):
                column, row = corner[:, 0] + i, corner[:, 1] + j
                weight = np.abs(1 - i - part[:, 0]) * np.abs(1 - j - part[:, 1]) * values
                good = (row >= 0) & (row < self.shape[0]) & (column >= 0) & (column < self.shape[1])
                total += np.bincount(row[good] * self.shape[1] + column[good], weight[good], len(total))
        return total.reshape(self.shape)

    def smooth(self, density):
        """Sum over the kernel of a deposited density, per h^2."""
        for _ in range(3):
            density = box_mean(density, self.width // 2)
        return density / self.pixel ** 2

    def beyond(self, axis, at, inside):
        """Pixels with their centre on the other side of a plane."""
        k = axis // 2
        centres = self.low[k] + (np.arange(self.shape[1 - k]) + 0.5) * self.pixel
        outside = (centres - at) * inside < 0
        return (slice(None), outside) if k == 0 else (outside, slice(None))

    def at(self, values, places):
        """Values at places, infinite beyond the raster."""
        column, row = np.rint(places).astype(int).T
        inside = (row >= 0) & (row < self.shape[0]) & (column >= 0) & (column < self.shape[1])
        return np.where(inside, values[np.where(inside, row, 0), np.where(inside, column, 0)], np.inf)


def box_mean(values, reach):
    """Mean over a square of 2 reach + 1 pixels; zero beyond the edges."""
    n = 2 * reach + 1
    for axis in (0, 1):
        total = np.cumsum(np.pad(values, [(reach + 1, reach) if k == axis else (0, 0) for k in (0, 1)]),
                          axis=axis)
        last = total.shape[axis]
        values = (np.take(total, range(n, last), axis) - np.take(total, range(last - n), axis)) / n
    return values


class Fraction:
    """Volume fraction of one body on a raster, means of fields, and the points that it does not show."""

    def __init__(self, raster, frame, x, volume, planes, y=0.0):
        self.raster = raster
        if frame == "axisymmetric":  # both halves
            volume = np.tile(volume / (2 * math.pi * np.maximum(x[:, 0], 1e-300)), 2)
            index = np.tile(np.arange(len(x)), 2)
            x = np.concatenate([x, x * [-1, 1, 1]])
            planes = [plane for plane in planes if plane[:2] != (0, 0.0)] + \
                [(0, -at, -inside) for axis, at, inside in planes if axis == 0 and at != 0.0]
        else:
            index = np.arange(len(x))
        image, x = mirrored(x, planes, raster.h)
        self.index, self.share = index[image], volume[image]
        if frame == "3d":
            self.share = self.share * bspline((x[:, 1] - y) / raster.h) / raster.h
            used = self.share > 0
            self.index, self.share, x = self.index[used], self.share[used], x[used]
        self.places = raster.places(x)
        self.inside = np.ones(len(x), bool)
        for axis, at, inside in planes:
            self.inside &= (x[:, axis] - at) * inside >= 0
        self.weight = raster.smooth(raster.deposit(self.places, self.share))
        self.phi = self.weight.copy()
        self.beyond = np.zeros(raster.shape, bool)  # where the images are, which are not drawn
        for axis, at, inside in planes:
            if axis != 1:
                self.beyond[raster.beyond(axis, at, inside)] = True
        self.phi[self.beyond] = 0

    def mean(self, values):
        """Kernel-weighted mean, of the points whose value is a number."""
        values = values[self.index]
        good = np.isfinite(values)
        share = np.where(good, self.share, 0)
        total = self.raster.smooth(self.raster.deposit(self.places, share * np.nan_to_num(values)))
        weight = self.weight if good.all() else self.raster.smooth(self.raster.deposit(self.places, share))
        return total / np.maximum(weight, 1e-12)

    def isolated(self, least=HALF):
        """Entries of `index` and `places` where phi is less (1/2: phi does not show these points). The corner of a body,
        which its outline of 1/2 rounds off, is no debris: it counts as shown with what is shown beside it."""
        phi = self.raster.at(self.phi, self.places)
        shown = box_mean((self.phi >= HALF).astype(float), int(round(BESIDE * self.raster.width))) > 1e-12
        rim = (phi >= CORNER) & (self.raster.at(shown, self.places) > 0)
        return np.flatnonzero((phi < least) & ~rim & self.inside)


def stamp(u, v, reach, shape, order, key):
    """Point in each pixel, -1 where none: of all points whose square covers the pixel (`reach` pixels
    about the point) that with the smallest `key(points, rows, columns)`. Of several points in one
    pixel the last in `order` counts."""
    nearest, best = np.full(shape, -1), np.full(shape, np.inf)
    latest = np.full(shape, -1)
    largest = int(reach.max(initial=0))
    column, row = np.floor(u).astype(int), np.floor(v).astype(int)
    for i in range(-largest, largest + 1):
        for j in range(-largest, largest + 1):
            points = order[reach[order] >= max(abs(i), abs(j))]
            r, c = row[points] + i, column[points] + j
            inside = (r >= 0) & (r < shape[0]) & (c >= 0) & (c < shape[1])
            points, r, c = points[inside], r[inside], c[inside]
            latest[r, c] = points
            last = latest[r, c] == points
            points, r, c = points[last], r[last], c[last]
            keys = key(points, r, c)
            closer = keys < best[r, c]
            best[r[closer], c[closer]], nearest[r[closer], c[closer]] = keys[closer], points[closer]
    return nearest, best
