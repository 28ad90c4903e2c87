# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers and tables as the tools print them."""

import math

from units import scale_of


def number(value, digits=5):
    if isinstance(value, bool) or value is None:
        return "-" if value is None else str(value)
    return f"{value:.{digits}g}" if isinstance(value, (int, float)) else str(value)


def table(rows, right=(1, 3, 4)):
    """Rows as aligned text; the columns of numbers to the right."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = []
    for row in rows:
        cells = [cell.rjust(width) if i in right else cell.ljust(width)
                 for i, (cell, width) in enumerate(zip(row, widths))]
        lines.append(("  " + "  ".join(cells)).rstrip())
    lines.insert(1, "  " + "  ".join("-" * width for width in widths))
    return "\n".join(lines)


def shown(values, unit):
    """Texts of values of one unit and that unit's name, as people say them: mm, us, g, MPa, km/s. The files are SI."""
    numbers = [abs(value) for value in values if isinstance(value, (int, float)) and math.isfinite(value)]
    divisor, name = scale_of(max(numbers, default=0), unit)
    return [number(value / divisor) if isinstance(value, (int, float)) else number(value) for value in values], \
        divisor, plain(name)


def plain(text):
    """For terminals that know no more than ASCII."""
    for sign, word in (("µ", "u"), ("°", "degree"), ("³", "^3"), ("²", "^2")):
        text = text.replace(sign, word)
    return text
