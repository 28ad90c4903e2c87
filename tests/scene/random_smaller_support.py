# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a scene that went wrong smaller: leaves out whatever its fate does not need. Not a test.

One part at a time - a body, a side's condition, a load, a law's block, the method - and for good where the scene without it
still ends alike: the same class, and the same words but for numbers. Ends when nothing more can go.
"""

import copy
import re

OF_SCENE = ("loads", "body_force", "damping", "method")
OF_MATERIAL = ("damage", "failure", "spall", "heating", "viscosity")
OF_BODY = ("kinematics", "velocity")


def without_body(tree, name):
    out = copy.deepcopy(tree)
    out["materials"].pop(out["bodies"].pop(name)["material"])
    out["loads"] = {key: load for key, load in out.get("loads", {}).items() if load["body"] != name}
    out["grid"]["refine"] = [one for one in out["grid"].get("refine", []) if one.get("follow") != name]
    for tree_of, key in ((out, "loads"), (out["grid"], "refine")):
        if not tree_of[key]:
            del tree_of[key]
    return out


def without(tree, *path):
    out = copy.deepcopy(tree)
    inner = out
    for key in path[:-1]:
        inner = inner[key]
    del inner[path[-1]]
    return out


def candidates(tree):
    """Scenes with one thing less, and what that is."""
    for name in tree["bodies"]:
        if len(tree["bodies"]) > 1:
            yield f"body {name}", without_body(tree, name)
    for key in OF_SCENE:
        if key in tree:
            yield key, without(tree, key)
    for side, kind in tree["grid"]["boundary"].items():
        if kind != "axis":
            yield side, without(tree, "grid", "boundary", side)
    if "refine" in tree["grid"]:
        yield "grid.refine", without(tree, "grid", "refine")
    if "contact" in tree:
        yield "contact", without(tree, "contact")
    for family, keys in (("materials", OF_MATERIAL), ("bodies", OF_BODY)):
        for name, block in tree[family].items():
            for key in keys:
                if key in block:
                    yield f"{family}.{name}.{key}", without(tree, family, name, key)


def words(fate):
    """What was said, without its numbers and places."""
    return fate.kind, re.sub(r"[-+]?[0-9][-+0-9.e]*", "#", re.sub(r"^\S*\.yaml:\d+: ", "", fate.why))[:80]


def smaller(tree, fate_of):
    """(the scene with nothing left that its fate does not need, what went); `fate_of` runs a scene."""
    wanted, gone = words(fate_of(tree)), []
    tried = set()
    while True:
        for name, other in candidates(tree):
            if name in tried:
                continue
            if words(fate_of(other)) == wanted:
                tree = other
                gone.append(name)
                break
            tried.add(name)
        else:
            return tree, gone
