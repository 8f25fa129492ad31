# SPDX-License-Identifier: MIT
"""M1, linear patch through the program, on regular and perturbed nodes.

affine.nml gives every node a homogeneous displacement gradient of some per cent in one step and then
lets the inner nodes go. Where an operator passes the patch test, every inner node is in balance to
round-off and stays where it is, so what moves is the error: relative to the largest displacement, with
a limit of 1e-12. The weights `rk` and `area`, plain readings of the literature, do not pass: run and
shown. A deck's ell is 3 h at least; ell = 2 h is tested by test_talus_soil_step on the operator.

patch.nml is the same body driven by moving rollers through driven boundaries and relaxation. Its
transient leaves an objective stress a trace of second order in the strain (2e-5 there); it has the same
sign in compression and in extension, so the odd half of a squeezed and a stretched run is free of it.
1e-9 is thirty times the tolerance of the relaxation.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

YOUNG, POISSON, STRAIN_X, STRAIN_Y = 1.0e6, 0.3, -2.0e-5, 1.0e-5
EXACT_LEVELS = {
    "one level": None,
    "two levels, symmetric, ell = 3 h": (3, "symmetric"),
    "two levels, symmetric, ell = 4 h": (4, "symmetric"),
}
POOR_LEVELS = {
    f"two levels, {weights}, ell = {ratio} h": (ratio, weights)
    for weights in ("rk", "area")
    for ratio in (3, 4)
}

case = Case(
    __file__.rsplit("/", 1)[0],
    id="M1",
    title="Linear patch, regular and perturbed nodes",
    error="largest motion of an inner node over the largest displacement",
    reference="u = B x, exact",
)


def levels_of(choice, spacing):
    if choice is None:
        return "levels = 1"
    return f"levels = 2\n  length = {choice[0] * spacing}\n  weights = '{choice[1]}'"


def class_of(name):
    """The name of a level without its length."""
    return name.split(", ell")[0]


def let_go(name, choice, spacing, perturbation):
    """Motion of the inner nodes after they are let go, relative; and the stress's departure."""
    result = case.run(
        "affine.nml",
        [
            ("spacing = 0.1", f"spacing = {spacing}"),
            ("perturbation = 0.0", f"perturbation = {perturbation}"),
            ("levels = 1", levels_of(choice, spacing)),
        ],
    )
    names = result.snapshots()
    given = result.field("displacement", names[-2])
    strained = result.field("stress", names[-2])
    error = np.abs(result.field("displacement") - given).max() / np.abs(given).max()
    spread = np.abs(strained - strained.mean(axis=0)).max() / np.abs(strained).max()
    nodes = "regular" if perturbation == 0.0 else f"perturbed by {100 * perturbation:.0f} %"
    case.study(f"{name}, {nodes}", result, spacing, error, curve=f"{class_of(name)}, worst")
    return max(error, spread)


spacings = (0.2, 0.1, 0.05) if case.full else (0.1,)
worst = {}
for perturbation in (0.0, 0.15, 0.3) if case.full else (0.0, 0.3):
    for name, choice in {**EXACT_LEVELS, **POOR_LEVELS}.items():
        values = [let_go(name, choice, spacing, perturbation) for spacing in spacings]
        pick = max if name in EXACT_LEVELS else min
        worst[name] = values if name not in worst else [pick(a, b) for a, b in zip(worst[name], values)]
for name in EXACT_LEVELS:
    case.target(
        f"{name}, motion and spread of stress", max(worst[name]), 1.0e-12, "machine precision", asked=True
    )
for weights in ("rk", "area"):
    least = min(min(worst[name]) for name in POOR_LEVELS if weights in name)
    case.remedy(
        f"second level with plain weights `{weights}` instead of symmetric, conservative ones",
        f"inner nodes move by at least {least:.2g} of the displacement",
        f"by {max(max(worst[name]) for name in EXACT_LEVELS):.2g}",
        least > 1.0e-4,
    )
if case.full:
    classes = {}
    for name, values in worst.items():
        pick = max if name in EXACT_LEVELS else min
        kind = class_of(name)
        classes[kind] = values if kind not in classes else list(map(pick, classes[kind], values))
    case.picture(
        "Departure from a homogeneous strain (worst exact and best failing of all nodes)",
        "Node spacing [m]",
        "Relative motion [-]",
        {
            kind: (spacings, values, "s--" if "rk" in kind or "area" in kind else "o-")
            for kind, values in classes.items()
        },
        log_x=True,
        log_y=True,
    )

bulk = YOUNG / (3.0 * (1.0 - 2.0 * POISSON))
shear = YOUNG / (2.0 * (1.0 + POISSON))
lame = bulk - 2.0 * shear / 3.0
volume = STRAIN_X + STRAIN_Y
exact = np.array(
    [lame * volume + 2.0 * shear * STRAIN_X, lame * volume + 2.0 * shear * STRAIN_Y, lame * volume, 0.0]
)
for perturbation in ("0.0", "0.3"):
    for name, choice in EXACT_LEVELS.items():
        change = [("perturbation = 0.0", "perturbation = " + perturbation)]
        change += [("levels = 1", levels_of(choice, 0.1))]
        squeezed = case.run("patch.nml", change)
        stretched = case.run(
            "patch.nml", change + [("-4.0e-5", "4.0e-5"), ("1.0e-5", "-1.0e-5")], name="stretched"
        )
        stress = 0.5 * (squeezed.field("stress") - stretched.field("stress"))
        spread = np.abs(stress - stress.mean(axis=0)).max() / np.abs(exact).max()
        error = np.abs(stress - exact).max() / np.abs(exact).max()
        what = f"between moving rollers, {name}, perturbation {perturbation}"
        case.check(f"{what}: stress is uniform", spread, 1.0e-9, "thirty times the tolerance")
        case.check(f"{what}: stress is Hooke's", error, 1.0e-8, "third order in a strain of 2e-5")
        case.check(
            f"{what}: energy",
            abs(squeezed.history()["energy_error"][-1]),
            1.0e-4,
            "work of driven nodes is stored or damped; second order in the strain",
        )
sys.exit(case.verdict())
