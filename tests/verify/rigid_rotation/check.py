# SPDX-License-Identifier: MIT
"""M2, rigid rotation of a stressed block: sigma = Q sigma0 Q^T, no strain.

A block of perturbed nodes is squeezed and sheared unevenly until some of it yields, then every node is
turned by 90 degrees about a point outside the block: in one step, and in 1000 small ones. The rule of
Hughes & Winget (1980) turns stress exactly, so only round-off is left: that of positions (1e-16 of 2 m)
over the spacing (0.05 m) is 5e-15 of strain from each neighbour, and stress over modulus is 1/75 here.
Hence one limit of 1e-11 for stress, 1e-12 for strain and plastic strain, of which there must be none.
The picture has beside it what the same turn costs with the Jaumann rate taken at the start of each
step, evaluated here.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

LIMIT = {"stress error": 1.0e-11, "strain": 1.0e-12, "plastic strain": 1.0e-12}
LEVELS = {"one level": "levels = 1", "two levels, ell = 4 h": "levels = 2\n  length = {}"}
QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])


def tensors(stress):
    """In-plane stress as matrices."""
    return stress[:, [0, 3, 3, 1]].reshape(-1, 2, 2)


def error_of(plane, across, start):
    """Largest error of in-plane matrices and of the stress along z against the turned start."""
    exact = QUARTER @ tensors(start) @ QUARTER.T
    return max(np.abs(plane - exact).max(), np.abs(across - start[:, 2]).max()) / np.abs(start).max()


def first_order(start, steps):
    """Error of sigma += w sigma - sigma w in equal steps."""
    plane, spin = tensors(start), np.pi / 2 / steps * QUARTER
    for _ in range(steps):
        plane = plane + spin @ plane - plane @ spin
    return error_of(plane, start[:, 2], start)


case = Case(
    __file__.rsplit("/", 1)[0],
    id="M2",
    title="Rigid rotation of a stressed block by 90 degrees",
    error="largest error of a stress component at any node over the largest stress",
    reference="sigma = Q sigma0 Q^T, exact",
)
worst = {}
curve = []
for spacing in (0.2, 0.1, 0.05) if case.full else (0.1,):
    for level, smoothing in LEVELS.items():
        for steps in (1, 10, 100, 1000) if case.full else (1, 1000):
            rate = np.pi / 2 / steps
            result = case.run(
                "turn.nml",
                [
                    ("spacing = 0.1", f"spacing = {spacing}"),
                    ("levels = 1", smoothing.format(4 * spacing)),
                    ("0.0, -1.5707963267948966, 1.5707963267948966, 0.0", f"0.0, {-rate}, {rate}, 0.0"),
                    ("'dynamic'\n  duration = 1.0", f"'dynamic'\n  duration = {steps}.0"),
                ],
            )
            history = result.history()
            case.check_true(
                f"turned in {steps} steps",
                history["step"][-1] - history["step"][history["stage"] == "turn"][0] == steps,
            )
            start = result.field("stress", result.snapshots()[-2])
            stress = result.field("stress")
            error = error_of(tensors(stress), stress[:, 2], start)
            case.study(f"{level}, {steps} step{'s' * (steps > 1)}", result, spacing, error)
            found = {
                "stress error": error,
                "strain": np.abs(result.field("strain")).max(),
                "plastic strain": result.field("plastic_strain").max(),
            }
            for what, value in found.items():
                key = (what, "one step" if steps == 1 else "small steps")
                worst[key] = max(worst.get(key, 0.0), value)
            if spacing == 0.1 and level == "one level":
                curve.append((steps, error, first_order(start, steps)))
case.check_true("the block had yielded somewhere", result.history()["energy_plastic"].max() > 0.0)
for (what, steps), value in worst.items():
    case.target(f"{what}, {steps}", value, LIMIT[what], "round-off of positions, see check.py", asked=True)
steps, ours, other = np.array(curve).T
case.picture(
    "Stress error after a turn of 90 degrees",
    "Number of steps [-]",
    "Relative error [-]",
    {"TALUS": (steps, ours, "o-"), "Jaumann rate at the start of the step": (steps, other, "s--")},
    log_x=True,
    log_y=True,
)
sys.exit(case.verdict())
