#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Kill a program that writes results without pause, again and again, and read what it left.

The writer never rests, so each kill hits a writing; a real run writes for a few milliseconds in
minutes. Every kill must leave the snapshots finished before, all fields equal to their step.
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


def check(folder):
    """Number of snapshots of the result in `folder`; raises when something does not fit."""
    with h5py.File(folder / "killed.h5", "r") as file:
        nodes = file["mesh/nodes"].shape[0]
        names = sorted(file["snapshots"])
        for step, name in enumerate(names):
            group = file["snapshots"][name]
            assert int(name) == step == group.attrs["step"], f"snapshot {name} is out of order"
            for field, shape in (("displacement", (nodes, 2)), ("stress", (nodes, 4))):
                values = group[field][...]
                assert values.shape == shape and (values == step).all(), f"{name}/{field}"
            assert "damage" in group and group["damage"].attrs["units"] == b"1"
        rows = [file["history"][column].shape[0] for column in ("time", "step", "energy")]
        assert min(rows) >= len(names) - 1, f"history {rows}, {len(names)} snapshots"
        times = file["history/time"][: min(rows)]
        assert (times == range(len(times))).all(), "history has holes"
    tree = xml.etree.ElementTree.parse(folder / "killed.xdmf")
    listed = len(tree.findall(".//Time"))
    assert len(names) - 1 <= listed <= len(names), f"XDMF lists {listed} of {len(names)}"
    lines = (folder / "killed_history.csv").read_text().splitlines()
    assert lines[0] == "time[s],stage,step,energy[J/m]" and len(lines) >= len(names)
    summary = (folder / "killed_summary.txt").read_text()
    assert summary.startswith("steps = ") and summary.endswith("\n"), summary
    return len(names)


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
