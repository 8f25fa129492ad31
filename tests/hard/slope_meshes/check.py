# SPDX-License-Identifier: MIT
"""The slope of the demo, input/rain_slope, at three spacings with one smoothing length.

The time of failure must agree within 3 % and the mass of the slide (where the displacement is more than
half of the greatest) within 5 % after 4 s of sliding. At one level the width of the band follows the spacing.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "verify"))
from talus_case import Case  # noqa: E402

case = Case(
    pathlib.Path(__file__).resolve().parents[3] / "input" / "rain_slope",
    id="hard 10",
    title="The demo's slope at three spacings with one smoothing length",
    error="range of the time of failure over its mean",
    reference="each other",
)
case.story["case"] = "slope_meshes"
SPACINGS = (0.5, 0.4, 0.3)
SHORT = ("duration = 15.0", "duration = 4.0")


def slope(levels, spacing):
    """Time of failure [s], area of the slide [m2], and the run."""
    smoothing = "levels = 2\n  length = 1.5" if levels == 2 else "levels = 1"
    replace = [("spacing = 0.35", f"spacing = {spacing}"), ("levels = 2\n  length = 1.1", smoothing), SHORT]
    result = case.run("case.nml", replace, name=f"level_{levels}_{spacing}")
    length = np.linalg.norm(result.field("displacement"), axis=1)
    mass = result.area[length > 0.5 * length.max()].sum()
    trigger = float(result.summary["trigger_time"])
    print(
        f"     {levels} levels, {spacing} m: failure after {trigger:.6g} s, slide of {mass:.4g} m2, "
        f"largest displacement {length.max():.4g} m"
    )
    return trigger, mass, result


def spread(values):
    """Range over mean."""
    return (max(values) - min(values)) / np.mean(values)


def band_strain(result):
    """Greatest plastic strain: it grows without bound where a band has no width of its own."""
    return float(result.field("plastic_strain").max())


two = [slope(2, spacing) for spacing in SPACINGS]
one = [slope(1, spacing) for spacing in (SPACINGS[0], SPACINGS[-1])]
for spacing, run in zip(SPACINGS, two):
    case.study("two levels, 1.5 m", run[2], spacing, abs(run[0] / two[-1][0] - 1.0))
case.target(
    "time of failure at three spacings, range over mean",
    spread([run[0] for run in two]),
    0.03,
    "required",
    held=(0.0, 0.08),
)
case.target(
    "mass of the slide at three spacings, range over mean",
    spread([run[1] for run in two]),
    0.05,
    "required",
    held=(0.0, 0.15),
)
smooth = [band_strain(run[2]) for run in two]
rough = [band_strain(run[2]) for run in one]
case.remedy(
    "bands as narrow as the mesh; remedy: a smoothing length of 1.5 m",
    f"one level, 0.5 and 0.3 m: failure after {one[0][0]:.6g} and {one[1][0]:.6g} s, greatest plastic strain "
    f"{rough[0]:.3g} and {rough[1]:.3g}",
    f"failure after {two[0][0]:.6g} and {two[-1][0]:.6g} s, {smooth[0]:.3g} and {smooth[-1]:.3g}",
    spread([run[0] for run in one]) > spread([run[0] for run in two]) or max(rough) > 2.0 * max(smooth),
)
case.note(
    "Both limits are missed. At one level the time of failure moves nearly three times as much. How much of "
    "what is left comes from the stabilisation, which shear bands feel (hard 9), has not been separated."
)
case.picture(
    "Time of failure over spacing",
    "node spacing [m]",
    "time of failure [h]",
    {
        "two levels, 1.5 m": (SPACINGS, [run[0] / 3600.0 for run in two], "o-"),
        "one level": ((SPACINGS[0], SPACINGS[-1]), [run[0] / 3600.0 for run in one], "s--"),
    },
)
sys.exit(case.verdict())
