#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Water that came in, left, ran off and was stored, and the error of the balance."""

import matplotlib.pyplot as plt
import numpy as np

from talus_result import ResultError
from talus_style import GREY, display_units, figure_path, parser_of, run_main, save, time_scale

PARTS = (
    ("water_in", "infiltrated", "#0072B2"),
    ("water_stored", "stored (change)", "#009E73"),
    ("water_out", "flowed out", "#D55E00"),
    ("water_runoff", "ran off", "#CC79A7"),
)


def draw(result, arguments):
    """Draw and save; returns the file's name."""
    history = result.history()
    parts = [part for part in PARTS if part[0] in history]
    if not parts:
        raise ResultError(f"{result.path}: the history has no water balance")
    scale, unit = time_scale(np.ptp(history["time"]))
    time = history["time"] * scale
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
    for name, label, colour in parts:
        values = history[name] - (history[name][0] if name == "water_stored" else 0.0)
        upper.plot(time, values, color=colour, label=label)
    _, units = display_units(result.history_units(parts[0][0]), 1.0)
    upper.set_ylabel(f"Water per metre of slope [{units}]")
    upper.axhline(0.0, color=GREY, linewidth=0.7, zorder=0)
    upper.legend(loc="upper left")
    upper.grid(True)
    if balance:
        lower.semilogy(time, np.maximum(np.abs(history["water_error"]), 1e-17), color="#000000")
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
