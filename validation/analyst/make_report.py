#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The analyst's day: from an empty folder to a first picture, pictures of every kind, the page of a run, the manual.

Writes README.md and pictures into its folder; tutorials.csv is made by bare.py, as root on a bare Debian 12. Pages are
photographed by headless Chromium. `tools/validate analyst` builds first.
"""

import csv
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests" / "scene")]
from browser_support import Page  # noqa: E402
from validate_impacts import discussion  # noqa: E402
from validate_runs import Study  # noqa: E402

ESTIMATED_SECONDS = 240  # on two quiet cores
EXAMPLE = "inputs/taylor_copper.yaml"
DRAWN = "document.body.dataset.drawn !== undefined"


def scene_of(tutorial):
    """The first scene of a tutorial of the manual."""
    text = (ROOT / "src/manual/pages/tutorials" / f"{tutorial}.md").read_text(encoding="utf-8")
    return re.search(r"```yaml\n(.*?)```", text, re.S)[1]


class Timed:
    """Commands in a folder, with the time of each."""

    def __init__(self, study, folder):
        self.study, self.folder, self.rows, self.total = study, folder, [], 0.0

    def __call__(self, said, *command):
        before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        done = subprocess.run(list(map(str, command)), cwd=self.folder, capture_output=True, text=True, check=False,
                              env={**os.environ, "KRATER": self.study.krater, "OMP_WAIT_POLICY": "passive",
                                   "KRATER_CARDS": str(ROOT / "inputs/materials")})
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode != 0:
            self.study.failed.append((said, done.returncode, done.stderr.strip().splitlines()[-1]))
        wall, used = time.monotonic() - begin, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        self.total += wall
        self.rows.append([f"`{said}`", f"{wall:.1f} s", f"{used:.1f} s", f"{self.total:.1f} s"])
        return done


def tool(name):
    return str(ROOT / "tools" / name)


def first_picture(study):
    """An example of the installation, its measures, an own picture, the page."""
    with tempfile.TemporaryDirectory(prefix="krater analyst ") as folder:
        shutil.copy(ROOT / EXAMPLE, folder)
        timed = Timed(study, folder)
        out = "taylor_copper_out"
        timed("krater check taylor_copper.yaml", study.krater, "check", "taylor_copper.yaml")
        timed("krater run taylor_copper.yaml", study.krater, "run", "taylor_copper.yaml", "-j", study.cores)
        own = timed("krater-plot-run taylor_copper_out --field temperature --time 30us", tool("plot_run"), out, "--field", "temperature",
                    "--time", "30us")
        until = timed.total
        timed("krater-plot-run taylor_copper_out", tool("plot_run"), out)
        timed("krater-report taylor_copper_out", tool("report"), out)
        kept = os.path.join(study.folder, "runs_out", "taylor")
        shutil.rmtree(kept, ignore_errors=True)
        shutil.copytree(os.path.join(folder, out), kept)
        picture = os.path.join(folder, own.stdout.strip())
        if os.path.exists(picture):
            keep(picture, "first.png")
    study.add("## From an empty folder to a first picture", "What a new user types after the installation, in a folder that holds the "
              "shipped example alone. His time to read and to type is not in it.")
    study.add_table(["command", "wall", "processors", "since the start"], timed.rows)
    study.add_table(["", "since the start"], [["the first picture that he asked for", f"{until:.1f} s"]])
    study.add("![the picture that was asked for](first.png)")


def keep(path, name, width=1100):
    """A picture beside the report, of at most `width` pixels; in 256 colours where it would be larger than 250 kB."""
    with Image.open(path) as image:
        image = image.convert("RGB")
        if image.width > width:
            image = image.resize((width, round(image.height * width / image.width)), Image.LANCZOS)
        image.save(HERE / name, optimize=True)
        if (HERE / name).stat().st_size > 250e3:
            image.quantize(256, dither=Image.Dither.NONE).save(HERE / name, optimize=True)


def pictures(study, whipple, bullet):
    """Of several kinds, by tools/plot_run."""
    study.add("## Pictures", "Each by one command, at its own size; shown here at 1100 pixels at most.")
    rows, shown = [], []
    wanted = [("set-up", "plot_scene", os.path.join(study.folder, "runs_out", "bullet.yaml"), ["-o"], "setup.png"),
              ("a field in a section of 3D", "plot_run", bullet, ["--field", "von_mises", "--time", "40us", "-o"], "section.png"),
              ("bodies, debris at visible size", "plot_run", whipple, ["--field", "body", "--time", "10us", "-o"], "bodies.png"),
              ("surfaces in space (VTK)", "plot_run", bullet, ["--field", "body", "--view", "iso", "-o"], "surface.png"),
              ("an axisymmetric body turned, cut open", "plot_run", whipple, ["--field", "body", "--view", "iso", "--time", "10us", "-o"],
               "turned.png"),
              ("a film", "plot_run", whipple, ["--field", "speed", "--film", "gif", "--size", "900x700", "-o"], "film.gif")]
    with tempfile.TemporaryDirectory() as folder:
        for what, by, run, options, name in wanted:
            if run is None:
                continue
            place, timed = getattr(run, "folder", run), Timed(study, folder)
            timed(what, tool(by), place, *options, name)
            made = pathlib.Path(folder, name)
            if not made.exists():
                continue
            with Image.open(made) as image:
                size, frames = image.size, getattr(image, "n_frames", 1)
                if frames > 1:
                    image.seek(frames // 3)
                image.convert("RGB").save(pathlib.Path(folder, "frame.png"))
            target = name.replace(".gif", "_frame.png")
            keep(pathlib.Path(folder, "frame.png"), target)
            rows.append([what, f"`krater-{by.replace('_', '-')} {' '.join(['…', *options[:-1]])}`", f"{size[0]} x {size[1]}"
                         + (f", {frames} frames" if frames > 1 else ""), f"{made.stat().st_size / 1024:.0f} kB", timed.rows[0][2]])
            shown.append(f"![{what}]({target})")
    study.add_table(["picture", "command", "pixels", "file", "processors"], rows)
    study.add(*shown)


def photograph(path, name, scripts=(), size=(1280, 900), drawn=DRAWN):
    with Page(path, *size) as page, tempfile.TemporaryDirectory() as folder:
        page.until(drawn)
        for script in scripts:
            page.value(script)
        page.value("new Promise((done) => setTimeout(done, 400))")
        raw = os.path.join(folder, "page.png")
        page.picture(raw)
        keep(raw, name, 1280)
        return page.troubles(), page.requests()


def pages(study, whipple):
    """The page of a run, of two, and of the manual."""
    out, manual = pathlib.Path(study.folder, "runs_out"), pathlib.Path(tempfile.mkdtemp(prefix="krater manual "))
    other = study.run("slower", ["bodies.rod.velocity=[0, -150 m/s]"], 2)
    rows, wrong = [], []
    timed = Timed(study, out)
    timed("one run", tool("report"), "taylor")
    timed("two runs", tool("report"), "taylor", other.folder, "-o", "two.html")
    timed("a Whipple shield", tool("report"), whipple.folder, "-o", "whipple.html")
    timed("the manual", tool("manual"), "-o", manual)
    shots = [(out / "taylor/report.html", "page.png", ["document.getElementById('field').value = 'pressure'",
                                                       "document.getElementById('field').onchange()", "location.hash = 'sections'", "player.go(3)"]),
             (out / "taylor/report.html", "page_measures.png", ["location.hash = 'measures'"]),
             (out / "two.html", "page_two.png", ["document.getElementById('over').click()", "location.hash = 'sections'"]),
             (out / "whipple.html", "page_whipple.png", ["location.hash = 'sections'", "player.go(4)"])]
    for path, name, scripts in shots:
        troubles, requests = photograph(path, name, scripts)
        wrong += troubles + requests
    for page, name in (("tutorials/taylor.html", "manual_tutorial.png"), ("reference.html#measure", "manual_reference.png")):
        place = manual / "site" / page.partition("#")[0]
        photograph(place, name, [f"location.hash = '{page.partition('#')[2]}'"], drawn="document.readyState === 'complete'")
    for path, said in (("taylor/report.html", 0), ("two.html", 1), ("whipple.html", 2)):
        rows.append([timed.rows[said][0].strip("`"), f"{(out / path).stat().st_size / 1e6:.2f} MB", timed.rows[said][2]])
    whole = sum(path.stat().st_size for path in (manual / "site").rglob("*") if path.is_file())
    rows.append(["the manual (mkdocs)", f"{whole / 1e6:.1f} MB", timed.rows[3][2]])
    shutil.rmtree(manual)
    study.add("## Pages", "In headless Chromium, 1280 x 900. " + ("Nothing went wrong in them and nothing was asked of the network."
              if not wrong else f"**Wrong in them**: {wrong[:3]}"))
    study.add_table(["page", "size", "processors"], rows)
    study.add("The page of a run, pressure at 30 µs:", "![page](page.png)", "Measures, histories, energy:",
              "![measures](page_measures.png)", "Two runs in one picture:", "![two runs](page_two.png)", "A Whipple shield:",
              "![Whipple shield](page_whipple.png)", "The manual: a tutorial, and the reference of measures by kind:",
              "![a tutorial](manual_tutorial.png)", "![the reference](manual_reference.png)")


def tutorials(study):
    path = HERE / "tutorials.csv"
    if not path.exists():
        return
    with open(path, newline="", encoding="utf-8") as file:
        titles, *rows = list(csv.reader(file))
    study.add("## Tutorials on a bare Debian 12", f"From the package, each in an empty folder ([bare.py](bare.py)): {titles.pop()}.")
    study.add_table(titles, rows)


def main():
    study = Study(__file__, EXAMPLE, ESTIMATED_SECONDS, __doc__)
    first_picture(study)
    whipple = study.run_text("whipple", scene_of("whipple"), 10, ["grid.cell=0.2 mm"])
    bullet = study.run_text("bullet", scene_of("oblique"), 30)
    pictures(study, whipple, bullet)
    study.use(EXAMPLE)
    pages(study, whipple)
    tutorials(study)
    discussion(study)
    study.write("The analyst's day: first picture, pictures, pages, tutorials")


if __name__ == "__main__":
    main()
