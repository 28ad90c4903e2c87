#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Speed: what a point-step costs, where its time goes, and beside what the machine can do.

Writes README.md into its folder from build/bench/bench.json; `tools/bench` measures the parts that are missing there
or are of another revision. `tools/validate speed` builds first.
"""

import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools"), str(pathlib.Path(__file__).resolve().parent)]
import users  # noqa: E402
from bench_suite import STAGES, SUITE  # noqa: E402
from validate_runs import Study  # noqa: E402

ESTIMATED_SECONDS = 1800  # on two quiet cores
SECONDS = {"scenes": 240, "memory": 200, "effects": 300, "alone": 300, "leavers": 60, "dormant": 30, "wait": 120,
           "small": 40, "cores": 40, "peers": 120, "inputs": 240, "instructions": 120}
RESULTS = pathlib.Path(os.environ.get("KRATER_BUILD_DIR", ROOT / "build")) / "bench" / "bench.json"


def read():
    return json.loads(RESULTS.read_text(encoding="utf-8"))["parts"] if RESULTS.exists() else {}


def measure(study):
    """Run what is missing, within the budget."""
    spent = 0

    def last_change(paths):
        return subprocess.run(["git", "-C", ROOT, "log", "-1", "--format=%h", "--", *paths], capture_output=True, text=True,
                              check=True).stdout.strip()

    step = last_change([f"{top}/{part}" for top in ("src", "include/krater") for part in ("core", "grid", "materials", "points",
                                                                                         "kinematics", "contact")])
    every = last_change(["src", "include"])
    for name in SUITE:
        part = read().get(name)
        revision = every if name in ("wait", "peers", "inputs") else step  # the others time steps alone
        if part and subprocess.run(["git", "-C", ROOT, "merge-base", "--is-ancestor", revision,
                                    part["machine"]["revision"].replace("-dirty", "")], check=False,
                                   capture_output=True).returncode == 0:
            continue  # measured with the present sources
        if spent + SECONDS[name] > study.budget:
            study.left_out.append(name)
            continue
        spent += SECONDS[name]
        subprocess.run([ROOT / "tools" / "bench", name], check=True, stdout=subprocess.DEVNULL)


def calibration(part):
    m, before, after = part["machine"], part["calibration"], part["calibration_after"]

    def pair(get, scale, digits):
        return " and ".join(f"{get(x) / scale:.{digits}f}" for x in (before, after))
    text = [f"clock {pair(lambda x: x['clock_hz'], 1e9, 2)} GHz"]
    text += [f"multiply-adds {level} {pair(lambda x, k=level: x['fma_flops'][k], 1e9, 0)} GFlop/s"
             for level in ("v4", "v3") if level in before["fma_flops"]]
    text += [f"triad on {n} thread(s) {pair(lambda x, k=n: x['triad_bytes_per_s'][k], 1e9, 1)} GB/s"
             for n in before["triad_bytes_per_s"]]
    return f"Measured {m['date']}, revision {m['revision']}, load {m['load']}; before and after: " + ", ".join(text) + "."


def stage_rows(part):
    rows = []
    for name, row in part["rows"].items():
        ns = row["ns"]
        total = ns["step"]
        rows.append([name, row["points"], f"{total:.1f}", f"{ns['cpu']:.1f}", *(f"{ns[k]:.1f}" for k in STAGES), f"{1e3 / total:.2f}",
                     f"{row['bytes_per_point']:.0f}"])
    return rows


TITLES = ["run", "points", "step", "cpu", *(k.replace("_", " ") for k in STAGES), "M point-steps/s", "bytes/point"]


def verdict(value, limit, more=False):
    return f"{value:.2f}, **{'met' if (value >= limit if more else value <= limit) else 'missed'}**"


def add_scenes(study, part):
    study.add("## Scenes", "ns per point and step; `cpu` of all threads together, which other programs on the machine "
              "do not lengthen as they do the others; `gather and stress` with all laws, `scatter` of both sweeps.",
              calibration(part))
    study.add_table(TITLES, stage_rows(part))
    for n, ns in part["probe"].items():
        cpu = part["probe_cpu"][n]
        study.add(f"Probe, {n} thread(s): {ns['step']:.1f} ns (scatter {ns['scatter']:.1f}, nodes {ns['nodes']:.1f}, gather "
                  f"and laws {ns['gather_and_stress']:.1f}), cpu {cpu['ns']:.1f} ns. Taylor 3d at {n} thread(s) reaches "
                  f"{cpu['share']:.2f} of it by cpu time (wall clock: {part['share_of_probe'][n]:.2f}; medians of "
                  f"interleaved pairs)" +
                  (f". Demanded 0.60, aim 0.75: **{'met' if cpu['share'] >= 0.6 else 'missed'}**." if n == "1" else "."))
    step = {name: row["ns"]["step"] for name, row in part["rows"].items()}
    cost = {name: row["ns"]["cpu"] for name, row in part["rows"].items()}
    if "2" in part["probe"]:
        ours = step["Taylor 3d, 1 thread"] / step["Taylor 3d, 2 threads"]
        theirs = part["probe"]["1"]["step"] / part["probe"]["2"]["step"]
        study.add(f"Two threads: {ours:.2f} times faster, the probe {theirs:.2f}, by wall clock; share (demanded 0.95): "
                  f"{verdict(ours / theirs, 0.95, True)}.")
    for frame in ("axisymmetric", "plane strain"):
        study.add(f"Taylor {frame} against 3d (demanded 2), cpu time: "
                  f"{verdict(cost['Taylor 3d, 1 thread'] / cost[f'Taylor {frame}, h/4, 1 thread'], 2, True)}.")
    row = part["rows"]["hypervelocity 3d, 1 thread"]
    study.add(f"Hypervelocity: {100 * row['change_cell']:.0f} % of the points change cell in a step, "
              f"{100 * row['change_block']:.0f} % block.")


def add_memory(study, part):
    small, large = part["rows"]["1e6"], part["rows"]["1e7"]
    study.add("## Memory", calibration(part))
    study.add_table(TITLES, stage_rows(part))
    study.add(f"1e7 against 1e6 points, cpu time per point-step (demanded at most 1.15): "
              f"{verdict(large['ns']['cpu'] / small['ns']['cpu'], 1.15)}. Bytes per point, everything the step holds "
              f"(demanded at most 400): {large['bytes_per_point']:.0f}; peak resident, start-up included: "
              f"{large['resident_bytes_per_point']:.0f}.")


def add_effects(study, part):
    study.add("## Effects", "The Taylor scene (3d, cell 2 h) with one effect removed or replaced at a time. Instructions (cell 3 h) per "
              "point-step of the AVX2 level by callgrind: no other user disturbs them.", calibration(part))
    full = part["rows"]["everything"]
    study.add_table(["scene", "cpu ns", "share", "instructions", "share", "record bytes/point"],
                    [[name, f"{r['ns']['cpu']:.1f}", f"{r['ns']['cpu'] / full['ns']['cpu']:.2f}", f"{r['instructions']:.0f}",
                      f"{r['instructions'] / full['instructions']:.2f}", f"{r['record_bytes']:.0f}"]
                     for name, r in part["rows"].items()])


def add_alone(study, part):
    study.add("## One law alone", "An elastic scene (3d, cell 2 h) in the program as it is, and in one that was built from the same "
              f"sources with that scene's two laws only: instructions per point-step {part['instructions_ratio']:.4f} times, "
              f"bytes of a point {part['bytes_ratio']:.4f} times as many (demanded within 1 %: **"
              f"{'met' if abs(part['instructions_ratio'] - 1) < 0.01 and part['bytes_ratio'] == 1 else 'missed'}**), the bits "
              f"{'the same' if part['same_bits'] else '**different**'}.")
    study.add_table(["program", "instructions (AVX2)", "record bytes/point", "bytes/point"],
                    [[name, f"{r['instructions']:.0f}", f"{r['record_bytes']:.0f}", f"{r['bytes_per_point']:.0f}"]
                     for name, r in part["rows"].items()])


def add_rest(study, parts):
    if "leavers" in parts:
        part = parts["leavers"]
        study.add("## Leavers", f"A block in uniform flight against the same block at rest (dormant blocks off), "
                  f"{100 * part['rows']['flow']['change_block']:.1f} % of the points leave their block in a step: "
                  f"{verdict(part['ratio'], 1.8)} times the cost (demanded at most 1.8).", calibration(part))
        study.add_table(TITLES, stage_rows(part))
    if "dormant" in parts:
        part = parts["dormant"]
        study.add("## Dormant blocks", f"A penetrator into a target 40 diameters wide, first quarter of the run: dormant "
                  f"blocks make it {verdict(part['ratio'], 3, True)} times faster (demanded 3), the bits are "
                  f"{'the same' if part['same_bits'] else '**different**'}.", calibration(part))
        study.add_table(TITLES, stage_rows(part))
    if "instructions" in parts:
        part = parts["instructions"]
        study.add("## Instructions", "Per point-step, AVX2 level, callgrind.", calibration(part))
        study.add_table(["scene", "instructions"], [[n, f"{r['instructions']:.0f}"] for n, r in part["rows"].items()])


def main():
    study = Study(__file__, "inputs/taylor_copper.yaml", ESTIMATED_SECONDS, __doc__)
    measure(study)
    parts = read()
    study.add("Made by `tools/bench`, which times single steps: medians over steps and over interleaved runs. Figures of a "
              "loaded machine move together; compare those of one section, and ratios. The triad is STREAM's, 24 bytes "
              "per element.")
    users.add_asked(study, parts)
    for name, add in (("scenes", add_scenes), ("memory", add_memory), ("effects", add_effects),
                      ("alone", add_alone)):
        if name in parts:
            add(study, parts[name])
    add_rest(study, parts)
    for name, add in (("wait", users.add_wait), ("small", users.add_small), ("cores", users.add_cores), ("peers", users.add_peers),
                      ("inputs", users.add_inputs)):
        if name in parts:
            add(study, parts[name], calibration(parts[name]))
    with open(os.path.join(study.folder, "discussion.md"), encoding="utf-8") as file:
        study.add(file.read().strip())
    study.write("Speed")


if __name__ == "__main__":
    main()
