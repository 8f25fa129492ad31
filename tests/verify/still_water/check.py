# SPDX-License-Identifier: MIT
"""Still water stays still: hydrostatic pressure in sand and clay (conductivity 1e6 : 1), with a
capillary fringe, on perturbed nodes, from the hydrostatic and from the steady start."""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="still water",
    title="still water stays still in layers of 1e6 : 1",
    error="largest change of pressure in a day, over the largest pressure, 9.81 kPa",
    reference="hydrostatic pressure",
)
worst, curves = 0.0, {}
for start in ("hydrostatic", "steady"):
    for spacing in (0.2, 0.1, 0.05) if case.full else (0.1,):
        result = case.run(
            "still_water.nml",
            [("'hydrostatic'", f"'{start}'"), ("spacing = 0.1", f"spacing = {spacing}")],
            name=f"{start}_{spacing}",
        )
        still = 9810.0 * (1.0 - result.nodes[:, 1])
        pressure = result.field("pore_pressure")
        moved = np.max(np.abs(pressure - still))
        case.study(f"{start} start, perturbed nodes", result, spacing, moved / 9810.0)
        worst = max(worst, moved)
        if spacing == 0.1:
            mark = "C0o" if start == "hydrostatic" else "C1+"
            curves[f"after a day, {start} start"] = (pressure / 1e3, result.nodes[:, 1], mark)
curves["hydrostatic, exact"] = (9.81 * np.array([1.0, -1.0]), [0.0, 2.0], "k-")
curves["layer of clay"] = ([-9.81, 9.81, 9.81, -9.81, -9.81], [0.6, 0.6, 1.3, 1.3, 0.6], "C7:")
case.picture(
    "Pressure of every node over the height",
    "pore pressure [kPa]",
    "height [m]",
    curves,
)
case.target(
    "largest change of pressure in a day [Pa]",
    worst,
    1e-5,
    "1 nm of head: round-off of the fluxes over a step of hours",
)
sys.exit(case.verdict())
