# SPDX-License-Identifier: MIT
"""Flux, head and impermeable boundaries, and anisotropic conductivity: a linear head is exact.

The head falls by q/k_x per metre, on perturbed nodes too, from a transient that starts hydrostatic.
The same flow along y needs four times the gradient."""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(__file__.rsplit("/", 1)[0])
for name, change, k, axis, length in (
    ("along_x", [], 4.0e-5, 0, 2.0),
    ("along_y", [("'left'", "'bottom'"), ("'right'", "'top'")], 1.0e-5, 1, 1.0),
):
    result = case.run("darcy_flow.nml", change, name=name)
    head = result.field("pore_pressure") / 9810.0 + result.nodes[:, 1]
    exact = 3.0 + 2.0e-5 / k * (length - result.nodes[:, axis])
    case.check(
        f"largest error of head {name} [m]",
        np.max(np.abs(head - exact)),
        1e-8,
        "linear exactness, and the transient has died out",
    )
    velocity = result.field("seepage_velocity")
    case.check(
        f"largest error of velocity {name}, relative",
        np.max(np.abs(velocity[:, axis] / 2.0e-5 - 1)),
        1e-7,
        "linear exactness",
    )
    case.check(
        f"cross flow {name}, relative",
        np.max(np.abs(velocity[:, 1 - axis])) / 2.0e-5,
        1e-7,
        "linear exactness",
    )
    history = result.history()
    case.check(
        f"inflow {name} over flux x side x time, less one",
        abs(history["water_in"][-1] / (2.0e-5 * 2.0 / length * 1.0e5) - 1),
        1e-12,
        "flux is counted exactly",
    )
    case.check(f"water error {name}", abs(float(result.summary["water_error"])), 1e-12, "round-off")
sys.exit(case.verdict())
