# SPDX-License-Identifier: MIT
"""Energy over a dynamic stage: a soft block, 4 m high, gives way under its own weight.

Plastic flow, softening, damage and large rotation at once, with nodes off their grid; the crest falls
by more than a metre. Limit 1e-3 of the largest energy that changed hands, at every history line,
at one level and at two, with the lumped and with the consistent mass.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="energy",
    title="energy balance of a soft block that collapses",
    error="missing energy over the largest that changed hands, at any time",
    reference="conservation of energy",
)
TWO = "levels = 2\n  length = 0.8"
SPACINGS = (0.5, 0.36, 0.25, 0.18, 0.13) if case.full else (0.25,)
REAL = "kind = 'dynamic'"
SERIES = {
    "two levels": [],
    "one level": [(TWO, "levels = 1")],
    "consistent mass": [(REAL, f"{REAL}\n  mass = 'consistent'")],
}
runs = [(n, changes, h) for n, changes in SERIES.items() for h in SPACINGS]
# The second level needs a length of three spacings at least.
for name, changes, spacing in [r for r in runs if r[0] == "one level" or r[2] < 0.27]:
    result = case.run(
        "drop.nml",
        [*changes, ("spacing = 0.25", f"spacing = {spacing}")],
        name=f"{name.replace(' ', '_')}_{spacing}",
    )
    history = result.history()
    error = np.abs(history["energy_error"]).max()
    case.study(name, result, spacing, error)
    if spacing == 0.25:
        what = f"energy error, {name}, spacing {spacing} m"
        case.target(what, error, 1e-3, "the accuracy asked for", asked=True)
        case.picture(
            f"Energies, {name}",
            "Time [s]",
            "Energy [kJ/m]",
            {
                words: (history["time"], history[f"energy_{column}"] / 1e3, style)
                for words, column, style in (
                    ("work of gravity", "external", "C7-"),
                    ("kinetic", "kinetic", "C0-"),
                    ("plastic", "plastic", "C1-"),
                    ("strain", "strain", "C2-"),
                    ("damage", "damage", "C3-"),
                    ("stabilisation", "stabilisation", "C4--"),
                )
            },
        )
    case.check(
        f"{name}: the summary's", float(result.summary["energy_error"]), 1e-3, "the accuracy asked for"
    )
    case.check_true(f"{name}: falls by more than a metre", history["maximum_displacement"][-1] > 1.0)
    case.check_true(
        f"{name}: plastic work and damage take part",
        history["energy_plastic"][-1] > 0.05 * history["energy_external"][-1]
        and history["energy_damage"][-1] > 0,
    )
sys.exit(case.verdict())
