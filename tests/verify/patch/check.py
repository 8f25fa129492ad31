# SPDX-License-Identifier: MIT
"""M1, linear patch through the program: a box between moving rollers is strained uniformly.

Reference: Hooke's law in plane strain. Inner nodes find their places in one step of a storm, so this
passes through driven boundaries, relaxation, both gradients and their adjoint. The transient of
the relaxation leaves an objective stress a trace of second order in the strain (2e-5 here); it has
the same sign in compression and in extension, so the odd half of a squeezed and a stretched run is
free of it and shows the patch error alone. 1e-9 is thirty times the tolerance of the relaxation.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

YOUNG, POISSON, STRAIN_X, STRAIN_Y = 1.0e6, 0.3, -2.0e-5, 1.0e-5
LEVELS = {
    "one level": "levels = 1",
    "two levels, ell = 3 h": "levels = 2\n  length = 0.3",
    "two levels, ell = 4 h": "levels = 2\n  length = 0.4",
}

case = Case(__file__.rsplit("/", 1)[0])
bulk = YOUNG / (3.0 * (1.0 - 2.0 * POISSON))
shear = YOUNG / (2.0 * (1.0 + POISSON))
lame = bulk - 2.0 * shear / 3.0
volume = STRAIN_X + STRAIN_Y
exact = np.array(
    [lame * volume + 2.0 * shear * STRAIN_X, lame * volume + 2.0 * shear * STRAIN_Y, lame * volume, 0.0]
)
for perturbation in ("0.0", "0.3"):
    for name, levels in LEVELS.items():
        change = [("perturbation = 0.0", "perturbation = " + perturbation), ("levels = 1", levels)]
        squeezed = case.run("patch.nml", change)
        stretched = case.run(
            "patch.nml", change + [("-4.0e-5", "4.0e-5"), ("1.0e-5", "-1.0e-5")], name="stretched"
        )
        stress = 0.5 * (squeezed.field("stress") - stretched.field("stress"))
        spread = np.abs(stress - stress.mean(axis=0)).max() / np.abs(exact).max()
        error = np.abs(stress - exact).max() / np.abs(exact).max()
        what = f"{name}, perturbation {perturbation}"
        case.check(f"{what}: stress is uniform", spread, 1.0e-9, "thirty times the tolerance")
        case.check(f"{what}: stress is Hooke's", error, 1.0e-8, "third order in a strain of 2e-5")
        case.check(
            f"{what}: energy",
            abs(squeezed.history()["energy_error"][-1]),
            1.0e-4,
            "work of driven nodes is stored or damped; second order in the strain",
        )
sys.exit(case.verdict())
