# SPDX-License-Identifier: MIT
"""M7, smooth strip footing on weightless clay, c = 1 + 2 z kPa: mean pressure 7.80 kPa at collapse.

Davis & Booker (1973), half width 1 m; undrained, phi = 0, so that the cone matched in plane strain is
Tresca's. Strength and stiffness follow depth by one layer of soil a row of nodes, which is exact for
nodal integration: a node has one soil. The footing presses on the cells of its nodes, so its edge is put
halfway between two nodes: h = 2 m/(2 n - 1) for n nodes in the half width. A prescribed velocity drives
it, and the reaction of the named boundary in the history is its load.

The limit load does not depend on stiffness, but a program of finite strains sees the footing sink. With
the stiffness of the benchmark, E = 299 + 498 z kPa, it sinks by centimetres before the load levels out,
and penetration goes on raising the load. The load of the theory, on soil in its first shape, is therefore
taken with soil 100 times as stiff, at the same E/c-scaled settlement; the run with E as given is beside
it. Load: mean of the last tenth. That the answer is quasi-static is shown by half the velocity.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

EXACT, WIDTH, DEPTH = 7.80e3, 3.0, 1.5
SETTLEMENT, VELOCITY, STIFFER = 0.16, 4.0e-3, 100.0
PLACE = "! check.py puts one layer of soil a row of nodes here.\n"

case = Case(
    __file__.rsplit("/", 1)[0],
    id="M7",
    title="Smooth strip footing, strength growing with depth",
    error="|mean pressure at collapse / 7.80 kPa - 1|",
    reference="Davis & Booker 1973",
)


def layers(rows, spacing, stiffer):
    """One soil a row of nodes, with the strength and stiffness of its depth."""
    return "".join(
        f"&soil\n  name = 'row_{row}'\n"
        f"  from_y = {-(row + 0.5) * spacing}\n  to_y = {-(row - 0.5) * spacing}\n"
        "  density_solid = 2000.0\n  porosity = 0.0\n"
        f"  youngs_modulus = {stiffer * (299e3 + 498e3 * row * spacing)}\n  poisson_ratio = 0.3\n"
        "  plasticity = 'drucker_prager'\n  friction_angle = 0.0\n"
        f"  cohesion = {1e3 + 2e3 * row * spacing}\n/\n"
        for row in range(rows + 1)
    )


def press(nodes, stiffer=STIFFER, slower=1.0, smoothing="levels = 1"):
    """Result, settlement times the factor on stiffness, and mean pressure under the footing."""
    spacing = 2.0 / (2 * nodes - 1)
    columns, rows = round(WIDTH / spacing), round(DEPTH / spacing)
    # The pressure of a wave that stops the footing, density times wave speed times velocity, stays.
    velocity = VELOCITY / np.sqrt(stiffer) / slower
    duration = SETTLEMENT / stiffer / velocity
    result = case.run(
        "footing.nml",
        [
            ("width = 4.0", f"width = {columns * spacing}"),
            ("height = 2.0", f"height = {rows * spacing}"),
            ("origin_y = -2.0", f"origin_y = {-rows * spacing}"),
            ("spacing = 0.1", f"spacing = {spacing}"),
            ("levels = 1", smoothing),
            (PLACE, layers(rows, spacing, stiffer)),
            ("velocity_y = -4.0e-3", f"velocity_y = {-velocity}"),
            ("duration = 40.0", f"duration = {duration}"),
            ("history_interval = 0.5", f"history_interval = {duration / 80}"),
        ],
    )
    history = result.history()
    # Half a footing, 1 m wide: its reaction is the mean pressure.
    return result, history["time"] * velocity * stiffer, -history["reaction_footing_y"]


def last(load):
    return load[-len(load) // 10 :].mean()


curves = {}
for nodes in (10, 20, 30) if case.full else (10,):
    result, settlement, load = press(nodes)
    error = abs(last(load) / EXACT - 1)
    case.study("one level", result, 2.0 / (2 * nodes - 1), error)
    curves[f"{nodes} nodes in the half width"] = (100 * settlement, load / 1e3)
    if nodes == (20 if case.full else 10):
        case.target(f"mean pressure, {nodes} nodes in the half width", error, 0.03, "required, M7")
    if nodes == 10:
        slow = press(10, slower=2.0)[2]
        case.check(
            "half the velocity, change of the load", abs(last(slow) / last(load) - 1), 0.002, "quasi-static"
        )
if case.full:
    others = {
        "one level, stabilisation 0.01": "levels = 1\n  stabilisation = 0.01",
        "two levels, ell = 0.32 m": "levels = 2\n  length = 0.32",
    }
    for name, smoothing in others.items():
        for nodes in (10, 20):
            result, settlement, load = press(nodes, smoothing=smoothing)
            case.study(name, result, 2.0 / (2 * nodes - 1), abs(last(load) / EXACT - 1))
            curves[f"{name}, {nodes} nodes"] = (100 * settlement, load / 1e3, ":")
    case.note(
        "With the default stabilisation, 0.05, the load is one to two per cent above that with 0.01. With "
        "two levels it is lower: the averages over ell = 0.32 m soften the edge of the footing and mix in "
        "the weak soil at the surface."
    )
    result, settlement, load = press(10, stiffer=1.0)
    sunk = [np.interp(where, settlement, load) / 1e3 for where in (0.04, 0.08, 0.16)]
    curves["E as given, 10 nodes"] = (100 * settlement, load / 1e3, "--")
    case.remedy(
        "finite strains: the limit load of the first shape, by stiffer soil",
        f"{sunk[0]:.2f}, {sunk[1]:.2f} and {sunk[2]:.2f} kPa when the footing has sunk by 4, 8 and 16 cm",
        f"{curves['10 nodes in the half width'][1][-1]:.2f} kPa at the same nodes",
        sunk[2] > 1.2 * EXACT / 1e3,
    )
    curves["Davis & Booker"] = (100 * settlement[[0, -1]], [EXACT / 1e3] * 2, "k--")
    case.picture(
        "Load and settlement of the footing",
        "settlement in cm, times the factor on stiffness",
        "mean pressure in kPa",
        curves,
    )
sys.exit(case.verdict())
