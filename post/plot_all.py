#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every figure that a result file has the data for, into figures/ beside it."""

import argparse
import sys
from pathlib import Path

import animate
import plot_field
import plot_histories
import plot_profiles
import plot_sequence
import plot_water_balance
from talus_map import default_field
from talus_result import Result, ResultError
from talus_style import figure_path, give_up, use_style

MAPS = ("displacement", "plastic_strain", "damage", "pore_pressure", "saturation")


def result_file(path):
    """The result file itself, or the only one in a folder."""
    path = Path(path)
    if not path.is_dir():
        return path
    found = sorted(path.glob("*.h5"))
    if len(found) != 1:
        names = ", ".join(f.name for f in found) or "none"
        raise ResultError(f"{path}: one result file (.h5) expected in this folder, found {names}")
    return found[0]


def figures_of(result, folder, dpi):
    """(module, arguments) of each figure."""
    path = str(result.path)
    best = default_field(result)
    plan = [(plot_field, f"{name}", ["--field", name]) for name in MAPS if result.has(name)]
    for snapshot in result.snapshots:
        if snapshot.name.startswith("mechanism"):
            options = ["--field", "plastic_strain", "--snapshot", snapshot.name]
            plan.append((plot_field, f"plastic_strain_{snapshot.name}", options))
    plan.append((plot_sequence, f"{best}_sequence", ["--field", best]))
    if result.has("pore_pressure"):
        plan.append((plot_sequence, "pore_pressure_sequence", ["--field", "pore_pressure"]))
    plan.append((plot_profiles, "profiles", []))
    plan.append((plot_histories, "histories", []))
    plan.append((plot_water_balance, "water_balance", []))
    plan.append((animate, best, ["--field", best, "--frames", "60"]))
    done = set()
    for module, name, options in plan:
        suffix = ".gif" if module is animate else ".png"
        output = folder / figure_path(path, name, suffix).name
        if output in done:
            continue
        done.add(output)
        resolution = [] if module is animate or dpi is None else ["--dpi", str(dpi)]
        yield module, [path, "--output", str(output), *resolution, *options]


def draw_all(path, folder=None, dpi=None, animation=True):
    """Draw; prints the name of each file and returns them."""
    path = result_file(path)
    folder = Path(folder) if folder else figure_path(path, "").parent
    use_style()
    written = []
    with Result(path) as result:
        for module, options in figures_of(result, folder, dpi):
            if module is animate and not (animation and len(result.numbered()) > 1):
                continue
            try:
                written.append(module.draw(result, module.parser().parse_args(options)))
            except ResultError as error:
                print(f"left out {module.__name__}: {error}", file=sys.stderr)
                continue
            print(written[-1], flush=True)
    return written


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result", type=Path, help="result file (.h5), or its folder")
    parser.add_argument("--output", type=Path, help="folder (figures/ beside the result)")
    parser.add_argument("--dpi", type=float, help="dots per inch of the still figures (200)")
    parser.add_argument("--no-animation", action="store_true", help="leave the GIF out")
    arguments = parser.parse_args()
    try:
        draw_all(arguments.result, arguments.output, arguments.dpi, not arguments.no_animation)
    except ResultError as error:
        give_up("plot_all.py", error)


if __name__ == "__main__":
    main()
