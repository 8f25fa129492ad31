# SPDX-License-Identifier: MIT
"""Runs a verification deck with the real program and compares it with its reference.

A case is a folder of tests/verify or tests/hard with its decks, its reference data and a check.py that
ends with `sys.exit(case.verdict())`. Every check prints the measured value, the limit and why it is that.
With `--report FILE` all that the case measured is stored as JSON too, from which `./talus verify` writes
tests/README.md; with `--full` the case runs all of its spacings, else those that a quick test affords.
"""

import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy as np

# [s], for one run of the program: within the time of a case (run_cases.py), so that the case can say which.
RUN_LIMIT = 1000.0


class Case:
    """One verification case: runs decks in a scratch folder and collects checks."""

    def __init__(
        self, folder, id="", title="", error="", reference="", quantity="error", order=True, work=True
    ):
        """`id` as in the report (H3), `title` of the case, `error`: the norm, `reference`: its source.

        `quantity`: what the study's column and axes are called, where that is no error. Without `order`
        there are no observed orders and no picture over the spacing, without `work` none over the time:
        for what passes through zero, or is measured against other spacings.
        """
        parser = argparse.ArgumentParser(description="Run one verification case.")
        parser.add_argument("program", help="path of the talus program")
        parser.add_argument("--keep", help="folder to keep the results in")
        parser.add_argument("--full", action="store_true", help="all spacings, not the quick ones only")
        parser.add_argument("--report", help="JSON file to store the measured values in")
        self.options = parser.parse_args()
        self.options.program = str(pathlib.Path(self.options.program).resolve())  # runs are in other folders
        self.full = self.options.full
        self.folder = pathlib.Path(folder)
        self.story = {
            "case": self.folder.name,
            "id": id,
            "title": title,
            "error": error,
            "reference": reference,
            "quantity": quantity,
            "order": order,
            "work": work,
            "full": self.full,
            "checks": 0,
            "runs": [],
            "targets": [],
            "cautions": [],
            "remedies": [],
            "tables": [],
            "pictures": [],
            "notes": [],
        }
        self.published, self.story["published_source"] = read_published(self.folder / "published.csv")
        self.story["published"] = self.published
        self._scratch = tempfile.TemporaryDirectory()
        self.scratch = pathlib.Path(self.options.keep or self._scratch.name)
        self.failures = 0

    def run(self, deck, replace=(), threads=1, code=0, name=None, repeat=1):
        """Run a deck, with (old, new) text replacements, and return its Result.

        `code`: the exit code expected, or a tuple of those allowed. Repeated runs (their fields are the same)
        give the Result of median wall time.
        """
        done = [self._run(deck, replace, threads, code, name) for _ in range(repeat)]
        done.sort(key=lambda result: float(result.summary.get("wall_seconds", 0.0)))
        result = done[repeat // 2]
        result.repeats = repeat
        summary = result.summary
        if "git_hash" in summary:
            self.story["version"] = f"{summary['version']} ({summary['git_hash']})"
            self.story["compiler"] = summary["compiler"]
        return result

    def _run(self, deck, replace, threads, code, name):
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
        words = ["run", f"{name}.nml", "--threads", str(threads), "--output", ".", "--overwrite"]
        done = self._talus(words, place)
        if done.returncode not in (code if isinstance(code, tuple) else (code,)):
            sys.exit(f"{name}: exit code {done.returncode}, expected {code}\n{done.stderr}")
        return Result(place, name, done)

    def _talus(self, words, place):
        """The program in a folder, done; the case ends where it takes longer than RUN_LIMIT."""
        try:
            return subprocess.run(
                [self.options.program, *words], cwd=place, capture_output=True, text=True, timeout=RUN_LIMIT
            )
        except subprocess.TimeoutExpired:
            sys.exit(f"{place.name}: {words[0]} stopped after {RUN_LIMIT:.0f} s")

    def inspect(self, deck, replace=()):
        """Lines of `talus check --spectrum`."""
        text = (self.folder / deck).read_text()
        for old, new in replace:
            if old not in text:
                sys.exit(f"{deck}: nothing to replace: {old!r}")
            text = text.replace(old, new)
        place = self.scratch / "spectrum"
        place.mkdir(parents=True, exist_ok=True)
        (place / deck).write_text(text)
        done = self._talus(["check", deck, "--spectrum"], place)
        if done.returncode != 0:
            sys.exit(f"{deck}: exit code {done.returncode}\n{done.stderr}")
        return done.stdout.splitlines()

    def seepage_steps(self, deck, replace=()):
        """Of the last stage with water: limit of monotone explicit steps, of stable ones, by LAPACK [s]."""
        names = ("  explicit seepage step", "  stable seepage step", "  2/lambda_max by LAPACK")
        lines = self.inspect(deck, replace)
        return [float([k for k in lines if k.startswith(name)][-1].split()[3]) for name in names]

    def spectrum(self, deck, replace=(), stage=None):
        """`talus check --spectrum` of a stage (the last if not named): stable step [s], omega^2 ascending."""
        step, squares, here = None, [], stage is None
        for line in self.inspect(deck, replace):
            words = line.split()
            if line.startswith("stage "):
                here = stage is None or words[1] == stage
                if here:
                    step, squares = None, []
            elif here and line.startswith("  stable soil step"):
                step = float(words[3])
            elif here and step is not None and len(words) == 2 and words[0] == str(len(squares) + 1):
                squares.append(float(words[1]))
        return step, np.array(squares)

    def check(self, what, value, limit, why):
        """A value that may not exceed its limit."""
        good = bool(np.isfinite(value)) and value <= limit
        self.story["checks"] += 1
        self.failures += not good
        print(f"{'ok  ' if good else 'FAIL'} {what}: {value:.6g} (limit {limit:.6g}: {why})")

    def check_true(self, what, good):
        self.story["checks"] += 1
        self.failures += not good
        print(f"{'ok  ' if good else 'FAIL'} {what}")

    def study(self, series, result, spacing, error, curve=None, exact=False):
        """One run of a study in mesh size: a row of the report's table, a point of its pictures.

        `series` names the rows ("one level, regular"), `spacing` in m, `error` relative, in the norm of
        the case. Of the series that share a `curve`, the pictures show the worst alone. What is `exact`
        but for the tolerance of a solver has no order, and no place in the pictures. Nodes, seconds, speed,
        smoothing and stabilisation come from the summary of the run.
        """
        summary = result.summary
        levels = int(summary["smoothing_levels"])
        self.story["runs"].append(
            {
                "series": series,
                "curve": curve or series,
                "exact": exact,
                "nodes": int(summary["nodes"]),
                "spacing": float(spacing),
                "error": float(error),
                "seconds": float(summary["wall_seconds"]),
                "repeats": result.repeats,
                "seconds_set_up": float(summary["wall_seconds_set_up"]),
                "steps": int(summary["steps"]),
                "seepage_steps": int(summary["seepage_steps"]),
                "node_steps_per_second": speed(summary),
                "threads": int(summary["threads"]),
                "smoothing": "one level" if levels == 1 else f"two levels, {summary['smoothing_length']} m",
                "stabilisation": float(summary["stabilisation"]),
            }
        )
        print(f"     {series}, spacing {spacing:g} m: error {error:.4g}, {summary['wall_seconds']} s")

    def target(self, what, value, limit, why, low=None, held=None, asked=False):
        """A number to meet: at most `limit`, and at least `low` where given. It enters the report.

        `asked`: it is one of those that the requirements name (ASKED of report_text.py), not our own.
        Where TALUS misses it, `held` = (low, limit) is the range that this check holds instead; the report
        then names the miss in its first lines, with the value.
        """
        met = bool(np.isfinite(value) and value <= limit and (low is None or value >= low))
        good = met
        if not met and held is not None:
            good = bool(np.isfinite(value)) and held[0] <= value <= held[1]
        self.failures += not good
        self.story["targets"].append(
            {
                "what": what,
                "value": float(value),
                "limit": float(limit),
                "low": None if low is None else float(low),
                "met": met,
                "asked": asked,
                "why": why,
            }
        )
        span = f"limit {limit:.6g}" if low is None else f"{low:.6g} to {limit:.6g}"
        word = "ok  " if met else ("miss" if good else "FAIL")
        print(f"{word} {what}: {value:.6g} ({span}: {why})")

    def caution(self, text):
        """What a reader should know of a target that is met only as worded: a sentence or two, with numbers.

        The report prints it below the missed targets, in its first lines.
        """
        self.story["cautions"].append(text)
        print(f"     read with care: {text}")

    def compare_time(self, result, error, program, what=None):
        """Time of a run against what a program of published.csv needs for the same error, or a finer one.

        With `what` ("201 rows") it is a target, asked for, to need less time, else a note.
        """
        points = [p for p in self.published if p["program"] == program]
        theirs, finest = seconds_at(points, error), min(p["error"] for p in points)
        ours = float(result.summary["wall_seconds"])
        story = f"{program} needs {theirs:.3g} s for " + (
            f"that error of {error:.2g}" if error >= finest else f"its finest error, {finest:.2g}"
        )
        if what:
            self.target(f"time at {what} over that of {program}", ours / theirs, 1.0, story, asked=True)
        self.note(f"TALUS takes {ours:.3g} s for an error of {error:.2g}; {story}.")

    def remedy(self, what, without, remedied, shown, by="TALUS"):
        """What goes wrong without a remedy, run and shown.

        `what` tells hazard and remedy, `without` and `remedied` what was measured without and with it (text
        with numbers); `shown` is true if the run without the remedy did go wrong. `by`: what ran without
        it, where TALUS has no such choice.
        """
        self.failures += not shown
        self.story["remedies"].append(
            {"what": what, "without": without, "remedied": remedied, "shown": bool(shown), "by": by}
        )
        print(f"{'ok  ' if shown else 'FAIL'} {what}: without (by {by}) {without}; with {remedied}")

    def picture(self, name, x_label, y_label, curves, log_x=False, log_y=False, **more):
        """A line picture of the report. `curves`: name -> (x, y) or (x, y, matplotlib format).

        `down=True` lets y grow downwards, as a depth; `equal=True` draws x and y at one scale.
        """
        self.story["pictures"].append(
            {
                "name": name,
                "x_label": x_label,
                "y_label": y_label,
                "log_x": log_x,
                "log_y": log_y,
                **more,
                "curves": [
                    {
                        "name": title,
                        "x": np.asarray(curve[0], float).tolist(),
                        "y": np.asarray(curve[1], float).tolist(),
                        "style": curve[2] if len(curve) > 2 else "-",
                    }
                    for title, curve in curves.items()
                ],
            }
        )

    def table(self, name, head, rows):
        """A table of the report besides the study; its values are shown as they are."""
        rows = [[str(value) for value in row] for row in rows]
        self.story["tables"].append({"name": name, "head": head, "rows": rows})
        for row in rows:
            print("     " + ", ".join(f"{title} {value}" for title, value in zip(head, row)))

    def note(self, text):
        """A sentence for the report."""
        self.story["notes"].append(text)
        print(f"     {text}")

    def verdict(self):
        self.story["failures"] = self.failures
        if self.options.report:
            path = pathlib.Path(self.options.report)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps(self.story, indent=1) + "\n")
        print(f"{self.failures} checks failed")
        return 1 if self.failures else 0


def speed(summary):
    """Node-steps a second of the soil, or of the water's sub-steps where the soil does not step."""
    if int(summary["steps"]) > 0 and "node_steps_per_second" in summary:
        return float(summary["node_steps_per_second"])
    seconds = float(summary.get("wall_seconds_seepage", 0.0))
    return int(summary["nodes"]) * int(summary["seepage_steps"]) / seconds if seconds > 0 else None


def read_published(path):
    """Points of other programs, and their source, from a CSV file if there is one.

    Comment lines (#) tell the source; then columns program, nodes (may be empty), error, seconds.
    """
    if not path.exists():
        return [], ""
    lines = path.read_text(encoding="utf-8").splitlines()
    source = " ".join(line.lstrip("# ") for line in lines if line.startswith("#"))
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return [
        {
            "program": row["program"],
            "nodes": int(row["nodes"]) if row["nodes"] else None,
            "error": float(row["error"]),
            "seconds": float(row["seconds"]),
        }
        for row in rows
    ], source


def seconds_at(points, error):
    """Seconds that a program needs for an error, between its published points (both logarithmic).

    Finer than its finest point it needs at least that one's time, which is what is returned: never more
    than was published. Coarser than its coarsest, the line through the first two points goes on.
    """
    points = sorted(points, key=lambda p: -p["error"])
    x = np.log([p["error"] for p in points])
    y = np.log([p["seconds"] for p in points])
    at = np.log(error)
    if at > x[0]:
        return float(np.exp(y[0] + (at - x[0]) * (y[1] - y[0]) / (x[1] - x[0])))
    return float(np.exp(np.interp(-at, -x, y)))


class Result:
    """Files of one run."""

    repeats = 1

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
