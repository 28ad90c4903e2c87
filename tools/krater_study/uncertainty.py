# SPDX-License-Identifier: GPL-3.0-or-later
"""Numerical error of a number that was computed with several cells (ASME V&V 20; Roache; Eca and Hoekstra 2014).

    f(h) = f0 + a h^p            f0: the limit of small cells, p: the order that the values show

Three cells: p from the three values, U = Fs |f1 - f2|/(r^p - 1). More values, or lattices shifted by parts of a cell:
f0, a, p by least squares weighted with 1/h, with their own scatter s,

    U = Fs |f0 - f(h1)| + s t + |f1 - f(h1)|        h1: the finest cell, t: Student's for two standard deviations

Fs is 1.25 where p says that the values converge as the scheme does, 0.5 < p < order + 0.5. An impact has shocks, edges
and contact, where the scheme is of order 1: a higher p of few values is an accident of the coarsest (the foot of
taylor_copper: 14.882, 14.545, 14.464 mm, order 2.1, and then 14.615), so no band is made with p > 1 (Oberkampf and Roy:
the observed order is limited by the formal one), and beyond 1.5 Fs is 3. Values that waver are
not in that range either: U is at least 1.25 times the spread of the last three. Never is U less than the step between
the two finest cells, nor than the spread of shifted lattices, which no refinement sees.

The finest four cells are asked. Where they do not waver, but the coarsest of them is out of the range of a law and
makes the fit wide, the finest three alone are the better witness.

U is meant to hold the limit in at least nine of ten cases: tests/scene/cell_error_test.py tries it on made-up
sequences, `tools/validate calibration` on problems with known answers.
"""

import dataclasses
import math

import numpy as np
from scipy.optimize import brentq, minimize_scalar
from scipy.special import stdtrit

ORDER = 1.0  # of the scheme at shocks, edges and contact
SAFE, UNSAFE = 1.25, 3.0
MOST = 4  # cells that are asked: coarser ones are out of the range where a law holds
SAME_CELL = 1.15  # cells nearer to each other than this are shifted lattices of one cell
ORDERS = (0.05, 4.0)


@dataclasses.dataclass
class Estimate:
    value: float  # of the finest cell
    uncertainty: float  # U: the limit lies within value +- U in nine of ten cases; nan: not known
    behaviour: str  # converges, settles, wavers, is noisy, ...
    order: float | None = None  # that the values show
    limit: float | None = None  # f0
    scatter: float = 0.0  # spread of shifted lattices of the finest cell that has them

    @property
    def known(self):
        return math.isfinite(self.uncertainty)

    @property
    def how(self):
        """How it was found, in words."""
        if not self.known:
            return self.behaviour
        order = f", order {self.order:.1f}" if self.order is not None else ""
        lattices = ", shifted lattices" if self.scatter else ""
        return f"{self.behaviour}{order}{lattices}"

    @property
    def falls_as(self):
        """The order by which the uncertainty is foretold for finer cells; None where refinement is not seen to help."""
        if self.behaviour == "converges":
            return min(self.order, ORDER)
        return 0.5 * ORDER if self.behaviour == "settles" else None


def estimate(cells, values, order=ORDER):
    """Estimate of values at cells, in any order; several within 15 % are lattices shifted against each other."""
    cells, values = (np.asarray(x, float) for x in (cells, values))
    good = np.isfinite(values)
    if not good.all() or not len(values):
        return Estimate(values[np.argmin(cells)] if len(values) else math.nan, math.nan,
                        "has no value at some cells" if len(values) else "has no value")
    levels = levels_of(cells)[:MOST]
    kept = sorted(i for level in levels for i in level)
    cells, values = cells[kept], values[kept]
    levels = levels_of(cells)
    first = [level[0] for level in levels]
    h, f = cells[first], values[first]  # finest first
    if len(levels) < 2:
        return Estimate(f[0], math.nan, "one cell says nothing of its own error")
    if np.ptp(values) == 0:
        return Estimate(f[0], 0.0, "does not depend on the cell", limit=f[0])
    if len(levels) == 2:
        found = two_cells(h, f)
    elif len(values) == 3:
        found = three_cells(h, f, order)
    else:
        found = many(cells, values, (h, f), order)
        if len(levels) == MOST and found.behaviour not in ("wavers", "is noisy"):
            fine = sorted(i for level in levels[:-1] for i in level)
            alone = estimate(cells[fine], values[fine], order)
            if alone.behaviour == "converges" and alone.uncertainty < found.uncertainty:
                found = alone
    found.scatter = scatter(levels, cells, values, found)
    found.uncertainty = float(max(found.uncertainty, abs(f[0] - f[1]), found.scatter))
    return found


def levels_of(cells):
    """Indices by cell, finest first; within a level the member nearest to the middle, the unshifted one, first."""
    levels = []
    for i in np.argsort(cells, kind="stable"):
        if levels and cells[i] < SAME_CELL * cells[levels[-1][0]]:
            levels[-1].append(int(i))
        else:
            levels.append([int(i)])
    return [sorted(level, key=lambda i, m=np.median(cells[level]): (abs(cells[i] - m), i)) for level in levels]


def two_cells(h, f):
    step = f[0] - f[1]
    return Estimate(f[0], UNSAFE * abs(step) / (h[1] / h[0] - 1), "settles", limit=f[0] + step / (h[1] / h[0] - 1))


def three_cells(h, f, order):
    fine, coarse = f[0] - f[1], f[1] - f[2]
    careful = UNSAFE * abs(fine) / ((h[1] / h[0]) ** order - 1)
    spread = SAFE * np.ptp(f)
    if fine == 0 or coarse / fine <= 0:
        return Estimate(f[0], max(careful, spread), "wavers" if fine else "settles")
    p = order_of_three(h, coarse / fine)
    limit = f[0] + fine / ((h[1] / h[0]) ** p - 1) if p > ORDERS[0] else None
    if 0.5 < p < order + 0.5:
        return Estimate(f[0], SAFE * abs(fine) / ((h[1] / h[0]) ** min(p, order) - 1), "converges", p, limit)
    if p >= order + 0.5:
        return Estimate(f[0], careful, "settles", p, limit)
    return Estimate(f[0], max(careful, spread), "settles" if p > ORDERS[0] else "changes more and more", p, limit)


def order_of_three(h, ratio):
    """p of (h3^p - h2^p)/(h2^p - h1^p) = ratio, within ORDERS."""
    def miss(p):
        return (h[2] ** p - h[1] ** p) / (h[1] ** p - h[0] ** p) - ratio
    low, high = ORDERS
    if miss(low) >= 0:
        return low
    return float(brentq(miss, low, high)) if miss(high) > 0 else high


def fit(cells, values, p):
    """(f0, a, root of the weighted mean square residual times n) of f0 + a h^p."""
    weight = np.sqrt((1 / cells) / np.mean(1 / cells))
    matrix = np.stack([np.ones_like(cells), (cells / cells.min()) ** p], axis=1)
    (f0, a), *_ = np.linalg.lstsq(matrix * weight[:, None], values * weight, rcond=None)
    return f0, a, float(np.sum(((matrix @ [f0, a] - values) * weight) ** 2))


def many(cells, values, finest, order):
    """More than three values: least squares, with the order free where the values show one."""
    h, f = finest
    p = float(minimize_scalar(lambda q: fit(cells, values, q)[2], bounds=ORDERS, method="bounded").x)
    f0, a, squares = fit(cells, values, p)
    free = len(values) - 3
    trusted = 0.5 < p < order + 0.5
    if not trusted:
        f0, a, squares = fit(cells, values, order)
        free = len(values) - 2
    s = math.sqrt(squares / free)
    step = np.ptp(f) / (len(f) - 1)
    steps = np.diff(f)
    wavers = bool(np.any(steps[0] * steps[1:2] < 0))
    noisy = s >= step
    off = abs(a) * (h[0] / cells.min()) ** (p if trusted else order)  # |f0 - f(h1)|
    missed = abs(f[0] - f0 - math.copysign(off, a))
    if trusted and p > order:
        off = max(off, abs(fit(cells, values, order)[1]) * (h[0] / cells.min()) ** order)
    t = float(stdtrit(free, 0.975)) / 1.96
    safe = SAFE if trusted and not noisy and not wavers else UNSAFE
    u = safe * off + s * t + missed
    if noisy:
        u = max(u, 3 * s, SAFE * np.ptp(f[:3]))
    if wavers:
        u = max(u, SAFE * np.ptp(f[:3]))
    word = "is noisy" if noisy else "wavers" if wavers else "converges" if trusted else (
        "settles" if p >= 0.5 or abs(steps[0]) < abs(steps[1]) else "changes more and more")
    return Estimate(f[0], u, word, None if noisy or wavers else p, f0)


def scatter(levels, cells, values, found):
    """Spread of the lattices of the finest cell that has several, their slope by the cell taken off."""
    for level in levels:
        if len(level) > 1:
            x, y = cells[level], values[level]
            slope = 0.0
            if found.limit is not None:  # first order towards the limit: shifted cells differ by some per cent only
                slope = (values[level[0]] - found.limit) / x[0]
            return float(np.ptp(y - slope * (x - x[0])))
    return 0.0


def error(values, ratio=2.0):
    """(U, order or None, word) of three values from the coarsest cell to the finest."""
    found = estimate([ratio**2, ratio, 1.0], values)
    return found.uncertainty, found.order, found.behaviour


def validation(found, data, data_uncertainty, input_uncertainty=0.0):
    """ASME V&V 20: E = S - D, u_val, and the sentence. Uncertainties are half-widths of 95 %, u their half."""
    e = found.value - data
    numerical = found.uncertainty / 1.15 if found.known else 0.0
    u = math.sqrt(numerical**2 + data_uncertainty**2 + input_uncertainty**2) / 2
    inside = abs(e) <= 2 * u
    words = ("no model error is seen: it is below what grid and test leave open" if inside else
             "grid and test do not explain it: the rest is the model's, its constants' or the test's set-up")
    return {"difference": e, "u_val": u, "from": e - 2 * u, "to": e + 2 * u, "seen": not inside, "words": words}


def power_law(x, y):
    """(c, q) of y = c x^q by least squares in the logarithms; None of fewer than two different x."""
    x, y = (np.asarray(v, float) for v in (x, y))
    good = (x > 0) & (y > 0)
    if len(set(x[good])) < 2:
        return None
    q, c = np.polyfit(np.log(x[good]), np.log(y[good]), 1)
    return math.exp(c), float(q)
