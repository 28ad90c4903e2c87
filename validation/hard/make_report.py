#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard cases, each a scene of cases/ that says what must hold; what they do, and what is missed.

Writes README.md and pictures into its folder. `tools/validate hard` builds first; `tools/hard NAME` runs one.
"""

import json
import os
import pathlib
import shutil
import sys
from concurrent.futures import ThreadPoolExecutor

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
import expectations  # noqa: E402
import hard_cases  # noqa: E402
import hard_invariance  # noqa: E402
from validate_impacts import discussion  # noqa: E402
from validate_runs import Run, Study, cards, digest  # noqa: E402

ESTIMATED_SECONDS = 1200  # on two quiet cores
ELSEWHERE = [
    ("cone's tip on the axis, at three cells", "tests/scene/faults, b05"), ("Whipple shield", "faults 02; validation/energy"),
    ("Noh, Sod, Sedov", "faults b10, sod, b11; validation/energy"), ("two spheres at 30 km/s", "fault b13"),
    ("gas at rest, detonation products in a tube", "faults 01, 09"), ("CFL 0.9 on all scenes of inputs/", "tests/scene/inputs_test.py"),
    ("cold matter, every side and corner", "faults walls-momentum, b06"), ("160 and 1000 bodies", "faults b07, b07-1000"),
    ("a flipped bit anywhere in a checkpoint", "fault b18"), ("kill -9, full disk, memory, one folder", "tests/scene/calamities_test.py"),
    ("oblique plates, Hertz, friction", "tests/verification/contact_test.cpp; validation/contact"),
    ("edges of levels", "validation/levels")]
PICTURES = [("bars", "4 km/s", "final_shape.png", "bars.png", "Two bars at 4 km/s after 14 us."),
            ("shear", "tflip", "final_shape.png", "shear.png", "The sheared layer at a shear of 20: plastic strain."),
            ("long_rod", "run", "final_shape.png", "long_rod.png", "The long rod at 60 degrees after 50 us."),
            ("verney", "16 cells", "final_shape.png", "verney.png", "Verney's shell after it has stopped.")]


def run_of(study, case, name):
    """A run and its verdict; the run is kept as long as program and scene are the same."""
    folder = pathlib.Path(study.folder, "runs_out", case.name, name or "run")
    stamp = folder / "ended.json"
    wanted = digest(study.krater, case.path, *cards()) + " " + " ".join(case.runs[name])
    kept = json.loads(stamp.read_text(encoding="utf-8")) if stamp.exists() else {}
    if kept.get("identity") != wanted:
        shutil.rmtree(folder, ignore_errors=True)
        ended = hard_cases.execute(study.krater, case, name, folder)
        print(f"  {case.name} {name}: {ended[2]:.1f} s", flush=True)
        folder.mkdir(parents=True, exist_ok=True)
        kept = {"identity": wanted, "ended": ended}
        stamp.write_text(json.dumps(kept), encoding="utf-8")
    return hard_cases.judged(case, name, folder, kept["ended"])


def told(outcome):
    """What is said of a run: its figures in the order of its scene."""
    return "; ".join([str(one) for one in outcome.verdict if one.name != "exit"] +
                     [f"{name} {expectations.show(value)}" for name, value in outcome.figures.items()])


def table_of_cases(study, outcomes):
    rows = []
    for one in outcomes:
        missed = [j.name for j in one.verdict if not j.held]
        rows.append([f"[{one.case.name}](cases/{one.case.name}.yaml)", one.run or "-", "**missed**" if missed else "holds",
                     ", ".join(missed) or "-", f"{one.seconds:.1f}"])
    study.add_table(["case", "run", "verdict", "what is missed", "s"], rows)


def misses_of(study, outcomes):
    lines = []
    for one in outcomes:
        for j in one.verdict:
            if j.held:
                continue
            reasons = one.case.expect.get("misses", {})
            why = reasons.get(j.name) or reasons.get(f"{one.run}: {j.name}") or "**not explained**"
            lines.append(f"- **{one.label()}**, {j}: {why}")
    study.add("## What is missed, and why", "\n".join(lines) or "Nothing.")


def details(study, outcomes):
    study.add("## Figures", "Of each run what its scene asks for, beside the band that it must lie in, and figures that are only "
              "told. energy_residual: account of the energy; energy_error: what is not physical of it; step_fall: steps of the worst "
              "twentieth of the run over those of the first; mirror_x: how far images are apart, in cells; density: least and "
              "greatest, of that at rest (tools/expectations.py).")
    study.add("\n".join(f"- {one.label()}: {told(one)}" for one in outcomes))


def looks(study):
    """Scenes of inputs/ seen otherwise."""
    rows = []
    for name in hard_invariance.SCENES:
        print(f"  seen otherwise: {name}", flush=True)
        found = hard_invariance.Look(study.krater, name, os.path.join(study.folder, "runs_out", "looks")).look()
        for _, label, cells, energy, bound, held, why in found:
            rows.append([name, label, "-" if cells is None else f"{cells:.1e}", "-" if energy is None else f"{energy:.1e}",
                         f"{bound:g}", why.replace("|", " ") or ("holds" if held else "**missed**")])
    study.add("## The same scene, seen otherwise", "Scenes of `inputs/`, shortened, and their images (`tools/hard --invariance` says "
              "how each is made): greatest distance of points in cells, difference of energies over the energy, and the bound on "
              "both.")
    study.add_table(["scene", "seen", "cells", "energy", "bound", "verdict"], rows)


def pictures(study):
    for case, run, name, target, text in PICTURES:
        folder = os.path.join(study.folder, "runs_out", case, run)
        if os.path.exists(os.path.join(folder, "summary.json")):
            study.picture(Run(folder), name, target)
            study.add(f"![{text}]({target})", text)


def main():
    study = Study(__file__, "inputs/taylor_copper.yaml", ESTIMATED_SECONDS, __doc__)
    jobs = [(case, name) for case in hard_cases.all_cases() for name in case.runs]
    with ThreadPoolExecutor(study.cores) as pool:
        outcomes = list(pool.map(lambda job: run_of(study, *job), jobs))
    held = sum(all(j.held for j in one.verdict) for one in outcomes)
    study.add("Each case is a scene in [cases/](cases) that says itself what must hold (`expect:`); `tools/hard NAME` runs and judges "
              "it again. Where a case fails the method is to be mended, not the case: what is not mended stands here as missed.")
    study.add_table(["", "runs"], [["of cases that are known to be hard", len(outcomes)], ["hold all that is asked", held],
                                   ["miss something", len(outcomes) - held]])
    table_of_cases(study, outcomes)
    misses_of(study, outcomes)
    looks(study)
    discussion(study)
    pictures(study)
    study.add("## Held elsewhere")
    study.add_table(["case", "by"], ELSEWHERE)
    details(study, outcomes)
    study.write("Hard cases")


main()
