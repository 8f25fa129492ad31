# SPDX-License-Identifier: MIT
"""Hard 2: a free square with E = rho = 1, nu = 0.3, its spectrum and 1e5 steps of free vibration.

The square is pulled by tractions, then let go with nothing holding it; its strains are some 5e-8, so that the
turning of the stress by the rate law (second order in the strain) is not what is seen. Reference for
omega^2: 5.9588, 7.2179, 7.2179, nine-node finite elements with consistent mass (see
tests/unit/free_square_reference.py). The drift is the relative change from the mean energy of the first
fiftieth of the vibration to that of the last.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "verify"))
from talus_case import Case  # noqa: E402

REFERENCE = np.array([5.9588, 7.2179, 7.2179])
STEPS = 100000

case = Case(
    pathlib.Path(__file__).parent,
    id="hard 2",
    title="free square: spectrum and 1e5 steps of free vibration",
    error="relative change of the total energy over 1e5 steps",
    reference="nine-node finite elements with consistent mass, tests/unit/free_square_reference.py",
    quantity="energy drift",
    order=False,
    work=False,
)


def changes(spacing, perturbation, factor, stabilisation="0.05"):
    """Text replacements of the deck; `factor` = ell/h, 0 for one level."""
    found = [
        ("spacing = 0.05", f"spacing = {spacing:.12g}"),
        ("perturbation = 0.3", f"perturbation = {perturbation}"),
        ("stabilisation = 0.05", f"stabilisation = {stabilisation}"),
    ]
    if factor > 0:
        found.append(("levels = 1", f"levels = 2\n  length = {factor * spacing:.12g}"))
    return found


def name_of(factor):
    return "one level" if factor == 0 else f"two levels, ell = {factor} h"


def soft_modes(square):
    """Zero modes, and modes that deform the square with less than 3/4 of the lowest true omega^2."""
    zero = np.abs(square) < 1e-12 * square[-1]
    return np.count_nonzero(zero), np.count_nonzero(~zero & (square < 0.75 * REFERENCE[0]))


def spectra():
    curves, rows = {}, []
    limits = {
        0: (0.05, "required"),
        3: (0.10, "required"),
        4: (0.05, "our own: as at one level"),
    }
    for perturbation in (0.0, 0.3) if case.full else (0.3,):
        for factor, (limit, why) in limits.items():
            _, square = case.spectrum("square.nml", changes(0.05, perturbation, factor))
            what = f"{name_of(factor)}, nodes perturbed by {perturbation} h"
            zero, soft = soft_modes(square)
            case.target(f"{what}: zero modes", zero, 3, "required: exactly three", low=3, asked=True)
            case.target(f"{what}: spurious soft modes", soft, 0, "required", low=0, asked=True)
            error = np.abs(square[3:6] / REFERENCE - 1).max()
            asked = why == "required"
            case.target(f"{what}: error of the next three omega^2", error, limit, why, asked=asked)
            rows.append([name_of(factor), f"{perturbation} h", zero, soft])
            rows[-1] += [f"{value:.3f}" for value in square[3:6]] + [f"{error:.2%}"]
            if perturbation > 0:
                curves[name_of(factor)] = (np.arange(4, 61), square[3:60])
    for factor in (0, 3):
        _, square = case.spectrum("square.nml", changes(0.05, 0.3, factor, "0.0"))
        zero, soft = soft_modes(square)
        curves[f"{name_of(factor)}, no stabilisation, {zero} zero modes"] = (
            np.arange(zero + 1, 61),
            square[zero:60],
            "--",
        )
        case.remedy(
            f"spurious modes of nodal integration, {name_of(factor)}; remedy: affine-residual stabilisation",
            f"{zero} zero modes and {soft} modes below 3/4 of the lowest true omega^2, "
            f"lowest {square[zero]:.3g}",
            "3 zero modes, none spurious",
            zero + soft > 3,
        )
    rows.append(["nine-node elements", "-", 3, 0, *[f"{value:.3f}" for value in REFERENCE], "-"])
    case.table(
        "Spectrum of 21 x 21 nodes, E = rho = 1",
        ["levels", "perturbed by", "zero modes", "soft modes", "omega^2 4", "5", "6", "largest error"],
        rows,
    )
    case.picture(
        "Spectrum of 21 x 21 perturbed nodes, without the modes of zero",
        "Mode [-]",
        "omega² [1/s²]",
        curves,
        log_y=True,
    )


def ring(cells, factor):
    """1e5 steps of free vibration: the curve of total energy over time."""
    spacing = 1.0 / cells
    change = changes(spacing, 0.3, factor)
    step, _ = case.spectrum("square.nml", change)
    duration = 0.9 * step * 1.001 * STEPS
    change += [
        ("duration = 4000.0", f"duration = {duration:.12g}"),
        ("history_interval = 1.0", f"history_interval = {duration / 2000:.12g}"),
    ]
    result = case.run("square.nml", change, name=f"ring_{cells}_{factor}")
    history = result.history()
    ringing = history["stage"] == "ring"
    total = sum(history[f"energy_{part}"][ringing] for part in ("kinetic", "strain", "stabilisation"))
    time = history["time"][ringing]
    steps = history["step"][-1] - history["step"][ringing][0]
    part = len(total) // 50
    drift = total[-part:].mean() / total[1 : part + 1].mean() - 1
    what = f"{name_of(factor)}, {cells + 1} x {cells + 1} perturbed nodes"
    case.check_true(f"{what}: balanced when let go", result.summary["failed"] == ".false.")
    case.check_true(f"{what}: {steps:.0f} steps were taken", steps >= STEPS)
    case.target(f"{what}: energy drift over 1e5 steps", abs(drift), 1e-6, "required", asked=True)
    case.study(f"{name_of(factor)}, perturbed nodes", result, spacing, abs(drift))
    case.check(f"{what}: energy error of the audit", abs(history["energy_error"][-1]), 1e-6, "the same")
    return time - time[0], np.abs(total / total[1 : part + 1].mean() - 1)


spectra()
curves = {}
for cells, factor in ((10, 0), (10, 3), (10, 4), (20, 0), (20, 3)) if case.full else ((6, 0), (6, 3)):
    time, change = ring(cells, factor)
    curves[f"{name_of(factor)}, h = 1/{cells} m"] = (time[1:], np.maximum(change[1:], 1e-16))
case.picture(
    "Total energy over 1e5 steps", "Time [s]", "Relative change of the total energy [-]", curves, log_y=True
)
case.note(
    "A deck asks for ell >= 3 h, as shear bands need; ell = 2 h is tested at the level of modules, "
    "tests/unit/test_talus_spectrum.pf and test_free_vibration.pf, with the same limits."
)
sys.exit(case.verdict())
