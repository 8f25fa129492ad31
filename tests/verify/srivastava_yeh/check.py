# SPDX-License-Identifier: MIT
"""Infiltration above a water table: steady under 0.1 cm/h, then 0.9 cm/h of rain for 20 hours.

srivastava_yeh.csv holds the exact series, pressure head in cm at every centimetre; between these it is
interpolated by cubics, whose error is about 1e-6 of it. Run on a regular grid, and on perturbed
nodes in two dimensions, where the exact solution still has one. published.csv holds errors and times of
other programs.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="H2",
    title="transient infiltration of Srivastava & Yeh (1991), Gardner soil",
    error="relative L2 of the pressure head at 10 h over all nodes",
    reference="srivastava_yeh.csv: the exact series of Srivastava & Yeh (1991), Water Resources Research 27",
)
exact = np.loadtxt(case.folder / "srivastava_yeh.csv", delimiter=",")
HOURS = {0: 1, 1: 2, 3: 3, 5: 4, 10: 5, 20: 6}


def cubic(x, y, at):
    """Values at points between evenly spaced x by cubics through four of them."""
    first = np.clip(np.searchsorted(x, at) - 2, 0, len(x) - 4)
    t = (at - x[first]) / (x[1] - x[0])
    weights = [
        -(t - 1) * (t - 2) * (t - 3) / 6,
        t * (t - 2) * (t - 3) / 2,
        -t * (t - 1) * (t - 3) / 2,
        t * (t - 1) * (t - 2) / 6,
    ]
    return sum(weight * y[first + i] for i, weight in enumerate(weights))


def errors(result):
    """Relative L2 error of the pressure head at each time."""
    found = {}
    for hours, k in HOURS.items():
        psi = result.field("pore_pressure", time=3600.0 * hours) / 9810.0
        right = cubic(exact[:, 0], exact[:, k], result.nodes[:, 1] * 100) / 100
        found[hours] = np.linalg.norm(psi - right) / np.linalg.norm(right)
    print(
        "     relative L2 of psi: "
        + ", ".join(f"{h} h {e:.3%}" for h, e in found.items())
        + f"; {result.summary['seepage_steps']} sub-steps"
    )
    return found


error, results = {}, {}
for rows in (26, 51, 101, 201, 401) if case.full else (51, 101):
    spacing = 1 / (rows - 1)
    results[rows] = case.run(
        "srivastava_yeh.nml",
        [("width = 0.02", f"width = {spacing}"), ("spacing = 0.01", f"spacing = {spacing}")],
        name=f"rows_{rows}",
        repeat=3 if case.full else 1,
    )
    error[rows] = errors(results[rows])
    case.study("two columns of nodes", results[rows], spacing, error[rows][10])
results["explicit"] = case.run(
    "srivastava_yeh.nml",
    [
        ("spacing = 0.01", "spacing = 0.02"),
        ("snapshots = 20", "snapshots = 20 water_step = 'explicit'"),
    ],
    name="explicit",
)
case.check(
    "explicit steps alone, 51 rows: error at any time",
    max(errors(results["explicit"]).values()),
    1.5e-3,
    "0.0011 with implicit steps: that of the spacing",
)
case.check("error at 10 h with 101 rows", error[101][10], 0.005, "the accuracy asked for")
case.check("error of the steady start, 101 rows", error[101][0], 0.005, "the same fluxes without storage")
case.check(
    "error at 0 h over that of twice the spacing",
    error[101][0] / error[51][0],
    0.3,
    "second order, 0.25, with a margin for higher terms",
)
if case.full:
    case.target(
        "error at 10 h with 201 rows", error[201][10], 0.001, "OpenGeoSys 6.5.9 has 0.00041", asked=True
    )
    case.compare_time(results[201], error[201][10], "OpenGeoSys 6.5.9", "201 rows")
    case.compare_time(results[201], error[201][10], "finite-volume script")
    case.note(
        "Below 1e-4 the error is that of the sub-steps in time, which change the water content of the "
        "fastest cell by 0.01 whatever the spacing; the steady start, without time, keeps order 2."
    )
for rows in (26, 51, 101) if case.full else (51,):
    spacing = 1 / (rows - 1)
    result = results[f"perturbed {rows}"] = case.run(
        "srivastava_yeh.nml",
        [("width = 0.02", "width = 0.2"), ("spacing = 0.01", f"spacing = {spacing} perturbation = 0.3")],
        name=f"perturbed_{rows}",
    )
    uneven = errors(result)
    case.study("0.2 m wide, nodes perturbed by 30 %", result, spacing, uneven[10])
    if rows == 51:
        case.check("error at 10 h on perturbed nodes", uneven[10], 0.005, "the same limit as on a grid")
case.target(
    "largest water error of all runs",
    max(abs(float(result.summary["water_error"])) for result in results.values()),
    1e-12,
    "fluxes are exchanged between nodes, so only round-off is lost",
)
finest = results[201] if case.full else results[101]
order = np.argsort(finest.nodes[:, 1])
side = order[finest.nodes[order, 0] < 1e-9]
curves = {}
for i, hours in enumerate((0, 1, 3, 5, 20)):
    psi = finest.field("pore_pressure", time=3600.0 * hours)[side] / 9810
    curves[f"exact, {hours} h"] = (exact[:, HOURS[hours]] / 100, exact[:, 0] / 100, f"C{i}-")
    curves[f"TALUS, {hours} h"] = (psi[::10], finest.nodes[side, 1][::10], f"C{i}o")
case.picture("Pressure head with 201 rows", "Pressure head [m]", "Height above the water table [m]", curves)
sys.exit(case.verdict())
