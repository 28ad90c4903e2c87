# SPDX-License-Identifier: GPL-3.0-or-later
"""The developer's guide, followed to the letter: its blocks are applied to a copy of the sources, what they touch is
compiled and linked with the rest of this build, and its examples are run by that program, which must do what they say.

The rest is not compiled again (what it holds of the new things is nothing); `tools/manual --guide` builds the whole copy.
"""

import concurrent.futures
import csv
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from scene_support import KRATER, ROOT, Folder, check, environment, finish

sys.path.insert(0, str(ROOT / "tools"))
import guide_steps  # noqa: E402

BUILD = pathlib.Path(os.environ.get("KRATER_BUILD_DIR", pathlib.Path(KRATER).resolve().parent))
# Sources that hold what a header of the steps changes.
HOLD = {"include/krater/materials/law_list.hpp": ["src/materials/catalogue.cpp", "src/materials/stages_strength_hot.cpp",
                                                  "src/materials/stages_model_hot.cpp", "src/materials/stages_parts_hot.cpp"]}
NAMES = {"include/krater/contact/options.hpp": "pushes()"}  # ... or all that name this


def commands():
    """{source: command that compiles it for the portable level}."""
    found = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text(encoding="utf-8")):
        source = os.path.relpath(entry["file"], ROOT)
        if not source.endswith("_hot.cpp") or "KRATER_ISA=isa_portable" in entry["command"]:
            found[source] = entry["command"]
    return found


def sources(tree, touched):
    wanted = {path for path in touched if path.endswith(".cpp")}
    for header in touched:
        wanted |= set(HOLD.get(header, []))
        if header in NAMES:
            wanted |= {str(path.relative_to(tree)) for path in (tree / "src").rglob("*.cpp")
                       if NAMES[header] in path.read_text(encoding="utf-8")}
    return sorted(wanted)


def compiled(tree, source, command):
    """What the compiler said; the object lies beside the others."""
    words, made = [], tree / (source.replace("/", "_") + ".o")
    for word in shlex.split(command):
        word = re.sub(rf"^(-I)?{re.escape(str(ROOT))}/(src|include|tests)", rf"\g<1>{tree}/\2", word)
        words.append(str(made) if words and words[-1] == "-o" else word)
    done = subprocess.run([*words, "-O0", "-g0"], cwd=BUILD, capture_output=True, text=True, check=False,
                          env={**os.environ, "CCACHE_BASEDIR": str(tree), "CCACHE_NOHASHDIR": "1"})
    return made, "" if done.returncode == 0 else done.stderr[-2000:]


def link_command():
    if (BUILD / "build.ninja").is_file():
        told = subprocess.run(["ninja", "-t", "commands", "krater"], cwd=BUILD, capture_output=True, text=True, check=True).stdout
        line = told.splitlines()[-1]
    else:
        line = (BUILD / "CMakeFiles/krater.dir/link.txt").read_text(encoding="utf-8")
    return [word for word in shlex.split(line) if word not in (":", "&&")]


def linked(objects, program):
    words = link_command()
    words[words.index("-o") + 1] = str(program)
    library = next(k for k, word in enumerate(words) if word.endswith("libkrater_core.a"))
    words[library:library] = map(str, objects)  # before the library, whose own are then not taken
    done = subprocess.run(words, cwd=BUILD, capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stderr[-2000:]


def followed(folder):
    """The program after the steps, or None."""
    tree = folder / "tree"
    tree.mkdir()
    for part in ("include", "src", "tests"):
        shutil.copytree(ROOT / part, tree / part)
    try:
        touched = guide_steps.apply(tree)
    except guide_steps.Broken as error:
        check(False, "the steps can be followed", str(error))
        return None
    check(len(touched) >= 10, "the steps can be followed", f"{len(touched)} files")
    known, wanted = commands(), sources(tree, touched)
    check(all(source in known for source in wanted), "all is compiled by this build", ", ".join(set(wanted) - set(known)))
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        made = list(pool.map(lambda source: compiled(tree, source, known[source]), wanted))
    wrong = [text for _, text in made if text]
    program = folder / "krater"
    if not check(not wrong, f"{len(made)} sources compile", "\n".join(wrong)):
        return None
    objects = [path for path, _ in made if not path.name.startswith("tests_")]
    said = linked(objects, program)
    return program if check(not said, "the program is linked", said) else None


def ran(folder, program):
    (folder / "bin").mkdir()
    (folder / "bin/krater").symlink_to(program)
    for command in guide_steps.examples(ROOT, folder):
        done = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True, check=False,
                              env=environment({"PATH": f"{folder}/bin:{os.environ['PATH']}", "KRATER_ISA": "portable",
                                               "OMP_NUM_THREADS": "1"}))
        check(done.returncode == 0, command, (done.stdout + done.stderr)[-600:])
        yield command, done.stdout


def table(path):
    """Columns of a table by name."""
    with open(path, encoding="utf-8") as file:
        titles, *rows = list(csv.reader(file))
    numbers = [k for k, text in enumerate(rows[0]) if re.fullmatch(r"[-+\d.eE]+|nan", text)]
    return {titles[k].partition(" [")[0]: [float(row[k]) for row in rows] for k in numbers}


def law():
    path = table("swift_out/point.csv")
    pairs = [(eps, q) for eps, q in zip(path["plastic_strain"], path["von_mises"]) if eps > 0.01]
    off = max((abs(q / (600e6 * (0.01 + eps) ** 0.2) - 1) for eps, q in pairs), default=1)
    check(len(pairs) > 100 and off < 1e-9, "Swift's bar follows K (eps_0 + eps)^n", f"{off:.1e} at {len(pairs)} rows")


def model():
    path = table("brittle_out/point.csv")
    peak, last = min(path["pressure"]), {name: values[-1] for name, values in path.items()}
    check(-10e6 <= peak < -9.5e6 and path["failed"][0] == 0 and last["failed"] == 1, "the solid parts at its tension", f"{peak:.4g} Pa")
    pressed = max(path["pressure"])
    check(last["strain_xx"] < -0.0019 and abs(last["von_mises"] / (0.6 * last["pressure"]) - 1) < 1e-9 and pressed > 30e6,
          "and is rubble that bears pressure and friction", f"q {last['von_mises']:.4g}, p {last['pressure']:.4g} Pa")


def side_and_measure():
    told = json.loads(pathlib.Path("bonded_out/summary.json").read_text(encoding="utf-8"))
    value = {name: measure["value"] for name, measure in told["measures"].items()}
    mass = 2700 * 3.14159265358979 * 0.005 ** 2 * 0.02
    check(value["pull"] < -0.2 * mass * 5 and abs(value["momentum"] - 5 * mass - value["pull"]) < 1e-3 * 5 * mass,
          "the bonded wall pulls the rod, and what it gives is what the rod loses", f"{value['pull']:.4g} N s of {5 * mass:.4g}")
    rows = table("bonded_out/history.csv")
    time, speed = rows["time"], [p / mass for p in rows["momentum"]]
    moved = sum(0.5 * (speed[k] + speed[k - 1]) * (time[k] - time[k - 1]) for k in range(1, len(time)))
    flight = 5 * time[-1]
    check(abs(rows["centre"][0] - 0.01) < 1e-9 and abs(value["centre"] - 0.01 - moved) < 0.01 * flight and abs(moved) < 0.5 * flight,
          "the centre moves as its momentum says, and less than in flight", f"{value['centre'] - 0.01:.4g} m for {moved:.4g} m")
    audit = told["audit"]
    check(abs(audit["energy_residual"]) < 1e-9 * audit["initial_energy"], "the energy is closed",
          f"{audit['energy_residual']:.1e} J of {audit['initial_energy']:.3g}")
    checked = subprocess.run(["bin/krater", "check", "bonded.yaml", "--set", "measures.centre.axis=null"], capture_output=True,
                             text=True, check=False)
    check(checked.returncode == 2 and "measures.centre" in checked.stderr, "the new kind's key is asked for", checked.stderr[:200])


def main():
    if "-fsanitize" in (BUILD / "compile_commands.json").read_text(encoding="utf-8"):
        print("skipped: sanitizers take minutes per file")
        sys.exit(77)
    with Folder() as folder:
        program = followed(folder)
        if program is not None:
            told = dict(ran(folder, program))
            check("Swift" in told["krater models swift"], "the catalogue knows the law")
            law()
            model()
            side_and_measure()
    finish()


if __name__ == "__main__":
    main()
