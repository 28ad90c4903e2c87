# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands in the plane of a picture, pixel by pixel: which body, and the values of its fields. For tools/plot_run,
tools/plot_scene and tools/report, so that a page shows what a picture shows.

Points: material where the volume fraction of a body is above 1/2 (plot_run_raster), the mean of its field about each
pixel; points that it does not show, or whose value is no number, as squares of their own area, none smaller than `least`
pixels across. Elements as they are.
"""

import numpy as np

from plot_run_elements import paint
from plot_run_raster import HALF, Fraction, Raster, stamp


class Section:
    """`cover` (volume fraction of the fullest body), `which` (its number in `bodies`, -1: none) and `values` (one array for
    each of the fields; NaN where it is absent or no number) over a raster. `fields`: functions of a body that return values
    of its points, or None. A body counts from the volume fraction `half` on.
    `drawn`: side of a pixel of the picture, where that is larger than the raster's."""

    def __init__(self, run, bodies, box, pixels, fields, least=1.0, half=HALF, drawn=0.0):
        cell = float(run.summary.get("cell") or 2 * np.median(bodies[0].side)) / 2 ** run.finest
        self.raster = Raster(box, cell, pixels)
        shape = self.raster.shape
        self.cover, self.which = np.zeros(shape), np.full(shape, -1)
        self.values = [np.full(shape, np.nan) for _ in fields]
        self.most, self.half = np.full(shape, half), half
        self.least = least * max(1.0, drawn / self.raster.pixel)
        for number, body in enumerate(bodies):
            values = [field(body) for field in fields]
            (self.add_points if body.cells is None else self.add_elements)(run, number, body, values)

    def put(self, number, where, values, index=None):
        """Pixels `where` are the body's; values of its points by `index`, or of the pixels themselves."""
        self.which[where] = number
        for array, of in zip(self.values, values):
            array[where] = np.nan if of is None else of[where] if index is None else of[index]

    def add_elements(self, run, number, body, values):
        found = paint(run, body, self.raster)
        where = found >= 0
        self.cover[where] = 1
        self.most[where] = np.inf
        self.put(number, where, values, found[where])

    def add_points(self, run, number, body, values):
        inside = Fraction(self.raster, run.frame, body.x, body.volume, run.planes, run.section_y)
        shown = inside.phi >= self.most
        self.most[shown] = inside.phi[shown]
        self.cover[shown] = inside.phi[shown]
        self.put(number, shown, [None if of is None else inside.mean(of) for of in values])
        bad = [~np.isfinite(of[inside.index]) for of in values if of is not None]
        bad = np.any(bad, axis=0) if bad else np.zeros(len(inside.index), bool)
        alone = np.union1d(inside.isolated(), np.flatnonzero(bad & inside.inside))
        if run.frame == "3d":  # of those beside the plane, the nearest
            alone = alone[np.abs(body.x[inside.index[alone], 1] - run.section_y) <= 0.5 * self.raster.h]
        if not len(alone):
            return
        u, v = (inside.places[alone] + 0.5).T
        reach = np.maximum(0.5 * body.side[inside.index[alone]] / self.raster.pixel, 0.5 * self.least)
        nearest, away = stamp(u, v, np.ceil(reach), self.cover.shape, np.arange(len(alone)),
                              lambda points, rows, columns: np.maximum(
                                  np.abs(columns + 0.5 - u[points]), np.abs(rows + 0.5 - v[points])) / reach[points])
        marked = (away <= 1) & ((self.cover < HALF) | bad[alone][nearest]) & ~inside.beyond
        self.cover[marked] = np.maximum(self.cover[marked], 1.0)
        self.put(number, marked, values, inside.index[alone][nearest[marked]])
