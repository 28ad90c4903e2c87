# SPDX-License-Identifier: GPL-3.0-or-later
"""Members of a study: runs as child processes, each with a folder of its own. What is done is told by what lies on
disk:

    FOLDER/members/NAME/     results of `krater run`; done where its summary.json says so
    FOLDER/members/NAME.json cost, exit code and reason; NAME.log: what the run said

A crash is a row with its reason. At the end of the budget members get SIGTERM, write a checkpoint and go on from it
later.
"""

import ctypes
import dataclasses
import hashlib
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time

from study_file import InputError, SECONDS

KRATER = os.environ.get("KRATER", "krater")
LOOK = 0.01  # between looks at the children [s]
LEAST = 0.1  # of a run, whatever it computes [s]
LONGEST_NAME = 100  # of a member, which is a folder's
YEAR = 365 * 86400.0  # [s]
MEMORY_SHARE = 0.8  # of what is free, that members side by side may take
BYTES = {"B": 1, "kB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}
ESTIMATE = re.compile(r"^estimate: .*?([\d.e+]+) (\w?B) of memory, ([\d.e+]+) (\w+) on one core", re.M)


@dataclasses.dataclass
class Member:
    name: str
    settings: list  # texts of --set
    values: dict  # what the table shows: {path: text}


@dataclasses.dataclass
class Row:
    member: Member
    status: str = "left"  # done | failed | interrupted | left
    reason: str = ""
    summary: dict = dataclasses.field(default_factory=dict)
    cost: dict = dataclasses.field(default_factory=dict)

    @property
    def done(self):
        return self.status == "done"

    def measure(self, name):
        """The number, or None."""
        if name.endswith(".residual_speed") and name not in self.summary.get("measures", {}):
            value = self.summary.get("outcomes", {}).get(name.rsplit(".", 1)[0], {}).get("residual_speed")
        else:
            value = (self.summary.get("measures", {}).get(name) or {}).get("value")
        return float(value) if isinstance(value, (int, float)) else None

    def unit(self, name):
        return (self.summary.get("measures", {}).get(name) or {}).get("unit", "m/s" if "." in name else "")

    def reference(self, name):
        """(value, source, error or None) of the scene's reference, or None."""
        found = (self.summary.get("measures", {}).get(name) or {}).get("reference")
        return (found["value"], found.get("source", ""), found.get("error")) if found else None

    @property
    def cell(self):
        return self.summary.get("cell")


def name_of(values):
    """Tells the values: cell=0.381mm. Where it does not tell all of them, for two keys end alike, signs are left out or
    it would be too long for a folder, it ends with a digest of them: a name is where results are kept, and two members
    with one name would be given one result."""
    keys = [path.rsplit(".", 1)[-1] for path in values]
    words = [re.sub(r"[^A-Za-z0-9_.+-]", "", text) for text in values.values()]
    name = ",".join(f"{key}={word}" for key, word in zip(keys, words))
    # Two values of a key that differ by a slash would not have the same dimension.
    whole = all(word == text.translate(str.maketrans("", "", " /")) for word, text in zip(words, values.values()))
    if whole and len(set(keys)) == len(keys) and len(name) <= LONGEST_NAME:
        return name or "as_it_is"
    told = hashlib.sha256(repr(sorted(values.items())).encode()).hexdigest()[:8]
    return f"{name[:LONGEST_NAME - len(told) - 1]}_{told}"


def member(values, extra=()):
    return Member(name_of(values), [*extra, *(f"{path}={text}" for path, text in values.items())], dict(values))


def die_with_parent():
    """A study that is killed leaves no members running on their own (Linux: PR_SET_PDEATHSIG)."""
    ctypes.CDLL(None).prctl(1, signal.SIGTERM)


class Engine:
    """Runs members and makes rows of them."""

    def __init__(self, scene, folder, fixed=(), jobs=1, threads=1, budget=None, say=None):
        self.scene, self.folder, self.fixed = scene, folder, list(fixed)
        self.jobs, self.threads = jobs, threads
        self.budget, self.deadline = budget, time.monotonic() + budget if budget else None  # of wall time [s]
        self.say = say or (lambda line: print(line, file=sys.stderr, flush=True))
        self.forecasts = {}  # name -> (bytes, seconds)
        self.measured = {}  # name -> core seconds of what is done
        self.over = False  # the budget ended something

    # ---- one member

    def place(self, name, ending=""):
        return os.path.join(self.folder, "members", name + ending)

    def command(self, one, threads=None):
        words = [KRATER, "run", os.path.abspath(self.scene), "-o", os.path.abspath(self.place(one.name)), "-j",
                 str(threads or self.threads), "--quiet"]  # a queue may run it from anywhere
        for text in (*self.fixed, *one.settings):
            words += ["--set", text]
        return words

    def shell_line(self, one):
        return "OMP_WAIT_POLICY=passive " + " ".join(map(shlex.quote, self.command(one)))

    def row(self, one):
        """What lies on disk of a member."""
        row, told = Row(one), read_json(self.place(one.name, ".json"))
        row.summary = read_json(os.path.join(self.place(one.name), "summary.json"))
        status = row.summary.get("status")
        if status == "done":
            row.status, row.cost = "done", self.cost(row.summary, told)
            self.measured[one.name] = row.cost["core_seconds"]
        elif told.get("status") == "killed":
            row.status, row.summary = "interrupted", {}
            row.reason = f"{told.get('reason')} (is memory short?); the same command tries it again"
        elif told.get("status") == "failed" or status == "failed":
            row.status, row.cost = "failed", told.get("cost", {})
            row.reason = told.get("reason") or str(row.summary.get("message", "failed"))
            row.summary = {}
        elif status == "interrupted" or os.path.exists(os.path.join(self.place(one.name), "checkpoint.h5")):
            row.status, row.summary = "interrupted", {}
            row.reason = "stopped before its end; goes on from its checkpoint"
        return row

    @staticmethod
    def cost(summary, told):
        machine = summary.get("machine", {})
        wall = machine.get("wall_seconds", 0.0)
        # Of processors, never of the clock on the wall: beside others a run takes several times as long, and a price
        # that is foretold from that would be as wrong.
        core = told.get("core_seconds", machine.get("processor_seconds", wall * machine.get("threads", 1)))
        setup = machine.get("seconds_outside_steps", {}).get("setup", 0.0)
        return {"core_seconds": core,
                "wall_seconds": told.get("wall_seconds", wall), "points": summary.get("points", 0),
                "steps": summary.get("steps", 0), "point_steps": summary.get("points", 0) * summary.get("steps", 0),
                "bytes": machine.get("peak_resident_bytes", 0), "threads": machine.get("threads", 1),
                "stepping_seconds": core * (wall / (wall + setup) if wall else 1.0)}

    # ---- what it will cost

    def check(self, members):
        """`krater check` of members without results: errors of input now, not in an hour; forecasts of cost."""
        waiting = [one for one in members if one.name not in self.forecasts and not self.row(one).done]
        while waiting:
            now, waiting = waiting[:self.jobs], waiting[self.jobs:]
            children = []
            for one in now:
                words = [KRATER, "check", self.scene]
                for text in (*self.fixed, *one.settings):
                    words += ["--set", text]
                children.append((one, subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                                       text=True)))
            for one, child in children:
                out, error = child.communicate()
                if child.returncode == 2:
                    for _, other in children:
                        other.kill()
                    said = "\n".join(dict.fromkeys(error.strip().split("\n")))
                    raise InputError(said if said.startswith("--set ") else f"{said} (member {one.name})")
                found = ESTIMATE.search(out)
                self.forecasts[one.name] = (0, 0)
                if found:
                    unit = SECONDS.get(found[4], 86400 if found[4] == "days" else 1)
                    self.forecasts[one.name] = (float(found[1]) * BYTES.get(found[2], 1), float(found[3]) * unit)

    def seconds(self, one):
        """Core seconds that a member will take: its forecast by the ratio that finished members had."""
        known = [(self.measured[name], self.forecasts[name][1]) for name in self.measured
                 if self.forecasts.get(name, (0, 0))[1] > 0]
        ratio = sum(a for a, _ in known) / sum(b for _, b in known) if known else 1.0
        return max(LEAST, self.forecasts.get(one.name, (0, 0))[1] * ratio)

    def estimate(self, members):
        """(members to run, core seconds, greatest memory)."""
        waiting = [one for one in members if self.row(one).status not in ("done", "failed")]
        return (len(waiting), sum(self.seconds(one) for one in waiting),
                max((self.forecasts.get(one.name, (0, 0))[0] for one in waiting), default=0))

    # ---- running

    def run(self, members):
        """Rows of the members, those that were not done run now, cheapest first: what a budget cuts is the dearest.
        Cores are shared out: the last members, which are the largest, get what the others have left."""
        rows = {one.name: self.row(one) for one in members}
        waiting = sorted((one for one in members if rows[one.name].status in ("left", "interrupted")), key=self.seconds)
        total, running = len(waiting), []
        try:
            while waiting or running:
                while waiting and self.may_start(waiting[0], running):
                    one = waiting.pop(0)
                    threads = max(self.threads, self.jobs // (len(waiting) + len(running) + 1))
                    if self.too_late(one, threads):
                        self.over = True
                        rows[one.name] = Row(one, rows[one.name].status,
                                             f"no time left for its {text_of(self.seconds(one))}")
                        continue
                    running.append(self.start(one, rows[one.name].status == "interrupted", threads))
                for child in [child for child in running if child.ended()]:
                    running.remove(child)
                    rows[child.one.name] = self.finish(child)
                    self.tell(rows[child.one.name], total - len(waiting) - len(running), total, waiting, running)
                if self.deadline and time.monotonic() > self.deadline:
                    self.over = self.over or bool(running)
                    for child in running:
                        child.stop()
                if running:
                    time.sleep(LOOK)
        finally:
            for child in running:
                child.stop()
            for child in running:
                child.wait()
                self.finish(child)  # what it has cost so far is a part of what it costs
        return rows

    def may_start(self, one, running):
        if not running:
            return True
        used = sum(child.threads for child in running)
        memory = sum(self.forecasts.get(other.name, (0, 0))[0] for other in [one, *(child.one for child in running)])
        return used + self.threads <= self.jobs and memory < MEMORY_SHARE * free_memory()

    def too_late(self, one, threads):
        return self.deadline is not None and time.monotonic() + self.seconds(one) / threads > self.deadline

    def start(self, one, goes_on, threads):
        words = self.command(one, threads)
        checkpoint = os.path.join(self.place(one.name), "checkpoint.h5")
        if goes_on and os.path.exists(checkpoint):
            words += ["--restart", checkpoint]
        return Child(one, words, threads, self.place(one.name))

    def finish(self, child):
        told = {"exit_code": child.code, "core_seconds": child.core_seconds, "wall_seconds": child.wall_seconds,
                "command": child.words, "status": "done" if child.code == 0 else "failed"}
        before = read_json(self.place(child.one.name, ".json"))
        if before.get("status") == "interrupted":  # the cost of the part before
            for key in ("core_seconds", "wall_seconds"):
                told[key] += before.get(key, 0)
        if child.code == 4 or child.code == -signal.SIGTERM:
            told["status"] = "interrupted"
        elif child.code:
            told["reason"] = child.reason()
            if child.code == -signal.SIGKILL:  # nothing a run does by itself: the system's memory, or somebody
                told["status"] = "killed"
        write_json(self.place(child.one.name, ".json"), told)
        return self.row(child.one)

    def tell(self, row, number, total, waiting, running):
        left = sum(self.seconds(one) for one in waiting) + sum(
            max(0.0, self.seconds(child.one) - child.age()) for child in running)
        cost = f" {text_of(row.cost['core_seconds'])}" if row.done else f": {row.reason}"
        after = f"; about {text_of(left / self.jobs)} left" if left > 0 else ""
        self.say(f"krater study: [{number}/{total}] {row.member.name} {row.status}{cost}{after}")


class Child:
    """A run as a process."""

    def __init__(self, one, words, threads, folder):
        self.one, self.words, self.threads, self.log = one, words, threads, folder + ".log"
        os.makedirs(os.path.dirname(folder), exist_ok=True)
        self.begin, self.code, self.stopped = time.monotonic(), None, False
        self.core_seconds = self.wall_seconds = 0.0
        with open(self.log, "w", encoding="utf-8") as log:
            # Its own group: a Ctrl-C is for the study, which then asks its members one by one.
            self.process = subprocess.Popen(words, stdout=log, stderr=subprocess.STDOUT, start_new_session=True,
                                            preexec_fn=die_with_parent,
                                            env={"OMP_WAIT_POLICY": "passive", **os.environ})

    def age(self):
        return time.monotonic() - self.begin

    def ended(self, options=os.WNOHANG):
        pid, status, usage = os.wait4(self.process.pid, options)
        if pid == 0:
            return False
        self.code = self.process.returncode = os.waitstatus_to_exitcode(status)
        self.core_seconds, self.wall_seconds = usage.ru_utime + usage.ru_stime, self.age()
        return True

    def stop(self):
        if not self.stopped:
            self.stopped = True
            self.process.terminate()

    def wait(self):
        if self.code is None:
            self.ended(0)

    def reason(self):
        """The last thing it said, or the signal that ended it."""
        if self.code < 0:
            return f"ended by {signal.Signals(-self.code).name}"
        with open(self.log, encoding="utf-8", errors="replace") as log:
            lines = [line.strip() for line in log if line.strip() and "warning:" not in line]
        return f"exit code {self.code}: {lines[-1].removeprefix('krater: ') if lines else 'no word'}"


def read_json(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return {}


def write_json(path, value):
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    with open(path + ".part", "w", encoding="utf-8") as file:
        json.dump(value, file, indent=1)
        file.write("\n")
    os.replace(path + ".part", path)


def free_memory():
    with open("/proc/meminfo", encoding="utf-8") as file:
        return next(float(line.split()[1]) * 1024 for line in file if line.startswith("MemAvailable"))


def text_of(seconds):
    """As 3.1 min. What is foretold beyond a year is no figure: nobody can try it."""
    if seconds > YEAR:
        return "more than a year"
    for unit, size in (("days", 86400), ("h", 3600), ("min", 60)):
        if seconds >= 1.5 * size:
            return f"{seconds / size:.1f} {unit}"
    return f"{seconds:.2g} s" if seconds < 10 else f"{seconds:.0f} s"
