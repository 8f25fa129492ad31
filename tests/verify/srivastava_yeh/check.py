# SPDX-License-Identifier: MIT
"""H2: infiltration above a water table against the series of Srivastava and Yeh (1991).

srivastava_yeh.csv holds their exact series, pressure head in cm. Run at 101 rows on a regular grid,
and on perturbed nodes in two dimensions, where the exact solution still has one.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(__file__.rsplit("/", 1)[0])
exact = np.loadtxt(case.folder / "srivastava_yeh.csv", delimiter=",")
HOURS = {0: 1, 1: 2, 3: 3, 5: 4, 10: 5, 20: 6}


def errors(result):
    """Relative L2 error of the pressure head at each time."""
    found = {}
    for hours, k in HOURS.items():
        psi = result.field("pore_pressure", time=3600.0 * hours) / 9810.0
        right = np.interp(result.nodes[:, 1] * 100, exact[:, 0], exact[:, k]) / 100
        found[hours] = np.linalg.norm(psi - right) / np.linalg.norm(right)
    print(
        "     relative L2 of psi: "
        + ", ".join(f"{h} h {e:.3%}" for h, e in found.items())
        + f"; {result.summary['seepage_steps']} sub-steps, "
        f"{result.summary['wall_seconds_seepage']} s in seepage"
    )
    return found


coarse = errors(case.run("srivastava_yeh.nml", [("spacing = 0.01", "spacing = 0.02")], name="rows_51"))
result = case.run("srivastava_yeh.nml")
fine = errors(result)
case.check("error at 10 h", fine[10], 0.005, "101 rows")
case.check("error of the steady start", fine[0], 0.005, "the same fluxes without storage")
case.check(
    "error at 0 h over that of twice the spacing",
    fine[0] / coarse[0],
    0.3,
    "second order, 0.25, with a margin for higher terms",
)
case.check("water error", abs(float(result.summary["water_error"])), 1e-12, "round-off")
result = case.run(
    "srivastava_yeh.nml",
    [("width = 0.02", "width = 0.2"), ("spacing = 0.01", "spacing = 0.02 perturbation = 0.3")],
    name="perturbed",
)
uneven = errors(result)
case.check("error at 10 h on perturbed nodes", uneven[10], 0.005, "the same limit as on a grid")
case.check("water error on perturbed nodes", abs(float(result.summary["water_error"])), 1e-12, "round-off")
sys.exit(case.verdict())
