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
    0.5: [(0, 0.3921), (0.501, 0.2139), (1.001, 0.0800), (1.510, 0.0196)],
    2: [(0, 0.6187), (1.011, 0.4298), (2.007, 0.2025), (2.498, 0.1144)],
    8: [(0, 0.7913), (2.010, 0.7253), (3.999, 0.5633), (6.000, 0.2630), (7.997, 0.0501)],
}

case = Case(__file__.rsplit("/", 1)[0])
result = case.run("broadbridge_white.nml")
column = result.nodes[:, 0] < 1e-9
order = np.argsort(-result.nodes[column, 1])
depth = (1.0 - result.nodes[column, 1][order]) / LENGTH
start = None
for time, points in EXACT.items():
    theta = result.field("saturation", time=time * TIME)
    profile = theta[column][order]
    worst = max(abs(np.interp(d, depth, profile) - exact) for d, exact in points)
    case.check(f"largest error of Theta at t = {time}", worst, 0.02, "100 nodes over a depth of 10")
    case.check(
        f"rise of Theta with depth at t = {time}",
        np.max(np.diff(profile)),
        1e-10,
        "the front is monotone to the tolerance of the implicit steps",
    )
    stored = np.sum(theta * result.area) / np.sum(result.area) * 10.0
    # What was there before the rain, by the first of the times.
    start = stored - 0.5 * time if start is None else start
    case.check(
        f"water that is not 0.5 t at t = {time}", abs(stored - 0.5 * time - start), 1e-6, "no water is lost"
    )
case.check("water error", abs(float(result.summary["water_error"])), 1e-12, "round-off")
print(
    f"     {result.summary['seepage_steps']} sub-steps, {result.summary['wall_seconds_seepage']} s in seepage"
)
sys.exit(case.verdict())
