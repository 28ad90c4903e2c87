# SPDX-License-Identifier: GPL-3.0-or-later
"""krater run SCENE --accuracy 2%: coarse, then finer cells until every measure is known so well.

Four times and twice the scene's cell, then on by what the values show: the band falls as cell^q (uncertainty.py), the
cost as power law of the cells that were run, so the cell that should reach the target and its price are said before it
is run. `--measures length,width` names those that must be known so well; the others get the band that they have then.
What the budget cannot pay is not begun: a rim thinner than the cells would take all of it and be known no better.
Each refinement is at most twofold: an order seen at coarse cells is not believed further. The finest run's
results are those of the folder, its summary.json says of every measure the uncertainty and how it was found; the other
cells lie in members/."""

import argparse
import math
import os
import shutil
import time

import numpy as np

from members import YEAR, member, read_json, text_of, write_json
from refinement import CELL, Convergence
from study_file import InputError, Study, load, seconds, suggestion
from uncertainty import estimate, levels_of

BUDGET = 20 * 60  # [s]
STARTS = (4.0, 2.0)  # of the scene's cell
SMALLEST_STEP = 1.25
SURE = 4  # cells, after which a price beyond the budget is believed
BLIND = 5  # cells, after which values that waver are not followed further


def options(words):
    parser = argparse.ArgumentParser(prog="krater run --accuracy")
    parser.add_argument("scene")
    parser.add_argument("accuracy")
    parser.add_argument("-j", type=int, default=os.cpu_count())
    parser.add_argument("-o", "--output")
    parser.add_argument("--budget")
    parser.add_argument("--measures")
    parser.add_argument("--set", action="append", default=[])
    # A share below 0 is a share, not an option: it is refused with the reason.
    return parser.parse_args([" " + word if word.startswith("-") and k == 1 else word for k, word in enumerate(words)])


def target_of(text):
    """2% or 0.02 -> 0.02."""
    try:
        value = float(text.rstrip("% ")) / (100 if text.rstrip().endswith("%") else 1)
    except ValueError:
        value = math.nan
    if not 0 < value < 1:
        raise InputError(f"--accuracy {text.strip()}: a share between 0 and 1 is expected, as 2%; no number of runs has no "
                         f"error")
    return value


class Request(Study):
    """What a study file would say: all measures of a scene, by its cell alone."""

    def __init__(self, scene, settings):
        if not os.path.isfile(scene):
            raise InputError(f"{scene}: no such file")
        self.path = self.scene = scene
        self.kind, self.keys = "accuracy", {}
        self.base = load(scene)
        self.title = str(self.base.get("title", os.path.splitext(os.path.basename(scene))[0]))
        self.said = dict(self.split(text) for text in settings)
        self.settings, self.truth, self.threads = dict(self.said), {}, 1
        self.measures = self.read_measures()


class Accuracy(Convergence):
    def __init__(self, study, target, named=None):
        self.study, self.target, self.engine, self.named = study, target, None, named
        self.cells, self.repeats = [], 1
        cell = study.settings.pop(CELL, None) or (study.base.get("grid") or {}).get("cell", "")
        self.own = study.quantity(cell, CELL)

    def member(self, number):
        return member({CELL: self.own.text(float(f"{number:.7g}"))})

    def accepts(self, one):
        """May this cell be run? One that leaves a body too thin, or a side off its node line, may not."""
        try:
            self.engine.check([one])
        except InputError:
            return False
        return True

    def next(self, rows):
        if not rows:
            starts = [one for factor in STARTS if self.accepts(one := self.member(factor * self.own.number))]
            return starts or [self.member(self.own.number)]
        if not rows[-1].done:
            return []
        done = [row for row in rows if row.done]
        finest = min(self.number(row) for row in done)
        levels = len(levels_of(np.array([row.cell for row in done])))
        if levels >= 3:
            unmet = {name: found for name, found in self.unmet(done).items() if found.known}
            wanted, dear = self.foretell(unmet, done, levels)
            if not unmet or (wanted is None and (dear or levels >= BLIND)):
                return []
            wanted = min(max(wanted or 0, finest / 2), finest / SMALLEST_STEP)
            one = self.member(wanted)
            if self.accepts(one):
                return [one]
        return [self.member(finest / 2)]

    def number(self, row):
        return float(row.member.values[CELL].split()[0])

    def bands(self, done):
        return {name: estimate([row.cell for row in done], [math.nan if row.measure(name) is None else row.measure(name)
                                                            for row in done]) for name in self.study.measures}

    @property
    def judged(self):
        """Those that were named, or all that have a value (command.py leaves out of the study what has none)."""
        return self.named or self.study.measures

    def unmet(self, done):
        bands = self.bands(done)
        found = {name: bands.get(name) or estimate([], []) for name in self.judged}
        return {name: one for name, one in found.items()
                if not one.known or one.uncertainty > self.target * abs(one.value)}

    def needed(self, found, finest):
        """The cell that should bring a measure to the target, in the unit of `finest`; None: no refinement is seen to
        help."""
        if not (found.falls_as and found.value):
            return None
        return finest * (self.target * abs(found.value) / found.uncertainty) ** (1 / found.falls_as)

    def foretell(self, unmet, done, levels):
        """(the cell, in the scene's unit, that should bring to the target all measures that refinement helps and that
        the budget can pay, or None; whether others are too dear for it)."""
        finest = min(self.number(row) for row in done)
        scale = min(row.cell for row in done) / finest
        cells = {name: cell for name, found in unmet.items() if (cell := self.needed(found, finest))}
        paid = {name: cell for name, cell in cells.items() if levels < SURE or self.can_pay(done, scale * cell)}
        if not paid:
            return None, bool(cells)
        least = min(paid.values())
        self.engine.say(f"krater run: {least:.4g} {self.own.unit} should bring {', '.join(paid)} to "
                        f"{100 * self.target:g} %")
        return least, len(paid) < len(cells)

    def can_pay(self, done, cell):
        """Does what is left of the budget pay for a cell [m] on all cores?"""
        law = self.cost_law(done)
        left = self.engine.deadline - time.monotonic()
        return law is None or law[2] * law[0] * cell ** law[1] <= left * self.engine.jobs

    def answer(self, rows):
        answer = super().answer(rows)
        done = [row for row in rows if row.done]
        unmet = self.unmet(done)
        law, finest = self.cost_law(done), min(row.cell for row in done)
        said = []
        for name, found in unmet.items():
            value = f"{100 * found.uncertainty / abs(found.value):.2g} %" if found.known and found.value else "nothing"
            line = f"{name} is not known to {100 * self.target:g} %: {value} can be had at {1e3 * finest:.4g} mm"
            cell = self.needed(found, finest) if found.known else None
            if cell and law:
                price = law[2] * law[0] * cell ** law[1]
                line += (f"; by what these cells show {1e3 * cell:.1g} mm would reach it, which is out of reach" if price > YEAR else
                         f"; {1e3 * cell:.3g} mm should reach it in about {text_of(price)} of core time")
            elif found.known:
                line += f"; it {found.behaviour} and no refinement is seen to help"
            said.append(line + ".")
        which = ", ".join(self.named) if self.named else "Every measure"
        said = said or [f"{which} is known to {100 * self.target:g} % at {1e3 * finest:.4g} mm."]
        answer.sentences = said + answer.sentences
        answer.data["target"], answer.data["met"], answer.data["judged"] = self.target, not unmet, list(self.judged)
        return answer


def named(study, text):
    """Names of --measures; None where it is not given."""
    if text is None:
        return None
    names = [name.strip() for name in text.split(",")]
    for name in names:
        if name not in study.measures:
            raise InputError(f"--measures {text}: the scene has no measure '{name}' ({suggestion(name, study.measures)})")
    return list(dict.fromkeys(names))


def prepare(words):
    """(study, question, folder, cores, budget); the question still lacks its engine."""
    given = options(words)
    target = target_of(given.accuracy)
    budget = BUDGET if given.budget is None else seconds(given.budget)
    if budget is None or budget <= 0:
        raise InputError(f"--budget {given.budget}: a time above 0 is expected, as 20min")
    study = Request(given.scene, given.set)
    folder = given.output or os.path.splitext(os.path.basename(given.scene))[0] + "_out"
    return study, Accuracy(study, target, named(study, given.measures)), folder, given.j, budget


def publish(folder, rows, answer):
    """The finest run's files become those of the folder, its summary with the uncertainties."""
    finest = min((row for row in rows if row.done), key=lambda row: row.cell)
    source = os.path.join(folder, "members", finest.member.name)
    for name in os.listdir(source):
        if name.startswith("."):
            continue
        target = os.path.join(folder, name)
        if os.path.isdir(target):
            shutil.rmtree(target)
        elif os.path.exists(target):
            os.remove(target)
        copy = shutil.copytree if os.path.isdir(os.path.join(source, name)) else shutil.copy2
        copy(os.path.join(source, name), target)
    summary = read_json(os.path.join(folder, "summary.json"))
    for name, curve in answer.data["measures"].items():
        if name in summary.get("measures", {}):
            summary["measures"][name]["uncertainty"] = curve["uncertainty"]
            summary["measures"][name]["uncertainty_from"] = curve["how"]
    summary["accuracy"] = {"target": answer.data["target"], "met": answer.data["met"],
                           "measures": answer.data["judged"], "cells": sorted(row.cell for row in rows if row.done)}
    write_json(os.path.join(folder, "summary.json"), summary)
