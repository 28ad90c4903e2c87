# SPDX-License-Identifier: GPL-3.0-or-later
"""The steps of the developer's guide (src/manual/pages/developer.md), applied to a tree as they stand there.

A sentence before a block of code says what is done with it:
  Write this as `PATH`:                a new file
  In `PATH`, after `TEXT`:             behind the line that holds TEXT, which one line alone does
  In `PATH`, `TEXT` becomes:           in place of that line
A block under <!-- guide: steps --> is a file or commands of the example, for the folder where it is run.
"""

import pathlib
import re

GUIDE = "src/manual/pages/developer.md"
BLOCK = re.compile(r"^(?P<said>[^\n]*)\n+(?P<comment><!-- guide: steps -->\n)?```(?P<language>\w+)\n(?P<text>.*?)^```$", re.S | re.M)
NEW = re.compile(r"^Write this as `(?P<path>[^`]+)`:$")
CHANGE = re.compile(r"^In `(?P<path>[^`]+)`, (?P<after>after )?`(?P<anchor>.+?)`(?P<becomes> becomes)?:$")


class Broken(Exception):
    """A step that cannot be followed."""


def blocks(root):
    text = (pathlib.Path(root) / GUIDE).read_text(encoding="utf-8")
    return [match.groupdict() for match in BLOCK.finditer(text)]


def changed(text, step, block, path):
    """The text of a file after a step."""
    lines = text.splitlines(keepends=True)
    found = [k for k, line in enumerate(lines) if step["anchor"].strip() in line]
    if len(found) > 1:  # the whole line is meant
        found = [k for k in found if lines[k].strip() == step["anchor"].strip()]
    if len(found) != 1:
        raise Broken(f"{GUIDE}: {len(found)} lines of {path} hold `{step['anchor']}`, one is needed")
    at = found[0]
    lines[at:at + 1] = ([lines[at]] if step["after"] else []) + [block["text"]]
    return "".join(lines)


def apply(root):
    """Follows every step in the tree `root`; the paths it wrote."""
    root, touched = pathlib.Path(root), []
    for block in blocks(root):
        new, change = NEW.match(block["said"]), CHANGE.match(block["said"])
        if block["comment"] or not (new or change):
            continue
        path = root / (new or change)["path"]
        if new:
            if path.exists():
                raise Broken(f"{GUIDE}: {path} is there already")
            path.write_text(block["text"], encoding="utf-8")
        else:
            path.write_text(changed(path.read_text(encoding="utf-8"), change.groupdict(), block, change["path"]), encoding="utf-8")
        touched.append((new or change)["path"])
    return list(dict.fromkeys(touched))


def examples(root, folder):
    """Writes the examples' files into `folder`; their commands, line by line."""
    commands = []
    for block in blocks(root):
        if not block["comment"]:
            continue
        new = NEW.match(block["said"])
        if new:
            (pathlib.Path(folder) / new["path"]).write_text(block["text"], encoding="utf-8")
        elif block["language"] == "sh":
            commands += block["text"].splitlines()
    return commands
