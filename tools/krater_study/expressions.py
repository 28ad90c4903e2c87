# SPDX-License-Identifier: GPL-3.0-or-later
"""Expressions of a template: of the numbers of a member, of its history, of its points. Parsed, never executed; in SI.

    cloud_length / cloud_width                      + - * / ** abs min max sqrt log, names as columns.py has them,
    fragments.pieces.pieces[1].mass                 whatever summary.json holds
    change(x), step(x)                              % by the first row, by the row before
    at(X, "12 us"), least(X), most(X), when_least(X)    X: an expression of columns of the history
    mean(X, "20 us", WHERE), spread(...), quantile(X, "20 us", WHERE, 0.99)
                                                    over the points of a frame, weighted by mass; X of x, y, z, body and
                                                    its fields; WHERE is left out or says which: body == "target" and
                                                    -2e-3 < z < 0
    noise(field, "20 us")                           rms difference of the points of a 2d run and their mean over a cell
"""

import ast
import functools
import math
import operator
import os
import re
import sys

import numpy as np

from study_file import QUANTITY, InputError, suggestion

TOOLS = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))  # those that read and draw runs
sys.path.append(TOOLS)
from units import quantity  # noqa: E402

COSTS = ("points", "steps", "core_seconds", "wall_seconds", "point_steps", "bytes", "threads")
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
             ast.Pow: operator.pow, ast.USub: operator.neg, ast.UAdd: operator.pos}
COMPARISONS = {ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge, ast.Eq: operator.eq,
               ast.NotEq: operator.ne}
FUNCTIONS = {"abs": abs, "min": min, "max": max, "sqrt": math.sqrt, "log": math.log}
OF_ARRAYS = {"abs": np.abs, "min": lambda *x: functools.reduce(np.minimum, x),
             "max": lambda *x: functools.reduce(np.maximum, x), "sqrt": np.sqrt, "log": np.log}
OF_ROWS = ("change", "step")
OF_HISTORY = {"at": 2, "least": 1, "most": 1, "when_least": 1}
OF_POINTS = {"mean": (2, 3), "spread": (2, 3), "quantile": (4,)}
EVERY = [*FUNCTIONS, *OF_ROWS, *OF_HISTORY, *OF_POINTS, "noise"]


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
    for step in re.findall(r"[^.\[\]]+", name):
        if isinstance(found, list) and step.isdecimal():
            if int(step) >= len(found):
                raise Missing(name)  # as the second piece of a plate that holds
            found = found[int(step)]
        elif isinstance(found, dict) and step in found:
            found = found[step]
        else:
            raise Unknown(name)
    return found


DEFINED = {}  # name -> tree: of the head of the template, of which a process has one


class Defined(ast.NodeTransformer):
    def visit_Name(self, node):
        return DEFINED.get(node.id, node)


def parse(text):
    try:
        return Defined().visit(ast.parse(str(text), mode="eval")).body
    except SyntaxError:
        raise InputError(f"'{text}' is no expression, as cloud_length / cloud_width") from None


def define(name, text):
    """Gives an expression a name, which those that are parsed later may use."""
    DEFINED[name] = parse(text)


def evaluate(node, text, name, call):
    """Value of a tree: `name(text)` gives those of names, `call(function, arguments)` those of calls."""
    def of(other):
        return evaluate(other, text, name, call)
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        return OPERATORS[type(node.op)](of(node.left), of(node.right))
    if isinstance(node, ast.UnaryOp) and type(node.op) in OPERATORS:
        return OPERATORS[type(node.op)](of(node.operand))
    if isinstance(node, ast.Compare) and all(type(one) in COMPARISONS for one in node.ops):
        sides = [of(one) for one in (node.left, *node.comparators)]
        return functools.reduce(np.logical_and, (COMPARISONS[type(one)](a, b) for one, a, b in
                                                 zip(node.ops, sides, sides[1:])))
    if isinstance(node, ast.BoolOp):
        return functools.reduce(np.logical_and if isinstance(node.op, ast.And) else np.logical_or, map(of, node.values))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        return call(node.func.id, node.args)
    if isinstance(node, (ast.Name, ast.Attribute, ast.Subscript)):
        return name(ast.unparse(node))
    raise InputError(f"'{ast.unparse(node)}' is not understood in '{text}' (names, numbers, + - * / **, "
                     f"{', '.join(EVERY)})")


def time_of(text, whole):
    try:
        return quantity(str(text), "s")
    except ValueError as error:
        raise InputError(f"'{whole}': {error}") from None


def elementwise(function, arguments, text, name, call):
    """Calls of expressions of arrays."""
    if function not in OF_ARRAYS:
        raise InputError(f"no function {function} of {len(arguments)} in '{text}' (there are {', '.join(OF_ARRAYS)})")
    return OF_ARRAYS[function](*(evaluate(one, text, name, call) for one in arguments))


class History:
    """Expressions of the columns of a run's history."""

    def __init__(self, folder):
        from run_reader import read_history
        self.columns = read_history(f"{folder}/history.csv")

    @property
    def time(self):
        return self.columns["time"][1]

    def name(self, name):
        if name not in self.columns:
            raise InputError(f"the history has no column '{name}' ({suggestion(name, list(self.columns))})")
        return self.columns[name][1]

    def values(self, node, text):
        def call(function, arguments):
            if OF_HISTORY.get(function) == len(arguments):
                return self.number_of(function, arguments, text)
            return elementwise(function, arguments, text, self.name, call)
        return evaluate(node, text, self.name, call) + 0.0 * self.time

    def number_of(self, function, arguments, text):
        values = self.values(arguments[0], text)
        if function == "at":
            if not isinstance(arguments[1], ast.Constant):
                raise InputError(f"'{text}': at(...) of a time is expected, as \"12 us\"")
            return float(np.interp(time_of(arguments[1].value, text), self.time, values))
        return float({"least": np.min, "most": np.max}[function](values) if function != "when_least" else
                     self.time[np.argmin(values)])


class Points:
    """Expressions of the points of a run at a time: arrays over the points of all bodies."""

    def __init__(self, folder, time):
        from run_pictures import nearest
        from run_reader import Run
        run = Run(folder)
        self.number = nearest(run, time)
        self.time = run.time(self.number)
        self.bodies = run.bodies(self.number)

    def name(self, name):
        if name == "body":
            return np.concatenate([np.full(len(body.x), body.name, dtype=object) for body in self.bodies])
        if name in ("x", "y", "z"):
            return np.concatenate([body.x[:, "xyz".index(name)] for body in self.bodies])
        if name == "volume":
            return np.concatenate([body.volume for body in self.bodies])
        found = [body.values(name) for body in self.bodies]
        if all(values is None for values in found):
            raise InputError(f"the points have no '{name}' (x, y, z, body, volume, or a field that output.fields writes; "
                             "velocity_z is a component)")
        return np.concatenate([np.full(len(body.x), np.nan) if values is None else values
                               for body, values in zip(self.bodies, found)])

    def values(self, node, text):
        def call(function, arguments):
            if function in OF_POINTS:
                return self.number_of(function, arguments, text, 0)
            return elementwise(function, arguments, text, self.name, call)
        return evaluate(node, text, self.name, call)

    def weights(self):
        """Masses, or volumes where output.fields leaves masses out."""
        return self.name("mass" if all(body.values("mass") is not None for body in self.bodies) else "volume")

    def number_of(self, function, arguments, text, skipped=1):
        """mean, spread, quantile of (expression, [time: `skipped`,] where, share)."""
        x = self.values(arguments[0], text) + 0.0 * self.name("x")
        rest = arguments[1 + skipped:]
        kept = np.isfinite(x)
        if rest:
            kept &= self.values(rest[0], text)
        x, weight = x[kept], self.weights()[kept]
        if not len(x) or not weight.sum() > 0:
            raise Missing(text)
        if function == "quantile":
            share, order = self.values(rest[1], text), np.argsort(x)
            reached = np.cumsum(weight[order])
            return float(x[order][min(np.searchsorted(reached, share * reached[-1]), len(x) - 1)])
        mean = float(np.average(x, weights=weight))
        return mean if function == "mean" else math.sqrt(np.average((x - mean) ** 2, weights=weight))


@functools.lru_cache(maxsize=4)
def points_of(folder, time):
    return Points(folder, time)


class Expression:
    """An expression over the rows of its table."""

    def __init__(self, text, rows, folder_of):
        self.text, self.rows, self.folder_of = str(text), rows, folder_of
        self.tree = parse(text)

    def of(self, row):
        """Its value for a row, or None."""
        try:
            return float(self.value(self.tree, row))
        except (Missing, ZeroDivisionError, OverflowError):
            return None
        except (TypeError, ValueError):
            raise InputError(f"'{self.text}' gives no number") from None

    def value(self, node, row):
        return evaluate(node, self.text, lambda name: self.name(name, row),
                        lambda function, arguments: self.call(function, arguments, row))

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
        if OF_HISTORY.get(name) == len(arguments) or len(arguments) in OF_POINTS.get(name, ()) or (
                name == "noise" and len(arguments) == 2):
            return self.of_a_run(name, arguments, row)
        raise InputError(f"no function {name} of {len(arguments)} in '{self.text}' (there are {', '.join(EVERY)})")

    def of_a_run(self, name, arguments, row):
        if not row.done:
            raise Missing(name)
        folder = self.folder_of(row)
        if name in OF_HISTORY:
            return History(folder).number_of(name, arguments, self.text)
        time = time_of(self.value(arguments[1], row), self.text)
        if name == "noise":
            import run_pictures  # here, not above: matplotlib takes long to load
            return run_pictures.noise(folder, ast.unparse(arguments[0]), time)
        return points_of(folder, time).number_of(name, arguments, self.text)
