# SPDX-License-Identifier: GPL-3.0-or-later
"""Columns of a table of members: a name (of what was varied, of a measure, of a cost, `audit.NAME` and whatever else
summary.json holds), or {title: expression} of such names in SI (expressions.py):

    {"length over width": cloud_length / cloud_width}
"""

from answer import number
from expressions import Expression, Missing, Unknown, known_names, lookup
from study_file import InputError, suggestion
from units import scale_of


def measure_column(name, rows, off):
    """[title, ...] and lines of cells of a measure, in the unit that its values call for; its distance to the reference
    beside it."""
    values = [row.measure(name) if row.done else None for row in rows]
    unit = next((row.unit(name) for row in rows if row.done and row.unit(name)), "")
    largest = max((abs(v) for v in values if v is not None), default=0.0)
    scale, shown = scale_of(largest, unit)
    titles = [f"{name.replace('_', ' ')} {shown}".strip()]
    lines = [[number(v and v / scale if v != 0 else v, 5)] for v in values]
    told = [row.summary.get("measures", {}).get(name, {}).get("difference_percent") for row in rows]
    if off and any(one is not None for one in told):
        titles.append("off %")
        lines = [line + ["-" if one is None else f"{one:+.2f}"] for line, one in zip(lines, told)]
    return titles, lines


def plain_column(name, rows):
    """[title] and lines of cells of anything else that has a name."""
    if any(name in row.member.values for row in rows):
        return [name.rsplit(".", 1)[-1].replace("_", " ")], [[row.member.values.get(name, "-")] for row in rows]
    cells = []
    for row in rows:
        try:
            found = lookup(row, name) if row.done or name == "member" else None
        except (Unknown, Missing):
            found = None
        cells.append([found if isinstance(found, str) else
                      f"{found:.0f}" if name in ("points", "steps") and found is not None else
                      "-" if isinstance(found, (dict, list)) else number(found, 2 if "seconds" in name else 4)])
    titles = {"core_seconds": "core s", "wall_seconds": "wall s", "cell": "cell m", "bytes": "memory B"}
    return [titles.get(name, name.replace("audit.", "").replace("_", " "))], cells


def column(name, rows, folder_of, off=False):
    """[titles], [cells of a row] of a column as a template names it."""
    if isinstance(name, dict):
        (title, text), = name.items()
        if any(text in row.member.values for row in rows):
            return [title], plain_column(text, rows)[1]
        expression = Expression(str(text), rows, folder_of)
        digits = ".2f" if title.endswith("%") else ".4g"
        return [title], [["-" if value is None else f"{value:{digits}}"] for value in map(expression.of, rows)]
    if any(name in row.summary.get("measures", {}) for row in rows) or str(name).endswith(".residual_speed"):
        return measure_column(str(name), rows, off)
    if any(row.done for row in rows) and name not in known_names(rows) and \
            all(is_unknown(row, name) for row in rows if row.done):
        raise InputError(f"no member has '{name}' ({suggestion(name, known_names(rows))})")
    return plain_column(str(name), rows)


def is_unknown(row, name):
    try:
        lookup(row, name)
    except Unknown:
        return True
    except Missing:
        pass
    return False


def across(path, rows, keys, values):
    """A table with a line for each of what else was varied, and the columns once for each value of `path`, side by side:
    (titles, lines). keys, values: (title, cells of the rows) of columns that name what was varied, and of the others."""
    texts = list(dict.fromkeys(row.member.values.get(path, "-") for row in rows))
    short = path.rsplit(".", 1)[-1].replace("_", " ")
    lines = {}
    for k, row in enumerate(rows):
        rest = tuple((name, text) for name, text in row.member.values.items() if name != path)
        _, found = lines.setdefault(rest, ([cells[k] for _, cells in keys], {}))
        found[row.member.values.get(path, "-")] = [cells[k] for _, cells in values]
    return ([title for title, _ in keys] + [f"{title}, {short} {text}" for text in texts for title, _ in values],
            [[*head, *(cell for text in texts for cell in found.get(text, ["-"] * len(values)))]
             for head, found in lines.values()])
