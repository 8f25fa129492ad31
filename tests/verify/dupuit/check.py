# SPDX-License-Identifier: MIT
"""Flow through a rectangular dam with a seepage face, from the steady start.

q = k (h1^2 - h2^2)/(2 L) holds exactly however high the seepage face is (Charny 1951), for soil that is dry
above the water table. The capillary fringe of the soil here, 1/alpha, carries water too and is halved with
the spacing: Charny's sum of the flow over a vertical, with the fringe in it, gives k (h1 - h2)/(alpha L) more
at most. A day of transient flow from the start has the same flow in and out: the start is steady.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

EXACT = 0.5 * (5.0**2 - 1.0**2) / (2 * 10.0)  # m2/d

case = Case(
    __file__.rsplit("/", 1)[0],
    id="H6",
    title="Dupuit dam with a seepage face",
    error="relative error of the flow through the dam",
    reference="q = k (h1^2 - h2^2)/(2 L) = 0.600 m2/d, exact (Charny 1951)",
)


def run(name, spacing, alpha, more=""):
    """Run the dam, check that its start is steady, and return Result and relative error of the flow."""
    result = case.run(
        "dupuit.nml",
        [("spacing = 0.25", f"spacing = {spacing}{more}"), ("alpha = 100.0", f"alpha = {alpha}")],
        name=name,
    )
    history = result.history()
    inward, outward = history["water_in"][-1], history["water_out"][-1]
    print(f"     {name}: in {inward:.6f} m2/d, out {outward:.6f} m2/d")
    case.check(f"in over out less one, {name}", abs(inward / outward - 1), 1e-6, "steady")
    names = result.snapshots()
    drift = np.max(np.abs(result.field("pore_pressure", names[-1]) - result.field("pore_pressure", names[0])))
    case.check(f"drift of the pressure in a day, {name} [Pa]", drift, 1e-2, "1 um of head")
    if spacing < 0.3:
        right = np.abs(result.nodes[:, 0] - 10) < 1e-9
        top = np.max(result.nodes[right & (result.field("pore_pressure") > -1e-3), 1])
        case.check_true(f"the seepage face ends between the reservoirs, {name}: {top} m", 1.25 <= top <= 4.0)
    return result, abs(inward / EXACT - 1)


def water_table(result):
    """Height of zero pressure over x, on columns of a regular grid."""
    pressure = result.field("pore_pressure")
    columns = np.unique(np.round(result.nodes[:, 0], 6))
    heights = []
    for x in columns:
        column = np.flatnonzero(np.abs(result.nodes[:, 0] - x) < 1e-5)
        column = column[np.argsort(result.nodes[column, 1])]
        heights.append(np.interp(0.0, -pressure[column], result.nodes[column, 1]))
    return columns, np.array(heights)


water = []
for series, more, quick in (
    ("grid", "", 0.25),
    ("nodes perturbed by 30 %", " perturbation = 0.3", 0.5),
):
    for spacing in (1.0, 0.5, 0.25) if case.full else (quick,):
        result, error = run(f"{series.split()[0]}_{spacing}", spacing, 25 / spacing, more)
        case.study(series, result, spacing, error)
        water.append(abs(float(result.summary["water_error"])))
        if series == "grid":
            table = water_table(result)
    case.target(f"error of the flow, {series}, spacing {spacing} m", error, 0.01, "the accuracy asked for")
if case.full:
    fringe = spacing / 25
    case.note(
        f"The fringe of {fringe * 100:g} cm may carry up to {0.5 * 4 * fringe / 10 / EXACT:.2%} of the flow, "
        "which the formula leaves out: most of the error on the grid."
    )
case.target(
    "largest water error of all runs",
    max(water),
    1e-12,
    "fluxes are exchanged between nodes, so only round-off is lost",
)
x = np.linspace(0, 10, 101)
case.picture(
    "Water table with the finest spacing on the grid",
    "Distance from the upper reservoir [m]",
    "Height [m]",
    {
        "Dupuit's parabola, without seepage face": (x, np.sqrt(25 - 2.4 * x), "C7--"),
        "TALUS, pressure zero": (*table, "C0o-"),
    },
)
sys.exit(case.verdict())
