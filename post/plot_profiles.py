#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pore pressure, suction and saturation along vertical lines at several times."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.ticker import MaxNLocator

from talus_result import ResultError, along_vertical
from talus_style import (
    GREY,
    INK,
    axis_label,
    display_units,
    figure_path,
    finite_range,
    parser_of,
    run_main,
    save,
    seconds,
    time_text,
)

FIELDS = ("pore_pressure", "suction", "saturation")


def chosen(result, arguments):
    """Snapshots to show: nearest to the times asked for, else `count` of those with water."""
    if arguments.times:
        return [result.snapshot(time=time) for time in arguments.times]
    wet = [s for s in result.numbered() if any(result.has(name, s) for name in FIELDS)]
    changed = [s for k, s in enumerate(wet) if k == 0 or s.time > wet[k - 1].time + 1e-3 * wet[-1].time]
    pick = np.unique(np.linspace(0, len(changed) - 1, arguments.count).round().astype(int))
    return [changed[i] for i in pick]


def draw_key(axes, result, lines):
    """Where the lines are: the outline with one letter a line."""
    edges, shared = result.edges
    axes.add_collection(LineCollection(result.nodes[edges[shared == 1]], colors=INK, linewidths=0.8))
    for letter, x in zip("ABCDEFGH", lines):
        y, _ = along_vertical(result, result.nodes, result.nodes[:, 1], x)
        axes.plot([x, x], [y[0], y[-1]], color=GREY, linewidth=1.2)
        axes.annotate(letter, (x, y[-1]), (0, 3), textcoords="offset points", ha="center", fontweight="bold")
    axes.set_aspect("equal", anchor="W")
    axes.margins(0.03, 0.2)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    axes.set_axis_on()


def draw(result, arguments):
    """Draw and save; returns the file's name."""
    wanted = arguments.fields or ("pore_pressure" if result.has("pore_pressure") else "suction", "saturation")
    names = [name for name in wanted if result.has(name)]
    if not names:
        raise ResultError(f"{result.path}: no pore pressure, suction or saturation stored")
    snapshots = chosen(result, arguments)
    low, high = finite_range([result.nodes[:, 0]])
    narrow = high - low < 0.5 * np.ptp(result.nodes[:, 1])
    places = (0.5,) if narrow else (0.25, 0.5, 0.75)
    lines = arguments.x or [low + part * (high - low) for part in places]
    for x in lines:
        if not along_vertical(result, result.nodes, result.nodes[:, 0], x)[0].size:
            raise ResultError(f"{result.path}: no soil at x = {x:g} m; the body spans {low:g} to {high:g} m")
    colours = plt.get_cmap("viridis_r")(np.linspace(0.1, 1.0, len(snapshots)))
    figure = plt.figure(figsize=(7.4, 1.9 + (3.3 if len(lines) == 1 else 2.3 * len(lines))))
    grid = figure.add_gridspec(len(lines) + 1, len(names), height_ratios=[0.8] + [1.0] * len(lines))
    key = figure.add_subplot(grid[0, : max(1, len(names) - 1)])
    key.set_axis_off()
    if not narrow:
        draw_key(key, result, lines)
    first = {}
    for row, (letter, x) in enumerate(zip("ABCDEFGH", lines)):
        for column, name in enumerate(names):
            axes = figure.add_subplot(grid[row + 1, column], sharex=first.get(name))
            first.setdefault(name, axes)
            data = [result.field(name, s) for s in snapshots]
            span = finite_range(data)
            factor, units = display_units(result.units(name, snapshots[-1]), max(abs(span[0]), abs(span[1])))
            for snapshot, values, colour in zip(snapshots, data, colours):
                y, value = along_vertical(
                    result, result.positions(snapshot, arguments.deformed), values * factor, x
                )
                axes.plot(value, y, color=colour, label=time_text(result, snapshot))
            if name == "pore_pressure":
                axes.axvline(0.0, color=GREY, linewidth=0.7, zorder=0)
            axes.grid(True)
            axes.yaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
            axes.set_title(f"{letter}: x = {x:.4g} m" if column == 0 else "")
            if column == 0:
                axes.set_ylabel("y [m]")
            if row == len(lines) - 1:
                axes.set_xlabel(axis_label(name, units))
            else:
                axes.tick_params(labelbottom=False)
    legend = figure.add_subplot(grid[0, -1]) if len(names) > 1 else axes
    if len(names) > 1:
        legend.set_axis_off()
    legend.legend(*axes.get_legend_handles_labels(), loc="center", title=None)
    path = arguments.output or figure_path(result.path, "profiles")
    return save(figure, path, arguments.dpi)


def parser():
    """Command line."""
    options = parser_of(__doc__)
    options.add_argument("--x", type=float, nargs="+", help="where the lines stand [m] (at 1/4, 1/2, 3/4)")
    options.add_argument(
        "--fields", nargs="+", choices=FIELDS, help="what to draw (pore pressure and saturation)"
    )
    options.add_argument("--times", nargs="+", type=seconds, help="nearest snapshots: 0 90min 1.5h")
    options.add_argument("--count", type=int, default=6, help="times spread over the run (6)")
    options.add_argument(
        "--deformed",
        action="store_const",
        const=1.0,
        default=0.0,
        help="cut the deformed body (default: the columns of the reference shape)",
    )
    return options


if __name__ == "__main__":
    run_main(parser(), draw)
