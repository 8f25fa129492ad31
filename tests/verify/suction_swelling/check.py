# SPDX-License-Identifier: MIT
"""H7: wetting under confinement with suction strain, in three steps; net stress and Bishop's.

A block that cannot strain is wetted from 100 kPa of suction to 60, 25 and -10 kPa (the last step ends
below the water table). With d(eps_s) = -ds/D_s each step raises the swelling pressure by 3 K ds/D_s,
where suction counts down to zero only. With D_s of Alonso et al. (1990) it is the logarithm of their law.
Bishop's stress has no suction strain: there the total stress changes by the change of chi s alone.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

YOUNG, POISSON, MODULUS, KAPPA, POROSITY = 6.0e6, 0.3, 8.0e6, 0.01, 0.4
BULK = YOUNG / (3 * (1 - 2 * POISSON))
AIR, WATER = 101325.0, 9810.0
FIRST, STEPS = 100.0e3, (60.0e3, 25.0e3, -10.0e3)
LAST = 10.0e3  # of the wetting with the law of Alonso et al.
LAW = "stress = 'net' suction_strain = 'constant' suction_modulus = 8.0e6"
ALONSO = f"stress = 'net' suction_strain = 'alonso' kappa_s = {KAPPA}"

case = Case(
    __file__.rsplit("/", 1)[0],
    id="H7",
    title="Wetting under confinement with suction strain",
    error="increment of swelling pressure, relative",
    reference="3 K ds/D_s; Alonso, Gens & Josa (1990) integrated; Bishop (1959)",
)


def run(name, law, suctions, element=False):
    """Wet to each suction in turn, a block or one element, of which all four nodes are held.

    Returns the run, and suction, saturation and stress of all nodes after each step.
    """
    text = ""
    for i, suction in enumerate(suctions):
        for where, height in (("bottom", 0.0), ("top", 1.0)):
            text += (
                f"&boundary where = '{where}' water = 'head' head = {height - suction / WATER!r} "
                f"stages = 's{i}' /\n"
            )
    for i in range(len(suctions)):
        text += f"&stage name = 's{i}' kind = 'storm' duration = 1e8 storm_step = 1e8 snapshots = 1 /\n"
    change = [(LAW, law), ("! check.py adds", text + "! check.py adds")]
    if element:
        change += [("spacing = 0.2", "spacing = 1.0"), ("levels = 2 length = 0.6", "levels = 1")]
    result = case.run("confined.nml", change, name=name)
    shots = [result.snapshots()[0]] + result.snapshots()[1::2]
    still = max(np.abs(result.field("displacement", s)).max() for s in shots)
    case.check(f"{name}: largest displacement [m]", still, 1e-12, "confined, and uniform")
    balance = np.abs(result.history()["water_error"]).max()
    case.check(f"{name}: water error", balance, 1e-12, "round-off")
    return (
        result,
        [-result.field("pore_pressure", s) for s in shots],
        [(result.field("saturation", s) - 0.1) / 0.9 for s in shots],
        [result.field("stress", s) for s in shots],
    )


def worst(stress, pressure):
    """Largest error of the increments of normal stress at any node, relative to the pressure; shear too."""
    found = 0.0
    for before, after, step in zip(stress[:-1], stress[1:], pressure):
        change = after - before
        change[:, :3] += step[:, None]
        found = max(found, np.max(np.abs(change)) / np.max(np.abs(step)))
    return found


def named(name, stress, limit, why):
    """3 K ds/D_s of the steps as the deck names them; returns the largest error."""
    errors = []
    for i in range(3):
        step = max((FIRST, *STEPS)[i], 0) - max(STEPS[i], 0)
        pressure = (stress[i] - stress[i + 1])[:, :3]
        expected = 3 * BULK * step / MODULUS
        errors.append(np.max(np.abs(pressure / expected - 1)))
        case.target(
            f"{name}, step {i + 1} of {step / 1e3:g} kPa: error of 3 K ds/D_s = {expected / 1e3:g} kPa",
            errors[-1],
            limit,
            why,
        )
    return max(errors)


shown = {}
result, suction, _, stress = run("constant", LAW, STEPS)
STEADY = "the pressure of the water is steady to 1e-12"
error = named("net stress, block at two levels", stress, 1e-11, STEADY)
case.study("constant D_s, block, 3 steps", result, 0.2, error)
result, suction, _, stress = run("element", LAW, STEPS, element=True)
error = named("net stress, one element", stress, 1e-13, "machine precision")
case.study("constant D_s, one element, 3 steps", result, 1.0, error)
shown["constant D_s"] = ([s.mean() / 1e3 for s in suction], [-t[:, 0].mean() / 1e3 for t in stress], "o")
whole = 3 * BULK * FIRST / MODULUS / 1e3
shown["3 K ds/D_s"] = ([100, 0, -10], [0, whole, whole], "k--")


def logarithm(a, b):
    """Swelling pressure of Alonso's law from suction a to b [Pa]."""
    return BULK * KAPPA * (1 - POROSITY) * np.log((a + AIR) / (b + AIR))


def midpoint(a, b):
    return BULK * KAPPA * (1 - POROSITY) * (a - b) / (0.5 * (a + b) + AIR)


errors = []
for steps in (3, 6, 12):
    path = tuple(FIRST - (FIRST - LAST) * (i + 1) / steps for i in range(steps))
    result, suction, _, stress = run(f"alonso_{steps}", ALONSO, path, element=True)
    case.target(
        f"Alonso's law in {steps} steps: largest error of D_s at the mean suction",
        worst(stress, [midpoint(a, b) for a, b in zip(suction[:-1], suction[1:])]),
        1e-13,
        "machine precision",
    )
    errors.append(abs(-stress[-1][:, 0].mean() / logarithm(FIRST, LAST) - 1))
    case.study(f"Alonso's law, one element, {steps} steps", result, 1.0, errors[-1])
case.target("Alonso's law, 12 steps: error of the whole swelling pressure", errors[-1], 1e-3, "second order")
case.check("Alonso's law: error at 12 over that at 6 steps", errors[2] / errors[1], 0.26, "second order")
shown["Alonso, 12 steps"] = (
    [s.mean() / 1e3 for s in suction],
    [-t[:, 0].mean() / 1e3 for t in stress],
    "s",
)
grid = np.linspace(LAST, FIRST, 50)
shown["its logarithm"] = (grid / 1e3, logarithm(FIRST, grid) / 1e3, "k:")

_, suction, saturation, stress = run("bishop", "stress = 'bishop'", STEPS, element=True)
carried = [np.where(s > 0, e, 1.0) * s for s, e in zip(suction, saturation)]
case.target(
    "Bishop's stress: largest error of the change of chi s, S_e from the results",
    worst(stress, [a - b for a, b in zip(carried[:-1], carried[1:])]),
    1e-13,
    "machine precision",
)
shown["Bishop's stress"] = (
    [s.mean() / 1e3 for s in suction],
    [-(t - stress[0])[:, 0].mean() / 1e3 for t in stress],
    "^-",
)
case.picture("Swelling pressure of a confined block", "Suction [kPa]", "Swelling pressure [kPa]", shown)
case.picture(
    "Alonso's law: error over number of steps",
    "Number of steps [-]",
    "Error of the swelling pressure [-]",
    {"TALUS": ((3, 6, 12), errors, "o-"), "order 2": ((3, 12), (errors[0], errors[0] / 16), "k:")},
    log_x=True,
    log_y=True,
)
sys.exit(case.verdict())
