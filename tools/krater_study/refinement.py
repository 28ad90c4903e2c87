# SPDX-License-Identifier: GPL-3.0-or-later
"""convergence: how wrong is each measure, and what would less error cost?

Repeats are lattices shifted by parts of a cell: cells a few per cent smaller and larger, so that what lies ten cells
from the grid's origin lies up to 0.4 of a cell elsewhere. A shift of the grid itself would do nothing to a body that
stands between an axis and a wall; and the small change of the cell is one that the fit knows how to take."""

import numpy as np

import pictures
from answer import Answer, Picture, Table, failed_sentences, number, percent, reference_of, scaled, with_band
from members import member, text_of
from uncertainty import estimate, levels_of, power_law, validation

CELL = "grid.cell"
SHIFTS = (0.0, -0.04, 0.04, -0.02, 0.02, -0.03, 0.03, -0.01, 0.01)
TARGETS = (0.05, 0.02, 0.01, 0.005)


class Convergence:
    def __init__(self, study):
        self.study = study
        vary = study.block("vary")
        for path in vary:
            if path != CELL:
                study.fail(f"vary/{path}", f"a convergence study varies {CELL} alone; `study: pareto` takes other axes")
        cells = vary.get(CELL) or self.around(study)
        if not isinstance(cells, list) or len(cells) < 2:
            study.fail(f"vary/{CELL}", "one cell has no order: give three or more, each about half of the one before "
                       "([0.8 mm, 0.4 mm, 0.2 mm])")
        self.cells = [study.quantity(text, f"vary/{CELL}") for text in cells]
        for a, b in zip(self.cells, self.cells[1:]):
            if a.unit != b.unit or a.number == b.number:
                study.fail(f"vary/{CELL}", "cells differ, and are given in one unit")
        if len(levels_of(np.array([cell.number for cell in self.cells]))) < 2:
            study.fail(f"vary/{CELL}", "cells within 15 % of each other are one cell whose lattice is shifted, which has "
                       "no order: give three or more, each about half of the one before")
        self.repeats = study.count("repeats", 1, len(SHIFTS))

    @staticmethod
    def around(study):
        """Twice, once and half the scene's own cell."""
        own = study.quantity((study.base.get("grid") or {}).get("cell", ""), "vary")
        return [own.text(factor * own.number) for factor in (2, 1, 0.5)]

    def next(self, rows):
        if rows:
            return []
        return [member({CELL: cell.text(cell.number * (1 + shift))}) for cell in self.cells
                for shift in SHIFTS[:self.repeats]]

    def answer(self, rows):
        answer = Answer(failed_sentences(rows))
        done = [row for row in rows if row.done]
        law = self.cost_law(done)
        table = Table("What is known of each measure", ["measure", "answer", "of it", "order", "how", "small cells"],
                      [])
        costs = Table("Core time of the cheapest cell for an uncertainty",
                      ["measure", *(f"{100 * target:g} %" for target in TARGETS)], [])
        curves = {}
        for name in self.study.measures:
            found = estimate([row.cell for row in done], [np.nan if row.measure(name) is None else row.measure(name)
                                                          for row in done])
            curves[name] = self.curve(name, done, found)
            unit = curves[name]["unit"]
            table.rows.append([name, with_band(found.value, found.uncertainty, unit),
                               percent(found.uncertainty, found.value), number(found.order, 2), found.how,
                               number(found.limit and found.limit * scaled(unit)[0], 5)])
            costs.rows.append([name, *(self.price(name, done, found, target, law) for target in TARGETS)])
            answer.sentences += self.sentences(name, curves[name], found)
        answer.data = {"measures": curves, "cost_law": law and {
            "point_steps_at_1m": law[0], "power_of_cell": law[1], "core_seconds_per_point_step": law[2]}}
        if law:
            answer.sentences.append(f"Point-steps grow as cell^{law[1]:.2f}: half the cell takes {2 ** -law[1]:.1f} "
                                    f"times as many, {1e9 * law[2]:.0f} ns of a core each.")
        answer.tables = [table, costs]
        answer.pictures = [Picture("convergence", "Each measure against the cell; the shaded band is where its limit "
                                   "of small cells lies in nine of ten cases; red: the reference.",
                                   lambda figure: pictures.convergence(figure, curves)),
                           Picture("cost", "Distance to the limit against cost.",
                                   lambda figure: pictures.cost(figure, curves))]
        return answer

    @staticmethod
    def cost_law(done):
        """(c, q, s): point-steps are c cell^q, s core-seconds each. By point-steps, because what a run costs before its
        first step hides the law of coarse cells; s is the least seen, for the same reason."""
        law = power_law([row.cell for row in done], [row.cost["point_steps"] for row in done])
        if law is None:
            return None
        return (*law, min(row.cost["stepping_seconds"] / row.cost["point_steps"] for row in done))

    def curve(self, name, done, found):
        return {"unit": next((row.unit(name) for row in done), ""), "cells": [row.cell for row in done],
                "values": [row.measure(name) for row in done],
                "core_seconds": [row.cost["core_seconds"] for row in done],
                "value": found.value, "uncertainty": found.uncertainty if found.known else None, "limit": found.limit,
                "order": found.order, "behaviour": found.behaviour, "how": found.how, "scatter": found.scatter,
                "reference": reference_of(self.study, done, name)}

    @staticmethod
    def sentences(name, curve, found):
        if not found.known:
            missing = [f"{1e3 * cell:.4g} mm" for cell, value in zip(curve["cells"], curve["values"]) if value is None]
            where = f" ({', '.join(missing)})" if missing else ""
            yield f"{name}: no error can be said: it {found.behaviour}{where}."
            return
        if found.behaviour in ("wavers", "is noisy", "changes more and more"):
            yield (f"{name} {found.behaviour} with the cell: it has no order, and its band is the spread that was "
                   f"seen. These "
                   "cells do not answer the question better than that.")
        if len(levels_of(np.array(curve["cells"]))) == 2:
            yield f"{name}: two cells show no order, and may agree by accident: a third would tell."
        if curve["reference"]:
            value, half, source = curve["reference"]
            said = validation(found, value, half or 0.0)
            scale, unit = scaled(curve["unit"])
            curve["validation"] = said
            yield (f"{name} is {scale * said['difference']:+.4g} {unit} "
                   f"({100 * said['difference'] / abs(value or 1):+.2f} %) off "
                   f"{scale * value:.5g} {unit} ({source}); the model's error lies between {scale * said['from']:+.3g} "
                   f"and "
                   f"{scale * said['to']:+.3g} {unit}" + ("" if half is not None
                                                          else " (if the test has no error of its own)") +
                   f": {said['words']}.")

    @staticmethod
    def price(name, done, found, target, law):
        """Of the coarsest cell that was run and is good enough; else foretold from the finest; else why not."""
        if not found.known or not found.value:
            return "-"
        allowed = target * abs(found.value)
        good = [row for row in done if found.uncertainty + abs(row.measure(name) - found.value) <= allowed]
        if good:
            row = max(good, key=lambda row: row.cell)
            return f"{text_of(row.cost['core_seconds'])} ({1e3 * row.cell:.3g} mm)"
        if found.falls_as is None or law is None:
            return "not by refinement"
        cell = min(row.cell for row in done) * (allowed / found.uncertainty) ** (1 / found.falls_as)
        return f"~{text_of(law[2] * law[0] * cell ** law[1])} ({1e3 * cell:.2g} mm)".replace("~more", "more")
