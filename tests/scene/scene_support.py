# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the program as a user does, in a scratch folder of its own. Not a test."""

import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
KRATER = os.environ.get("KRATER", str(ROOT / "build" / "krater"))
TAYLOR = ROOT / "inputs" / "taylor_copper.yaml"
ODD = re.compile(r"terminate|what\(\)|Traceback|std::|abort|segmentation|core dumped|HDF5-DIAG|assert", re.I)

failures = []


def check(condition, what, detail=""):
    """Says what was checked; a failure is counted and the test goes on."""
    text = f"{what}: {detail}" if detail else what
    print(("ok    " if condition else "FAIL  ") + text, flush=True)
    if not condition:
        failures.append(text)
    return bool(condition)


class Folder:
    """A scratch folder as the current one, removed at the end."""

    def __enter__(self):
        self.path = tempfile.mkdtemp(prefix="krater scene ")  # a space, as users have them
        os.chdir(self.path)
        return pathlib.Path(self.path)

    def __exit__(self, *_):
        os.chdir("/")
        shutil.rmtree(self.path, ignore_errors=True)


def settings(values):
    return [text for value in values for text in ("--set", value)]


def command(*arguments):
    return [KRATER, *map(str, arguments)]


def environment(changes=None):
    return {**os.environ, "OMP_WAIT_POLICY": "passive", **(changes or {})}


def krater(*arguments, env=None, timeout=120):
    done = subprocess.run(command(*arguments), capture_output=True, text=True, timeout=timeout,
                          env=environment(env), check=False)
    done.text = done.stdout + done.stderr
    said = done.text
    for name in (pathlib.Path(str(a)).name for a in arguments):
        said = said.replace(name, "") if name else said  # a scene may be called as it likes
    if ODD.search(said):
        check(False, f"no odd text from krater {' '.join(map(str, arguments))}", done.text)
    return done


def run(output, *values, scene=TAYLOR, threads=1, extra=(), env=None):
    return krater("run", scene, "-o", output, "-j", threads, *settings(values), *extra, env=env)


def start(output, *values, scene=TAYLOR, threads=1, extra=()):
    return subprocess.Popen(command("run", scene, "-o", output, "-j", threads, *settings(values), *extra),
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment())


def wait_for_rows(output, rows, process, timeout=60):
    """Until history.csv has so many lines; False when the run ended before."""
    end = time.monotonic() + timeout
    while time.monotonic() < end and process.poll() is None:
        try:
            with open(os.path.join(output, "history.csv"), encoding="utf-8") as file:
                if sum(1 for _ in file) > rows:
                    return True
        except OSError:
            pass
        time.sleep(0.002)
    return False


def summary(folder):
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def table(folder, file_name):
    """Column -> values, titles without units."""
    with open(os.path.join(folder, file_name), newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    values = np.array([[float(cell) for cell in row] for row in rows[1:]])
    return {title.split(" [")[0]: values[:, k] for k, title in enumerate(rows[0])}


def history(folder):
    return table(folder, "history.csv")


def gauge_table(folder, name):
    return table(folder, f"gauge_{name}.csv")


def datasets(file_name):
    """Path -> array of every dataset of an HDF5 file (links into other files followed)."""
    found = {}

    def walk(group, path):
        for name in group:
            item = group[name]
            if isinstance(item, h5py.Dataset):
                found[f"{path}/{name}"] = item[()]
            else:
                walk(item, f"{path}/{name}")

    with h5py.File(file_name, "r") as file:
        walk(file, "")
    return found


def results_errors(folder, *options):
    """What tools/check_results.py says; empty when all is well."""
    done = subprocess.run([sys.executable, str(ROOT / "tools" / "check_results.py"), str(folder), *options],
                          capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stderr + done.stdout


def checkpoint_is_whole(path):
    try:
        with h5py.File(path, "r") as file:
            whole = len(file["state"]) > 0
        with open(path, "rb") as file:
            return whole and file.read(17) == b"krater checkpoint"
    except (OSError, KeyError):
        return False


def same_bits(a, b):
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def differences(one, other, ignore=("machine",)):
    """Names of what differs between two results folders: frames, history.csv, summary.json."""
    found = []
    a, b = datasets(os.path.join(one, "frames.h5")), datasets(os.path.join(other, "frames.h5"))
    if sorted(a) != sorted(b):
        found.append(f"frames hold other datasets: {sorted(set(a) ^ set(b))[:5]}")
    found += [name for name in a if name in b and not same_bits(np.asarray(a[name]), np.asarray(b[name]))]
    with open(os.path.join(one, "history.csv"), "rb") as x, open(os.path.join(other, "history.csv"), "rb") as y:
        if x.read() != y.read():
            found.append("history.csv")
    p, q = summary(one), summary(other)
    found += [f"summary.json: {key}" for key in sorted(set(p) | set(q))
              if key not in ignore and p.get(key) != q.get(key)]
    return found


def finish():
    print(f"{len(failures)} failures" if failures else "all checks passed")
    sys.exit(1 if failures else 0)
