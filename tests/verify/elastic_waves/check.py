# SPDX-License-Identifier: MIT
"""M5, elastic P-wave in a bar, and the free vibration of a free square.

Pulse: surface tractions hold a bar in the shape u0 = A cos^4, of 3 m length; let go, it splits into two
pulses that run apart, u = (u0(x - c t) + u0(x + c t))/2 (d'Alembert). Relative L2 error of displacement
after 0.02 s, when they have parted; order >= 1.9 in the spacing, and with it in the time step. At two
levels ell shrinks with the spacing: a length of its own delays short waves.
Step: the left end moves at constant velocity from the start, u = V (t - x/c) behind the front. Arrival at
5 m is where the line through the displacement behind the front meets zero, within 0.5 % of x/c.
Square: the three lowest elastic omega^2 by `talus check --spectrum` against those of a fine mesh of
nine-node finite elements with consistent mass (tests/unit/test_talus_spectrum.pf): within 5 % at 21 x 21
nodes at one level, 10 % with ell = 3 h, where smoothing is physical. The seconds of these rows are those
of one second of vibration.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

SPEED, MODULUS = 100.0, 1.2e7
HEIGHT, LENGTH, MIDDLE = 1.0e-5, 3.0, 5.0
VELOCITY, PROBE = 1.0e-3, 5.0
SQUARE = np.array([5.9588, 7.2179, 7.2179])
PLACE = "! check.py puts here what starts the wave.\n"
STAGE = "name = 'run'\n  kind = 'dynamic'\n  duration = 0.02"


def pulse(x):
    return HEIGHT * np.cos(np.pi * np.clip((x - MIDDLE) / LENGTH, -0.5, 0.5)) ** 4


def slope(x):
    angle = np.pi * np.clip((x - MIDDLE) / LENGTH, -0.5, 0.5)
    return -4 * HEIGHT * np.pi / LENGTH * np.cos(angle) ** 3 * np.sin(angle)


def bend(spacing):
    """Groups that hold the bar in the shape of the pulse: mean tractions of each edge, top and bottom."""
    groups = ["&boundary\n  where = 'left'\n  stages = 'bend'\n  displacement = 'roller_x'\n/\n"]
    ends = np.linspace(0.0, 10.0, round(10.0 / spacing) + 1)
    for low, high in zip(ends[:-1], ends[1:]):
        traction = -MODULUS * (slope(high) - slope(low)) / (high - low) * spacing / 2
        for y in (0.0, spacing) if traction != 0.0 else ():
            groups.append(
                f"&boundary\n  where = 'box'\n  stages = 'bend'\n  from_x = {low}\n  to_x = {high}\n"
                f"  from_y = {y - spacing / 4}\n  to_y = {y + spacing / 4}\n  traction_x = {traction}\n/\n"
            )
    groups.append(
        "&stage\n  name = 'bend'\n  kind = 'geostatic'\n  tolerance = 1.0e-9\n  steps_max = 200000\n"
        "  reset_displacement = .false.\n/\n"
    )
    return "".join(groups)


case = Case(
    __file__.rsplit("/", 1)[0],
    id="M5",
    title="Elastic P-wave in a bar; frequencies of a free square",
    error="pulse: relative L2 error of displacement; step: relative error of the arrival; square: largest "
    "relative error of the three lowest omega^2",
    reference="d'Alembert, exact; omega^2 = 5.9588, 7.2179, 7.2179 of a fine mesh",
)


def bar(spacing, ratio, change):
    levels = "levels = 1" if ratio == 0 else f"levels = 2\n  length = {ratio * spacing}"
    return case.run(
        "bar.nml",
        [
            ("height = 0.1", f"height = {spacing}"),
            ("spacing = 0.1", f"spacing = {spacing}"),
            ("levels = 1", levels),
            *change,
        ],
    )


def axis(result, name):
    """A field along the bottom row, by x."""
    row = result.nodes[:, 1] < 1e-9
    order = np.argsort(result.nodes[row, 0])
    return result.nodes[row, 0][order], result.field(name)[row, 0][order]


curves = {}
LEVELS = {"one level": 0, "two levels, ell = 3 h": 3}
for name, ratio in LEVELS.items():
    found = []
    for spacing in (0.1, 0.05, 0.025) if case.full else (0.1, 0.05):
        result = bar(spacing, ratio, [(PLACE, bend(spacing))])
        time = result.history()["time"][-1]
        x, moved = axis(result, "displacement")
        exact = 0.5 * (pulse(x - SPEED * time) + pulse(x + SPEED * time))
        found.append(np.linalg.norm(moved - exact) / np.linalg.norm(exact))
        case.study(f"pulse, {name}", result, spacing, found[-1])
        if ratio == 0:
            curves[f"pulse, h = {spacing:g} m"] = (x, moved * 1e6)
    found = np.array(found)
    order = np.log2(found[:-1] / found[1:])
    if ratio == 0:
        curves["exact"] = (x, exact * 1e6, "k--")
        case.target("pulse, one level, order", order.min(), 3.0, "second order in space and time", low=1.9)
        case.target("pulse, one level, error at the finest spacing", found[-1], 0.01, "analytic, M5")
    else:
        case.check(f"pulse, {name}, 1.5 less the order", 1.5 - order.min(), 0.0, "converges with ell")

for name, ratio in LEVELS.items():
    for spacing in (0.1, 0.05, 0.025) if case.full else (0.05,):
        drive = f"&boundary\n  where = 'left'\n  velocity_x = {VELOCITY}\n/\n"
        probe = f"&output\n  history_interval = 0.0005\n  probe_x = {PROBE}\n  probe_y = 0.0\n/\n"
        result = bar(spacing, ratio, [(PLACE, drive + probe), (STAGE, STAGE.replace("0.02", "0.09"))])
        history = result.history()
        time, moved = history["time"], history["probe_1_displacement_x"]
        behind = time > 1.2 * PROBE / SPEED
        rate, start = np.polyfit(time[behind], moved[behind], 1)
        error = abs(-start / rate / (PROBE / SPEED) - 1)
        case.study(f"step, {name}", result, spacing, error)
        case.check(
            f"step, {name}, h = {spacing} m, velocity behind the front",
            abs(rate / VELOCITY - 1),
            0.02,
            "V, but for the ringing behind a jump",
        )
        if spacing == 0.05:
            what = f"step, {name}, arrival at 5 m, h = 0.05 m"
            case.target(what, error, 0.005, "analytic, required, M5", asked=True)

for name, ratio in LEVELS.items():
    for spacing in (0.1, 0.05, 1 / 30) if case.full else (0.05,):
        levels = "levels = 1" if ratio == 0 else f"levels = 2\n  length = {ratio * spacing}"
        change = [("spacing = 0.05", f"spacing = {spacing}"), ("levels = 1", levels)]
        square = case.spectrum("square.nml", change)[1]
        scale = square[-1]
        case.check_true(
            f"square, {name}, h = {spacing:.3g} m: three rigid modes and no more",
            np.abs(square[:3]).max() < 1e-9 * scale and square[3] > 1e-4 * scale,
        )
        error = np.abs(square[3:6] / SQUARE - 1).max()
        case.study(f"square, {name}", case.run("square.nml", change), spacing, error)
        if spacing == 0.05:
            limit = 0.05 if ratio == 0 else 0.10
            what = f"square, {name}, three lowest omega^2"
            case.target(what, error, limit, "required, 21 x 21 nodes", asked=True)

case.picture("Pulses after 0.02 s", "x [m]", "Displacement [µm]", curves)
sys.exit(case.verdict())
