# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a study, drawn into a matplotlib figure: small multiples, one look for all kinds."""

import math

import numpy as np

from answer import scaled

INK, BLUE, RED, GREY, GOLD = "#1b2733", "#1f5f99", "#b5402a", "#8794a1", "#c98a1b"
STYLE = {"font.family": "DejaVu Sans", "font.size": 9, "axes.edgecolor": GREY, "axes.labelcolor": INK,
         "text.color": INK,
         "xtick.color": INK, "ytick.color": INK, "axes.spines.top": False, "axes.spines.right": False,
         "axes.titlesize": 10,
         "axes.titlelocation": "left", "axes.grid": True, "axes.axisbelow": True, "grid.color": "#e6eaee", "legend.frameon": False,
         "svg.fonttype": "none", "svg.hashsalt": "krater", "figure.constrained_layout.use": True}


def style():
    import matplotlib  # here, not above: it takes longer to load than a small study to run
    matplotlib.use("Agg")
    matplotlib.rcParams.update(STYLE)


def grid(figure, count, width=3.4, height=2.6, columns=3):
    """Axes of small multiples."""
    columns = max(1, min(columns, count))
    rows = max(1, math.ceil(count / columns))
    figure.set_size_inches(width * columns if columns > 1 else 5.2, height * rows if columns > 1 else 3.6)
    return [figure.add_subplot(rows, columns, k + 1) for k in range(max(1, count))]


def convergence(figure, curves):
    drawn = {name: c for name, c in curves.items() if any(v is not None for v in c["values"])}
    for axes, (name, c) in zip(grid(figure, len(drawn)), drawn.items()):
        scale, unit = scaled(c["unit"])
        pairs = [(1e3 * h, scale * v) for h, v in zip(c["cells"], c["values"]) if v is not None]
        h, v = np.array(pairs).T
        if c["uncertainty"] is not None:
            axes.axhspan(scale * (c["value"] - c["uncertainty"]), scale * (c["value"] + c["uncertainty"]), color=BLUE,
                         alpha=0.13, lw=0)
        if c["reference"]:
            value, half, _ = c["reference"]
            axes.axhline(scale * value, color=RED, lw=1)
            if half:
                axes.axhspan(scale * (value - half), scale * (value + half), color=RED, alpha=0.12, lw=0)
        axes.plot(h, v, "o", color=BLUE, ms=4.5, mec="white", mew=0.6)
        axes.set_ylim(*axes.get_ylim())  # the curve does not set the scale
        if c["behaviour"] == "converges":
            fine = np.geomspace(h.min() / 3, h.max(), 80)
            a = (c["value"] - c["limit"]) / (h.min() ** c["order"])
            axes.plot(fine, scale * (c["limit"] + a * fine ** c["order"]), color=BLUE, lw=1, alpha=0.7)
        axes.set_xscale("log")
        axes.set_xlim(h.min() / 3, h.max() * 1.25)
        levels = [v for k, v in enumerate(sorted(h)) if k == 0 or v > 1.15 * sorted(h)[k - 1]]
        axes.set_xticks(levels, [f"{v:.3g}" for v in levels])
        axes.set_xticks([], minor=True)
        axes.set_title(name)
        axes.set_xlabel("cell [mm]")
        axes.set_ylabel(unit or "-")
        word = c["behaviour"] + (f", order {c['order']:.1f}" if c["order"] else "")
        axes.set_title(word, loc="right", color=GREY, fontsize=8)


def cost(figure, curves):
    axes = grid(figure, 1)[0]
    for k, (name, c) in enumerate(curves.items()):
        best = c["limit"] if c["limit"] is not None else c["value"]
        if not best:
            continue
        pairs = sorted((t, 100 * abs(v / best - 1)) for t, v in zip(c["core_seconds"], c["values"]) if v is not None)
        pairs = [(t, e) for t, e in pairs if e > 0 and t > 0]
        if pairs:
            axes.loglog(*zip(*pairs), "o-", ms=5, lw=0.6, mec="white", label=name, color=f"C{k}")
    for target in (5, 2, 1, 0.5):
        axes.axhline(target, color=GREY, lw=0.6, ls=":")
        axes.annotate(f"{target:g} %", (1, target), xycoords=("axes fraction", "data"), fontsize=6.5, color=GREY,
                      ha="right", va="bottom")
    axes.set_xlabel("core-seconds")
    axes.set_ylabel("distance to the limit [%]")
    if axes.lines:
        axes.legend(fontsize=8)


def plain_ticks(axis):
    """0.1 0.2 0.5 1: powers of ten with a 2 x before them are hard to read."""
    from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(FormatStrFormatter("%g"))
    axis.set_minor_formatter(NullFormatter())


def front(figure, clouds):
    """clouds: measure -> {cost, error [%], labels, front: indices, known: error of the truth [%]}."""
    for axes, (name, c) in zip(grid(figure, len(clouds)), clouds.items()):
        t, e = np.asarray(c["cost"], float), np.maximum(np.asarray(c["error"], float), 1e-4)
        axes.loglog(t, e, "o", color=GREY, ms=4.5, mec="white")
        on = sorted(c["front"], key=lambda i: t[i])
        axes.loglog(t[on], e[on], "o-", color=BLUE, ms=5, lw=1, mec="white")
        for i in on:
            axes.annotate(c["labels"][i], (t[i], e[i]), xytext=(4, 4), textcoords="offset points", fontsize=6.5,
                          color=INK)
        if c["known"]:
            axes.axhspan(axes.get_ylim()[0], c["known"], color=RED, alpha=0.1, lw=0)
        plain_ticks(axes.xaxis)
        plain_ticks(axes.yaxis)
        axes.set_title(name)
        axes.set_xlabel("core-seconds")
        axes.set_ylabel("error [%]")


def bars(figure, effects):
    """effects: measure -> {effect: change in %}."""
    for axes, (name, changes) in zip(grid(figure, len(effects)), effects.items()):
        names = list(changes)[::-1]
        values = [changes[k] if changes[k] is not None else 0 for k in names]
        axes.barh(names, values, color=[RED if v < 0 else BLUE for v in values], height=0.6)
        axes.axvline(0, color=INK, lw=0.8)
        axes.set_title(name)
        axes.set_xlabel("change without it [%]")


def scatter(figure, inputs, outputs):
    """Every measure against every input: inputs {path: (values, unit)}, outputs {measure: (values, unit)}."""
    pairs = [(x, y) for y in outputs for x in inputs]
    for axes, (x, y) in zip(grid(figure, len(pairs), columns=max(1, len(inputs))), pairs):
        scale, unit = scaled(outputs[y][1])
        axes.plot(inputs[x][0], np.asarray(outputs[y][0], float) * scale, "o", color=BLUE, ms=4, mec="white")
        axes.set_xlabel(f"{x.rsplit('.', 1)[-1]} [{inputs[x][1] or '-'}]")
        axes.set_ylabel(f"{y} [{unit or '-'}]")


def limit(figure, shots, fit, unit):
    """shots: [(speed, residual or 0, perforated)]; fit: function or None, with its band."""
    axes = grid(figure, 1)[0]
    for through, colour, label in ((True, BLUE, "perforated"), (False, RED, "not perforated")):
        chosen = [(v, r) for v, r, p in shots if p == through]
        if chosen:
            axes.plot(*zip(*chosen), "o", color=colour, ms=5, mec="white", label=label)
    if fit:
        low, high = fit["interval"]
        axes.axvspan(low, high, color=GOLD, alpha=0.18, lw=0)
        top = max(v for v, _, _ in shots) * 1.03
        v = np.linspace(fit["limit"], top, 200)
        axes.plot(v, fit["a"] * np.maximum(v ** fit["p"] - fit["limit"] ** fit["p"], 0) ** (1 / fit["p"]), color=BLUE,
                  lw=1)
        axes.axvline(fit["limit"], color=GOLD, lw=1)
    axes.set_xlabel(f"impact speed [{unit}]")
    axes.set_ylabel("residual speed [m/s]")
    axes.legend(fontsize=8)


def limits(figure, found, middles, band, unit):
    """Shots of several cells, and their limits against the cell with the band of the finest."""
    left, right = grid(figure, 2, 4.2, 3.4)
    for k, one in enumerate(found):
        through = [(v, r) for v, r, p in one["shots"] if p]
        stopped = [v for v, _, p in one["shots"] if p is False]
        left.plot(*zip(*through), "o", color=f"C{k}", ms=5, mec="white", label=f"{1e3 * one['cell']:.3g} mm")
        left.plot(stopped, [0] * len(stopped), "x", color=f"C{k}", ms=4.5)
        if one["fit"]:
            fit, v = one["fit"], np.linspace(one["fit"]["limit"], max(v for v, _ in through), 200)
            left.plot(v, fit["a"] * np.maximum(v ** fit["p"] - fit["limit"] ** fit["p"], 0) ** (1 / fit["p"]), color=f"C{k}", lw=1)
        low, high = one["bracket"]
        right.errorbar(1e3 * one["cell"], middles[k], [[middles[k] - low], [high - middles[k]]], fmt="o", color=f"C{k}", ms=5,
                       mec="white", capsize=3)
    finest = min(range(len(found)), key=lambda k: found[k]["cell"])
    right.axhspan(max(0.0, middles[finest] - band), middles[finest] + band, color=BLUE, alpha=0.13, lw=0)
    right.set_xlim(0, 1.1e3 * max(one["cell"] for one in found))
    right.set_ylim(max(0.0, min(middles) - band), min(max(middles) + band, 1.3 * max(middles)))
    left.set(xlabel=f"impact speed [{unit}]", ylabel="residual speed [m/s]")
    right.set(xlabel="cell [mm]", ylabel=f"limit [{unit}]")
    left.legend(fontsize=8)


def search(figure, trials, best):
    """trials: {path: (values, unit)}, `residual` among them; best: {path: (value, half)}."""
    paths = [path for path in trials if path != "residual"]
    for axes, path in zip(grid(figure, len(paths)), paths):
        axes.semilogy(trials[path][0], np.maximum(trials["residual"][0], 1e-6), "o", color=BLUE, ms=4.5, mec="white")
        value, half = best[path]
        axes.axvline(value, color=GOLD, lw=1)
        if half is not None:
            axes.axvspan(value - half, value + half, color=GOLD, alpha=0.18, lw=0)
        axes.set_xlabel(f"{path.rsplit('.', 1)[-1]} [{trials[path][1] or '-'}]")
        axes.set_ylabel("residual [uncertainties of the truth]")
