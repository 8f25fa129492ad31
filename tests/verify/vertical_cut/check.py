# SPDX-License-Identifier: MIT
"""The sample deck input/vertical_cut: shored it stands, opened it falls; with 25 kPa it stays.

A vertical cut stands up to 3.83 c/(rho g) (Taylor, upper bound for phi = 0; 5 degrees add 9 %): 3.4 m
with 15 kPa, 5.6 m with 25 kPa, and this one is 4 m high. Energy error of the fall <= 1e-3.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    pathlib.Path(__file__).resolve().parents[3] / "input" / "vertical_cut",
    id="vertical cut",
    title="the sample vertical cut falls when it is opened, and stands with more cohesion",
    error="relative energy error of the fall",
    reference="Taylor's upper bound of the height, 3.83 c/(rho g), 9 % more for 5 degrees of friction",
    quantity="energy error",
    order=False,
)
weak = case.run("case.nml", name="weak")
case.study("15 kPa, step of the deck", weak, 0.2, float(weak.summary["energy_error"]))
if case.full:
    for step, series in ((0.45, "15 kPa, step of the deck"), (0.225, "15 kPa, half of that step")):
        for spacing in (0.2, 0.125, 0.1):
            if (step, spacing) != (0.45, 0.2):  # run above
                finer = case.run(
                    "case.nml",
                    [
                        ("spacing = 0.2", f"spacing = {spacing}"),
                        ("step_safety = 0.45", f"step_safety = {step}"),
                    ],
                    name=f"spacing_{spacing}_step_{step}",
                )
                case.study(series, finer, spacing, float(finer.summary["energy_error"]))
    case.note(
        "The energy error is of first order in the step, and grows on finer nodes, which a support lost at "
        "once strains by more a step: the deck's step meets 1e-3 at its own spacing, not at half of it."
    )
history = weak.history()
shored = history["stage"] == "shored"
case.check(
    "shored: it stands [m]", history["maximum_displacement"][shored][-1], 0.05, "elastic settlement only"
)
lost = float(weak.summary["energy_error"])
case.target("energy error of the fall", lost, 1e-3, "the accuracy asked for", asked=True)
case.check_true(
    f"opened: it falls, by {history['maximum_displacement'][-1]:.2f} m in {history['time'][-1]:.2f} s",
    history["maximum_displacement"][-1] > 0.5,
)
case.check_true("opened: and still moves", history["maximum_velocity"][-1] > 1.0)
plastic = weak.field("plastic_strain")
band = plastic > 0.25 * plastic.max()
reach = weak.nodes[band]
case.check_true(
    "a shear band runs from the toe into the ground behind the face",
    np.min(np.linalg.norm(reach - [6.0, 2.0], axis=1)) < 0.5 and reach[:, 1].max() > 3.0,
)
strong = case.run(
    "case.nml",
    [("cohesion = 15.0e3", "cohesion = 25.0e3"), ("duration = 0.6", "duration = 1.0")],
    name="strong",
).history()
case.check(
    "25 kPa, opened: it stays [m]",
    strong["maximum_displacement"].max(),
    0.1,
    "elastic unloading swings by twice its static 3 cm",
)
case.check_true(
    "25 kPa, opened: plastic work has ended",
    np.ptp(strong["energy_plastic"][-20:]) < 0.02 * strong["energy_plastic"][-1],
)
curves = {}
for name, columns, style in (("15 kPa", history, "C1-"), ("25 kPa", strong, "C0-")):
    fall = columns["stage"] == "collapse"
    time = columns["time"][fall] - columns["time"][fall][0]
    curves[f"cohesion {name}"] = (time, columns["maximum_displacement"][fall], style)
case.picture("After the shoring has gone", "Time [s]", "Largest displacement [m]", curves)
sys.exit(case.verdict())
