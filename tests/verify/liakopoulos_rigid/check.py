# SPDX-License-Identifier: MIT
"""H5, rigid skeleton: drainage of a column of Del Monte sand (Liakopoulos 1964).

liakopoulos_rigid.csv holds the pressure head in m of a converged one-dimensional solution.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(__file__.rsplit("/", 1)[0])
exact = np.loadtxt(case.folder / "liakopoulos_rigid.csv", delimiter=",")
result = case.run("liakopoulos_rigid.nml")
for k, time in enumerate((60, 300, 600, 1200, 1800, 3600, 7200), start=1):
    psi = result.field("pore_pressure", time=float(time)) / 9810.0
    right = np.interp(result.nodes[:, 1], exact[:, 0], exact[:, k])
    case.check(
        f"relative L2 error of psi at {time} s",
        np.linalg.norm(psi - right) / np.linalg.norm(right),
        0.01,
        "101 rows",
    )
case.check("water error", abs(float(result.summary["water_error"])), 1e-12, "round-off")
print(
    f"     {result.summary['seepage_steps']} sub-steps, {result.summary['wall_seconds_seepage']} s in seepage"
)
sys.exit(case.verdict())
