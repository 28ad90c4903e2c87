# SPDX-License-Identifier: GPL-3.0-or-later
"""Numerical error of a number that was computed with three cells: the grid convergence index of Roache (ASME V&V 20).

With values f3, f2, f1 of cells r^2 h, r h, h and order p = ln((f3 - f2)/(f2 - f1)) / ln r, Richardson's limit is
f1 + (f1 - f2)/(r^p - 1), and the true value lies within U = F |f1 - f2|/(r^p - 1) of f1 in nine of ten cases
(tests/scene/cell_error_test.py). F is 1.25 where p says that the values converge as the scheme does (then U is at
least |f1 - f2|: p is that of three values). An impact has shocks, edges and contact, where the scheme is of order 1: a
higher p of three values is an accident of the coarsest (the foot of taylor_copper: 14.882, 14.545, 14.464 mm, order 2.1,
and then 14.615), so F is 3 with order 1. Values that do not settle are not in that range either: there U is at least
1.25 times the spread of all three, because the two finest may agree by accident.
"""

import math

ORDER = 1.0  # of the scheme at shocks, edges and contact


def error(values, ratio=2.0):
    """(U, order or None, word) of values from the coarsest cell to the finest; word: how the values behave."""
    coarse, middle, fine = values
    first, second = middle - coarse, fine - middle
    spread = max(values) - min(values)
    if spread == 0:
        return 0.0, None, "the same"
    if second == 0 or first / second <= 0:
        return max(3 * abs(second) / (ratio - 1), 1.25 * spread), None, "wavers" if second else "settles"
    order = math.log(first / second) / math.log(ratio)
    if order >= ORDER + 0.5:
        return 3 * abs(second) / (ratio - 1), order, "settles"
    if 0.5 < order:
        return max(1.25 * abs(second) / (ratio**order - 1), abs(second)), order, "converges"
    return max(3 * abs(second) / (ratio - 1), 1.25 * spread), order, "settles" if order > 0 else "changes more and more"
