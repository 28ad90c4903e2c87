#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Several processes on one scene: the bits of one, what they send, how evenly they are loaded, what they win.

Writes README.md into its folder. Needs `krater_on_ranks` beside krater, or a krater built with KRATER_MPI
(tools/setup --mpi), and mpirun. Times want a quiet machine.
"""

import json
import os
import shutil
import statistics
import subprocess
import sys
import time

import h5py
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_runs import ROOT, Study  # noqa: E402

ESTIMATED_SECONDS = 600  # on two quiet cores

ALONE = os.environ.get("KRATER", os.path.join(ROOT, "build", "krater"))
MANY = os.path.join(os.path.dirname(ALONE), "krater_on_ranks")
if not os.path.exists(MANY):
    MANY = ALONE
INPUTS = os.path.join(ROOT, "inputs")
# Shipped scenes of material points, coarse and short; elements and particles are refused by name.
SCENES = {
    "taylor_copper": ["time.end=4 us", "output.frames=2 us"],
    "taylor_copper, 3d": ["frame=3d", "grid.cell=0.762 mm", "time.end=2 us", "output.frames=1 us"],
    "taylor_copper, xpic": ["time.end=4 us", "output.frames=2 us", "method.transfer=xpic"],
    "taylor_copper, initial": ["time.end=4 us", "output.frames=2 us", "method.reference=initial"],
    "taylor_steel": ["time.end=4 us", "output.frames=2 us"],
    "plate_impact": ["time.end=0.4 us", "output.frames=0.2 us"],
    "copper_spall": ["grid.cell=0.04 mm", "grid.box.max=[0.08 mm, 6 mm]", "time.end=0.6 us", "output.frames=0.3 us"],
    "cylinder_test": ["time.end=4 us", "output.frames=2 us"],
    "ccf_plugging": ["grid.cell=1 mm", "time.end=20 us", "output.frames=10 us"],
    "ccf_two_bars": ["grid.cell=1.25 mm", "time.end=3 us", "output.frames=1.5 us"],
    "ccf_hypervelocity": ["grid.cell=1 mm", "time.end=1 us", "output.frames=0.5 us"],
    "hiermaier_al": ["grid.cell=1 mm", "time.end=2 us", "output.frames=1 us"],
    "hypervelocity/crater": ["grid.cell=1 mm", "time.end=2 us", "output.frames=1 us"],
    "hypervelocity/hole": ["grid.cell=1 mm", "time.end=2 us", "output.frames=1 us"],
    "ogive_layered_plate": ["grid.cell=2 mm", "time.end=4 us", "output.frames=2 us"],
    "snl/penetration": ["grid.cell=50.8 mm", "time.end=0.4 ms", "output.frames=0.2 ms"],
    "snl/slab": ["time.end=20 us", "output.frames=10 us"],
    "snl/tilted": ["grid.cell=101.6 mm", "time.end=0.1 ms", "output.frames=0.1 ms"],
    "spear_plate": ["grid.cell=3.5 mm", "time.end=5 us", "output.frames=5 us"],
    "two_discs": ["time.end=0.3 s", "output.frames=0.15 s"],
    "copper_bar": ["time.end=2 us", "output.frames=1 us"],
    "bar_pulled_apart": ["time.end=2 us", "output.frames=1 us"],
}
RANKS = ((2, 1), (3, 1), (3, 2), (5, 1), (7, 1))
SPACE = ["frame=3d", "output={frames: 80 us, history: 80 us}"]
PAIRS = 5


def settings(values):
    return [word for value in values for word in ("--set", value)]


def peak_memory(output):
    """Of the processes that compute into a folder, by their number [bytes]."""
    found = {}
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/cmdline", "rb") as file:
                words = file.read().split(b"\0")
            if output.encode() not in words or b"krater" not in os.path.basename(words[0]):
                continue
            with open(f"/proc/{pid}/status", encoding="utf-8") as file:
                line = next(line for line in file if line.startswith("VmHWM:"))
            found[pid] = 1024 * int(line.split()[1])
        except (OSError, StopIteration):
            continue
    return found


class Runs:
    """Runs on several ranks; none is kept from an earlier report, for times are what they tell."""

    def __init__(self, folder):
        self.folder = os.path.join(folder, "runs_out", "ranks")
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)

    def run(self, name, scene, values, ranks=1, threads=1, watch=False):
        """Its summary; with `watch` also the peak memory of each process that computes [bytes]."""
        out = os.path.join(self.folder, name)
        path = scene if os.path.exists(scene) else os.path.join(INPUTS, scene + ".yaml")
        words = [ALONE if ranks == 1 else MANY, "run", path, "-o", out, "-j",
                 str(threads), "--quiet", *settings(values)]
        if ranks > 1:
            words = ["mpirun", "--oversubscribe", "--bind-to", "none", "-np", str(ranks), *words]
        environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                       "OMP_WAIT_POLICY": "passive"}
        with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=environment) as job:
            peaks = {}
            while watch and job.poll() is None:
                peaks.update(peak_memory(out))
                time.sleep(0.5)
            errors = job.communicate()[1]
        if job.returncode not in (0, 3):
            raise RuntimeError(f"{name}: {errors[-500:]}")
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        return (summary, sorted(peaks.values())) if watch else summary

    def plain(self):
        """Taylor's rod without its measures, for which all points would come to the first rank."""
        path = os.path.join(self.folder, "plain.yaml")
        with open(os.path.join(INPUTS, "taylor_copper.yaml"), encoding="utf-8") as file:
            text = file.read()
        with open(path, "w", encoding="utf-8") as file:
            file.write(text[:text.index("\nmeasures:") + 1])
        return path

    def content(self, name):
        """Every number of frames and history, and the summary but for machine and words of the program."""
        out = {}
        for file in ("frames.h5", "history.h5"):
            with h5py.File(os.path.join(self.folder, name, file)) as h5:
                h5.visititems(lambda path, item, file=file: out.__setitem__((file, path), np.asarray(item[()]).tobytes())
                              if isinstance(item, h5py.Dataset) else None)
        with open(os.path.join(self.folder, name, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        out["summary"] = json.dumps({k: v for k, v in summary.items() if k not in ("machine", "program", "effects")},
                                    sort_keys=True)
        return out


def bits(study, runs):
    rows, different = [], 0
    for label, values in SCENES.items():
        scene = label.split(",")[0]
        name = label.replace(", ", "_").replace("/", "_")
        one = runs.run(f"{name}_1", scene, values)
        row = [label, f"{one['points']}", f"{one['steps']}"]
        expected = runs.content(f"{name}_1")
        for ranks, threads in RANKS:
            other = f"{name}_{ranks}x{threads}"
            runs.run(other, scene, values, ranks, threads)
            found = runs.content(other)
            wrong = sum(1 for k in expected.keys() | found.keys() if expected.get(k) != found.get(k))
            different += wrong > 0
            row.append("same" if wrong == 0 else f"{wrong} differ")
        rows.append(row)
    count = len(SCENES) * len(RANKS)
    study.add("## The bits of one rank",
              f"Shipped scenes, shortened; frames, history and summary (machine apart) beside those of one process: "
              f"**{count - different} of {count}** identical in every bit. Among them are finer cells that points come into, "
              "rigid bodies, fluids whose pressure the grid integrates, loads on faces, detonation, concrete, filtered transfer and a "
              "reference configuration that stays. Elements, particles and contact on a fixed reference are refused by name.")
    study.add_table(["scene", "points", "steps", *(f"{r} ranks x {t}" for r, t in RANKS)], rows)


def seconds(summary):
    """Of the steps alone."""
    return sum(summary["machine"]["seconds"].values())


def speed(study, runs):
    """Returns seconds a point and step of one rank, of the finest of the rods."""
    rows = []
    for cell, end in (("0.5 mm", "2 us"), ("0.254 mm", "0.6 us"), ("0.21 mm", "0.3 us")):
        values = [*SPACE, f"grid.cell={cell}", f"time.end={end}"]
        times = {key: [] for key in ((1, 1), (2, 1), (1, 2))}
        for turn in range(PAIRS):
            for ranks, threads in times:
                s = runs.run(f"speed_{cell.split()[0]}_{ranks}x{threads}_{turn}", "taylor_copper", values, ranks, threads)
                times[ranks, threads].append((seconds(s), s))
        median = {key: statistics.median(t for t, _ in runs_) for key, runs_ in times.items()}
        gains = [one[0] / two[0] for one, two in zip(times[1, 1], times[2, 1])]
        s = times[2, 1][0][1]
        machine = s["machine"]
        point_step = median[1, 1] / s["points"] / s["steps"]
        rows.append([f"{s['points']}", f"{1e9 * point_step:.1f}",
                     f"{median[1, 1] / median[2, 1]:.2f}", f"{min(gains):.2f} to {max(gains):.2f}",
                     f"{median[1, 1] / median[1, 2]:.2f}",
                     f"{100 * statistics.median(x[1]['machine']['seconds_in_messages'] / x[0] for x in times[2, 1]):.0f} %",
                     f"{machine['rank_bytes_sent'] / s['steps'] / 1e6:.2f}",
                     f"{machine['rank_messages'] / s['steps']:.1f}"])
    study.add("## Two ranks on two cores",
              f"3D Taylor rod, medians of {PAIRS} interleaved turns of the time in steps; beside them two threads of one process. "
              "`in messages`: the first rank's time in exchange and waiting, by that of its steps. 1.85 times was asked of two ranks.")
    study.add_table(["points", "ns per point-step, one rank", "two ranks: times as fast", "in single turns",
                     "two threads: times as fast", "in messages", "MB sent by the first rank and step", "messages"], rows)
    return point_step


def growth(study, runs):
    rows = []
    values = [*SPACE, "grid.cell=0.381 mm", "time.end=0.15 us"]
    for ranks in (1, 2, 4, 8, 16, 32, 64):
        s, peaks = runs.run(f"growth_{ranks}", runs.plain(), values, ranks, watch=True)
        m, steps = s["machine"], s["steps"]
        rows.append([f"{ranks}", f"{s['points'] / ranks:.0f}", f"{m.get('rank_bytes_sent', 0) / steps / 1e6:.3f}",
                     f"{m.get('rank_messages', 0) / steps:.0f}", f"{m.get('imbalance', 1):.2f}",
                     f"{m.get('times_dealt_anew', 0)}", *(f"{p / 1e6:.0f}" for p in (peaks[0], peaks[-1]))])
    study.add("## What one rank sends, against their number",
              "The same scene on more and more ranks of these two cores: counts, not times. Messages include those that all ranks "
              "take part in. `imbalance`: the most that a rank has to do by measured time over the mean, which here says more of "
              "the crowd on two cores than of the blocks.")
    study.add_table(["ranks", "points a rank", "MB sent and step", "messages and step", "imbalance", "dealt anew",
                     "peak memory of a rank, least, MB", "most, MB"], rows)


def large(study, runs):
    """No rank holds all points: memory of each, on two ranks."""
    values = [*SPACE, "grid.cell=0.0772 mm", "time.end=0.01 us",
              "output={frames: 0.01 us, history: 0.01 us, fields: [pressure]}"]
    s, peaks = runs.run("large", runs.plain(), values, 2, watch=True)
    m = s["machine"]
    study.add("## Many points",
              f"**{s['points']:,} points** of the same rod on two ranks, {s['steps']} steps, with a frame at either end, rows of the "
              f"history and a checkpoint, no measures: the most that the ranks held was {peaks[0] / 1e9:.1f} and "
              f"{peaks[-1] / 1e9:.1f} GB, {sum(peaks) / s['points']:.0f} bytes a point of the scene in all. A step took "
              f"{seconds(s) / s['steps']:.1f} s ({1e9 * seconds(s) * 2 / s['points'] / s['steps']:.0f} ns a point and core), "
              f"{100 * m['seconds_in_messages'] / m['wall_seconds']:.0f} % of the whole run was in messages, waiting for the "
              "first rank to write included. Making the points, each rank walks through the whole lattice for a moment.")


def model(study, point_step):
    """Weak and strong scaling by counts and assumed networks."""
    latency, bandwidth, threads = 2e-6, 10e9, 16
    tile, found, block_points, collectives = 216 * 64.0, 224.0, 512.0, 10

    def step(points, cores):
        ranks = max(1, cores / threads)
        blocks = points / block_points / ranks
        side = blocks ** (1 / 3)
        border = min((side + 4) ** 3 - side ** 3, 26 * blocks) if ranks > 1 else 0  # two blocks all around
        work = point_step * points / cores
        again = 0.25 * border * block_points * point_step / threads  # nodes of the border: a quarter of what points cost
        tiles = border * tile / bandwidth + 26 * latency
        tell = points / block_points * found / bandwidth + collectives * latency * np.log2(max(2, ranks))
        walk = points / block_points * 40e-9  # over all patches, in each of a step's loops
        return work + (again + tiles + tell + walk if ranks > 1 else 0)

    rows = []
    for points in (1e8, 1e9):
        for cores in (16, 256, 1024, 4096, 10000):
            seconds_ = step(points, cores)
            rows.append([f"{points:.0e}", f"{cores}", f"{1e3 * seconds_:.1f}",
                         f"{100 * point_step * points / cores / seconds_:.0f} %"])
    study.add("## A model of larger machines",
              f"By the point-step above ({1e9 * point_step:.0f} ns a core), two blocks of border around a cube of blocks with 512 points "
              f"each, {tile / 1000:.1f} kB a tile, {found:.0f} bytes a patch to all, {collectives} collectives; assumed: "
              f"{1e6 * latency:.0f} us latency, {bandwidth / 1e9:.0f} GB/s a rank, {threads} threads a rank that share its work evenly, "
              "messages that do not overlap work. None of it is measured but the point-step. What bends the curve is not the border but "
              "that every rank hears of all patches: beyond some hundred ranks results would have to be added up before they are told.")
    study.add_table(["points", "cores", "ms a step", "of the ideal"], rows)


def main():
    study = Study(__file__, "inputs/taylor_copper.yaml", ESTIMATED_SECONDS, __doc__)
    runs = Runs(study.folder)
    bits(study, runs)
    point_step = speed(study, runs)
    growth(study, runs)
    large(study, runs)
    model(study, point_step)
    study.write("Several processes on one scene")


if __name__ == "__main__":
    main()
