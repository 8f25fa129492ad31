# SPDX-License-Identifier: MIT
"""A saturated column of Del Monte sand drains through its bottom; its skeleton is rigid.

liakopoulos_rigid.csv holds the pressure head in m, every centimetre, of a converged one-dimensional
solution; only rows on whole centimetres are compared.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="H5 rigid",
    title="drainage of Liakopoulos (1964), rigid skeleton",
    error="relative L2 of the pressure head over the rows at whole centimetres, the worst of seven times",
    reference="liakopoulos_rigid.csv: converged one-dimensional solution of the same equations",
)
exact = np.loadtxt(case.folder / "liakopoulos_rigid.csv", delimiter=",")
TIMES = (60, 300, 600, 1200, 1800, 3600, 7200)


def errors(result):
    """Relative L2 error of the pressure head at each time."""
    height = result.nodes[:, 1] * 100
    whole = np.abs(height - np.round(height)) < 1e-6
    point = np.round(height[whole]).astype(int)
    found = {}
    for k, time in enumerate(TIMES, start=1):
        psi = result.field("pore_pressure", time=float(time))[whole] / 9810.0
        found[time] = np.linalg.norm(psi - exact[point, k]) / np.linalg.norm(exact[point, k])
    return found


results = {}
for rows in (26, 51, 101, 201) if case.full else (101,):
    spacing = 1 / (rows - 1)
    results[rows] = case.run(
        "liakopoulos_rigid.nml",
        [("width = 0.02", f"width = {spacing}"), ("spacing = 0.01", f"spacing = {spacing}")],
        name=f"rows_{rows}",
        repeat=3 if case.full else 1,
    )
    found = errors(results[rows])
    case.study("two columns of nodes", results[rows], spacing, max(found.values()))
    print("     error at " + ", ".join(f"{t} s {e:.4%}" for t, e in found.items()))
case.target("error with 101 rows", max(errors(results[101]).values()), 0.01, "H5", asked=True)
case.target(
    "largest water error of all runs",
    max(abs(float(result.summary["water_error"])) for result in results.values()),
    1e-12,
    "fluxes are exchanged between nodes, so only round-off is lost",
)
order = np.argsort(results[101].nodes[:, 1])
side = order[results[101].nodes[order, 0] < 1e-9]
curves = {}
for i, time in enumerate((300, 1200, 3600, 7200)):
    psi = results[101].field("pore_pressure", time=float(time))[side] / 9810
    right = exact[:, 1 + TIMES.index(time)]
    curves[f"reference, {time // 60} min"] = (right, exact[:, 0], f"C{i}-")
    curves[f"TALUS, {time // 60} min"] = (psi[::5], results[101].nodes[side, 1][::5], f"C{i}o")
case.picture("Pressure head with 101 rows", "Pressure head [m]", "Height [m]", curves)
sys.exit(case.verdict())
