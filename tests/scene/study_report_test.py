#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`krater study REPORT.md`: a page of several studies of a user's own scene, from a template in an empty folder."""

import json
import os
import pathlib
import re

import numpy as np

from scene_support import ROOT, Folder, check, finish
from study_support import SCENE as PLATE
from study_support import study_of, write
from expressions import Expression
import run_pictures
from members import Member, Row
from study_file import InputError

SCENE = PLATE + "output: {frames: 0.5 us}\n"
TEMPLATE = """---
takes: 3 s
set: {time.cfl: 0.4}
---
# A plate

Words of mine.

```krater
table: [cells, laws]
columns: [grid.cell, velocity, {"change %": change(velocity)}, {mean %: '100 * at(velocity, "1 us") / velocity'}, core_seconds]
off: yes
members: cells/*
```

```krater
answer: cells
leave_out: pictures
```

```krater
demand: cells
says: the velocity changes by less than 5 %
value: abs(step(velocity))
below: 5
unit: "%"
members: cell=0.25mm
```

```krater
table: laws
columns: [time.energy_error, velocity]
```

```krater
sections: cells
times: 1 us
```

```krater
outlines: [cells, again]
time: 1 us
members: ["*/cell=1mm"]
boxes: [[0 mm, 1 mm, 0 mm, 12 mm]]
```

```krater
histories: [cells, again]
measures: velocity
members: ["*/cell=1mm"]
```

Last words.
"""
CELLS = "study: convergence\nscene: plate.yaml\nvary: {grid.cell: [1 mm, 0.5 mm, 0.25 mm]}\nmeasures: [velocity]\n"
LAWS = "study: sweep\nscene: plate.yaml\nmeasures: [velocity]\nvary: {time.energy_error: [off, 1e-12]}\n"


MORE = """---
define:
  drop: 100 * (at(kinetic_energy, "1 us") / at(kinetic_energy, "0 s") - 1)
  front: body == "plate" and z < quantile(z, body == "plate", 0) + 0.6e-3
---
# More

```krater
table: cases
columns: [case, points, {"drop %": drop}, {least J: least(kinetic_energy)}, {at us: '1e6 * when_least(kinetic_energy)'},
          {twice: 'most(2 * kinetic_energy) / at(kinetic_energy, "0 s")'}, {front mm: '1e3 * mean(z, "1 us", front)'},
          {all mm: '1e3 * mean(z, "1 us")'}, {top mm: '1e3 * quantile(z, "1 us", x >= 0, 1)'}, {wide mm: '1e3 * spread(z, "1 us")'},
          {heaviest g: '1e3 * fragments.parts.pieces[0].mass'}, {second g: '1e3 * fragments.parts.pieces[1].mass'}]
```

```krater
table: crossed
columns: [time.cfl, velocity, {steps of it: steps}]
across: grid.cell
```

```krater
demand: cases
says: more than one point
value: points
above: 1
```

```krater
demand: cases
says: each more than 300
value: points
above: 300
```

```krater
pieces: cases
measure: parts
most: 1
members: as_it_is
```

```krater
scatter: cases
x: {"x [mm]": 1e3 * x}
y: 1e3 * z
colour: velocity_z
where: front
times: [0 us, 1 us]
```

```krater
scatter: cases
x: z
y: {"p [GPa]": 1e-9 * pressure}
times: 1 us
lines: [{nothing: 0}]
box: [-0.02, 0.02, -1, 1]
```

```krater
histories: cases
measures: [{"share": 'kinetic_energy / at(kinetic_energy, "0 s")'}]
range: [0, 2]
```
"""
CASES = """study: sweep
scene: plate.yaml
design: cases
set: {measures.parts: {kind: fragments, body: plate}}
measures: [velocity]
vary:
  as it is: {}
  "finer, shorter": {grid.cell: 0.25 mm, time.end: 1 us}
"""
CROSSED = """study: sweep
scene: plate.yaml
measures: [velocity]
vary: {time.cfl: [0.4, 0.5], grid.cell: [1 mm, 0.5 mm]}
"""


def report(text, *words):
    write("plate.md", text)
    return study_of("plate.md", *words)


def page():
    labels, drawn = [], run_pictures.histories
    run_pictures.histories = lambda rows, *words, **more: labels.append(list(rows)) or drawn(rows, *words, **more)
    done = report(TEMPLATE)
    check(done.returncode == 0 and "about 3 s" in done.stderr, "a report is made", done.text[-600:])
    text = pathlib.Path("plate_report/README.md").read_text(encoding="utf-8")
    check(text.startswith("# A plate\n\n20") and "Words of mine." in text and text.rstrip().endswith("Last words."),
          "the author's words stand, with date and program below the title", text[:300])
    check(re.search(r"^\d{4}-\d\d-\d\d, krater [\w.]+ \(\w+(\+modified)?,", text, re.MULTILINE), "as tools/validate --index reads")
    rows = re.findall(r"^\| (1|0.5|0.25) mm \| (\S+) \| (\S+) \| (\S+) \| (\S+) \|", text, re.MULTILINE)
    members = {path.parent.name: json.loads(path.read_text(encoding="utf-8"))["measures"]["velocity"]
               for path in pathlib.Path("plate_report/runs_out").glob("cells_*/members/*/summary.json")}
    values = [members[f"cell={row[0]}mm"]["value"] for row in rows]
    check(len(rows) == 3 and [row[1] for row in rows] == [f"{v:.5g}" for v in values], "values are those of the members", rows)
    check([row[2] for row in rows] == [f"{100 * (v / -333.4 - 1):+.2f}" for v in values], "off the reference", rows)
    check([row[3] for row in rows] == ["-", *(f"{100 * (v / values[0] - 1):.2f}" for v in values[1:])], "change", rows)
    check(all(99.9 < float(row[4]) < 100.1 for row in rows), "the history's end is the measure", rows)
    step = abs(100 * (values[2] / values[1] - 1))
    check(f"Found: {step:.3g} %, **{'met' if step < 5 else 'missed'}**" in text, "a demand is judged", text)
    check("the model's error lies between" in text and "What is known of each measure" in text, "the study answers")
    check("| 1e-12 | - |" in text and "**Member energy_error=1e-12 failed: exit code 3" in text, "a failed member is told")
    pictures = re.findall(r"!\[[^\]]*\]\((\S+\.png)\)", text)
    check(labels[-1] == ["cells, 1 mm", "again, 1 mm"], "members of two studies are told apart in a picture", labels)
    check(len(pictures) == 3 and all(os.path.getsize("plate_report/" + one) > 5000 for one in pictures), "pictures", pictures)
    set_ = json.loads(next(pathlib.Path("plate_report").glob("runs_out/cells_*/members/cell=1mm/summary.json")).read_text(
        encoding="utf-8"))["machine"]["set"]
    check("time.cfl=0.4" in set_, "what the head sets is laid over every member", set_)


def more():
    """History, points, pieces, cases and tables across: values beside those that the files hold."""
    from run_reader import Run
    write("cases.yaml", CASES)
    write("crossed.yaml", CROSSED)
    done = report(MORE, "-o", "more")
    check(done.returncode == 0, "a report of history and points is made", done.text[-600:])
    text = pathlib.Path("more/README.md").read_text(encoding="utf-8")
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith(("| as it is", "| finer, shorter"))]
    check(len(rows) == 2 and int(rows[1][1]) > int(rows[0][1]), "cases by their names", rows)
    for row, name in zip(rows, ("as_it_is", "finer_shorter")):
        run = Run(next(str(path) for path in pathlib.Path("more").glob(f"runs_out/cases_*/members/{name}")))
        energy, time = run.history["kinetic_energy"][1], run.history["time"][1]
        body, = [one for one in run.bodies(run.numbers[-1]) if one.name == "plate"]
        z, mass = body.x[:, 2], body.values("mass")
        every = [(one.x[:, 2], one.values("mass")) for one in run.bodies(run.numbers[-1])]
        heights, masses = (np.concatenate(part) for part in zip(*every))
        front = z < z.min() + 0.6e-3
        mean = np.average(heights, weights=masses)
        for k, what, wanted in (
                (2, "change over the history", 100 * (np.interp(1e-6, time, energy) / energy[0] - 1)), (3, "least", energy.min()),
                (4, "when", 1e6 * time[energy.argmin()]), (5, "most of an expression", 2 * energy.max() / energy[0]),
                (6, "mean over some points", 1e3 * np.average(z[front], weights=mass[front])), (7, "over all", 1e3 * mean),
                (8, "quantile", 1e3 * heights.max()), (9, "spread", 1e3 * np.sqrt(np.average((heights - mean)**2, weights=masses))),
                (10, "a number in a list", 1e3 * mass.sum())):
            check(abs(float(row[k]) - wanted) <= 6e-3 * abs(wanted) + 1e-6, f"{name}: {what}", (row[k], wanted))
        check(row[11] == "-", "what a list has not is missing, not an error", row)
    check(re.search(r"\| cfl \| velocity m/s, cell 1 mm \| steps of it, cell 1 mm \| velocity m/s, cell 0.5 mm \| steps of it, cell "
                    r"0.5 mm \|\n[^\n]*\n\| 0.4 \| \S+ \| \d+ \| \S+ \| \d+ \|\n\| 0.5 \|", text), "a table across", text)
    check("Demanded: more than one point. Found: " in text and "**met**" in text and re.search(r"300. Found: \d+, .*missed", text),
          "a demand from below", text)
    check(re.search(r"\| piece of \| mass g .*\n.*\n\| plate \|", text) and "are not resolved" in text, "pieces", text)
    drawn = re.findall(r"!\[[^\]]*\]\((\S+\.png)\)", text)
    check(len(drawn) == 3 and all(os.path.getsize("more/" + one) > 5000 for one in drawn), "pictures of points", drawn)
    for what, change, words in (
            ("no such definition", ("columns: [case, points, {\"drop %\": drop}", "columns: [{d: dropp}"), "no member has 'dropp'"),
            ("a definition that is none", ("100 * (at", "100 * (* at"), r"plate.md:3: define: drop: .*is no expression"),
            ("no such field", ("colour: velocity_z", "colour: velocity_q"), "the points have no 'velocity_q'"),
            ("no such column", ("least(kinetic_energy)", "least(kinetic)"), "no column 'kinetic'.*did you mean"),
            ("no time", ('mean(z, "1 us")', 'mean(z, "1 mm")'), "1 mm"),
            ("nothing across", ("across: grid.cell", "across: grid.sell"), "none of these members varies 'grid.sell'"),
            ("two bounds", ("above: 300", "above: 300\nbelow: 2"), "one of `below` and `above`"),
            ("no bound", ("above: 300", "unit: m"), "one of `below` and `above`"),
            ("no pieces", ("measure: parts", "measure: part"), "no measure 'part' of kind fragments .did you mean parts"),
            ("no point", ("where: front", "where: z > 5"), "no point is there"),
            ("three numbers", ("range: [0, 2]", "range: [0, 2, 3]"), "2 numbers are expected")):
        done = report(MORE.replace(*change), "-o", "more")
        check(done.returncode == 2 and re.search(words, done.stderr, re.S) and "Traceback" not in done.stderr,
              f"refused: {what}", done.text[-300:])
    for what, change, words in (("two cases of one folder", ("as it is: {}", "as it is: {}\n  as_it_is: {}"), "the same folder"),
                                ("a case of nothing", ("as it is: {}", "as it is: fine"), "what this case changes"),
                                ("a key that no scene has", ("{grid.cell", "{grid.sell: 1 mm, grid.cell"),
                                 r"cases.yaml:8: vary.finer, shorter: .*unknown key 'sell'"),
                                ("a name that is not there", ("{grid.cell", "{bodies.plat.velocity: 0, grid.cell"), "bodies.plat")):
        write("cases.yaml", CASES.replace(*change))
        done = study_of("cases.yaml")
        check(done.returncode == 2 and re.search(words, done.stderr) and "Traceback" not in done.stderr, f"refused: {what}",
              done.text[-300:])
    write("cases.yaml", CASES)
    done = study_of("cases.yaml", "--set", "grid.cell=2 mm")
    check(done.returncode == 2 and "a case of this study says it" in done.text, "what a case says is not set for all", done.text)


def again():
    before = {path: path.stat().st_mtime_ns for path in pathlib.Path("plate_report").glob("runs_out/*/members/*/summary.json")}
    done = report(TEMPLATE.replace("below: 5", "below: 1e-9"))
    text = pathlib.Path("plate_report/README.md").read_text(encoding="utf-8")
    check("members to run" not in done.stderr and before == {path: path.stat().st_mtime_ns for path in before},
          "words may change, nothing is run again", done.stderr)
    check("**missed**" in text and "**met**" not in text, "a demand that is not met is missed")
    write("plate.yaml", SCENE.replace("end: 1 us", "end: 0.8 us"))
    done = report(TEMPLATE)
    check(done.returncode == 0 and "3 of 3 members to run" in done.stderr, "a scene that changed is run anew", done.text)
    write("plate.yaml", SCENE)
    done = report(TEMPLATE, "--budget", "0.01s", "-o", "poor")
    check(done.returncode == 2 and "below one run" in done.text, "a budget below one run is refused", done.text)
    write("cells.yaml", CELLS.replace("0.25 mm", "0.005 mm"))
    done = report(TEMPLATE.split("```krater\ndemand")[0], "--budget", "10s", "-o", "poor")
    text = pathlib.Path("poor/README.md").read_text(encoding="utf-8")
    check(done.returncode == 4 and "| 0.5 mm | -3" in text and "| 0.005 mm | - |" in text and "were not run" in text,
          "a budget that ends leaves what does not fit, and says so", done.text + text)
    write("cells.yaml", CELLS)
    done = report(TEMPLATE, "--list", "-o", "queued")
    check(done.returncode == 0 and len(done.stdout.splitlines()) == 8, "members for a queue", done.text)


def bad_input():
    line = TEMPLATE.split("\n").index("table: [cells, laws]") + 1
    for what, change, words in (
            ("no study", ("table: laws", "table: lows"), r"plate.md:\d+: table/table: no study lows.yaml"),
            ("an unknown block", ("table: [cells, laws]", "tabel: cells"), f"plate.md:{line}: .*did you mean table"),
            ("an unknown key", ("off: yes", "of: yes"), f"plate.md:{line + 2}: .*did you mean off"),
            ("a key that is missing", ("times: 1 us\n", ""), "missing key 'times'"),
            ("a block without end", ("Last words.", "```krater\ntable: cells"), "is not ended by ```"),
            ("an unknown column", ("velocity, {\"ch", "velocty, {\"ch"), f"plate.md:{line + 1}: .*did you mean velocity"),
            ("an unknown name", ("change(velocity)", "change(velo)"), f"plate.md:{line + 1}: .*no member has 'velo'"),
            ("code", ("change(velocity)", "__import__(1)"), f"plate.md:{line + 1}: .*no function __import__"),
            ("no such member", ("cells/*", "cell=3mm"), f"plate.md:{line + 3}: .*no member is called cell=3mm"),
            ("no time", ("times: 1 us", "times: 1 mm"), r"plate.md:\d+: sections/times"),
            ("an unknown key of the head", ("takes:", "take:"), "plate.md:2: take: .*did you mean takes"),
            ("no box", ("[0 mm, 1 mm,", "[2 mm, 1 mm,"), "a box is")):
        done = report(TEMPLATE.replace(*change))
        check(done.returncode == 2 and re.search(words, done.stderr, re.S) and "Traceback" not in done.stderr,
              f"refused: {what}", done.text[-300:])
    done = report("# Nothing\n")
    check(done.returncode == 2 and "names a study" in done.stderr, "refused: a page without a study", done.text)


def expressions():
    """Of made-up members: what they are, and that nothing but arithmetic is taken."""
    def row(cell, length, width):
        measures = {"length": {"value": length, "unit": "m"}, "width": {"value": width, "unit": "m"}}
        return Row(Member(cell, [], {"grid.cell": cell}), "done", "", {"measures": measures, "audit": {"heat": 3.0}}, {"steps": 7})

    rows = [row("2 mm", 4.0, 2.0), row("1 mm", 5.0, None), row("0.5 mm", 6.0, 0.0)]

    def of(text, k=0):
        return Expression(text, rows, None).of(rows[k])

    for text, k, wanted in (("length / width", 0, 2.0), ("length / width", 1, None), ("length / width", 2, None),
                            ("-length ** 2 + audit.heat", 0, -13.0), ("grid.cell * steps", 1, 7.0), ("change(length)", 0, None),
                            ("change(length)", 2, 50.0), ("step(length)", 2, 20.0), ("max(length, 9)", 0, 9.0)):
        found = of(text, k)
        check(found == wanted or abs(found - wanted) < 1e-12, f"{text} is {wanted}", found)
    for text in ("lengt", "length[0]", "length.real", "open(length)", "lambda: 1", "'a'", "length if 1 else 2", "1 +", "at(length)"):
        try:
            check(False, f"refused: {text}", of(text))
        except InputError:
            check(True, f"refused: {text}")


with Folder():
    write("plate.yaml", SCENE)
    write("cells.yaml", CELLS)
    write("again.yaml", CELLS.replace("vary", "set: {time.end: 0.9 us}\nvary"))
    write("laws.yaml", LAWS)
    page()
    more()
    again()
    bad_input()
    expressions()
finish()
