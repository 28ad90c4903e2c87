# SPDX-License-Identifier: GPL-3.0-or-later
"""study.csv, study.h5, study.json, pictures and study.html of a study's folder."""

import csv
import datetime
import json
import math
import os
import platform
import subprocess
import time

import numpy as np

import pictures
from members import KRATER, write_json
from page import page

COSTS = {"core_seconds": "s", "wall_seconds": "s", "points": "1", "steps": "1", "point_steps": "1", "bytes": "B",
         "threads": "1"}


def machine():
    """This machine beside its rates, so that costs of another can be compared: nominal clock, and numpy's triad
    a = b + s c over 3 x 16 MB on one core."""
    model, clock = "unknown processor", None
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        for line in file:
            key, _, value = line.partition(":")
            model = value.strip() if key.strip() == "model name" else model
            clock = float(value) if key.strip() == "cpu MHz" and clock is None else clock
    b, c = np.ones(2_000_000), np.ones(2_000_000)
    best = math.inf
    for _ in range(4):
        begin = time.perf_counter()
        np.multiply(c, 3.0, out=c)
        np.add(b, c, out=c)
        best = min(best, time.perf_counter() - begin)
    return {"host": platform.node(), "processor": model, "cores": os.cpu_count(), "clock_MHz": clock,
            "triad_GB_per_s": round(5 * 8 * len(b) / best / 1e9, 2), "load_average": os.getloadavg()[1]}


def version():
    done = subprocess.run([KRATER, "--version"], capture_output=True, text=True, check=False)
    return done.stdout.partition("\n")[0].strip()


def columns(rows, measures):
    """[(title, unit, values)]: what the members were, what they gave, what they cost."""
    table = [("member", "", [row.member.name for row in rows]), ("status", "", [row.status for row in rows]),
             ("reason", "", [row.reason for row in rows])]
    for path in dict.fromkeys(path for row in rows for path in row.member.values):
        table.append((path, "", [row.member.values.get(path, "") for row in rows]))
    table.append(("cell", "m", [row.cell for row in rows]))
    for name in measures:
        unit = next((row.unit(name) for row in rows if row.done), "")
        table.append((name, unit, [row.measure(name) for row in rows]))
    for name, unit in COSTS.items():
        table.append((name, unit, [row.cost.get(name) for row in rows]))
    table.append(("warnings", "1", [len(row.summary.get("warnings", [])) if row.done else None for row in rows]))
    return table


def write_csv(path, table):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([f"{title} [{unit}]" if unit else title for title, unit, _ in table])
        for line in zip(*(values for *_, values in table)):
            writer.writerow(["" if v is None else f"{v:.17g}" if isinstance(v, float) else v for v in line])


def write_h5(path, table, made):
    import h5py  # here, not above: a study that is refused need not wait for it
    with h5py.File(path + ".part", "w") as file:
        for key in ("title", "kind", "scene", "program", "date"):
            file.attrs[key] = str(made[key])
        file.attrs["columns"] = [title for title, *_ in table]
        for title, unit, values in table:
            if unit:
                data = file.create_dataset(title, data=np.array([np.nan if v is None else v for v in values], float))
                data.attrs["unit"] = unit
            else:
                file.create_dataset(title, data=[str(v) for v in values], dtype=h5py.string_dtype())
    os.replace(path + ".part", path)


def clean(value):
    """JSON has no nan."""
    if isinstance(value, dict):
        return {str(key): clean(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [clean(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def draw(folder, answer):
    """PNG and SVG of each picture; {name: svg text} for the page."""
    pictures.style()
    from matplotlib.figure import Figure  # after the choice of the backend
    drawn = {}
    os.makedirs(os.path.join(folder, "pictures"), exist_ok=True)
    for picture in answer.pictures:
        figure = Figure(figsize=(6, 4))
        picture.draw(figure)
        path = os.path.join(folder, "pictures", picture.name)
        figure.savefig(path + ".png", dpi=160)
        figure.savefig(path + ".svg", metadata={"Date": None})
        with open(path + ".svg", encoding="utf-8") as file:
            drawn[picture.name] = file.read()
    return drawn


def write(folder, study, rows, answer):
    """All files; returns the page's path."""
    os.makedirs(folder, exist_ok=True)
    made = {"title": study.title, "kind": study.kind, "scene": study.scene, "study": study.path, "program": version(),
            "date": datetime.datetime.now().strftime("%Y-%m-%d %H:%M"), "machine": machine()}
    revisions = sorted({row.summary.get("program", {}).get("revision", "?") for row in rows if row.done})
    if any(f"({revision}," not in made["program"] for revision in revisions):
        answer.sentences.append(f"Members were made by {'several revisions' if len(revisions) > 1 else 'revision'} "
                                f"{', '.join(revisions)} of krater, and this page by {made['program']}: choose another "
                                "folder with -o to make them anew.")
    table = columns(rows, study.measures)
    write_csv(os.path.join(folder, "study.csv"), table)
    write_h5(os.path.join(folder, "study.h5"), table, made)
    members = [dict(zip((title for title, *_ in table), line)) | {"settings": row.member.settings}
               for row, line in zip(rows, zip(*(values for *_, values in table)))]
    write_json(os.path.join(folder, "study.json"), clean({**made, "sentences": answer.sentences, "answer": answer.data,
                                                          "members": members}))
    if study.kind in ("convergence", "accuracy"):
        write_bands(os.path.join(folder, "uncertainty.tsv"), study.scene, answer.data["measures"])
    if study.kind == "ablation" and "verdicts" in answer.data:
        write_influence(os.path.join(folder, "influence.tsv"), study.scene, rows[0].cell, answer.data)
    path = os.path.join(folder, "study.html")
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write(page(made, rows, answer, table, draw(folder, answer)))
    os.replace(path + ".part", path)
    return path


def write_bands(path, scene, curves):
    """The band of every measure at every cell, for `krater run` to find (app/known_error.hpp): that of the finest, and
    the distance to the finest added for the others."""
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write(f"# scene {os.path.basename(scene)}\n")
        for name, c in curves.items():
            for cell, value in zip(c["cells"], c["values"]):
                if c["uncertainty"] is not None and value is not None:
                    band = c["uncertainty"] + abs(value - c["value"])
                    file.write(f"{name}\t{cell:.17g}\t{value:.17g}\t{band:.6g}\t{c['how']}\n")
    os.replace(path + ".part", path)


def write_influence(path, scene, cell, data):
    """What each effect moves most, for the table of effects of `krater check` and `krater run`
    (src/app/effect_influence.cpp): the keys that take it away, change in %, measure, verdict."""
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write(f"# scene {os.path.basename(scene)} {cell:.17g}\n")
        for effect, verdict in data["verdicts"].items():
            found = {name: change[effect] for name, change in data["changes_percent"].items()}
            gone = [name for name, change in found.items() if change is None]
            most = gone[0] if gone else max(found, key=lambda name: abs(found[name]), default=None)
            if most is not None:
                change = "all" if gone else f"{abs(found[most]):.2g}"
                file.write(f"{' '.join(data['effects'][effect])}\t{change}\t{most}\t{verdict}\n")
    os.replace(path + ".part", path)


def stamp(folder):
    """What is said of the study that a folder holds, or {}."""
    try:
        with open(os.path.join(folder, "study.lock.json"), encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return {}
