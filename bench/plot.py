"""What a sitting found, as pictures."""

import re

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter

from table import bounds, number, plural

OURS, THEIRS, DIFFERENT, LIMIT, GRID = "#d1495b", "#2e5266", "#9fb1bc", "#e0a458", "#e6e6e6"
DASHES = (0, (4, 2))
COLUMNS = 4


def write(results, folder):
    for name, figure in {"plot": panels(results), "growth": growth(results)}.items():
        if figure:
            for ending in ("svg", "png"):
                figure.savefig(folder / f"{name}.{ending}", dpi=150)
            plt.close(figure)


def panels(results):
    """A panel for each scene: a row for each engine, a dot for each number of threads, the faster with its number."""
    scenes = results["scenes"]
    names = list(dict.fromkeys(entry["name"] for scene in scenes for entry in scene["entries"]))
    columns = min(COLUMNS, len(scenes))
    rows = -(-len(scenes) // columns)
    size = 2.2 + 2.9 * columns, 1.3 + rows * (0.8 + 0.24 * len(names))
    figure, grid = plt.subplots(
        rows, columns, figsize=size, sharex=True, sharey=True, squeeze=False, layout="constrained"
    )
    axes = list(grid.flat)
    for axis, scene in zip(axes, scenes, strict=False):
        panel(axis, scene, names, results["limits"])
    for axis in axes[len(scenes) :]:
        axis.set_visible(False)
    for axis in axes[max(0, len(scenes) - columns) : len(scenes)]:
        axis.tick_params(labelbottom=True)
        axis.set_xlabel("ns per spring and step")
    figure.suptitle(
        "Explicit springs: time per spring and step, further left is faster", x=0.01, ha="left", fontsize=13
    )
    figure.legend(handles=legend(results), loc="outside lower left", ncols=5, frameon=False, fontsize=9)
    return figure


def panel(axis, scene, names, limits):
    tidy(axis)
    axis.set_xscale("log")
    axis.margins(x=0.12)
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.grid(axis="x", color=GRID, linewidth=0.7)
    axis.set_title(f"{scene['name']}, {scene['springs']:,} springs", fontsize=10, loc="left")
    if limits:
        arithmetic, traffic, _ = bounds(scene, limits[-1])
        axis.axvline(arithmetic, color=LIMIT, linewidth=1.4)
        axis.axvline(traffic, color=LIMIT, linewidth=1.4, linestyle=DASHES)
    for row, name in enumerate(names):
        entries = [entry for entry in scene["entries"] if entry["name"] == name and entry["ns"] is not None]
        for entry in entries:
            dot(axis, entry["ns"], row, entry["threads"] > 1, entry["differs"], colour(entry))
        if entries:
            best = min(entry["ns"] for entry in entries)
            axis.annotate(
                number(best), (best, row), (-7, 0), textcoords="offset points", ha="right", va="center", fontsize=8,
                color=colour(entries[0]), bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5},
            )  # fmt: skip
    axis.set_yticks(range(len(names)), names, fontsize=9)
    axis.set_ylim(len(names) - 0.4, -0.6)
    for text in axis.get_yticklabels():
        if text.get_text() == "sprung":
            text.set(color=OURS, fontweight="bold")


def dot(axis, ns, row, several_threads, differs, color):
    """A ring for one thread and a disc for several, of two sizes, so that neither hides the other."""
    if differs:
        marker = {"marker": "x", "markersize": 6}
    elif several_threads:
        marker = {"marker": "o", "markersize": 4.5}
    else:
        marker = {"marker": "o", "markersize": 7.5, "markerfacecolor": "none"}
    axis.plot(ns, row, color=color, markeredgewidth=1.5, zorder=3, **marker)


def legend(results):
    threads = results["machine"]["processors"]
    style = {"linestyle": "", "markeredgewidth": 1.5}
    handles = [
        Line2D([], [], marker="o", color=THEIRS, markerfacecolor="none", markersize=7.5, label="1 thread", **style)
    ]
    if threads > 1:
        handles.append(
            Line2D([], [], marker="o", color=THEIRS, markersize=4.5, label=plural(threads, "thread"), **style)
        )
    if any(entry["differs"] for scene in results["scenes"] for entry in scene["entries"]):
        handles.append(Line2D([], [], marker="x", color=DIFFERENT, label="not the same motion", **style))
    if results["limits"]:
        on = plural(threads, "thread")
        handles.append(Line2D([], [], color=LIMIT, label=f"arithmetic alone, {on}"))
        handles.append(Line2D([], [], color=LIMIT, linestyle=DASHES, label=f"traffic of a plain layout alone, {on}"))
    return handles


def growth(results):
    """How cost grows with size, if one shape was measured in three sizes or more: each engine at its fastest."""
    sizes = {}
    for scene in results["scenes"]:
        if match := re.fullmatch(r"([a-z]+)\d+", scene["name"]):
            sizes.setdefault(match[1], []).append(scene)
    shape, scenes = max(sizes.items(), key=lambda item: len(item[1]), default=("", []))
    if len(scenes) < 3:
        return None
    curves = {}
    for scene in sorted(scenes, key=lambda scene: scene["springs"]):
        best = {}
        for entry in scene["entries"]:
            if entry["ns"] is not None and not entry["differs"]:
                best[entry["name"]] = min(entry["ns"], best.get(entry["name"], entry["ns"]))
        for name, ns in best.items():
            curves.setdefault(name, []).append((scene["springs"], ns))

    figure, axis = plt.subplots(figsize=(8.5, 5.5), layout="constrained")
    tidy(axis)
    axis.grid(color=GRID, linewidth=0.7)
    axis.set(xscale="log", yscale="log", xlabel="springs", ylabel="ns per spring and step")
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    for name, points in curves.items():
        color, width = (OURS, 2.4) if name == "sprung" else (THEIRS, 1.3)
        axis.plot(*zip(*points, strict=True), "o-", color=color, markersize=4, linewidth=width)
    name_curves(axis, curves)
    axis.set_title(f"How cost grows with size: the {shape}, each engine at its fastest", loc="left", fontsize=12)
    return figure


def name_curves(axis, curves):
    """Writes the names at the right, in the order in which the curves end, pushed apart where these meet."""
    right = max(points[-1][0] for points in curves.values())
    low, high = axis.get_ylim()
    gap = (high / low) ** 0.042
    height = 0.0
    for name, (x, y) in sorted(((name, points[-1]) for name, points in curves.items()), key=lambda item: item[1][1]):
        height = max(y, height * gap)
        color, weight = (OURS, "bold") if name == "sprung" else (THEIRS, "normal")
        axis.annotate(
            name, (x, y), (right * 1.5, height), color=color, fontsize=9, fontweight=weight, va="center",
            arrowprops={"arrowstyle": "-", "color": DIFFERENT, "linewidth": 0.7, "relpos": (0, 0.5), "shrinkB": 4},
        )  # fmt: skip
    axis.set_xlim(right=right * 14)


def colour(entry):
    return DIFFERENT if entry["differs"] else OURS if entry["key"] == "sprung" else THEIRS


def tidy(axis):
    for side in ("top", "right", "left"):
        axis.spines[side].set_visible(False)
    axis.tick_params(which="both", length=0)
    axis.set_axisbelow(True)
