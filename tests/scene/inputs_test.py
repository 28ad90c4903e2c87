#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every scene of inputs/ in every frame it supports: checked, stepped for a short time, results sound."""

import re

from scene_support import ROOT, Folder, check, finish, krater, results_errors, run, summary

# Frames a scene supports; in the others it must be refused, and say why. 3d runs take a coarser cell.
SCENES = {
    "bar_pulled_apart": {"frames": ("axisymmetric", "plane_strain", "3d"), "end": "1 us", "coarse": "1 mm"},
    # Their 3d runs are for tools/validate: full cylinders of millions of points.
    "ccf_hypervelocity": {"frames": ("axisymmetric",), "end": "0.2 us", "coarse": None, "too_large": ("plane_strain", "3d")},
    "ccf_plugging": {"frames": ("axisymmetric",), "end": "5 us", "coarse": None, "cell": "0.8 mm", "too_large": ("3d",)},
    "cylinder_test": {"frames": ("axisymmetric",), "end": "4 us", "coarse": None},
    "hiermaier_al": {"frames": ("axisymmetric",), "end": "0.2 us", "coarse": None, "too_large": ("3d",)},
    "ccf_two_bars": {"frames": ("3d",), "end": "1 us", "coarse": "1.25 mm"},
    "copper_spall": {"frames": ("axisymmetric", "plane_strain", "3d"), "end": "0.1 us", "coarse": "0.02 mm"},
    "copper_bar": {"frames": ("axisymmetric", "plane_strain", "3d"), "end": "1 us", "coarse": "0.8 mm"},
    "copper_bar_elements": {"frames": ("axisymmetric", "plane_strain", "3d"), "end": "0.2 us", "coarse": "0.8 mm"},
    "ogive_layered_plate": {"frames": ("axisymmetric", "plane_strain", "3d"), "end": "2 us", "coarse": "2 mm"},
    "plate_impact": {"frames": ("axisymmetric", "plane_strain", "3d"), "end": "0.2 us", "coarse": "0.5 mm"},
    "round_nosed_rod": {"frames": ("axisymmetric",), "end": "1 us", "coarse": None},
    # 3d: for tools/validate.
    "ceramic/rod_on_alumina": {"frames": ("axisymmetric",), "end": "2 us", "coarse": None, "cell": "1 mm", "too_large": ("plane_strain", "3d")},
    "hypervelocity/crater": {"frames": ("axisymmetric",), "end": "0.5 us", "coarse": None, "too_large": ("plane_strain", "3d")},
    "hypervelocity/hole": {"frames": ("axisymmetric",), "end": "0.5 us", "coarse": None, "too_large": ("plane_strain", "3d")},
    "snl/penetration": {"frames": ("axisymmetric",), "end": "20 us", "coarse": None, "too_large": ("plane_strain", "3d")},
    "snl/piped": {"frames": ("axisymmetric",), "end": "20 us", "coarse": None, "too_large": ("plane_strain", "3d")},
    "snl/slab": {"frames": ("axisymmetric",), "end": "10 us", "coarse": None, "too_large": ("plane_strain", "3d")},
    "snl/three_kinematics": {"frames": ("3d",), "end": "20 us", "coarse": "25.4 mm"},
    "snl/tilted": {"frames": ("3d",), "end": "20 us", "coarse": "101.6 mm"},
    "spear_plate": {"frames": ("3d",), "end": "1 us", "coarse": "4.06 mm"},
    "taylor_steel": {"frames": ("axisymmetric", "plane_strain", "3d"), "end": "1 us", "coarse": "0.762 mm"},
    "taylor_copper_sph": {"frames": ("3d",), "end": "1 us", "coarse": "0.762 mm"},
    "taylor_copper": {"frames": ("axisymmetric", "plane_strain", "3d"), "end": "1 us", "coarse": "0.762 mm"},
    "two_discs": {"frames": ("plane_strain",), "end": "0.1", "coarse": None},
}
FRAMES = ("axisymmetric", "plane_strain", "3d")


def name_of(path):
    return str(path.relative_to(ROOT / "inputs").with_suffix(""))


def step(path, scene, frame):
    values = [f"frame={frame}", f"time.end={scene['end']}"]
    if "cell" in scene:
        values.append(f"grid.cell={scene['cell']}")
    if frame == "3d":
        values.append(f"grid.cell={scene['coarse']}")
    output = f"{name_of(path).replace('/', '_')}_{frame}"
    done = run(output, *values, scene=path, threads=2)
    if not check(done.returncode == 0, f"{output} runs", done.stderr.strip().splitlines()[-1]):
        return
    errors = results_errors(output)
    check(not errors, f"{output}: results are sound", errors)
    s = summary(output)
    check(s["status"] == "done" and s["steps"] > 3 and abs(s["audit"]["energy_residual_fraction"]) < 1e-10,
          f"{output}: done", f"{s['points']} points, {s['steps']} steps, "
          f"energy residual {s['audit']['energy_residual_fraction']:.1e}, "
          f"error {100 * s['audit']['energy_error_fraction']:.2f} %")


def answers(path, said):
    """Every doubt and advice of `check` is answered in the scene's comments, and every answer is to one that is there.

    `# - "words of the doubt": the answer`, below a line `# Answers to `krater check``.
    """
    doubts = re.findall(r"^(?:doubt|advice): .*|^note: .*does not use.*", said, re.MULTILINE)
    quotes = re.findall(r'^# - "([^"]+)": \S', path.read_text(encoding="utf-8"), re.MULTILINE)
    open_doubts = [doubt for doubt in doubts if not any(quote in doubt for quote in quotes)]
    idle = [quote for quote in quotes if not any(quote in doubt for doubt in doubts)]
    check(not open_doubts, f"{path.name}: its {len(doubts)} doubts are answered in its comments", open_doubts)
    check(not idle, f"{path.name}: its {len(quotes)} answers are to doubts", idle)


with Folder():
    files = sorted(path for folder in ("", "ceramic", "hypervelocity", "snl") for path in (ROOT / "inputs" / folder).glob("*.yaml"))
    files = [path for path in files if not re.search(r"^study:", path.read_text(encoding="utf-8"), re.MULTILINE)]
    check(len(files) >= 4, f"{len(files)} scenes in inputs/")
    pages = [ROOT / "README.md", *(ROOT / "src" / "manual" / "pages").glob("*.md")]
    said = "".join(page.read_text(encoding="utf-8") for page in pages)
    for name, scene in SCENES.items():
        if not set(FRAMES) <= {*scene["frames"], *scene.get("too_large", ())}:
            check(f"`{name}`" in said, f"the README or the manual says that {name} does not run in every frame")
    for path in files:
        name = name_of(path)
        if not check(name in SCENES, f"{name} is listed in this test"):
            continue
        own = krater("check", path)
        check(own.returncode == 0 and "estimate:" in own.stdout and not own.stderr, f"check {path.name}")
        answers(path, own.stdout)
        for frame in FRAMES:
            if frame in SCENES[name].get("too_large", ()):
                continue
            if frame in SCENES[name]["frames"]:
                done = krater("check", path, "--set", f"frame={frame}")
                check(done.returncode == 0, f"check {path.name} in {frame}", done.stderr)
                step(path, SCENES[name], frame)
            else:
                done = krater("check", path, "--set", f"frame={frame}")
                check(done.returncode == 2 and path.name + ":" in done.stderr,
                      f"check {path.name} in {frame} is refused", done.stderr.splitlines()[0])
finish()
