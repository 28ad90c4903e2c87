# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of a validation study and the parts of its report, for validation/*/make_report.py.

Results lie in validation/NAME/runs_out/ (not in git) and are used again only by the same executable and scene, bit for
bit: a study can be interrupted and continued, and a report never mixes versions.
"""

import argparse
import csv
import datetime
import hashlib
import json
import os
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


class Run:
    """A finished run: summary, history and folder."""

    def __init__(self, folder):
        self.folder = folder
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            self.summary = json.load(file)

    def measure(self, name):
        return self.summary["measures"][name]["value"]

    def audit(self, name):
        return self.summary["audit"][name]

    @property
    def error(self):
        """energy_error_fraction in per cent."""
        return 100 * self.audit("energy_error_fraction")

    @property
    def wall(self):
        return self.summary["machine"]["wall_seconds"]

    @property
    def memory(self):
        """Largest resident memory of the program in bytes, as it says itself: what the launcher could ask for counts
        its own memory too, for a child starts as a copy of it. None where the program did not say."""
        return self.summary["machine"].get("peak_resident_bytes")

    def history(self):
        """name -> values."""
        with open(os.path.join(self.folder, "history.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        names = [title.partition(" [")[0] for title in rows[0]]
        return {n: np.array([float(v) for v in column]) for n, column in zip(names, zip(*rows[1:]))
                if n not in ("limiter", "dt_limiter", "dt_limited_by")}


class Point:
    """A result of `krater point`: summary and columns."""

    def __init__(self, folder):
        self.folder = folder
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            self.summary = json.load(file)
        with open(os.path.join(folder, "point.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        values = np.array([[float(v) for v in row] for row in rows[1:]])
        self.columns = {title.partition(" [")[0]: values[:, k] for k, title in enumerate(rows[0])}

    def __getitem__(self, name):
        return self.columns[name]


def execute(command, environment):
    return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=environment,
                          check=False)


def digest(*paths):
    total = hashlib.sha256()
    for path in paths:
        with open(path, "rb") as file:
            total.update(file.read())
    return total.hexdigest()[:16]


class Study:
    def __init__(self, file, scene, seconds, description):
        parser = argparse.ArgumentParser(description=description,
                                         formatter_class=argparse.RawDescriptionHelpFormatter)
        parser.add_argument("--budget", type=float, default=float("inf"), metavar="SECONDS",
                            help="leave out runs that would take the study longer")
        parser.add_argument("-j", type=int, default=min(os.cpu_count() or 1, 2), metavar="N",
                            help="cores to use (default: %(default)s)")
        options = parser.parse_args()
        self.folder = os.path.dirname(os.path.abspath(file))
        self.name = os.path.basename(self.folder)
        self.scene = os.path.join(ROOT, scene)
        self.krater = os.environ.get("KRATER") or os.path.join(ROOT, "build", "krater")
        self.cores, self.budget, self.start = options.j, options.budget, time.monotonic()
        self.identity = digest(self.krater, self.scene)
        self.left_out, self.failed, self.lines = [], [], []
        print(f"{self.name}: about {seconds:.0f} s on 2 quiet cores; {self.krater}; results in "
              f"{os.path.join(self.folder, 'runs_out')}", flush=True)

    def run_text(self, label, text, seconds=0.0, settings=()):
        """run() of a scene given as text, which becomes the study's."""
        folder = os.path.join(self.folder, "runs_out")
        os.makedirs(folder, exist_ok=True)
        self.scene = os.path.join(folder, label + ".yaml")
        with open(self.scene, "w", encoding="utf-8") as file:
            file.write(text)
        self.identity = digest(self.krater, self.scene)
        return self.run(label, settings, seconds)

    def use(self, scene):
        """Runs from here on are of another scene of the project."""
        self.scene = os.path.join(ROOT, scene)
        self.identity = digest(self.krater, self.scene)

    def run(self, label, settings=(), seconds=0.0, threads=1, without=()):
        """Run `label` with --set options; None if it fails or the budget does not allow it. `without`: lines
        of the scene to leave out, for a block whose absence is the switch."""
        folder, stamp, wanted = self.place(label, [*settings, *("without " + line for line in without)])
        if self.stands(stamp, wanted):
            return Run(folder)
        if time.monotonic() - self.start + seconds > self.budget:
            self.left_out.append(label)
            return None
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(os.path.dirname(folder), exist_ok=True)
        scene = self.scene_without(label, without) if without else self.scene
        command = [self.krater, "run", scene, "-o", folder, "-j", str(threads), "--quiet"]
        for setting in ("time.energy_error=off", *settings):  # a report says the error, it does not stop there
            command += ["--set", setting]
        environment = {"OMP_WAIT_POLICY": "passive", **os.environ}
        begin = time.monotonic()
        done = execute(command, environment)
        for _ in range(3):  # interrupted by someone else's signal: the same bits from the checkpoint
            checkpoint = os.path.join(folder, "checkpoint.h5")
            if done.returncode != 4 or not os.path.exists(checkpoint):
                break
            done = execute([*command, "--restart", checkpoint], environment)
        print(f"  {label}: {time.monotonic() - begin:.1f} s" +
              (f", exit code {done.returncode}" if done.returncode else ""), flush=True)
        if done.returncode:
            words = done.stderr.strip().splitlines()
            self.failed.append((label, done.returncode, words[-1] if words else ""))
            return None
        with open(stamp, "w", encoding="utf-8") as file:
            file.write(wanted)
        return Run(folder)

    def scene_without(self, label, lines):
        """A copy of the scene in the folder of the results; cards are found from there too."""
        with open(self.scene, encoding="utf-8") as file:
            text = file.read()
        for line in lines:
            if text.count(line + "\n") != 1:
                raise ValueError(f"{self.scene} has not exactly one line '{line}'")
            text = text.replace(line + "\n", "")
        path = os.path.join(self.folder, "runs_out", label + ".yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def place(self, label, settings):
        """Folder of a result, its stamp, and what the stamp must say: of the cards those that its text can name, so that a
        card more makes no study anew."""
        folder = os.path.join(self.folder, "runs_out", label)
        with open(self.scene, encoding="utf-8") as file:
            text = "\n".join([file.read(), *settings])
        used = [path for path in cards() if os.path.splitext(os.path.basename(path))[0] in text]
        return (folder, os.path.join(folder, "identity.txt"),
                " ".join([self.identity, *([digest(*used)] if used else []), *settings]) + "\n")

    @staticmethod
    def stands(stamp, wanted):
        if not os.path.exists(stamp):
            return False
        with open(stamp, encoding="utf-8") as file:
            return file.read() == wanted

    def point(self, label, file, settings=()):
        """`krater point` with a file of inputs/points or text; None if it fails."""
        text = "\n" in file
        path = os.path.join(ROOT, file)
        if not text:
            with open(path, encoding="utf-8") as written:
                file = written.read()
        folder, stamp, wanted = self.place(label, [file, *settings])
        if self.stands(stamp, wanted):
            return Point(folder)
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(os.path.dirname(folder), exist_ok=True)
        if text:
            path = folder + ".yaml"
            with open(path, "w", encoding="utf-8") as written:
                written.write(file)
        command = [self.krater, "point", path, "-o", folder, "--quiet"]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            words = done.stderr.strip().splitlines()
            self.failed.append((label, done.returncode, words[-1] if words else ""))
            return None
        with open(stamp, "w", encoding="utf-8") as written:
            written.write(wanted)
        return Point(folder)

    def ask(self, name, settings=(), beside=()):
        """(study.json, folder) of `krater study` with NAME.yaml of this folder, None and None if it failed. Its members are kept
        for the same program, study and files that lie beside it."""
        file = os.path.join(self.folder, name + ".yaml")
        folder = os.path.join(self.folder, "runs_out", f"{name}_{digest(self.krater, file, *beside)}")
        command = [self.krater, "study", file, "-j", str(self.cores), "-o", folder]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode:
            words = done.stderr.strip().splitlines()
            self.failed.append((name, done.returncode, words[-1] if words else ""))
            return None, None
        with open(os.path.join(folder, "study.json"), encoding="utf-8") as written:
            return json.load(written), folder

    def run_all(self, jobs):
        """{label: (settings, seconds)} -> {label: Run or None}, each on one core, as many at a time as
        there are cores."""
        with ThreadPoolExecutor(self.cores) as pool:
            futures = {label: pool.submit(self.run, label, settings, seconds)
                       for label, (settings, seconds) in jobs.items()}
            return {label: future.result() for label, future in futures.items()}

    def picture(self, run, name, target):
        """A picture of tools/plot_run beside the report."""
        if run is None:
            return
        path = os.path.join(run.folder, "pictures", name)
        if not os.path.exists(path):
            subprocess.run([sys.executable, os.path.join(ROOT, "tools", "plot_run"), run.folder],
                           stdout=subprocess.DEVNULL, check=True)
        shutil.copyfile(path, os.path.join(self.folder, target))

    # ---- the report

    def add(self, *paragraphs):
        for text in paragraphs:
            self.lines += [text, ""]

    def add_table(self, titles, rows):
        self.lines.append("| " + " | ".join(titles) + " |")
        self.lines.append("| " + " | ".join(["---"] + ["---:"] * (len(titles) - 1)) + " |")
        self.lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
        self.lines.append("")

    def write(self, title):
        program = subprocess.run([self.krater, "--version"], capture_output=True, text=True,
                                 check=False).stdout.partition("\n")[0]
        text = [f"# {title}", "", f"{datetime.date.today()}, {program}, {machine()}, load average "
                f"{os.getloadavg()[2]:.0f} (wall times are those of such a machine). Made by `tools/validate "
                f"{self.name}`; do not edit.", ""] + self.lines
        if self.left_out:
            text += [f"Left out for the budget of {self.budget:.0f} s: {', '.join(self.left_out)}.", ""]
        for label, code, words in self.failed:
            text += [f"**{label} ended with exit code {code}**: {words}", ""]
        path = os.path.join(self.folder, "README.md")
        with open(path + ".part", "w", encoding="utf-8") as file:
            file.write("\n".join(text).rstrip() + "\n")
        os.replace(path + ".part", path)
        print(f"{path} ({time.monotonic() - self.start:.0f} s)")


def cards():
    folder = os.path.join(ROOT, "inputs", "materials")
    return [os.path.join(folder, name) for name in sorted(os.listdir(folder)) if name.endswith(".yaml")]


def machine():
    model = "unknown processor"
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            model = next((line.partition(":")[2].strip() for line in file if line.startswith("model name")),
                         model)
    except OSError:
        pass
    return f"{os.cpu_count()} cores of {model}"
