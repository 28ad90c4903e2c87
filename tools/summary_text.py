# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers and tables as the tools print them."""


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


# Lengths and times are easier to read in mm and us; the file itself is SI.
READABLE = {"m": (1e3, "mm"), "s": (1e6, "us")}
