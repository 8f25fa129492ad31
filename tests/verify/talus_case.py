# SPDX-License-Identifier: MIT
"""Runs a verification deck with the real program and compares it with its reference.

A case is a folder of tests/verify with its decks, its reference data and a check.py that ends with
`sys.exit(case.verdict())`. Every check prints the measured value, the limit and why it is that.
"""

import argparse
import csv
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy as np


class Case:
    """One verification case: runs decks in a scratch folder and collects checks."""

    def __init__(self, folder):
        parser = argparse.ArgumentParser(description="Run one verification case.")
        parser.add_argument("program", help="path of the talus program")
        parser.add_argument("--keep", help="folder to keep the results in")
        self.options = parser.parse_args()
        self.folder = pathlib.Path(folder)
        self._scratch = tempfile.TemporaryDirectory()
        self.scratch = pathlib.Path(self.options.keep or self._scratch.name)
        self.failures = 0

    def run(self, deck, replace=(), threads=1, code=0, name=None):
        """Run a deck, with (old, new) text replacements, and return its Result."""
        text = (self.folder / deck).read_text()
        for old, new in replace:
            if old not in text:
                sys.exit(f"{deck}: nothing to replace: {old!r}")
            text = text.replace(old, new)
        name = name or pathlib.Path(deck).stem
        place = self.scratch / name
        place.mkdir(parents=True, exist_ok=True)
        for other in self.folder.iterdir():
            if other.suffix in (".csv", ".txt"):
                (place / other.name).write_bytes(other.read_bytes())
        (place / f"{name}.nml").write_text(text)
        done = subprocess.run(
            [
                self.options.program,
                "run",
                f"{name}.nml",
                "--threads",
                str(threads),
                "--output",
                ".",
                "--overwrite",
            ],
            cwd=place,
            capture_output=True,
            text=True,
        )
        if done.returncode != code:
            sys.exit(f"{name}: exit code {done.returncode}, expected {code}\n{done.stderr}")
        return Result(place, name, done)

    def check(self, what, value, limit, why):
        """A value that may not exceed its limit."""
        good = bool(np.isfinite(value)) and value <= limit
        self.failures += not good
        print(f"{'ok  ' if good else 'FAIL'} {what}: {value:.6g} (limit {limit:.6g}: {why})")

    def check_true(self, what, good):
        self.failures += not good
        print(f"{'ok  ' if good else 'FAIL'} {what}")

    def verdict(self):
        print(f"{self.failures} checks failed")
        return 1 if self.failures else 0


class Result:
    """Files of one run."""

    def __init__(self, place, name, done):
        self.place, self.name, self.done = place, name, done
        self.path = place / f"{name}.h5"
        summary = (place / f"{name}_summary.txt").read_text().splitlines()
        self.summary = dict(line.split(" = ", 1) for line in summary if " = " in line)
        with h5py.File(self.path) as file:
            self.nodes = file["mesh/nodes"][:]
            self.area = file["mesh/cell_area"][:]

    def snapshots(self):
        """Names of the numbered snapshots in order."""
        with h5py.File(self.path) as file:
            return sorted(k for k in file["snapshots"] if k.isdigit())

    def field(self, name, snapshot=None, time=None):
        """A field of the last snapshot, a named one, or the one nearest to a time."""
        with h5py.File(self.path) as file:
            group = file["snapshots"]
            names = sorted(k for k in group if k.isdigit())
            chosen = snapshot or names[-1]
            if time is not None:
                chosen = min(names, key=lambda k: abs(group[k].attrs["time"] - time))
                if abs(group[chosen].attrs["time"] - time) > 1e-6 * max(1.0, abs(time)):
                    sys.exit(f"{self.name}: no snapshot at {time} s")
            return group[chosen][name][:]

    def history(self):
        """Columns of the history as arrays; text columns stay text."""
        with open(self.place / f"{self.name}_history.csv", newline="") as file:
            rows = list(csv.reader(file))
        columns = {}
        for i, title in enumerate(rows[0]):
            values = [row[i] for row in rows[1:]]
            try:
                columns[title.split("[")[0]] = np.array(values, float)
            except ValueError:
                columns[title.split("[")[0]] = np.array(values)
        return columns
