# SPDX-License-Identifier: MIT
"""H1: rain on a dry column against the exact solution of Broadbridge and White (1988).

The deck explains the scaling. Reference: Theta at depths of the exact solution (benchmark H1).
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

LENGTH, TIME, POROSITY = 0.1, 4000.0, 0.4
EXACT = {
    0.5: [(0, .3921), (.501, .2139), (1.001, .0800), (1.510, .0196)],
    2: [(0, .6187), (1.011, .4298), (2.007, .2025), (2.498, .1144)],
    8: [(0, .7913), (2.010, .7253), (3.999, .5633), (6.000, .2630), (7.997, .0501)],
}

case = Case(__file__.rsplit("/", 1)[0])
result = case.run("broadbridge_white.nml")
column = result.nodes[:, 0] < 1e-9
order = np.argsort(-result.nodes[column, 1])
depth = (1.0 - result.nodes[column, 1][order]) / LENGTH
for time, points in EXACT.items():
    theta = result.field("saturation", time=time * TIME)
    profile = theta[column][order]
    worst = max(abs(np.interp(d, depth, profile) - exact) for d, exact in points)
    case.check(f"largest error of Theta at t = {time}", worst, 0.02,
               "100 nodes over a depth of 10")
    case.check(f"rise of Theta with depth at t = {time}", np.max(np.diff(profile)), 1e-10,
               "the front is monotone to the tolerance of the implicit steps")
    stored = np.sum(theta * result.area) / np.sum(result.area) * 10.0
    case.check(f"water that is not 0.5 t at t = {time}",
               abs(stored - 0.5 * time - start) if time > 0.5 else 0.0, 1e-6,
               "no water is lost") if time > 0.5 else None
    start = stored - 0.5 * time
case.check("water error", abs(float(result.summary["water_error"])), 1e-12, "round-off")
print(f"     {result.summary['seepage_steps']} sub-steps, "
      f"{result.summary['wall_seconds_seepage']} s in seepage")
sys.exit(case.verdict())
