# SPDX-License-Identifier: MIT
"""Energy over a dynamic stage: a soft block, 4 m high, gives way under its own weight.

Plastic flow, softening, damage and large rotation at once, with nodes off their grid; the crest falls
by more than a metre. Limit 1e-3 of the largest energy that changed hands, at every history line
(issue 2), at one level and at two.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(__file__.rsplit("/", 1)[0])
TWO = "levels = 2\n  length = 0.8"
for name, levels in {"two levels": TWO, "one level": "levels = 1"}.items():
    result = case.run("drop.nml", [(TWO, levels)])
    history = result.history()
    case.check(f"{name}: energy", np.abs(history["energy_error"]).max(), 1e-3, "issue 2")
    case.check(f"{name}: the summary's", float(result.summary["energy_error"]), 1e-3, "issue 2")
    case.check_true(f"{name}: falls by more than a metre", history["maximum_displacement"][-1] > 1.0)
    case.check_true(
        f"{name}: plastic work and damage take part",
        history["energy_plastic"][-1] > 0.05 * history["energy_external"][-1]
        and history["energy_damage"][-1] > 0,
    )
sys.exit(case.verdict())
