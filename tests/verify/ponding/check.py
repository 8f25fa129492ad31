# SPDX-License-Identifier: MIT
"""Rain that starts, ponds, runs off, stops and comes back: no water is lost, the front is monotone,
and no node passes the pressure at which rain ponds."""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="ponding",
    title="two bursts of rain that pond, run off and drain",
    error="water that is neither in the soil nor gone, over what moved",
    reference="conservation of water; rain ponds at zero pressure",
)
worst = {}
for deck, catch, spacing in (("column.nml", 0.02, 0.02), ("slope.nml", 7.0, 0.2)):
    result = case.run(deck)
    history = result.history()
    fallen = 0.09 * catch
    print(
        f"     {deck}: in {history['water_in'][-1]:.6g}, run-off "
        f"{history['water_runoff'][-1]:.6g} m2, {result.summary['seepage_steps']} sub-steps, "
        f"{result.summary['wall_seconds_seepage']} s in seepage"
    )
    worst[deck] = np.max(np.abs(history["water_error"]))
    case.study(deck.removesuffix(".nml"), result, spacing, worst[deck])
    hours = history["time"] / 3600
    case.picture(
        f"Water in and off the {deck.removesuffix('.nml')}",
        "Time [h]",
        "Water, summed up [m²]",
        {
            "rain": (hours, history["water_in"] + history["water_runoff"], "C7-"),
            "into the soil": (hours, history["water_in"], "C0-"),
            "run-off": (hours, history["water_runoff"], "C1-"),
            "out through the seepage face": (hours, history["water_out"], "C2--"),
        },
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
for deck, error in worst.items():
    case.target(
        f"water error at any time, {deck.removesuffix('.nml')}",
        error,
        1e-12,
        "fluxes are exchanged between nodes, so only round-off is lost",
    )
sys.exit(case.verdict())
