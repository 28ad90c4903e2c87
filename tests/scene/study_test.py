#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`krater study`: the engine (resume, failing members, budget, queue, bad input), every kind at toy size."""

import csv
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import types

import h5py

from scene_support import ROOT, Folder, check, command, environment, finish, krater
from study_support import SCENE, study_of, write
from answer import Answer
from ballistic_limit import BallisticLimit, by_cell
from members import Member, Row, member, text_of
from refinement import Convergence
from study_file import Quantity

SHOT = """
frame: axisymmetric
grid: {cell: 0.5 mm, box: {min: [0, -14 mm], max: [6 mm, 8 mm]}, boundary: {r_min: axis}}
time: {end: 60 us, stop_when: {settled: rod}}
materials:
  steel: {density: 7850, shear_modulus: 80 GPa, strength: {von_mises: {Y: 1.5 GPa, H: 100 MPa}},
          eos: {mie_gruneisen_shock: {c0: 4569 m/s, S1: 1.49, gamma0: 2.17}}}
  soft: {density: 2700, shear_modulus: 26 GPa, strength: {von_mises: {Y: 200 MPa, H: 100 MPa}},
         eos: {mie_gruneisen_shock: {c0: 5240 m/s, S1: 1.4, gamma0: 2}},
         damage: {maximum_plastic_strain: {eps_max: 0.8}}, failure: {action: remove}}
bodies:
  rod: {material: steel, shape: {cylinder: {radius: 2 mm, height: 5 mm, base: [0, 0.3 mm]}},
        velocity: {speed: 600 m/s, towards: -z}}
  plate: {material: soft, shape: {cylinder: {radius: 6 mm, height: 2 mm, base: [0, -2 mm]}}}
outcomes: {shot: {projectile: rod, target: plate}}
contact: {friction: 0}
"""
LIMIT = "study: ballistic_limit\nscene: shot.yaml\noutcome: shot\nspeed: {path: bodies.rod.velocity.speed, " \
        "between: [50 m/s, 600 m/s], tolerance: 40 m/s}\n"


def study(name, text="", *words):
    if text:
        write(name + ".yaml", text)
    return study_of(name + ".yaml", *words)


def answer(name):
    return json.loads(pathlib.Path(f"{name}_study/study.json").read_text(encoding="utf-8"))


def convergence(cells="[1 mm, 0.5 mm, 0.25 mm]", more=""):
    return f"study: convergence\nscene: plate.yaml\nvary: {{grid.cell: {cells}}}\nmeasures: [velocity]\n{more}"


def files_of_a_study():
    write("three.yaml", convergence())
    done = krater("study", "three.yaml", "-j", 2)
    check(done.returncode == 0, "a convergence study runs", done.text)
    said = answer("three")
    one = said["answer"]["measures"]["velocity"]
    check(abs(one["value"] + 333.4) <= one["uncertainty"] and one["uncertainty"] < 20,
          "the exact velocity lies in the band", one)
    check(len(said["members"]) == 3 and all(row["status"] == "done" for row in said["members"]), "three members")
    check("off -333.4" in done.stdout and "the model's error lies between" in done.stdout, "the reference is judged")
    with open("three_study/study.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    with h5py.File("three_study/study.h5", "r") as file:
        check([*file.attrs["columns"]] == [title.split(" [")[0] for title in rows[0]],
              "csv and h5 have the same columns")
        check(file["velocity"].attrs["unit"] == "m/s" and len(file["velocity"]) == len(rows) - 1 == 3, "with units")
    page = pathlib.Path("three_study/study.html").read_text(encoding="utf-8")
    check("<svg" in page and not re.search(r'(src|href)="(?!#)', page), "the page needs nothing beside it")
    check("core time" in done.stderr and "left" in done.stderr, "cost is foretold, and what is left", done.stderr)
    done = study("three")
    check(done.returncode == 0 and "members to run" not in done.stderr, "a second call runs nothing", done.stderr)
    check("Members were made" not in done.stdout, "by this program", done.stdout)
    path = pathlib.Path("three_study/members/cell=1mm/summary.json")
    told = path.read_text(encoding="utf-8")
    path.write_text(re.sub(r'("revision": ")[^"]*', r"\g<1>feedfacecafe", told), encoding="utf-8")
    check("Members were made by several revisions" in study("three").stdout, "members of another program are told")
    path.write_text(told, encoding="utf-8")


def resumed():
    """Killed in the middle: members stop with their study, what was done stays, the rest goes on."""
    write("long.yaml", convergence("[0.5 mm, 0.25 mm, 0.05 mm]"))
    process = subprocess.Popen(command("study", "long.yaml", "-j", 1), stderr=subprocess.PIPE, text=True,
                               env=environment())
    for line in process.stderr:
        if "[2/3]" in line:
            break
    end = time.monotonic() + 30
    while not os.path.exists("long_study/members/cell=0.05mm/checkpoint.h5") and time.monotonic() < end:
        time.sleep(0.005)
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stderr.close()
    folder = pathlib.Path("long_study/members")
    before = {p: p.stat().st_mtime_ns for p in folder.glob("cell=0.[25]*mm/summary.json")}
    check(len(before) == 2, "two members were done when it was killed")
    while time.monotonic() < end:  # the orphan writes its checkpoint and ends
        told = folder / "cell=0.05mm/summary.json"
        if told.exists() and json.loads(told.read_text(encoding="utf-8"))["status"] != "running":
            break
        time.sleep(0.02)
    done = study("long")
    log = (folder / "cell=0.05mm/log.txt").read_text(encoding="utf-8")
    check(done.returncode == 0 and "1 of 3 members to run" in done.stderr, "the same command goes on", done.text)
    check("--restart" in log, "the member from its checkpoint", log[-400:])
    check(before == {p: p.stat().st_mtime_ns for p in before}, "what was done is not done again")


def at_the_last_of_three(name):
    """A study that has two of its three members and begins the last."""
    process = subprocess.Popen(command("study", name, "-j", 1), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               env=environment())
    for line in process.stderr:
        if "[2/3]" in line:
            break
    return process


def stopped_study():
    """A study that is asked to end: the member goes on later, and has cost both parts."""
    write("asked.yaml", convergence("[1 mm, 0.5 mm, 0.04 mm]"))
    process = at_the_last_of_three("asked.yaml")
    folder, end = pathlib.Path("asked_study/members"), time.monotonic() + 30
    while not (folder / "cell=0.04mm/log.txt").exists() and time.monotonic() < end:
        time.sleep(0.005)
    time.sleep(0.3)
    process.send_signal(signal.SIGTERM)
    _, error = process.communicate()
    told = json.loads((folder / "cell=0.04mm.json").read_text(encoding="utf-8"))
    check(process.returncode == 4 and "interrupted; what is done lies in" in error and told["status"] == "interrupted" and
          told["core_seconds"] > 0.1, "a study that is asked to end books what was spent", told)
    done = study("asked")
    after = json.loads((folder / "cell=0.04mm.json").read_text(encoding="utf-8"))
    alone = json.loads((folder / "cell=0.04mm/summary.json").read_text(encoding="utf-8"))["machine"]["processor_seconds"]
    check(done.returncode == 0 and after["core_seconds"] > told["core_seconds"] + 0.5 * alone, "and later both parts",
          (told["core_seconds"], alone, after["core_seconds"]))


def killed_member():
    """A member that the system ended, for want of memory mostly, says nothing of its settings: it is tried again."""
    write("short.yaml", convergence("[1 mm, 0.5 mm, 0.05 mm]"))
    process = at_the_last_of_three("short.yaml")
    end, children = time.monotonic() + 30, []
    while not children and time.monotonic() < end:
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text(encoding="utf-8").split()
        time.sleep(0.005)
    os.kill(int(children[0]), signal.SIGKILL)
    out, error = process.communicate()
    check(process.returncode == 4 and "ended by SIGKILL" in out and "1 members are left" in error, "a killed member is left",
          out + error)
    done = study("short")
    check(done.returncode == 0 and "1 of 3 members to run" in done.stderr, "and run by the same command", done.text)


def names():
    """A name is where results lie: no two members may share one, however alike they are told."""
    long = "{lagrangian_mesh: {failure: {action: erode, when: {plastic_strain: 1.0, jacobian: 0.05}}}}"
    both = [(first, second) for first in ("mpm", long) for second in ("mpm", long)]
    values = ([{"bodies.a.kinematics": first, "bodies.b.kinematics": second} for first, second in both] +
              [{"x.a": text} for text in ("[1, 0]", "[10]", "{p: 10}", "10", "1 0 mm", long + " ", "")])
    told = [member(one).name for one in values]
    check(len(set(told)) == len(values) and max(len(name) for name in told) <= 100, "each member has its own name", told)
    check(member({"grid.cell": "0.381 mm"}).name == "cell=0.381mm" and member({}).name == "as_it_is",
          "that tells its values where it can")


def failing_member():
    write("limited.yaml", "study: sweep\nscene: plate.yaml\nmeasures: [velocity]\n"
          "vary: {time.energy_error: [off, 1e-12, 0.2]}\n")
    done = study("limited")
    said = answer("limited")
    row = said["members"][1]
    check(done.returncode == 0 and row["status"] == "failed" and "exit code 3: energy error" in row["reason"],
          "a failure is a row", row)
    check(f"Member {row['member']} failed" in done.stdout and row["velocity"] is None, "and is told")
    done = study("limited")
    check("to run" not in done.stderr and f"Member {row['member']} failed" in done.stdout,
          "what failed by itself is told again, not run again", done.stderr)


def budget():
    write("dear.yaml", convergence("[1 mm, 0.5 mm, 0.005 mm]"))
    done = study("dear", "", "--budget", "20s")
    check(done.returncode == 4 and "left (cell=0.005mm)" in done.stderr, "a budget ends cleanly, says what is left",
          done.text)
    check(len([1 for row in answer("dear")["members"] if row["status"] == "done"]) == 2, "what fits is answered with")
    check("were not run" in done.stdout or "left" in done.stdout or "interrupted" in done.stdout, "the answer says so")
    done = study("poor", convergence("[0.002 mm, 0.001 mm]"), "--budget", "0.1 s")
    check(done.returncode == 2 and "below one run" in done.text, "a budget below one run is refused", done.text)


def null_in_some():
    """A measure that some members have not: left out of what is said of it, and that is said; an error is never made of
    it."""
    some = "vary: {bodies.plate.velocity: [[0, -1 km/s], [0, 3 km/s]]}"
    done = study("some", f"study: sweep\nscene: plate.yaml\nmeasures: [velocity, gone]\n{some}\n")
    values = [row["gone"] for row in answer("some")["members"]]
    check(done.returncode == 0 and values[0] is None and values[1] > 0, "the body is there in one of two", values)
    check(re.search(r"gone has no value in 1 of 2 members \(velocity=0-1kms_[0-9a-f]{8}\): they are left out", done.stdout),
          "what is left out is said", done.stdout)
    rows = [row_of_a_run(cell, value) for cell, value in ((0.004, 1.0), (0.002, None), (0.001, 1.1))]
    kind = Convergence.__new__(Convergence)
    kind.study = types.SimpleNamespace(measures=["gone"], truth={})
    said = kind.answer(rows)
    check(said.data["measures"]["gone"]["uncertainty"] is None and
          any("no error can be said" in line and "2 mm" in line for line in said.sentences),
          "a refinement with a gap says no error, and which cell has no value", said.sentences)


def row_of_a_run(cell, value):
    """A member as it would lie on disk."""
    cost = {"core_seconds": 1 / cell, "point_steps": 1 / cell**3, "stepping_seconds": 1 / cell}
    measures = {"gone": {"value": value, "unit": "m"}}
    return Row(Member(f"cell={cell}", [], {}), "done", "", {"cell": cell, "measures": measures}, cost)


def fates():
    """What each word of an outcome means for the limit; a wrong one would move it and nothing else would tell."""
    def shot(speed, word, whole="moving"):
        told = {"outcome": whole, "main_piece_outcome": word}
        return Row(Member(f"{speed}", [], {"v": f"{speed} m/s"}), "done", "", {"outcomes": {"shot": told}})

    kind = BallisticLimit.__new__(BallisticLimit)
    kind.outcome, kind.path = "shot", "v"
    for word, through in (("perforated", True), ("stopped", False), ("ricocheted", False), ("missed", None),
                          ("moving", None)):
        check(kind.perforated(shot(300, word)) is through, f"{word}: {through}")
        check(kind.perforated(shot(300, None, word)) is through, f"{word} of the whole, where there is no main piece")
    rows = [shot(100, "stopped"), shot(200, "stopped"), shot(400, "perforated"), shot(300, "perforated")]
    check(kind.bracket(rows) == (200, 300), "fastest that was stopped, slowest that perforated", kind.bracket(rows))
    check(kind.bracket([*rows, shot(350, "stopped")]) == (200, 300), "not one that was stopped above it")
    check(kind.bracket([*rows, shot(250, "ricocheted")]) == (250, 300), "a ricochet did not perforate")
    check(kind.bracket(rows[:2]) == (200, None) and kind.bracket(rows[2:]) == (None, 300),
          "one end alone is no bracket")


def queue():
    write("queued.yaml", convergence())
    done = study("queued", "", "--list")
    lines = done.stdout.splitlines()
    check(done.returncode == 0 and len(lines) == 3 and all("krater run" in line for line in lines),
          "one command per member", done.text)
    if shutil.which("parallel"):
        subprocess.run(["parallel", "-j", "1"], input="\n".join(lines[:2]), text=True, check=True, capture_output=True)
    else:
        print("skip  GNU parallel is not here (Debian: parallel); a shell runs the lines")
        for line in lines[:2]:
            subprocess.run(line, shell=True, check=True, capture_output=True)
    done = study("queued", "", "--collect")
    check(done.returncode == 4 and "1 members were not run" in done.stdout, "what is done is collected", done.text)
    subprocess.run(lines[2], shell=True, check=True, capture_output=True, cwd="/")
    done = study("queued", "", "--collect")
    check(done.returncode == 0 and answer("queued")["answer"]["measures"]["velocity"]["uncertainty"] > 0, "then all",
          done.text)
    check(study("queued", "", "--list").stdout == "", "and nothing is left to list")
    done = study("side", "study: sweep\nscene: plate.yaml\ndesign: list\nvary: {time.end: [1 us, 2 us, 3 us], "
                 "time.cfl: [0.5, 0.5, 0.6]}\nmeasures: [velocity]\n", "--list")
    check(done.returncode == 0 and len(done.stdout.splitlines()) == 3, "values side by side may be there twice", done.text)


def bad_input():
    base = convergence()
    for what, text, words in (
            ("a path no scene has", base.replace("vary:", "set: {bodies.plat.velocity: 1}\nvary:"),
             "bad.yaml:3: .*did you mean plate"),
            ("a key no scene has", base.replace("vary:", "set: {grid.cel: 1}\nvary:"),
             r"bad.yaml:3: .*did you mean cell"),
            ("a value that is set and varied", base.replace("vary:", "set: {grid.cell: 1 mm}\nvary:"),
             "bad.yaml:3: set/grid.cell: this study varies it"),
            ("shifts of one cell", convergence("[1 mm, 0.95 mm, 0.9 mm]"), "bad.yaml:3: .*within 15 %"),
            ("a cell that asks too much", convergence("[1 mm, 1e-6 mm]"), r"a million cells[^\n]*\(member cell=1e-06mm\)\n$"),
            ("an axis that is no cell", base.replace("grid.cell", "time.end"), "bad.yaml:3: vary/time.end: .*pareto"),
            ("one cell for an order", convergence("[1 mm]"), "bad.yaml:3: .*one cell has no order"),
            ("a value that is none", convergence("[1 mm, small]"), "bad.yaml:3: .*small"),
            ("an unknown measure", base.replace("[velocity]", "[velocty]"), "bad.yaml:4: .*did you mean velocity"),
            ("an unknown kind", base.replace("convergence", "convergense"), "bad.yaml:1: .*did you mean convergence"),
            ("an unknown key", base + "repeat: 3\n", "bad.yaml:5: .*did you mean repeats"),
            ("no scene", base.replace("plate.yaml", "plat.yaml"), "bad.yaml:2: .*no such file"),
            ("a budget of 0", base + "budget: 0 s\n", "bad.yaml:5: budget: a time above 0"),
            ("no YAML", base + "  - x: [\n", r"bad.yaml:\d+"),
            ("uncertainty in another unit", base + "truth: {velocity: {value: 1 m/s, uncertainty: 1 mm/s}}\n",
             "bad.yaml:5: truth/velocity: .*m/s"),
            ("a truth of another unit", base + "truth: {velocity: {value: 1 mm}}\n", "bad.yaml:5: .*mm"),
            ("a plain list for the cube", "study: sweep\nscene: plate.yaml\ndesign: latin_hypercube\n"
             "vary: {time.end: [1 us, 2 us, 3 us]}\n", r"bad.yaml:4: .*\[low, high\]"),
            ("one member of a list twice", "study: sweep\nscene: plate.yaml\ndesign: list\nvary: {time.end: [1 us, 2 us, 1 us], "
             "time.cfl: [0.5, 0.5, 0.5]}\n", "bad.yaml:4: vary: a member is there twice"),
            ("three constants", "study: calibrate\nscene: plate.yaml\nvary: {a: [1, 2], b: [1, 2], c: [1, 2]}\n"
             "truth: {velocity: {value: 1 m/s}}\n", "bad.yaml:3: vary: one or two"),
            ("shifts that the sides forbid", base + "repeats: 3\n", "bad.yaml:5: repeats: .*leave repeats out"),
            ("one cell for a limit", LIMIT + "cells: [0.5 mm]\n", "bad.yaml:5: cells: two cells or more"),
            ("a cell twice", LIMIT + "cells: [0.5 mm, 0.45 mm]\n", "bad.yaml:5: cells: .*15 %"),
            ("shots of two cells of three", LIMIT + "cells: [1 mm, 0.5 mm, 0.25 mm]\nmembers: [4, 4]\n",
             r"bad.yaml:6: members: one number, or as many as there are cells \(3\)"),
            ("a finest cell that no scene can have", LIMIT + "cells: [1 mm, 0.001 um]\n", "cell"),
            ("no outcome", "study: ballistic_limit\nscene: plate.yaml\noutcome: shot\nspeed: {}\n",
             "bad.yaml:3: outcome")):
        done = study("bad", text)
        check(done.returncode == 2 and re.search(words, done.stderr, re.S) and not done.stdout, f"refused: {what}",
              done.text[-300:])
    done = study("three", "", "--set", "grid.cell=1 mm")
    check(done.returncode == 2 and "--set grid.cell: this study varies it (three.yaml:3)" in done.text,
          "what a study varies cannot be set", done.text)
    study("null", base.replace("[velocity]", "[gone]"))
    done = study("null")
    check(done.returncode == 2 and "'gone' has no value in any" in done.text, "a measure that is null everywhere",
          done.text)
    done = study("three", convergence("[1 mm, 0.5 mm, 0.2 mm]"))
    check(done.returncode == 2 and "three.yaml:3: vary: changed since" in done.text, "a file that changed", done.text)
    check(krater("study").returncode == 2 and krater("study", "--help").returncode == 0, "usage")


def limit():
    done = study("limit", LIMIT)
    said = answer("limit")["answer"]
    low, high = said["bracket"]
    fates = {speed: through for speed, _, through in said["shots"]}
    check(done.returncode == 0 and 0 < high - low <= 40 and fates[high] and not fates[low], "the limit is bracketed",
          said)
    check(said["fit"] and low - 60 < said["fit"]["limit"] < high + 60, "and fitted", said.get("fit"))
    check("give `cells: [...]`" in done.stdout, "of one cell, which the study says", done.stdout)


def limit_by_cell():
    """Limits of several cells, each found for itself; and of made-up ones, whether they answer the question."""
    done = study("cells", LIMIT.replace("tolerance: 40", "tolerance: 150") + "cells: [0.5 mm, 1 mm]\n")
    said = answer("cells")["answer"]
    check(done.returncode == 0 and [one["cell"] for one in said["cells"]] == [1e-3, 5e-4], "coarse, then fine", said)
    for one in said["cells"]:
        fates = {speed: through for speed, _, through in one["shots"]}
        low, high = one["bracket"]
        check(0 < high - low <= 150 and fates[high] and not fates[low] and len(fates) >= 4, "each is bracketed by its own", one)
    check(said["limit"] == 0.5 * sum(said["cells"][1]["bracket"]) and said["uncertainty"] == 137.5 and
          re.search(r"By the cells 1, 0.5 mm the limit is .* \+- ", done.stdout), "and told together", done.stdout)
    for what, limits, words in (
            ("20, 40, 60 through a plate of 12 mm", (239, 209, 189), "do not answer to 2 %, and where it ends these cells do not"),
            ("of first order", (240, 215, 206.7), r"0\.6, 0\.3, 0\.2 mm do not answer to 2 %; 0\.0\d+ mm should, at "),
            ("within their intervals", (200, 201, 200.5), "Every one"),
            ("out of reach", (340, 260, 245), r"by what they show .* mm would, which is out of reach: halve the finest"),
            ("settled", (201, 200.2, 200), r"Every one of these cells answers to 2 %"),
            ("settled in the end", (240, 200.2, 200), r"^0\.6 mm does not answer to 2 %\."),
            ("wavering", (200, 260, 190), "do not answer to 2 %, and where it ends")):
        told = Answer()
        by_cell(told, [{"cell": cell, "bracket": [limit - 1, limit + 1], "shots": [], "core_seconds": 1} for cell, limit in zip((6e-4, 3e-4, 2e-4), limits)],
                "m/s", (1e-4, -3.0, 1e-7))
        check(re.search(words, told.sentences[-1]), f"{what}: {words}", told.sentences)


def prices():
    for seconds, words in ((5.26, "5.3 s"), (90, "1.5 min"), (7200, "2.0 h"), (1e6, "11.6 days"), (4e7, "more than a year")):
        check(text_of(seconds) == words, f"{seconds:g} s is told as {words}", text_of(seconds))


def finer_begin_near():
    """A finer cell begins where coarser ones point to; wherever its limit is, its own shots bracket it."""
    def asked(limits, most=20):
        """{cell: its rows} where shots above limits[cell] perforate; None: they tell nothing."""
        kind = BallisticLimit.__new__(BallisticLimit)
        kind.outcome, kind.path, kind.tolerance, kind.cells = "shot", "v", 5.0, list(limits)
        kind.low, kind.high, kind.most = Quantity(100, "m/s"), Quantity(420, "m/s"), dict.fromkeys(limits, most)
        rows = []
        while new := kind.next(rows):
            for one in new:
                speed, limit = float(one.values["v"].split()[0]), limits[one.values["grid.cell"]]
                word = "moving" if limit is None else "perforated" if speed > limit else "stopped"
                rows.append(Row(one, "done", "", {"outcomes": {"shot": {"outcome": word}}}))
            check(len(rows) == len({row.member.name for row in rows}) < 70, "no shot is asked twice", rows[-1].member.name)
        return kind, {cell: kind.of_cell(rows, cell) for cell in kind.cells}

    for what, limits, dear in (("as the cell", (261.3, 221.7, 201.9), 7), ("settled", (261.3, 261.3, 261.3), 7),
                               ("far below", (261.3, 221.7, 121.9), 11), ("far above", (261.3, 221.7, 391.1), 11),
                               ("below all", (261.3, 221.7, 90), 7), ("above all", (151.9, 171.3, 430), 7)):
        kind, found = asked(dict(zip(("0.6 mm", "0.3 mm", "0.2 mm"), limits)))
        for limit, rows in zip(limits, found.values()):
            low, high = kind.bracket(rows)
            inside = 100 < limit < 420
            check(low < limit < high <= low + 5 if inside else low is None if limit < 100 else high is None,
                  f"{what}: {limit} is bracketed, or known to be outside", (low, high))
        check(len(found["0.6 mm"]) > len(found["0.2 mm"]) or not what.startswith(("as", "settled")), f"{what}: fewer dear shots")
        first = [kind.speed(row) for row in found["0.2 mm"][:2]]
        check(what != "as the cell" or first[0] < limits[2] < first[1], f"{what}: the first two shots bracket it", first)
        check(len(found["0.2 mm"]) <= dear, f"{what}: at most {dear} dear shots", len(found["0.2 mm"]))
    _, found = asked({"0.6 mm": 260, "0.3 mm": None, "0.2 mm": 240})
    check(len(found["0.3 mm"]) < 10 and len(found["0.2 mm"]) < 10, "a cell that tells nothing is passed over",
          [len(rows) for rows in found.values()])
    kind, found = asked({"0.6 mm": 260, "0.3 mm": 120}, 2)
    rows = found["0.3 mm"][1:]
    check("below " + kind.low.text(kind.speed(rows[0])) in kind.outside(rows, None, kind.speed(rows[0])) and
          "More shots" in kind.outside(rows, None, 1), "a search that was cut short says no more than its shots do")
    kind, found = asked({"0.6 mm": 90})
    check("below 100 m/s. Widen" in kind.outside(found["0.6 mm"], None, 100), "one that met the end says so")
    kind, found = asked({"0.6 mm": 430})
    check("above 420 m/s. Widen" in kind.outside(found["0.6 mm"], 420, None), "at either end")
    _, found = asked({"0.6 mm": 260, "0.3 mm": 220}, 3)
    check([len(rows) for rows in found.values()] == [3, 3], "never more than `members` of a cell")


def examples():
    """Those of inputs/studies as they are, but coarse."""
    toy = {"convergence": ("[1.524 mm, 0.762 mm, 0.381 mm, 0.1905 mm]", "[3 mm, 1.5 mm]"), "pareto": ("2, 3", "2"),
           "ablation": None, "sweep": ("members: 24", "members: 4"), "calibrate": ("members: 15", "members: 4"),
           "ballistic_limit": ("members: 16", "members: 3")}
    here = sorted(path.stem for path in (ROOT / "inputs/studies").glob("*.yaml"))
    check(here == sorted(toy), "an example of each kind", here)
    for kind, change in toy.items():
        text = (ROOT / f"inputs/studies/{kind}.yaml").read_text(encoding="utf-8").replace("../", f"{ROOT}/inputs/")
        words = {"convergence": (), "pareto": ("--set", "time.end=10 us"), "ballistic_limit": (
            "--set", "grid.cell=4 mm", "--set", "time.energy_error=off", "--set",
            "bodies.plate.shape.cylinder.radius=60 mm")
        }.get(kind, ("--set", "grid.cell=1.524 mm"))
        done = study(kind, text.replace(*change) if change else text, *words)
        check(done.returncode == 0 and os.path.exists(f"{kind}_study/study.html"), f"the example of {kind} runs",
              done.text[-600:])
    lines = pathlib.Path("ablation_study/influence.tsv").read_text(encoding="utf-8").splitlines()
    check(lines[0] == f"# scene taylor_copper.yaml {1.524e-3:.17g}" and len(lines) == 5 and
          re.fullmatch(r"materials.copper.heating\t[0-9.]+\t\w+\t(keep|could go)", lines[1]),
          "an ablation leaves what krater check tells of each effect", lines)


with Folder():
    write("plate.yaml", SCENE)
    write("shot.yaml", SHOT)
    names()
    files_of_a_study()
    resumed()
    killed_member()
    stopped_study()
    failing_member()
    null_in_some()
    fates()
    budget()
    queue()
    bad_input()
    limit()
    limit_by_cell()
    prices()
    finer_begin_near()
    examples()
finish()
