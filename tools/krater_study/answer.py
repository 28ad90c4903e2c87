# SPDX-License-Identifier: GPL-3.0-or-later
"""What a kind says of its table: sentences, tables, pictures, and the same as data."""

import dataclasses
import math

READABLE = {"m": (1e3, "mm"), "s": (1e6, "us"), "Pa": (1e-9, "GPa")}


@dataclasses.dataclass
class Table:
    caption: str
    titles: list
    rows: list  # of texts


@dataclasses.dataclass
class Picture:
    name: str
    caption: str
    draw: object  # called with a matplotlib figure


@dataclasses.dataclass
class Answer:
    sentences: list = dataclasses.field(default_factory=list)
    tables: list = dataclasses.field(default_factory=list)
    pictures: list = dataclasses.field(default_factory=list)
    data: dict = dataclasses.field(default_factory=dict)


def scaled(unit):
    return READABLE.get(unit, (1, unit if unit != "1" else ""))


def with_band(value, band, unit):
    """17.32 +- 0.05 mm: digits by the band."""
    scale, unit = scaled(unit)
    if value is None:
        return "-"
    value *= scale
    if band is None or not math.isfinite(band):
        return f"{value:.5g} +- ? {unit}".strip()
    band *= scale
    digits = 5 if band == 0 else max(1, min(8, 2 + math.floor(math.log10(max(abs(value), band))) -
                                            math.floor(math.log10(band))))
    return f"{value:.{digits}g} +- {band:.2g} {unit}".strip()


def short_names(paths):
    """{path: the least of its end that tells it from the others}: materials.copper.strength.johnson_cook.A -> A. Whole
    paths push what was found out of the page."""
    def end(path, parts):
        return ".".join(path.split(".")[-parts:])
    names = {}
    for path in paths:
        names[path] = next(end(path, parts) for parts in range(1, path.count(".") + 2)
                           if sum(end(other, parts) == end(path, parts) for other in paths) == 1)
    return names


def number(value, digits=4):
    return "-" if value is None or not math.isfinite(value) else f"{value:.{digits}g}"


def percent(part, whole):
    return f"{100 * part / abs(whole):.2g} %" if whole and math.isfinite(part) else "-"


def failed_sentences(rows):
    """Members that gave nothing, with their reasons: an answer must not pass them over."""
    lines = [f"Member {row.member.name} {row.status}: {row.reason}." for row in rows
             if row.status in ("failed", "interrupted")]
    left = sum(row.status == "left" for row in rows)
    return lines + ([f"{left} members were not run: no time was left."] if left else [])


def missing_sentences(rows, measures):
    """Measures that some members have and others have not: how they are taken must be said."""
    done = [row for row in rows if row.done]
    for name in measures:
        without = [row.member.name for row in done if row.measure(name) is None]
        if 0 < len(without) < len(done):
            listed = ", ".join(without[:5]) + (", ..." if len(without) > 5 else "")
            yield (f"{name} has no value in {len(without)} of {len(done)} members ({listed}): they are left out of "
                   f"what is said of it, and a refinement says no error of it.")


def reference_of(study, rows, name):
    """(value, half-width or None, source) of the truth of a measure, or None."""
    for row in rows:
        found = row.reference(name)
        if found:
            share = study.truth.get(name, (0, None, 0))[1]
            return found[0], found[2] if share is None else share * abs(found[0]), found[1]
    return None
