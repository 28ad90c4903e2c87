# SPDX-License-Identifier: GPL-3.0-or-later
"""What tools/report says in words and tables: scene, measures, energy, cost, provenance of runs."""

import html
import math
import os

import numpy as np
import yaml

from run_reader import reference_error, reference_of
from units import said, scale_of

COLOURS = ["#1f5f99", "#b5402a", "#2c8a4b", "#c98a1b", "#7d5ba6", "#1795a8"]  # of runs
PHASES = {"scatter": ("points to grid", "#1f5f99"), "nodes": ("grid nodes", "#7da7cc"), "contact": ("contact", "#b5402a"),
          "boundary": ("sides", "#e0a899"), "gather_and_stress": ("grid to points, material laws", "#2c8a4b"),
          "migrate": ("moving points between cells", "#a5cfb0"), "history_and_measures": ("measures, history", "#c98a1b"),
          "frames": ("writing frames", "#e7c98f"), "checkpoints": ("writing checkpoints", "#7d5ba6"),
          "setup": ("reading the scene, filling bodies", "#c3b2d9"), "rest": ("the rest", "#c9d0d6")}
LEDGER = [("initial_energy", "in the scene at the start"), ("external_work", "+ work from outside"),
          ("wall_work", "+ work of driven sides"), ("kinetic_energy", "kinetic"), ("internal_energy", "internal"),
          ("removed_energy", "left with removed points"), ("energy_residual", "unaccounted (round-off)")]
PARTS = [("plastic_work", "plastic work"), ("viscous_work", "artificial viscosity (shocks)"),
         ("friction_work", "friction"), ("contact_heat", "heat of contact"), ("wall_heat", "heat of sides"),
         ("transfer_loss", "points and grid: lost by motion, kept as heat"), ("transfer_gain", "points and grid: taken back"),
         ("hourglass_energy", "hourglass control"), ("level_heat", "change of cell size"),
         ("numerical_heat", "numerical: no law can feel it"), ("carried_energy", "owed, carried on")]


def text(value):
    return html.escape(str(value))


def table(titles, rows, numbers=(), sums=()):
    """Rows of ready HTML; columns in `numbers` to the right, rows in `sums` stand out."""
    def cell(tag, k, value):
        return f"<{tag}{' class=n' if k in numbers else ''}>{value}</{tag}>"
    head = "".join(cell("th", k, text(t)) for k, t in enumerate(titles))
    body = "".join(("<tr class=sum>" if n in sums else "<tr>") + "".join(cell("td", k, v) for k, v in enumerate(row)) + "</tr>"
                   for n, row in enumerate(rows))
    return f"<div class=wide><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"


def resolved(run):
    try:
        with open(os.path.join(run.folder, "resolved.yaml"), encoding="utf-8") as file:
            source = file.read()
        return source, yaml.safe_load(source) or {}
    except (OSError, yaml.YAMLError):
        return "", {}


def plain(value):
    """A number that YAML left as a text (4e-04), or the value itself."""
    try:
        return float(value) if isinstance(value, str) else value
    except ValueError:
        return value


def words(value, unit=None):
    """A value of a scene in a line."""
    value = plain(value)
    if isinstance(value, dict):
        return ", ".join(f"{key} {words(v, unit)}" for key, v in value.items())
    if isinstance(value, list):
        return "[" + ", ".join(words(v, unit) for v in value) + "]"
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return said(value, unit) if unit else f"{value:.6g}"


def shape_words(shape):
    """cylinder: radius 3.81 mm, height 25.4 mm, ... of a block of the resolved scene."""
    if not isinstance(shape, dict) or not shape:
        return words(shape)
    kind, keys = next(iter(shape.items()))
    if not isinstance(keys, dict):
        return f"{kind} of {len(keys)} shapes" if isinstance(keys, list) else f"{kind} {words(keys)}"
    parts = []
    for key, value in keys.items():
        numeric = plain(value[0] if isinstance(value, list) and value else value)
        length = isinstance(numeric, (int, float)) and key not in ("crh", "angle")
        parts.append(f"{key} {shape_words(value) if key == 'shape' else words(value, 'm' if length else None)}")
    return f"{kind}: " + ", ".join(parts)


# ------------------------------------------------------------------------------------------ scene

def body_rows(run, scene):
    first = run.file["frames"][run.numbers[0]]
    for name, body in (scene.get("bodies") or {}).items():
        if not isinstance(body, dict):
            continue
        group = first.get(name)
        count = len(group["id"]) if group is not None else 0
        mass = float(group["mass"][()].sum()) if group is not None and "mass" in group else None
        kind = body.get("kinematics", "mpm")
        kind = next(iter(kind)) if isinstance(kind, dict) else kind
        yield [text(name), text(body.get("material", "-")), text(shape_words(body.get("shape"))),
               text(words(body.get("velocity", "-"), "m/s")), text(kind.replace("_", " ")), f"{count:,}", said(mass, "kg")]


def law_rows(scene):
    for name, material in (scene.get("materials") or {}).items():
        if not isinstance(material, dict):
            continue
        laws = []
        for key in ("model", "strength", "eos", "damage", "spall", "heating", "viscosity", "rate", "failure"):
            value = material.get(key)
            if value is None or (key == "rate" and value == "truesdell"):
                continue
            law = next((k for k, v in value.items() if isinstance(v, dict)), None) if isinstance(value, dict) else None
            constants = value[law] if law else value
            laws.append(f"<b>{text(key)}</b> {text((law or '').replace('_', ' '))} "
                        f"<span class=soft>{text(words(constants))}</span>")
        yield [text(name), said(plain(material.get("density")), "kg/m^3"), "<br>".join(laws)]


def scene_section(run):
    source, scene = resolved(run)
    grid = scene.get("grid") or {}
    method, box = scene.get("method") or {}, grid.get("box") or {}
    bodies = list(body_rows(run, scene))
    rows = [["grid", f"cell {text(words(grid.get('cell', '-'), 'm'))}, box {text(words(box, 'm'))}"],
            ["sides", text(words(grid.get("boundary", {})))],
            ["time", f"to {text(words((scene.get('time') or {}).get('end', '-'), 's'))}"],
            ["method", text(", ".join(str(method[k]).replace("_", " ") for k in ("transfer", "shape", "update", "reference")
                                      if k in method))]]
    if scene.get("contact"):
        rows.append(["contact", text(words(scene["contact"]))])
    parts = [table(["body", "material", "shape", "velocity", "kinematics", "points", "mass"], bodies, (5, 6)) if bodies else "",
             table(["material", "density", "laws, constants in SI"], list(law_rows(scene))) if scene.get("materials") else "",
             table(["", ""], rows)]
    return "".join(parts), source


def flat(scene, path=""):
    if isinstance(scene, dict):
        for key, value in scene.items():
            yield from flat(value, f"{path}.{key}" if path else str(key))
    else:
        yield path, words(scene)


def differences_section(runs):
    """What the resolved scenes of several runs have different."""
    scenes = [dict(flat(resolved(run)[1])) for run in runs]
    keys = [key for key in dict.fromkeys(k for scene in scenes for k in scene)
            if len({scene.get(key) for scene in scenes}) > 1]
    if not keys:
        return "<p>The scenes are the same, key by key.</p>"
    rows = [[f"<code>{text(key)}</code>"] + [text(scene.get(key, "-")) for scene in scenes] for key in keys[:60]]
    more = f"<p class=soft>and {len(keys) - 60} more keys</p>" if len(keys) > 60 else ""
    return "<h3>What differs</h3>" + table(["key (SI)"] + [label(run, runs) for run in runs], rows) + more


def label(run, runs):
    """What a run is called among others: its folder where titles are the same."""
    folder = os.path.basename(os.path.abspath(run.folder))
    return folder if len({r.title() for r in runs}) < len(runs) or len(runs) > 1 else run.title()


# ------------------------------------------------------------------------------------------ measures

def whisker(off, band, bar, most):
    """A dot at its distance from the reference [%] with its band, and the bar that the reference has, on a scale to +-most."""
    w, middle = 260, 130
    def x(v):
        return middle + (middle - 12) * max(-1.0, min(1.0, v / most))
    out = [f"<svg width={w} height=20 role=img aria-label='{off:+.2f} %'>",
           f"<line x1=12 x2={w - 12} y1=10 y2=10 stroke=#e1e6ea />",
           "" if bar is None else f"<rect class=theirs x={x(-bar):.1f} width={x(bar) - x(-bar):.1f} y=3 height=14 fill=#b5402a opacity=0.2 />",
           f"<line x1={middle} x2={middle} y1=1 y2=19 stroke=#b5402a stroke-width=1.6 />"]
    if band is not None:
        out.append(f"<line x1={x(off - band):.1f} x2={x(off + band):.1f} y1=10 y2=10 stroke=#1f5f99 stroke-width=2 />")
        out += [f"<line x1={x(off + s * band):.1f} x2={x(off + s * band):.1f} y1=6 y2=14 stroke=#1f5f99 stroke-width=2 />"
                for s in (-1, 1)]
    out.append(f"<circle cx={x(off):.1f} cy=10 r=4.2 fill={'#fff' if abs(off) > most else '#1f5f99'} stroke=#1f5f99 "
               "stroke-width=1.6 /></svg>")
    return "".join(out)


def offs_of(runs):
    """Distances to references with their bands, of all runs [%]."""
    for run in runs:
        for measure in (run.summary.get("measures") or {}).values():
            wanted = reference_of(measure)[0]
            if wanted and isinstance(measure.get("value"), (int, float)):
                yield abs(100 * (measure["value"] / wanted - 1)) + abs(100 * (measure.get("uncertainty") or 0) / wanted)
                yield abs(100 * (reference_error(measure) or 0) / wanted)


def measure_row(name, measure, run, runs, most):
    value, (wanted, source), band = measure.get("value"), reference_of(measure), measure.get("uncertainty")
    bar = reference_error(measure)
    numbers = [abs(v) for v in (value, wanted) if isinstance(v, (int, float))]
    divisor, unit = scale_of(max(numbers, default=0), measure.get("unit", ""))
    def shown(v, digits=5):
        return "-" if not isinstance(v, (int, float)) else f"{v / divisor:.{digits}g}"
    off = 100 * (value / wanted - 1) if wanted and isinstance(value, (int, float)) else None
    drawn = "" if off is None else whisker(off, *(None if v is None else abs(100 * v / wanted) for v in (band, bar)), most)
    notes = [f"{measure['keep']}, at {said(measure.get('time'), 's')}"] if measure.get("keep") else []
    notes += ["rarefied: hardly a surface"] if measure.get("rarefied") else []
    notes += [str(measure["uncertainty_from"])] if measure.get("uncertainty_from") else []
    notes += [source] if wanted is not None else []
    first = [text(name.replace("_", " "))] + ([text(label(run, runs))] if len(runs) > 1 else [])
    return first + [shown(value), "?" if band is None else shown(band, 2), text(unit),
                    shown(wanted) + ("" if bar is None else f" ± {shown(bar, 2)}"),
                    "" if off is None else f"{off:+.2f} %", drawn, f"<span class=soft>{text('; '.join(notes))}</span>"]


def measures_section(runs):
    names = list(dict.fromkeys(name for run in runs for name in run.summary.get("measures") or {}))
    if not names:
        return "<p class=soft>The scene has no <code>measures:</code>.</p>"
    most = max([1.0, *(off for off in offs_of(runs) if math.isfinite(off) and off < 50)])
    most = next(step for step in (1, 2, 5, 10, 20, 50) if step >= most or step == 50)
    rows = [measure_row(name, run.summary["measures"][name], run, runs, most) for name in names for run in runs
            if isinstance((run.summary.get("measures") or {}).get(name), dict)]
    many = len(runs) > 1
    titles = ["measure"] + ["run"] * many + ["value", "±", "unit", "reference", "difference", f"−{most} % … +{most} %", "notes"]
    out = table(titles, rows, tuple(k + many for k in (1, 2, 4, 5)))
    if not any("uncertainty" in m for run in runs for m in (run.summary.get("measures") or {}).values() if isinstance(m, dict)):
        out += ("<p class=soft>± is not known: one cell says nothing about its own error. "
                "<code>krater run SCENE --accuracy 2%</code> or a <code>krater study</code> finds it.</p>")
    else:
        out += "<p class=soft>± is meant to hold the limit of small cells in nine of ten cases; the red line is the reference.</p>"
    if any(reference_error(m) for run in runs for m in (run.summary.get("measures") or {}).values() if isinstance(m, dict)):
        out += "<p class=soft>The red bar is the error that the reference's own source gives.</p>"
    for run in runs:
        out += "".join(f"<p><b>{text(name)}</b>: {text(str(of.get('outcome', '')).replace('_', ' '))}, residual speed "
                       f"{said(of.get('residual_speed'), 'm/s')}</p>" for name, of in (run.summary.get("outcomes") or {}).items())
    return out


# ------------------------------------------------------------------------------------------ energy and cost

def audit_of(run):
    return {**run.summary, **(run.summary.get("audit") or {})}


def ledger(runs, entries, least):
    """Rows of entries that any run has; in parts of the greatest energy too."""
    rows = []
    for key, words_of in entries:
        values = [audit_of(run).get(key) for run in runs]
        good = [v for v in values if isinstance(v, (int, float))]
        if not good or (least and max(map(abs, good)) == 0):
            continue
        row = [text(words_of)]
        for run, value in zip(runs, values):
            start = audit_of(run).get("initial_energy") or 0
            row += [said(value, "J", 5), f"{100 * value / start:.3g} %" if start and value is not None else ""]
        rows.append(row)
    return rows


def energy_section(runs):
    titles = ["energy"] + [t for run in runs for t in (label(run, runs) if len(runs) > 1 else "value", "of the start")]
    right = tuple(range(1, len(titles)))
    found = [f"{100 * e:.2g} %" for run in runs for e in [audit_of(run).get("energy_error_fraction")] if e is not None]
    out = "<div class=narrow>" + table(titles, ledger(runs, LEDGER, False), right)
    parts = ledger(runs, PARTS, True)
    if parts:
        out += "<h3>Where it went</h3>" + table(titles, parts, right)
    return out + "</div>" + (f"<p>Energy that is not physical: {', '.join(found)} of the greatest energy in the scene "
                  "(a run warns above 1 %).</p>" if found else "")


def cost_bar(run):
    machine = run.summary.get("machine") or {}
    every = {**(machine.get("seconds") or {}), **(machine.get("seconds_outside_steps") or {})}
    seconds = {k: v for k, v in every.items() if isinstance(v, (int, float)) and v > 0}
    if not seconds:
        return ""
    wall = machine.get("wall_seconds") or 0
    rest = wall + seconds.get("setup", 0) - sum(seconds.values())
    if rest > 0.005 * wall:
        seconds["rest"] = rest
    total = sum(seconds.values())
    named = {k: PHASES.get(k, (k.replace("_", " "), "#8794a1")) for k in seconds}
    bar = "".join(f"<i style='width:{100 * v / total:.2f}%;background:{named[k][1]}' title='{text(named[k][0])}: {v:.3g} s'></i>"
                  for k, v in seconds.items())
    key = "".join(f"<span><i class=dot style='background:{named[k][1]}'></i>{text(named[k][0])} {v:.3g} s, "
                  f"{100 * v / total:.0f} %</span> " for k, v in seconds.items())
    return f"<div class=bar>{bar}</div><div class=key>{key}</div>"


def cost_section(run):
    machine = run.summary.get("machine") or {}
    facts = [f"{machine['wall_seconds']:.3g} s of wall time" if "wall_seconds" in machine else "",
             f"{machine['threads']} thread{'s' * (machine['threads'] > 1)}, {machine.get('instruction_set')}" if machine.get("threads") else "",
             f"{machine['point_steps_per_second'] / 1e6:.3g} million point-steps/s" if machine.get("point_steps_per_second") else "",
             f"{machine['peak_resident_bytes'] / 2**20:.0f} MiB of memory" if machine.get("peak_resident_bytes") else ""]
    times = machine.get("ns_per_point_step") or {}
    rows = []
    for effect in run.summary.get("effects") or []:
        if effect.get("law") == "off":
            continue
        owner = effect.get("material")
        key = f"{owner}.{effect['effect']}" if owner else effect["effect"]
        rows.append([text(owner or "scene"), text(effect["effect"]), text(str(effect.get("law")).replace("_", " ")),
                     f"{times[key]:.1f}" if key in times else "-", f"{effect.get('bytes_per_point', '-')}",
                     text(effect.get("influence", "-")), text(effect.get("advice", ""))])
    for key, value in times.items():
        if key.endswith("all_stages"):
            rows.append([text(key.rpartition(".")[0]), "all stages of its laws", "", f"{value:.1f}", "", "", ""])
    if "whole_step" in times:
        rows.append(["", "whole step", "", f"{times['whole_step']:.1f}", "", "", ""])
    out = f"<p>{text(', '.join(filter(None, facts)))}</p>" + cost_bar(run)
    if rows:
        out += table(["of", "effect", "law", "ns per point and step", "bytes per point", "influence", "advice"], rows, (3, 4),
                     [len(rows) - 1] if "whole_step" in times else [])
    return out


# ------------------------------------------------------------------------------------------ provenance

def provenance_section(run, source):
    program, machine = run.summary.get("program") or {}, run.summary.get("machine") or {}
    rows = [["program", text(f"krater {program.get('version', '?')}, revision {program.get('revision', '?')}")],
            ["built by", text(f"{program.get('compiler', '?')}, {program.get('build', '?')}")],
            ["machine", text(f"{machine.get('host', '?')}, {machine.get('threads', '?')} threads, "
                             f"{machine.get('instruction_set', '?')}")],
            ["command", f"<code>{text(run.command() or 'not told')}</code>"],
            ["results", f"<code>{text(os.path.abspath(run.folder))}</code>"]]
    out = table(["", ""], rows)
    if source:
        out += f"<details><summary>the scene with every default filled in (resolved.yaml)</summary><pre>{text(source)}</pre></details>"
    try:
        with open(os.path.join(run.folder, "log.txt"), encoding="utf-8", errors="replace") as file:
            out += f"<details><summary>what the run said (log.txt)</summary><pre>{text(file.read()[-60000:])}</pre></details>"
    except OSError:
        pass
    return out


def warnings_of(run):
    return [w for w in run.summary.get("warnings") or [] if isinstance(w, dict)]


def figures(run):
    summary = run.summary
    points = summary.get("points") or sum(len(g["id"]) for g in run.file["frames"][run.numbers[0]].values())
    pairs = [(run.frame.replace("_", " "), "frame"), (said(summary.get("cell"), "m"), "cell"), (f"{points:,}", "points"),
             (f"{summary.get('steps', 0):,}", "steps"), (said(float(run.time(run.numbers[-1])), "s"), "time"),
             (said((summary.get("machine") or {}).get("wall_seconds"), "s", 3), "wall time")]
    error = audit_of(run).get("energy_error_fraction")
    if isinstance(error, (int, float)) and np.isfinite(error):
        pairs.append((f"{100 * error:.1g} %", "unphysical energy"))
    return "<div class=figures>" + "".join(f"<div><b>{text(a)}</b><span>{text(b)}</span></div>" for a, b in pairs) + "</div>"
