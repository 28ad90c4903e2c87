# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user types: cards, doubts, forecasts, and that whatever `check` passes runs."""

import os
import pathlib
import re
import shutil
import subprocess
import time

import yaml

from faults_support import fault, scene
from scene_support import KRATER, ROOT, check, environment, krater, summary

CARDS = ROOT / "inputs" / "materials"


def local(name, old="", new=""):
    """The fault's input under a bare name in the current folder, edited."""
    text = scene(name).read_text(encoding="utf-8")
    assert old in text, old
    pathlib.Path("scene.yaml").write_text(text.replace(old, new, 1), encoding="utf-8")
    return "scene.yaml"


def both(what, code, expected, *arguments):
    """`check` and `run` give one answer: exit code, and text on stderr where it is refused."""
    for command in (("check",), ("run", "-o", "both", "-j", "1", "--quiet")):
        done = krater(command[0], arguments[0], *command[1:], *arguments[1:])
        text = done.stderr if code else ""
        check(done.returncode == code and re.search(expected, text), f"{command[0]}: {what}",
              f"{done.returncode} {done.stderr.strip()[:300]}")
    shutil.rmtree("both", ignore_errors=True)


@fault("05", "a measure named like a column of the history is refused by check, with its line")
def measure_name():
    both("a measure called kinetic_energy", 2, r"05.*:15: measures\.kinetic_energy.*rod_kinetic_energy", scene("05"))
    for name in ("time", "step", "dt", "mass", "momentum_z", "removed_mass", "wall_impulse_r", "contact_pairs"):
        both(name, 2, rf"scene\.yaml:15: measures\.{name}: the history has a column",
             local("05", "  kinetic_energy: {", f"  {name}: {{"))
    both("out of the history it may be called so", 0, "",
         local("05", "kind: kinetic_energy,", "kind: kinetic_energy, history: false,"))


@fault("time", "the keys of time and output: what check passes runs, what cannot run is refused by both")
def time_keys():
    def case(time_block, code, expected=""):
        both(time_block, code, expected, local("12", "{end: 2 us}", f"{{{time_block}}}"), "--set", "output.history=0",
             "--set", "time.end=0.2 us")

    case("end: 2 us, first_step: 1 s", 2, r"scene\.yaml:\d+: time: first_step.*stable step")
    case("end: 2 us, first_step: 1 us", 2, "first_step.*stable step")
    case("end: 2 us, min_step: 1 us", 2, "min_step.*stable step")
    case("end: 2 us, max_step: 1e-30", 2, "steps.*max_step")
    case("end: 2 us, cfl: 1e-30", 2, "steps.*cfl")
    case("end: 2 us, max_step: 1 ns, min_step: 2 ns", 2, "min_step is longer than max_step")
    case("end: 2 us, first_step: 1e-12, min_step: 1e-9", 0)
    case("end: 2 us, max_step: 1e300", 0)
    for key, value, code in (("frames", "1e-30", 2), ("frames", "1e-13", 2), ("frames", "-1", 2), ("frames", "1e300", 0),
                             ("history", "1e300", 0), ("history", "-1 us", 2), ("checkpoint", "1e300", 0)):
        both(f"output.{key}={value}", code, key if code else "", local("12"), "--set", "output.history=0", "--set",
             f"output.{key}={value}", "--set", "time.end=0.2 us")


@fault("07", "another damage law in a scene replaces the card's; the same law is laid over")
def damage_replaced():
    done = krater("run", scene("07"), "-o", "out", "-j", 1, "--quiet", "--set", "time.end=0.1 us")
    check(done.returncode == 0, "07: runs", done.stderr)
    text = pathlib.Path("out/resolved.yaml").read_text(encoding="utf-8")
    damage = yaml.safe_load(text)["materials"]["copper"]["damage"]
    check({*damage} - {"coupling", "degrade_pressure"} == {"maximum_plastic_strain"}, "07: its law alone", damage)
    # README's example: on every card with Johnson and Cook's fracture strain, under either name.
    for card in sorted(CARDS.glob("*.yaml")):
        if "johnson_cook" not in str(yaml.safe_load(card.read_text(encoding="utf-8")).get("damage")):
            continue
        own = yaml.safe_load(card.read_text(encoding="utf-8"))["damage"]
        law = next(iter(own))
        name = local("07", "maximum_plastic_strain: {eps_max: 1.5}", "johnson_cook: {D1: 0.1}")
        done = krater("run", name, "-o", card.stem, "--quiet", "--set", f"materials.copper.card={card.stem}", "--set",
                      "time.end=1e-9", env={"KRATER_CARDS": str(CARDS)})
        if not check(done.returncode == 0, f"07: D1 over {card.stem}", done.stderr):
            continue
        got = yaml.safe_load(pathlib.Path(card.stem, "resolved.yaml").read_text(encoding="utf-8"))
        got = got["materials"]["copper"]["damage"]["johnson_cook"]
        check(float(got["D1"]) == 0.1 and float(got["D2"]) == float(own[law]["D2"]), f"07: {card.stem} keeps D2", got)


@fault("blame", "one mistake is reported, not what follows from it")
def one_mistake():
    base = local("08", "card: ofhc_copper", "card: arne_tool_steel")
    for what, settings, count in (
            ("an unknown key elsewhere", ["grid.cel=1"], 1),
            ("a bad --set", ["time.end=1 kg"], 1),
            ("bad elastic constants", ["materials.copper.poisson_ratio=0.7"], 1),
            ("a body without a good name", ["bodies={a b: {material: copper, shape: {sphere: {radius: 5 mm, center: [0, 9 mm]}}}}",
                                            "measures={m: {kind: mass, body: a b}}"], 1),
            ("a measure without a kind", ["measures={m: {kind: masss, body: rod}}", "references={m: {value: 1}}"], 1)):
        done = krater("check", base, *[t for s in settings for t in ("--set", s)], env={"KRATER_CARDS": str(CARDS)})
        lines = done.stderr.strip().splitlines()
        check(done.returncode == 2 and len(lines) == count and "bulk_modulus" not in done.stderr, f"blame: {what}",
              done.stderr)


@fault("08", "cards are found beside the scene, above, in $KRATER_CARDS and where krater is installed")
def cards_found():
    nowhere = {"KRATER_CARDS": ""}
    name = local("08")
    os.makedirs("prefix/bin")
    shutil.copy2(KRATER, "prefix/bin/krater")  # a program that knows no tree
    alone = os.path.abspath("prefix/bin/krater")

    def ask(what, code, expected, scene_name=name, env=None, folder="."):
        done = subprocess.run([alone, "check", scene_name], capture_output=True, text=True, check=False, cwd=folder,
                              env=environment({**nowhere, **(env or {})}))
        check(done.returncode == code and re.search(expected, done.stdout + done.stderr), f"08: {what}", done.stderr)

    ask("a message says where it looked", 2, r"no card 'ofhc_copper'.*looked in.*KRATER_CARDS.*every folder above.*install")
    ask("$KRATER_CARDS", 0, f"card {CARDS}/ofhc_copper", env={"KRATER_CARDS": f"/nowhere:{CARDS}"})
    ask("near names", 2, "did you mean ofhc_copper", local("08", "card: ofhc_copper", "card: ofhc_coper"), {"KRATER_CARDS": str(CARDS)})
    local("08")
    shutil.copy2(CARDS / "ofhc_copper.yaml", "ofhc_copper.yaml")
    ask("beside the scene", 0, "card ./ofhc_copper.yaml")
    ask("by a bare file name", 0, "card", local("08", "card: ofhc_copper", "card: ofhc_copper.yaml"))
    local("08")
    os.remove("ofhc_copper.yaml")
    os.makedirs("inputs/materials")
    os.makedirs("one/two")
    shutil.copy2(CARDS / "ofhc_copper.yaml", "inputs/materials")
    shutil.copy2("scene.yaml", "one/two/scene.yaml")
    for spelling in ("scene.yaml", "./scene.yaml", os.path.abspath("one/two/scene.yaml")):
        ask(f"two folders above {spelling}", 0, "card", spelling, folder="one/two")
    shutil.rmtree("inputs")
    build = os.environ.get("KRATER_BUILD_DIR") or str(pathlib.Path(KRATER).resolve().parent)
    done = subprocess.run(["cmake", "--install", build, "--prefix", os.path.abspath("prefix")], capture_output=True,
                          text=True, check=False)
    check(done.returncode == 0, "08: cmake --install", done.stderr)
    ask("the installation", 0, r"card .*/prefix/share/krater/materials/ofhc_copper")
    shutil.move("prefix", "moved")
    alone = os.path.abspath("moved/bin/krater")
    ask("the installation, moved", 0, r"card .*/moved/share/krater/materials/ofhc_copper")
    shutil.copy2(ROOT / "inputs" / "points" / "copper_flow_curve.yaml", "curve.yaml")
    done = subprocess.run([alone, "point", "curve.yaml", "--quiet"], capture_output=True, text=True, check=False)
    check(done.returncode == 0, "08: krater point", done.stderr)
    check("ofhc_copper" in subprocess.run([alone, "models"], capture_output=True, text=True, check=False).stdout,
          "08: krater models lists cards")


@fault("11", "numbers of another unit system are doubted, each with the unit that was meant")
def magnitudes():
    def doubts(*settings, base=scene("11")):
        done = krater("check", base, *[t for s in settings for t in ("--set", s)])
        check(done.returncode == 0, f"11: check {settings}", done.stderr)
        return [line for line in done.stdout.splitlines() if line.startswith("doubt: ")]

    def doubted(expected, *settings, base=scene("11")):
        found = doubts(*settings, base=base)
        missing = [e for e in expected if not any(re.search(e, line) for line in found)]
        check(not missing, f"11: {settings or 'kg-mm-ms'}: {expected}", found)

    doubted(["density = 8.96e-06.*kg/mm\\^3 meant", "shear_modulus = 46 .*GPa meant", "A = 0.09 .*GPa", "B = 0.292 .*GPa"])
    si = ["materials.copper.density=8960", "materials.copper.shear_modulus=46 GPa", "materials.copper.strength.johnson_cook.A=90 MPa",
          "materials.copper.strength.johnson_cook.B=292 MPa"]
    found = [line for line in doubts(*si) if "spall" not in line]
    check(not found, "11: none in SI", found)
    copper, jc, eos = "materials.copper.", "materials.copper.strength.johnson_cook.", "materials.copper.eos.mie_gruneisen_shock."
    for expected, setting in (("rho0 c0\\^2 .* another unit", copper + "density=8.96"), ("density.*t/mm\\^3", copper + "density=8.96e-9"),
                              ("shear_modulus.*Mbar", copper + "shear_modulus=0.46"), ("A = 90 .*MPa", jc + "A=90"),
                              ("c0.*km/s", eos + "c0=3.94"), ("c0.*cm/us", eos + "c0=0.394"), ("c0.*mm/s", eos + "c0=3.94e6"),
                              ("initial_temperature.*degC", copper + "initial_temperature=20"),
                              ("S1", eos + "S1=148.9"), ("n = 31", jc + "n=31"),
                              ("spall_strength.*GPa", copper + "spall_strength=1.3"),
                              ("cp = 0.383.*J/\\(g K\\)", copper + "heating={plastic_work: {cp: 0.383}}"),
                              ("rod.*faster than any impact", "bodies.rod.velocity=[0, -190 km/s]"),
                              ("rod.*faster", "bodies.rod.velocity=[0, -299792458]"),
                              ("time.end = 80 s.*us meant", "time.end=80")):
        doubted([expected], *si, setting)
    done = local("11", "radius: 4 mm, height: 20 mm", "radius: 4, height: 25.4")
    doubted(["rod is 25.4 m long.*mm meant"], *si, "grid.box.max=[12, 30]", "grid.cell=0.5", base=done)
    doubted(["rod moves at 190 m/s.*wave speed"], base=scene("12"), *["output.history=0",
            "materials.steel.youngs_modulus=200", "bodies.rod.velocity=[0, -190]", "time.end=1e-6"])


@fault("16", "the forecast counts the steps that frames cut, their bytes and their seconds")
def estimate():
    def said(path, *settings):
        out = krater("check", path, *settings).stdout
        steps = re.search(r"estimate: (\d+) steps", out)
        size = re.search(r"([\d.]+) (MB|GB) of results", out)
        check(steps and size and not re.search(r"\d{6,} s\b", out), "16: an estimate in human figures", out)
        return int(steps[1]), float(size[1]) * (1 if size[2] == "MB" else 1000), out

    steps, megabytes, _ = said(scene("16"))
    check(2000 <= steps <= 2300, "16: steps", steps)
    check(65 < megabytes < 280, "16: MB of 136 in fact", megabytes)
    shorter = ("--set", "output.frames=20 ns")
    steps, megabytes, _ = said(scene("16"), *shorter)
    krater("run", scene("16"), "-o", "out", "-j", 1, "--quiet", *shorter)
    real = sum(f.stat().st_size for f in pathlib.Path("out").rglob("*") if f.is_file()) / 1e6
    check(steps / 2 < summary("out")["steps"] < 2 * steps, "16: steps as taken", (steps, summary("out")["steps"]))
    check(megabytes / 2 < real < 2 * megabytes, "16: MB as written", (megabytes, real))
    _, _, text = said(scene("16"), "--set", "time.end=1000 s", "--set", "output.frames=0")
    check(re.search(r"[\d.]+ (days|years|h) on one core", text), "16: long times in days", text)


@fault("b17", "what memory cannot hold is refused at once, with points and GB")
def memory():
    def limited(gigabytes, *arguments):
        start = time.monotonic()
        done = subprocess.run(["bash", "-c", f'ulimit -v {int(1e6 * gigabytes)}; exec "$@"', "-", KRATER, *map(str, arguments)],
                              capture_output=True, text=True, check=False, env=environment(), timeout=60)
        took = time.monotonic() - start
        check(done.returncode == 2 and took < 5 and re.search(r" points need [\d.]+ GB of memory, and [\d.]+ (MB|GB) are",
                                                              done.stderr),
              f"b17: {arguments[0]} under {gigabytes} GB", f"{done.returncode} in {took:.2f} s: {done.stderr}")

    for gigabytes in (1, 2, 3, 4, 8):
        limited(gigabytes, "check", scene("b17"))
    limited(3, "run", scene("b17"), "-o", "out")
    check(not os.path.exists("out"), "b17: nothing left behind")
    for frame, box in (("axisymmetric", "[10 mm, 30 mm]"), ("plane_strain", "[10 mm, 30 mm]"), ("3d", "[10 mm, 30 mm]")):
        limited(8, "check", scene("12"), "--set", f"frame={frame}", "--set", "grid.cell=1 um", "--set", "output.history=0",
                "--set", f"grid.box.max={box}")
    # Large, but not too large: checked without making its points, in little memory.
    start = time.monotonic()
    done = krater("check", scene("b17"), "--set", "grid.cell=6 mm")
    check(done.returncode == 0 and "points are not made" in done.stdout, "b17: a large scene is checked by a coarser one",
          f"{time.monotonic() - start:.1f} s {done.stderr}")


@fault("empty", "a shape that holds nothing is called empty, and says why")
def empty():
    def refused(shape, expected, frame="axisymmetric"):
        name = local("08", "{cylinder: {radius: 4 mm, height: 20 mm}}", shape)
        done = krater("check", name, "--set", f"frame={frame}", env={"KRATER_CARDS": str(CARDS)})
        check(done.returncode == 2 and re.search(expected, done.stderr) and re.search(r"scene\.yaml:\d+: bodies\.rod",
                                                                                       done.stderr),
              f"empty: {shape[:60]}", done.stderr)

    low, high = "{sphere: {radius: 2 mm, center: [0, 5 mm]}}", "{sphere: {radius: 2 mm, center: [0, 15 mm]}}"
    refused(f"{{intersection: [{low}, {high}]}}", "is empty: the shapes of its intersection do not overlap")
    refused(f"{{difference: [{low}, {{sphere: {{radius: 3 mm, center: [0, 5 mm]}}}}]}}", "is empty: .* leave nothing")
    refused(f"{{union: [{{intersection: [{low}, {high}]}}, {{intersection: [{low}, {high}]}}]}}", "is empty")
    refused("{union: []}", "at least|two|shapes")
    refused("{move: {by: [0, 1 m], shape: " + low + "}}", "lies outside the domain: it spans .*z = 1 to 1 m|outside the domain")
    refused("{sphere: {radius: 2 mm, center: [0, 9 mm, 5 mm]}}", "y = 0|axis", frame="plane_strain")
    refused("{box: {min: [1 mm, 1 mm], max: [1 mm, 5 mm]}}", "max must lie beyond min")
    refused("{cylinder: {radius: 0, height: 1 mm}}", "positive")
    refused("{tube: {inner_radius: 4 mm, outer_radius: 4 mm, height: 1 mm}}", "radius")
    refused("{cone: {radius: 0, top_radius: 0, height: 5 mm}}", "radii|empty")
    refused("{revolution: {polygon: [[0, 1 mm], [3 mm, 1 mm], [1 mm, 1 mm]]}}", "polygon|area|empty")
