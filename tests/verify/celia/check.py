# SPDX-License-Identifier: MIT
"""H3: the infiltration front of Celia et al. (1990) in a van Genuchten soil.

celia.csv holds the pressure head in cm, Richardson-extrapolated from 6400 and 12800 cells. The deck
limits conductivity and retention as published; the front is the steepest of the usual benchmarks.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(__file__.rsplit("/", 1)[0])
exact = np.loadtxt(case.folder / "celia.csv", delimiter=",")
error = {}
for rows in (41, 81, 201):
    result = case.run("celia.nml", [("0.025", f"{1 / (rows - 1)}")], name=f"rows_{rows}")
    found = []
    for time, k in ((21600.0, 1), (43200.0, 2), (86400.0, 3)):
        psi = result.field("pore_pressure", time=time) / 98.1
        right = np.interp(result.nodes[:, 1] * 100, exact[:, 0], exact[:, k])
        found.append(np.linalg.norm(psi - right) / np.linalg.norm(right))
    error[rows] = found[-1]
    print(f"     {rows} rows, relative L2 of psi: " + ", ".join(f"{e:.3%}" for e in found)
          + f"; {result.summary['seepage_steps']} sub-steps, "
          f"{result.summary['wall_seconds_seepage']} s in seepage")
    case.check(f"water error, {rows} rows", abs(float(result.summary["water_error"])), 1e-12,
               "round-off")
    column = result.nodes[:, 0] < 1e-9
    saturation = result.field("saturation")[column][np.argsort(result.nodes[column, 1])]
    case.check("fall of saturation upward", np.max(-np.diff(saturation)), 1e-9,
               "the front is monotone")
case.check("error at 24 h, 41 rows", error[41], 0.10, "OpenGeoSys 6.5.9 has 0.165")
case.check("error at 24 h, 81 rows", error[81], 0.043, "OpenGeoSys 6.5.9 has 0.057 at 101")
case.check("error at 24 h, 201 rows", error[201], 0.015, "OpenGeoSys 6.5.9 has 0.047")
sys.exit(case.verdict())
