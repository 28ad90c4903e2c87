# SPDX-License-Identifier: GPL-3.0-or-later
"""The declarations of scenes are whole: every shipped scene and card fits the schema that is written from them, every
key says what it is, what the readers ask for is what is declared, and both refuse the same mistakes."""

import json
import pathlib
import re
import shutil

import jsonschema
import yaml
from scene_support import ROOT, TAYLOR, Folder, check, finish, krater


def schema(*of):
    done = krater("schema", *of)
    check(done.returncode == 0, f"krater schema {' '.join(of)}", done.stderr[:300])
    made = json.loads(done.stdout)
    jsonschema.Draft7Validator.check_schema(made)
    return made


def errors(made, value):
    found = []
    for error in jsonschema.Draft7Validator(made).iter_errors(value):
        while error.context:  # of the forms that a value may have, the one that came furthest
            error = max(error.context, key=lambda e: len(e.absolute_path))
        found.append(f"{'.'.join(map(str, error.absolute_path))}: {error.message[:150]}")
    return found


def read(path):
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def shipped_scenes(scene, point):
    files = sorted((ROOT / "inputs").rglob("*.yaml")) + sorted((ROOT / "validation").rglob("*.yaml"))
    count = {"scene": 0, "path": 0, "card": 0}
    card = {"allOf": [{"$ref": "#/definitions/material"}], "definitions": scene["definitions"]}
    for path in files:
        value = read(path)
        if not isinstance(value, dict):
            continue
        kind = "scene" if "bodies" in value and "frame" in value else "path" if "point" in value else \
            "card" if path.parent.name == "materials" else None
        if kind is None or (kind == "scene" and not {"grid", "time", "materials"} <= set(value)):
            continue  # studies
        made = {"scene": scene, "path": point, "card": card}[kind]
        wrong = errors(made, value)
        count[kind] += 1
        if wrong:
            check(False, f"{path.relative_to(ROOT)} fits the schema", "; ".join(wrong[:3]))
    check(count["scene"] >= 15 and count["path"] >= 5 and count["card"] >= 30, "scenes, paths and cards fit", str(count))


def everything_said(made):
    """A key or block without a meaning is a key nobody can look up."""
    silent, keys = [], 0
    for name, block in made["definitions"].items():
        if len(block.get("description", "")) < 3:
            silent.append(name)
        for key, info in block.get("properties", {}).items():
            keys += 1
            if not info.get("x-meaning", "").strip() or not info.get("x-takes") or not info.get("x-default"):
                silent.append(f"{name}.{key}")
    check(not silent and keys > 300, "every key says what it is, takes and is by default", f"{keys} keys; {silent[:5]}")


# Where a key is put that no block has, and the block: its answer lists the keys that the reader asked for.
ASKED = {"time.qqq": "time", "method.qqq": "method", "output.qqq": "output", "grid.qqq": "grid",
         "contact.qqq": "contact", "materials.copper.qqq": "material", "bodies.rod.qqq": "body",
         "bodies.rod.points.qqq": "points", "materials.copper.spall.qqq": "spall", "materials.copper.failure.qqq": "failure",
         "bodies.rod.shape.cylinder.qqq": "cylinder", "damping.qqq": "damping", "gauges.g.qqq": "gauge",
         "outcomes.o.qqq": "outcome"}
# Read only where another key calls for them, or by the search for cards.
ELSEWHERE = {"material": {"unsourced", "G", "K", "E", "nu"}}


def readers_ask(made):
    base = read(TAYLOR)
    base["contact"] = {}
    base["damping"] = {"mass": 1}
    base["materials"]["copper"].update(spall={"strength": "1 GPa"}, failure={"action": "remove"})
    base["bodies"]["rod"]["points"] = {}
    base["gauges"] = {"g": {"body": "rod", "from": [0, 0], "to": [0, 0.01], "count": 2, "fields": ["speed"]}}
    base["outcomes"] = {"o": {"projectile": "rod", "target": "rod"}}
    for path, block in ASKED.items():
        changed = json.loads(json.dumps(base))
        at = changed
        *steps, key = path.split(".")
        for step in steps:
            at = at[step]
        at[key] = 1
        pathlib.Path("asked.yaml").write_text(yaml.safe_dump(changed), encoding="utf-8")
        said = krater("check", "asked.yaml").stderr
        known = re.search(r"unknown key 'qqq' \((?:did you mean \w+\? )?known: ([^)]*)\)", said)
        asked = set(known[1].split(", ")) if known else set()
        declared = set(made["definitions"][block]["properties"]) - ELSEWHERE.get(block, set())
        check(asked == declared, f"{block}: the reader asks for the declared keys",
              f"only asked {sorted(asked - declared)}, only declared {sorted(declared - asked)} {'' if known else said[:200]}")


# A kind asks for one of these in its own way: what the reader is given, so that it goes on to the next key.
GIVEN = {"axis": "z", "by": "z_min", "at": {"z": 0.01}, "field": "pressure", "target": "wall", "face": "z_max"}


def kinds_ask(made):
    """Each kind of measure: the reader asks for the keys of its block, in 3d where a turn has an axis, and what is required is.""" 
    base = yaml.safe_load((ROOT / "inputs" / "ccf_plugging.yaml").read_text(encoding="utf-8"))
    base.pop("references", None)
    base.pop("outcomes", None)
    base.pop("gauges", None)
    body, other = list(base["bodies"])[:2]
    variants = [made["definitions"][one["$ref"].rpartition("/")[2]] for one in made["definitions"]["measure"]["anyOf"]]
    check(len(variants) > 25, "a block for each kind of measure", str(len(variants)))
    measures = {}
    for variant in variants:
        kind = variant["properties"]["kind"]["enum"][0]
        keys = {**GIVEN, "target": other, "by": other}
        measures[kind] = {"kind": kind, "body": body, **{key: keys[key] for key in variant["required"] if key in keys}, "qqq": 1}
    said = ""
    for first in range(0, len(measures), 8):  # krater lists the first problems only
        base["measures"] = dict(list(measures.items())[first:first + 8])
        pathlib.Path("kinds.yaml").write_text(yaml.safe_dump(base), encoding="utf-8")
        said += krater("check", "kinds.yaml", "--set", "frame=3d").stderr
    asked = {kind: set(known.split(", ")) for kind, known in
             re.findall(r"measures\.(\w+)\.qqq: unknown key 'qqq' \((?:did you mean \w+\? )?known: ([^)]*)\)", said)}
    for variant in variants:
        kind = variant["properties"]["kind"]["enum"][0]
        declared = set(variant["properties"])
        check(asked.get(kind) == declared, f"measure {kind}: the reader asks for the declared keys",
              f"asked {sorted(asked.get(kind, set()) - declared)}, declared {sorted(declared - asked.get(kind, set()))}")
    said = ""
    for first in range(0, len(measures), 8):
        base["measures"] = {kind: {"kind": kind, "body": body} for kind in list(measures)[first:first + 8]}
        pathlib.Path("kinds.yaml").write_text(yaml.safe_dump(base), encoding="utf-8")
        said += krater("check", "kinds.yaml", "--set", "frame=3d").stderr
    asked = {(kind, key) for kind, key in re.findall(r"measures\.(\w+): missing key '(\w+)'", said)}
    declared = {(variant["properties"]["kind"]["enum"][0], key) for variant in variants for key, info in variant["properties"].items()
                if key in set(variant["required"]) - {"kind", "body"} or "required in 3d" in info["x-default"]}
    check(asked == declared and len(asked) > 15, "what a kind requires is what the reader misses",
          f"only missed {sorted(asked - declared)}, only declared {sorted(declared - asked)}")
    missing = []
    for variant in variants:  # without each required key: refused by both
        kind = variant["properties"]["kind"]["enum"][0]
        for key in set(variant["required"]) - {"kind", "body"}:
            measure = {k: v for k, v in measures[kind].items() if k not in (key, "qqq")}
            changed = {**base, "measures": {kind: measure}}
            if not errors(made, changed):
                missing.append(f"{kind} without {key}")
    check(not missing, "a kind without what it requires is refused", missing)


MISTAKES = [("time", "ends", 1), ("method", "shape", "cubic"), ("grid", "cell", -1), ("grid", "cell", "fine"),
            ("output", "frames", [1]), ("bodies", "rod", {"material": "copper"}), ("method", "stagger", "perhaps"),
            ("measures", "m", {"kind": "mass", "body": "rod", "axis": "z"}), ("measures", "m", {"kind": "extent", "body": "rod"}),
           ("measures", "m", {"kind": "extent", "body": "rod", "axis": [1, 0, 1]}), ("references", "final_length", {"value": 1, "error": -1}),
           ("method", "points_per_direction", 9), ("bodies", "rod", {"material": "copper", "shape": {"cube": {}}})]


def same_refusals(made):
    base = read(TAYLOR)
    check(errors(made, base) == [], "the scene without mistakes fits")
    for block, key, value in MISTAKES:
        changed = json.loads(json.dumps(base))
        changed[block][key] = value
        pathlib.Path("wrong.yaml").write_text(yaml.safe_dump(changed), encoding="utf-8")
        both = (bool(errors(made, changed)), krater("check", "wrong.yaml").returncode == 2)
        check(both == (True, True), f"{block}.{key} = {value}: refused by the schema and by krater", str(both))


def main():
    with Folder():
        shutil.copytree(ROOT / "inputs" / "materials", "materials")
        scene, point = schema(), schema("point")
        check(schema("scene") == scene, "scene is the default")
        check(krater("schema", "qqq").returncode == 2, "another schema is refused")
        shipped_scenes(scene, point)
        everything_said(scene)
        everything_said({"definitions": {**scene["definitions"], **point["definitions"]}})
        readers_ask(scene)
        kinds_ask(scene)
        same_refusals(scene)
    finish()


if __name__ == "__main__":
    main()
