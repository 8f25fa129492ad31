# SPDX-License-Identifier: MIT
"""Hard 5: simple shear to 300 % and a stress-free block that turns ten times.

Elastic soil under the Jaumann rate has sigma_xy = G sin(gamma), sigma_xx = -sigma_yy = G (1 - cos(gamma)).
Drucker-Prager soil stays on its cone: with a = R sin(theta), b = R cos(theta) of the in-plane deviator
theta' = 1 - G/R sin(theta), and lambda' = G cos(theta)/(G + 9 K alpha alpha_psi) raises R and lowers I1.
Every node follows the shear at first; then only the boundary does, and the inside finds its equilibrium.
The turning block is driven node by node (no stress may arise), and free in real time (momentum, energy).
"""

import pathlib
import sys

import numpy as np
from scipy.integrate import solve_ivp

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "verify"))
from talus_case import Case  # noqa: E402

YOUNG, POISSON, STRAIN = 2.6e6, 0.3, 3.0
SHEAR, BULK = YOUNG / (2 * (1 + POISSON)), YOUNG / (3 * (1 - 2 * POISSON))
COHESION, PHI, PSI = 10.0e3, np.radians(30.0), np.radians(5.0)
STAND_IN = "numpy stand-in at one point, not TALUS"
PLASTIC = "'drucker_prager' cohesion = 10.0e3 friction_angle = 30.0 dilation_angle = 5.0"

case = Case(
    pathlib.Path(__file__).resolve().parent,
    id="hard 5",
    title="Simple shear to 300 %, and ten turns of a stress-free block",
    error="largest error of a stress component at any node over G (elastic) or the cone's radius",
    reference="closed form and ordinary differential equation of the Jaumann rate",
)


def cone():
    """Slopes and k of the plane-strain fit, src/THEORY.md (3.7)."""
    slope = np.sin(PSI) / np.sqrt(9 + 3 * np.sin(PSI) ** 2)
    root = np.sqrt(1 - 3 * slope**2)
    alpha = np.sin(PHI) / (3 * (root + slope * np.sin(PHI)))
    return alpha, slope, COHESION * np.cos(PHI) * (1 - 3 * alpha * slope) / root


ALPHA, ALPHA_PSI, K_CONE = cone()


def elastic(gamma):
    """Stress xx, yy, zz, xy."""
    return SHEAR * np.array([1 - np.cos(gamma), np.cos(gamma) - 1, 0.0, np.sin(gamma)])


def plastic(gammas):
    """Stress xx, yy, zz, xy of the cone at shears beyond yield, (n, 4)."""
    first = 2 * np.arcsin(K_CONE / (2 * SHEAR))

    def rate(_, y):
        flow = SHEAR * np.cos(y[0]) / (SHEAR + 9 * BULK * ALPHA * ALPHA_PSI)
        return [
            1 - SHEAR / y[1] * np.sin(y[0]),
            9 * BULK * ALPHA * ALPHA_PSI * flow,
            -9 * BULK * ALPHA_PSI * flow,
        ]

    start = [first / 2, K_CONE, 0.0]  # elastic soil reaches R = 2 G sin(gamma/2) at theta = gamma/2
    theta, radius, i1 = solve_ivp(
        rate, (first, max(gammas)), start, "LSODA", np.maximum(gammas, first), rtol=1e-11, atol=1e-9
    ).y
    a, b, p = radius * np.sin(theta), radius * np.cos(theta), i1 / 3
    return np.stack([p + a, p - a, p, b], axis=1)


def off_cone(stress):
    """Largest sqrt(J2) + alpha I1 - k at any node, over k."""
    i1 = stress[:, :3].sum(axis=1)
    deviator = stress[:, :3] - i1[:, None] / 3
    root = np.sqrt(0.5 * np.sum(deviator**2, axis=1) + stress[:, 3] ** 2)
    return np.max(root + ALPHA * i1 - K_CONE) / K_CONE


def shear(soil, steps, spacing, snapshots=10):
    return case.run(
        "shear.nml",
        [
            ("'none'", soil),
            ("0.003", repr(STRAIN / steps)),
            ("duration = 1000.0 snapshots = 10", f"duration = {steps}.0 snapshots = {snapshots}"),
            ("spacing = 0.2", f"spacing = {spacing}"),
        ],
        name=f"{soil.split()[0][1:5]}_{steps}_{round(100 * spacing)}",
    )


def path(result):
    """Shear and stress at all nodes of each snapshot but the first."""
    names = result.snapshots()[1:]
    gammas = np.arange(1, len(names) + 1) * STRAIN / len(names)
    return gammas, [result.field("stress", s) for s in names]


def follow_all():
    """Every node follows the shear."""
    for spacing in (0.2, 0.1, 0.05) if case.full else (0.2,):
        result = shear("'none'", 1000, spacing)
        gammas, stress = path(result)
        error = max(np.abs(s - elastic(g)).max() for g, s in zip(gammas, stress)) / SHEAR
        case.study("elastic, 1000 steps", result, spacing, error)
        case.target(
            f"elastic, 1000 steps of 0.3 %, h = {spacing} m: error of the stress over G",
            error,
            1e-5,
            "second order in the step: (0.003)^2 and less",
        )
        result = shear(PLASTIC, 1000, spacing)
        gammas, stress = path(result)
        exact = plastic(gammas)
        error = max(np.abs(s - e).max() / e[3] for s, e in zip(stress, exact))
        case.study("Drucker-Prager, 1000 steps", result, spacing, error)
        case.target(f"Drucker-Prager, 1000 steps, h = {spacing} m: error", error, 2e-3, "first order return")
        above = max(off_cone(s) for s in stress)
        case.target(f"Drucker-Prager, h = {spacing} m: f over k", above, 1e-12, "stress is on the cone")
    counts, errors = (30, 100, 300, 1000), []
    for steps in counts:
        errors.append(np.abs(shear("'none'", steps, 0.2).field("stress") - elastic(STRAIN)).max() / SHEAR)
    orders = np.diff(np.log(errors)) / np.diff(np.log(counts))
    case.target("elastic: order in the step, less than 1.9 by", 1.9 + max(orders), 0.0, f"orders {-orders}")
    naive = [np.abs(numpy_path(n, "unturned increment") - elastic(STRAIN)).max() / SHEAR for n in counts]
    start = [np.abs(numpy_path(n, "start of the step") - elastic(STRAIN)).max() / SHEAR for n in counts]
    small = [np.abs(numpy_path(n, "small strain") - elastic(STRAIN)).max() / SHEAR for n in counts]
    case.picture(
        "Elastic shear of 300 %: error over number of steps",
        "Number of steps [-]",
        "Error of the stress over G [-]",
        {
            "TALUS": (counts, errors, "o-"),
            "increment not turned": (counts, naive, "s--"),
            "Jaumann rate at the start of the step": (counts, start, "^--"),
            "small strain": (counts, small, "k:"),
        },
        log_x=True,
        log_y=True,
    )
    case.remedy(
        "large shear, 1000 steps: increments of small strain, stress not turned",
        f"the error of the stress is {small[-1]:.2f} G (sigma_xy = {STRAIN:.0f} G in place of 0.14 G)",
        f"{errors[-1]:.1e} G",
        small[-1] > 1 and errors[-1] < 1e-5,
        by=STAND_IN,
    )
    case.remedy(
        "large shear, 1000 steps: strain increment left in the middle of the step (Hughes & Winget as "
        "usually coded), or the rate taken at its start",
        f"errors of {naive[-1]:.1e} and {start[-1]:.1e} G, first order",
        f"{errors[-1]:.1e} G with the increment turned by half the rotation, second order",
        min(naive[-1], start[-1]) > 100 * errors[-1],
        by=STAND_IN,
    )


def numpy_path(steps, rule):
    """Stress xx, yy, zz, xy after simple shear by other rules."""
    stress, d = np.zeros((2, 2)), STRAIN / steps
    increment, spin = d / 2 * np.array([[0, 1], [1, 0]]), d / 2 * np.array([[0, 1], [-1, 0]])
    turn = np.linalg.solve(np.eye(2) - spin / 2, np.eye(2) + spin / 2)
    for _ in range(steps):
        if rule == "unturned increment":
            stress = turn @ stress @ turn.T
        elif rule == "start of the step":
            stress = stress + spin @ stress - stress @ spin
        stress = stress + 2 * SHEAR * increment
    return np.array([stress[0, 0], stress[1, 1], 0.0, stress[0, 1]])


def inside_free():
    """The boundary follows the shear, the inside finds its equilibrium."""
    exact_path, shown = None, {}
    for levels in ("levels = 1", "levels = 2 length = 0.6"):
        name = "one level" if levels == "levels = 1" else "two levels"
        result = case.run("interior.nml", [("levels = 1", levels)], name=f"inside_{levels[9]}")
        gammas, stress = path(result)
        case.check_true(
            f"{name}, boundary sheared: equilibrium is never lost",
            abs(float(result.summary["simulated_seconds"]) - STRAIN) < 1e-6,
        )
        exact_path = plastic(gammas)
        mean = [np.sum(s * result.area[:, None], axis=0) for s in stress]
        error = max(np.abs(m - e).max() / e[3] for m, e in zip(mean, exact_path))
        case.target(
            f"{name}, boundary sheared to 300 %: error of the mean stress", error, 0.02, "paths differ"
        )
        above = max(off_cone(s) for s in stress)
        case.target(f"{name}, boundary sheared to 300 %: f over k", above, 1e-12, "stress is on the cone")
        place = result.nodes + result.field("displacement")
        affine = result.nodes + STRAIN * result.nodes[:, 1:] * [1, 0]
        case.check(
            f"{name}: largest distance of an inner node from the homogeneous shear over h",
            np.abs(place - affine).max() / 0.2,
            0.05,
            "the inside follows",
        )
        shown[f"{name}: sigma_xy"] = (gammas, [m[3] / 1e3 for m in mean], "o")
        shown[f"{name}: sigma_yy"] = (gammas, [m[1] / 1e3 for m in mean], "s")
    shown["exact: sigma_xy"] = (gammas, exact_path[:, 3] / 1e3, "k-")
    shown["exact: sigma_yy"] = (gammas, exact_path[:, 1] / 1e3, "k--")
    case.picture("Drucker-Prager soil, its boundary sheared", "Shear strain [-]", "Stress [kPa]", shown)


def turns():
    """Ten turns, driven and free."""
    two = [("levels = 1", "levels = 2 length = 0.4")]
    for name, change in (("one level", []), ("two levels", two)):
        result = case.run("turn.nml", change, name=f"turn_{name[:3]}")
        stress = max(np.abs(result.field("stress", s)).max() for s in result.snapshots())
        case.target(
            f"{name}, ten turns in steps of one degree: largest stress over E",
            stress / 1e7,
            1e-11,
            "round-off of positions over the spacing, 3600 times",
        )
    # The same turn with the strain increment of the shape at the start of each step.
    strain, degree = np.zeros((2, 2)), np.radians(1.0)
    turn = np.array([[np.cos(degree), -np.sin(degree)], [np.sin(degree), np.cos(degree)]])
    for _ in range(3600):
        strain = turn @ strain @ turn.T + (turn + turn.T) / 2 - np.eye(2)
    pressure = -strain[0, 0] / ((1 + POISSON) * (1 - 2 * POISSON))
    case.remedy(
        "ten turns in steps of one degree: strain increment sym(du/dx) of the shape at the start of the step",
        f"strain {strain[0, 0]:.2f} in each direction of a block that but turned: pressure {pressure:.2f} E",
        f"{stress / 1e7:.1e} E with that of the middle of the step",
        pressure > 0.1,
        by=STAND_IN,
    )
    result = case.run("spin.nml", [] if case.full else [("snapshots = 200", "snapshots = 50")])
    history, mass = result.history(), 2000.0 * result.area
    momentum, trace = [], []
    for s in result.snapshots():
        x, v, stress = (result.field(f, s) for f in ("displacement", "velocity", "stress"))
        x = x + result.nodes
        momentum.append(np.sum(mass * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])))
        trace.append(np.sum(result.area * (stress[:, 0] + stress[:, 1]) / 2))
    case.target(
        "free block, ten turns: drift of the angular momentum",
        np.max(np.abs(np.array(momentum) / momentum[0] - 1)),
        1e-12,
        "round-off",
    )
    error = np.abs(history["energy_error"]).max() * np.ptp(history["energy_kinetic"])
    case.target(
        "free block, ten turns: energy error over the kinetic energy",
        error / history["energy_kinetic"][0],
        1e-6,
        "of the energy that changes hands 1e-3 at most",
    )
    case.check(
        "free block: mean stress over that of the centrifugal force (virial theorem), less one",
        abs(np.mean(trace[1:]) / history["energy_kinetic"][0] - 1),
        0.02,
        "no other stress arises, mean over snapshots",
    )


follow_all()
inside_free()
turns()
sys.exit(case.verdict())
