# SPDX-License-Identifier: MIT
"""Flux, head and impermeable boundaries, and anisotropic conductivity: a linear head is exact.

The head falls by q/k_x per metre, on perturbed nodes too, from a transient that starts hydrostatic.
The same flow along y needs four times the gradient."""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="Darcy flow",
    title="a linear head is exact: flux and head boundaries, conductivity 4 : 1, perturbed nodes",
    error="largest error of head over its fall",
    reference="Darcy's law: the head falls by q/k per metre",
)
largest, curves = 0.0, {}
for direction, change, k, axis, length in (
    ("x", [], 4.0e-5, 0, 2.0),
    ("y", [("'left'", "'bottom'"), ("'right'", "'top'")], 1.0e-5, 1, 1.0),
):
    for spacing in (0.2, 0.1, 0.05) if case.full else (0.1,):
        name = f"along_{direction}_{spacing}"
        result = case.run("darcy_flow.nml", [*change, ("spacing = 0.1", f"spacing = {spacing}")], name=name)
        head = result.field("pore_pressure") / 9810.0 + result.nodes[:, 1]
        exact = 3.0 + 2.0e-5 / k * (length - result.nodes[:, axis])
        fall = 2.0e-5 / k * length
        case.study(
            f"along {direction}, perturbed nodes", result, spacing, np.max(np.abs(head - exact)) / fall
        )
        largest = max(largest, np.max(np.abs(head - exact)))
        if spacing == 0.1:
            along = result.nodes[:, axis]
            curves[f"along {direction}, k = {k:g} m/s"] = (along, head, "C0o" if axis == 0 else "C1s")
            line = ([0.0, length], [3.0 + fall, 3.0], "k-" if axis == 0 else "k--")
            curves[f"exact, along {direction}"] = line
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
case.picture(
    "Head along the flow at every node",
    "distance along the flow from where the water enters [m]",
    "head [m]",
    curves,
)
case.target("largest error of head [m]", largest, 1e-8, "linear exactness, and the transient has died out")
sys.exit(case.verdict())
