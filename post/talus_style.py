# SPDX-License-Identifier: MIT
"""The look of all figures: fonts, colours, units and labels, and the shared command line."""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)
import numpy as np  # noqa: E402
from matplotlib.colors import LinearSegmentedColormap  # noqa: E402

from talus_result import Result, ResultError  # noqa: E402

INK = "#222222"
GREY = "#8a8a8a"
# Okabe & Ito: tells apart for every kind of colour vision.
LINES = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999")

# Sound soil is pale, so that only what is damaged stands out; lightness falls all the way.
DAMAGED = LinearSegmentedColormap.from_list(
    "damaged", ["#f3f0e9", "#fbd08a", "#ee8a3c", "#c23b3a", "#7a1746", "#1c0a2c"]
)
MOVED = LinearSegmentedColormap.from_list(
    "moved", ["#f3f0e9", "#b5dccb", "#5fb3b3", "#2f7fa3", "#2b4c86", "#211a4a"]
)
# Brown is suction, white is zero, blue is water under pressure.
WATER = LinearSegmentedColormap.from_list(
    "water", ["#6b3f10", "#b98a4b", "#e6d3ab", "#f7f5ef", "#a9cfe6", "#3f8fc6", "#0b3c70"]
)


@dataclass(frozen=True)
class Look:
    """How one field is shown: its words, symbol and colour map."""

    label: str
    symbol: str = ""
    colours: object = "viridis"
    signed: bool = False  # symmetric about zero
    split: bool = False  # zero in the middle of the colours, each side with its own scale


LOOKS = {
    "displacement": Look("Displacement", r"$|u|$", MOVED),
    "velocity": Look("Velocity", r"$|v|$", MOVED),
    "stress": Look("Stress", r"$\sigma$", "RdBu_r", True),
    "stress_acting": Look("Stress that acts", r"$\sigma$", "RdBu_r", True),
    "strain": Look("Strain", r"$\varepsilon$", "RdBu_r", True),
    "plastic_strain": Look("Equivalent plastic strain", r"$\bar\varepsilon^p$", DAMAGED),
    "opening": Look("Opening", r"$o$", DAMAGED),
    "damage": Look("Damage", r"$D$", DAMAGED),
    "pore_pressure": Look("Pore water pressure", r"$p_w$", WATER, split=True),
    "saturation": Look("Degree of saturation", r"$S_r$", "YlGnBu"),
    "suction": Look("Suction", r"$s$", "YlOrBr"),
    "porosity": Look("Porosity", r"$n$", "cividis"),
    "seepage_velocity": Look("Seepage velocity", r"$|v_w|$", "YlGnBu"),
}


def look_of(name):
    """Look of a field or of a component of one."""
    if name in LOOKS:
        return LOOKS[name]
    stem, _, part = name.rpartition("_")
    if stem in LOOKS and part in ("x", "y", "xx", "yy", "zz", "xy"):
        letter = LOOKS[stem].symbol.strip("$").replace("|", "")
        base, _, sub = letter.partition("_")
        index = f"{sub},{part}" if sub else part
        return Look(f"{LOOKS[stem].label} {part}", f"${base}_{{{index}}}$", "RdBu_r", True)
    return Look(name.replace("_", " ").capitalize())


def display_units(units, largest):
    """Factor and units that make numbers up to `largest` readable: 25000 Pa is 25 kPa."""
    steps = {
        "Pa": ((1e6, 1e-6, "MPa"), (1e3, 1e-3, "kPa")),
        "J": ((1e6, 1e-6, "MJ"), (1e3, 1e-3, "kJ")),
        "J/m": ((1e6, 1e-6, "MJ/m"), (1e3, 1e-3, "kJ/m")),
    }
    for limit, factor, text in steps.get(units, ()):
        if largest >= limit:
            return factor, text
    if units == "m" and 0.0 < largest < 0.1:
        return 1e3, "mm"
    if units == "m/s" and 0.0 < largest < 1e-3:
        return 3.6e6, "mm/h"
    pretty = {"1": "", "m2": "m²", "m3": "m³", "m3/m": "m³/m", "m2/m": "m²/m"}
    return 1.0, pretty.get(units, units)


def axis_label(name, units):
    """'Suction s [kPa]'."""
    look = look_of(name)
    words = f"{look.label} {look.symbol}".strip()
    return f"{words} [{units}]" if units else words


def time_scale(span):
    """Factor and unit for a stretch of time [s]."""
    if span < 300.0:
        return 1.0, "s"
    if span < 3 * 3600.0:
        return 1.0 / 60.0, "min"
    return 1.0 / 3600.0, "h"


def time_text(result, snapshot):
    """'storm, 12.5 h', or 'slide, 12.5 h + 3.20 s' in a short stage that starts late.

    A mechanism has a factor of safety in place of a time.
    """
    if snapshot.name.startswith("mechanism"):
        factor = result.factor_of_safety(snapshot.stage)
        return f"{snapshot.stage}, factor of safety {factor:.4g}" if factor else snapshot.stage
    start = result.stage_start(snapshot)
    last = max(s.time for s in result.snapshots if s.stage == snapshot.stage)
    factor, unit = time_scale(max(last - start, 1e-12))
    if start > 100 * (last - start) > 0.0:
        big, big_unit = time_scale(start)
        text = f"{start * big:.2f} {big_unit} + {(snapshot.time - start) * factor:.2f} {unit}"
    else:
        factor, unit = time_scale(last)
        text = f"{snapshot.time * factor:.2f} {unit}"
    return f"{snapshot.stage}, {text}" if snapshot.stage else text


def use_style():
    """Set the style of all figures."""
    plt.rcParams.update(
        {
            "font.size": 9,
            "axes.titlesize": 9,
            "axes.labelsize": 9,
            "xtick.labelsize": 8,
            "ytick.labelsize": 8,
            "legend.fontsize": 8,
            "figure.titlesize": 10,
            "figure.constrained_layout.use": True,
            "figure.dpi": 100,
            "axes.edgecolor": INK,
            "axes.labelcolor": INK,
            "text.color": INK,
            "xtick.color": INK,
            "ytick.color": INK,
            "axes.linewidth": 0.7,
            "xtick.major.width": 0.7,
            "ytick.major.width": 0.7,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "axes.titlelocation": "left",
            "axes.axisbelow": True,
            "axes.xmargin": 0.02,
            "axes.formatter.limits": (-4, 5),
            "axes.formatter.use_mathtext": True,
            "axes.prop_cycle": plt.cycler(color=LINES),
            "lines.linewidth": 1.4,
            "legend.frameon": False,
            "grid.color": "#dddddd",
            "grid.linewidth": 0.5,
            "savefig.dpi": 200,
        }
    )


def parser_of(description):
    """Command line that every figure shares."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("result", type=Path, help="result file (.h5)")
    parser.add_argument("--output", type=Path, help="file to write (.png, .pdf, .svg)")
    parser.add_argument("--dpi", type=float, default=200.0, help="dots per inch (200)")
    return parser


def seconds(text):
    """A time in seconds: '5400', '90min', '1.5h'."""
    for unit, factor in (("min", 60.0), ("h", 3600.0), ("d", 86400.0), ("s", 1.0)):
        if text.endswith(unit):
            return float(text[: -len(unit)]) * factor
    return float(text)


def figure_path(result_path, figure, suffix=".png"):
    """figures/<result>_<figure>.png beside the result file."""
    result_path = Path(result_path)
    return result_path.parent / "figures" / f"{result_path.stem}_{figure}{suffix}"


def save(figure, path, dpi):
    """Write a figure, making its folder; returns the file's name."""
    return write(path, lambda place: figure.savefig(place, dpi=dpi), figure)


def write(path, how, figure):
    """Write a file by `how(path)`, making its folder, and close the figure; returns the file's name."""
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        how(path)
    except (OSError, ValueError) as error:
        # Matplotlib and Pillow tell by a ValueError which endings they know.
        raise ResultError(f"cannot write {path}: {getattr(error, 'strerror', None) or error}") from error
    finally:
        plt.close(figure)
    return path


def run_main(parser, draw):
    """Parse the command line, draw, print the file's name; a message instead of a traceback."""
    arguments = parser.parse_args()
    use_style()
    try:
        with Result(arguments.result) as result:
            print(draw(result, arguments))
    except ResultError as error:
        give_up(parser.prog, error)


def give_up(program, error):
    """End with the message and the exit code of wrong input, as for a wrong option."""
    print(f"{program}: {error}", file=sys.stderr)
    sys.exit(2)


def finite_range(arrays):
    """Smallest and largest finite value of some arrays."""
    low, high = np.inf, -np.inf
    for array in arrays:
        finite = array[np.isfinite(array)]
        if finite.size:
            low, high = min(low, finite.min()), max(high, finite.max())
    return (float(low), float(high)) if low <= high else (0.0, 1.0)
