#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`krater run --accuracy`: reached, not to be had, refused, too dear; and what a plain run then knows of itself."""

import json
import os
import pathlib
import re
import subprocess
import time
import types

from scene_support import ROOT, Folder, check, finish, krater
from study_support import SCENE, write
from accuracy import Accuracy
from members import Member, Row
from study_file import Quantity


def to_an_accuracy():
    """krater run --accuracy: met, not to be had, refused; and what a plain run then knows of itself."""
    plain = write("plain.yaml", SCENE)
    done = krater("run", plain, "--accuracy", "3%", "-j", 2)
    told = json.loads(pathlib.Path("plain_out/summary.json").read_text(encoding="utf-8"))
    one = told["measures"]["velocity"]
    check(done.returncode == 0 and told["accuracy"]["met"] and "gone has no value" in done.text, "3 % is reached",
          done.text)
    check(0 < one["uncertainty"] <= 0.03 * abs(one["value"]) and abs(one["value"] + 333.4) <= one["uncertainty"] and
          one["uncertainty_from"], "with a band that holds the exact velocity", one)
    cell = told["cell"]
    shown = subprocess.run([ROOT / "tools/show_summary", "plain_out"], capture_output=True, text=True,
                           check=False).stdout
    check(re.search(r"velocity +-3\d\d\.?\d* +\d", shown), "show_summary shows it", shown)
    done = krater("run", plain, "-o", "again_out", "--set", f"grid.cell={cell!r}")
    check(re.search(r"velocity = -\d+\.?\d* \+- \d.* plain_out", done.text), "a plain run of that cell knows its error",
          done.text)
    done = krater("run", plain, "-o", "other_out", "--set", "grid.cell=0.2 mm")
    check("of other cells" in done.text and "+-" not in done.text, "another cell does not", done.text)
    done = krater("run", plain, "-o", "other_out", "--set", f"grid.cell={cell!r}", "--set", "time.end=0.9 us")
    check("another state" in done.text and "velocity =" not in done.text, "nor another state of the scene", done.text)
    os.mkdir("elsewhere")
    done = krater("run", "plain.yaml", "-o", "elsewhere/out", "--set", "grid.cell=1 mm", "--quiet")
    check("uncertainty" not in done.text, "--quiet says nothing of it", done.text)
    done = krater("run", plain, "--accuracy", "0.1%", "--budget", "4s", "-o", "poor_out")
    told = re.search("is not known to 0.1 %: ([0-9.]+ %|nothing) can be had at", done.stdout)
    check((done.returncode == 5 and told) or (done.returncode == 4 and "members are left" in done.text) or
          "no member is done" in done.text, "what cannot be had is said, and what can", done.text)
    for words, what in ((("--accuracy", "0"), "no number of runs has no error"),
                        (("--accuracy=-1%",), "--accuracy -1%: a share between 0 and 1"), (("--budget", "1s"), "--accuracy"),
                        (("--accuracy", "2%", "--restart", "x.h5"), "goes on by itself"),
                        (("--measures", "velocity"), "--accuracy"),
                        (("--accuracy", "2%", "--measures", "velocty"),
                         "--measures velocty: the scene has no measure 'velocty' (did you mean velocity?"),
                        (("--accuracy", "2%", "--set", "grid.box=1"), "grid.box")):
        done = krater("run", plain, *words)
        check(done.returncode == 2 and what in done.text, f"refused: {' '.join(words)}", done.text)


def of_some():
    """--measures: what is not named may be as rough as it likes, and is told with its band all the same."""
    plain = write("some.yaml", SCENE)
    done = krater("run", plain, "--accuracy", "3%", "--measures", "gone", "--budget", "4s", "-o", "gone_out")
    check(done.returncode in (4, 5) and "gone is not known to 3 %: nothing" in done.stdout, "a measure without value is not reached", done.text)
    done = krater("run", plain, "--accuracy", "3%", "--measures", "velocity, velocity", "-o", "some_out")
    told = json.loads(pathlib.Path("some_out/summary.json").read_text(encoding="utf-8"))
    check(done.returncode == 0 and told["accuracy"]["measures"] == ["velocity"] and
          "velocity is known to 3 % at" in done.stdout, "the named one is", done.text)


def too_dear():
    """What the budget cannot pay is not begun, once four cells have shown it; what it can is."""
    cells = [(f"{1e3 * cell:g} mm", cell) for cell in (0.008, 0.004, 0.002, 0.001)]
    rows = [Row(Member(text, [], {"grid.cell": text}), "done", "", {"cell": cell, "measures": {
        "rim": {"value": 1 + 30 * cell, "unit": "m"}}}, {"point_steps": cell**-3, "stepping_seconds": cell**-3 * 1e-8,
                                                       "core_seconds": 1}) for text, cell in cells]
    kind = Accuracy.__new__(Accuracy)
    kind.own, kind.target = Quantity(1, "mm"), 0.001
    kind.study, kind.named = types.SimpleNamespace(measures=["rim"]), None

    def wanted(count, budget):
        kind.engine = types.SimpleNamespace(deadline=time.monotonic() + budget, jobs=1, say=lambda _: None,
                                            check=lambda _: None)
        return [one.values["grid.cell"] for one in kind.next(rows[:count])]

    check(wanted(4, 1e7) == ["0.5 mm"], "a finer cell on the way to the one that does it", wanted(4, 1e7))
    check(wanted(4, 1e3) == [], "which the budget cannot pay", wanted(4, 1e3))
    check(wanted(3, 1e3) == ["1 mm"], "three cells are not believed", wanted(3, 1e3))


with Folder():
    to_an_accuracy()
    of_some()
    too_dear()
finish()
