#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Put the speed of the program, as last stored in tests/bench, into the README; with --check only compare."""

import argparse
import csv
import re
import sys
from pathlib import Path

BEGIN = "<!-- speed: written by tests/bench/update_readme.py -->"
END = "<!-- end of speed -->"


def rows_of(path):
    """Rows of a CSV file."""
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def prices(folder):
    """The price list as a table."""
    lines = [
        "| 2e4 nodes, one thread | million node-steps/s | price | over the row above | bytes per node |",
        "|---|--:|--:|--:|--:|",
    ]
    for row in rows_of(folder / "price.csv"):
        speed = 1e-6 * float(row["node_steps_per_s"])
        lines.append(
            f"| {row['model'].replace(';', ',')} | {speed:.2f} | {float(row['price']):.2f} "
            f"| {float(row['over_row_above']):.2f} | {float(row['bytes_per_node']):.0f} |"
        )
    return lines


def block(folder):
    """Machine, date, price list and both pictures, between the marks."""
    report = (folder / "README.md").read_text(encoding="utf-8")
    machine = re.search(r"^Machine: .*$", report, re.MULTILINE)
    if machine is None:
        raise ValueError("no machine in the report")
    lines = [BEGIN, "", machine.group(0), "", *prices(folder), ""]
    lines += ["![Node-steps per second over model size](tests/bench/scaling.png)", ""]
    lines += ["![Time and memory of each part of the physics](tests/bench/price_list.png)", "", END]
    return "\n".join(lines)


def main():
    """Replace what stands between the marks, or say that it differs."""
    folder = Path(__file__).resolve().parent
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="change nothing, fail when it differs")
    arguments = parser.parse_args()
    path = folder.parents[1] / "README.md"
    text = path.read_text(encoding="utf-8")
    found = re.search(re.escape(BEGIN) + ".*?" + re.escape(END), text, re.DOTALL)
    if found is None:
        sys.exit(f"{path}: the marks of the block on speed are missing")
    new = block(folder)
    if found.group(0) == new:
        return
    if arguments.check:
        sys.exit(f"{path}: its speed is not that of {folder}; run {Path(__file__).name}")
    path.write_text(text.replace(found.group(0), new), encoding="utf-8")


if __name__ == "__main__":
    main()
