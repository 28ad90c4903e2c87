#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mistakes of users: exit code 2, a message that names the place and a remedy, nothing left behind."""

import os
import pathlib
import re
import subprocess

from scene_support import KRATER, ROOT, TAYLOR, Folder, check, finish, krater, run

SHORT = ("--set", "time.end=0.2 us")


def refused(what, expected, *arguments, output="left_behind", env=None):
    """`expected`: regular expressions that the message must all contain."""
    extra = ("-o", output) if arguments and arguments[0] == "run" and output else ()
    before = set(os.listdir("."))
    done = krater(*arguments, *extra, env=env)
    missing = [e for e in expected if not re.search(e, done.stderr)]
    left = sorted(set(os.listdir(".")) - before)
    problems = ([f"exit code {done.returncode}"] if done.returncode != 2 else []) + \
               [f"no /{e}/" for e in missing] + ([f"left behind: {left}"] if left else []) + \
               (["text on stdout"] if done.stdout else [])
    check(not problems, what, f"{', '.join(problems)} {done.stderr.strip().splitlines()[:1]}")


def edited(name, old, new):
    text = TAYLOR.read_text(encoding="utf-8").replace("card: ofhc_copper ", f"card: {CARD} ")
    assert old in text, old
    pathlib.Path(name).write_text(text.replace(old, new, 1), encoding="utf-8")
    return name


def scenes():
    line = next(i for i, t in enumerate(TAYLOR.read_text(encoding="utf-8").splitlines(), 1) if "cell:" in t)
    refused("unknown key", [rf"a\.yaml:{line}: grid\.cel", "did you mean cell", "known:"], "run",
            edited("a.yaml", "cell: 0.381", "cel: 0.381"))
    refused("unknown unit", [rf"b\.yaml:{line}: grid\.cell", "parsec", "known"], "run",
            edited("b.yaml", "0.381 mm", "0.381 parsec"))
    refused("wrong kind of unit", [rf"c\.yaml:{line}: grid\.cell"], "run", edited("c.yaml", "0.381 mm", "0.381 kg"))
    refused("out of range", [rf"d\.yaml:{line}: grid\.cell", "positive"], "run", edited("d.yaml", "0.381 mm", "-1 mm"))
    refused("duplicate key", [r"e\.yaml:\d+: grid\.cell", "duplicate"], "run",
            edited("e.yaml", "  cell:", "  cell: 1 mm\n  cell:"))
    refused("missing key", ["missing key 'bodies'"], "run", edited("f.yaml", "bodies:", "bodiez:"))
    refused("unknown material", [r"g\.yaml:\d+: bodies\.rod\.material", "known:|copper"], "run",
            edited("g.yaml", "material: copper", "material: coper"))
    refused("unknown card", [r"h\.yaml:\d+: materials\.copper\.card", "nocard"], "run",
            edited("h.yaml", f"card: {CARD}", "card: nocard"))
    refused("not YAML", [r"i\.yaml:\d+", "not valid YAML"], "run", edited("i.yaml", "grid:", "grid: {["))
    refused("tab", [r"j\.yaml:\d+", "tab"], "run", edited("j.yaml", "  cell:", "\tcell:"))
    pathlib.Path("empty.yaml").write_text("", encoding="utf-8")
    refused("empty scene", ["empty.yaml: is empty"], "run", "empty.yaml")
    pathlib.Path("binary.yaml").write_bytes(bytes(range(256)))
    refused("binary scene", [r"binary\.yaml"], "run", "binary.yaml")
    refused("missing scene", [r"nowhere\.yaml: no such file"], "run", "nowhere.yaml")
    refused("folder as scene", ["is a folder"], "run", ".")
    refused("body outside of the box", [r"k\.yaml:\d+: bodies\.rod", "outside"], "run",
            edited("k.yaml", "height: 25.4 mm", "height: 25.4 mm, base: [0, 90 mm]"))
    refused("measure of a field that is not there", ["temperature"], "run", ROOT / "inputs" / "plate_impact.yaml", "--set",
            "measures.hot={kind: maximum, body: plate, field: temperature}")
    refused("a grid of too many points", ["grid.cell", "larger"], "run", TAYLOR, "--set", "grid.cell=0.1 um")


def overrides():
    refused("--set without =", ["--set grid.cell", "path=value"], "run", TAYLOR, "--set", "grid.cell")
    refused("--set without value", ["grid.cell"], "run", TAYLOR, "--set", "grid.cell=")
    refused("--set nothing", ["--set"], "run", TAYLOR, "--set", output=None)
    refused("--set unknown path", ["--set grid.cel=1", "did you mean cell"], "run", TAYLOR, "--set", "grid.cel=1")
    refused("--set unknown block", ["--set grit.cell=1", "grid"], "run", TAYLOR, "--set", "grit.cell=1")
    refused("--set unknown model", ["unknown model 'jonson_cook'", "did you mean johnson_cook"], "run", TAYLOR,
            "--set", "materials.copper.strength={jonson_cook: {A: 1}}")
    refused("--set frame", ["axisymetric", "did you mean axisymmetric"], "run", TAYLOR, "--set", "frame=axisymetric")
    refused("time.end=0", ["time.end", "positive"], "run", TAYLOR, "--set", "time.end=0")


def arguments():
    refused("-j 0", ["threads", "1"], "run", TAYLOR, "-j", "0")
    refused("-j many", ["threads"], "run", TAYLOR, "-j", "many")
    refused("no command", ["subcommand", "--help"])
    refused("unknown command", ["unknown command 'rum'", "known: run, check, point, models"], "rum", TAYLOR)
    refused("unknown option", ["--fast", "--help"], "run", TAYLOR, "--fast")
    refused("run without a scene", ["scene", "--help"], "run")
    refused("models: unknown law", ["no law 'jonson'", "johnson_cook"], "models", "jonson")
    refused("KRATER_ISA", ["KRATER_ISA=v9", "portable, v3, v4"], "run", TAYLOR, env={"KRATER_ISA": "v9"})


def outputs():
    pathlib.Path("a file").write_text("mine", encoding="utf-8")
    for place in ("/proc/nothing", "a file", "a file/below", "/sys"):
        done = krater("run", TAYLOR, "-o", place, *SHORT)
        check(done.returncode == 2 and place in done.stderr, f"unwritable output {place}", done.stderr.strip())
    check(pathlib.Path("a file").read_text(encoding="utf-8") == "mine", "the file in the way is untouched")


def restarts():
    done = run("short", "time.end=0.2 us")
    assert done.returncode == 0, done.stderr
    pathlib.Path("garbage.h5").write_bytes(os.urandom(5000))
    whole = pathlib.Path("short/checkpoint.h5").read_bytes()
    pathlib.Path("cut.h5").write_bytes(whole[: len(whole) // 2])
    flipped = bytearray(whole)
    for at in range(len(whole) // 2, len(whole) // 2 + 64):
        flipped[at] ^= 1
    pathlib.Path("flipped.h5").write_bytes(bytes(flipped))

    def restart(what, expected, checkpoint, *more, scene=TAYLOR):
        refused(f"restart: {what}", [re.escape(checkpoint), *expected], "run", scene, "--restart", checkpoint, *more)

    restart("no such file", ["No such file"], "nothing.h5")
    restart("a folder", ["not a plain file"], "short")
    restart("garbage", ["not a checkpoint"], "garbage.h5")
    restart("a file cut short", ["."], "cut.h5")
    restart("a damaged file", ["damaged"], "flipped.h5")
    restart("a frame", ["not a checkpoint"], "short/frames/000000.h5")
    restart("text", ["not a checkpoint"], "short/history.csv")
    other = ["another"]
    restart("another scene", other, "short/checkpoint.h5", scene=ROOT / "inputs" / "copper_bar.yaml")
    restart("another dimension", other, "short/checkpoint.h5", "--set", "frame=3d", "--quiet")
    restart("another frame", other, "short/checkpoint.h5", "--set", "frame=plane_strain")
    restart("another cell", other, "short/checkpoint.h5", "--set", "grid.cell=0.762 mm")
    restart("another method", other, "short/checkpoint.h5", "--set", "method.shape=gimp")
    done = krater("run", TAYLOR, "-o", "short", "--restart", "short/checkpoint.h5", "--set", "time.end=1 us", "--set",
                  "measures.top={kind: max, body: rod, axis: z}")
    check(done.returncode == 2 and "-o" in done.stderr, "restart with other measures into the old folder is refused",
          done.stderr.strip().splitlines()[-1])


def good():
    for words, expected in ((("--version",), r"^krater \d+\.\d+\.\d+ \("), (("--help",), "run.*check.*point.*models"),
                            (("run", "--help"), "--restart"), (("check", "--help"), "--set"), (("point", "--help"), "--set"),
                            (("models",), "johnson_cook.*mie_gruneisen_shock"), (("models", "--help"), "name"),
                            (("models", "johnson_cook"), r"A +\[Pa\].*T_melt"),
                            (("check", TAYLOR), "rod.*johnson_cook.*estimate")):
        done = krater(*words)
        check(done.returncode == 0 and re.search(expected, done.stdout, re.S) and not done.stderr
              and not re.search(r"\b(nan|inf)\b", done.stdout), "krater " + " ".join(map(str, words)))
    # cards that are generated from a strength have no name of their own
    laws = [line.split()[1] for line in krater("models").stdout.splitlines() if " {concrete: " not in line]
    for law in laws:
        done = krater("models", law)
        check(done.returncode == 0 and law in done.stdout, f"models {law}", f"{len(done.stdout.splitlines())} lines")
    done = subprocess.run(["bash", "-c", f"'{KRATER}' models > /dev/full"], capture_output=True, text=True, check=False)
    check(done.returncode != 0 and "standard output" in done.stderr, "models into a full disk says so")


CARD = ROOT / "inputs" / "materials" / "ofhc_copper.yaml"
with Folder():
    scenes()
    overrides()
    arguments()
    outputs()
    restarts()
    good()
finish()
