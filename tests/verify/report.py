# SPDX-License-Identifier: MIT
"""Stores what the verification cases measured, and makes CSV, pictures and tests/README.md of it.

Everything lies in OUTPUT/report: KIND_NAME.json for each case, as talus_case.py and run_cases.py filled
it; run.json about the last run of all cases; studies.csv and targets.csv; the pictures. Each case keeps
its own date, so that a run of a few cases updates those only.
"""

import csv
import json
import math
import os
import re
from pathlib import Path

from case_list import report_order
from report_pictures import ROUND_OFF, draw_pictures
from report_text import report_text

STUDY_COLUMNS = (
    "case",
    "id",
    "date",
    "norm",
    "series",
    "nodes",
    "spacing_m",
    "error",
    "order",
    "wall_seconds",
    "repeats",
    "node_steps_per_second",
    "threads",
    "smoothing",
    "stabilisation",
)
TARGET_COLUMNS = ("case", "id", "date", "asked", "target", "measured", "at_least", "at_most", "met", "why")


def store_story(output, story):
    """Write the story of one case; lists of numbers go on one line, with six digits, long curves thinned."""
    for picture in story.get("pictures", []):
        for curve in picture["curves"]:
            curve["x"], curve["y"] = thinned(curve["x"], curve["y"])
            for axis in ("x", "y"):
                curve[axis] = [float(f"{value:.6g}") for value in curve[axis]]
    text = json.dumps(story, indent=1)
    text = re.sub(r"\[\s+([-+.\deE,\sNaInfity]+?)\s+\]", lambda m: f"[{' '.join(m[1].split())}]", text)
    path = Path(output) / "report" / f"{story['kind']}_{story['case']}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text + "\n", encoding="utf-8")


def thinned(x, y, parts=400):
    """A curve over rising x with the lowest and highest point of each of `parts` stretches only."""
    if len(x) <= 2 * parts or any(b < a for a, b in zip(x, x[1:])):
        return x, y
    kept = {0, len(x) - 1}
    for k in range(parts):
        stretch = range(k * len(x) // parts, (k + 1) * len(x) // parts)
        kept |= {min(stretch, key=y.__getitem__), max(stretch, key=y.__getitem__)}
    kept = sorted(kept)
    return [x[i] for i in kept], [y[i] for i in kept]


def load_stories(output, cases):
    """Stories stored of the cases that exist, in the order of the report, with observed orders."""
    stories = []
    for case in cases:
        path = Path(output) / "report" / f"{case.key}.json"
        if path.exists():
            story = {"id": "", "title": "", "error": "", "reference": "", "about": "", "trouble": ""}
            lists = {
                name: []
                for name in (
                    *("runs", "targets", "cautions", "remedies", "tables", "pictures", "notes"),
                    "published",
                )
            }
            story |= lists | json.loads(path.read_text(encoding="utf-8")) | {"key": case.key}
            add_orders(story)
            stories.append(story)
    return sorted(stories, key=lambda s: report_order(s["kind"], s["id"], s["case"]))


def store_run(output, **facts):
    """Keep facts about a run of all cases."""
    path = Path(output) / "report" / "run.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(facts) + "\n", encoding="utf-8")


def load_run(output):
    path = Path(output) / "report" / "run.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def add_orders(story):
    """Observed order of each row against the next coarser one of its series, where there is one.

    Round-off has no order, nor has what the case says has none.
    """
    for row in story.get("runs", []):
        coarser = [
            other
            for other in story["runs"]
            if other["series"] == row["series"] and other["spacing"] > row["spacing"] * (1 + 1e-9)
        ]
        row["order"] = None
        if coarser and story.get("order", True) and not row.get("exact"):
            other = min(coarser, key=lambda r: r["spacing"])
            if row["error"] > 0 and other["error"] > ROUND_OFF:
                ratio = math.log(other["spacing"] / row["spacing"])
                row["order"] = math.log(other["error"] / row["error"]) / ratio


def write_csv(path, columns, rows):
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(rows)


def write_tables(folder, stories):
    """studies.csv with all rows of studies, targets.csv with all targets."""
    studies, targets = [], []
    for s in stories:
        head = [s["case"], s["id"], s.get("date", "")]
        for r in s["runs"]:
            order = None if r["order"] is None else f"{r['order']:.3f}"
            studies.append(
                [
                    *head,
                    s["error"],
                    r["series"],
                    r["nodes"],
                    f"{r['spacing']:.6g}",
                    f"{r['error']:.6g}",
                    order,
                ]
                + [f"{r['seconds']:.4g}", r.get("repeats", 1), rounded(r["node_steps_per_second"])]
                + [r["threads"], r["smoothing"], r["stabilisation"]]
            )
        for t in s["targets"]:
            targets.append(
                [*head, "yes" if t.get("asked") else "no", t["what"], f"{t['value']:.6g}"]
                + [rounded(t["low"]), f"{t['limit']:.6g}", "yes" if t["met"] else "no", t["why"]]
            )
    write_csv(folder / "studies.csv", STUDY_COLUMNS, studies)
    write_csv(folder / "targets.csv", TARGET_COLUMNS, targets)


def rounded(value):
    return None if value is None else f"{value:.6g}"


def write_report(output, cases, tests):
    """Write the CSV files, the pictures and README.md into `output`; returns the README's path.

    `cases` are all that exist (CaseFile), `tests` the folder of their sources, for links.
    """
    output = Path(output)
    folder = output / "report"
    folder.mkdir(parents=True, exist_ok=True)
    stories = load_stories(output, cases)
    write_tables(folder, stories)
    pictures = {story["key"]: draw_pictures(story, folder) for story in stories}
    drawn = {path for made in pictures.values() for path, _ in made}
    for path in folder.glob("*.png"):
        if path not in drawn:
            path.unlink()
    missing = [case for case in cases if case.key not in pictures]
    text = report_text(stories, missing, pictures, load_run(output), os.path.relpath(tests, output))
    path = output / "README.md"
    path.write_text(text, encoding="utf-8")
    return path
