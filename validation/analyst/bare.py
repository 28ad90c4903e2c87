#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tutorials of the manual on a bare Debian 12 with the package (tools/package --try ROOT), as root: bare.py ROOT [--whole].

Each begins in an empty folder of ROOT and runs its own commands, shortened as the suite shortens them; --whole: as they
stand. Writes tutorials.csv into this folder: seconds, of processors too, and the program that ran.
"""

import csv
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "tests" / "scene"))
from manual_test import PAGES, blocks, prepared  # noqa: E402


def inside(root, folder, command):
    """Runs a command in a folder of the root; (exit code, seconds, seconds of processors, what it said)."""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(["chroot", root, "/usr/bin/env", "-i", "PATH=/usr/bin:/bin", "HOME=/root", "OMP_WAIT_POLICY=passive",
                           "bash", "-euc", f"cd {folder}\n{command}"], capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.returncode, time.monotonic() - begin, used, done.stdout + done.stderr


def tutorial(root, page, whole):
    folder = "/root/" + page.stem
    place = pathlib.Path(root + folder)
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    total = [0.0, 0.0, 0]
    for language, text, comments, name in blocks(page):
        if name:
            (place / name).write_text(text, encoding="utf-8")
        elif language == "sh":
            if not whole:
                os.chdir(place)
                text = prepared(text, comments)
            code, wall, used, said = inside(root, folder, text)
            total = [total[0] + wall, total[1] + used, total[2] + len(text.splitlines())]
            if code != 0:
                return total, f"{text.strip()}: exit code {code}: {said[-400:]}"
    return total, ""


def main():
    root, whole = os.path.abspath(sys.argv[1]), "--whole" in sys.argv
    proc = os.path.join(root, "proc")  # as every system has
    mounted = not os.path.exists(proc + "/meminfo") and subprocess.run(["mount", "-t", "proc", "proc", proc], check=True)
    try:
        return all_of_them(root, whole)
    finally:
        if mounted:
            subprocess.run(["umount", proc], check=False)


def all_of_them(root, whole):
    version = inside(root, "/root", "krater --version")[3].partition("\n")[0]
    rows = []
    for page in sorted((PAGES / "tutorials").glob("*.md")):
        (wall, used, commands), wrong = tutorial(root, page, whole)
        title = re.match(r"# (.*)", page.read_text(encoding="utf-8"))[1]
        pictures = sum(1 for path in pathlib.Path(root + "/root/" + page.stem).rglob("*.png"))
        rows.append([title, commands, f"{wall:.1f}", f"{used:.1f}", pictures, "failed" if wrong else "ran"])
        print(f"{title}: {wall:.1f} s, {used:.1f} s of processors{': ' + wrong if wrong else ''}", flush=True)
    with open(HERE / "tutorials.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["tutorial", "commands", "wall s", "processor s", "pictures", "result",
                         f"{version}; {'whole' if whole else 'shortened as in the suite'}; load {os.getloadavg()[2]:.0f}"])
        writer.writerows(rows)
    return 0 if all(row[-1] == "ran" for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
