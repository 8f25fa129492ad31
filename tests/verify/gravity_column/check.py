# SPDX-License-Identifier: MIT
"""M4, gravity column: sigma_yy = rho g (y - H), 21 rows of nodes, stress read at the nodes.

One level: within 0.5 % of rho g H at every node (benchmarks.md).
Two levels: the soil law sees strain averaged over ell, and the average of its stress carries the
load. That average is within 1 % at every node (the stabilisation, alpha_s = 5 %, carries the rest).
The nodal stress itself is, further than ell from both ends; nearer, where the averages are one-
sided, it departs by up to 0.35 rho g ell: the price of a length that belongs to the soil, bounded
by ell and not an error of the solution.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

HEIGHT, WEIGHT = 2.0, 2000.0 * 9.81


def average(nodes, area, ell):
    """Weights of the second level: cubic B-spline, symmetric, rows that sum to one."""
    distance = np.linalg.norm(nodes[:, None] - nodes[None], axis=2) / ell
    spline = np.where(
        distance < 0.5, 2 / 3 - 4 * distance**2 + 4 * distance**3, 4 / 3 * np.clip(1 - distance, 0, None) ** 3
    )
    scale = np.ones(len(area))
    for _ in range(200):
        scale = np.sqrt(scale / (spline @ (scale * area)))
    return scale[:, None] * spline * (scale * area)


case = Case(__file__.rsplit("/", 1)[0])
for ell in (None, 0.3, 0.4):
    levels = "levels = 1" if ell is None else f"levels = 2\n  length = {ell}"
    result = case.run("column.nml", [("levels = 1", levels)])
    y = result.nodes[:, 1]
    exact = WEIGHT * (y - HEIGHT)
    stress = result.field("stress")[:, 1]
    error = np.abs(stress - exact) / (WEIGHT * HEIGHT)
    if ell is None:
        case.check("one level", error.max(), 0.005, "benchmarks.md M4")
        continue
    carried = average(result.nodes, result.area, ell) @ stress
    inside = (y > ell + 1e-9) & (y < HEIGHT - ell - 1e-9)
    what = f"two levels, ell = {ell} m"
    case.check(
        f"{what}, averaged stress",
        np.abs(carried - exact).max() / (WEIGHT * HEIGHT),
        0.01,
        "but for the share of the stabilisation",
    )
    case.check(f"{what}, nodal stress inside", error[inside].max(), 0.005, "benchmarks.md M4")
    case.check(
        f"{what}, nodal stress within ell of an end",
        error.max(),
        0.35 * ell / HEIGHT,
        "0.35 rho g ell, see above",
    )
sys.exit(case.verdict())
