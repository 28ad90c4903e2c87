#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tools/report: a page of one run and of two that stands alone, plays, and says what the results say; named errors."""

import html
import json
import os
import pathlib
import re
import subprocess

import h5py
import numpy as np

from browser_support import Page, browser
from scene_support import ROOT, Folder, check, environment, finish, run, summary

COARSE = ["grid.cell=0.762mm", "time.end=24us", "output.frames=4us"]


def report(*arguments):
    return subprocess.run([str(ROOT / "tools" / "report"), *map(str, arguments)], capture_output=True, text=True, check=False,
                          env=environment())


def data_of(page):
    return json.loads(re.search(r"<script type='application/json' id=data>(.*?)</script>", page, re.S)[1])


def alone(page):
    check(not re.search(r"""(?:src|href)\s*=\s*(?!['"]?(?:#|data:))|url\(|@import|https?://(?!www\.w3\.org)""", page),
          "nothing is fetched", re.findall(r".{30}(?:src=|url\(|https?://).{40}", page)[:3])


def says_what_the_run_says(page, folder):
    shown, told = html.unescape(page), summary(folder)
    length = told["measures"]["final_length"]
    check(f">{1e3 * length['value']:.5g}<" in page and f"{length['difference_percent']:+.2f} %" in page, "measures and differences")
    for text in ("Taylor anvil, OFHC copper, 190 m/s · with grid.cell=0.762mm", told["program"]["revision"], "johnson cook",
                 "cylinder: radius 3.81 mm", "CuZerilli.dat: Lf", f"{told['audit']['initial_energy']:.5g} J", "epsdot0"):
        check(text in shown, f"the page says '{text}'")
    command = re.search(r"<td>command</td><td><code>(.*?)</code>", page)
    check(command and "krater run" in command[1] and "-o coarse" in html.unescape(command[1]), "and the command", command)


def bands(page_of):
    """A study's band is drawn; without one the page says that it is not known."""
    check("± is not known" in page_of, "no study: no band, and the page says so")
    told = summary("coarse")
    told["measures"]["final_length"].update(uncertainty=3e-4, uncertainty_from="study of three cells")
    pathlib.Path("coarse/summary.json").write_text(json.dumps(told), encoding="utf-8")
    report("coarse", "-o", "band.html")
    page = pathlib.Path("band.html").read_text(encoding="utf-8")
    check(">0.3<" in page and "study of three cells" in page and "± is not known" not in page, "a study's band stands beside")
    check("class=theirs" not in page and all(s["error"] is None for c in data_of(page)["charts"] for s in c["series"]), "no bar without an error")
    told["measures"]["final_length"]["reference"]["error"] = 4e-4
    pathlib.Path("coarse/summary.json").write_text(json.dumps(told), encoding="utf-8")
    report("coarse", "-o", "barred.html")
    page = pathlib.Path("barred.html").read_text(encoding="utf-8")
    charted = [s["error"] for c in data_of(page)["charts"] for s in c["series"] if s["name"] == "final length"]
    check(">16.205 ± 0.4<" in page and page.count("class=theirs") == 1 and charted and abs(charted[0] - 0.4) < 1e-12,
          "the error that a reference's source gives stands beside and in the chart", charted)


def warnings(page):
    check("class='warnings" not in page, "no warning, no box")
    told = summary("coarse")
    told["warnings"] = [{"kind": "x", "text": "7 points left <the> domain", "count": 7, "first_time": 3e-6}]
    pathlib.Path("coarse/summary.json").write_text(json.dumps(told), encoding="utf-8")
    report("coarse", "-o", "warned.html")
    page = pathlib.Path("warned.html").read_text(encoding="utf-8")
    check("7 points left &lt;the&gt; domain" in page and "done, 1 warning" in page, "warnings are repeated, as text")


READ = """(async () => {
    const film = player.films[0], last = film.frames.length - 1, name = 'temperature';
    const values = await film.layer(last, name), cover = await film.layer(last, 'cover');
    const [low, high] = film.frames[last].values[Object.keys(film.fields).indexOf(name)];
    const found = PLACES.map(([r, z]) => {
        const at = film.index(r, z), v = values[Math.round(at[1]) * film.columns + Math.round(at[0])];
        return v ? low + (v - 1) / 254 * (high - low) : null;
    });
    return [found, cover.filter((c) => c >= 128).length * film.pixel ** 2];
})()"""


def values_are_true(page):
    """What the page would show is what the points have there, from the foot to the end; and the section is as large as they are."""
    with h5py.File("coarse/frames.h5", "r") as file:
        rod = file["frames"][sorted(file["frames"])[-1]]["rod"]
        x, values = rod["coordinates"][()], rod["temperature"][()]
        area = (rod["mass"][()] / rod["density"][()] / (2 * np.pi * x[:, 0])).sum()
    places = [[1e-3, 1e-3 * z] for z in (0.8, 1.5, 2.5, 4, 8, 15)]
    wanted = [values[np.argsort(np.hypot(x[:, 0] - r, x[:, 2] - z))[:4]].mean() for r, z in places]
    with Page(page) as opened:
        opened.until("document.body.dataset.drawn !== undefined")
        shown, seen = opened.value(READ.replace("PLACES", json.dumps(places)))
    check(None not in shown and max(abs(a - b) for a, b in zip(shown, wanted)) < 0.05 * np.ptp(values)
          and np.ptp(wanted) > 0.3 * np.ptp(values), "temperatures in the page", f"{shown} for {wanted}")
    check(abs(seen / area - 1) < 0.04, "the area of the section", f"{seen} for {area}")


def plays(page, films):
    with Page(page) as opened:
        check(opened.until("document.body.dataset.drawn !== undefined"), "it draws")
        last = opened.value("Number(document.body.dataset.frame)")
        check(last == 6, "the last of 7 frames first", last)
        picture = "player.films.map((f) => f.canvas.toDataURL()).join()"
        before = opened.value(picture)
        opened.value("document.getElementById('loop').checked = false; document.getElementById('speed').value = '20';"
                     "window.seen = new Set(); new MutationObserver(() => seen.add(document.body.dataset.drawn)).observe("
                     "document.body, {attributes: true}); document.getElementById('play').click()")
        check(opened.until("seen.size >= 7 && player.timer === null"), "play moves through all frames, and stops",
              opened.value("[...seen].join()"))
        opened.value("player.go(1)")
        check(opened.value(picture) != before, "another time is another picture")
        one = opened.value(picture)
        opened.value("(async () => { const f = document.getElementById('field'); f.value = 'pressure'; f.onchange(); await player.go(1); })()")
        check(opened.value(picture) != one, "another field too")
        check(opened.value("document.querySelectorAll('#films canvas').length") == films
              and opened.value("document.querySelectorAll('.chart path[stroke]').length") > 3, "films and curves")
        if films > 1:
            opened.value("document.getElementById('over').click()")
            check(opened.until("player.overlaid && document.querySelectorAll('#films figure')[1].style.display === 'none'"),
                  "several runs in one picture")
        check(opened.troubles() == [], "nothing goes wrong in the page", opened.troubles())
        check(opened.requests() == [], "nothing is asked of the network", opened.requests())


def errors():
    for arguments, texts in ((["nowhere"], ["nowhere", "results folder"]),
                             (["coarse", "--fields", "pressure,damage"], ["no field 'damage'", "plastic_strain", "output: {fields"]),
                             (["coarse", "--section", "z=1mm"], ["section", "axisymmetric"])):
        done = report(*arguments)
        check(done.returncode == 2 and all(text in done.stderr for text in texts) and "Traceback" not in done.stderr,
              f"report {' '.join(arguments)}", done.stderr.strip())


def main():
    with Folder():
        run("coarse", *COARSE)
        run("slow", *COARSE, "bodies.rod.velocity=[0, -150 m/s]")
        one, two = report("coarse"), report("coarse", "slow", "-o", "two.html")
        check(one.returncode == 0 and two.returncode == 0 and "coarse/report.html" in one.stdout, "it is made", one.stderr + two.stderr)
        path = pathlib.Path("coarse/report.html")
        page, both = path.read_text(encoding="utf-8"), pathlib.Path("two.html").read_text(encoding="utf-8")
        check(os.path.getsize(path) < 1.5e6, "it is small", os.path.getsize(path))
        alone(page)
        says_what_the_run_says(page, "coarse")
        check("bodies.rod.velocity[1]" in both or "[0, -190]" in both and "[0, -150]" in both, "what differs between two runs")
        check(len(data_of(both)["runs"]) == 2, "both are in it")
        if browser():
            plays("coarse/report.html", 1)
            plays("two.html", 2)
            values_are_true("coarse/report.html")
        else:
            print("skipped: no chromium, so the pages were not opened (tools/setup --developer)")
        warnings(page)
        bands(page)
        errors()
    finish()


if __name__ == "__main__":
    main()
