# SPDX-License-Identifier: MIT
"""H3: the infiltration front of Celia et al. (1990) in a van Genuchten soil.

celia.csv holds the pressure head in cm, every centimetre, Richardson-extrapolated from 6400 and 12800
cells. The front is so steep that the reference must not be interpolated: rows lie on whole centimetres
or only those that do are compared.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(__file__.rsplit("/", 1)[0])
exact = np.loadtxt(case.folder / "celia.csv", delimiter=",")
error, mean = {}, {}
for rows in (51, 101, 201):
    result = case.run("celia.nml", [("0.025", f"{1 / (rows - 1)}")], name=f"rows_{rows}")
    found = []
    height = result.nodes[:, 1] * 100
    whole = np.abs(height - np.round(height)) < 1e-6
    point = np.round(height[whole]).astype(int)
    for time, k in ((21600.0, 1), (43200.0, 2), (86400.0, 3)):
        psi = result.field("pore_pressure", time=time)[whole] / 98.1
        right = exact[point, k]
        found.append(np.linalg.norm(psi - right) / np.linalg.norm(right))
    error[rows], mean[rows] = found[-1], np.mean(found)
    print(
        f"     {rows} rows, relative L2 of psi: "
        + ", ".join(f"{e:.3%}" for e in found)
        + f"; {result.summary['seepage_steps']} sub-steps, "
        f"{result.summary['wall_seconds_seepage']} s in seepage"
    )
    case.check(f"water error, {rows} rows", abs(float(result.summary["water_error"])), 1e-12, "round-off")
    column = result.nodes[:, 0] < 1e-9
    saturation = result.field("saturation")[column][np.argsort(result.nodes[column, 1])]
    case.check("fall of saturation upward", np.max(-np.diff(saturation)), 1e-9, "the front is monotone")
case.check("error at 24 h, 51 rows", error[51], 0.10, "OpenGeoSys 6.5.9 has 0.165 at 41")
case.check("error at 24 h, 101 rows", error[101], 0.03, "OpenGeoSys 6.5.9 has 0.057")
case.check("error at 24 h, 201 rows", error[201], 0.015, "OpenGeoSys 6.5.9 has 0.047")
case.check(
    "mean error at 201 over that at 51 rows",
    mean[201] / mean[51],
    0.25,
    "first order at least, although the front is a few nodes wide",
)
sys.exit(case.verdict())
