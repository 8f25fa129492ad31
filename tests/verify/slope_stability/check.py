# SPDX-License-Identifier: MIT
"""S1, Griffiths & Lane (1999) example 1: 2:1 slope, H = 10 m, phi = 20, psi = 0, gamma = 20 kN/m3.

c/(gamma H) = 0.05 stands. Strength divided by a factor: published factor of safety 1.380 (Bishop &
Morgenstern), (1.35, 1.40] by finite elements: it stands at 1.35 and falls at 1.40 at both levels.
c/(gamma H) = 0.02 still stands, with a factor of 1.06 by Bishop's circles (bishop.py), and falls with its
strength divided by 1.10; 0.01 (factor 0.94) falls as it is. A slope that does not stand ends the geostatic
stage, and the run, with exit code 3; in a storm the run goes on and tells `failed`. The balance is asked
to 1e-5 of the load: a slope at 1.40 creeps on at 1e-4.
"""

import math
import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from bishop import factor_of_slope  # noqa: E402
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="S1 bracket",
    title="which slopes of Griffiths & Lane (1999) example 1 stand, and which fall",
    error="factor of safety by strength reduction against that of Bishop's circles, relative",
    reference="Bishop & Morgenstern's charts: 1.380; finite elements of Griffiths & Lane: in (1.35, 1.40]; "
    "Bishop 1955, with the circles searched by bishop.py",
    quantity="|F/F of circles - 1|",
    order=False,
)
TWO = "levels = 2\n  length = 1.4"
UNIT_WEIGHT, HEIGHT, FRICTION = 20.0e3, 10.0, 20.0


def run(ratio, factor, levels, stands):
    friction = math.degrees(math.atan(math.tan(math.radians(20.0)) / factor))
    result = case.run(
        "slope.nml",
        [
            ("cohesion = 10.0e3", f"cohesion = {ratio * 200.0e3 / factor}"),
            ("friction_angle = 20.0", f"friction_angle = {friction}"),
            ("levels = 1", levels),
        ],
        code=0 if stands else 3,
    )
    what = f"c/(gamma H) = {ratio}, strength over {factor}, {levels.split(chr(10))[0]}"
    if stands:
        case.check_true(what + ": stands, also in a storm", result.summary["failed"] == ".false.")
    else:
        case.check_true(
            what + ": falls, and says so",
            "no equilibrium within steps_max" in result.done.stderr
            and "does not stand" in result.done.stderr,
        )
    history = result.history()
    gravity = history["stage"] == "gravity"
    return history["maximum_displacement"][gravity].max()


def bishop(ratio):
    return factor_of_slope(ratio * UNIT_WEIGHT * HEIGHT, FRICTION, HEIGHT, 2.0, UNIT_WEIGHT)[0]


def reduced(ratio):
    """Factor of safety of a slope with this c/(gamma H) by strength reduction, at the finest of spacings."""
    for spacing in (0.9, 0.64, 0.45):
        result = case.run(
            "../factor_of_safety/slope.nml",
            [
                ("cohesion = 10.0e3", f"cohesion = {ratio * UNIT_WEIGHT * HEIGHT}"),
                ("spacing = 0.45", f"spacing = {spacing}"),
            ],
            name=f"reduced_{ratio}_{spacing}",
        )
        factor = float(result.summary["factor_of_safety"])
        case.study(f"c/(gamma H) = {ratio}", result, spacing, abs(factor / bishop(ratio) - 1.0))
    return factor


curves = {}
for name, levels, mark in (("one level", "levels = 1", "C0o-"), ("two levels", TWO, "C1s-")):
    factors = (1.0, 1.2, 1.3, 1.35, 1.40, 1.45) if case.full else (1.0, 1.35, 1.40)
    moved = [run(0.05, factor, levels, factor < 1.38) for factor in factors]
    curves[name] = (factors, np.array(moved) * 1e8 / (20e3 * 10.0**2), mark)
    case.target(
        f"displacement at 1.35 over that at 1.40, {name}",
        moved[factors.index(1.35)] / moved[factors.index(1.40)],
        0.8,
        "it runs away between 1.35 and 1.40",
    )
run(0.02, 1.0, "levels = 1", True)
run(0.02, 1.10, "levels = 1", False)
run(0.01, 1.0, "levels = 1", False)
case.picture(
    "Displacement under gravity; what does not stand was stopped",
    "Factor that divides the strength [-]",
    "Displacement E u/(gamma H²) [-]",
    curves,
)

if case.full:
    RATIO = 0.02
    circle = bishop(RATIO)
    factor = reduced(RATIO)
    what = "c/(gamma H) = 0.02 falls: its factor of safety"
    case.target(what, factor, 1.0, "asked for", held=(1.0, 1.056), asked=True)
    case.note(
        "The slope of example 1 was asked to fall at c/(gamma H) = 0.02. TALUS finds a factor of safety of "
        f"{factor:.3f} there, and Bishop's circles {circle:.3f} (tests/verify/slope_stability/bishop.py): "
        f"two methods agree that it stands. It falls at 0.01, where the circles give {bishop(0.01):.3f}."
    )
    case.check_true("by Bishop's circles it stands, and 0.01 falls", bishop(0.01) < 1.0 < circle)
    case.check("Bishop's circles for 0.05, over the charts", abs(bishop(0.05) / 1.380 - 1.0), 0.005, "1.380")
    factors = {ratio: reduced(ratio) for ratio in (0.035, 0.05)} | {RATIO: factor}
    for ratio, found in factors.items():
        case.target(
            f"c/(gamma H) = {ratio}: factor of safety over that of Bishop's circles, distance from 1",
            abs(found / bishop(ratio) - 1.0),
            0.02,
            "limit equilibrium itself is good to a few per cent; h = 0.45 m, bracket 0.01",
        )
    ratios = np.linspace(0.01, 0.05, 9)
    case.picture(
        "Factor of safety over c/(gamma H)",
        "c/(gamma H) [-]",
        "Factor of safety [-]",
        {
            "Bishop's circles": (ratios, [bishop(ratio) for ratio in ratios]),
            "TALUS, strength reduction, h = 0.45 m": (list(factors), list(factors.values()), "o"),
            "stands above": (ratios[[0, -1]], [1.0, 1.0], "k:"),
        },
    )
sys.exit(case.verdict())
