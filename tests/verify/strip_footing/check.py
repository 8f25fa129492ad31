# SPDX-License-Identifier: MIT
"""M7, smooth strip footing on weightless clay, c = 1 + 2 z kPa: mean pressure 7.80 kPa at collapse.

Davis & Booker (1973), half width 1 m; undrained, phi = 0, so that the cone matched in plane strain is
Tresca's. Strength and stiffness follow depth by one layer of soil a row of nodes, with those of the middle of
its cells: a quarter of a spacing deep in the row at the surface. The footing presses on the cells of its
nodes, so its edge is put halfway between two nodes: h = 2 m/(2 n - 1) for n nodes in the half width. A
prescribed velocity drives it, and the reaction of the named boundary in the history is its load.

The limit load does not depend on stiffness, but a program of finite strains sees the footing sink. With
the stiffness of the benchmark, E = 299 + 498 z kPa, it sinks by centimetres before the load levels out,
and penetration goes on raising the load. The load of the theory, on soil in its first shape, is therefore
taken with soil 1000 times as stiff, at the same E/c-scaled settlement; with 100 times, and with E as given,
beside it. Load: mean of the last tenth. That the answer is quasi-static is shown by half the velocity.

What is left has two parts. The spacing makes the load too small, in proportion to h. The stabilisation makes
it too large: it resists the jump of the motion along the slip lines, and its force grows with the slip. With
0.002 in place of 0.05 the error halves with the spacing.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

EXACT, WIDTH, DEPTH = 7.80e3, 3.0, 1.5
SETTLEMENT, VELOCITY, STIFFER = 0.16, 4.0e-3, 1000.0
PLACE = "! check.py puts one layer of soil a row of nodes here.\n"

case = Case(
    __file__.rsplit("/", 1)[0],
    id="M7",
    title="Smooth strip footing, strength growing with depth",
    error="|mean pressure at collapse / 7.80 kPa - 1|",
    reference="Davis & Booker 1973",
)


def layers(rows, spacing, stiffer):
    """One soil a row of nodes, with the strength and stiffness of the middle of its cells."""
    text = ""
    for row in range(rows + 1):
        depth = max(row, 0.25) * spacing
        text += (
            f"&soil\n  name = 'row_{row}'\n"
            f"  from_y = {-(row + 0.5) * spacing}\n  to_y = {-(row - 0.5) * spacing}\n"
            "  density_solid = 2000.0\n  porosity = 0.0\n"
            f"  youngs_modulus = {stiffer * (299e3 + 498e3 * depth)}\n  poisson_ratio = 0.3\n"
            "  plasticity = 'drucker_prager'\n  friction_angle = 0.0\n"
            f"  cohesion = {1e3 + 2e3 * depth}\n/\n"
        )
    return text


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


def weak(stabilisation):
    return f"levels = 1\n  stabilisation = {stabilisation}"


SERIES = {"one level": ("levels = 1", (10, 20, 30))}
if case.full:
    SERIES |= {
        "one level, stabilisation 0.01": (weak(0.01), (10, 20, 30)),
        "one level, stabilisation 0.002": (weak(0.002), (10, 20)),
        "two levels, ell = 0.32 m": ("levels = 2\n  length = 0.32", (10, 20)),
    }
curves, rows, pressure = {}, [], {}


def tell(name, nodes, load):
    """A row of the table of pressures."""
    pressure[name, nodes] = last(load) / 1e3
    rows.append([name, nodes, f"{last(load) / 1e3:.3f}", f"{100 * (last(load) / EXACT - 1):+.2f} %"])


for name, (smoothing, counts) in SERIES.items():
    for nodes in counts if case.full else counts[:1]:
        result, settlement, load = press(nodes, smoothing=smoothing)
        error = abs(last(load) / EXACT - 1)
        case.study(name, result, 2.0 / (2 * nodes - 1), error)
        tell(name, nodes, load)
        if name == "one level" or nodes == 20:
            line = "-" if name == "one level" else ":"
            curves[f"{name}, {nodes} nodes"] = (100 * settlement, load / 1e3, line)
        if name == "one level" and nodes == (20 if case.full else 10):
            what = f"mean pressure, {nodes} nodes in the half width"
            case.target(what, error, 0.03, "required, M7", asked=True)
slow = press(10, slower=2.0)[2]
fast = pressure["one level", 10]
case.check("half the velocity, change of the load", abs(last(slow) / 1e3 / fast - 1), 0.002, "quasi-static")
if case.full:
    tell("one level, soil 100 times as stiff", 20, press(20, stiffer=100.0)[2])
    _, settlement, load = press(20, stiffer=1.0)
    tell("one level, E as given", 20, load)
    far = [100 * (np.interp(where, settlement, load) / EXACT - 1) for where in (0.04, 0.08, 0.16)]
    case.caution(
        f"The 3 % is met with soil {STIFFER:.0f} times as stiff, off by "
        f"{100 * (pressure['one level', 20] * 1e3 / EXACT - 1):+.2f} % at 20 nodes in the half width. With "
        "E = 299 + 498 z kPa, as the benchmark gives it, the pressure at these nodes is off by "
        f"{far[0]:+.0f}, {far[1]:+.0f} and {far[2]:+.0f} % when the footing has sunk by 4, 8 and 16 cm: it "
        "goes on rising."
    )
    least = [pressure["one level, stabilisation 0.002", nodes] for nodes in (10, 20)]
    ends = [2.0 / (2 * nodes - 1) for nodes in (10, 20)]
    limit = least[1] + (least[1] - least[0]) * ends[1] / (ends[0] - ends[1])
    case.target(
        "converged mean pressure, stabilisation 0.002, on the line through 10 and 20 nodes to h = 0 [kPa]",
        limit,
        7.80 * 1.01,
        "Davis & Booker 7.80 kPa, within 1 %",
        low=7.80 * 0.99,
    )
    case.table("Mean pressure at collapse", ["series", "nodes", "kPa", "over 7.80 kPa"], rows)
    case.note(
        "With the default stabilisation, 0.05, the load ends about 1 % above that with less of it, at each "
        "of the finer spacings: that is why its error does not fall. Soil 100 times as stiff has sunk by "
        "1.6 mm at the end, which is worth 1 % more. The velocity is worth nothing. With two levels the load "
        "is lower: the averages over ell = 0.32 m soften the edge of the footing and mix in the weak soil at "
        "the surface."
    )
    result, settlement, load = press(10, stiffer=1.0)
    sunk = [np.interp(where, settlement, load) / 1e3 for where in (0.04, 0.08, 0.16)]
    curves["E as given, 10 nodes"] = (100 * settlement, load / 1e3, "--")
    case.remedy(
        "finite strains: the limit load of the first shape, by stiffer soil",
        f"{sunk[0]:.2f}, {sunk[1]:.2f} and {sunk[2]:.2f} kPa when the footing has sunk by 4, 8 and 16 cm",
        f"{fast:.2f} kPa at the same nodes",
        sunk[2] > 1.2 * EXACT / 1e3,
    )
    curves["Davis & Booker"] = (100 * settlement[[0, -1]], [EXACT / 1e3] * 2, "k--")
    case.picture(
        "Load and settlement of the footing",
        "Settlement times the factor on stiffness [cm]",
        "Mean pressure [kPa]",
        curves,
    )
sys.exit(case.verdict())
