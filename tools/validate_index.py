#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""validation/README.md from the reports themselves: of each its figure of merit, error bar, cost, date and revision,
and whether the present code made it. `tools/validate --index` calls it.

A figure is read from the report's own tables, never computed here but for the difference of two cells, which is the
error bar where the report has no band. A report of which nothing can be read is an error: the page must not go silent.
"""

import argparse
import dataclasses
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
CODE = ("src", "include", "CMakeLists.txt")  # what a run is made by


@dataclasses.dataclass
class Table:
    titles: list
    rows: list  # of lists of texts

    def at(self, row, title):
        """The cell of the first row whose first text matches, in the first column whose title does."""
        column = next(i for i, text in enumerate(self.titles) if re.search(title, text))
        return next(cells for cells in self.rows if re.search(row, cells[0]))[column].strip()


@dataclasses.dataclass
class Figure:
    what: str
    value: str
    bar: str = "-"
    cost: str = "-"


class Report:
    def __init__(self, path):
        self.name, self.text = path.parent.name, path.read_text(encoding="utf-8")
        self.title = re.match(r"# (.*)", self.text).group(1)
        head = re.search(r"^(\d{4}-\d\d-\d\d), krater [\w.]+ \((\w+)(\+modified)?,", self.text, re.MULTILINE)
        if not head:
            raise ValueError(f"{path}: no date and revision in its third line")
        self.date, self.revision, self.modified = head.groups()
        self.tables = tables_of(self.text)
        self.seconds = takes(maker(path.parent))

    def table(self, row, title):
        for table in self.tables:
            if any(re.search(title, text) for text in table.titles) and any(re.search(row, c[0]) for c in table.rows):
                return table
        raise ValueError(f"validation/{self.name}/README.md: no table with a row like '{row}', a column like '{title}'")

    def cell(self, row, title):
        return self.table(row, title).at(row, title)

    def found(self, pattern):
        found = re.search(pattern, self.text)
        if not found:
            raise ValueError(f"validation/{self.name}/README.md: nothing like '{pattern}'")
        return found.group(1)

    def finest(self, what, title, finest, coarser, distance="last refinement"):
        """Value of the finest cell, its distance to the next, and the wall time of the run."""
        first, second = (number(self.cell(row, title)) for row in (finest, coarser))
        table = self.table(finest, title)
        seconds = "-"
        if any(re.search("wall time", text) for text in table.titles):
            seconds = re.sub(r"([\d.]+)", r"\1 s", table.at(finest, "wall time"), count=1)
        elif "core s" in table.titles:
            seconds = table.at(finest, "^core s$") + " core s"
        unit = re.search(r"(?<!\w)(mm|m/s|%)", next(t for t in table.titles if re.search(title, t))).group(1)
        return Figure(what, f"{first:g} {unit}", f"{abs(first - second):.2g} {unit}, {distance}", seconds)


def maker(folder):
    """Template or script of a report."""
    return next(path for path in (folder / "report.md", folder / "make_report.py") if path.exists())


def makers():
    """Of all reports."""
    return sorted(maker(path) for path in (ROOT / "validation").iterdir()
                  if (path / "report.md").exists() or (path / "make_report.py").exists())


def takes(path):
    """Seconds that making a report takes, as its maker says."""
    found = re.search(r"^(?:ESTIMATED_SECONDS *= *|takes: *)(\d+)(?: *(s|min))?", path.read_text(encoding="utf-8"),
                      re.MULTILINE)
    if not found:
        raise ValueError(f"{path}: it does not say how long it takes")
    return int(found.group(1)) * (60 if found.group(2) == "min" else 1)


def number(text):
    return float(re.match(r"[-+]?[\d.]+(e[-+]?\d+)?", text).group(0))


def tables_of(text):
    tables, lines = [], text.split("\n")
    for k, line in enumerate(lines):
        if line.startswith("|") and k + 1 < len(lines) and re.fullmatch(r"\|( *:?-+:? *\|)+", lines[k + 1]):
            rows = []
            for row in lines[k + 2:]:
                if not row.startswith("|"):
                    break
                rows.append(cells_of(row))
            tables.append(Table(cells_of(line), rows))
    return tables


def cells_of(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def worst(report, title):
    """The greatest value of a column that holds numbers."""
    table = next(t for t in report.tables if any(re.search(title, text) for text in t.titles))
    column = next(i for i, text in enumerate(table.titles) if re.search(title, text))
    return max(abs(number(row[column])) for row in table.rows if re.match(r"[-+]?\d", row[column]))


# Report -> its figure of merit.
FIGURES = {
    "ablations": lambda r: Figure("choices that move no measure by 0.5 %",
                                  f"{r.text.count('| could go |')} of "
                                  f"{r.text.count('| could go |') + r.text.count('| keep |')}"),
    "analyst": lambda r: Figure("an example to the first picture that was asked for", r.cell("^the first picture", "since the start")),
    "ballistic_limit": lambda r: Figure("limit of 12 mm of Weldox, 30 cells through it (measured 184.5 m/s)",
                                        r.cell("^0.4$", "^limit m/s") + " m/s",
                                        r.found(r"lies at [\d.]+ (\+- [\d.e+]+) m/s") + " m/s, band"),
    "calibration": lambda r: Figure("bands that hold the truth (demanded 90 %)",
                                    r.found(r"\*\*([\d.]+ % of \d+) bands")),
    "ccf_bars": lambda r: Figure(
        "impact end of a bar of elements, ten across: sides over diagonals (a turned square 1.41)",
        r.table("^truesdell, assumed_strain, current", "least V/V0").at("^truesdell, assumed_strain, current",
                                                                        "sides/diagonals").split(" / ")[0]),
    "ccf_hypervelocity": lambda r: r.finest("penetration at 10 us", "penetration", "^40 cells|^0.08875 mm",
                                             "^20 cells|^0.1775 mm"),
    "ccf_plugging": lambda r: r.finest("residual velocity (measured 241.4 m/s)", "residual velocity", "^80 cells|^0.1 mm",
                                       "^40 cells|^0.2 mm"),
    "ccf_two_bars": lambda r: r.finest("velocity of the struck bar", "target (velocity )?m/s", "^10 cells", "^5 cells"),
    "contact": lambda r: Figure("equal bars: share that the struck bar takes (exact 1)",
                                r.cell("^the same, 100", "found"),
                                f"{1 - number(r.cell('^the same, 100', 'found')):.2g}, to the exact"),
    "copper_bar": lambda r: r.finest("foot radius (five codes 7.22)", "foot radius mm", r"^0\.1 mm", r"^0\.2 mm"),
    "distribution": lambda r: Figure("runs on several ranks with the bits of one", r.found(r"\*\*(\d+ of \d+)\*\* identical")),
    "energy": lambda r: Figure("e behind shocks of 1 to 6 km/s, worst at 200 cells", f"{worst(r, '^e, 200'):.2f} %"),
    "fronts": lambda r: Figure("W of Taylor copper to 1 %: core time, cheapest setting",
                               r.cell("^w diameter", "^1 %").split(":")[0]),
    "hard": lambda r: Figure("runs of cases known to be hard that hold all that is asked",
                             f"{r.cell('^hold all', 'runs')} of {r.cell('^of cases', 'runs')}"),
    "hypervelocity": lambda r: Figure("crater of aluminium at 5 km/s, 20 cells; off the nearest formula",
                                      r.cell("^aluminium, 5 km/s, 20", "^depth") + " mm",
                                      r.cell("^aluminium, 5 km/s, 20", "^off") + " %"),
    "hiermaier_al": lambda r: r.finest("hole (experiment 31.0 mm)", "hole mm", "^40$", "^20$"),
    "kinematics": lambda r: Figure("plugging, elements at 20 through the plate (measured 241.4 m/s)",
                                   r.cell("^elements, 20 through", "residual velocity") + " m/s"),
    "levels": lambda r: Figure("time of three levels over the uniform grid, a plate in 3D (asked 0.2)",
                               r.cell("^4.06 mm, level 2", "time over")),
    "manufactured": lambda r: Figure("error of the bar, G = 0.05, 128 cells, gimp (order)",
                                     r.tables[1].at("^gimp, tflip", "N = 128") + " m"),
    "concrete": lambda r: Figure("peaks of Holmquist-Johnson-Cook against quadrature, worst", f"{worst(r, 'off %'):.2f} %"),
    "materials": lambda r: Figure("flow curves against their closed form, worst", f"{worst(r, 'closed form'):.0e}"),
    "plate_impact": lambda r: Figure("pressure behind the shock, worst at 100 cells",
                                     r.found(r"largest error is ([\d.]+ %) in pressure")),
    "reference_configuration": lambda r: r.finest("length on the initial reference, beside current", "length mm",
                                                  "^initial", "^current", "to current"),
    "snl": lambda r: Figure("depth of seven shots in conventional concrete, HJC, rms error (the shots scatter by 12 %)",
                            r.cell("^HJC, conventional", "rms %") + " %"),
    "solutions": lambda r: Figure("a plate that bends, eight elements through it (points and particles: the report)",
                                  next(c[4] for c in r.tables[0].rows if c[0].startswith("Plate of 2") and c[1] == "elements") + " %"),
    "spear_plate": lambda r: r.finest("residual velocity, 3D", "residual velocity", "^full, 12.5", "^full, 6.3"),
    "speed": lambda r: Figure("Taylor 3d, ns per point-step on one core", r.cell("^Taylor 3d, 1 thread", "^step")),
    "spin_and_discs": lambda r: r.finest("energy that two discs keep, change", "total at 3 s", "^default, h/4",
                                         "^default, h/2"),
    "taylor": lambda r: Figure("off the experiment, best card: steel 4340, length", r.table("^T139", "best card").at(
        "^T139", "best card"), "± " + r.table("^T139", "grid").at("^T139", "grid") + " %, band"),
    "thin_sheets": lambda r: Figure("force of a bar stretched eightfold, off the exact (left alone: torn)",
                                    r.cell("^split", "force at 8") + " %"),
    "taylor_copper": lambda r: r.finest("length (experiment 16.205 mm)", "length mm", r"^0\.09525 mm",
                                        r"^0\.1905 mm"),
}


def git(*words):
    return subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True, check=False)


def state(report):
    """What is between the report's revision and the code as it is."""
    if report.modified:
        return "**no**: not of a clean revision"
    if git("cat-file", "-e", report.revision + "^{commit}").returncode:
        return "unknown: its revision is not here"
    commits = git("rev-list", "--count", f"{report.revision}..HEAD", "--", *CODE).stdout.strip()
    dirty = git("status", "--porcelain", "--", *CODE).stdout.strip()
    if git("diff", "--quiet", report.revision, "HEAD", "--", *CODE).returncode == 0 and not dirty:
        return "yes"
    return f"no: {commits} commits of code since"


def row_of(report):
    figure = FIGURES[report.name](report)
    minutes = report.seconds / 60
    whole = f"{minutes:.0f} min" if minutes >= 2 else f"{report.seconds} s"
    return [f"[{report.name}]({report.name}/README.md)", figure.what, figure.value, figure.bar, figure.cost, whole,
            report.date, report.revision[:12], state(report)]


def page():
    paths = makers()
    unknown = [p.parent.name for p in paths if p.parent.name not in FIGURES]
    if unknown:
        raise ValueError(f"tools/validate_index.py knows no figure of: {', '.join(unknown)}")
    made = [path for path in paths if (path.parent / "README.md").exists()]
    head = git("rev-parse", "--short=12", "HEAD").stdout.strip()
    lines = ["# What krater gets right, misses and costs", "",
             f"Made by `tools/validate --index` from the reports themselves, at {head}; do not edit. Each report "
             "says what its figure is worth. Error bar: the report's own band, or how far the last refinement moved "
             "the value. Cost: wall time (threads), or core-seconds, of the run that gave the figure; then of the whole "
             "report on two quiet cores.", "",
             "| report | figure of merit | value | error bar | run | report | date | revision | by the present code |",
             "| --- | --- | ---: | ---: | ---: | ---: | --- | --- | --- |"]
    for path in made:
        lines.append("| " + " | ".join(row_of(Report(path.parent / "README.md"))) + " |")
    missing = [path.parent.name for path in paths if path not in made]
    if missing:
        lines += ["", "Not made yet: " + ", ".join(missing) + "."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--print", action="store_true", help="to the terminal, not into validation/README.md")
    options = parser.parse_args()
    try:
        text = page()
    except ValueError as error:
        print(f"tools/validate: {error}", file=sys.stderr)
        return 1
    if options.print:
        print(text, end="")
        return 0
    path = ROOT / "validation" / "README.md"
    path.write_text(text, encoding="utf-8")
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
