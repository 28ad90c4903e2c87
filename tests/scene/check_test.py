#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`krater check --json`: the facts of the text as one JSON object, alone on standard output; errors as ever."""

import json
import math
import re

from scene_support import TAYLOR, Folder, check, finish, krater, run, summary

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


def errors():
    done = krater("check", "--json", TAYLOR, "--set", "grid.cel=1 mm")
    check(done.returncode == 2 and done.stdout == "" and "grid.cel" in done.stderr, "an error goes to stderr", done.text)
    done = krater("check", "--json", TAYLOR, "--set", "time.max_step=1e-30 s")
    check(done.returncode == 2 and done.stdout == "" and "time.max_step" in done.stderr, "so does a refusal", done.text)


with Folder():
    as_the_text()
    step()
    elements()
    errors()
finish()
