# SPDX-License-Identifier: MIT
"""A saturated column is loaded at once without drainage, then drained through its top.

The load is carried by the pore water but for the share S_s/(S_s + 1/M), and drains with
c_v = k/(gamma_w (1/M + S_s)). The soil is stiff, M = 100 MPa, as the theory is for small strains. The storm
step goes with the spacing squared. S_s = 1/M, and in one run M/100: water and soil take turns in each step
until they agree (src/THEORY.md section 5.6), so the compressibility of the water sets no limit.
"""

import sys

import h5py
import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

MODULUS, STORAGE, LOAD, CONDUCTIVITY, WATER = 1.0e8, 1.0e-8, 1.0e4, 1.0e-8, 9810.0

case = Case(
    __file__.rsplit("/", 1)[0],
    id="H4",
    title="consolidation of Terzaghi's column",
    error="largest error of the degree of consolidation, of pressure or settlement, over six times T_v",
    reference="the series of Terzaghi (1943), degree = 1 - sum 2 exp(-M^2 T_v)/M^2, M = (2 m + 1) pi/2",
)
c_v = CONDUCTIVITY / (WATER * (1 / MODULUS + STORAGE))
undrained = LOAD / (1 + STORAGE * MODULUS)
TIMES = (0.05, 0.1, 0.2, 0.4, 0.6, 0.9)


def degree(time):
    """Terzaghi's degree of consolidation at T_v."""
    m = (2 * np.arange(400) + 1) * np.pi / 2
    return 1 - np.sum(2 / m**2 * np.exp(-(m**2) * time))


def excess_of(result, group):
    """Pore pressure beyond that of still water [Pa]."""
    return group["pore_pressure"][:] - WATER * (1 - result.nodes[:, 1])


def softer(rows):
    """Error with a tenth of the stiffness, conductivity and storage to keep c_v."""
    spacing = 1 / (rows - 1)
    result = case.run(
        "column.nml",
        [
            ("width = 0.1", f"width = {spacing}"),
            ("9.0e7", "9.0e6"),
            ("conductivity_x = 1.0e-8", "conductivity_x = 1.0e-7"),
            ("specific_storage = 1.0e-8", "specific_storage = 1.0e-7"),
        ],
        name="softer",
    )
    found = drained(result, MODULUS / 10)
    return max(max(abs(row[1:] - degree(row[0]))) for row in found)


def text(value):
    return value.decode() if isinstance(value, bytes) else value


def stiff_water(rows):
    """Error with water a hundred times stiffer than the soil, and as many storm steps."""
    storage = STORAGE / 100
    end = 0.9 * WATER * (1 / MODULUS + storage) / CONDUCTIVITY
    spacing = 1 / (rows - 1)
    result = case.run(
        "column.nml",
        [
            ("width = 0.1", f"width = {spacing}"),
            ("spacing = 0.05", f"spacing = {spacing}"),
            ("specific_storage = 1.0e-8", f"specific_storage = {storage}"),
            ("duration = 17658.0", f"duration = {end:.17g}"),
            ("storm_step = 109.0", f"storm_step = {end / 162:.17g}"),
        ],
        name="stiff_water",
    )
    found = drained(result, storage=storage)
    case.check_true("stiff water: all times of the table were reached", len(found) == len(TIMES))
    return max(max(abs(row[1:] - degree(row[0]))) for row in found)


def drained(result, modulus=MODULUS, storage=STORAGE):
    """T_v, degree by pressure and degree by settlement at each time of the table."""
    top = result.nodes[:, 1] > 1 - 1e-6
    rows = []
    pace = CONDUCTIVITY / (WATER * (1 / MODULUS + storage))
    carried = 1 / (1 + storage * MODULUS)
    with h5py.File(result.path) as file:
        for name in result.snapshots():
            group = file["snapshots"][name]
            reached = pace * group.attrs["time"]
            if text(group.attrs["stage"]) != "drain" or not any(abs(reached - t) < 1e-6 for t in TIMES):
                continue
            mean = np.sum(excess_of(result, group) * result.area) / np.sum(result.area)
            settlement = -group["displacement"][:, 1][top].mean()
            rows.append(
                (reached, 1 - mean / (LOAD * carried), 1 - (1 - settlement * modulus / LOAD) / carried)
            )
    return np.array(rows)


def undrained_error(result):
    """Largest relative error of the pressure under the load, before any water has left."""
    with h5py.File(result.path) as file:
        groups = [file["snapshots"][name] for name in result.snapshots()]
        loaded = [g for g in groups if text(g.attrs["stage"]) == "load" and g.attrs["time"] > 0]
        return max(np.abs(excess_of(result, group) / undrained - 1).max() for group in loaded)


error, results = {}, {}
for rows in (11, 21, 41) if case.full else (21,):
    spacing = 1 / (rows - 1)
    step = 17658.0 / round(162 * (0.05 / spacing) ** 2 / 18) / 18
    result = results[rows] = case.run(
        "column.nml",
        [
            ("width = 0.1", f"width = {spacing}"),
            ("spacing = 0.05", f"spacing = {spacing}"),
            ("storm_step = 109.0", f"storm_step = {step}"),
        ],
        name=f"rows_{rows}",
    )
    found = drained(result)
    case.check_true(f"{rows} rows: all times of the table were reached", len(found) == len(TIMES))
    exact = np.array([degree(time) for time in found[:, 0]])
    by_pressure, by_settlement = np.abs(found[:, 1] - exact), np.abs(found[:, 2] - exact)
    error[rows] = max(by_pressure.max(), by_settlement.max())
    case.study("two columns of nodes", result, spacing, error[rows])
    print(f"     by pressure {by_pressure.max():.5f}, by settlement {by_settlement.max():.5f}")
    case.check(
        f"{rows} rows: undrained pressure",
        undrained_error(result),
        5e-4,
        "the weight strains the column by 0.01 to 0.02 % first",
    )
    left = float(result.summary["coupling_error"])
    case.check(f"{rows} rows: pressure left to later steps", left, 1e-2, "src/THEORY.md section 5.6")
if case.full:
    case.note(
        "With M = 10 MPa the load and the weight strain the column by 0.1 % each, and the error at 21 rows "
        f"is {softer(21):.2%}: Terzaghi's strains are infinitesimal, those of TALUS are not."
    )
    case.target("error of the degree, water 100 times stiffer than soil", stiff_water(21), 0.005, "our own")
finest = max(results)
case.target(f"error of the degree with {finest} rows", error[finest], 0.005, "H4", asked=True)
case.target(
    "largest water error of all runs",
    max(abs(float(result.summary["water_error"])) for result in results.values()),
    1e-12,
    "fluxes are exchanged between nodes, so only round-off is lost",
)
times = np.linspace(1e-4, 0.9, 200)
found = drained(results[finest])
case.picture(
    f"Degree of consolidation with {finest} rows",
    "Time factor T_v [-]",
    "Degree [-]",
    {
        "exact": (times, [degree(time) for time in times], "C7-"),
        "TALUS, by pressure": (found[:, 0], found[:, 1], "C0o"),
        "TALUS, by settlement": (found[:, 0], found[:, 2], "C1x"),
    },
    down=True,
)
sys.exit(case.verdict())
