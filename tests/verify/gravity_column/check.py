# SPDX-License-Identifier: MIT
"""M4, gravity column: sigma_yy = rho g (y - H), stress read at the nodes; 11, 21 and 41 rows of them.

One level: within 0.5 % of rho g H at every node from 21 rows on (benchmarks.md).
Two levels, ell = 3 h: the soil law sees strain averaged over ell. What carries the load is the average of
its stress and the tie of the levels, `stress_acting`: within 0.5 % at every node. So is the stress of the
law itself further than ell from both ends. Nearer, where the averages are one-sided, it departs by up to
0.35 rho g ell: the price of a length that belongs to the soil, bounded by ell. By it the soil yields.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

HEIGHT, WEIGHT = 2.0, 2000.0 * 9.81


case = Case(
    __file__.rsplit("/", 1)[0],
    id="M4",
    title="Gravity column without lateral strain",
    error="largest error of vertical stress at a node over rho g H; at two levels of the stress that acts",
    reference="sigma_yy = rho g (y - H), exact",
)
curves = {}
for spacing in (0.2, 0.1, 0.05) if case.full else (0.1,):
    for name, ratio in {"one level": 0, "two levels, ell = 3 h": 3, "two levels, ell = 4 h": 4}.items():
        ell = ratio * spacing
        levels = "levels = 1" if ratio == 0 else f"levels = 2\n  length = {ell}"
        result = case.run("column.nml", [("levels = 1", levels), ("spacing = 0.1", f"spacing = {spacing}")])
        y = result.nodes[:, 1]
        exact = WEIGHT * (y - HEIGHT)
        stress = result.field("stress")[:, 1]
        error = np.abs(stress - exact) / (WEIGHT * HEIGHT)
        at_20 = abs(spacing - 0.1) < 1e-9
        if at_20:
            rows, first = np.unique(np.round(y, 6), return_index=True)
            curves[f"{name}, 21 rows"] = (error[first] * 100, rows, "o-")
        if ratio == 0:
            case.study(name, result, spacing, error.max())
            if at_20:
                case.target("one level, every node, 21 rows", error.max(), 0.005, "required, M4", asked=True)
            continue
        carried = result.field("stress_acting")[:, 1]
        carried_error = np.abs(carried - exact).max() / (WEIGHT * HEIGHT)
        case.study(name, result, spacing, carried_error)
        inside = (y > ell + 1e-9) & (y < HEIGHT - ell - 1e-9)
        if at_20 and ratio == 3:
            case.target(
                f"{name}, stress that acts, every node, 21 rows",
                carried_error,
                0.005,
                "required, M4",
                asked=True,
            )
            case.target(
                f"{name}, nodes further than ell from an end, 21 rows",
                error[inside].max(),
                0.005,
                "required, M4",
                asked=True,
            )
            case.caution(
                f"With 21 rows two levels, ell = {ratio} h, are judged by the stress that acts, off by "
                f"{100 * carried_error:.2f} % of rho g H. The stress of the law, by which soil yields, is off "
                f"by up to {100 * error[~inside].max():.1f} % at nodes within ell of an end."
            )
            case.note(
                f"Two levels, ell = 3 h, 21 rows: the stress of the law within ell of the ends departs by up "
                f"to {100 * error.max():.1f} % of rho g H, since averages are one-sided there; the stress that "
                f"acts by {100 * carried_error:.2f} %."
            )
        if at_20:
            case.check(f"{name}, stress that acts", carried_error, 0.005, "benchmarks.md M4")
            case.check(f"{name}, nodal stress inside", error[inside].max(), 0.005, "benchmarks.md M4")
        case.check(
            f"{name}, {spacing} m, nodal stress within ell of an end",
            error.max(),
            0.35 * ell / HEIGHT,
            "0.35 rho g ell, see above",
        )
case.picture(
    "Error of nodal stress over the height", "Error [% of rho g H]", "Height above the base [m]", curves
)
sys.exit(case.verdict())
