# SPDX-License-Identifier: GPL-3.0-or-later
"""Results, restarts, warnings, and the tools that read them."""

import pathlib
import random
import re
import subprocess

import h5py
import numpy as np
import yaml

from faults_support import fault, scene
from scene_support import (ROOT, check, command, environment, history, krater, results_errors, run, settings,
                           summary)

LEAVES = ["time.end=6 us", "grid.cell=0.762 mm", "grid.box={min: [0, 0], max: [6 mm, 26 mm]}",
          "bodies.rod.velocity=[0, 300 m/s]"]  # through the open upper side


@fault("warnings", "a run that ends with warnings says so, lists them, and is exit 5 under --strict")
def warnings():
    done = run("lax", *LEAVES, extra=["--quiet"])
    check(done.returncode == 0 and done.stderr.count("krater: warning: ") == 1, "warned, exit 0, also when quiet",
          f"{done.returncode}: {done.stderr}")
    listed = summary("lax")["warnings"]
    check([w["kind"] for w in listed] == ["points_left"], "summary.json lists it", listed)
    check(listed[0]["count"] == summary("lax")["audit"]["events"]["removed_points"] and 0 < listed[0]["first_time"] < 6e-6,
          "with its count and first time", listed[0])
    done = run("strict", *LEAVES, extra=["--strict"])
    lines = [line for line in done.stderr.splitlines() if "points left the domain" in line]
    check(done.returncode == 5 and len(lines) == 2, "--strict: exit 5; said when met and at the end",
          f"{done.returncode}: {done.stderr}")
    done = run("clean", "time.end=1 us", extra=["--strict"])
    check(done.returncode == 0 and summary("clean")["warnings"] == [], "--strict without warnings: exit 0",
          done.stderr)


def times_of(folder):
    with h5py.File(f"{folder}/frames.h5", "r") as file:
        return np.array([file["frames"][name].attrs["time"] for name in sorted(file["frames"])])


@fault("15", "the last frame and row are written once, whatever k * interval rounds to")
def duplicate_last_frame():
    off = ["--set", "time.energy_error=off"]  # elastic, four cells per radius: 10.2 % are lost, and said
    for end in (25, 5):
        out = f"out {end}"
        done = krater("run", scene("15"), "-o", out, "-j", 1, "--quiet", *off, "--set", f"time.end={end} us")
        times = times_of(out)
        check(done.returncode == 0 and len(times) == end + 1 and times[-1] == float(f"{end}e-6"), f"15: {end} us: {end + 1} frames",
              f"{len(times)}, the last at {times[-1]}")
        check(np.min(np.diff(times)) > 0.5e-6 and np.min(np.diff(history(out)["time"])) > 0.5e-6,
              "15: half an interval apart, rows too", np.min(np.diff(times)))
    # A restart hits the same times, with the same bits.
    stop = ["--quiet", *off, "--set", "time.end=10.4 us"]
    krater("run", scene("15"), "-o", "half", "-j", 1, *stop)
    done = krater("run", scene("15"), "-o", "half", "-j", 1, "--quiet", *off, "--restart", "half/checkpoint.h5")
    times = times_of("half")
    check(done.returncode == 0 and np.array_equal(times[times != 10.4e-6], times_of("out 25")),
          "15: a restart goes on at the same times", str(times))


@fault("12", "a row after every step where the interval cannot be counted; never a loop that no signal ends")
def history_interval():
    for interval, key in (("1e-30", "history"), ("1e-300", "frames")):
        done = run("out", f"output.{key}={interval}", scene=scene("12"), extra=["--quiet"])
        check(done.returncode in (0, 2), f"12: {key} {interval}: ends", f"{done.returncode}: {done.stderr}")
        if done.returncode == 0 and key == "history":
            check(len(history("out")["time"]) == summary("out")["steps"] + 1, "12: a row after every step")


@fault("restart", "a restart takes no other scene; what may change is said")
def restart():
    base = ["time.end=0.4 us", "grid.cell=0.762 mm"]
    run("first", *base)
    copper = "materials.copper"
    refused = {
        f"{copper}.density=8000": ["materials.copper.density: 8960 in the checkpoint, 8000 in the scene"],
        f"{copper}.shear_modulus=10 GPa": ["materials.copper.shear_modulus"],
        f"{copper}.strength.johnson_cook.A=1 GPa": ["strength.johnson_cook.A: 9e.07 in the", "1e.09 in the scene"],
        f"{copper}.strength.johnson_cook.n=0.4": ["strength.johnson_cook.n: 0.31 in the"],
        f"{copper}.eos.mie_gruneisen_shock.S1=1.4": ["S1: 1.489", "1.4 in the scene"],
        "grid.boundary.z_min={wall: {friction: 0.3}}": ["grid.boundary.z_min.wall.friction: 0 in", "0.3 in the scene"],
        "grid.boundary.z_min=sticky": ["grid.boundary.z_min.wall.friction: 0 in the checkpoint, none in the scene",
                                       "grid.boundary.z_min: none in the checkpoint, sticky in the scene"],
        "method.transfer=flip": ["method.transfer: tflip in the checkpoint, flip in the scene"],
        "method.update=musl": ["method.update"],
        "method.points_per_direction=3": ["points"],
        "bodies.rod.velocity=[0, 10]": ["bodies.rod.velocity"],
        "body_force=[0, 1e6]": ["body_force"],
    }
    for setting, expected in refused.items():
        done = run("other", *base, setting, extra=["--restart", "first/checkpoint.h5", "--quiet"])
        missing = [text for text in expected if not re.search(text, done.stderr)]
        check(done.returncode == 2 and not missing, f"restart with {setting} is refused, by name",
              f"{done.returncode}: {done.stderr.strip()}")
    check(not pathlib.Path("other").exists(), "and nothing is written")
    allowed = ["time.end=0.8 us", "time.cfl=0.4", "title=another", "output.frames=0.1 us", "output.fields=[deviatoric_stress]",
               "measures.top={kind: max, body: rod, axis: z}", "method.dormant_blocks=false"]
    done = run("other", *base, *allowed, extra=["--restart", "first/checkpoint.h5"])
    check(done.returncode == 0 and "changed since the checkpoint" in done.stderr and "measures.top" in done.stderr,
          "what may differ may, and is named", done.stderr)


def energies(folder):
    audit = summary(folder)["audit"]
    return np.array([audit["kinetic_energy"], audit["internal_energy"]])


@fault("b22", "bodies in another order: the names decide")
def bodies_swapped():
    text = scene("b22").read_text(encoding="utf-8")
    lines = text.splitlines()
    a, b = (next(i for i, line in enumerate(lines) if line.startswith(f"  {name}:")) for name in "ab")
    lines[a], lines[b] = lines[b], lines[a]
    pathlib.Path("swapped.yaml").write_text("\n".join(lines), encoding="utf-8")
    krater("run", scene("b22"), "-o", "out", "-j", 1, "--quiet")
    for name, file in (("plain", scene("b22")), ("swapped", "swapped.yaml")):
        done = krater("run", file, "-o", name, "-j", 1, "--quiet", "--restart", "out/checkpoint.h5", "--set", "time.end=1e-4")
        check(done.returncode == 0, f"b22: {name} restart", f"{done.returncode}: {done.stderr}")
    check(np.allclose(energies("plain"), energies("swapped"), rtol=1e-9, atol=0), "b22: the same energies",
          f"{energies('plain')}, {energies('swapped')}")
    done = krater("run", "swapped.yaml", "-o", "out", "-j", 1, "--quiet", "--restart", "out/checkpoint.h5", "--set",
                  "time.end=1e-4")
    check(done.returncode == 2 and "order of bodies" in done.stderr, "b22: not into the history of the other order",
          done.stderr)


def row_of_bodies(count):
    """The scene of b07 with so many bodies."""
    tree = yaml.safe_load(scene("b07").read_text(encoding="utf-8"))
    tree["grid"]["box"]["max"][1] = round(0.003 * count + 0.01, 3)
    tree["bodies"] = {f"b{i}": {"material": "m", "shape": {"box": {"min": [-0.002, round(0.003 * i, 6)],
                                                                   "max": [0.002, round(0.003 * i + 0.002, 6)]}}}
                      for i in range(count)}
    pathlib.Path(f"{count}.yaml").write_text(yaml.safe_dump(tree, sort_keys=False), encoding="utf-8")
    return f"{count}.yaml"


def many(count):
    file = row_of_bodies(count)
    moved = "bodies.b7.velocity=[0, 50]"  # so that something happens
    done = krater("check", file, "--set", moved, timeout=300)
    check(done.returncode == 0, f"b07: check of {count} bodies", done.stderr[-300:])
    for out, extra in (("whole", []), ("half", ["--set", "time.end=0.4e-7"]), ("half", ["--restart", "half/checkpoint.h5"])):
        done = krater("run", file, "--set", moved, "-o", out, "-j", 1, "--quiet", *extra, timeout=300)
        check(done.returncode == 0, f"b07: run of {count} bodies {extra}", done.stderr[-300:])
    return file


@fault("b07", "the number of bodies is limited by memory only: 160")
def many_bodies():
    many(160)


@fault("b07-1000", "the number of bodies is limited by memory only: 1000", long=True)
def thousand_bodies():
    many(1000)


def flipped(whole, bits):
    for bit in bits:
        damaged = bytearray(whole)
        damaged[bit // 8] ^= 1 << bit % 8
        pathlib.Path("c.h5").write_bytes(damaged)
        done = subprocess.run(command("run", scene("b18"), "-o", "out2", "-j", "1", "--quiet", "--restart", "c.h5"),
                              capture_output=True, text=True, timeout=10, env=environment(), check=False)
        if done.returncode != 2 or "damaged" not in done.stderr:
            yield f"bit {bit}: {done.returncode} {done.stderr.strip()[:100]}"


def checkpoint_bits(count):
    krater("run", scene("b18"), "-o", "out", "-j", 1, "--quiet")
    whole = pathlib.Path("out/checkpoint.h5").read_bytes()
    draw = random.Random(18)
    bits = [8 * k + 6 for k in range(2500, 4000, 1500 // count)]
    bits += [draw.randrange(8 * 6000) for _ in range(count)] + [draw.randrange(8 * len(whole)) for _ in range(count)]
    wrong = list(flipped(whole, bits))
    check(not wrong, f"b18: {len(bits)} flipped bits: exit 2, damaged", "; ".join(wrong[:5]))
    # Frames of a run that is continued: damage there is no reason to die either.
    frames = sorted(pathlib.Path("out/frames").glob("*.h5"))
    index = [pathlib.Path("out/frames.h5"), pathlib.Path("out/frames.xmf")]
    for path in [*frames, *index]:
        kept = path.read_bytes()
        for _ in range(max(1, count // 8)):
            damaged = bytearray(kept)
            damaged[draw.randrange(min(len(kept), 4000))] ^= 1 << draw.randrange(8)
            path.write_bytes(damaged)
            done = subprocess.run(command("run", scene("b18"), "-o", "out", "-j", "1", "--quiet", "--restart",
                                          "out/checkpoint.h5", *settings(["time.end=5.01 us"])),
                                  capture_output=True, text=True, timeout=10, env=environment(), check=False)
            check(done.returncode == 0, f"b18: {path.name} damaged: the run goes on",
                  f"{done.returncode} {done.stderr.strip()[:200]}")
            pathlib.Path("out/checkpoint.h5").write_bytes(whole)
        path.write_bytes(kept)


@fault("b18", "a flipped bit in a checkpoint is said to be damage")
def checkpoint_bit():
    checkpoint_bits(17)  # 52 places


@fault("b18-long", "a flipped bit in a checkpoint is said to be damage", long=True)
def checkpoint_many_bits():
    checkpoint_bits(200)


@fault("20", "coincident corners are one in every format; an ASCII STL may be in capitals")
def split_vertices():
    source = scene("20")
    pathlib.Path("20-obj-split-vertices.obj").write_bytes(source.with_suffix(".obj").read_bytes())
    pathlib.Path("20.yaml").write_bytes(source.read_bytes())
    vertices, facets = [], []
    for line in source.with_suffix(".obj").read_text(encoding="utf-8").splitlines():
        key, *words = line.split()
        (vertices if key == "v" else facets).append([float(w) if key == "v" else int(w) - 1 for w in words])
    triangles = [(f[0], f[k], f[k + 1]) for f in facets for k in (1, 2)]
    stl = "SOLID CUBE\r\n" + "".join(
        "FACET NORMAL 0 0 0\r\nOUTER LOOP\r\n" + "".join("VERTEX {} {} {}\r\n".format(*vertices[c]) for c in t) +
        "ENDLOOP\r\nENDFACET\r\n" for t in triangles) + "ENDSOLID CUBE\r\n"
    pathlib.Path("21.stl").write_text("\ufeff" + stl, encoding="utf-8", newline="")
    header = (f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
              f"element face {len(facets)}\nproperty list uchar int vertex_indices\nend_header\n")
    pathlib.Path("20.ply").write_text(header + "".join("{} {} {}\n".format(*v) for v in vertices) +
                                      "".join("4 {} {} {} {}\n".format(*f) for f in facets), encoding="utf-8")
    for surface in ("20-obj-split-vertices.obj", "20.ply", "21.stl"):
        done = krater("run", "20.yaml", "-o", "out", "-j", 1, "--quiet", "--set", f"bodies.b.shape.surface.file={surface}")
        check(done.returncode == 0 and abs(summary("out")["audit"]["mass"] / 1e-3 - 1) < 1e-6, f"20: {surface}: 1 cm^3",
              f"{done.returncode}: {done.stderr.strip()}")


def tool(name, *arguments):
    return subprocess.run([str(ROOT / "tools" / name), *arguments], capture_output=True, text=True, check=False,
                          env=environment())


def pictures(folder, *names):
    done = tool("plot_run", folder)
    lacking = [name for name in names if not pathlib.Path(folder, "pictures", f"{name}.png").exists()]
    check(done.returncode == 0 and not lacking, f"plot_run {folder}", f"{done.returncode}, lacks {lacking}: {done.stderr[-300:]}")


@fault("22", "pictures and checks of a run of which nothing is left")
def all_points_fail():
    coarse = ["--set", "grid.cell=2 mm"]
    done = krater("run", scene("22"), "-o", "gone", "-j", 1, *coarse)
    errors = results_errors("gone")
    check(done.returncode == 0 and not errors, "22: results are sound; nan is the value of a body that is gone", errors)
    check(np.isnan(history("gone")["v"][-1]) and summary("gone")["measures"]["v"]["value"] is None
          and [w["kind"] for w in summary("gone")["warnings"]][-1:] == ["measures_without_points"],
          "22: and a warning names the measure", summary("gone")["warnings"])
    check(tool("show_summary", "gone").returncode == 0, "22: show_summary")
    check(tool("to_vtkhdf", "gone").returncode == 0, "22: to_vtkhdf")


@fault("22-pictures", "pictures of a run of which nothing is left, of one frame, without a history or summary", long=True)
def pictures_of_nothing():
    coarse = ["--set", "grid.cell=2 mm"]
    krater("run", scene("22"), "-o", "gone", "-j", 1, "--quiet", *coarse)
    pictures("gone", "final_shape", "shapes", "energy", "dt", "measures")
    # The other ends: one frame only, no history, no summary.
    krater("run", scene("22"), "-o", "short", "-j", 1, "--quiet", *coarse, "--set", "time.end=0.01 us")
    pictures("short", "final_shape", "energy")
    for name in ("history.csv", "history.h5", "summary.json"):
        pathlib.Path("short", name).unlink()
    pictures("short", "final_shape")


@fault("22-100", "pictures of 100 bodies", long=True)
def hundred_bodies():
    file = row_of_bodies(100)
    krater("run", file, "-o", "many", "-j", 1, "--quiet")
    pictures("many", "final_shape", "shapes", "energy", "dt")
    check(not results_errors("many"), "22: results of 100 bodies")
    done = tool("plot_scene", file, "-o", "setup.png")
    check(done.returncode == 0, "22: plot_scene of 100 bodies", done.stderr[-300:])


@fault("difference", "a difference is told in the direction of the reference")
def difference():
    run("out", "time.end=1 us", "grid.cell=0.762 mm",
        "measures.v={kind: mean_velocity, body: rod, axis: z}", "references.v={value: -250 m/s, source: made up}")
    v = summary("out")["measures"]["v"]
    expected = 100 * (v["value"] / -250 - 1)
    check(-40 < expected < -20 and abs(v["difference_percent"] - expected) < 1e-9, "slower: negative in summary.json", v)
    row = next(line for line in tool("show_summary", "out").stdout.splitlines() if line.strip().startswith("v "))
    check(f"{expected:+.2f}" in row.split(), "and in show_summary", row)


@fault("told", "a run behind a pipe says how far it is; log.txt holds what was said; memory is krater's own")
def told():
    ballast = bytearray(300 << 20)  # what launches krater must not be counted
    run("out", "time.end=0.5 us", "grid.cell=0.762 mm", *LEAVES[3:])
    del ballast
    machine = summary("out")["machine"]
    check(2e6 < machine["peak_resident_bytes"] < 100e6, "peak memory of the program itself", machine["peak_resident_bytes"])
    log = pathlib.Path("out/log.txt").read_text(encoding="utf-8")
    check("done after" in log and log.startswith("krater "), "log.txt", log)


@fault("pipe", "lines of progress in a pipe after 10, 20 ... seconds", long=True)
def pipe():
    process = subprocess.Popen(command("run", ROOT / "inputs" / "taylor_copper.yaml", "-o", "slow", "-j", "1",
                                       *settings(["grid.cell=0.1 mm"])), stderr=subprocess.PIPE, text=True, env=environment())
    line = process.stderr.readline()
    process.terminate()
    process.communicate()
    check(" left " in line and " step " in line and "\r" not in line, "a line of progress", line)
    log = pathlib.Path("slow/log.txt").read_text(encoding="utf-8")
    check(line.strip().removeprefix("krater: ") in log, "and in the log", log)


@fault("frames", "frames are compressed, and a frame costs the same whatever their number")
def frames():
    run("out", "time.end=4 us")
    with h5py.File("out/frames.h5", "r") as file:
        rod = file["frames"][max(file["frames"])]["rod"]
        check(rod["velocity"].compression == "gzip" and rod["velocity"].shuffle, "deflated and shuffled")
        raw = sum(item.nbytes for item in rod.values())
        stored = sum(item.id.get_storage_size() for item in rod.values())
        check(stored < 0.75 * raw, "three quarters of the size at most", f"{stored} of {raw} bytes")
    with open("out/frames.xmf", encoding="utf-8") as file:
        check(file.read().endswith("</Xdmf>\n"), "frames.xmf is whole")
