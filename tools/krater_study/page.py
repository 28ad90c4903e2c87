# SPDX-License-Identifier: GPL-3.0-or-later
"""study.html: one page that needs nothing beside it."""

import html
import re

from members import text_of

STYLE = """
:root { --ink: #1b2733; --soft: #5b6875; --line: #dfe4e9; --paper: #ffffff; --shade: #f5f7f9;
  --blue: #1f5f99; --red: #b5402a; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--shade); color: var(--ink); font: 15px/1.55 system-ui, "DejaVu Sans", sans-serif; }
main { max-width: 1080px; margin: 0 auto; padding: 40px 44px 64px; background: var(--paper); min-height: 100vh; }
h1 { font-size: 27px; line-height: 1.25; margin: 0 0 4px; font-weight: 650; letter-spacing: -0.01em; }
h2 { font-size: 17px; margin: 40px 0 10px; font-weight: 650; }
.kind { color: var(--blue); font-size: 12px; font-weight: 650; letter-spacing: 0.08em; text-transform: uppercase; }
.made { color: var(--soft); font-size: 13px; margin: 0 0 26px; }
.figures { display: flex; flex-wrap: wrap; gap: 12px; margin: 18px 0 8px; padding: 0; }
.figures div { flex: 1 1 130px; border: 1px solid var(--line); border-radius: 8px; padding: 10px 14px; }
.figures b { display: block; font-size: 20px; font-weight: 600; }
.figures span { color: var(--soft); font-size: 12px; }
ul.said { padding-left: 20px; } ul.said li { margin: 5px 0; }
figure { margin: 18px 0; } figure svg { width: 100%; height: auto; max-width: 1000px; }
figcaption { color: var(--soft); font-size: 13px; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; width: 100%; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; color: var(--soft); border-bottom: 1.5px solid var(--line);
  padding: 6px 10px 6px 0; }
td { border-bottom: 1px solid var(--line); padding: 6px 10px 6px 0; vertical-align: top; white-space: nowrap; }
td.text { white-space: normal; min-width: 150px; } tr.bad td { color: var(--red); }
code { font: 12.5px/1.5 "DejaVu Sans Mono", monospace; background: var(--shade); padding: 1px 4px; border-radius: 3px; }
@media print { body { background: none; } main { padding: 0; } }
"""


def text(value):
    return html.escape(str(value))


def number(value):
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else text(value)


def table(titles, rows, bad=()):
    lines = ["<div class=wide><table><thead><tr>", *(f"<th>{text(title)}</th>" for title in titles),
             "</tr></thead><tbody>"]
    for k, row in enumerate(rows):
        lines.append("<tr class=bad>" if k in bad else "<tr>")
        lines += [f"<td class=text>{cell}</td>" if len(cell) > 40 else f"<td>{cell}</td>" for cell in map(number, row)]
        lines.append("</tr>")
    return "".join(lines) + "</tbody></table></div>"


def svg(source):
    """The drawing alone, its ids made its own by the caller's order on the page."""
    return re.sub(r'(<svg[^>]*?) width="[^"]*" height="[^"]*"', r"\1", source[source.index("<svg"):], 1, re.S)


def in_words(count):
    return next((f"{count / size:.3g} {word}" for size, word in ((1e9, "billion"), (1e6, "million")) if count >= size), f"{count:.0f}")


def page(made, rows, answer, columns, drawn):
    machine = made["machine"]
    done = [row for row in rows if row.done]
    core = sum(row.cost.get("core_seconds", 0) for row in done)
    facts = [(f"{len(done)} of {len(rows)}", "members done"), (text_of(core), "core time"),
             (in_words(sum(row.cost.get("point_steps", 0) for row in done)), "point-steps"),
             (f"{max((row.cost.get('bytes', 0) for row in done), default=0) / 2**20:.0f} MiB", "greatest memory")]
    out = ["<!doctype html><html lang=en><head><meta charset=utf-8>"
           '<meta name=viewport content="width=device-width, initial-scale=1">',
           f"<title>{text(made['title'])}</title><style>{STYLE}</style></head><body><main>",
           f"<div class=kind>{text(made['kind'].replace('_', ' '))}</div><h1>{text(made['title'])}</h1>",
           f"<p class=made>{text(made['date'])} &middot; scene <code>{text(made['scene'])}</code> &middot; study "
           f"<code>{text(made['study'])}</code> &middot; {text(made['program'])}</p><div class=figures>",
           *(f"<div><b>{text(a)}</b><span>{text(b)}</span></div>" for a, b in facts), "</div>"]
    if answer.sentences:
        out += ["<h2>What it says</h2><ul class=said>", *(f"<li>{text(line)}</li>" for line in answer.sentences),
                "</ul>"]
    for picture in answer.pictures:
        out.append(f"<figure>{svg(drawn[picture.name])}<figcaption>{text(picture.caption)}</figcaption></figure>")
    for one in answer.tables:
        out.append(f"<h2>{text(one.caption)}</h2>" + table(one.titles, one.rows))
    out.append("<h2>Members</h2>" + table(
        [f"{title} [{unit}]" if unit and unit != "1" else title for title, unit, _ in columns],
        list(zip(*(values for *_, values in columns))), {k for k, row in enumerate(rows) if not row.done}))
    out.append(f"<h2>How it was made</h2><p>On {text(machine['host'])}, {machine['cores']} cores of "
               f"{text(machine['processor'])}, "
               f"{machine['clock_MHz'] or 0:.0f} MHz, numpy triad {machine['triad_GB_per_s']} GB/s on one core, load "
               f"average "
               f"{machine['load_average']:.1f}. Core-seconds are user and system time of a member's process; wall "
               f"times under "
               "load are not those of a quiet machine. Every number of this page is in <code>study.csv</code>, "
               "<code>study.h5</code> and <code>study.json</code> beside it; each member's results lie in "
               "<code>members/</code>.</p></main></body></html>\n")
    return "".join(out)
