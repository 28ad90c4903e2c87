# SPDX-License-Identifier: GPL-3.0-or-later
"""Blocks of a report that draw: sections, outlines, histories, scatter, picture; and how their keys are read."""

import os
import shlex
import shutil
import subprocess
import sys

import numpy as np

import columns
import expressions
from study_file import flow

STANDARD = ("final_shape", "shapes", "energy", "dt", "measures")  # pictures that tools/plot_run draws unasked


class Pictures:
    """Of a Report, which knows members and writes words."""

    pictures = 0  # so many were drawn

    def sections(self, piece):
        import run_pictures
        from plot_run_shapes import Colouring
        span = piece.items("range") or None

        def scale(run):
            return Colouring(run, run.numbers, str(piece.keys["field"]) if "field" in piece.keys else None, span)
        self.draw(piece, run_pictures.sections, [self.time(piece, "times", text) for text in piece.items("times")], scale,
                  self.box(piece, "box", piece.items("box")))

    def outlines(self, piece):
        import run_pictures
        boxes = [self.box(piece, "boxes", box) for box in piece.items("boxes")]
        self.draw(piece, run_pictures.outlines, self.time(piece, "time", piece.keys["time"]), [None, *boxes])

    def histories(self, piece):
        import run_pictures
        items = piece.items("measures")
        names = [item for item in items if not isinstance(item, dict)]
        given = {title: text for item in items if isinstance(item, dict) for title, text in item.items()}
        units = {row.unit(name) for _, row in self.rows(piece) for name in names if row.done}
        if len(units - {""}) > 1:
            piece.fail("measures", f"one picture shows one unit, these have {', '.join(sorted(units))}")
        unit = next(iter(units - {""}), "")
        largest = max((abs(row.measure(name) or 0) for _, row in self.rows(piece) for name in names), default=0)
        scale, shown = columns.scale_of(largest, unit)
        lines = [(self.number(piece, "lines", value), words) for line in piece.items("lines")
                 for words, value in line.items()]
        words = {name: name.replace("_", " ") for name in names} | {title: title for title in given}
        title = next(iter(words.values())) if len(words) == 1 else ""
        if len(words) == 1:
            words = dict.fromkeys(words, "")

        def values(folder, name):
            history = expressions.History(folder)
            text = given.get(name)
            return history.name(name) / scale if text is None else history.values(expressions.parse(text), text)

        def drawn(rows, title):
            return run_pictures.histories(rows, words, axis, 1.0, lines, title, values, self.numbers(piece, "range", 2))
        axis = f"{title} [{shown}]" if shown and names else title
        self.mended(piece, "measures", self.draw, piece, drawn)

    def scatter(self, piece):
        """Points of each member: one expression over another, coloured by a third."""
        import run_pictures
        axes = {key: self.labelled(piece.keys[key]) for key in ("x", "y", "colour") if key in piece.keys}
        where, times = piece.keys.get("where"), [self.time(piece, "times", text) for text in piece.items("times")]
        lines = [(self.number(piece, "lines", value), words) for line in piece.items("lines")
                 for words, value in line.items()]

        def values(folder, time):
            points = expressions.points_of(folder, time)
            kept = slice(None) if where is None else points.values(expressions.parse(where), str(where))
            shown.append(np.sum(np.ones(len(points.name("x")))[kept]))
            return points.time, {key: points.values(expressions.parse(text), text)[kept] for key, (_, text) in axes.items()}

        def drawn(rows, title):
            figure = run_pictures.scatter(rows, times, values, {key: label for key, (label, _) in axes.items()},
                                          self.numbers(piece, "range", 2), self.numbers(piece, "box", 4), lines, title)
            if not any(shown):
                raise expressions.Missing(where)
            return figure
        shown = []  # points of each member and time
        self.mended(piece, "scatter", self.draw, piece, drawn)

    @staticmethod
    def labelled(item):
        """(label, expression) of `{label: expression}` or of an expression alone."""
        return next(iter(item.items())) if isinstance(item, dict) else (str(item), str(item))

    def numbers(self, piece, key, count):
        """So many numbers, or None where the key is not there."""
        if key not in piece.keys:
            return None
        found = [self.number(piece, key, item) for item in piece.items(key)]
        return found if len(found) == count else piece.fail(key, f"{count} numbers are expected")

    def picture(self, piece):
        """`tools/plot_run` of a member: one of its standard pictures by name, or what its options ask for."""
        words = shlex.split(str(piece.keys.get("plot", STANDARD[0])))
        for name, folder in self.folders(piece).items():
            target = self.target(piece)
            path = os.path.join(self.folder, target)
            standard = len(words) == 1 and words[0] in STANDARD
            done = subprocess.run([sys.executable, os.path.join(expressions.TOOLS, "plot_run"), folder,
                                   *(() if standard else (*words, "-o", path))], capture_output=True, text=True, check=False)
            if done.returncode:
                piece.fail("plot", done.stderr.strip())
            if standard:
                shutil.copyfile(os.path.join(folder, "pictures", words[0] + ".png"), path)
            self.paragraphs([f"![{name}]({target})"])

    def draw(self, piece, picture, *words):
        rows = self.folders(piece)
        if rows:
            target = self.target(piece)
            title = str(piece.keys.get("title", ""))
            picture(rows, *words, title=title).savefig(os.path.join(self.folder, target), dpi=110)
            self.paragraphs([f"![{title or piece.kind}]({target})"])

    # ---- values of a template

    def target(self, piece):
        self.pictures += 1
        return f"{piece.studies[0]}_{piece.kind}_{self.pictures}.png"

    @staticmethod
    def number(piece, key, text=None):
        try:
            return float(piece.keys[key] if text is None else text)
        except (TypeError, ValueError):
            return piece.fail(key, f"a number is expected, found {flow(text or piece.keys[key])}")

    @staticmethod
    def time(piece, key, text):
        try:
            return expressions.quantity(text, "s")
        except ValueError as error:
            return piece.fail(key, str(error))

    @staticmethod
    def box(piece, key, texts):
        """[x, x, z, z] in mm, or None."""
        if not texts:
            return None
        try:
            box = [1e3 * expressions.quantity(text, "m") for text in texts]
        except ValueError as error:
            piece.fail(key, str(error))
        if len(box) != 4 or not (box[0] < box[1] and box[2] < box[3]):
            piece.fail(key, "a box is [least x, largest x, least z, largest z]")
        return box
