#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Speed over model size, and what each part of the physics costs, from the CSV of `talus bench`."""

import argparse
import csv
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from talus_style import GREY, LINES, save, use_style


def rows_of(path):
    """Rows of a CSV file with numbers where there are numbers."""
    rows = []
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            for name, value in row.items():
                try:
                    row[name] = float(value)
                except ValueError:
                    continue
            rows.append(row)
    if not rows:
        raise ValueError("no rows")
    return rows


def draw_scaling(rows, path, dpi):
    """Whole step of each model and number of threads, with what the memory would allow."""
    whole = [row for row in rows if row["phase"] == "whole"]
    figure, axes = plt.subplots(1, 2, figsize=(7.2, 3.2))
    models = list(dict.fromkeys(row["model"] for row in whole))
    for row_threads, marker, dash in zip(
        sorted({row["threads"] for row in whole}), "os^D", ("-", "--", ":", "-.")
    ):
        for model, colour in zip(models, LINES):
            chosen = [r for r in whole if r["model"] == model and r["threads"] == row_threads]
            nodes = [r["nodes"] for r in chosen]
            label = f"{model}, {row_threads:.0f} thread{'s' if row_threads > 1 else ''}"
            style = {"color": colour, "marker": marker, "linestyle": dash, "markersize": 4}
            axes[0].plot(nodes, [1e-6 * r["node_steps_per_s"] for r in chosen], label=label, **style)
            axes[1].plot(nodes, [r["roofline_fraction"] for r in chosen], **style)
    axes[0].set_ylabel("Million node-steps per second")
    axes[1].set_ylabel("Fraction of what STREAM triad allows")
    axes[1].set_ylim(0.0, None)
    axes[0].set_ylim(0.0, None)
    axes[0].figure.legend(
        *axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=4, frameon=False
    )
    for axis in axes:
        axis.set_xscale("log")
        axis.set_xlabel("Nodes")
        axis.grid(True)
    return save(figure, path, dpi)


def draw_prices(rows, path, dpi):
    """Time and memory of each model of the price list over the first."""
    names = [row["model"].replace(";", ",") for row in rows]
    places = np.arange(len(rows))
    figure, axes = plt.subplots(1, 2, figsize=(7.2, 3.2), sharey=True)
    axes[0].barh(places, [row["price"] for row in rows], color=LINES[0])
    axes[1].barh(places, [row["bytes_per_node"] for row in rows], color=LINES[2])
    for place, row in zip(places, rows):
        axes[0].text(row["price"], place, f" {row['price']:.2f}", va="center", fontsize=7)
        axes[1].text(row["bytes_per_node"], place, f" {row['bytes_per_node']:.0f}", va="center", fontsize=7)
    axes[0].axvline(1.0, color=GREY, linewidth=0.7)
    axes[0].set_yticks(places, names)
    axes[0].invert_yaxis()
    axes[0].set_xlabel("Time of a step over elastic, one level")
    axes[1].set_xlabel("Bytes per node")
    for axis in axes:
        axis.margins(x=0.15)
    return save(figure, path, dpi)


def main():
    """Draw both pictures into the folder of the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="folder that `talus bench` wrote")
    parser.add_argument("--dpi", type=float, default=150.0, help="dots per inch (150)")
    arguments = parser.parse_args()
    use_style()
    for draw, table, picture in (
        (draw_scaling, "scaling.csv", "scaling.png"),
        (draw_prices, "price.csv", "price_list.png"),
    ):
        try:
            rows = rows_of(arguments.folder / table)
            print(draw(rows, arguments.folder / picture, arguments.dpi))
        except (OSError, KeyError, ValueError) as error:
            sys.exit(f"{parser.prog}: {arguments.folder / table}: {error}")


if __name__ == "__main__":
    main()
