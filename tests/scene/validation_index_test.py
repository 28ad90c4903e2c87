#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""validation/README.md can be made from the reports as they are: of each a date, a revision, a figure."""

import pathlib
import re
import shutil
import sys

from scene_support import ROOT, Folder, check, finish

sys.path.insert(0, str(ROOT / "tools"))
import validate_index as index  # noqa: E402


def all_reports():
    text = index.page()
    rows = re.findall(r"^\| \[(\w+)\].*\|$", text, re.MULTILINE)
    made = sorted(path.parent.name for path in (ROOT / "validation").glob("*/README.md"))
    check(rows == made, f"a row for each of {len(made)} reports", set(made) ^ set(rows))
    known = {path.parent.name for path in index.makers()}
    check(known == set(index.FIGURES), "a figure of merit for each report", known ^ set(index.FIGURES))
    for name in made:
        row = index.row_of(index.Report(ROOT / "validation" / name / "README.md"))
        check(re.search(r"\d", row[2]) and re.fullmatch(r"\d{4}-\d\d-\d\d", row[6]), f"{name}: {row[1]}: {row[2]}")


def what_cannot_be_read():
    """A report whose table has changed is an error that names it, not a row of an old figure."""
    shutil.copytree(ROOT / "validation" / "taylor_copper", "taylor_copper", ignore=shutil.ignore_patterns("*_out"))
    path = pathlib.Path("taylor_copper/README.md")
    text = path.read_text(encoding="utf-8")
    report = index.Report(path)
    length = index.number(report.cell(r"^0\.09525 mm", "length mm"))
    check(index.FIGURES["taylor_copper"](report).value == f"{length:g} mm",
          "the figure is the cell of the table")
    for change, what in ((("0.09525 mm", "quarter"), "no table with a row"),
                         ((", krater ", " by "), "no date and revision")):
        path.write_text(text.replace(*change), encoding="utf-8")
        try:
            index.FIGURES["taylor_copper"](index.Report(path))
            check(False, f"{what}: refused")
        except ValueError as error:
            check(what in str(error), f"{what}: refused", error)
    path.write_text(text.replace("krater 0.1.0 (", "krater 0.1.0 (0123456789ab+modified, was ", 1), encoding="utf-8")
    check("not of a clean revision" in index.state(index.Report(path)), "a report of a modified program is told")
    path.write_text(re.sub(r"krater 0.1.0 \(\w+", "krater 0.1.0 (0123456789ab", text, count=1), encoding="utf-8")
    check("not here" in index.state(index.Report(path)), "and one of a revision that nobody has")


with Folder():
    all_reports()
    what_cannot_be_read()
finish()
