#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How a run ends and what it leaves: measures, energy and time in units that people use, a log always, JSON on demand."""

import json
import math
import re
import sys

from scene_support import ROOT, TAYLOR, Folder, check, finish, krater, run, summary

sys.path.insert(0, str(ROOT / "tools"))
from summary_text import plain, shown  # noqa: E402
from units import LADDERS, PREFIXED, PREFIXES, scale_of  # noqa: E402

COARSE = ["grid.cell=0.762mm", "time.end=8us", "output.frames=4us"]
BEYOND = ["grid.cell=1.5mm", "time.end=5us"]  # of ccf_hypervelocity: an equation of state leaves its range, which warns


def log_of(folder):
    with open(f"{folder}/log.txt", encoding="utf-8") as file:
        return file.read()


def seconds_in(text):
    number, unit = re.fullmatch(r"([\d.e-]+) (\w+)", text).groups()
    return float(number) * {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1}[unit]


def ends_with():
    said = run("out", *COARSE).stderr
    told = summary("out")
    for name, measure in told["measures"].items():
        wanted = (measure.get("reference") or {}).get("value")
        (value, reference), _, unit = shown([measure["value"], wanted], measure["unit"])
        off = f"{measure['difference_percent']:+.2f} %" if wanted else "-"
        line = next((line for line in said.splitlines() if line.startswith(f"krater:   {name} ")), "").split()
        check(line[2:] == [value, unit, reference, *off.split()], f"{name}, as in summary.json", line)
    audit = told["audit"]
    energy = re.search(r"energy: ([\d.]+) J at the start = ([\d.]+) J kinetic \+ ([\d.]+) J internal", said)
    check(energy and all(abs(float(text) / audit[key] - 1) < 1e-4 for text, key in
                         zip(energy.groups(), ("initial_energy", "kinetic_energy", "internal_energy"))), "energy", energy)
    check(f"plastic work {audit['plastic_work']:.4g} J" in said, "what it became")
    time = re.search(r"time: (.*), after (.*) to set up", said)
    machine = told["machine"]
    outside = machine["seconds_outside_steps"]
    check(time and abs(seconds_in(time[1]) / machine["wall_seconds"] - 1) < 0.01
          and abs(seconds_in(time[2]) / outside["setup"] - 1) < 0.01, "time", time)
    spent = sum(machine["seconds"].values()) + sum(outside.values()) - outside["setup"]
    check(all(v >= 0 for v in outside.values()) and outside["setup"] > 0 and 0 < spent <= 1.001 * machine["wall_seconds"],
          "its parts are no more than all of it", (spent, machine["wall_seconds"]))
    shares = [float(x) for x in re.findall(r" (\d+) %[,;]", next(l for l in said.splitlines() if "million point-steps/s" in l))]
    check(90 <= sum(shares) <= 103 and shares == sorted(shares, reverse=True), "told by shares, the largest first", shares)
    check(said.index("measures ") < said.index("energy:") < said.index("time:") < said.index("done after"), "in this order")
    check(machine["set"] == COARSE and all(f"--set {text}" in machine["command"] for text in COARSE), "what was set is kept",
          machine["command"])


def log_always():
    done = run("quiet", *COARSE, extra=["--quiet"])
    log = log_of("quiet")
    check(done.text == "" and all(text in log for text in ("krater run", "final_length", "energy: ", "time: ", "done after")),
          "--quiet says nothing; the log holds all of it", done.text)


def run_json():
    done = run("json", *BEYOND, scene=ROOT / "inputs" / "ccf_hypervelocity.yaml", extra=["--json", "--strict"])
    told = json.loads(done.stdout)
    check(done.returncode == 5 and told["exit_code"] == 5 and told["results"] == "json", "--strict: exit 5, told too", done.returncode)
    check({k: v for k, v in told.items() if k not in ("exit_code", "results")} == summary("json"), "the rest is summary.json")
    texts = [w["text"] for w in told["warnings"]]
    end = done.stderr.splitlines()[-1 - len(texts):]
    check(texts and all(text in line for text, line in zip(texts, end)) and "with 1 warning" in end[-1],
          "warnings stand in it, and at the end of the text", end)
    plain_run = run("plain", *BEYOND, scene=ROOT / "inputs" / "ccf_hypervelocity.yaml", extra=["--json"])
    check(plain_run.returncode == 0 and json.loads(plain_run.stdout)["exit_code"] == 0, "without --strict 0")
    bad = run("bad", "grid.cell=-1mm", extra=["--json"])
    check(bad.returncode == 2 and bad.stdout == "" and "grid.cell" in bad.stderr, "bad input: nothing but the error", bad.text)
    both = krater("run", TAYLOR, "--json", "--accuracy", "2%")
    check(both.returncode == 2 and both.stdout == "" and "--json excludes --accuracy" in both.stderr, "not with --accuracy", both.text)


def models_json():
    every, text = json.loads(krater("models", "--json").stdout), krater("models").stdout
    laws = [(law["family"], law["name"]) for law in every["laws"]]
    listed = [tuple(line.split()[:2]) for line in text.splitlines() if not line.startswith("card")]
    check(laws == listed, "every law of the text", len(laws))
    check([card["name"] for card in every["cards"]] == [line.split()[1] for line in text.splitlines()
                                                        if line.startswith("card") and "{" not in line], "every card")
    one = json.loads(krater("models", "--json", "johnson_cook").stdout)
    strength = next(law for law in one["laws"] if law["family"] == "strength")
    a = next(p for p in strength["parameters"] if p["key"] == "A")
    check(a["unit"] == "Pa" and a["required"] and "default" not in a and strength["equation"] and strength["reference"],
          "a law: keys with unit, range, default", a)
    card = json.loads(krater("models", "--json", "ofhc_copper").stdout)["cards"][0]
    check("density" in card["yaml"] and card["file"].endswith("ofhc_copper.yaml"), "a card: its text and file")
    none = krater("models", "--json", "ofhc_coper")
    check(none.returncode == 2 and none.stdout == "" and "ofhc_copper" in none.stderr, "none of that name", none.stderr[:80])


def one_way_to_say_units():
    """src/app/readable.cpp and tools/units.py have the same ladders."""
    source = (ROOT / "src" / "app" / "readable.cpp").read_text(encoding="utf-8").replace("std::numbers::pi / 180", repr(math.pi / 180))
    steps = {}
    table = source[source.index("kSteps[]"):source.index("kUsual[]")]
    for unit, least, size, name in re.findall(r'\{"([^"]*)",\s*([\d.e+-]+),\s*([\d.e+-]+),\s*"([^"]*)"\}', table):
        steps.setdefault(unit, []).append((float(least), float(size), name))
    check(steps == {unit: [(float(a), float(b), plain(c)) for a, b, c in ladder] for unit, ladder in LADDERS.items()}, "ladders")
    prefixes = re.findall(r'\{"", ([\d.e+-]+), ([\d.e+-]+), "(\w?)"\}', source[source.index("kPrefixes[]"):])
    check([(float(a), float(b), c) for a, b, c in prefixes] == [(a, b, plain(c)) for a, b, c in PREFIXES]
          and set(re.findall(r'"([^"]+)"', source[source.index("kPrefixed{"):source.index("kPrefixes[]")])) >= PREFIXED, "prefixes")
    for value, unit, wanted in ((3.1e8, "Pa", "MPa"), (1.2e9, "Pa", "GPa"), (0.0254, "m", "mm"), (0, "m", "mm"), (2.5e3, "m/s", "km/s"),
                                (190, "m/s", "m/s"), (8e-5, "s", "µs"), (1.2e-3, "kg", "g"), (8960, "kg/m^3", "g/cm³"), (4e4, "J", "kJ"),
                                (0.3, "1", "")):
        check(scale_of(value, unit)[1] == wanted, f"{value} {unit} in {wanted or 'nothing'}", scale_of(value, unit))


def main():
    with Folder():
        for test in (ends_with, log_always, run_json, models_json, one_way_to_say_units):
            test()
    finish()


if __name__ == "__main__":
    main()
