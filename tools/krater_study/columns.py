# SPDX-License-Identifier: GPL-3.0-or-later
"""Columns of a table of members: a name (of what was varied, of a measure, of a cost, `audit.NAME` and whatever else
summary.json holds), or {title: expression} of such names in SI.

    {"length over width": cloud_length / cloud_width}       + - * / ** abs min max sqrt log
    change(x): % by the first row, step(x): % by the row before, at(measure, "12 us"): of the history at a time,
    noise(field, "20 us"): rms difference of the points of a 2d run and their mean over a cell
"""

import ast
import math
import operator
import os
import sys

import numpy as np

from answer import number
from study_file import QUANTITY, InputError, suggestion

TOOLS = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))  # those that read and draw runs
sys.path.append(TOOLS)
from units import quantity, scale_of  # noqa: E402

COSTS = ("points", "steps", "core_seconds", "wall_seconds", "point_steps", "bytes", "threads")
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
             ast.Pow: operator.pow, ast.USub: operator.neg, ast.UAdd: operator.pos}
FUNCTIONS = {"abs": abs, "min": min, "max": max, "sqrt": math.sqrt, "log": math.log}
OF_ROWS = ("change", "step")
OF_A_RUN = ("at", "noise")


class Missing(Exception):
    """A value that this member has not: its cell is '-'."""


class Unknown(Exception):
    """A name that no member has."""


def known_names(rows):
    names = ["member", "cell", *COSTS]
    for row in rows:
        names += [*row.member.values, *row.summary.get("measures", {}),
                  *(f"audit.{key}" for key in row.summary.get("audit", {}))]
    return list(dict.fromkeys(names))


def lookup(row, name):
    """Number or text of a name; Missing or Unknown."""
    if name == "member":
        return row.member.name
    if name in row.member.values:
        return row.member.values[name]
    if name == "cell":
        return row.cell
    if name in COSTS:
        return row.cost.get(name)
    if name in row.summary.get("measures", {}) or name.endswith(".residual_speed"):
        return row.measure(name)
    found = row.summary
    for step in name.split("."):
        if not isinstance(found, dict) or step not in found:
            raise Unknown(name)
        found = found[step]
    return found


class Expression:
    """A column's expression over the rows of its table."""

    def __init__(self, text, rows, folder_of):
        self.text, self.rows, self.folder_of = text, rows, folder_of
        try:
            self.tree = ast.parse(text, mode="eval").body
        except SyntaxError:
            raise InputError(f"'{text}' is no expression, as cloud_length / cloud_width") from None

    def of(self, row):
        """Its value for a row, or None."""
        try:
            return float(self.value(self.tree, row))
        except (Missing, ZeroDivisionError, OverflowError):
            return None
        except (TypeError, ValueError):
            raise InputError(f"'{self.text}' gives no number") from None

    def value(self, node, row):
        if isinstance(node, ast.Constant):
            return node.value
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
            return OPERATORS[type(node.op)](self.value(node.left, row), self.value(node.right, row))
        if isinstance(node, ast.UnaryOp) and type(node.op) in OPERATORS:
            return OPERATORS[type(node.op)](self.value(node.operand, row))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
            return self.call(node.func.id, node.args, row)
        if isinstance(node, (ast.Name, ast.Attribute)):
            return self.name(ast.unparse(node), row)
        raise InputError(f"'{ast.unparse(node)}' is not understood in '{self.text}' (names, numbers, + - * / **, "
                         f"{', '.join([*FUNCTIONS, *OF_ROWS, *OF_A_RUN])})")

    def name(self, name, row):
        if not row.done:
            raise Missing(name)
        try:
            found = lookup(row, name)
        except Unknown:
            known = known_names(self.rows)
            if any(name in one.summary.get("measures", {}) for one in self.rows):
                raise Missing(name) from None
            raise InputError(f"no member has '{name}' ({suggestion(name, known)})") from None
        if isinstance(found, str):
            told = QUANTITY.match(found)
            found = float(told[1]) if told else None
        if found is None or not math.isfinite(found):
            raise Missing(name)
        return found

    def call(self, name, arguments, row):
        if name in FUNCTIONS:
            return FUNCTIONS[name](*(self.value(one, row) for one in arguments))
        if name in OF_ROWS and len(arguments) == 1:
            place = self.rows.index(row)
            other = self.rows[0 if name == "change" else place - 1]
            if place == 0:
                raise Missing(name)
            return 100 * (self.value(arguments[0], row) / self.value(arguments[0], other) - 1)
        if name in OF_A_RUN and len(arguments) == 2:
            return self.of_a_run(name, arguments, row)
        raise InputError(f"no function {name} of {len(arguments)} in '{self.text}' (there are "
                         f"{', '.join([*FUNCTIONS, *OF_ROWS, *OF_A_RUN])})")

    def of_a_run(self, name, arguments, row):
        if not row.done:
            raise Missing(name)
        what, when = ast.unparse(arguments[0]), self.value(arguments[1], row)
        try:
            time = quantity(when, "s")
        except ValueError as error:
            raise InputError(f"'{self.text}': {error}") from None
        if name == "noise":
            import run_pictures  # here, not above: matplotlib takes long to load
            return run_pictures.noise(self.folder_of(row), what, time)
        from run_reader import read_history
        history = read_history(f"{self.folder_of(row)}/history.csv")
        if what not in history:
            raise InputError(f"the history has no column '{what}' ({suggestion(what, list(history))})")
        return float(np.interp(time, history["time"][1], history[what][1]))


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
        except Unknown:
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
    return False
