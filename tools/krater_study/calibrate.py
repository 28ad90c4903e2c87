# SPDX-License-Identifier: GPL-3.0-or-later
"""calibrate: one or two constants that bring measures nearest to their truth."""

import dataclasses
import math

import numpy as np
from scipy.optimize import minimize, minimize_scalar

import pictures
from answer import Answer, Picture, Table, failed_sentences, number, reference_of, scaled, short_names
from members import member
from study_file import Block, InputError


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
