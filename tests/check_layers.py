#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Check which folder of src/ uses which: base <- deck <- model <- disc <- state <- step.

`output` sees what the state is made of but not the steps; `main` sees everything. Also: every file
holds one module of its own name, every `use` of a TALUS module says `only`, and src/CMakeLists.txt
names every source.
"""

import re
import sys
from pathlib import Path

CHAIN = ["base", "deck", "model", "disc", "state", "step"]
ALLOWED = {folder: set(CHAIN[: at + 1]) for at, folder in enumerate(CHAIN)}
ALLOWED["output"] = set(CHAIN[:-1]) | {"output"}
ALLOWED["main"] = set(CHAIN) | {"output", "main"}
GENERATED = {"talus_version": "base"}

USE = re.compile(r"^\s*use\s*(?:,\s*\w+\s*::)?\s*(talus_\w+)\s*(,\s*only\s*:)?", re.I)
UNIT = re.compile(r"^\s*(module|program)\s+(?!procedure\b)(\w+)\s*$", re.I)


def check(source):
    """All offences below a source folder, as lines of text."""
    files = sorted(source.glob("*/*.f90"))
    home = {file.stem: file.parent.name for file in files} | GENERATED
    listed = (source / "CMakeLists.txt").read_text(encoding="utf-8")
    found = []
    for file in files:
        folder = file.parent.name
        place = f"src/{folder}/{file.name}"
        if folder not in ALLOWED:
            found.append(f"{place}: no layer is called '{folder}'")
            continue
        if f"{folder}/{file.name}" not in listed:
            found.append(f"{place}: not in src/CMakeLists.txt")
        units = []
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            unit, use = UNIT.match(line), USE.match(line)
            if unit:
                units.append(unit.group(2).lower())
            if not use:
                continue
            module = use.group(1).lower()
            if module not in home:
                found.append(f"{place}:{number}: uses {module}, which no file holds")
            elif home[module] not in ALLOWED[folder]:
                found.append(f"{place}:{number}: {folder} may not use {module} of {home[module]}")
            if not use.group(2):
                found.append(f"{place}:{number}: use {module} without only")
        if units != [file.stem]:
            found.append(f"{place}: holds {units}, expected {file.stem} alone")
    if not files:
        found.append(f"no sources below {source}")
    return found


def main():
    found = check(Path(sys.argv[1]))
    print("\n".join(found) if found else "every use follows the layers")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
