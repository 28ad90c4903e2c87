# SPDX-License-Identifier: GPL-3.0-or-later
"""What `tools/bench` measures on whole steps: each function takes a Bench and returns plain data for bench.json.

Figures are ns per point and step, of single steps (krater_bench_steps): no start-up, no output. Runs that are compared
are interleaved, and medians over the repetitions are taken; compare ratios, for the machine has other users.
"""

import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import tempfile

import bench_scenes as scenes
import bench_users as users

ROOT = pathlib.Path(__file__).resolve().parents[1]
PROBE = pathlib.Path(os.environ.get("KRATER_PROBE", ROOT.parent / "shared" / "probe" / "step3d.cpp"))
STAGES = ("scatter", "nodes", "contact", "boundary", "gather_and_stress", "migrate")


# The probe's clock becomes that of its own CPU time, so that other programs do not lengthen its loops.
CPU_CLOCK = """#include <chrono>
#include <ctime>
namespace std::chrono {
struct cpu_clock {
  using duration = nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<cpu_clock>;
  static constexpr bool is_steady = true;
  static time_point now() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return time_point(seconds(t.tv_sec) + nanoseconds(t.tv_nsec));
  }
};
}
#define steady_clock cpu_clock
"""


class Bench:
    """Programs, a folder for scenes, and how often things are repeated."""

    def __init__(self, build, repetitions):
        self.steps_program = build("krater_bench_steps")
        self.machine_program = build("krater_bench_machine")
        self.krater = build("krater")
        self.repetitions = repetitions
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="krater_bench_"))
        self.probe, self.probe_cpu = self.build_probe("probe"), self.build_probe("probe_cpu", CPU_CLOCK)

    def close(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def build_probe(self, name, header=""):
        """The stand-alone prototype that the project measures itself by, where its source and AVX-512 are. With
        `header` before its first line."""
        flags = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
        if not PROBE.exists() or "avx512dq" not in flags:
            return None
        program, before = self.folder / name, self.folder / f"{name}.hpp"
        before.write_text(header, encoding="utf-8")
        done = subprocess.run(["g++", "-std=c++20", "-O3", "-march=x86-64-v4", "-mprefer-vector-width=512", "-include",
                               before, PROBE, "-o", program, "-lmvec", "-lm", "-lpthread"], check=False,
                              capture_output=True)
        return program if done.returncode == 0 else None

    def calibrate(self):
        return json.loads(subprocess.run([self.machine_program], capture_output=True, text=True, check=True).stdout)

    def scene(self, text):
        path = self.folder / f"scene_{abs(hash(text)):x}.yaml"
        path.write_text(text, encoding="utf-8")
        return path

    def command(self, text, steps, warm, threads, flow=False):
        return [self.steps_program, self.scene(text), "--steps", str(steps), "--warm", str(warm), "--threads",
                str(threads)] + ([] if flow else ["--no-flow"])

    def steps(self, text, steps=30, warm=10, threads=1, flow=False):
        done = subprocess.run(self.command(text, steps, warm, threads, flow), capture_output=True, text=True, check=False)
        if done.returncode:
            raise SystemExit(f"tools/bench: {done.stderr.strip()}")
        return json.loads(done.stdout)

    def run_probe(self, threads, program=None):
        """ns per point and step of its three loops. The naive loops after them are not waited for."""
        environment = dict(os.environ, NOQ="1")
        with subprocess.Popen(["stdbuf", "-oL", program or self.probe, "16", "2", str(threads)], stdout=subprocess.PIPE, text=True,
                              env=environment) as process:
            lines = [process.stdout.readline() for _ in range(2)]
            process.terminate()
        words = re.findall(r"([0-9.]+) ns", lines[1])
        return {"scatter": float(words[0]), "nodes": float(words[1]), "gather_and_stress": float(words[2]),
                "step": sum(float(w) for w in words[:3])}

    def interleaved(self, jobs):
        """{name: function} -> {name: [results]}: all once, then all again."""
        results = {name: [] for name in jobs}
        for _ in range(self.repetitions):
            for name, job in jobs.items():
                results[name].append(job())
        return results


def times(results, kind="median"):
    """Median over repetitions of the median (or mean) over steps, per stage [ns per point and step]."""
    keys = [k for k in (*STAGES, "step", "cpu") if k in results[0]["ns"]]
    return {k: statistics.median(r["ns"][k][kind] for r in results) for k in keys}


def entry(results, kind="median"):
    """One row of the table."""
    first = results[0]
    ns = times(results, kind)
    if len({r["hash"] for r in results}) != 1:
        raise SystemExit("tools/bench: repetitions of one run gave different bits")
    return {"points": first["points"], "threads": first["threads"], "steps": first["timed"],
            "instruction_set": first["instruction_set"], "patches": first["patches"], "asleep": first["asleep"],
            "bytes_per_point": first["bytes_per_point"], "record_bytes": first["record_bytes"], "hash": first["hash"],
            "resident_bytes_per_point": first["resident_bytes_per_point"], "ns": ns,
            "million_point_steps_per_s": 1e3 / ns["step"], "change_cell": first["change_cell"],
            "change_block": first["change_block"]}


SCENES = {  # name: (scene, steps, warm-up, flow is watched)
    "Taylor 3d": (scenes.taylor("3d"), 30, 10, False),
    "Taylor axisymmetric, h/4": (scenes.taylor("axisymmetric", scenes.H / 4), 120, 20, False),
    "Taylor plane strain, h/4": (scenes.taylor("plane_strain", scenes.H / 4), 120, 20, False),
    "hypervelocity 3d": (scenes.hypervelocity(), 30, 40, True),
    "wide target": (scenes.wide_target(), 120, 40, False),
    "elastic 3d": (scenes.elastic("3d"), 30, 10, False),
    "Taylor 3d, elements": (scenes.taylor("3d", kinematics="lagrangian_mesh"), 100, 10, False),
    "Taylor axisymmetric, h/4, elements":
        (scenes.taylor("axisymmetric", scenes.H / 4, kinematics="lagrangian_mesh"), 120, 20, False),
    "Taylor 3d, a quarter, particles": (scenes.taylor("3d", kinematics="sph", quarter=True), 20, 5, False),
}


def scene_suite(bench):
    """Every scene on one and two threads, the probe beside them."""
    threads = [1, 2] if (os.cpu_count() or 1) > 1 else [1]
    jobs = {}
    for n in threads:
        for name, (text, steps, warm, flow) in SCENES.items():
            jobs[name, n] = lambda text=text, steps=steps, warm=warm, n=n, flow=flow: bench.steps(
                text, steps, warm, n, flow)
        if bench.probe:
            jobs["probe", n] = lambda n=n: bench.run_probe(n)
            jobs["probe cpu", n] = lambda n=n: bench.run_probe(n, bench.probe_cpu)
    results = bench.interleaved(jobs)
    rows = {f"{name}, {n} thread{'s' if n > 1 else ''}": entry(r)
            for (name, n), r in results.items() if not name.startswith("probe")}
    probe = {str(n): {k: statistics.median(x[k] for x in r) for k in r[0]}
             for (name, n), r in results.items() if name == "probe"}
    ratios = {str(n): statistics.median(p["step"] / k["ns"]["step"]["median"] for p, k in
                                        zip(results["probe", n], results["Taylor 3d", n]))
              for n in threads if ("probe", n) in results}
    cpu = {str(n): {"ns": statistics.median(p["step"] for p in results["probe cpu", n]),
                    "share": statistics.median(p["step"] / k["ns"]["cpu"]["median"] for p, k in
                                               zip(results["probe cpu", n], results["Taylor 3d", n]))}
           for n in threads if ("probe cpu", n) in results}
    return {"rows": rows, "probe": probe, "share_of_probe": ratios, "probe_cpu": cpu}


def memory(bench):
    """1e6 against 1e7 points of the Taylor rod."""
    sizes = {"1e6": scenes.H * (168692 / 1e6) ** (1 / 3), "1e7": scenes.H * (168692 / 1e7) ** (1 / 3)}
    jobs = {name: lambda cell=cell: bench.steps(scenes.taylor("3d", cell), 3, 2) for name, cell in sizes.items()}
    return {"rows": {name: entry(r) for name, r in bench.interleaved(jobs).items()}}


def count_instructions(bench, text, few=2, many=6, warm=2):
    """Instructions per point-step on the AVX2 level (valgrind knows no AVX-512), by the difference of two lengths."""
    counts = []
    for steps in (few, many):
        done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
                               *bench.command(text, steps, warm, 1)], capture_output=True, text=True, check=False,
                              env=dict(os.environ, KRATER_ISA="v3", OMP_WAIT_POLICY="passive"))
        found = re.search(r"Collected : (\d+)", done.stderr)
        if done.returncode or not found:
            raise SystemExit(f"tools/bench: valgrind failed: {done.stderr.strip()[-300:]}")
        counts.append(int(found.group(1)))
    points = json.loads(done.stdout)["points"]
    return (counts[1] - counts[0]) / (points * (many - few))


def instructions(bench):
    """The regression test of speed that no neighbour on the machine disturbs."""
    cases = {"Taylor 3d": scenes.taylor("3d", 2 * scenes.H),
             "Taylor axisymmetric": scenes.taylor("axisymmetric", scenes.H / 2),
             "Taylor plane strain": scenes.taylor("plane_strain", scenes.H / 2),
             "elastic 3d": scenes.elastic("3d", 2 * scenes.H)}
    return {"rows": {name: {"instructions": count_instructions(bench, text)} for name, text in cases.items()}}


def build_alone(bench, laws):
    """krater_bench_steps of a copy of the sources whose list of laws holds only `laws`."""
    copy = bench.folder / "alone"
    copy.mkdir()
    shutil.copy(ROOT / "CMakeLists.txt", copy)
    for name in ("include", "src", "tests", "tools"):
        shutil.copytree(ROOT / name, copy / name)
    header = copy / "include" / "krater" / "materials" / "law_list.hpp"
    text, found = re.subn(r"using AllLaws = LawList<.*?>;", f"using AllLaws = LawList<{', '.join(laws)}>;",
                          header.read_text(encoding="utf-8"), flags=re.DOTALL)
    if found != 1:
        raise SystemExit(f"tools/bench: no list of laws in {header}")
    header.write_text(text, encoding="utf-8")
    for command in (["cmake", "-S", copy, "-B", copy / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"],
                    ["ninja", "-C", copy / "build", "krater_bench_steps"]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise SystemExit(f"tools/bench: {(done.stdout + done.stderr)[-2000:]}")
    return copy / "build" / "krater_bench_steps"


def alone(bench):
    """What the presence of all other laws costs an elastic scene: against a program that has its two laws only."""
    every, only = bench.steps_program, build_alone(bench, ["Elastic", "LinearEos"])
    rows = {}
    for name, program in (("every law in the program", every), ("elastic and linear alone", only)):
        bench.steps_program = program
        rows[name] = dict(entry([bench.steps(scenes.elastic("3d", 2 * scenes.H))]),
                          instructions=count_instructions(bench, scenes.elastic("3d", 2 * scenes.H)))
    bench.steps_program = every
    first, second = rows.values()
    return {"rows": rows, "instructions_ratio": first["instructions"] / second["instructions"],
            "bytes_ratio": first["record_bytes"] / second["record_bytes"], "same_bits": first["hash"] == second["hash"]}


def effect_scenes(cell):
    rods = {name: scenes.taylor("3d", cell, **change) for name, change in scenes.EFFECTS.items()}
    return {**rods, "one effect: elastic rod": scenes.elastic("3d", cell)}


def effects(bench):
    """The Taylor scene without each of its effects."""
    texts, smaller = effect_scenes(2 * scenes.H), effect_scenes(3 * scenes.H)
    timed = bench.interleaved({name: lambda text=text: bench.steps(text, 60, 20) for name, text in texts.items()})
    return {"rows": {name: dict(entry(timed[name]), instructions=count_instructions(bench, smaller[name]))
                     for name in texts}}


def leavers(bench):
    """A uniform flow against the same block at rest, dormant blocks off; means, for migration comes in bursts."""
    jobs = {"at rest": lambda: bench.steps(scenes.flow(0), 30, 40),
            "flow": lambda: bench.steps(scenes.flow(6000), 30, 40, flow=True)}
    results = bench.interleaved(jobs)
    ratio = statistics.median(f["ns"]["step"]["mean"] / r["ns"]["step"]["mean"]
                              for r, f in zip(results["at rest"], results["flow"]))
    return {"rows": {name: entry(r, "mean") for name, r in results.items()}, "ratio": ratio}


def dormant(bench):
    """First quarter of a wide target's run, blocks at rest passed over or not: time and bits."""
    quarter = 10e-6
    results = {}
    for name, on in (("dormant", True), ("awake", False)):
        text = scenes.wide_target(on).replace("end: 40 us", f"end: {quarter!r}")
        results[name] = bench.steps(text, 1000000, 0)
    rows = {name: entry([r], "mean") for name, r in results.items()}
    same = results["dormant"]["hash"] == results["awake"]["hash"]
    return {"rows": rows, "ratio": rows["awake"]["ns"]["step"] / rows["dormant"]["ns"]["step"], "same_bits": same}


SUITE = {"scenes": scene_suite, "memory": memory, "effects": effects, "alone": alone, "leavers": leavers, "dormant": dormant,
         "wait": users.wait, "small": users.small, "cores": users.cores, "peers": users.peers,
         "inputs": users.inputs, "instructions": instructions}
