# SPDX-License-Identifier: MIT
"""The failing demo slope, input/rain_slope, with half the time step and with twice the stabilisation.

Half the step of the slide must change the final displacement by less than 1 %, and so must twice the
stabilisation. The greatest displacement and its mean over the slide (where it is more than half of that)
are measured.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "verify"))
from talus_case import Case  # noqa: E402

case = Case(
    pathlib.Path(__file__).resolve().parents[3] / "input" / "rain_slope",
    id="hard 9",
    title="Half the step and twice the stabilisation on the failing demo slope",
    error="relative change of the final displacement",
    reference="the demo as it is",
)
case.story["case"] = "step_and_alpha"


def slope(name, *replace):
    """Greatest displacement, its mean over the slide, and the run."""
    result = case.run("case.nml", list(replace), name=name)
    length = np.linalg.norm(result.field("displacement"), axis=1)
    slid = length > 0.5 * length.max()
    mean = (length * result.area)[slid].sum() / result.area[slid].sum()
    print(
        f"     {name}: largest {length.max():.4g} m, mean {mean:.4g} m, "
        f"failure after {result.summary['trigger_time']} s"
    )
    return length.max(), mean, float(result.summary["trigger_time"]), result


largest, mean, trigger, demo = slope("demo")
curves = {"as it is": demo}
for what, name, replace, held in (
    (
        "half the step of the slide",
        "half_step",
        ("name = 'slide'", "name = 'slide'\n  step_safety = 0.45"),
        0.01,
    ),
    ("twice the stabilisation", "twice_alpha", ("length = 1.1", "length = 1.1\n  stabilisation = 0.1"), 0.28),
):
    other = slope(name, replace)
    curves[what] = other[3]
    case.study(what, other[3], 0.35, abs(other[0] / largest - 1.0))
    for quantity, one, two in (("greatest", largest, other[0]), ("mean", mean, other[1])):
        change, moved = abs(two / one - 1.0), f"{what}: change of the {quantity} displacement"
        case.target(moved, change, 0.01, "limit", held=(0.0, held), asked=True)
    case.check(f"{what}: change of the time of failure", abs(other[2] / trigger - 1.0), 0.15, "held")
case.picture(
    "Largest displacement during the slide",
    "time since the slide began [s]",
    "largest displacement [m]",
    {
        what: (
            h["time"][h["stage"] == "slide"] - h["time"][h["stage"] == "slide"][0],
            h["maximum_displacement"][h["stage"] == "slide"],
        )
        for what, h in ((what, result.history()) for what, result in curves.items())
    },
)
# Without stabilisation the slope does not slide as a mass: single nodes fly off.
_, _, _, bare = slope("no_alpha", ("length = 1.1", "length = 1.1\n  stabilisation = 0.004"))
flown = np.linalg.norm(bare.field("displacement"), axis=1)
case.remedy(
    "nodal modes of a sliding mass; remedy: stabilisation = 0.05",
    f"with 0.004 of the soil's stiffness single nodes fly off, up to {flown.max():.3g} m, "
    f"{flown.max() / np.percentile(flown, 95):.3g} times what 95 % of the nodes stay below",
    f"largest displacement {largest:.3g} m",
    flown.max() > 5.0 * largest,
)
# How much strength is in the stabilisation: the factor of safety of the standing slope after 16 h.
STORM = ("duration = 129600.0", "duration = 57600.0")
SLIDE = (
    "name = 'slide'\n  kind = 'dynamic'\n  only_after_failure = .true.\n  solve = 'soil'\n  duration = 15.0"
)
FACTOR = (SLIDE, "name = 'factor'\n  kind = 'strength_reduction'\n  factor_tolerance = 0.002")


def factor(smoothing, stabilisation):
    """Factor of safety after 16 h of rain."""
    replace = [
        ("levels = 2\n  length = 1.1", f"{smoothing}\n  stabilisation = {stabilisation}"),
        STORM,
        FACTOR,
    ]
    summary = case.run("case.nml", replace, name=f"factor_{smoothing[9]}_{stabilisation}").summary
    return float(summary["factor_of_safety"])


factors = {
    level: [factor(smoothing, alpha) for alpha in (0.05, 0.1)]
    for level, smoothing in (("one level", "levels = 1"), ("two levels", "levels = 2\n  length = 1.1"))
}
for level, (once, twice) in factors.items():
    case.check(
        f"factor of safety at 16 h, {level}: change by twice the stabilisation",
        twice / once - 1,
        0.015,
        "held",
    )
case.note(
    "Twice the stabilisation misses. What it adds is a little strength: the factor of safety after 16 h goes "
    "from "
    + " and ".join(f"{a:.4g} to {b:.4g} at {level}" for level, (a, b) in factors.items())
    + ". But rain takes only some 1 % of this slope's factor in an hour, and the slide is driven by what the "
    "soil lacks of balance, a few per cent of the weight: the slope fails later and slides less far. F, "
    "smoothed over ell, differs from the motion of the nodes, most of all in a shear band, and only the "
    "stabilisation resists there. Tried: a tolerance of 1e-5 and storm steps of 900 s move the times of "
    "failure of both by under 3 % and leave their distance of 10 %. A square of beta (4.11), residuals "
    "of F smoothed less and weights with a cusp at the centre all left a good part of it. A residual of the "
    "F of the first level brings the times of failure to within 4 %, but lets nodes of the sliding mass fly "
    "off at 0.05 (17 m), and the free square's frequencies fall by 10 % at ell = 3h."
)
sys.exit(case.verdict())
