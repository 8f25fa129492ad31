#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`talus bench --quick` ends with its five lines, in order and with credible values.

Numbers are held to what no machine could miss, not to a speed: tests share their machine.
"""

import csv
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# Least and greatest value that is not an error of measurement.
LINES = {
    "triad_GB_per_s": (0.5, 5000.0),
    "one_level_node_steps_per_s": (5e4, 1e9),
    "one_level_roofline_fraction": (0.005, 1.5),
    "everything_node_steps_per_s": (5e4, 1e9),
    "two_thread_speedup": (0.1, 2.5),
}


def check_tables(folder):
    """The files agree with each other and with what they measure."""
    rows = list(csv.DictReader((folder / "scaling.csv").open(encoding="utf-8")))
    whole = [row for row in rows if row["phase"] == "whole"]
    assert {row["model"] for row in whole} == {"one level", "everything"}, whole
    assert {row["threads"] for row in whole} == {"1", "2"}, whole
    for row in whole:
        assert 19000 < int(row["nodes"]) < 21000, row
        assert 500.0 < float(row["bytes_per_node_step"]) < 5000.0, row
    # Phases together take about the time of the step: within a factor of two on a busy machine.
    one = [row for row in rows if row["model"] == "one level" and row["threads"] == "1"]
    together = sum(1.0 / float(row["node_steps_per_s"]) for row in one if row["phase"] != "whole")
    step = sum(1.0 / float(row["node_steps_per_s"]) for row in one if row["phase"] == "whole")
    assert 0.5 < together / step < 2.0, (together, step)
    prices = list(csv.DictReader((folder / "price.csv").open(encoding="utf-8")))
    assert len(prices) == 8, prices
    assert abs(float(prices[0]["price"]) - 1.0) < 1e-9, prices
    # Every part takes memory when it is on, and none when it is off; an audit keeps nothing.
    memory = [float(row["bytes_per_node"]) for row in prices]
    assert all(a < b for a, b in zip(memory[:5], memory[1:6])), memory
    assert abs(memory[7] - memory[6]) < 1.0, memory
    report = (folder / "README.md").read_text(encoding="utf-8")
    # The targets come first, and each says whether it is met.
    targets = report.split("## ")[1].splitlines()
    assert targets[0] == "Targets", targets[0]
    rows = [line for line in targets if line.startswith("| ") and "---" not in line][1:]
    assert len(rows) >= 8, rows
    assert all(re.search(r"\| (met|\*\*missed.*\*\*) \|$", row) for row in rows), rows
    assert "| no |" not in report, "results depend on the number of threads"


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(
            [program, "bench", "--quick", "--output", folder],
            capture_output=True,
            text=True,
            timeout=280,
            check=False,
        )
        assert run.returncode == 0, run.stderr
        last = run.stdout.splitlines()[-len(LINES) :]
        for line, (name, (least, greatest)) in zip(last, LINES.items()):
            found = re.fullmatch(rf"{name} = (\S+)", line)
            assert found, line
            assert least <= float(found.group(1)) <= greatest, line
        check_tables(Path(folder))
    print("\n".join(last))


if __name__ == "__main__":
    main()
