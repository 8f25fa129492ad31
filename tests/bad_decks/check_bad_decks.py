#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every bad deck must be refused with exactly its expected messages, and leave nothing behind.

check_bad_decks.py PROGRAM [--update] runs `PROGRAM check DECK` for each *.expected beside this
script; a deck without errors (warnings only) must be accepted. A line of *.expected is one message.
--update writes the messages of the program into *.expected: read the difference before keeping it.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parent
MESSAGE = re.compile(r"^\S+\.nml:(\d+:)? (error|warning): ")


def copy_of(folder: pathlib.Path) -> None:
    """Copy all decks and their tables, so that a program that writes can be caught at it."""
    for source in FOLDER.iterdir():
        if source.suffix in (".nml", ".csv", ".txt"):
            (folder / source.name).write_bytes(source.read_bytes())


def messages_of(program: str, deck: str, folder: pathlib.Path) -> tuple[list[str], int]:
    """Messages and exit code of `program check deck`."""
    run = subprocess.run([program, "check", deck], cwd=folder, capture_output=True, timeout=60, check=False)
    text = (run.stdout + run.stderr).decode("utf-8", "replace")
    return [line for line in text.splitlines() if MESSAGE.match(line)], run.returncode


def judge(program: str, expected_file: pathlib.Path, update: bool) -> list[str]:
    """Faults of one deck, none when all is as expected."""
    deck = expected_file.stem + ".nml"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        copy_of(folder)
        before = sorted(folder.rglob("*"))
        found, code = messages_of(program, deck, folder)
        faults = [f"wrote {p.name}" for p in sorted(folder.rglob("*")) if p not in before]
    if update:
        expected_file.write_text("".join(line + "\n" for line in found), encoding="utf-8")
    expected = expected_file.read_text(encoding="utf-8").splitlines()
    wanted_code = 2 if any(" error: " in line for line in expected) else 0
    if code != wanted_code:
        faults.append(f"exit code {code}, not {wanted_code}")
    faults += [f"missing: {line}" for line in expected if line not in found]
    faults += [f"not expected: {line}" for line in found if line not in expected]
    if not expected:
        faults.append("nothing is expected of it")
    return faults


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", help="path of the program talus")
    parser.add_argument("--update", action="store_true", help="write *.expected anew")
    arguments = parser.parse_args()
    program = str(pathlib.Path(arguments.program).resolve())
    failed = 0
    expected_files = sorted(FOLDER.glob("*.expected"))
    for deck in FOLDER.glob("*.nml"):
        if deck.with_suffix(".expected") not in expected_files:
            print(f"{deck.name}: no {deck.stem}.expected")
            failed += 1
    for expected_file in expected_files:
        faults = judge(program, expected_file, arguments.update)
        for fault in faults:
            print(f"{expected_file.stem}: {fault}")
        failed += bool(faults)
    print(f"{len(expected_files) - failed} of {len(expected_files)} decks as expected")
    return 1 if failed or not expected_files else 0


if __name__ == "__main__":
    sys.exit(main())
