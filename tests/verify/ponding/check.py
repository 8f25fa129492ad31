# SPDX-License-Identifier: MIT
"""Rain that starts, ponds, runs off, stops and comes back: no water is lost, the front is monotone,
and no node passes the pressure at which rain ponds."""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(__file__.rsplit("/", 1)[0])
for deck, catch in (("column.nml", 0.02), ("slope.nml", 7.0)):
    result = case.run(deck)
    history = result.history()
    fallen = 0.09 * catch
    print(
        f"     {deck}: in {history['water_in'][-1]:.6g}, run-off "
        f"{history['water_runoff'][-1]:.6g} m2, {result.summary['seepage_steps']} sub-steps, "
        f"{result.summary['wall_seconds_seepage']} s in seepage"
    )
    case.check(
        f"{deck}: water error",
        np.max(np.abs(history["water_error"])),
        1e-12,
        "fluxes are exchanged; round-off",
    )
    case.check_true(f"{deck}: water runs off", history["water_runoff"][-1] > 0.01 * fallen)
    case.check_true(
        f"{deck}: run-off and inflow only grow",
        np.all(np.diff(history["water_runoff"]) >= 0) and np.all(np.diff(history["water_in"]) >= 0),
    )
    case.check(
        f"{deck}: rain that neither entered nor ran off, over the rain",
        abs(history["water_in"][-1] + history["water_runoff"][-1] - fallen) / fallen,
        1e-10,
        "every millimetre is counted once",
    )
    top = result.nodes[:, 1] > np.max(result.nodes[:, 1]) - 1e-9
    highest = max(np.max(result.field("pore_pressure", name)[top]) for name in result.snapshots())
    case.check(f"{deck}: largest pressure at the level top [Pa]", highest, 1e-3, "rain ponds at zero")
    case.check_true(f"{deck}: the top ponds", highest > -1e-3)
    for name in result.snapshots():
        saturation = result.field("saturation", name)
        case.failures += not np.all((saturation > 0.18) & (saturation <= 1 + 1e-12))
column = case.run("column.nml", name="front")
order = np.argsort(-column.nodes[:, 1], kind="stable")
side = column.nodes[order, 0] < 1e-9
rise = max(
    np.max(np.diff(column.field("saturation", time=t)[order][side][:40]))
    for t in np.arange(600.0, 3601.0, 600.0)
)
case.check("column: rise of saturation with depth in the first burst", rise, 1e-9, "the front is monotone")
sys.exit(case.verdict())
