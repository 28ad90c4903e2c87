#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Error against cost on nine problems: settings that nothing beats, that lose everywhere, what 5, 2, 1 % cost.

The studies (kind `pareto`) lie beside this file. Writes README.md and fronts.png into its folder. `tools/validate
fronts` builds first.
"""

import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_runs import Study  # noqa: E402

ESTIMATED_SECONDS = 420  # on two quiet cores
PROBLEMS = ("taylor_copper", "copper_bar", "plate_impact", "two_bars", "taylor_kinematics", "bars_kinematics",
            "plugging", "spear", "hiermaier")
COLUMNS = 3  # of the picture
CELL = "grid.cell"


def settings_of(told, label):
    """{path: value} of a member."""
    member = next(m for m in told["members"] if m["member"] == label)
    return dict(text.split("=", 1) for text in member["settings"])


def short(path, value):
    """A setting as a table tells it: of kinematics the body, and in one word what becomes of its elements."""
    parts = path.split(".")
    if parts[-1] != "kinematics":
        return f"{parts[-1]} {value}"
    if "lagrangian_mesh" not in value:
        return f"{parts[-2]} of {'particles' if 'sph' in value else 'points'}"
    how = [word for word in ("erode", "convert", "viscous", "initial") if word in value]
    return f"{parts[-2]} of elements" + (f" ({', '.join(how)})" if how else "")


def varied(told, label):
    return ", ".join(short(path, value) for path, value in settings_of(told, label).items())


def prices(study, told):
    """What an error costs, and by which settings."""
    rows = []
    for name, cloud in told["answer"]["measures"].items():
        cells = [name.replace("_", " ")]
        cells += ["-" if found is None else f"{found[0]:.2g} s: {varied(told, found[1])}" for found in cloud["prices"].values()]
        rows.append(cells)
    study.add(f"### {told['title']}",
              f"{len(told['members'])} members. Core-seconds of the cheapest setting that is as "
              "near, with all finer cells:")
    study.add_table(["measure", *(f"{target} %" for target in cloud["prices"])], rows)
    study.add(*(line for line in told["sentences"] if line.startswith("Member")))


def wins(told):
    """{(path, value): (members on a front, members)} over all measures."""
    count = {}
    for cloud in told["answer"]["measures"].values():
        for i, label in enumerate(cloud["labels"]):
            for setting in settings_of(told, label).items():
                on, all_of = count.get(setting, (0, 0))
                count[setting] = (on + (i in cloud["front"]), all_of + 1)
    return count


def dominated(study, all_told):
    """Settings that stand on no front of their problem."""
    rows, never = [], []
    for told in all_told:
        for (path, value), (on, all_of) in wins(told).items():
            if path == CELL:
                continue
            rows.append([told["title"], short(path, value), f"{on} of {all_of}"])
            if on == 0:
                never.append(f"{short(path, value)} ({told['title']})")
    study.add("## On how many fronts",
              "Members with a setting that no other member beats in both error and cost, over all measures.")
    study.add_table(["problem", "setting", "on a front"], rows)
    study.add("On none: " + ("; ".join(never) if never else "there is no such setting") + ".")


def draw(path, all_told):
    lines = -(-len(all_told) // COLUMNS)
    figure, grid = plt.subplots(lines, COLUMNS, figsize=(4 * COLUMNS, 3.4 * lines), squeeze=False)
    for ax in grid.ravel()[len(all_told):]:
        ax.set_axis_off()
    for ax, told in zip(grid.ravel(), all_told):
        for k, (name, cloud) in enumerate(told["answer"]["measures"].items()):
            ax.loglog(cloud["cost"], [max(e, 1e-3) for e in cloud["error"]], ".", ms=5, alpha=0.45, color=f"C{k}")
            front = sorted(cloud["front"], key=lambda i: cloud["cost"][i])
            ax.loglog([cloud["cost"][i] for i in front], [max(cloud["error"][i], 1e-3) for i in front], "-o", ms=3,
                      lw=1, color=f"C{k}", label=name.replace("_", " "))
        ax.set_title(told["title"], fontsize=8)
        ax.set_xlabel("core-seconds")
        ax.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        ax.xaxis.set_major_formatter(FormatStrFormatter("%g"))
        ax.xaxis.set_minor_formatter(NullFormatter())
        ax.legend(fontsize=6, frameon=False)
    for line in grid:
        line[0].set_ylabel("error [%]")
    figure.tight_layout()
    figure.savefig(path, dpi=160)


def main():
    study = Study(__file__, "inputs/taylor_copper.yaml", ESTIMATED_SECONDS, __doc__)
    all_told = [told for name in PROBLEMS if (told := study.ask(name, ["time.energy_error=off"])[0])]
    if not all_told:
        sys.exit(f"fronts: no study ran: {study.failed}")
    study.add("Error against a known answer, and cost, of every combination of some settings: "
              + ", ".join(f"[{name}]({name}.yaml)" for name in PROBLEMS) + ", to be run by anybody with `krater "
              "study`. Start of the program and output are part of the cost: nothing falls below about 0.1 s. Errors "
              "below what the truth is known to count as no better than that.", "![fronts](fronts.png)")
    with open(os.path.join(study.folder, "discussion.md"), encoding="utf-8") as file:
        study.add(file.read().strip())
    study.add("## What an error costs")
    for told in all_told:
        prices(study, told)
    dominated(study, all_told)
    draw(os.path.join(study.folder, "fronts.png"), all_told)
    study.write("Error against cost: the fronts")
    return 1 if study.failed else 0


if __name__ == "__main__":
    sys.exit(main())
