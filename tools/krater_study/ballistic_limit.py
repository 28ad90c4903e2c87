# SPDX-License-Identifier: GPL-3.0-or-later
"""ballistic_limit: at what speed is it just perforated?

Halves an interval of speeds whose ends were not perforated and perforated, then fits Recht and Ipson,

    v_r = a (v^p - v_bl^p)^(1/p),    0 < a <= 1,  p = 2 where fewer than five shots perforated

to the residual speeds. Two intervals are said: that of the shots, which is certain, and that of the fit (95 %,
Student).

Of several cells the coarsest is asked first, by the whole interval; a finer one begins where those before it point to,
by the straight line through the last two, and widens its interval by doubling where that was wrong. A shot at half the
cell takes eight times as long, so nearly all of the time is that of the finest cell's shots: these are saved.
"""

import math

import numpy as np
from scipy.optimize import curve_fit
from scipy.special import stdtrit

import pictures
from answer import Answer, Picture, Table, failed_sentences, number
from members import YEAR, member, text_of
from refinement import CELL, Convergence
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
        self.cells = self.read_cells(study)
        self.most = self.read_most(study)

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

    def read_most(self, study):
        """{cell: shots at most}: one number, or one for each cell, as its shots are dearer and dearer."""
        said = study.keys.get("members")
        if not isinstance(said, list) or "cells" not in study.keys:
            return dict.fromkeys(self.cells, study.count("members", 20, 1000))
        if len(said) != len(self.cells):
            study.fail("members", f"one number, or as many as there are cells ({len(self.cells)}), are expected")
        order = sorted(range(len(said)), key=lambda k: -study.quantity(study.keys["cells"][k], "cells").number)
        return {cell: study.whole(said[k], "members", 1000) for cell, k in zip(self.cells, order)}

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
        """Shots of the coarsest cell that still wants any."""
        for k, cell in enumerate(self.cells):
            if wanted := self.next_of(self.of_cell(rows, cell), cell, self.begin(rows, k)):
                return wanted
        return []

    def begin(self, rows, k):
        """The first two speeds of a cell: the ends, or around what coarser cells point to."""
        known = [(float(cell.split()[0]), 0.5 * (low + high)) for cell in self.cells[:k]
                 for low, high in [self.bracket(self.of_cell(rows, cell))] if None not in (low, high)]
        if not known:
            return self.low.number, self.high.number
        cell, guess = known[-1]
        half = 2 * self.tolerance
        if len(known) > 1:
            (coarse, before), own = known[-2], float(self.cells[k].split()[0])
            change = (guess - before) * (cell - own) / (coarse - cell)
            guess, half = guess + change, max(half, 0.5 * abs(change))
        return max(self.low.number, guess - half), min(self.high.number, guess + half)

    def next_of(self, rows, cell, begin):
        if not rows:
            return self.distinct([self.shot(float(f"{speed:.6g}"), cell) for speed in begin], [])[:self.most[cell]]
        low, high = self.bracket(rows)
        if len(rows) >= self.most[cell]:
            return []
        if low is None or high is None:
            return self.widened(rows, low, cell)
        if high - low <= self.tolerance:
            return self.for_the_fit(rows, high, cell)
        middle = self.distinct([self.shot(float(f"{0.5 * (low + high):.6g}"), cell)], rows)
        return middle or self.for_the_fit(rows, high, cell)  # it told nothing: no narrower interval is to be had

    @staticmethod
    def distinct(shots, rows):
        """Those that were not asked yet, each once."""
        return list({one.name: one for one in shots if one.name not in [row.member.name for row in rows]}.values())

    def widened(self, rows, low, cell):
        """All perforated, or none: as far again beyond what was tried, to the ends."""
        tried = [self.speed(row) for row in rows]
        step = max(max(tried) - min(tried), 2 * self.tolerance)
        speed = max(self.low.number, min(tried) - step) if low is None else min(self.high.number, max(tried) + step)
        return self.distinct([self.shot(float(f"{speed:.6g}"), cell)], rows)

    def for_the_fit(self, rows, high, cell):
        """A fit of one perforation says nothing: more shots between the limit and the fastest."""
        through = sum(self.perforated(row) is True for row in rows if row.done)
        wanted = [self.shot(float(f"{high + share * (self.high.number - high):.6g}"), cell) for share in (0.25, 0.5, 0.1)]
        wanted = [one for one in wanted if one.name not in [row.member.name for row in rows]]
        return wanted[:max(0, min(4 - through, self.most[cell] - len(rows)))]

    def expected(self):
        """[(a shot, how many like it)]: what all of it will take, as far as it can be known before."""
        halvings = math.ceil(math.log2(max(2.0, (self.high.number - self.low.number) / self.tolerance)))
        first, later = 4 + halvings, 7  # ends, halvings, fit; two, one too far, two halvings, fit
        speed = float(f"{0.5 * (self.low.number + self.high.number):.6g}")
        return [(self.shot(speed, cell), min(self.most[cell], first if k == 0 else later))
                for k, cell in enumerate(self.cells)]

    def answer(self, rows):
        """Of one cell: its bracket and fit. Of several: those of each, and what they say of each other."""
        answer = Answer(failed_sentences(rows))
        found = [self.limit_of(answer, self.of_cell(rows, cell), cell) for cell in self.cells]
        if len(found) == 1:
            answer.data |= found[0]
        else:
            whole = Answer(data={"unit": self.low.unit, "cells": found})  # what was asked for comes first
            by_cell(whole, found, self.low.unit, Convergence.cost_law([row for row in rows if row.done]))
            answer = Answer(whole.sentences + answer.sentences, whole.tables + answer.tables, whole.pictures, whole.data)
        return answer

    def outside(self, done, low, high):
        """Where a limit lies that shots of one kind alone were asked of."""
        told = [self.speed(row) for row in done if self.perforated(row) is not None]
        if not told:
            return "No shot tells whether it perforated: nothing is known of the limit."
        fate, end = ("perforated", max(told)) if high is None else ("was stopped", min(told))
        reached = end >= self.high.number if high is None else end <= self.low.number
        return (f"No shot {fate}: the limit lies {'above' if high is None else 'below'} {self.low.text(end)}. " +
                ("Widen speed.between." if reached else "More shots would tell where (the same command goes on; `members` bounds them)."))

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
            answer.sentences.append(at + self.outside(done, low, high))
        else:
            alone = "" if cell else (" That holds for this cell only: give `cells: [...]`, some of them finer, and this "
                                     "study tells whether it answers the question.")
            answer.sentences.append(f"{at}The limit lies between {low:.5g} and {high:.5g} {unit}: the fastest that was "
                                    f"stopped, the slowest that perforated.{alone}")
            fit = recht_ipson([(v, r) for v, r, p in shots if p], low, high)
            answer.sentences += [at + line for line in fit_sentences(fit, low, high, unit)]
        drawn = [(v, r if p else 0.0, p) for v, r, p in shots if p is not None]
        if drawn:
            answer.pictures.append(Picture("limit", "Residual against impact speed; the band is the fit's confidence interval.",
                                           lambda figure: pictures.limit(figure, drawn, fit, unit)))
        return {"cell": next((row.cell for row in done), None), "bracket": [low, high], "unit": unit, "shots": shots,
                "fit": fit, "core_seconds": sum(row.cost["core_seconds"] for row in done)}


TARGET = 0.02  # of the limit: what an answer by several cells is measured by


def by_cell(answer, found, unit, law):
    """Do these cells answer the question, and what would? The intervals of the shots are an error of their own."""
    known = [one for one in found if None not in one["bracket"]]
    cells, limits = [one["cell"] for one in known], [0.5 * sum(one["bracket"]) for one in known]
    answer.tables.append(Table("Limit by cell", ["cell mm", f"limit {unit}", f"bracket {unit}", "shots", "core-seconds"], [
        [number(1e3 * cell), number(limit), f"{one['bracket'][0]:.5g} to {one['bracket'][1]:.5g}", str(len(one["shots"])),
         number(one["core_seconds"], 3)] for cell, limit, one in zip(cells, limits, known)]))
    if len(known) < 2:
        answer.sentences.append("Fewer than two cells have a limit: nothing is known of the error of the cell.")
        return
    result, width = estimate(cells, limits), max(high - low for low, high in (one["bracket"] for one in known))
    band = result.uncertainty + 0.5 * width
    if np.ptp(limits) < width:
        band = width
        result.behaviour, result.order = "differs by less than its intervals are wide (a smaller speed.tolerance tells more)", None
    answer.data |= {"limit": result.value, "uncertainty": band, "how": result.how}
    answer.pictures.append(Picture("limit", "Left: residual against impact speed, with the fits; crosses: not perforated. Right: the limit of "
                                   "each cell with its shots' interval; shaded: where the limit of small cells lies in nine of ten cases.",
                                   lambda figure: pictures.limits(figure, known, limits, band, unit)))
    told = ", ".join(number(limit) for limit in limits)
    answer.sentences.append(f"By the cells {', '.join(number(1e3 * cell) for cell in cells)} mm the limit is {told} {unit}: it "
                            f"{result.how}, and lies at {result.value:.4g} +- {band:.2g} {unit}.")
    allowed = TARGET * abs(result.value)
    far = [number(1e3 * cell) for cell, limit in zip(cells, limits) if abs(limit - result.value) + band > allowed]
    if not far:
        answer.sentences.append(f"Every one of these cells answers to {100 * TARGET:g} %.")
        return
    line = f"{', '.join(far)} mm do{'es' if len(far) == 1 else ''} not answer to {100 * TARGET:g} %"
    if len(far) == len(cells):
        line += what_would(result.falls_as, min(cells), allowed / band, law, len(cells))
    answer.sentences.append(line + ".")


def what_would(order, finest, share, law, count):
    """The cell at which the band, which falls by `order`, is `share` of the finest cell's; or why there is none."""
    softens = "give the law that softens a length (resolution.md of the manual)"
    if not order:
        return (f", and where it ends these cells do not show: halve the finest again, or {softens}" if count > 2 else
                "; a third cell would tell what does")
    cell = finest * share ** (1 / order)
    price = law[2] * law[0] * cell ** law[1] if law else 0.0
    if price > YEAR:
        return (f"; by what they show {1e3 * cell:.1g} mm would, which is out of reach: halve the finest, for that may show more, or "
                f"{softens}")
    return f"; {1e3 * cell:.2g} mm should" + (f", at {text_of(price)} of core time a shot" if law else "")


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
