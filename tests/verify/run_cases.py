# SPDX-License-Identifier: MIT
"""Runs the verification cases at all of their spacings and writes tests/README.md: `./talus verify`."""

import argparse
import concurrent.futures
import contextlib
import datetime
import json
import os
import platform
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from case_list import find_cases, select_cases
from report import add_orders, load_stories, store_run, store_story, write_report
from report_text import number, study_lines

TESTS = Path(__file__).resolve().parents[1]
TIME_LIMIT = 1700.0  # [s], for one case


def parse_arguments():
    parser = argparse.ArgumentParser(prog="talus verify", description=__doc__)
    parser.add_argument("program", type=Path, help="path of the talus program")
    parser.add_argument("case", nargs="*", help="names or ids of cases (celia, H3, hard4, hard); all")
    parser.add_argument("--output", type=Path, default=TESTS, help="folder of the report (tests)")
    parser.add_argument("--logs", type=Path, help="folder for what the cases print")
    parser.add_argument("--jobs", type=int, default=processors(), help="cases at once (processors)")
    return parser.parse_intermixed_args()


def processors():
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def machine():
    """The processor's name and how many there are."""
    name = platform.processor() or platform.machine()
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                name = line.split(":", 1)[1].strip()
                break
    return f"{name}, {processors()} processors"


def run_case(case, program, scratch, running):
    """Run one check.py; returns its story (see talus_case.py) with date, machine, seconds and exit code.

    What it printed is in scratch/KEY.log. A case that ends without a story gets one that says so.
    """
    file, log = scratch / f"{case.key}.json", scratch / f"{case.key}.log"
    command = [sys.executable, case.path, program, "--full", "--report", file]
    once = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    start, trouble = time.monotonic(), ""
    with log.open("w") as out:
        process = subprocess.Popen(
            [str(word) for word in command],
            stdout=out,
            stderr=subprocess.STDOUT,
            env={**os.environ, **once},
            start_new_session=True,
        )
        running.add(process)
        try:
            code = process.wait(TIME_LIMIT)
        except subprocess.TimeoutExpired:
            stop(process)
            code, trouble = 1, f"stopped after {TIME_LIMIT:.0f} s"
        running.discard(process)
    if file.exists():
        story = json.loads(file.read_text())
    else:
        last = log.read_text(errors="replace").strip().splitlines()[-2:]
        trouble = trouble or f"ended with exit code {code} before its verdict: {' / '.join(last)}"
        story = {"case": case.name, "id": case.id, "title": "", "failures": 1}
    return {
        **story,
        "case": case.name,
        "kind": case.kind,
        "about": case.about,
        "trouble": trouble,
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d"),
        "machine": machine(),
        "case_seconds": round(time.monotonic() - start, 1),
    }


def stop(process):
    """End a case and the program that it runs."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def state_of(story):
    """ok, miss (a target is not met, and the check knows), or FAIL."""
    if story.get("trouble") or story["failures"]:
        return "FAIL"
    return "ok" if all(target["met"] for target in story.get("targets", [])) else "miss"


def headline(story):
    """The number that tells most of a case: a missed target, else the first, else the finest error."""
    targets = story.get("targets", [])
    targets = [target for target in targets if not target["met"]] + targets
    if story.get("trouble"):
        return story["trouble"]
    if targets:
        return f"{targets[0]['what']}: {number(targets[0]['value'])}"
    if story.get("runs"):
        row = min(story["runs"], key=lambda row: row["spacing"])
        return f"error {number(row['error'])} at spacing {number(row['spacing'])} m"
    return f"{story.get('checks', 0)} checks"


def run_all(cases, options, logs):
    """Run the cases, as many at once as asked for; stories by key.

    As each ends, its story is stored, so that an interrupted run keeps what it found, and a line printed.
    """
    seconds = {s["key"]: s.get("case_seconds", 0.0) for s in load_stories(options.output, cases)}
    # The longest first, so that the last to end is a short one.
    queue = sorted(cases, key=lambda case: -seconds.get(case.key, TIME_LIMIT))
    stories, running = {}, set()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        waiting = {pool.submit(run_case, case, options.program, logs, running): case for case in queue}
        try:
            for done in concurrent.futures.as_completed(waiting):
                case = waiting[done]
                story = stories[case.key] = done.result()
                store_story(options.output, story)
                state = state_of(story)
                print(
                    f"{state:4s} {case.label:34.34s} {story['case_seconds']:6.1f} s  {headline(story):.90s}",
                    flush=True,
                )
                print_study(story)
                if state == "FAIL":
                    show_failure(logs / f"{case.key}.log")
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            for process in list(running):
                stop(process)
            print(f"interrupted; what {len(stories)} cases found is kept for the next report")
            sys.exit(130)
    return stories


def print_study(story):
    """The rows of the case's study in mesh size."""
    add_orders(story)
    if story.get("runs"):
        print("\n".join(f"       {line}" for line in study_lines(story)), flush=True)


def show_failure(log):
    """The checks that failed, or the last lines."""
    lines = log.read_text(errors="replace").splitlines()
    for line in [line for line in lines if line.startswith("FAIL")] or lines[-10:]:
        print(f"       {line}")


def print_targets(stories):
    """All targets with what was measured, in the order of the report."""
    rows = [(s["id"] or s["case"], target) for s in stories for target in s.get("targets", [])]
    if not rows:
        return
    print(f"\n{'':5s}{'case':15s} {'measured':>10s}  {'wanted':<18s} target")
    for id, target in rows:
        low = "" if target["low"] is None else f"{number(target['low'])} to "
        wanted = f"{low}{number(target['limit'])}" if low else f"<= {number(target['limit'])}"
        state = "ok" if target["met"] else "MISS"
        print(f"{state:4s} {id:15.15s} {number(target['value']):>10s}  {wanted:<18s} {target['what']}")
    missed = sum(not target["met"] for _, target in rows)
    print(f"{len(rows)} targets, {missed} not met")


def main():
    options = parse_arguments()
    options.program = options.program.resolve()
    everything = find_cases(TESTS)
    cases, unknown = select_cases(everything, options.case)
    if unknown:
        print(
            f"talus verify: no case {', '.join(repr(word) for word in unknown)}. There are:", file=sys.stderr
        )
        for case in everything:
            print(f"  {case.kind + '/' + case.name:36s} {case.id}", file=sys.stderr)
        return 2
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as scratch:
        logs = options.logs or Path(scratch)
        logs.mkdir(parents=True, exist_ok=True)
        for case in cases:
            (logs / f"{case.key}.json").unlink(missing_ok=True)
        print(f"{len(cases)} cases, {options.jobs} at once", flush=True)
        load = os.getloadavg()[0]
        stories = run_all(cases, options, logs)
    elapsed = time.monotonic() - start
    if len(cases) == len(everything):
        store_run(options.output, elapsed=round(elapsed), jobs=options.jobs, load=round(load, 1))
    print_targets([stories[case.key] for case in cases])
    print(f"{elapsed:.0f} s; report: {write_report(options.output, everything, TESTS)}")
    failed = [case.label for case in cases if state_of(stories[case.key]) == "FAIL"]
    if failed:
        print(f"failed: {', '.join(failed)}")
        if options.logs:
            print(f"what they printed is in {options.logs}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
