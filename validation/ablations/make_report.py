#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the source's own choices move and cost: ablations of plugging (CCF 4.2) and of the impact at 6 km/s (CCF 4.3).

The studies are plugging.yaml and ccf_hypervelocity.yaml beside this file, for anybody to run. Writes README.md and two
pictures into its folder. `tools/validate ablations` builds first.
"""

import os
import shutil
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_runs import Study  # noqa: E402

ESTIMATED_SECONDS = 400  # on two quiet cores
STUDIES = {  # name: what is laid over every member
    "ccf_hypervelocity": ["output.frames=10 us"],
    "plugging": ["grid.cell=0.4 mm", "time.end=60 us", "output.frames=60 us"],
}


def answer(study, name, settings):
    """study.json of one ablation."""
    told, folder = study.ask(name, ["time.energy_error=off", *settings], [study.scene])
    if told:
        shutil.copyfile(os.path.join(folder, "pictures", "effects.png"), os.path.join(study.folder, name + ".png"))
    return told


def report(study, told):
    members = told["members"]
    base, data = members[0], told["answer"]
    names = list(data["changes_percent"])
    rows = [["as it is", *(f"{base[name]:.5g}" for name in names), f"{base['core_seconds']:.1f}", "", ""]]
    for member in members[1:]:
        effect = member["without"]
        cells = [data["changes_percent"][name].get(effect) for name in names]
        seconds = member["core_seconds"]
        rows.append([f"`{effect}`", *("-" if v is None else f"{v:+.2f}" for v in cells),
                     "-" if seconds is None else f"{seconds:.1f}",
                     "-" if member["steps"] is None else f"{100 * (member['steps'] / base['steps'] - 1):+.0f}",
                     data["verdicts"].get(effect, member["status"])])
    study.add(f"## {told['title']}",
              f"{base['points']:.0f} points, {base['steps']:.0f} steps, cell {1e3 * base['cell']:.4g} mm. First row: "
              f"the scene as it is, SI; the others: change in %.")
    study.add_table(["choice", *(name.replace("_", " ") for name in names), "core s", "steps %", "advice"], rows)
    study.add(*(line for line in told["sentences"] if line.startswith("Member")))


def main():
    study = Study(__file__, "inputs/ccf_plugging.yaml", ESTIMATED_SECONDS, __doc__)
    study.add("Each choice alone against the scene as it is: Johnson-Cook damage coupled to strength and tension "
              "(`coupling: effective`), Truesdell rate, alpha 1/2, viscosity. The studies are files of kind `ablation` "
              "([plugging](plugging.yaml), [ccf_hypervelocity](ccf_hypervelocity.yaml)); constants of the other damage "
              "laws are said there. Single runs: differences of cost of some per cent are noise.")
    told = {name: answer(study, name, settings) for name, settings in STUDIES.items()}
    verdicts = [word for one in told.values() if one for word in one["answer"]["verdicts"].values()]
    study.add(f"**{verdicts.count('could go')} of {len(verdicts)} choices could go**: they move no measure by 0.5 %.")
    with open(os.path.join(study.folder, "discussion.md"), encoding="utf-8") as file:
        study.add(file.read().strip())
    for name, one in told.items():
        if one:
            report(study, one)
            study.add(f"![{one['title']}]({name}.png)")
    study.write("The source's own choices: what each moves and costs")
    return 1 if study.failed else 0


if __name__ == "__main__":
    sys.exit(main())
