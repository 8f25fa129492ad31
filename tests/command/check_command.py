#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The command line of the program: what each word prints, and its exit code.

check_command.py PROGRAM runs every case below in an empty folder, in which none may leave a file.
"""

import os
import subprocess
import sys
import tempfile

# Arguments, exit code, and a part of what is printed.
CASES = [
    ([], 0, "talus run DECK"),
    (["help"], 0, "exit codes: 0 done, 1 results could not be written, 2 bad input"),
    (["--help"], 0, "talus check DECK"),
    (["version"], 0, "talus "),
    (["-V"], 0, "talus "),
    (["keys"], 0, "youngs_modulus"),
    (["keys", "nodes"], 0, "spacing"),
    (["keys", "nodse"], 2, "nodes"),
    (["manual"], 0, "youngs_modulus"),
    (["walk"], 2, 'unknown word "walk"; allowed: run, check, keys, manual, bench, version, help'),
    (["run"], 2, "run needs a deck: talus run DECK"),
    (["check"], 2, "check needs a deck: talus check DECK"),
    (["run", "a.nml", "b.nml"], 2, 'unexpected "b.nml" after run'),
    (["run", "a.nml", "--thread", "2"], 2, 'unexpected "--thread" after run; allowed: one deck'),
    (["run", "a.nml", "--threads", "two"], 2, "--threads two: allowed: a whole number from 1"),
    (["run", "a.nml", "--threads", "0"], 2, "--threads 0: allowed: a whole number from 1"),
    (["run", "a.nml", "--threads"], 2, "allowed: a whole number from 1 to 1024"),
    (["run", "a.nml", "--output"], 2, "--output : allowed: a folder"),
    (["run", "a.nml", "--output", "--overwrite"], 2, "--output --overwrite: allowed: a folder"),
    (["run", "a.nml", "--output", "--output", "out"], 2, "--output --output: allowed: a folder"),
    (["run", "a.nml", "--spectrum"], 2, 'unexpected "--spectrum" after run; allowed: one deck, --threads N'),
    (["run", "a.nml", "-"], 2, 'unexpected "-" after run'),
    (["check", "a.nml", "--overwrite"], 2, 'unexpected "--overwrite" after check; allowed: one deck, '),
    (["check", "a.nml", "--output", "out"], 2, 'unexpected "--output" after check'),
    (["keys", "--threads", "3"], 2, 'unexpected "--threads" after keys; allowed: one group'),
    (["keys", "run", "soil"], 2, 'unexpected "soil" after keys; allowed: one group'),
    (["manual", "soil"], 2, 'unexpected "soil" after manual; allowed: nothing'),
    (["bench", "a.nml"], 2, 'unexpected "a.nml" after bench; allowed: --quick, --output DIR'),
    (["version", "extra"], 2, 'unexpected "extra" after version; allowed: nothing'),
    (["help", "me"], 2, 'unexpected "me" after help; allowed: nothing'),
    (["run", "no_such_deck.nml"], 2, "no such file; allowed: a path relative to the working folder"),
    (["check", "no_such_deck.nml"], 2, "no_such_deck.nml"),
]

# How threads wait: what the user has set, and what libgomp is told.
WAITING = [
    ({}, "GOMP_SPINCOUNT = '1000'"),
    ({"GOMP_SPINCOUNT": "77"}, "GOMP_SPINCOUNT = '77'"),
    ({"OMP_WAIT_POLICY": "passive"}, "GOMP_SPINCOUNT = '0'"),
]


def fault_of(program, arguments, code, part):
    """What is wrong with a case, '' for nothing."""
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(
            [program, *arguments], cwd=folder, capture_output=True, text=True, timeout=60, check=False
        )
        left = " ".join(os.listdir(folder))
    printed = run.stdout + run.stderr
    if run.returncode != code:
        return f"exit code {run.returncode}, not {code}; it printed:\n{printed}"
    if part not in printed:
        return f"does not print {part!r} but:\n{printed}"
    return f"left {left}" if left else ""


def fault_of_waiting(program, chosen, part):
    """What is wrong with how threads wait, by what libgomp says it was told; '' for nothing."""
    kept = {k: v for k, v in os.environ.items() if k not in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")}
    run = subprocess.run(
        [program, "check", "no such deck.nml"],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env={**kept, "OMP_DISPLAY_ENV": "verbose", **chosen},
    )
    last = run.stderr[run.stderr.rfind("OPENMP DISPLAY ENVIRONMENT BEGIN") :]
    if part not in last:
        return f"libgomp was not told {part}, but:\n{last}"
    return "" if "no such deck.nml" in last else f"words were lost at the second start:\n{last}"


def main():
    """Run all cases."""
    faults = 0
    for chosen, part in WAITING:
        fault = fault_of_waiting(sys.argv[1], chosen, part)
        faults += bool(fault)
        if fault:
            print(f"talus check with {chosen}: {fault}")
    for arguments, code, part in CASES:
        fault = fault_of(sys.argv[1], arguments, code, part)
        faults += bool(fault)
        if fault:
            print(f"talus {' '.join(arguments)}: {fault}")
    print(f"{len(CASES) + len(WAITING)} command lines, {faults} wrong")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
