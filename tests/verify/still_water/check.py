# SPDX-License-Identifier: MIT
"""Still water stays still: hydrostatic pressure in sand and clay (conductivity 1e6 : 1), with a
capillary fringe, on perturbed nodes, from the hydrostatic and from the steady start."""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(__file__.rsplit("/", 1)[0])
for start in ("hydrostatic", "steady"):
    result = case.run("still_water.nml", [("'hydrostatic'", f"'{start}'")], name=start)
    still = 9810.0 * (1.0 - result.nodes[:, 1])
    moved = np.max(np.abs(result.field("pore_pressure") - still))
    print(f"     {start}: {result.summary['seepage_steps']} sub-steps in a day")
    case.check(
        f"largest change of pressure in a day, {start} start [Pa]",
        moved,
        1e-5,
        "1 nm of head: round-off of the fluxes over a step of hours",
    )
sys.exit(case.verdict())
