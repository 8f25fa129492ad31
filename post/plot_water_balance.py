#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Water that came in, left, ran off and was stored, and the error of the balance."""

import matplotlib.pyplot as plt
import numpy as np

from talus_result import ResultError
from talus_style import GREY, display_units, figure_path, parser_of, run_main, save, time_scale

PARTS = (
    ("water_in", "infiltrated", "#0072B2", "-"),
    ("water_stored", "stored (change)", "#009E73", (0, (4, 2))),
    ("water_out", "flowed out", "#D55E00", "-"),
    ("water_runoff", "ran off", "#CC79A7", "-"),
)


def balance_of(history):
    """Rows of stages that move water, and totals over them: the counters start anew in each.

    Stored water is counted from the beginning of the first of these stages.
    """
    stage = history["stage"]
    starts = np.flatnonzero(np.r_[True, stage[1:] != stage[:-1]])
    number = np.cumsum(np.r_[True, stage[1:] != stage[:-1]]) - 1
    flows = [name for name in ("water_in", "water_out", "water_runoff") if name in history]
    moved = np.maximum.reduceat(np.max([np.abs(history[n]) for n in flows], axis=0), starts) > 0.0
    rows = np.flatnonzero(moved[number])
    totals = {}
    for name in flows:
        ends = history[name][np.r_[starts[1:] - 1, len(stage) - 1]] * moved
        totals[name] = (history[name] + (np.cumsum(ends) - ends)[number])[rows]
    if "water_stored" in history and len(rows):
        stored = history["water_stored"][rows]
        arrived = totals.get("water_in", 0.0 * stored)[0] - totals.get("water_out", 0.0 * stored)[0]
        totals["water_stored"] = stored - stored[0] + arrived
    return rows, totals


def draw(result, arguments):
    """Draw and save; returns the file's name."""
    history = result.history()
    parts = [part for part in PARTS if part[0] in history]
    if not parts or parts[0][0] != "water_in":
        raise ResultError(f"{result.path}: the history has no water balance")
    rows, totals = balance_of(history)
    if not len(rows):
        raise ResultError(f"{result.path}: no stage moves water")
    scale, unit = time_scale(history["time"][rows[-1]])
    time = history["time"][rows] * scale
    balance = "water_error" in history
    figure, grid = plt.subplots(
        1 + balance,
        1,
        figsize=(6.0, 3.2 + 1.3 * balance),
        sharex=True,
        squeeze=False,
        height_ratios=[3.0, 1.2][: 1 + balance],
    )
    upper, lower = grid[0, 0], grid[-1, 0]
    for name, label, colour, dash in parts:
        upper.plot(time, totals[name], color=colour, linestyle=dash, label=label)
    _, units = display_units(result.history_units(parts[0][0]), 1.0)
    upper.set_ylabel(f"Water per metre of slope [{units}]")
    upper.axhline(0.0, color=GREY, linewidth=0.7, zorder=0)
    upper.legend(loc="upper left")
    upper.grid(True)
    if balance:
        lower.semilogy(time, np.maximum(np.abs(history["water_error"][rows]), 1e-17), color="#000000")
        lower.set_ylabel("Relative error")
        lower.grid(True)
    lower.set_xlabel(f"Time [{unit}]")
    figure.align_ylabels()
    path = arguments.output or figure_path(result.path, "water_balance")
    return save(figure, path, arguments.dpi)


def parser():
    """Command line."""
    return parser_of(__doc__)


if __name__ == "__main__":
    run_main(parser(), draw)
