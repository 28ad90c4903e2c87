# SPDX-License-Identifier: GPL-3.0-or-later
"""Template of a report: Markdown whose blocks ```krater ... ``` say what of which study stands there.

    # Title                          ```krater                         (the words of a block: BLOCKS below)
    Words of the author.             table: refinement
                                     columns: [grid.cell, final_length]
                                     ```

A study is the file refinement.yaml beside the template. A block at the head, --- takes: 10 min, set: {...} ---, says how
long all of it takes and what is laid over every member of every study; define: {ratio: length / width} names expressions."""

import dataclasses
import os
import re

import yaml

from study_file import Block, InputError, Tree, flow, seconds, suggestion

FENCE, END, HEAD = "```krater", "```", "---"
CHOSEN = ("members",)
BLOCKS = {  # first key, which names the study or a list of them: other keys
    "table": ("columns", "across", "off", *CHOSEN),
    "answer": ("leave_out",),
    "demand": ("says", "value", "below", "above", "unit", *CHOSEN),
    "pieces": ("measure", "most", *CHOSEN),
    "sections": ("times", "field", "range", "box", "title", *CHOSEN),
    "outlines": ("time", "boxes", "title", *CHOSEN),
    "histories": ("measures", "lines", "range", "title", *CHOSEN),
    "scatter": ("x", "y", "times", "where", "colour", "range", "box", "lines", "title", *CHOSEN),
    "picture": ("plot", *CHOSEN),
}
REQUIRED = {"table": ("columns",), "demand": ("says", "value"), "pieces": ("measure",), "scatter": ("x", "y", "times"), "sections": ("times",),
            "outlines": ("time",), "histories": ("measures",)}


@dataclasses.dataclass
class Piece:
    """A block of a template, or with `kind` '' words of its author."""
    kind: str
    text: str = ""
    keys: Block = None
    studies: tuple = ()
    path: str = ""
    line: int = 0

    def fail(self, key, message):
        line = self.keys.lines.get(key, self.line)
        raise InputError(f"{self.path}:{line}: {self.kind}/{key}: {message}")

    def items(self, key):
        """A list; one value is a list of one; nothing is none."""
        value = self.keys.get(key, [])
        return value if isinstance(value, list) else [value]


class Template:
    def __init__(self, path):
        self.path, self.pieces = path, []
        try:
            with open(path, encoding="utf-8") as file:
                self.lines = file.read().split("\n")
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{path}: cannot be read: {error}") from None
        start = self.read_head()
        self.read_pieces(start)
        if not self.studies:
            raise InputError(f"{path}: no block {FENCE} ... {END} names a study, as `table: refinement` of the file "
                             "refinement.yaml beside it")

    @property
    def studies(self):
        """Names in the order in which they are met."""
        return list(dict.fromkeys(name for piece in self.pieces for name in piece.studies))

    def fail(self, line, message):
        raise InputError(f"{self.path}:{line}: {message}")

    def read_head(self):
        """The line after the head; `takes` [s or None] and `settings` (texts of --set) are read."""
        self.takes, self.settings, self.defined = None, [], {}
        if self.lines[0].strip() != HEAD:
            return 0
        end = self.find(HEAD, 1)
        head = self.yaml(1, end)
        for key in head:
            if key not in ("takes", "set", "define"):
                self.fail(head.lines[key], f"{key}: unknown key of the head ({suggestion(key, ('takes', 'set', 'define'))})")
        if "takes" in head:
            self.takes = seconds(head["takes"]) if isinstance(head["takes"], str) else None
            if not self.takes:
                self.fail(head.lines["takes"], f"takes: a time is expected, as 10 min, found {flow(head['takes'])}")
        if not isinstance(head.get("set", Block()), Block):
            self.fail(head.lines["set"], "set: a block of keys is expected: {time.energy_error: off}")
        self.defined = head.get("define", Block())
        if not isinstance(self.defined, Block):
            self.fail(head.lines["define"], "define: a block of expressions is expected: {ratio: length / width}")
        self.settings = [f"{path}={flow(value)}" for path, value in head.get("set", {}).items()]
        return end + 1

    def find(self, word, start):
        """Index of the line that ends what began before `start`."""
        for k in range(start, len(self.lines)):
            if self.lines[k].strip() == word:
                return k
        return self.fail(start, f"this block is not ended by {word}")

    def yaml(self, start, end):
        """Block of lines [start, end), its line numbers those of the template."""
        text = "\n" * start + "\n".join(self.lines[start:end])
        try:
            node = yaml.compose(text, Loader=yaml.SafeLoader)
        except yaml.YAMLError as error:
            mark = getattr(error, "problem_mark", None)
            self.fail(mark.line + 1 if mark else start + 1, getattr(error, "problem", error))
        if not isinstance(node, yaml.MappingNode):
            self.fail(start + 1, "a block of keys is expected (table: STUDY, columns: [...])")
        return Tree(self.path).of(node)

    def read_pieces(self, start):
        words = []
        k = start
        while k < len(self.lines):
            if self.lines[k].strip() == FENCE:
                self.pieces.append(Piece("", "\n".join(words)))
                end = self.find(END, k + 1)
                self.pieces.append(self.piece(k + 1, end))
                words, k = [], end + 1
                continue
            words.append(self.lines[k])
            k += 1
        self.pieces.append(Piece("", "\n".join(words)))

    def piece(self, start, end):
        keys = self.yaml(start, end)
        kind = next(iter(keys))
        if kind not in BLOCKS:
            self.fail(start + 1, f"unknown block '{kind}' ({suggestion(kind, list(BLOCKS))})")
        piece = Piece(kind, keys=keys, path=self.path, line=start + 1)
        for key in list(keys)[1:]:
            if key not in BLOCKS[kind]:
                piece.fail(key, f"unknown key ({suggestion(key, BLOCKS[kind])})")
        for key in REQUIRED.get(kind, ()):
            if key not in keys:
                piece.fail(kind, f"missing key '{key}'")
        piece.studies = tuple(self.study(piece, name) for name in piece.items(kind))
        return piece

    def study(self, piece, name):
        if not isinstance(name, str) or not re.fullmatch(r"[\w.-]+", name):
            piece.fail(piece.kind, f"the name of a study is expected, as refinement, found {flow(name)}")
        if not os.path.isfile(self.file_of(name)):
            piece.fail(piece.kind, f"no study {self.file_of(name)}")
        return str(name)

    def file_of(self, name):
        return os.path.join(os.path.dirname(self.path), name + ".yaml")
