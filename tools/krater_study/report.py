# SPDX-License-Identifier: GPL-3.0-or-later
"""krater study REPORT.md: a page of several studies, made of a template (template.py). Runs what its studies still lack,
then writes README.md and pictures into the folder.

Members lie in FOLDER/runs_out, in a folder of their own for every program, study file and scene: a page never mixes
versions, and an old one is not told of a new scene."""

import datetime
import fnmatch
import hashlib
import os
import shutil
import time

import columns
import command
import expressions
import results
from answer import failed_sentences
from members import KRATER, LEAST, text_of
from report_pictures import Pictures
from study_file import InputError, Study, flow, suggestion
from template import Template


class Members:
    """What a study has found: rows, where their results lie, its answer."""

    def __init__(self, name, asked, answer):
        self.name, self.rows, self.folder, self.answer = name, asked.rows, asked.folder, answer


def digest(*paths):
    total = hashlib.sha256()
    for path in paths:
        with open(path, "rb") as file:
            total.update(file.read())
    return total.hexdigest()[:16]


class Report(Pictures):
    def __init__(self, template, folder):
        self.template, self.folder, self.studies, self.lines = template, folder, {}, []
        for name, text in template.defined.items():
            try:
                expressions.define(name, text)
            except InputError as error:
                template.fail(template.defined.lines[name], f"define: {name}: {error}")

    # ---- studies

    def study(self, name, settings):
        path = self.template.file_of(name)
        study = Study(path, [*self.template.settings, *settings])
        place = os.path.join(self.folder, "runs_out", f"{name}_{digest(KRATER, path, study.scene)}")
        return study, command.KINDS[study.kind](study), place

    def ask(self, name, given, budget):
        study, question, place = self.study(name, given.set)
        command.say(f"krater study: {name}")
        asked = command.ask(study, question, place, given.j, budget, not (given.list or given.collect))
        if given.list:
            command.print_list(asked)
            return asked.more
        answer, _ = command.conclude(asked)
        command.tell_left(asked.rows)
        self.studies[name] = Members(name, asked, answer)
        return asked.more

    # ---- members of a block

    def rows(self, piece):
        """[(study, row)] of a block, of its `members` where it names any."""
        every = [(self.studies[name], row) for name in piece.studies for row in self.studies[name].rows]
        patterns = piece.items("members")
        if not patterns:
            return every
        for pattern in patterns:
            if not any(matches(study, row, pattern) for study, row in every):
                piece.fail("members", f"no member is called {flow(pattern)} (there are: "
                           f"{', '.join(row.member.name for _, row in every)}; * stands for anything)")
        return [(study, row) for study, row in every if any(matches(study, row, one) for one in patterns)]

    def place(self, study, row):
        return os.path.join(study.folder, "members", row.member.name)

    def folders(self, piece):
        """{label: folder} of the members that are done."""
        pairs = [(study, row) for study, row in self.rows(piece) if row.done]
        labels = labels_of([row for _, row in pairs])
        if len(piece.studies) > 1:
            labels = [f"{study.name}, {label}" for label, (study, _) in zip(labels, pairs)]
        return {label: self.place(study, row) for label, (study, row) in zip(labels, pairs)}

    def folder_of(self, row):
        return next(self.place(study, row) for study in self.studies.values() if any(row is one for one in study.rows))

    # ---- blocks

    def table(self, piece):
        chosen = [row for _, row in self.rows(piece)]
        every = [row for name in piece.studies for row in self.studies[name].rows]
        in_order, places = [], [next(k for k, one in enumerate(every) if one is row) for row in chosen]
        keys, values = [], []  # (title, cells) of columns that name what was varied, and of the others
        for name in piece.items("columns"):
            titles, cells = self.mended(piece, "columns", columns.column, name, every, self.folder_of,
                                        piece.keys.get("off") in ("yes", "true"))
            path = next(iter(name.values())) if isinstance(name, dict) else name
            of = keys if any(path in row.member.values for row in every) else values
            of += [(title, [cells[place][k] for place in places]) for k, title in enumerate(titles)]
            in_order += of[-len(titles):]
        if "across" in piece.keys:
            if not any(piece.keys["across"] in row.member.values for row in chosen):
                piece.fail("across", f"none of these members varies '{piece.keys['across']}'")
            titles, lines = columns.across(str(piece.keys["across"]), chosen, keys, values)
        else:
            titles = [title for title, _ in in_order]
            lines = [[cells[k] for _, cells in in_order] for k in range(len(chosen))]
        self.marked(titles, lines)
        self.paragraphs(f"**{line}**" for line in failed_sentences(chosen))

    def marked(self, titles, lines):
        """A table of Markdown."""
        self.lines += ["| " + " | ".join(titles) + " |", "| " + " | ".join(["---"] + ["---:"] * (len(titles) - 1)) + " |"]
        self.lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines] + [""]

    def pieces(self, piece):
        """What a measure of kind fragments has found: the heaviest pieces of each member, and what is too small."""
        name, most = str(piece.keys["measure"]), int(self.number(piece, "most", piece.keys.get("most", "8")))
        pairs = [(study, row) for study, row in self.rows(piece) if row.done]
        for label, (_, row) in zip(labels_of([row for _, row in pairs]), pairs):
            found = row.summary.get("fragments", {}).get(name)
            if found is None:
                piece.fail("measure", f"no measure '{name}' of kind fragments "
                           f"({suggestion(name, list(row.summary.get('fragments', {})))})")
            self.paragraphs([f"{label}:"] if len(pairs) > 1 else [])
            self.marked(["piece of", "mass g", "points", "velocity m/s", "size mm"], [
                [one["body"], f"{1e3 * one['mass']:.3f}", str(one["points"]),
                 ", ".join(f"{axis} {v:.1f}" for axis, v in one["velocity"].items()),
                 " x ".join(f"{1e3 * size:.1f}" for size in one["size"].values())] for one in found["pieces"][:most]])
            left, dust = len(found["pieces"]) - most, found["dust"]
            self.paragraphs([(f"{left} more pieces. " if left > 0 else "") +
                             f"Pieces of fewer than {found['least_points']} points are not resolved: {dust['pieces']} of "
                             f"them, {1e3 * dust['mass']:.3f} g together."])

    @staticmethod
    def mended(piece, key, call, *words):
        """An error of a column told at its block."""
        try:
            return call(*words)
        except InputError as error:
            return piece.fail(key, str(error))
        except expressions.Missing as error:
            return piece.fail(key, f"'{error}' has no value: no point is there, or none of them is meant")

    def answer(self, piece):
        """Sentences, tables and pictures of the study itself."""
        leave_out = piece.items("leave_out")
        for name in piece.studies:
            answer = self.studies[name].answer
            if answer is None:
                self.paragraphs([f"**{name}: no member is done.**"])
                continue
            said = failed_sentences(self.studies[name].rows) if "sentences" in leave_out else answer.sentences
            self.lines += [*(f"- {line}" for line in said), ""]
            for table in answer.tables if "tables" not in leave_out else ():
                self.paragraphs([table.caption + ":"])
                self.lines += ["| " + " | ".join(map(str, line)) + " |"
                               for line in (table.titles, ["---"] * len(table.titles), *table.rows)]
                self.lines.append("")
            for picture in answer.pictures if "pictures" not in leave_out else ():
                source = os.path.join(self.studies[name].folder, "pictures", picture.name + ".png")
                target = f"{name}_{picture.name}.png"
                shutil.copyfile(source, os.path.join(self.folder, target))
                self.paragraphs([f"![{picture.caption}]({target})", picture.caption])

    def demand(self, piece):
        """What was asked for beside the worst of what was found."""
        bounds = [key for key in ("below", "above") if key in piece.keys]
        if len(bounds) != 1:
            piece.fail("demand", "one of `below` and `above` is expected")
        every = [row for name in piece.studies for row in self.studies[name].rows]
        expression = self.mended(piece, "value", expressions.Expression, str(piece.keys["value"]), every, self.folder_of)
        found = [self.mended(piece, "value", expression.of, row) for _, row in self.rows(piece)]
        bound, unit = self.number(piece, bounds[0]), str(piece.keys.get("unit", ""))
        known = [value for value in found if value is not None]
        worst = max(known, default=0) if bounds[0] == "below" else min(known, default=0)
        met = worst < bound if bounds[0] == "below" else worst > bound
        told = f"{worst:.3g} {unit}".strip() + f", **{'met' if met else 'missed'}**" if known else "**not known**"
        self.paragraphs([f"Demanded: {piece.keys['says']}. Found: {told}."])

    # ---- the page

    def paragraphs(self, texts):
        for text in texts:
            self.lines += [text, ""]

    def write(self):
        for piece in self.template.pieces:
            if piece.kind:
                getattr(self, piece.kind)(piece)
            else:
                self.lines += [piece.text.strip("\n"), ""]
        text = "\n".join(line for line in self.lines).strip("\n")
        title, _, rest = text.partition("\n")
        made = (f"{datetime.date.today()}, {results.version()}, {os.cpu_count()} cores of "
                f"{results.machine()['processor']}, load average {os.getloadavg()[2]:.0f} "
                f"(core-seconds are user and system time). Made by `krater study "
                f"{os.path.basename(self.template.path)}`; do not edit.")
        path = os.path.join(self.folder, "README.md")
        with open(path + ".part", "w", encoding="utf-8") as file:
            file.write(squeezed(f"{title}\n\n{made}\n{rest}\n"))
        os.replace(path + ".part", path)
        return path


def matches(study, row, pattern):
    return any(fnmatch.fnmatchcase(name, str(pattern)) for name in (row.member.name, f"{study.name}/{row.member.name}"))


def labels_of(rows):
    """What a picture calls members: the values that tell them apart."""
    paths = list(dict.fromkeys(path for row in rows for path in row.member.values))
    apart = [path for path in paths if len({row.member.values.get(path) for row in rows}) > 1]
    return [", ".join(row.member.values[path] for path in apart or paths if path in row.member.values) or
            row.member.name for row in rows]


def squeezed(text):
    """One empty line, where blocks leave several."""
    while "\n\n\n" in text:
        text = text.replace("\n\n\n", "\n\n")
    return text


def remaining(budget, start, more):
    """Of a budget [s]; less than a look at the next study takes is none, and none goes on where one study had too little."""
    left = budget - (time.monotonic() - start)
    return 0 if more or left < LEAST else left


def run(given):
    """Exit code of `krater study REPORT.md`."""
    template = Template(given.file)
    budget = command.budget_of(given)
    begin = start = time.monotonic()
    folder = given.output or os.path.splitext(os.path.basename(given.file))[0] + "_report"
    report = Report(template, folder)
    for name in template.studies:  # errors of input now, not after hours
        report.study(name, given.set)
    if template.takes and not (given.list or given.collect):
        command.say(f"krater study: about {text_of(template.takes)} on two quiet cores, as its author says")
    more = False
    try:
        for name in template.studies:
            more = report.ask(name, given, budget) or more
            budget = budget and remaining(budget, start, more)
            start = time.monotonic()
    except KeyboardInterrupt:
        command.say(f"krater study: interrupted; what is done lies in {folder}/runs_out; the same command goes on")
        return command.STOPPED
    if given.list:
        return command.DONE
    command.say(f"krater study: {report.write()} ({text_of(time.monotonic() - begin)})")
    if any(study.answer is None for study in report.studies.values()):
        return command.STOPPED if more else command.NOTHING
    return command.STOPPED if more else command.DONE
