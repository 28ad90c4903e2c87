#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are nearly right are read or refused by name: surfaces and point files by the program, studies by their reader,
and, where tools/fuzz has been built (build-fuzz/: minutes and clang), some thousand of each under sanitizers."""

import pathlib
import random
import re
import subprocess
import sys

from scene_support import ODD, ROOT, Folder, check, command, environment, finish

sys.path.insert(0, str(ROOT / "tests" / "fuzz"))
from mutants import mutant  # noqa: E402

CORPUS = ROOT / "tests" / "data" / "fuzz"
SCENE = """
frame: 3d
grid: {{cell: 2 mm, box: {{min: [-20 mm, -20 mm, -20 mm], max: [20 mm, 20 mm, 20 mm]}}}}
time: {{end: 1 us}}
materials: {{steel: {{density: 7850, shear_modulus: 80 GPa, eos: {{linear: {{K: 160 GPa}}}}, strength: elastic}}}}
bodies: {{part: {{material: steel, thin: allowed, shape: {{surface: {{file: part.{ending}, unit: mm{repair}}}}}}}}}
"""
REPAIR = ", repair: {merge_vertices: 0.001 mm, drop_facets: true, orient: true, close_holes: 1 m}"
FILES_OF_A_KIND = 25


def ends_well(words, file, what, kept):
    """Exit code 0, or 2 and the file or scene is named; never a signal, nor a word of a broken program."""
    done = subprocess.run(command(*words), capture_output=True, text=True, timeout=60, env=environment(), check=False)
    said = done.stdout + done.stderr
    named = file in done.stderr or re.search(r"\.yaml:\d+: ", done.stderr)
    if done.returncode == 0 or (done.returncode == 2 and named and not ODD.search(said.replace(file, ""))):
        return True
    pathlib.Path(kept).write_bytes(pathlib.Path(file).read_bytes())
    return check(False, f"{what} ends well", f"exit {done.returncode}: {said[-400:]}; kept in {kept}")


def surfaces():
    for ending in ("stl", "off", "obj", "ply"):
        draw, texts = random.Random(ending), [path.read_bytes() for path in sorted((CORPUS / ending).iterdir())]
        for repair, name in ((REPAIR, "mended.yaml"), ("", "as_it_is.yaml")):
            pathlib.Path(name).write_text(SCENE.format(ending=ending, repair=repair), encoding="utf-8")
        good = 0
        for k in range(len(texts) + FILES_OF_A_KIND):
            data = texts[k] if k < len(texts) else mutant(draw, draw.choice(texts), texts)
            pathlib.Path(f"part.{ending}").write_bytes(data)
            scene = ("mended.yaml", "as_it_is.yaml")[k % 2]
            good += ends_well(["check", scene], f"part.{ending}", f"{ending} {k}", f"/tmp/krater_fuzz_{k}.{ending}")
        check(good == k + 1, f"{ending}: {good} of {k + 1} files are read or refused by name")


def points():
    draw = random.Random("point")
    texts = [path.read_bytes() for path in sorted((ROOT / "inputs" / "points").glob("*.yaml"))]
    good = 0
    for k in range(FILES_OF_A_KIND):
        pathlib.Path("point.yaml").write_bytes(mutant(draw, draw.choice(texts), texts))
        good += ends_well(["point", "point.yaml", "-o", "point.csv"], "point.yaml", f"point {k}",
                          f"/tmp/krater_fuzz_{k}.yaml")
    check(good == k + 1, f"point: {good} of {k + 1} files are run or refused by name")


def run(what, *words):
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    told = (done.stdout + done.stderr).strip().splitlines() or ["nothing said"]
    check(done.returncode == 0, what, "\n".join(told[-20:]) if done.returncode else told[-1])


with Folder():
    surfaces()
    points()
run("studies that failed once", "/usr/bin/python3", ROOT / "tests/fuzz/study_fuzz.py", "--replay")
run("studies", "/usr/bin/python3", ROOT / "tests/fuzz/study_fuzz.py", "--runs", "500")
programs = {"scene_fuzz": ["scene"], "point_fuzz": ["point"], "surface_fuzz": ["stl", "off", "obj", "ply"]}
for program, targets in programs.items():
    if (ROOT / "build-fuzz" / program).exists():
        run(program, ROOT / "tools/fuzz", *targets, "--runs", "1000", "--seconds", "20")
    else:
        print(f"skip  {program} has not been built (tools/fuzz --build {targets[0]})")
finish()
