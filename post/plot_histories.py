#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Largest displacement, energies and the energy error against time, one column a stage."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import MaxNLocator

from talus_result import ResultError
from talus_style import GREY, LINES, display_units, figure_path, parser_of, run_main, save, time_scale

ORDER = ("external", "kinetic", "strain", "plastic", "damage", "water", "damping", "stabilisation")


def stages_of(history):
    """Names and row ranges of the stages, in order."""
    stage = history["stage"]
    starts = np.flatnonzero(np.r_[True, stage[1:] != stage[:-1]])
    ends = np.r_[starts[1:], len(stage)]
    return [(stage[a], slice(a, b)) for a, b in zip(starts, ends) if b - a > 1]


def rows_of(result, history):
    """Rows of panels: label, column names, units, logarithmic or not."""
    units = {name: result.history_units(name) for name in history}
    energies = [n for n in history if units[n].startswith("J") and "error" not in n]
    energies.sort(key=lambda n: next((k for k, w in enumerate(ORDER) if w in n), len(ORDER)))
    moved = [n for n in history if units[n] == "m" and "displacement" in n]
    wrong = [n for n in history if n == "energy_error"]
    groups = (
        ("Displacement", moved, True),
        ("Energy", energies, False),
        ("Relative energy error", wrong, True),
    )
    return [(label, names, units[names[0]], log) for label, names, log in groups if names]


def label_of(name, group):
    """Short label of a column in its panel: 'energy_kinetic' is 'kinetic'."""
    words = [w for w in name.split("_") if w not in (group.lower(), "work")]
    return " ".join(words) or name


def stage_axis(history, part):
    """Abscissae in a stage and their label: time, or steps where time stands still."""
    time = history["time"][part] - history["time"][part][0]
    if time[-1] <= 0.0:
        before = history["step"][part.start - 1] if part.start else 0
        return history["step"][part] - before, "Steps"
    scale, unit = time_scale(time[-1])
    return time * scale, f"Time [{unit}]"


def draw(result, arguments):
    """Draw and save; returns the file's name."""
    history = result.history()
    stages = stages_of(history)
    rows = rows_of(result, history)
    if not rows or not stages:
        raise ResultError(f"{result.path}: the history has no displacements and no energies")
    figure, grid = plt.subplots(
        len(rows),
        len(stages),
        figsize=(max(7.4, 1.4 * len(stages)), 0.5 + 2.0 * len(rows)),
        sharey="row",
        sharex="col",
        squeeze=False,
    )
    for row, (group, names, units, log) in enumerate(rows):
        largest = max(np.nanmax(np.abs(history[name]), initial=0.0) for name in names)
        factor, shown = display_units(units, largest)
        for column, (stage, part) in enumerate(stages):
            axes = grid[row, column]
            floor = 1e-4 * max(np.nanmax(np.abs(history[name][part]), initial=0.0) for name in names)
            along, label = stage_axis(history, part)
            for name, colour in zip(names, LINES * 4):
                values = history[name][part]
                if log:
                    values = np.where(np.abs(values) > floor, np.abs(values), np.nan)
                axes.plot(along, values * factor, color=colour, label=label_of(name, group))
            if log:
                axes.set_yscale("log")
                if floor == 0.0:
                    axes.text(0.5, 0.5, "zero", transform=axes.transAxes, ha="center", color=GREY)
            few = max(2, min(5, 10 // len(stages)))
            axes.xaxis.set_major_locator(MaxNLocator(few, steps=[1, 2, 5, 10]))
            axes.grid(True)
            if row == 0:
                axes.set_title(stage)
            if row == len(rows) - 1:
                axes.set_xlabel(label)
        words = f"|{group}|" if log else group  # a logarithm shows sizes only
        grid[row, 0].set_ylabel(f"{words} [{shown}]" if shown else words)
        if len(names) > 1:
            grid[row, -1].legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.align_ylabels()
    path = arguments.output or figure_path(result.path, "histories")
    return save(figure, path, arguments.dpi)


def parser():
    """Command line."""
    return parser_of(__doc__)


if __name__ == "__main__":
    run_main(parser(), draw)
