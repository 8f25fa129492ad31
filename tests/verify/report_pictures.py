# SPDX-License-Identifier: MIT
"""Pictures of the verification report: work over precision, and the curves that a case draws."""

import io
import re
import sys
import textwrap
from pathlib import Path

import numpy as np
from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "post"))

import matplotlib.pyplot as plt  # noqa: E402  (found through the path above)
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: E402

from talus_style import GREY, LINES, use_style  # noqa: E402

MARKERS = "osD^vP*"
ROUND_OFF = 1e-8  # what is smaller has no order
SIZE = (4.4, 3.0)  # inches


def draw_pictures(story, folder):
    """Draw all pictures of a case; returns a list of (path, caption)."""
    use_style()
    made, rows = [], drawn_rows(story["runs"])
    if rows and story.get("work", True):
        made.append(draw_work(story, rows, folder))
    if story.get("order", True) and any(
        len({row["spacing"] for row in members}) > 2 for members in series_of(rows).values()
    ):
        made.append(draw_convergence(story, rows, folder))
    made += [draw_curves(story, picture, folder) for picture in story["pictures"]]
    return made


def save_small(figure, path):
    """Write a picture with a palette of colours, which keeps lines sharp and files small."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=120)
    plt.close(figure)
    buffer.seek(0)
    with Image.open(buffer) as image:
        image.convert("RGB").quantize(96, dither=Image.Dither.NONE).save(path, optimize=True)
    return path


def series_of(rows, name="series"):
    """Rows of each series, in the order in which they came."""
    return {title: [r for r in rows if r[name] == title] for title in dict.fromkeys(r[name] for r in rows)}


def drawn_rows(runs):
    """The worst row of each curve and spacing, of the curves that are more than round-off."""
    worst = {}
    for row in (r for r in runs if not r.get("exact")):
        key = row.get("curve", row["series"]), row["spacing"]
        if key not in worst or row["error"] > worst[key]["error"]:
            worst[key] = {**row, "series": key[0]}
    curves = series_of(list(worst.values())).values()
    return [row for rows in curves if max(r["error"] for r in rows) > ROUND_OFF for row in rows]


def quantity(story):
    """'Error', or what the case calls it."""
    words = story.get("quantity", "error")
    return words[:1].upper() + words[1:]


def log_axis(axis, values):
    """A logarithmic axis that shows at least a factor of ten, with numbers at 1, 2 and 5 or at decades."""
    values = np.asarray(values, float)
    middle = np.sqrt(values.min() * values.max())
    reach = max(1.25 * np.sqrt(values.max() / values.min()), np.sqrt(10.0))
    limit = axis.axes.set_xlim if axis.axis_name == "x" else axis.axes.set_ylim
    limit(middle / reach, middle * reach)
    if reach**2 < 200.0:
        axis.set_major_locator(LogLocator(10.0, subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def draw_points(axes, curves, x):
    """Log-log curves of rows with error > 0, from coarse to fine: {label: (rows, style)}."""
    shown = []
    for label, (rows, style) in curves.items():
        rows = [r for r in rows if r["error"] > 0 and r[x] > 0]
        rows.sort(key=lambda r: -r.get("spacing", r["error"]))
        if rows:
            axes.plot([r[x] for r in rows], [r["error"] for r in rows], label=label, **style)
            shown += rows
    axes.set_xscale("log")
    axes.set_yscale("log")
    if shown:
        log_axis(axes.xaxis, [r[x] for r in shown])
        log_axis(axes.yaxis, [r["error"] for r in shown])
    axes.grid(True)
    return shown


def styles():
    """Styles of the series of TALUS, one after the other."""
    for i in range(100):
        yield {"color": LINES[i % len(LINES)], "marker": MARKERS[i % len(MARKERS)], "markersize": 4.5}


def legend(figure, axes):
    """A legend where it hides nothing: above the axes, or at their right where it is long."""
    handles, labels = axes.get_legend_handles_labels()
    if len(labels) > 4:
        figure.set_figwidth(SIZE[0] + 0.3 + 0.065 * max(len(label) for label in labels))
        figure.set_figheight(max(SIZE[1], 0.3 + 0.17 * len(labels)))
        figure.legend(handles, labels, loc="outside right upper")
    elif labels:
        columns = 2 if max(len(label) for label in labels) < 34 else 1
        figure.legend(handles, labels, loc="outside upper left", ncols=columns)


def draw_work(story, rows, folder):
    """Error over wall seconds, with published points of other programs beside ours."""
    figure, axes = plt.subplots(figsize=SIZE)
    published = {
        title: (points, {"color": GREY, "marker": mark, "linestyle": "--", "markersize": 5, "mfc": "white"})
        for (title, points), mark in zip(series_of(story["published"], "program").items(), "sD^v")
    }
    ours = {
        (f"TALUS, {title}" if published else title): (members, style)
        for (title, members), style in zip(series_of(rows).items(), styles())
    }
    draw_points(axes, published | ours, "seconds")
    axes.set_xlabel("Wall time [s]")
    axes.set_ylabel(f"{quantity(story)} [-]")
    legend(figure, axes)
    path = save_small(figure, folder / f"{story['key']}_work_precision.png")
    return path, f"{quantity(story)} over wall time"


def draw_convergence(story, rows, folder):
    """Error over node spacing, with slopes of first and second order to compare with."""
    figure, axes = plt.subplots(figsize=SIZE)
    series = {
        title: members
        for title, members in series_of(rows).items()
        if len({row["spacing"] for row in members}) > 1
    }
    ours = {title: (members, style) for (title, members), style in zip(series.items(), styles())}
    shown = draw_points(axes, ours, "spacing")
    first = sorted((r["spacing"], r["error"]) for r in next(iter(series.values())))
    spacing, error = first[len(first) // 2]
    ends = np.array([min(r["spacing"] for r in shown), max(r["spacing"] for r in shown)])
    for order, dash in ((1, ":"), (2, "--")):
        line = error * (ends / spacing) ** order
        axes.plot(ends, line, color=GREY, linestyle=dash, linewidth=0.9, label=f"order {order}")
    axes.set_xlabel("Node spacing [m]")
    axes.set_ylabel(f"{quantity(story)} [-]")
    legend(figure, axes)
    path = save_small(figure, folder / f"{story['key']}_convergence.png")
    return path, f"{quantity(story)} over node spacing"


def draw_curves(story, picture, folder):
    """The curves that a case asked for."""
    figure, axes = plt.subplots(figsize=SIZE)
    for curve in picture["curves"]:
        axes.plot(curve["x"], curve["y"], curve["style"], label=curve["name"], markersize=4)
    for name, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
        if picture[f"log_{name}"]:
            (axes.set_xscale if name == "x" else axes.set_yscale)("log")
            values = [v for curve in picture["curves"] for v in curve[name] if v > 0]
            if values:
                log_axis(axis, values)
    if picture.get("down"):
        axes.invert_yaxis()
    if picture.get("equal"):
        axes.set_aspect("equal")
    axes.set_xlabel(picture["x_label"])
    axes.set_ylabel(textwrap.fill(picture["y_label"], 32))
    axes.grid(True)
    legend(figure, axes)
    slug = re.sub(r"[^a-z0-9]+", "_", picture["name"].lower()).strip("_")
    return save_small(figure, folder / f"{story['key']}_{slug}.png"), picture["name"]
