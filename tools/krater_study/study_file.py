# SPDX-License-Identifier: GPL-3.0-or-later
"""A study file, read with its lines. Scenes are krater's to read: values of `set` and `vary` stay the text they are and
go to `krater run --set`; of the scene only the names of its blocks are looked at."""

import dataclasses
import difflib
import os
import re

import yaml

COMMON = ("study", "title", "scene", "set", "measures", "truth", "budget", "threads")
KEYS = {
    "convergence": ("vary", "repeats"),
    "pareto": ("vary",),
    "ablation": ("effects",),
    "sweep": ("vary", "design", "members", "seed"),
    "ballistic_limit": ("outcome", "speed", "members", "cells"),
    "calibrate": ("vary", "members"),
}
REQUIRED = {"convergence": (), "pareto": ("vary",), "ablation": ("effects",), "sweep": ("vary",),
            "ballistic_limit": ("outcome", "speed"), "calibrate": ("vary", "truth")}
NAMED = ("bodies", "materials", "measures", "references", "gauges", "loads", "outcomes")  # blocks of free names
SECONDS = {"": 1, "s": 1, "min": 60, "h": 3600, "d": 86400, "ms": 1e-3}
QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$")


class InputError(Exception):
    """What a user can mend: file, line, key, remedy."""


class Text(str):
    """A scalar as it was written, and its line."""
    line, quoted = 0, False


class Block(dict):
    """A map, the lines of its keys."""
    def __init__(self):
        super().__init__()
        self.lines = {}


class Items(list):
    line = 0


@dataclasses.dataclass
class Quantity:
    number: float
    unit: str

    def text(self, number=None):
        value = self.number if number is None else number
        return f"{value:.9g} {self.unit}".strip()


class Tree:
    """Turns nodes of YAML into Text, Items and Block; bounded as krater's own reader is, for anchors unfold."""
    MOST_NODES, DEEPEST = 200_000, 40

    def __init__(self, path):
        self.path, self.nodes = path, 0

    def fail(self, node, message):
        raise InputError(f"{self.path}:{node.start_mark.line + 1}: {message}")

    def of(self, node, depth=0):
        self.nodes += 1
        if self.nodes > self.MOST_NODES or depth > self.DEEPEST:
            self.fail(node, "too large or too deep (does an anchor contain itself?)")
        if isinstance(node, yaml.ScalarNode):
            text = Text(node.value)
            text.line, text.quoted = node.start_mark.line + 1, node.style in ("'", '"')
            return text
        if isinstance(node, yaml.SequenceNode):
            items = Items(self.of(item, depth + 1) for item in node.value)
            items.line = node.start_mark.line + 1
            return items
        block = Block()
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                self.fail(key, "a key is expected to be a word")
            if key.value in block:
                self.fail(key, f"{key.value}: the key is there twice; take one away")
            block[key.value] = self.of(value, depth + 1)
            block.lines[key.value] = key.start_mark.line + 1
        return block


def flow(value):
    """A value as one line of YAML, for --set."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(flow(item) for item in value) + "]"
    if not getattr(value, "quoted", False):
        return str(value)
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'


def load(path):
    try:
        with open(path, encoding="utf-8") as file:
            node = yaml.compose(file, Loader=yaml.SafeLoader)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: is no text (UTF-8 expected)") from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        raise InputError(f"{path}{f':{mark.line + 1}' if mark else ''}: {getattr(error, 'problem', error)}") from None
    if not isinstance(node, yaml.MappingNode):
        raise InputError(f"{path}: a block of keys is expected (study: convergence, scene: FILE, ...)")
    return Tree(path).of(node)


def suggestion(word, known):
    near = difflib.get_close_matches(word, known, 1)
    return (f"did you mean {near[0]}? " if near else "") + "known: " + (", ".join(known) or "none")


def seconds(text):
    """20 min, 20min, 90 (s) -> seconds; None where it is no time."""
    found = QUANTITY.match(text)
    if not found or found[2] not in SECONDS:
        return None
    return float(found[1]) * SECONDS[found[2]]


class Study:
    """A study file: its keys checked, its scene found. Kinds read their own keys by the methods below."""

    def __init__(self, path, settings=()):
        """`settings`: texts of --set, laid over the file's."""
        self.path = path
        self.keys = load(path)
        self.kind = self.word("study", list(KEYS))
        self.check_keys()
        self.scene = self.find_scene()
        self.base = load(self.scene)
        self.title = str(self.keys.get("title", os.path.splitext(os.path.basename(path))[0]))
        self.settings = {key: flow(value) for key, value in self.block("set").items()}
        self.said = dict(self.split(text) for text in settings)
        self.settings.update(self.said)
        self.check_paths("set", [path for path in self.settings if path not in self.said])
        self.check_varied()
        self.budget = self.time("budget")
        self.threads = self.count("threads", 1, 4096)
        self.measures = self.read_measures()
        self.truth = self.read_truth()

    @staticmethod
    def split(text):
        path, equals, value = text.partition("=")
        if not path or not equals:
            raise InputError(f"--set {text}: expected path=value, for example --set \"grid.cell=0.2 mm\"")
        return path, value

    # ---- errors and values

    def fail(self, key, message, line=None):
        line = line or self.line(key)
        raise InputError(f"{self.path}:{line}: {key}: {message}" if line else f"{self.path}: {key}: {message}")

    def line(self, key):
        block = self.keys
        line = 0
        for step in key.split("/"):
            if not isinstance(block, Block) or step not in block:
                break
            line, block = block.lines[step], block[step]
        return line

    def word(self, key, known):
        value = self.keys.get(key)
        if not isinstance(value, str):
            self.fail(key, f"missing or no word; one of {', '.join(known)}")
        if value not in known:
            self.fail(key, f"unknown '{value}' ({suggestion(value, known)})")
        return str(value)

    def block(self, key, required=False):
        value = self.keys.get(key)
        if value is None and not required:
            return Block()
        if not isinstance(value, Block) or not value:
            self.fail(key, "a block of keys is expected")
        return value

    def count(self, key, default, most):
        value = self.keys.get(key)
        return default if value is None else self.whole(value, key, most)

    def whole(self, value, key, most):
        if not isinstance(value, str) or not value.isdecimal() or len(value) > 9 or not 1 <= int(value) <= most:
            self.fail(key, f"a whole number from 1 to {most} is expected, found {flow(value)}")
        return int(value)

    def time(self, key):
        value = self.keys.get(key)
        if value is None:
            return None
        found = seconds(value) if isinstance(value, str) else None
        if found is None or found <= 0:
            self.fail(key, f"a time above 0 is expected, as 20 min, found {flow(value)}")
        return found

    def quantity(self, value, key):
        found = QUANTITY.match(value) if isinstance(value, str) else None
        if not found:
            self.fail(key, f"a number with its unit is expected, found {flow(value)}", getattr(value, "line", None))
        return Quantity(float(found[1]), found[2])

    def between(self, value, key):
        """[low, high] of one unit -> two Quantities."""
        if not isinstance(value, list) or len(value) != 2:
            self.fail(key, "two values are expected: [low, high]")
        low, high = (self.quantity(item, key) for item in value)
        if low.unit != high.unit or not low.number < high.number:
            self.fail(key, f"[low, high] in one unit are expected, found {flow(value)}")
        return low, high

    # ---- the file

    def check_keys(self):
        known = COMMON + KEYS[self.kind]
        for key in self.keys:
            if key not in known:
                self.fail(key, f"unknown key of a {self.kind} study ({suggestion(key, known)})")
        for key in ("scene", *REQUIRED[self.kind]):
            if key not in self.keys:
                raise InputError(f"{self.path}: missing key '{key}' of a {self.kind} study (inputs/studies/ has "
                                 f"examples)")

    def find_scene(self):
        scene = self.keys["scene"]
        path = os.path.join(os.path.dirname(self.path), scene) if isinstance(scene, str) else ""
        if not os.path.isfile(path):
            self.fail("scene", f"no such file: '{path or flow(scene)}' (relative to the study's folder)")
        return os.path.normpath(path)

    def check_paths(self, key, paths):
        """Names that the scene does not have; other keys are krater's to judge."""
        for path in paths:
            steps = path.split(".")
            names = self.names(steps[0])
            if steps[0] in NAMED and len(steps) > 2 and steps[1] not in names:
                self.fail(f"{key}/{path}", f"the scene {self.scene} has no {steps[0]}.{steps[1]} "
                          f"({suggestion(steps[1], names)})")

    def check_varied(self):
        """What members vary cannot be set for all of them: it would say nothing, and be believed."""
        speed = self.keys.get("speed")
        vary = self.block("vary")
        cases = [path for changes in vary.values() if isinstance(changes, Block) for path in changes]
        if self.keys.get("design") == "cases":  # a case may change what `set` says for all
            for path in cases:
                if path in self.said:
                    raise InputError(f"--set {path}: a case of this study says it ({self.path}:{self.line('vary')}); change "
                                     "it there")
            return
        varied = [*vary, *([speed.get("path")] if isinstance(speed, Block) else [])]
        for path in varied:
            if path in self.said:
                raise InputError(f"--set {path}: this study varies it ({self.path}:{self.line(f'vary/{path}')}); change "
                                 "it there")
            if path in self.settings:
                self.fail(f"set/{path}", "this study varies it; take one of them away")

    def names(self, block):
        """Free names of a block of the scene, and of what `set` adds to it."""
        own = self.base.get(block)
        return [*(own if isinstance(own, dict) else ()),
                *(path.split(".")[1] for path in self.settings if path.startswith(block + ".") and
                  path.count(".") == 1)]

    def read_measures(self):
        """Names of the measures to judge: those said, or all of the scene."""
        known = self.names("measures") + [f"{name}.residual_speed" for name in self.names("outcomes")]
        said = self.keys.get("measures")
        if said is None:
            if not known:
                raise InputError(f"{self.scene}: it measures nothing; give it `measures:` to study")
            return known
        if not isinstance(said, list) or not said:
            self.fail("measures", "a list of names is expected")
        for name in said:
            if not isinstance(name, str):
                self.fail("measures", f"a list of names is expected, found {flow(name)}")
            if name not in known:
                self.fail("measures", f"the scene has no measure '{name}' ({suggestion(name, known)})", name.line)
        return [str(name) for name in said]

    def read_truth(self):
        """{measure: (text, share of the uncertainty, source)}; the scene's own references fill what is not said."""
        truth = {}
        for name, value in self.block("truth").items():
            key = f"truth/{name}"
            if name not in self.measures:
                self.fail(key, f"no measure of this study ({suggestion(name, self.measures)})")
            if not isinstance(value, Block) or "value" not in value:
                self.fail(key, "expected {value: ..., uncertainty: ..., source: ...}")
            for word in value:
                if word not in ("value", "uncertainty", "source"):
                    self.fail(key, f"unknown key '{word}' (known: value, uncertainty, source)")
            truth[name] = (flow(value["value"]), self.share(value, key), str(value.get("source", self.path)))
        return truth

    def share(self, value, key):
        """The uncertainty by the value; krater's units never need be known here. None where it is not said."""
        if "uncertainty" not in value:
            return None
        number, of = self.quantity(value["uncertainty"], key), self.quantity(value["value"], key)
        if number.number < 0:
            self.fail(key, "an uncertainty is not below 0")
        if number.unit == "%":
            return number.number / 100
        if number.unit != of.unit:
            self.fail(key, f"give the uncertainty in the value's unit '{of.unit}', or in %")
        if of.number == 0:
            self.fail(key, "a value of 0 has no share; leave the uncertainty out")
        return abs(number.number / of.number)

    def fixed(self):
        """--set texts of every member: `set`, and the truth as the scene's references, so that krater reads its
        units."""
        texts = [f"{path}={value}" for path, value in self.settings.items()]
        for name, (value, _, source) in self.truth.items():
            if "." not in name:
                quoted = source.replace("\\", "\\\\").replace('"', '\\"')
                texts.append(f'references.{name}={{value: {value}, source: "{quoted}"}}')
        return texts
