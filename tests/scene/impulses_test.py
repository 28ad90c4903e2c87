#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Forces and impulses between bodies and from sides of the domain; every change of momentum has an owner."""

import pathlib

import h5py
import numpy as np

from scene_support import Folder, check, differences, finish, history, krater, run, summary

# A rod on an anvil: what the anvil gives is what the rod loses.
ANVIL = ["time.end=12 us", "grid.cell=0.762 mm", "output.frames=0",
         "measures.push={kind: impulse, body: rod, by: z_min, axis: z}", "measures.F={kind: force, body: rod, by: z_min, axis: z}",
         "gauges={anvil: {measures: [F, push, push_rate], every: 0.1 us, filter: {cfc: 60000}}}"]

# An oblique block, a bar and a rigid ball: friction, three bodies at a node, a wall with friction.
BODIES = """
frame: plane_strain
grid: {cell: 1 mm, box: {min: [-30 mm, 0], max: [30 mm, 50 mm]}, boundary: {z_min: {wall: {friction: 0.2}}}}
time: {end: 60 us}
output: {frames: 30 us}
materials:
  soft: {density: 2700, shear_modulus: 26 GPa, strength: {von_mises: {Y: 200 MPa, H: 100 MPa}},
         eos: {mie_gruneisen_shock: {c0: 5240 m/s, S1: 1.4, gamma0: 2}}}
  hard: {density: 7850}
bodies:
  plate: {material: soft, shape: {box: {min: [-20 mm, -1, 1 mm], max: [20 mm, 1, 7 mm]}}}
  block: {material: soft, shape: {box: {min: [-10 mm, -1, 8 mm], max: [0, 1, 16 mm]}}, velocity: [60 m/s, -200 m/s]}
  ball: {material: hard, shape: {sphere: {radius: 5 mm, center: [8 mm, 0, 14 mm]}}, velocity: [0, -150 m/s], rigid: free}
  ram: {material: hard, shape: {box: {min: [-12 mm, -1, 24 mm], max: [-2 mm, 1, 30 mm]}}, rigid: {velocity: [0, -250 m/s]}}
contact: {friction: 0.3}
measures:
  block_plate_z: {kind: impulse, body: block, by: plate, axis: z}
  block_plate_x: {kind: impulse, body: block, by: plate, axis: x}
  plate_block_z: {kind: impulse, body: plate, by: block, axis: z}
  block_ball_x: {kind: impulse, body: block, by: ball, axis: x}
  block_ball_z: {kind: impulse, body: block, by: ball, axis: z}
  block_ram_x: {kind: impulse, body: block, by: ram, axis: x}
  block_ram_z: {kind: impulse, body: block, by: ram, axis: z}
  ball_plate_z: {kind: impulse, body: ball, by: plate, axis: z}
  ball_plate_x: {kind: impulse, body: ball, by: plate, axis: x}
  plate_wall_x: {kind: impulse, body: plate, by: z_min, axis: x}
  plate_wall_z: {kind: impulse, body: plate, by: z_min, axis: z}
  block_wall_z: {kind: impulse, body: block, by: z_min, axis: z}
  slant: {kind: impulse, body: block, by: plate, axis: [3, 4]}
  on_block_x: {kind: impulse, body: block, by: all, axis: x}
  on_block_z: {kind: impulse, body: block, by: all, axis: z}
  on_both_z: {kind: impulse, body: [block, plate], by: all, axis: z}
  block_px: {kind: momentum, body: block, axis: x}
  block_pz: {kind: momentum, body: block, axis: z}
  plate_px: {kind: momentum, body: plate, axis: x}
  plate_pz: {kind: momentum, body: plate, axis: z}
  ball_pz: {kind: momentum, body: ball, axis: z}
  touch: {kind: force, body: block, by: plate, axis: z}
  peak: {kind: force, body: plate, by: block, axis: z, keep: smallest}
gauges: {pair: {measures: [touch, block_plate_x, block_pz_rate], every: 0.7 us, filter: {moving_mean: 3 us}}}
"""

# A corner strikes a wall, and some points go a hair beyond it and are put back: what that gives them is the wall's.
CORNER = """
frame: plane_strain
grid: {cell: 1 mm, box: {min: [-20 mm, 0], max: [30 mm, 40 mm]}, boundary: {z_min: {wall: {friction: 0.2}}}}
time: {end: 12 us, energy_error: off}
output: {frames: 0}
materials:
  soft: {density: 2700, shear_modulus: 26 GPa, strength: {von_mises: {Y: 200 MPa, H: 100 MPa}},
         eos: {mie_gruneisen_shock: {c0: 5240 m/s, S1: 1.4, gamma0: 2}}}
bodies:
  block: {material: soft, shape: {rotate: {axis: y, angle: 40 degree, shape: {box: {min: [-5 mm, -1, 8 mm], max: [5 mm, 1, 14 mm]}}}},
          velocity: [400 m/s, -800 m/s]}
measures:
  px: {kind: momentum, body: block, axis: x}
  pz: {kind: momentum, body: block, axis: z}
  Jx: {kind: impulse, body: block, by: z_min, axis: x}
  Jz: {kind: impulse, body: block, by: z_min, axis: z}
"""

OWNERS = {
    "loads, damping, a wall": ["damping={mass: 1e4 1/s}", "loads={push: {body: plate, face: x_min, pressure: 0.3 GPa}, "
                               "pull: {body: block, face: z_max, traction: [0.1 GPa, 0]}, drive: {body: plate, face: x_max, velocity: [free, 5 m/s]}}"],
    "body forces on all": ['body_force=[1e6, "-1e7*cos(1e5*t)"]'],
    "planes that fold": ["grid.boundary.z_max=symmetry", "grid.boundary.x_max=sticky", "damping={mass: 1e4 1/s}",
                         "grid.box={min: [-30 mm, 0], max: [20 mm, 16 mm]}", "loads={push: {body: plate, face: x_min, pressure: 0.3 GPa}}"],
}


def change(rows, name):
    return rows[name] - rows[name][0]


def anvil():
    done = run("anvil", *ANVIL)
    if not check(done.returncode == 0, "the rod runs", done.text[-400:]):
        return
    rows = history("anvil")
    scale = abs(rows["momentum_z"][0])
    gap = max(abs(change(rows, "momentum_z") - rows["push"])) / scale
    check(gap < 1e-10 and rows["push"][-1] > 0.1 * scale, "the anvil's impulse is the rod's change of momentum", f"{gap:.1e}")
    for scheme in ("transfer=apic", "transfer={xpic: {order: 2}}", "update=musl", "update=usf"):
        run("scheme", *ANVIL, "time.end=6 us", "time.energy_error=off", f"method.{scheme}")
        other = history("scheme")
        gap = max(abs(change(other, "momentum_z") - other["push"])) / scale
        check(gap < 1e-10 and other["push"][-1] > 0.05 * scale, f"{scheme}: the same", f"{gap:.1e}")
    done = np.sum(rows["F"][1:] * np.diff(rows["time"]))
    check(abs(done - rows["push"][-1]) < 1e-10 * scale, "the integral of the force is the impulse", (done, rows["push"][-1]))
    with h5py.File("anvil/history.h5", "r") as file:
        gauge = file["gauges/anvil"]
        said = dict(gauge.attrs)
        t, F, J = (gauge[name][()] for name in ("time", "F", "push"))
        units = [gauge[name].attrs["unit"] for name in ("F", "push", "F_filtered")]
        same = np.allclose(F, gauge["push_rate"][()], rtol=1e-9, atol=1e-6 * max(F))
    check(said["filter_frequency"] == 1e5 and said["every"] == 1e-7 and said["filter"] == "cfc 60000", "the gauge says its filter", said)
    check(units == ["N", "N s", "N"] and same, "and its units; force is the rate of the impulse", units)
    work = np.sum(F[1:] * np.diff(t)) / J[-1]
    check(abs(work - 1) < 0.01, "its force adds up to the impulse", work)


def pairs(rows, what):
    scale = abs(rows["block_pz"][0])
    gaps = {
        "block along x": change(rows, "block_px") - rows["block_plate_x"] - rows["block_ball_x"] - rows["block_ram_x"],
        "block along z": change(rows, "block_pz") - rows["block_plate_z"] - rows["block_ball_z"] - rows["block_ram_z"] - rows["block_wall_z"],
        "plate along x": change(rows, "plate_px") + rows["block_plate_x"] + rows["ball_plate_x"] - rows["plate_wall_x"],
        "plate along z": change(rows, "plate_pz") + rows["block_plate_z"] + rows["ball_plate_z"] - rows["plate_wall_z"],
        "ball along z": change(rows, "ball_pz") - rows["ball_plate_z"] + rows["block_ball_z"],
        "block by all along x": change(rows, "block_px") - rows["on_block_x"],
        "block by all along z": change(rows, "block_pz") - rows["on_block_z"],
        "two bodies by all others": change(rows, "block_pz") + change(rows, "plate_pz") - rows["on_both_z"],
        "action and reaction": rows["plate_block_z"] + rows["block_plate_z"],
        "a slanted axis": rows["slant"] - 0.6 * rows["block_plate_x"] - 0.8 * rows["block_plate_z"],
    }
    for name, gap in gaps.items():
        check(max(abs(gap)) < 1e-12 * scale, f"{what}, {name}: impulses make up the momentum", f"{max(abs(gap)) / scale:.1e}")
    for name in ("block_plate_x", "block_plate_z", "block_ram_z", "ball_plate_z", "plate_wall_x"):
        check(abs(rows[name][-1]) > 1e-3 * scale, f"{what}: {name} is not nothing", rows[name][-1] / scale)


def table_of_pairs(rows):
    told = summary("one")["measures"]["on_block_z"]
    names = {"plate": "plate", "ball": "ball", "ram": "ram", "z_min": "wall"}
    check(told["by"] == "all" and list(told["impulses"]) == list(names), "by: all names every partner", told)
    for name, column in names.items():
        check(told["impulses"][name] == rows[f"block_{column}_z"][-1], f"the table has what {name} gave", told["impulses"][name])


def rigid_first(folder):
    """The rigid bodies before those they push: the pair is noted the other way round."""
    lines = BODIES.splitlines(True)
    rigid = [line for line in lines if line.startswith(("  ball:", "  ram:"))]
    rest = [line for line in lines if line not in rigid]
    at = rest.index("bodies:\n") + 1
    scene = pathlib.Path(folder, "rigid.yaml")
    scene.write_text("".join(rest[:at] + rigid + rest[at:]), encoding="utf-8")
    done = run("rigid", scene=scene)
    if check(done.returncode == 0, "rigid bodies may come first", done.text[-400:]):
        pairs(history("rigid"), "rigid first")


def put_back(folder):
    scene = pathlib.Path(folder, "corner.yaml")
    scene.write_text(CORNER, encoding="utf-8")
    done = run("corner", scene=scene)
    if not check(done.returncode == 0, "a corner strikes a wall", done.text[-400:]):
        return
    rows, events = history("corner"), summary("corner")["audit"]["events"]
    check(events["reflections"] > 0 and events["removed_points"] == 0, "some points are put back", events["reflections"])
    for axis in "xz":
        gap = max(abs(change(rows, f"p{axis}") - rows[f"J{axis}"])) / abs(rows["pz"][0])
        check(gap < 1e-12 and abs(rows[f"J{axis}"][-1]) > 1e-2 * abs(rows["pz"][0]), f"along {axis} that is in the wall's impulse", f"{gap:.1e}")


def owners(name):
    rows, audit = history(name), summary(name)["audit"]
    for axis in "xz":
        gap = abs(change(rows, f"momentum_{axis}") - rows[f"wall_impulse_{axis}"] - rows[f"external_impulse_{axis}"])
        scale = abs(rows["momentum_z"][0])
        check(max(gap) < 1e-11 * scale and audit["events"]["removed_points"] == 0,
              f"{name}: momentum along {axis} has its owners", f"{max(gap) / scale:.1e}")


def main():
    with Folder() as folder:
        anvil()
        scene = pathlib.Path(folder, "bodies.yaml")
        scene.write_text(BODIES, encoding="utf-8")
        done = run("one", scene=scene)
        check(done.returncode == 0, "three bodies and a ram run", done.text[-400:])
        pairs(history("one"), "usl")
        table_of_pairs(history("one"))
        rigid_first(folder)
        put_back(folder)
        owners("one")
        check(summary("one")["measures"]["peak"]["value"] < 0 and summary("one")["measures"]["slant"]["by"] == "plate", "the peak force is told")
        run("two", scene=scene, threads=2)
        check(not differences("one", "two"), "the same bits on two threads", differences("one", "two"))
        run("parts", "time.end=30 us", scene=scene)
        run("parts", scene=scene, extra=["--restart", "parts/checkpoint.h5"])
        found = [d for d in differences("one", "parts") if "summary" not in d]
        check(not found, "the same bits across a restart", found)
        pair = [pathlib.Path(name, "gauge_pair.csv").read_bytes() for name in ("one", "two", "parts")]
        check(pair[0] == pair[1] == pair[2] and pair[0].count(b"\n") > 80, "of the gauge too, on threads and across a restart")
        run("musl", "method.update=musl", "time.end=20 us", scene=scene)
        pairs_of_short = history("musl")
        gap = change(pairs_of_short, "block_pz") - sum(pairs_of_short[f"block_{by}_z"] for by in ("plate", "ball", "ram", "wall"))
        check(max(abs(gap)) < 1e-12 * abs(pairs_of_short["block_pz"][0]), "musl: impulses make up the momentum", max(abs(gap)))
        fold = pathlib.Path(folder, "fold.yaml")
        rigid = ("  ball:", "  ram:", "  block_ball", "  block_ram", "  ball_", "gauges:")
        fold.write_text("".join(line for line in BODIES.splitlines(True) if not line.startswith(rigid)), encoding="utf-8")
        for name, settings in OWNERS.items():
            done = run(name, "time.end=20 us", *settings, scene=fold if "fold" in name else scene)
            if check(done.returncode == 0, f"{name} runs", done.text[-400:]):
                owners(name)
        for setting, part in (("measures.slant.by=x_min", "pushes nobody"), ("measures.slant.by=block", "gives itself"),
                              ("measures.slant.axis=[0, 0]", "needs a length"), ("measures.slant.by=plat", "pushes nobody"),
                              ("grid.boundary.z_min=sticky", "is in wall_impulse of the history"),
                              ("measures.more={kind: impulse, body: ball, by: all}", "axis"),
                              ("contact=none", "known are bodies where"), ("measures.gauges={kind: mass, body: block}", "under this name")):
            done = krater("check", scene, "--set", setting)
            check(done.returncode == 2 and part in done.text and "measures." in done.text, f"{setting} is refused", done.text[:300])
    finish()


main()
