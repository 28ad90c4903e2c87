# SPDX-License-Identifier: GPL-3.0-or-later
"""ballistic_limit and calibrate: what to run next depends on what has been run.

ballistic_limit halves an interval of speeds whose ends were not perforated and perforated, then fits Recht and Ipson,

    v_r = a (v^p - v_bl^p)^(1/p),    0 < a <= 1,  p = 2 where fewer than five shots perforated

to the residual speeds. Two intervals are said: that of the shots, which is certain, and that of the fit (95 %,
Student).
"""

import dataclasses
import math

import numpy as np
from scipy.optimize import curve_fit, minimize, minimize_scalar
from scipy.special import stdtrit

import pictures
from answer import Answer, Picture, Table, failed_sentences, number, reference_of, scaled, short_names
from members import member, text_of
from refinement import CELL, Convergence
from study_file import Block, InputError
from uncertainty import estimate, levels_of

TOLERANCE = 0.01  # of the speed


class BallisticLimit:
    def __init__(self, study):
        self.study = study
        outcome = study.keys["outcome"]
        known = study.names("outcomes")
        if outcome not in known:
            study.fail("outcome", f"the scene has no outcomes.{outcome}; give it `outcomes: {{shot: {{projectile: ..., "
                       f"target: ...}}}}` (known: {', '.join(known) or 'none'})")
        self.outcome = str(outcome)
        speed = study.block("speed", required=True)
        for key in speed:
            if key not in ("path", "between", "tolerance"):
                study.fail(f"speed/{key}", "unknown key (known: path, between, tolerance)")
        if "path" not in speed or "between" not in speed:
            study.fail("speed", "expected {path: bodies.rod.velocity.speed, between: [200 m/s, 400 m/s], tolerance: 5 "
                       "m/s}")
        self.path = str(speed["path"])
        study.check_paths("speed", [self.path])
        self.low, self.high = study.between(speed["between"], "speed/between")
        self.tolerance = self.high.number * TOLERANCE
        if "tolerance" in speed:
            given = study.quantity(speed["tolerance"], "speed/tolerance")
            if given.unit != self.low.unit or given.number <= 0:
                study.fail("speed/tolerance", f"a speed above 0 in {self.low.unit} is expected")
            self.tolerance = given.number
        self.most = study.count("members", 20, 1000)
        self.cells = self.read_cells(study)

    @staticmethod
    def read_cells(study):
        """[None] where the scene's own cell is meant, else the texts of several, to be searched one by one."""
        if "cells" not in study.keys:
            return [None]
        cells = study.keys["cells"]
        if not isinstance(cells, list) or len(cells) < 2:
            study.fail("cells", "two cells or more are expected, each about half of the one before; for one alone set "
                       f"{CELL}")
        if CELL in study.settings:
            study.fail("cells", f"this study sets {CELL} for all members; take one of them away")
        found = [study.quantity(text, "cells") for text in cells]
        if len({cell.unit for cell in found}) > 1 or len(levels_of(np.array([cell.number for cell in found]))) < len(found):
            study.fail("cells", "cells in one unit, each more than 15 % from every other, are expected")
        return [cell.text() for cell in sorted(found, key=lambda cell: -cell.number)]

    def shot(self, speed, cell=None):
        values = {self.path: self.low.text(speed)}
        return member(values if cell is None else {**values, CELL: cell})

    def of_cell(self, rows, cell):
        return [row for row in rows if row.member.values.get(CELL) == cell]

    def speed(self, row):
        return float(row.member.values[self.path].split()[0])

    def perforated(self, row):
        """True, False, or None where the run does not tell."""
        found = row.summary.get("outcomes", {}).get(self.outcome, {})
        word = found.get("main_piece_outcome") or found.get("outcome")
        return {"perforated": True, "stopped": False, "ricocheted": False}.get(word)

    def word(self, row):
        return str(row.summary.get("outcomes", {}).get(self.outcome, {}).get("outcome", "nothing"))

    def bracket(self, rows):
        """(fastest that was stopped, slowest that perforated), below each other or None."""
        told = [(self.speed(row), self.perforated(row)) for row in rows if row.done and
                self.perforated(row) is not None]
        through = [v for v, p in told if p]
        high = min(through) if through else None
        stopped = [v for v, p in told if not p and (high is None or v < high)]
        return max(stopped) if stopped else None, high

    def next(self, rows):
        """Cells do not wait for each other: their shots run side by side."""
        return [one for cell in self.cells for one in self.next_of(self.of_cell(rows, cell), cell)]

    def next_of(self, rows, cell):
        if not rows:
            return [self.shot(self.low.number, cell), self.shot(self.high.number, cell)]
        low, high = self.bracket(rows)
        if low is None or high is None or high - low <= self.tolerance or len(rows) >= self.most:
            return self.for_the_fit(rows, low, high, cell)
        middle = self.shot(float(f"{0.5 * (low + high):.6g}"), cell)
        if middle.name in [row.member.name for row in rows]:  # it told nothing: no narrower interval is to be had
            return self.for_the_fit(rows, low, high, cell)
        return [middle]

    def for_the_fit(self, rows, low, high, cell):
        """A fit of one perforation says nothing: more shots between the limit and the fastest."""
        if low is None or high is None:
            return []
        have = [row.member.name for row in rows]
        through = sum(self.perforated(row) is True for row in rows if row.done)
        wanted = [self.shot(float(f"{high + share * (self.high.number - high):.6g}"), cell) for share in (0.25, 0.5, 0.1)]
        new = [one for one in wanted if one.name not in have]
        return new[:1] if through < 4 and new and len(rows) < self.most else []

    def answer(self, rows):
        """Of one cell: its bracket and fit. Of several: those of each, and what they say of each other."""
        answer = Answer(failed_sentences(rows))
        found = [self.limit_of(answer, self.of_cell(rows, cell), cell) for cell in self.cells]
        if len(found) == 1:
            answer.data |= found[0]
        else:
            answer.data = {"unit": self.low.unit, "cells": found}
            by_cell(answer, found, self.low.unit, Convergence.cost_law([row for row in rows if row.done]))
        return answer

    def limit_of(self, answer, rows, cell):
        """{bracket, shots, fit, unit} of a cell, told in `answer`."""
        done = [row for row in rows if row.done]
        low, high = self.bracket(rows)
        unit, at = self.low.unit, f"{cell}: " if cell else ""
        shots = [(self.speed(row), row.measure(f"{self.outcome}.residual_speed") or 0.0, self.perforated(row))
                 for row in done]
        answer.tables.append(Table(f"Shots{f', cell {cell}' if cell else ''}", [
            f"speed {unit}", "what became of it", "residual m/s", "core-seconds"],
            [[number(self.speed(row), 5), self.word(row), number(row.measure(f"{self.outcome}.residual_speed"), 4),
              number(row.cost["core_seconds"], 3)] for row in sorted(done, key=self.speed)]))
        for row in done:
            if self.perforated(row) is None:
                answer.sentences.append(f"{at}At {number(self.speed(row), 5)} {unit} the run tells nothing "
                                        f"({self.word(row)}); a later time.end, or time: {{stop_when: {{settled: ...}}}}, "
                                        "would.")
        fit = None
        if low is None or high is None:
            missing = "perforated" if high is None else "was stopped"
            answer.sentences.append(f"{at}No shot between {self.low.text()} and {self.high.text()} {missing}: the limit "
                                    f"lies {'above' if high is None else 'below'} this interval. Widen speed.between.")
        else:
            alone = "" if cell else (" That holds for this cell only: give `cells: [...]`, some of them finer, and this "
                                     "study tells whether it answers the question.")
            answer.sentences.append(f"{at}The limit lies between {low:.5g} and {high:.5g} {unit}: the fastest that was "
                                    f"stopped, the slowest that perforated.{alone}")
            fit = recht_ipson([(v, r) for v, r, p in shots if p], low, high)
            answer.sentences += [at + line for line in fit_sentences(fit, low, high, unit)]
        drawn = [(v, r if p else 0.0, p) for v, r, p in shots if p is not None]
        if drawn:
            name = "limit" if cell is None else f"limit_{cell.replace(' ', '')}"
            answer.pictures.append(Picture(
                name, f"{at}Residual against impact speed; the band is the fit's confidence interval.",
                lambda figure: pictures.limit(figure, drawn, fit, unit)))
        return {"cell": next((row.cell for row in done), None), "bracket": [low, high], "unit": unit, "shots": shots,
                "fit": fit}


TARGET = 0.02  # of the limit: what an answer by several cells is measured by


def by_cell(answer, found, unit, law):
    """Do these cells answer the question, and what would? The intervals of the shots are an error of their own."""
    known = [one for one in found if None not in one["bracket"]]
    cells, limits = [one["cell"] for one in known], [0.5 * sum(one["bracket"]) for one in known]
    answer.tables.append(Table("Limit by cell", ["cell mm", f"limit {unit}", f"bracket {unit}"], [
        [number(1e3 * cell), number(limit), f"{one['bracket'][0]:.5g} to {one['bracket'][1]:.5g}"]
        for cell, limit, one in zip(cells, limits, known)]))
    if len(known) < 2:
        answer.sentences.append("Fewer than two cells have a limit: nothing is known of the error of the cell.")
        return
    result, width = estimate(cells, limits), max(high - low for low, high in (one["bracket"] for one in known))
    band = result.uncertainty + 0.5 * width
    if np.ptp(limits) < width:
        band = width
        result.behaviour, result.order = "differs by less than its intervals are wide (a smaller speed.tolerance tells more)", None
    answer.data |= {"limit": result.value, "uncertainty": band, "how": result.how}
    told = ", ".join(number(limit) for limit in limits)
    answer.sentences.append(f"By the cells {', '.join(number(1e3 * cell) for cell in cells)} mm the limit is {told} {unit}: it "
                            f"{result.how}, and lies at {result.value:.4g} +- {band:.2g} {unit}.")
    allowed = TARGET * abs(result.value)
    far = [number(1e3 * cell) for cell, limit in zip(cells, limits) if abs(limit - result.value) + band > allowed]
    if not far:
        answer.sentences.append(f"Every one of these cells answers to {100 * TARGET:g} %.")
        return
    line = f"{', '.join(far)} mm do{'es' if len(far) == 1 else ''} not answer to {100 * TARGET:g} %"
    if len(far) == len(cells) and result.falls_as:
        cell = min(cells) * (allowed / band) ** (1 / result.falls_as)
        price = f", about {text_of(law[2] * law[0] * cell ** law[1])} of core time a shot" if law else ""
        line += f"; {1e3 * cell:.2g} mm should{price}"
    elif len(far) == len(cells):
        line += (", and where it ends these cells do not show: halve the finest again, or give the law that softens a length "
                 "(resolution.md of the manual)" if len(cells) > 2 else "; a third cell would tell what does")
    answer.sentences.append(line + ".")


def recht_ipson(shots, low, high):
    """Fit of (speed, residual) of the shots that perforated; None of fewer than three."""
    if len(shots) < 3:
        return None
    v, r = np.array(sorted(shots)).T
    p = 2.0 if len(v) < 5 else None

    def model(x, limit, a, power=2.0):
        return a * np.maximum(x**power - limit**power, 0.0) ** (1 / power)
    start, bounds = [0.5 * (low + high), 0.8], [[0.5 * low, 0.01], [v.min(), 1.0]]
    if p is None:
        start, bounds = start + [2.0], [bounds[0] + [1.0], bounds[1] + [6.0]]
    start[0] = min(start[0], 0.999 * v.min())
    try:
        found, covariance = curve_fit(model, v, r, p0=start, bounds=bounds, maxfev=20000)
    except (RuntimeError, ValueError):
        return None
    free = len(v) - len(found)
    spread = math.sqrt(covariance[0, 0]) if np.isfinite(covariance[0, 0]) else math.inf
    half = float(stdtrit(free, 0.975)) * spread if free > 0 else math.inf
    return {"limit": float(found[0]), "a": float(found[1]), "p": float(found[2]) if len(found) > 2 else 2.0,
            "half": half,
            "interval": [max(0.0, float(found[0]) - half), float(found[0]) + half], "shots": len(v),
            "misfit": float(np.sqrt(np.mean((model(v, *found) - r) ** 2)))}


def fit_sentences(fit, low, high, unit):
    if fit is None:
        yield "Fewer than three shots perforated, or no curve fits: no Recht-Ipson fit."
        return
    yield (f"Recht-Ipson: limit {fit['limit']:.4g} +- {fit['half']:.2g} {unit} (95 %), a = {fit['a']:.3g}, p = "
           f"{fit['p']:.3g}, "
           f"{fit['shots']} shots, misfit {fit['misfit']:.2g} {unit}.")
    if fit["interval"][0] > high or fit["interval"][1] < low:
        yield ("The fit's interval and that of the shots do not meet: residual speeds do not follow the curve near the "
               "limit; "
               "believe the shots.")


@dataclasses.dataclass
class Parameter:
    path: str
    low: float
    high: float
    unit: str


class Calibrate:
    """One or two constants that bring measures nearest to their truth, in units of its uncertainty (1 % where not
    said)."""

    def __init__(self, study):
        self.study = study
        self.parameters = []
        for path, value in study.block("vary", required=True).items():
            low, high = study.between(value.get("between") if isinstance(value, Block) else value, f"vary/{path}")
            self.parameters.append(Parameter(path, low.number, high.number, low.unit))
        study.check_paths("vary", [one.path for one in self.parameters])
        if len(self.parameters) > 2:
            study.fail("vary", "one or two constants: three are not told apart by a few numbers")
        if len(study.truth) < len(self.parameters):
            study.fail("truth", "as many measures as constants are needed, or they are not told apart")
        study.measures = [name for name in study.measures if name in study.truth]
        self.most = study.count("members", 15 * len(self.parameters), 1000)

    def trial(self, x):
        """x in 0 to 1 of each range; four digits of it, so that a search that comes back meets its own member."""
        return member({one.path: f"{one.low + round(float(u), 4) * (one.high - one.low):.7g} {one.unit}".strip()
                       for one, u in zip(self.parameters, x)})

    def residual(self, row):
        """Root mean square distance from the truth in its uncertainties; infinite of a member that failed."""
        total = 0.0
        for name in self.study.truth:
            value, truth = row.measure(name), reference_of(self.study, [row], name)
            if value is None or truth is None:
                return math.inf
            total += ((value - truth[0]) / (truth[1] or 0.01 * abs(truth[0]) or 1.0)) ** 2
        return math.sqrt(total / len(self.study.truth))

    def next(self, rows):
        """The search is taken again from its start with what is known; the first trial that is not is run next."""
        known = {row.member.name: row for row in rows}
        if any(row.status == "left" for row in rows) or len(rows) >= self.most:
            return []

        def look(x):
            x = np.clip(np.atleast_1d(x), 0, 1)
            one = self.trial(x)
            if one.name not in known:
                raise Unknown(one)
            return min(self.residual(known[one.name]) ** 2, 1e12)
        try:
            if len(self.parameters) == 1:
                for u in (0.0, 0.5, 1.0):
                    look([u])
                best = min((0.0, 0.5, 1.0), key=lambda u: look([u]))
                minimize_scalar(look, bounds=(max(0, best - 0.5), min(1, best + 0.5)), method="bounded",
                                options={"xatol": 2e-3, "maxiter": self.most})
            else:
                minimize(look, [0.5, 0.5], method="Nelder-Mead", options={
                    "initial_simplex": [[0.5, 0.5], [0.8, 0.5], [0.5, 0.8]], "xatol": 2e-3, "fatol": 1e-3,
                    "maxfev": self.most})
        except Unknown as unknown:
            return [unknown.one]
        return []

    def answer(self, rows):
        answer = Answer(failed_sentences(rows))
        done = sorted((row for row in rows if row.done and math.isfinite(self.residual(row))), key=self.residual)
        if not done:
            raise InputError(f"{self.study.path}: no member gave all measures of `truth`: nothing to calibrate by")
        best = done[0]
        values = {one.path: [float(row.member.values[one.path].split()[0]) for row in done] for one in self.parameters}
        residuals = [self.residual(row) for row in done]
        halves = {one.path: self.half(values[one.path], residuals) for one in self.parameters}
        for one in self.parameters:
            value, half = values[one.path][0], halves[one.path]
            text = f"+- {half:.2g}" if half is not None else "(how well, these members do not tell)"
            answer.sentences.append(f"{one.path} = {value:.5g} {text} {one.unit}: within +- chi^2 of the truth rises "
                                    f"by 1 (one "
                                    "standard deviation, where its uncertainties are).")
            if min(value - one.low, one.high - value) < 0.01 * (one.high - one.low):
                answer.sentences.append(f"{one.path} ended at the edge of its range: the best lies beyond. Widen it.")
        if len(self.parameters) == 2:
            answer.sentences.append("With two constants each +- is that of the members seen while the other moved too: "
                                    "where "
                                    "they can make up for each other it is too small.")
        if residuals[0] > 2:
            answer.sentences.append(f"Even the best misses the truth by {residuals[0]:.2g} of its uncertainties: these "
                                    f"constants "
                                    "alone do not reproduce it.")
        units = {name: scaled(best.unit(name))[1] for name in self.study.measures}
        table = Table("Trials, the best first", [*short_names(list(values)).values(), "residual",
                                                 *(f"{name} {unit}".strip() for name, unit in units.items())],
                      [[*row.member.values.values(), number(r, 3), *(number(scaled(row.unit(n))[0] * row.measure(n), 5)
                                                                     for n in self.study.measures)]
                       for row, r in zip(done, residuals)])
        answer.tables = [table]
        answer.data = {"best": dict(best.member.values), "half": halves, "residual": residuals[0]}
        trials = {one.path: (values[one.path], one.unit) for one in self.parameters} | {"residual": (residuals, "")}
        marks = {one.path: (values[one.path][0], halves[one.path]) for one in self.parameters}
        answer.pictures = [Picture("search", "Residual of every trial.",
                                   lambda figure: pictures.search(figure, trials, marks))]
        return answer

    def half(self, values, residuals):
        """Half-width in which chi^2 rises by 1, of a parabola through the nearest members; None where it has none."""
        x, y = np.array(values), len(self.study.truth) * np.array(residuals) ** 2
        near = np.argsort(np.abs(x - x[0]))[:6]
        if len(set(x[near])) < 3:
            return None
        curvature = np.polyfit(x[near] - x[0], y[near], 2)[0]
        return float(1 / math.sqrt(curvature)) if curvature > 0 else None


class Unknown(Exception):
    def __init__(self, one):
        super().__init__(one.name)
        self.one = one
