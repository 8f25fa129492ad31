# SPDX-License-Identifier: MIT
"""H6: flow through a rectangular dam with a seepage face, from the steady start.

q = k (h1^2 - h2^2)/(2 L) holds exactly however high the seepage face is (Charny 1951). A day of
transient flow from there has the same flow in and out: the start is steady.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

EXACT = 0.5 * (5.0**2 - 1.0**2) / (2 * 10.0)  # m2/d

case = Case(__file__.rsplit("/", 1)[0])
for name, change in (("grid", []), ("perturbed", [("spacing = 0.25", "spacing = 0.25 perturbation = 0.3")])):
    result = case.run("dupuit.nml", change, name=name)
    history = result.history()
    inward, outward = history["water_in"][-1], history["water_out"][-1]
    print(
        f"     {name}: in {inward:.6f} m2/d, out {outward:.6f} m2/d, "
        f"{result.summary['seepage_steps']} sub-steps, {result.summary['wall_seconds']} s"
    )
    case.check(
        f"relative error of the flow, {name}",
        abs(inward / EXACT - 1),
        0.01,
        "fringe of 1 cm in 5 m, spacing 0.25 m",
    )
    case.check(f"in over out less one, {name}", abs(inward / outward - 1), 1e-6, "steady")
    case.check(f"water error, {name}", abs(float(result.summary["water_error"])), 1e-12, "round-off")
    names = result.snapshots()
    drift = np.max(np.abs(result.field("pore_pressure", names[-1]) - result.field("pore_pressure", names[0])))
    case.check(f"drift of the pressure in a day, {name} [Pa]", drift, 1e-2, "1 um of head")
    right = np.abs(result.nodes[:, 0] - 10) < 1e-9
    wet = right & (result.field("pore_pressure") > -1e-3)
    top = np.max(result.nodes[wet, 1])
    case.check_true(f"the seepage face ends between the reservoirs, {name}: {top} m", 1.25 <= top <= 4.0)
sys.exit(case.verdict())
