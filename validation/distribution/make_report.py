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

import h5py
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from validate_runs import ROOT, Study  # noqa: E402

ESTIMATED_SECONDS = 180  # on two quiet cores

ALONE = os.environ.get("KRATER", os.path.join(ROOT, "build", "krater"))
MANY = os.path.join(os.path.dirname(ALONE), "krater_on_ranks")
if not os.path.exists(MANY):
    MANY = ALONE
INPUTS = os.path.join(ROOT, "inputs")
# Shipped scenes of what ranks can do, coarse and short.
SCENES = {
    "taylor_copper": ["time.end=4 us", "output.frames=2 us"],
    "taylor_copper, 3d": ["frame=3d", "grid.cell=0.762 mm", "time.end=2 us", "output.frames=1 us"],
    "taylor_steel": ["time.end=4 us", "output.frames=2 us"],
    "plate_impact": ["method.grid_pressure=none", "time.end=0.4 us", "output.frames=0.2 us"],
    "ccf_plugging": ["grid.cell=1 mm", "time.end=20 us", "output.frames=10 us"],
    "ccf_two_bars": ["grid.cell=1.25 mm", "time.end=3 us", "output.frames=1.5 us"],
    "ccf_hypervelocity": ["grid.cell=1 mm", "time.end=1 us", "output.frames=0.5 us"],
    "hiermaier_al": ["grid.cell=1 mm", "time.end=2 us", "output.frames=1 us"],
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


class Runs:
    """Runs on several ranks; none is kept from an earlier report, for times are what they tell."""

    def __init__(self, folder):
        self.folder = os.path.join(folder, "runs_out", "ranks")
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)

    def run(self, name, scene, values, ranks=1, threads=1):
        out = os.path.join(self.folder, name)
        words = [ALONE if ranks == 1 else MANY, "run", os.path.join(INPUTS, scene + ".yaml"), "-o", out, "-j",
                 str(threads), "--quiet", *settings(values)]
        if ranks > 1:
            words = ["mpirun", "--oversubscribe", "--bind-to", "none", "-np", str(ranks), *words]
        environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                       "OMP_WAIT_POLICY": "passive"}
        done = subprocess.run(words, capture_output=True, text=True, env=environment, check=False)
        if done.returncode not in (0, 3):
            raise RuntimeError(f"{name}: {done.stderr[-500:]}")
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            return json.load(file)

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
        name = label.replace(", ", "_")
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
              f"**{count - different} of {count}** identical in every bit. Scenes of finer cells, elements, particles, rigid "
              "bodies, fluids on the grid and loads on faces are refused by name.")
    study.add_table(["scene", "points", "steps", *(f"{r} ranks x {t}" for r, t in RANKS)], rows)


def seconds(summary):
    """Of the steps alone."""
    return sum(summary["machine"]["seconds"].values())


def speed(study, runs):
    rows = []
    for cell, end in (("0.5 mm", "2 us"), ("0.254 mm", "0.6 us")):
        values = [*SPACE, f"grid.cell={cell}", f"time.end={end}"]
        times = {key: [] for key in ((1, 1), (2, 1), (1, 2))}
        for turn in range(PAIRS):
            for ranks, threads in times:
                s = runs.run(f"speed_{cell.split()[0]}_{ranks}x{threads}_{turn}", "taylor_copper", values, ranks, threads)
                times[ranks, threads].append((seconds(s), s))
        best = {key: statistics.median(t for t, _ in runs_) for key, runs_ in times.items()}
        s = times[2, 1][0][1]
        machine = s["machine"]
        rows.append([f"{s['points']}", f"{1e9 * best[1, 1] / s['points'] / s['steps']:.1f}",
                     f"{best[1, 1] / best[2, 1]:.2f}", f"{best[1, 1] / best[1, 2]:.2f}",
                     f"{100 * statistics.median(x[1]['machine']['seconds_in_messages'] / x[0] for x in times[2, 1]):.0f} %",
                     f"{machine['rank_bytes_sent'] / s['steps'] / 1e6:.2f}",
                     f"{machine['rank_messages'] / s['steps']:.1f}"])
    study.add("## Two ranks on two cores",
              f"3D Taylor rod, medians of {PAIRS} interleaved turns of the time in steps; beside them two threads of one process. "
              "`in messages`: the first rank's time in exchange and waiting, by that of its steps. 1.85 times was asked of two ranks.")
    study.add_table(["points", "ns per point-step, one rank", "two ranks: times as fast", "two threads: times as fast",
                     "in messages", "MB sent by the first rank and step", "messages"], rows)


def growth(study, runs):
    rows = []
    values = [*SPACE, "grid.cell=0.381 mm", "time.end=0.15 us"]
    for ranks in (1, 2, 4, 8, 16, 32):
        s = runs.run(f"growth_{ranks}", "taylor_copper", values, ranks)
        m, steps = s["machine"], s["steps"]
        rows.append([f"{ranks}", f"{s['points'] / ranks:.0f}", f"{m.get('rank_bytes_sent', 0) / steps / 1e6:.3f}",
                     f"{m.get('rank_messages', 0) / steps:.0f}", f"{m.get('imbalance', 1):.2f}",
                     f"{m.get('times_dealt_anew', 0)}", f"{m['peak_resident_bytes'] / 1e6:.0f}"])
    study.add("## What one rank sends, against their number",
              "The same scene on more and more ranks of these two cores: counts, not times. Messages include those that all ranks "
              "take part in. `imbalance`: the most that a rank has to do by measured time over the mean, which here says more of "
              "the crowd on two cores than of the blocks. Memory is that of the first rank, which holds all points at the start "
              "and when it writes.")
    study.add_table(["ranks", "points a rank", "MB sent and step", "messages and step", "imbalance", "dealt anew",
                     "peak memory, MB"], rows)


def main():
    study = Study(__file__, "inputs/taylor_copper.yaml", ESTIMATED_SECONDS, __doc__)
    runs = Runs(study.folder)
    bits(study, runs)
    speed(study, runs)
    growth(study, runs)
    study.write("Several processes on one scene")


if __name__ == "__main__":
    main()
