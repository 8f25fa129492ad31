# SPDX-License-Identifier: MIT
"""Hard 1: nodes perturbed by 40 % of the spacing, graded 1:10 along x and 10:1 along y.

Linear patch (odd half of a squeezed and a stretched run, see tests/verify/patch), the weight of a column,
steady rain through exponential soil (Gardner 1958: k_r = r + (1 - r) exp(-alpha z), r = rain/conductivity),
and the stable step against LAPACK's eigenvalues.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "verify"))
from talus_case import Case  # noqa: E402

YOUNG, POISSON, STRAIN_X, STRAIN_Y = 1.0e6, 0.3, -2.0e-5, 1.0e-5
LAME = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
SHEAR = YOUNG / (2 * (1 + POISSON))
HEIGHT, WEIGHT = 2.0, 2000.0 * 9.81
ALPHA, RATIO, WATER = 2.0, 0.1, 9810.0
REGULAR = [("grading_x = 10.0", "grading_x = 1.0"), ("grading_y = 0.1", "grading_y = 1.0"),
           ("perturbation = 0.4", "perturbation = 0.0")]  # fmt: skip

case = Case(
    pathlib.Path(__file__).parent,
    id="hard 1",
    title="nodes perturbed by 40 % of h and graded 1:10 both ways",
    error="relative L2 error of vertical stress (column) and of suction head (rain)",
    reference="exact: Hooke's law, rho g (y - H), Gardner 1958",
)


def patch_error(levels, change=()):
    """Largest departure of the stress from Hooke's, over the largest stress."""
    change = [("levels = 1", levels), *change]
    squeezed = case.run("patch.nml", change)
    stretched = case.run(
        "patch.nml", change + [("-4.0e-5", "4.0e-5"), ("1.0e-5", "-1.0e-5")], name="stretched"
    )
    volume = STRAIN_X + STRAIN_Y
    exact = LAME * volume + 2 * SHEAR * np.array([STRAIN_X, STRAIN_Y, 0.0])
    stress = 0.5 * (squeezed.field("stress") - stretched.field("stress"))[:, :3]
    return np.abs(stress - exact).max() / np.abs(exact).max()


def patches():
    for name, levels in (
        ("one level", "levels = 1"),
        ("two levels, ell = 4 mean spacings", "levels = 2\n  length = 0.4"),
    ):
        case.target(
            f"patch, {name}: error of stress", patch_error(levels), 1e-8, "third order in a strain of 2e-5"
        )
    for weights in ("rk", "area") if case.full else ("rk",):
        wrong = patch_error(
            "levels = 2\n  length = 0.4\n  weights = '" + weights + "'", [("3.0e-11", "1.0e-7")]
        )
        case.remedy(
            f"a linear field, second level's weights '{weights}'; remedy: symmetric weights",
            f"{wrong:.2g} error of stress",
            "below 1e-8",
            wrong > 1e-3,
        )


def relative(area, field, exact):
    return np.sqrt(np.sum(area * (field - exact) ** 2) / np.sum(area * exact**2))


def rain_head(z):
    return np.log(RATIO + (1 - RATIO) * np.exp(-ALPHA * z)) / ALPHA


def studies():
    curves = {}
    graded = [("perturbed and graded", [])]
    for series, shape in graded + [("regular", REGULAR)] if case.full else graded:
        stress_error, head_error = [], []
        spacings = (0.2, 0.1, 0.05) if case.full else (0.1,)
        for spacing in spacings:
            change = shape + [("spacing = 0.1", f"spacing = {spacing}")]
            column = case.run("column.nml", change, name=f"column_{series[:3]}_{spacing}")
            stress = column.field("stress")[:, 1]
            exact = WEIGHT * (column.nodes[:, 1] - HEIGHT)
            stress_error.append(relative(column.area, stress, exact))
            case.study(f"column, {series}", column, spacing, stress_error[-1])
            rain = case.run("seepage.nml", change, name=f"rain_{series[:3]}_{spacing}")
            head = rain.field("pore_pressure") / WATER
            head_error.append(relative(rain.area, head, rain_head(rain.nodes[:, 1])))
            case.study(f"rain, {series}", rain, spacing, head_error[-1])
            case.check("water error", abs(float(rain.summary["water_error"])), 1e-12, "round-off")
            if shape:
                continue
            first = rain.field("pore_pressure", snapshot=rain.snapshots()[0]) / WATER
            moved = np.abs(head - first).max()
            case.check(f"spacing {spacing}: a day of steady rain moves the head [m]", moved, 1e-6, "steady")
            if spacing == 0.1:
                worst = np.abs(stress - exact).max() / (WEIGHT * HEIGHT)
                case.target(
                    "column: L2 error of stress, 21 rows", stress_error[-1], 0.02, "our own: rows of 0.25 m"
                )
                case.target("column: largest error of stress, 21 rows", worst, 0.05, "our own")
                case.target("rain: L2 error of suction head, 21 rows", head_error[-1], 0.01, "our own")
                curves["exact"] = (rain_head(np.linspace(0, 2, 100)), np.linspace(0, 2, 100))
                curves["all nodes, perturbed and graded"] = (head, rain.nodes[:, 1], ".")
    case.picture("Pressure head over the height", "Pressure head [m]", "Elevation [m]", curves)


def without_stabilisation():
    change = [("stabilisation = 0.05", "stabilisation = 0.0")]
    rough = {}
    for name, extra in (("with", []), ("without", change)):
        run = case.run("column.nml", extra, name=name)
        run_u = run.field("displacement")[:, 0]
        rough[name] = np.sqrt(np.mean(run_u**2)) / (WEIGHT * HEIGHT**2 / 2 / 1.346e9)
    case.remedy(
        "sideways motion in a column that can only settle; remedy: affine-residual stabilisation",
        f"{rough['without']:.2g} of the settlement (root mean square)",
        f"{rough['with']:.2g}",
        rough["without"] > 1.5 * rough["with"],
    )


def stable_step():
    start = "kind = 'geostatic'\n  tolerance = 1.0e-9\n  steps_max = 100000\n  reset_displacement = .false."
    for name, change in (
        ("scaled masses", []),
        ("true masses", [(start, "kind = 'dynamic'\n  duration = 1.0")]),
    ):
        step, square = case.spectrum("column.nml", change)
        exact = 2 / np.sqrt(square[-1])
        case.target(f"{name}: stable step over LAPACK's", step / exact, 1.005, "our own: sharp", low=0.99)
    case.note(f"the stable step on these nodes, {step:.3g} s, is that of the smallest cells.")


patches()
studies()
without_stabilisation()
stable_step()
sys.exit(case.verdict())
