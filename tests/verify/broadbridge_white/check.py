# SPDX-License-Identifier: MIT
"""Constant rain on a dry, deep column, in the scaling that the deck explains.

exact.py evaluates the exact solution, and broadbridge_white.csv holds its published values, against which
both are checked. No water may be lost: what is stored grows by the rain.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from exact import exact_theta  # noqa: E402  (beside this file)
from talus_case import Case  # noqa: E402

LENGTH, TIME, DEPTH = 0.1, 4000.0, 12.5
TIMES = (0.5, 2, 8)

case = Case(
    __file__.rsplit("/", 1)[0],
    id="H1",
    title="constant rain on a dry column, Broadbridge & White (1988)",
    error="relative L2 of Theta over the nodes down to a depth of 10, the worst of t = 0.5, 2 and 8",
    reference="exact.py: the exact solution of Broadbridge & White (1988), Water Resources Research 24",
)
table = np.loadtxt(case.folder / "broadbridge_white.csv", delimiter=",", skiprows=2)
case.check(
    "exact.py against the published table",
    max(abs(exact_theta(time, depth) - theta) for time, depth, theta in table),
    6e-5,
    "the table has four digits",
)


def profile(result, time):
    """Depths and Theta of the left column of nodes."""
    column = np.flatnonzero(result.nodes[:, 0] < 1e-9)
    column = column[np.argsort(-result.nodes[column, 1])]
    theta = result.field("saturation", time=time * TIME)[column]
    return DEPTH - result.nodes[column, 1] / LENGTH, theta


def error_of(result, time):
    """Relative L2 error at a time."""
    depth, theta = profile(result, time)
    compared = depth < 10 + 1e-9
    right = exact_theta(time, depth[compared])
    return np.linalg.norm(theta[compared] - right) / np.linalg.norm(right)


error, results = {}, {}
for rows in (51, 101, 201, 401) if case.full else (101,):
    spacing = 1 / (rows - 1)
    result = results[rows] = case.run(
        "broadbridge_white.nml",
        [("width = 0.02", f"width = {spacing}"), ("spacing = 0.01", f"spacing = {spacing}")],
        name=f"rows_{rows}",
        repeat=3 if case.full else 1,
    )
    found = [error_of(result, time) for time in TIMES]
    error[rows] = max(found)
    case.study("two columns of nodes", result, spacing, error[rows])
    print("     error at " + ", ".join(f"t = {t}: {e:.3%}" for t, e in zip(TIMES, found)))
for time in TIMES:
    depth, theta = profile(results[101], time)
    case.check(
        f"largest error of Theta at t = {time}",
        max(abs(np.interp(d, depth, theta) - right) for t, d, right in table if t == time),
        0.02,
        "100 nodes over a depth of 10",
    )
    case.check(
        f"rise of Theta with depth at t = {time}",
        np.max(np.diff(theta)),
        1e-10,
        "the front is monotone to the tolerance of the implicit steps",
    )
results["explicit"] = case.run(
    "broadbridge_white.nml", [("snapshots = 16", "snapshots = 16 water_step = 'explicit'")], name="explicit"
)
for time in TIMES:
    case.check(
        f"explicit steps alone: error of Theta at t = {time}",
        error_of(results["explicit"], time),
        1.5e-3,
        "that of the spacing, as with implicit steps",
    )
start = None
for time in TIMES:
    area = results[101].area
    stored = np.sum(results[101].field("saturation", time=time * TIME) * area) / np.sum(area) * DEPTH
    # What was there before the rain, by the first of the times.
    start = stored - 0.5 * time if start is None else start
    case.check(
        f"water that is not 0.5 t at t = {time}", abs(stored - 0.5 * time - start), 1e-6, "no water is lost"
    )
if case.full:
    case.target("error on the finest nodes, 40 to a unit", error[401], 0.005, "H1", asked=True)
    case.note(
        "The error flattens at 2.7e-4, since the exact solution starts from Theta = 0, at no finite suction, "
        "and the deck from 100 MPa, where Theta is 2e-5: from 1000 MPa it is 8e-5 with 401 rows, at 40 times "
        "the cost. It is largest at t = 0.5; at t = 8 it is 4e-5."
    )
case.target(
    "largest water error of all runs",
    max(abs(float(result.summary["water_error"])) for result in results.values()),
    1e-12,
    "fluxes are exchanged between nodes, so only round-off is lost",
)
curves = {}
for i, time in enumerate(TIMES):
    depth, theta = profile(results[101], time)
    compared = depth < 10
    curves[f"exact, t = {time}"] = (exact_theta(time, depth[compared]), depth[compared], f"C{i}-")
    curves[f"TALUS, t = {time}"] = (theta[compared][::4], depth[compared][::4], f"C{i}o")
case.picture("Saturation with 10 nodes to a unit of depth", "Theta [-]", "Depth [-]", curves, down=True)
sys.exit(case.verdict())
