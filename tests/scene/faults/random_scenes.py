# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes made by chance (random_support.py) end well, or say why they do not."""

import yaml

from faults_support import fault
from random_runs_support import counts, fate_of, fate_of_scene, minimised, run_seeds
from random_smaller_support import words
from scene_support import check


def by_chance(seeds, sound, ended):
    """No scene breaks the program; of all at least `sound` keep their energy to 1 %, and `ended` get to their end."""
    fates = run_seeds(seeds, ".")
    for fate in fates:
        check(fate.kind != "broken", f"seed {fate.seed}: {fate.kind}", fate.why)
    share = [sum(fate.kind in kinds for fate in fates) / len(fates) for kinds in (("sound",), ("sound", "loose", "poor"))]
    check(share[0] >= sound and share[1] >= ended, f"{len(fates)} scenes", counts(fates))


@fault("random", "scenes made by chance from the whole catalogue run to their end with a sound ledger")
def twenty():
    by_chance(range(20), 0.5, 0.8)


@fault("random-smaller", "a scene that fails is made smaller and fails alike")
def made_smaller():
    seed = 5011  # a rigid body runs into a side; the third body has nothing to do with it
    first = fate_of(seed, ".")
    path, gone = minimised(seed, ".")
    tree = yaml.safe_load(path.read_text(encoding="utf-8"))
    last = fate_of_scene(seed, path, "small_out")
    check(first.kind == "failed" and words(last) == words(first), "fails alike", f"{first.why[:200]}; {last.why[:200]}")
    check(len(gone) >= 3 and list(tree["bodies"]) == ["b1", "b2"], "what it does not need is gone", f"{gone}, {list(tree['bodies'])}")


@fault("random-long", "200 of them", long=True)
def two_hundred():
    by_chance(range(1000, 1200), 0.5, 0.8)
