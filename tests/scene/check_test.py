#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`krater check --json`: the facts of the text as one JSON object, alone on standard output; errors as ever."""

import json
import math
import pathlib
import re

from scene_support import ROOT, TAYLOR, Folder, check, finish, krater, run, summary

MESH = "bodies.rod.kinematics={lagrangian_mesh: {element: 0.762 mm}}"
TELLS = ["advice", "bodies", "cell", "cells_looked_at", "contact", "doubts", "effects", "forecast", "frame", "notes",
         "time_step", "title"]


def told(text, word):
    return re.findall(rf"^{word}: (.*)$", text, re.MULTILINE)


def object_of(*arguments):
    """What standard output holds; nothing but one object, or the test fails here."""
    done = krater("check", "--json", *arguments)
    check(done.returncode == 0 and done.stderr == "", "it succeeds and says nothing else", done.stderr)
    return json.loads(done.stdout)


def as_the_text():
    facts, text = object_of(TAYLOR), krater("check", TAYLOR).stdout
    check(sorted(facts) == TELLS, "it holds what README lists", sorted(facts))
    rod = facts["bodies"][0]
    check(f"body {rod['name']}: material {rod['material']}, {rod['points']:.0f} points, mass {rod['mass']:.6g} kg" in text,
          "points and mass are those of the text", rod)
    exact = 8960 * math.pi * 3.81e-3**2 * 25.4e-3
    check(abs(rod["solid"]["mass"] / exact - 1) < 1e-12 and rod["solid"]["closed_form"], "the solid is a cylinder", rod)
    check(abs(rod["of_points"]["mass"] / rod["mass"] - 1) < 1e-12 and "ofhc_copper" in rod["card"], "its points", rod)
    check(rod["kinematics"] == "mpm" and [f" {s};" in text for s in rod["stages"]].count(False) == 0, "its stages", rod)
    for word, key in (("doubt", "doubts"), ("advice", "advice"), ("note", "notes")):
        check(facts[key] == told(text, word) and facts[key], f"{key} are those of the text", facts[key])
    steps = re.search(r"estimate: (\d+) steps", text)
    check(f"{facts['forecast']['steps']:.0f}" == steps[1], "and the forecast", facts["forecast"])
    strength = [e for e in facts["effects"] if e["effect"] == "strength"]
    check(len(strength) == 1 and strength[0]["law"] == "johnson_cook", "the table of effects", strength)


def step():
    first = object_of(TAYLOR)["time_step"]
    run("one", "time.end=1e-10", "output.frames=0")
    check(first["stable"] > 1e-10 and first["limit"], "the stable step and what limits it", first)
    check(summary("one")["points"] == object_of(TAYLOR)["bodies"][0]["points"], "points are those of the run")


def elements():
    facts = object_of(TAYLOR, "--set", MESH)
    rod = facts["bodies"][0]
    text = krater("check", TAYLOR, "--set", MESH).stdout
    check(rod["kinematics"] == "lagrangian_mesh" and rod["elements"] == facts["elements"]["count"], "elements", rod)
    check(f"time step {facts['time_step']['stable']:.4g} s, {facts['time_step']['limit']}" in text,
          "their step is that of the text", facts["time_step"])


def levels():
    rule = ["--set", "grid.refine=[{region: {box: {min: [0, 0], max: [1, 8 mm]}}, level: 2}]"]
    facts, text = object_of(TAYLOR, *rule), krater("check", TAYLOR, *rule).stdout
    one, told_levels = object_of(TAYLOR), facts["levels"]["list"]
    check([entry["level"] for entry in told_levels] == [0, 1, 2], "three levels", told_levels)
    for entry in told_levels:
        check(f"level {entry['level']}: cell {entry['cell']:.4g} m, {entry['points']:.0f} points in "
              f"{entry['blocks']:.0f} blocks" in text, f"level {entry['level']} is that of the text", entry)
        check(abs(entry["cell"] * 2**entry["level"] / facts["cell"] - 1) < 1e-12 and entry["bytes"] > 0, "its cells", entry)
    points = sum(entry["points"] for entry in told_levels)
    check(points == facts["bodies"][0]["points"] and abs(sum(e["share_of_time"] for e in told_levels) - 1) < 1e-12,
          "they have all points and all the time", points)
    uniform = facts["levels"]["uniform_points"]
    check(abs(uniform / (16 * one["bodies"][0]["points"]) - 1) < 0.01, "what one level of the finest cells would have", uniform)
    check(facts["levels"]["saving"] == uniform / points > 1.2, "and the saving", facts["levels"])
    check("levels" not in one, "nothing of levels without them", sorted(one))
    check(facts["doubts"] == told(text, "doubt"), "doubts of levels are among the doubts", facts["doubts"])
    few = object_of(TAYLOR, "--set", "grid.cell=12 um", *rule)
    check(few["cells_looked_at"] > 1 and abs(few["levels"]["list"][0]["cell"] / 12e-6 - 1) < 1e-9,
          "cells are those of the scene when longer ones were looked at", few["levels"])


def rigid():
    plugging = (ROOT / "inputs" / "ccf_plugging.yaml", "--set", "grid.cell=4 mm", "--set", "grid.boundary.z_min=wall")
    free = (*plugging, "--set", "bodies.projectile.rigid=free", "--set", "time.end=1 ms")
    facts, text = object_of(*free), krater("check", *free).stdout
    doubts = [d for d in facts["doubts"] if d.startswith("projectile: if nothing stops it before, it runs into z_min at 0.0002")]
    check(len(doubts) == 1 and facts["doubts"] == told(text, "doubt"), "a free body that flies to a wall is doubted", facts["doubts"])
    text = plugging[0].read_text(encoding="utf-8").replace("velocity: [0, -298 m/s]", "rigid: {velocity: [0, -298 m/s]}")
    pathlib.Path("driven.yaml").write_text(text.replace("end: 100 us", "end: 1 ms"), encoding="utf-8")
    driven = ("driven.yaml", *plugging[1:])
    for command in ("check", "run"):
        done = krater(command, *driven)
        check(done.returncode == 2 and re.search(r"\.yaml:\d+: bodies\.projectile: its motion runs into z_min at 0\.0002", done.stderr),
              f"{command}: a prescribed motion into a wall is refused", done.text[-300:])


def errors():
    done = krater("check", "--json", TAYLOR, "--set", "grid.cel=1 mm")
    check(done.returncode == 2 and done.stdout == "" and "grid.cel" in done.stderr, "an error goes to stderr", done.text)
    done = krater("check", "--json", TAYLOR, "--set", "time.max_step=1e-30 s")
    check(done.returncode == 2 and done.stdout == "" and "time.max_step" in done.stderr, "so does a refusal", done.text)


with Folder():
    as_the_text()
    step()
    elements()
    levels()
    rigid()
    errors()
finish()
