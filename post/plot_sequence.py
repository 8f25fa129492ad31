#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""One field at several times, small maps with one colour scale."""

import matplotlib.pyplot as plt
import numpy as np

from talus_map import FieldMap, FieldScale, add_map_options, default_field, map_size, shape_note, view_of
from talus_style import figure_path, parser_of, run_main, save, seconds, time_text


def chosen(result, arguments):
    """Snapshots to show: those asked for, else `count` spread over the run."""
    if arguments.snapshots:
        return [result.snapshot(name) for name in arguments.snapshots]
    if arguments.times:
        return [result.snapshot(time=time) for time in arguments.times]
    numbered = result.numbered()
    # Of snapshots at one time (the end of a stage, the start of the next) the last.
    numbered = [s for s, after in zip(numbered, [*numbered[1:], None]) if not after or after.time > s.time]
    pick = np.unique(np.linspace(0, len(numbered) - 1, arguments.count).round().astype(int))
    return [numbered[i] for i in pick]


def draw(result, arguments):
    """Draw and save; returns the file's name."""
    snapshots = chosen(result, arguments)
    field = arguments.field or default_field(result)
    scale = FieldScale(result, field, snapshots, arguments.limits)
    view = view_of(result, snapshots, arguments.deformed)
    width, height = map_size(view, 2.95, 4.5)
    columns = min(arguments.columns or max(2, int(6.8 / max(width + 0.25, 1.1))), len(snapshots))
    if arguments.columns or columns == 1:
        width, height = map_size(view, 5.9 / columns, 4.5)
    rows = -(-len(snapshots) // columns)
    figure, grid = plt.subplots(
        rows,
        columns,
        figsize=(columns * max(width, 1.1) + 1.5, min(10.0, rows * (height + 0.32) + 0.45)),
        sharex=True,
        sharey=True,
        squeeze=False,
    )
    for axes, snapshot in zip(grid.flat, snapshots):
        cells = FieldMap(axes, result, scale, arguments.deformed).show(snapshot)
        axes.set(xlim=view[0], ylim=view[1])
        title = time_text(result, snapshot)
        axes.set_title(title.replace(", ", "\n") if width < 1.8 else title, fontsize=8)
    for axes in grid.flat[len(snapshots) :]:
        axes.set_axis_off()
    for column in range(columns):
        shown = (len(snapshots) - 1 - column) // columns
        grid[shown, column].set_xlabel("x [m]")
        grid[shown, column].tick_params(labelbottom=True)
    for axes in grid[:, 0]:
        axes.set_ylabel("y [m]")
    scale.add_bar(figure, cells, ax=grid, shrink=min(1.0, 0.3 + 1.1 / rows), aspect=25, pad=0.02)
    note = shape_note(arguments.deformed)
    if note:
        figure.suptitle(note, fontsize=8)
    path = arguments.output or figure_path(result.path, f"{field}_sequence")
    return save(figure, path, arguments.dpi)


def parser():
    """Command line."""
    options = parser_of(__doc__)
    add_map_options(options)
    when = options.add_mutually_exclusive_group()
    when.add_argument("--snapshots", nargs="+", help="numbers or names; -1 is the last")
    when.add_argument("--times", nargs="+", type=seconds, help="nearest snapshots: 0 90min 1.5h")
    when.add_argument("--count", type=int, default=6, help="maps spread over the run (6)")
    options.add_argument("--columns", type=int, help="maps beside each other")
    return options


if __name__ == "__main__":
    run_main(parser(), draw)
