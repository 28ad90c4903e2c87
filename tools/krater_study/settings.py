# SPDX-License-Identifier: GPL-3.0-or-later
"""pareto, ablation, sweep: tables of settings, effects, inputs."""

import itertools
import re

import numpy as np

import pictures
from answer import Answer, Picture, Table, failed_sentences, number, reference_of, scaled, short_names
from members import Member, member, text_of
from study_file import Block, flow

MOST = 10000  # members of a grid
CELL = "grid.cell"
TARGETS = (5, 2, 1, 0.5)  # % of error that a price is told of


def axes_of(study, key="vary", crossed=True):
    """{path: [texts]}: every value as it was written. `crossed`: each with each; else side by side."""
    axes = {}
    for path, values in study.block(key, required=True).items():
        if not isinstance(values, list) or not values:
            study.fail(f"{key}/{path}", "a list of values is expected")
        axes[path] = [flow(value) for value in values]
        if crossed and len(set(axes[path])) < len(values):
            study.fail(f"{key}/{path}", "a value is there twice; take one away")
    study.check_paths(key, axes)
    lengths = [len(values) for values in axes.values()]
    count = int(np.prod(lengths, dtype=float)) if crossed else max(lengths)
    if count > MOST:
        study.fail(key, f"{count} members; at most {MOST} in one study: take values away, or use design: "
                   f"latin_hypercube")
    return axes


def cases_of(study):
    """Members of `vary: {as it is: {}, a quarter: {frame: 3d, grid.boundary: ...}}`."""
    members = []
    for name, changes in study.block("vary", required=True).items():
        if not isinstance(changes, Block) and flow(changes) not in ("", "{}"):
            study.fail(f"vary/{name}", "what this case changes is expected: {grid.cell: 0.2 mm, ...}, or {}")
        texts = {path: flow(value) for path, value in changes.items()} if isinstance(changes, Block) else {}
        study.check_paths(f"vary/{name}", texts)
        members.append(Member(re.sub(r"[^\w.+-]+", "_", name), [f"{path}={text}" for path, text in texts.items()],
                              {"case": str(name)}))
        if members[-1].name in [other.name for other in members[:-1]]:
            study.fail(f"vary/{name}", f"another case would have the same folder '{members[-1].name}'; call it otherwise")
    return members


def product(axes):
    return [member(dict(zip(axes, values))) for values in itertools.product(*axes.values())]


def numbers(texts):
    """Leading numbers of the texts; where one has none, their places in the list of different texts."""
    try:
        return [float(text.split()[0]) for text in texts]
    except (ValueError, IndexError):
        order = list(dict.fromkeys(texts))
        return [float(order.index(text)) for text in texts]


class Pareto:
    """Error against cost over all axes. The truth is said, or the scene's reference, or else the dearest member's
    value, which then cannot be judged itself."""

    def __init__(self, study):
        self.study = study
        self.axes = axes_of(study)
        if all(len(values) < 2 for values in self.axes.values()):
            study.fail("vary", "one setting is no choice: give two values or more of some path")

    def next(self, rows):
        return [] if rows else product(self.axes)

    def answer(self, rows):
        answer = Answer(failed_sentences(rows))
        done = [row for row in rows if row.done]
        if not done:
            return answer
        dearest = max(done, key=lambda row: row.cost["core_seconds"])
        clouds, wins = {}, {row.member.name: [] for row in done}
        for name in self.study.measures:
            told = self.study.truth.get(name) and reference_of(self.study, done, name)
            truth = told[0] if told else dearest.measure(name)
            judged = [row for row in done if row.measure(name) is not None and (told or row is not dearest)]
            if not truth or not judged:
                answer.sentences.append(f"{name}: nothing to judge it by (no value, or a truth of 0).")
                continue
            error = [100 * abs(row.measure(name) / truth - 1) for row in judged]
            cost = [row.cost["core_seconds"] for row in judged]
            known = 100 * told[1] / abs(truth) if told and told[1] else 0.0  # nearer than this is no nearer
            front = front_of(cost, [max(e, known) for e in error])
            clouds[name] = {"cost": cost, "error": error, "labels": [row.member.name for row in judged], "front": front,
                            "known": known,
                            "truth": truth, "of": told[2] if told else f"member {dearest.member.name}, the dearest"}
            clouds[name]["prices"] = {f"{target:g}": cheapest(judged, cost, error, target) for target in TARGETS}
            for i in front:
                wins[judged[i].member.name].append(name)
            answer.sentences.append(f"{name}: error against {scaled_text(truth, done[0].unit(name))} "
                                    f"({clouds[name]['of']}); "
                                    f"{len(front)} of {len(judged)} settings are worth their time.")
        answer.tables = [Table("All members, the cheapest first",
                               ["member", "core-seconds", *(f"{name}, error %" for name in clouds), "best for"],
                               [self.line(row, clouds, wins)
                                for row in sorted(done, key=lambda r: r.cost["core_seconds"])]),
                          Table("What an error costs: core time of the cheapest member that is as near, with all finer "
                                "cells of its settings", ["measure", *(f"{target:g} %" for target in TARGETS)],
                                [[name, *map(price, cloud["prices"].values())] for name, cloud in clouds.items()])]
        never = [name for name, won in wins.items() if not won and name != dearest.member.name]
        if never and clouds:
            answer.sentences.append("Dominated for every measure (another member is both cheaper and nearer): " +
                                    ", ".join(never) + ".")
        answer.data = {"measures": clouds, "dominated": never}
        answer.pictures = [Picture("front", "Error against cost; the line joins the settings that nothing beats. "
                                   "Shaded: nearer than the truth itself is known, which counts as no nearer.",
                                   lambda figure: pictures.front(figure, clouds))] if clouds else []
        return answer

    @staticmethod
    def line(row, clouds, wins):
        errors = [dict(zip(c["labels"], c["error"])).get(row.member.name) for c in clouds.values()]
        return [row.member.name, number(row.cost["core_seconds"], 3), *(number(e, 3) for e in errors),
                ", ".join(wins[row.member.name])]


def cheapest(rows, cost, error, target):
    """(core-seconds, member) of the cheapest that is as near, and stays so with every finer cell: a coarse cell that hits
    by luck is no price. None: no member is."""
    rest = [{path: text for path, text in row.member.values.items() if path != CELL} for row in rows]
    steady = [(cost[i], row.member.name) for i, row in enumerate(rows)
              if all(error[j] <= target for j, finer in enumerate(rows)
                     if rest[j] == rest[i] and finer.cell <= row.cell)]
    return min(steady) if steady else None


def price(found):
    return f"{text_of(found[0])}: {found[1]}" if found else "-"


def front_of(cost, error):
    """Indices that no other beats in both."""
    return [i for i in range(len(cost))
            if not any((cost[j] <= cost[i] and error[j] < error[i]) or (cost[j] < cost[i] and error[j] <= error[i])
                       for j in range(len(cost)))]


def scaled_text(value, unit, digits=5):
    scale, unit = scaled(unit)
    return f"{scale * value:.{digits}g} {unit}".strip()


class Ablation:
    """The scene as it is, and once without each effect: `effects: {heating: {materials.copper.heating: none}}`."""

    KEEP = 0.005  # an effect that moves every measure by less could go

    def __init__(self, study):
        self.study, self.effects = study, {}
        for name, changes in study.block("effects", required=True).items():
            if not isinstance(changes, Block) or not changes:
                study.fail(f"effects/{name}", "what takes the effect away is expected: {materials.copper.heating: "
                           "none}")
            self.effects[name] = {path: flow(value) for path, value in changes.items()}
            study.check_paths(f"effects/{name}", self.effects[name])

    def next(self, rows):
        return [] if rows else [Member("as_it_is", [], {"without": "-"})] + [
            Member(f"without_{name}", [f"{path}={text}" for path, text in changes.items()], {"without": name})
            for name, changes in self.effects.items()]

    def answer(self, rows):
        answer = Answer(failed_sentences(rows))
        base, others = rows[0], rows[1:]
        if not base.done:
            answer.sentences.append("Without the scene as it is there is nothing to compare with.")
            return answer
        changes = {name: {} for name in self.study.measures if base.measure(name)}
        verdicts = {}
        table = Table("Change without each effect, in %", ["without", *changes, "core-seconds", "time saved", "advice"],
                      [["-", *(scaled_text(base.measure(name), base.unit(name)) for name in changes),
                        number(base.cost["core_seconds"], 3), "", ""]])
        for row in others:
            effect = row.member.values["without"]
            if not row.done:
                table.rows.append([effect, *("-" for _ in changes), "-", "-", f"{row.status}: keep"])
                continue
            found = {name: relative(row.measure(name), base.measure(name)) for name in changes}
            for name in changes:
                changes[name][effect] = found[name]
            most = max((abs(v) for v in found.values() if v is not None), default=0)
            gone = [name for name, v in found.items() if v is None]
            saved = 1 - row.cost["core_seconds"] / max(base.cost["core_seconds"], 1e-9)
            keep = most > 100 * self.KEEP or bool(gone)
            verdicts[effect] = "keep" if keep else "could go"
            table.rows.append([effect, *("-" if v is None else f"{v:+.3g}" for v in found.values()),
                               number(row.cost["core_seconds"], 3), f"{100 * saved:+.0f} %", "keep" if keep
                               else "could go"])
            answer.sentences.append(
                f"{effect}: {'keep' if keep else 'could go'}: without it the measures change by at most {most:.2g} %"
                f"{' and ' + ', '.join(gone) + ' has no value' if gone else ''}, and the run takes {-100 * saved:+.0f} "
                f"% of time.")
        answer.sentences.append("`could go`: less than 0.5 % of every measure of this study at this cell; another "
                                "question of "
                                "the same scene may need it. Times are of single runs on this machine: differences of "
                                "some "
                                "per cent are noise.")
        answer.tables, answer.data = [table], {"changes_percent": changes, "effects": self.effects,
                                               "verdicts": verdicts}
        answer.pictures = [Picture("effects", "What each effect does to each measure.",
                                   lambda figure: pictures.bars(figure, changes))]
        return answer


def relative(value, base):
    return None if value is None else 100 * (value - base) / abs(base)


class Sweep:
    """Inputs and their consequences: design grid, list (values side by side), cases (each with a name and settings of its
    own), latin_hypercube (ranges)."""

    def __init__(self, study):
        self.study = study
        self.design = study.word("design", ["grid", "list", "cases", "latin_hypercube"]) if "design" in study.keys else "grid"
        if self.design == "latin_hypercube":
            self.ranges = {path: study.between(value, f"vary/{path}")
                           for path, value in study.block("vary", required=True).items()}
            study.check_paths("vary", self.ranges)
            self.members = self.hypercube(study.count("members", 10 * len(self.ranges), MOST),
                                          study.count("seed", 1, 2**31))
            return
        for key in ("members", "seed"):
            if key in study.keys:
                study.fail(key, "only design: latin_hypercube draws members")
        if self.design == "cases":
            self.members = cases_of(study)
            return
        axes = axes_of(study, crossed=self.design == "grid")
        lengths = {len(values) for values in axes.values()}
        if self.design == "list" and len(lengths) > 1:
            study.fail("vary", "of a list, all paths have as many values: they go side by side")
        lines = list(zip(*axes.values()))
        if self.design == "list" and len(set(lines)) < len(lines):
            study.fail("vary", "a member is there twice: every path has the same value in both; take one away")
        self.members = product(axes) if self.design == "grid" else [
            member(dict(zip(axes, values))) for values in zip(*axes.values())]

    def hypercube(self, count, seed):
        from scipy.stats import qmc  # here and below, not above: scipy.stats takes longer to load than most studies ask
        unit = qmc.LatinHypercube(d=len(self.ranges), seed=seed).random(count)
        return [Member(f"m{k:04d}", [f"{path}={text}" for path, text in values.items()], values) for k,
                values in enumerate(
            {path: low.text(float(f"{low.number + u * (high.number - low.number):.6g}"))
             for u, (path, (low, high)) in zip(line, self.ranges.items())} for line in unit)]

    def next(self, rows):
        return [] if rows else self.members

    def answer(self, rows):
        answer = Answer(failed_sentences(rows))
        done = [row for row in rows if row.done]
        if not done:
            return answer
        paths = list(done[0].member.values)
        short = short_names(paths)
        answer.tables = [Table("All members", ["member", *short.values(), *self.study.measures, "core-seconds"],
                               [[row.member.name, *row.member.values.values(),
                                 *("-" if row.measure(name) is None else scaled_text(row.measure(name), row.unit(name))
                                   for name in self.study.measures), number(row.cost["core_seconds"], 3)]
                                for row in done])]
        if self.design == "cases":  # what differs has no order: the table says all
            return answer
        inputs = {path: (numbers([row.member.values[path] for row in done]), unit_of(done[0].member.values[path]))
                  for path in paths}
        outputs = {name: ([np.nan if row.measure(name) is None else row.measure(name) for row in done],
                          done[0].unit(name))
                   for name in self.study.measures}
        answer.tables.append(self.ranks(inputs, outputs))
        if self.design == "grid":
            answer.tables.append(self.main_effects(done, paths))
        answer.data = {"spread": {}}
        for name, (values, unit) in outputs.items():
            good = [v for v in values if np.isfinite(v)]
            if len(good) > 1:
                answer.data["spread"][name] = float(np.std(good, ddof=1))
                answer.sentences.append(f"{name}: mean {scaled_text(np.mean(good), unit)}, standard deviation "
                                        f"{scaled_text(np.std(good, ddof=1), unit, 3)} over {len(good)} members.")
        answer.pictures = [Picture("sweep", "Every measure against every input.",
                                   lambda figure: pictures.scatter(figure, inputs, outputs))]
        return answer

    @staticmethod
    def ranks(inputs, outputs):
        from scipy.stats import spearmanr
        table = Table("Rank correlation of measure and input (Spearman; in brackets the chance to see as much from "
                      "none)",
                      ["measure", *short_names(list(inputs)).values()], [])
        for name, (values, _) in outputs.items():
            cells, y = [], np.asarray(values, float)
            for x, _ in inputs.values():
                good = np.isfinite(y)
                if good.sum() < 3 or np.ptp(np.asarray(x)[good]) == 0 or np.ptp(y[good]) == 0:
                    cells.append("-")
                    continue
                rank, chance = spearmanr(np.asarray(x)[good], y[good])
                cells.append(f"{rank:+.2f} ({chance:.2g})")
            table.rows.append([name, *cells])
        return table

    def main_effects(self, done, paths):
        """Mean at each value less the mean of all, in % of it."""
        table = Table("Main effects: mean at a value against the mean of all, in %",
                      ["input", "value", *self.study.measures], [])
        for path in paths:
            for text in dict.fromkeys(row.member.values[path] for row in done):
                cells = []
                for name in self.study.measures:
                    every = [row.measure(name) for row in done if row.measure(name) is not None]
                    here = [row.measure(name) for row in done if row.measure(name) is not None and
                            row.member.values[path] == text]
                    mean = np.mean(every) if every else 0
                    cells.append(f"{100 * (np.mean(here) - mean) / abs(mean):+.3g}" if here and mean else "-")
                table.rows.append([short_names(paths)[path], text, *cells])
        return table


def unit_of(text):
    parts = text.split(None, 1)
    return parts[1] if len(parts) > 1 else ""
