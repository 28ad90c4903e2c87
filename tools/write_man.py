#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes krater.1, the page of `man krater`, from what the program's own --help says.

    tools/write_man.py PROGRAM FILE
"""

import os
import re
import subprocess
import sys

FILES = [
    ("SCENE_out/", "results: summary.json, history.csv, frames.h5, log.txt; RESULTS.md in the documentation describes them"),
    ("/usr/share/krater/materials", "material cards; krater models lists them"),
    ("/usr/share/krater/examples", "scenes to start from: taylor_copper.yaml first"),
]
CODES = [("0", "done"), ("2", "bad input: file, line, key and remedy are named"), ("3", "numerical failure, state saved"),
         ("4", "interrupted, checkpoint written"), ("5", "done with warnings under --strict")]
ENVIRONMENT = [("KRATER_CARDS", "folders of cards, separated by colons"),
               ("KRATER_ISA", "portable, v3 or v4: the instruction set that is used (the results are the same)"),
               ("OMP_WAIT_POLICY", "active: threads that wait for others look on and do not sleep, for a machine of your own")]
SEE = ["krater-plot-run DIR", "krater-plot-scene SCENE", "krater-plot-point DIR", "krater-show-summary DIR",
       "krater-three-cells SCENE", "krater-to-vtkhdf DIR"]


def said(program, *words):
    return subprocess.run([program, *words], capture_output=True, text=True, check=True,
                          env={**os.environ, "COLUMNS": "100"}).stdout


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def commands(text):
    """[(name, meaning)] of `krater --help`."""
    part = text.partition("Subcommands:")[2]
    return [(m[1], " ".join(m[2].split())) for m in re.finditer(r"^  (\w+) +(.*(?:\n {6,}.*)*)", part, re.M)]


def options(text):
    """[(spelling, meaning)] of one command's help: positionals and options."""
    found = []
    for line in text.splitlines():
        entry = re.match(r"^  (\S.*?)(?: {2,}(.*))?$", line)
        if entry and not line.startswith("      "):
            found.append([entry[1], entry[2] or ""])
        elif found and re.match(r"^ {6,}\S", line):
            found[-1][1] += " " + line.strip()
    return found


def items(pairs):
    return [line for name, meaning in pairs for line in (".TP", ".B " + roff(name), roff(meaning.strip()))]


def page(program):
    first = said(program, "--version").split()
    listed = commands(said(program, "--help"))
    lines = [f".TH KRATER 1 \"\" \"krater {first[1]}\" \"User commands\"", ".SH NAME",
             "krater \\- Material Point Method for impact, penetration and fragmentation", ".SH SYNOPSIS"]
    lines += [f".B krater {name}\n.RI [ options ]\n.br" for name, _ in listed]
    lines += [".SH DESCRIPTION", "One scene file in YAML describes a case; values carry units, a bare number is SI. A key that is "
              "unknown, missing or out of range is an error with file, line and a suggestion.", ".SH COMMANDS"]
    for name, meaning in listed:
        lines += [f".SS krater {name}", roff(meaning)]
        if name != "study":  # a package of its own, with pages of its own
            lines += items(options(said(program, name, "--help").partition("\n")[2]))
    lines += [".SH EXIT STATUS", *items(CODES), ".SH ENVIRONMENT", *items(ENVIRONMENT), ".SH FILES", *items(FILES)]
    lines += [".SH SEE ALSO", roff(", ".join(SEE)) + "; each says more under \\-\\-help."]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[2] + ".part", "w", encoding="utf-8") as file:
        file.write(page(sys.argv[1]))
    os.replace(sys.argv[2] + ".part", sys.argv[2])


if __name__ == "__main__":
    main()
