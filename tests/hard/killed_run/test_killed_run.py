#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Kill a program that writes results without pause, again and again, and read what it left.

The writer never rests, so each kill hits a writing; a real run writes for a few milliseconds in
minutes. Every kill must leave the snapshots finished before, all fields equal to their step, and
the files beside them. test_every_write.py looks at the result file after each single write.
"""

import argparse
import random
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree
from pathlib import Path

import h5py

from killed_result import ROWS, check_file


def check(folder):
    """Number of snapshots of the result in `folder`; raises when something does not fit."""
    with h5py.File(folder / "killed.h5", "r") as file:
        snapshots = check_file(file)
    tree = xml.etree.ElementTree.parse(folder / "killed.xdmf")
    listed = len(tree.findall(".//Time"))
    assert snapshots - 1 <= listed <= snapshots, f"XDMF lists {listed} of {snapshots}"
    lines = (folder / "killed_history.csv").read_text().splitlines()
    assert lines[0] == "time[s],stage,step,energy[J/m]" and len(lines) > ROWS * (snapshots - 1)
    summary = (folder / "killed_summary.txt").read_text()
    assert summary.startswith("steps = ") and summary.endswith("\n"), summary
    return snapshots


def main():
    """Exit code 0 when every killed run was readable."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("writer", type=Path, help="the program write_forever")
    parser.add_argument("--kills", type=int, default=12)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    rng = random.Random(arguments.seed)
    unreadable = 0
    snapshots = 0
    for kill in range(arguments.kills):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            writer = subprocess.Popen([arguments.writer.resolve()], cwd=folder)
            deadline = time.monotonic() + 20
            while not (folder / "killed_summary.txt").exists() and time.monotonic() < deadline:
                time.sleep(0.002)
            time.sleep(rng.uniform(0.0, 0.3))
            writer.send_signal(signal.SIGKILL)
            assert writer.wait() == -signal.SIGKILL, "the writer ended by itself"
            try:
                snapshots += check(folder)
            except (OSError, KeyError, RuntimeError, AssertionError) as error:
                unreadable += 1
                print(f"kill {kill}: {error!r}")
    print(f"{arguments.kills} kills, {snapshots} snapshots read, {unreadable} runs unreadable")
    return 1 if unreadable else 0


if __name__ == "__main__":
    sys.exit(main())
