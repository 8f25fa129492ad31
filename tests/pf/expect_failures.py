#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Run a suite that must fail: exit code 2, and exactly the marked lines reported."""

import re
import subprocess
import sys
from pathlib import Path


def main():
    program, suite = sys.argv[1], Path(sys.argv[2])
    lines = suite.read_text(encoding="utf-8").splitlines()
    marked = {number + 1 for number, line in enumerate(lines, 1) if line.strip() == "! fails"}
    run = subprocess.run([program], capture_output=True, text=True, timeout=120, check=False)
    reported = {int(number) for number in re.findall(rf"{suite.name}:(\d+)", run.stdout)}
    wrong = []
    if run.returncode != 2:
        wrong.append(f"exit code {run.returncode}, expected 2")
    if re.search(r"\(\d+ tests?\)", run.stdout):
        wrong.append("it says (N tests) although tests failed")
    if not marked or reported != marked:
        wrong.append(f"reported lines {sorted(reported)}, expected {sorted(marked)}")
    if "twelve is not eleven" not in run.stdout or "[two]" not in run.stdout:
        wrong.append("the message or the parameter of a failure is missing")
    if wrong:
        print(run.stdout, run.stderr, *wrong, sep="\n")
        return 1
    print(f"{len(marked)} marked lines failed, and no other")
    return 0


if __name__ == "__main__":
    sys.exit(main())
