# SPDX-License-Identifier: GPL-3.0-or-later
"""Cards: the finder, cards of LS-DYNA in the units asked for, what is wrong with them; friction of walls from the contact
block."""

import json
import pathlib
import shutil

import yaml
from scene_support import ROOT, Folder, check, finish, krater, run

# Steel as Büyük and others (2019) print it for LS-DYNA: g, cm, us, Mbar.
STEEL = """*KEYWORD
$ a comment
*MAT_JOHNSON_COOK_TITLE
Steel 1006
$#     mid        ro         g         e        pr       dtf        vp    rateop
        15     7.896     0.818         0       0.3         0         0         0
    0.0035   0.00275      0.36     0.022         1      1811       300         1
   4.62E-6    -0.015         2         0      0.05      3.44     -2.12     0.002
      0.61         0         0         0         0
*EOS_GRUNEISEN
        15    0.4568      1.49         0         0      2.17
         0
*END
"""
SIMPLE = "*MAT_098\n1, 7.85e-9, 210e3, .3, 0\n490, 383, .45, .0123, 1.5, , , 5e-4\n*EOS_GRUNEISEN\n1, 4.57e6, 1.49, 0, 0, 1.67\n"
BURN = ("*MAT_HIGH_EXPLOSIVE_BURN\n         1      1.63     0.693      0.21         0     0.108\n*EOS_JWL\n"
        "         1     3.712   0.03231      4.15      0.95       0.3      0.07       1.0\n")


def scene(card, **more):
    return {"frame": "axisymmetric", "grid": {"cell": "1 mm", "box": {"min": [0, 0], "max": ["9 mm", "12 mm"]},
                                              "boundary": {"z_min": "wall", "r_min": "axis"}},
            "time": {"end": "1 us"}, "materials": {"m": {"card": card, **more}},
            "bodies": {"b": {"material": "m", "shape": {"cylinder": {"radius": "4 mm", "height": "9 mm"}}}}}


def resolved(value):
    """The scene as krater resolves it, and what it said."""
    pathlib.Path("scene.yaml").write_text(yaml.safe_dump(value), encoding="utf-8")
    shutil.rmtree("out", ignore_errors=True)
    done = run("out", "time.end=1 ns", "time.max_step=1 ns", scene="scene.yaml")
    made = yaml.safe_load(pathlib.Path("out/resolved.yaml").read_text(encoding="utf-8")) if done.returncode == 0 else {}
    return made, done.text


def near(material, wanted):
    """Values of a resolved material by path, to 1e-9."""
    wrong = []
    for path, value in wanted.items():
        at = material
        for step in path.split("."):
            at = at.get(step, {}) if isinstance(at, dict) else {}
        if not isinstance(at, (int, float, str)) or abs(float(at) - value) > 1e-9 * abs(value):
            wrong.append(f"{path} {at}, not {value}")
    return "; ".join(wrong)


def keyword_cards():
    for name, text in (("steel.k", STEEL), ("simple.k", SIMPLE), ("tnt.k", BURN)):
        pathlib.Path(name).write_text(text, encoding="utf-8")
    for name, units, more, wanted in (
            ("steel.k", ["g", "cm", "us"], {"damage": "card", "spall_strength": "card"},
             {"density": 7896, "shear_modulus": 81.8e9, "strength.johnson_cook.A": 350e6, "strength.johnson_cook.B": 275e6,
              "strength.johnson_cook.n": 0.36, "strength.johnson_cook.epsdot0": 1e6, "strength.johnson_cook.T_melt": 1811,
              "heating.plastic_work.cp": 462, "eos.mie_gruneisen_shock.c0": 4568, "eos.mie_gruneisen_shock.gamma0": 2.17,
              "damage.johnson_cook.D3": -2.12, "damage.johnson_cook.D5": 0.61, "spall.strength": 1.5e9}),
            ("simple.k", ["ton", "mm", "s"], {},
             {"density": 7850, "shear_modulus": 210e9 / 2.6, "strength.johnson_cook.A": 490e6, "eos.mie_gruneisen_shock.c0": 4570,
              "strength.johnson_cook.epsdot0": 5e-4}),
            ("tnt.k", ["g", "cm", "us"], {},
             {"density": 1630, "eos.jwl_burn.A": 371.2e9, "eos.jwl_burn.E0": 7e9, "eos.jwl_burn.D": 6930,
              "eos.jwl_burn.p_CJ": 21e9, "eos.jwl_burn.bulk_modulus": 10.8e9})):
        value = scene({"keywords": {"file": name, "units": units}}, **more)
        if "tnt" in name:
            value["detonators"] = {"cap": {"point": [0, 0]}}
        made, said = resolved(value)
        wrong = near(made.get("materials", {}).get("m", {}), wanted)
        check(bool(made) and not wrong, f"{name} in {units}", wrong or said[-300:])
    made, said = resolved(scene({"keywords": {"file": "steel.k", "units": ["g", "cm", "us"]}}))
    check("damage" not in made.get("materials", {}).get("m", {"damage": 0}), "damage of a card waits to be asked for", said[-200:])


WRONG = [
    ("no units", {"file": "steel.k"}, "", "missing key 'units'"),
    ("two units", {"file": "steel.k", "units": ["g", "mm"]}, "", "mass, length and time"),
    ("not a mass", {"file": "steel.k", "units": ["mm", "mm", "ms"]}, "", "wrong dimension"),
    ("no file", {"file": "none.k", "units": ["g", "mm", "ms"]}, "", "no such file"),
    ("a keyword", {"file": "bad.k", "units": ["g", "mm", "ms"]}, STEEL.replace("*END", "*MAT_ELASTIC\n1\n"),
     "bad.k:13: the keyword '*MAT_ELASTIC' is not understood"),
    ("a parameter", {"file": "bad.k", "units": ["g", "mm", "ms"]}, STEEL.replace("     7.896", "      &rho"), "RO is no number"),
    ("a rate form", {"file": "bad.k", "units": ["g", "mm", "ms"]},
     STEEL.replace("0.3         0         0         0", "0.3         0         0         2"), "RATEOP = 2"),
    ("a curved Hugoniot", {"file": "bad.k", "units": ["g", "mm", "ms"]}, STEEL.replace("1.49         0", "1.49       0.2"),
     "S2 = 0.2"),
    ("a missing field", {"file": "bad.k", "units": ["g", "mm", "ms"]}, STEEL.replace("    0.0035", "          "), "A is missing"),
    ("two materials", {"file": "bad.k", "units": ["g", "mm", "ms"]}, STEEL + SIMPLE, "several materials"),
]


def wrong_cards():
    for what, keywords, text, expected in WRONG:
        if text:
            pathlib.Path("bad.k").write_text(text, encoding="utf-8")
        pathlib.Path("scene.yaml").write_text(yaml.safe_dump(scene({"keywords": keywords})), encoding="utf-8")
        done = krater("check", "scene.yaml")
        check(done.returncode == 2 and expected in done.stderr, f"keyword card: {what}", done.stderr[:250])


def finder():
    done = krater("models", "--cards", "steel")
    check(done.returncode == 0 and "s7_tool_steel" in done.stdout and "weldox_460e" in done.stdout
          and "ofhc_copper" not in done.stdout, "cards by a word of their comments", done.stdout[:200])
    for word, card in (("tillotson", "basalt_tillotson"), ("zerilli", "copper_za"), ("JWL", "comp_b")):
        done = krater("models", "--cards", word)
        check(card in done.stdout and f"laws: " in done.stdout, f"cards with {word}", done.stdout[:200])
    done = krater("models", "--cards", "unobtainium")
    check(done.returncode == 2 and "unobtainium" in done.stderr, "no card is an error", done.stderr[:150])


def every_card_runs():
    """A few steps with each new card: constants in range, and a law that computes."""
    for name in ("tnt", "comp_b", "aluminium_tillotson", "basalt_tillotson", "tungsten_tillotson", "copper_za", "iron_za"):
        value = scene(name)
        value["bodies"]["b"]["velocity"] = [0, "-50 m/s"]
        if name in ("tnt", "comp_b"):
            value["detonators"] = {"cap": {"point": [0, 0]}}
        pathlib.Path("scene.yaml").write_text(yaml.safe_dump(value), encoding="utf-8")
        shutil.rmtree("out", ignore_errors=True)
        done = run("out", scene="scene.yaml")
        error = json.loads(pathlib.Path("out/summary.json").read_text(encoding="utf-8"))["audit"]["energy_error_fraction"] \
            if done.returncode == 0 else None
        check(done.returncode == 0 and error < 0.1, f"card {name} runs", f"{error} {done.text[-200:]}")


def walls():
    value = scene("ofhc_copper")
    made, said = resolved({**value, "contact": {"walls": 0.2}})
    side = made.get("grid", {}).get("boundary", {}).get("z_min")
    check(side == {"wall": {"friction": 0.2}}, "contact.walls is the friction of a wall that names none", f"{side} {said[-200:]}")
    value["grid"]["boundary"]["z_min"] = {"wall": {"friction": 0.05}}
    side = resolved({**value, "contact": {"walls": 0.2}})[0].get("grid", {}).get("boundary", {}).get("z_min")
    check(side == {"wall": {"friction": 0.05}}, "a wall's own friction stands over it", str(side))
    value["grid"]["boundary"]["z_min"] = "open"
    made, said = resolved({**value, "contact": {"walls": 0.2}})
    check(not made and "no side of the domain is a wall" in said, "walls without a wall are an error", said[:200])


def main():
    with Folder():
        shutil.copytree(ROOT / "inputs" / "materials", "materials")
        keyword_cards()
        wrong_cards()
        finder()
        every_card_runs()
        walls()
    finish()


if __name__ == "__main__":
    main()
