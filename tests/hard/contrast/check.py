# SPDX-License-Identifier: MIT
"""Hard 7: layers with a contrast of 1000:1 in stiffness and of 1e6:1 in conductivity.

The weight of three layers without lateral strain: sigma_yy = rho g (y - H), settlement by the moduli of the
layers. Flow through three layers in series: q = head/sum(L/k), head straight in each layer; interfaces lie
half-way between rows of nodes, where the faces of the cells are. Rain that perches on the tight layer.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "verify"))
from talus_case import Case  # noqa: E402

HEIGHT, WIDTH, WEIGHT, WATER, DURATION = 2.0, 0.5, 2000.0 * 9.81, 9810.0, 1.0e6
SOFT, STIFF = (young * 0.7 / (1.3 * 0.4) for young in (1.0e7, 1.0e10))
TIGHT, OPEN = 1.0e-9, 1.0e-3
LOWER, THICK = {0.1: 0.65, 0.05: 0.625, 0.025: 0.6125}, 0.6

case = Case(
    pathlib.Path(__file__).parent,
    id="hard 7",
    title="layers: stiffness 1000:1, conductivity 1e6:1",
    error="relative L2 error of vertical stress (weight) and of head (flow)",
    reference="exact: moduli and resistances in series",
)


def layers(spacing):
    """Text replacements for a spacing, with the interfaces half-way between rows."""
    low, high = LOWER[spacing], LOWER[spacing] + THICK
    return [
        ("spacing = 0.05", f"spacing = {spacing}"),
        ("from_y = 0.625", f"from_y = {low}"),
        ("to_y = 1.225", f"to_y = {high}"),
    ]


def settled(low, y):
    """Displacement at heights y by the weight above, layer by layer."""
    edges, moduli = [0.0, low, low + THICK, HEIGHT], [STIFF, SOFT, STIFF]
    total = np.zeros_like(y)
    for a, b, modulus in zip(edges[:-1], edges[1:], moduli):
        top = np.clip(y, a, b)
        total += WEIGHT / modulus * ((top - HEIGHT) ** 2 - (a - HEIGHT) ** 2) / 2
    return total


def resistances(low):
    return np.array([low / OPEN, THICK / TIGHT, (HEIGHT - low - THICK) / OPEN])


def head_exact(low, y):
    lost = resistances(low)
    return 2.0 + np.interp(
        y, [0, low, low + THICK, HEIGHT], np.concatenate([[0], np.cumsum(lost)]) / lost.sum()
    )


def relative(area, field, exact):
    return np.sqrt(np.sum(area * (field - exact) ** 2) / np.sum(area * exact**2))


def weight(spacing, change=(), name="weight"):
    """Run the column: the run, the stress at equilibrium and the exact one."""
    run = case.run("weight.nml", layers(spacing) + list(change), name=f"{name}_{spacing}")
    balanced = run.snapshots()[1]
    y = run.nodes[:, 1]
    return run, balanced, run.field("stress", snapshot=balanced)[:, 1], WEIGHT * (y - HEIGHT)


def acts(run, snapshot):
    """The vertical stress that carries the load."""
    return run.field("stress_acting", snapshot=snapshot)[:, 1]


def row_averages(y, stress):
    """Heights of the rows between the ends, and stress there averaged over three rows by 1/4, 1/2, 1/4."""
    rows = np.unique(np.round(y, 6))
    mean = np.array([np.mean(stress[np.abs(y - row) < 1e-6]) for row in rows])
    return rows[1:-1], 0.25 * (mean[:-2] + 2 * mean[1:-1] + mean[2:])


def weights(spacings):
    for spacing in spacings:
        run, balanced, stress, exact = weight(spacing)
        case.study("weight", run, spacing, relative(run.area, stress, exact))
        rows, values = row_averages(run.nodes[:, 1], stress)
        right = WEIGHT * (rows - HEIGHT)
        case.study("weight, averages of rows", run, spacing, relative(np.ones_like(rows), values, right))
    y = run.nodes[:, 1]
    sunk = run.field("displacement", snapshot=balanced)[:, 1]
    top = y > HEIGHT - 1e-6
    sinks = settled(LOWER[spacing], np.array([HEIGHT]))[0]
    case.target(f"settlement of the top, h = {spacing} m", abs(sunk[top].mean() / sinks - 1), 0.02, "our own")
    case.target("L2 error of stress", relative(run.area, stress, exact), 0.10, "our own, see the note")
    off = np.abs(values - right).max() / (WEIGHT * HEIGHT)
    case.target("stress averaged over neighbouring rows: largest error over rho g H", off, 0.05, "our own")
    lost = abs(float(run.summary["energy_error"]))
    case.target("energy error of the dynamic stage", lost, 1e-3, "limit", asked=True)
    two, balanced, *_ = weight(
        spacing, [("levels = 1", f"levels = 2\n  length = {4 * spacing}")], name="weight_two"
    )
    case.study("weight, two levels, ell = 4 h", two, spacing, relative(two.area, acts(two, balanced), exact))
    off = two.field("displacement", snapshot=balanced)[top, 1].mean() / sunk[top].mean() - 1
    what = "two levels, ell = 4 h: settlement of the top over that at one, less one"
    case.target(what, abs(off), 1e-4, "our own: elastic soil deforms as at one level")
    lost = abs(float(two.summary["energy_error"]))
    case.target("energy error of the dynamic stage, two levels", lost, 1e-3, "limit")
    largest = np.abs(stress - exact).max() / (WEIGHT * HEIGHT)
    case.note(
        "At a jump of stiffness stress alternates from row to row; the stabilisation, which carries a "
        f"share of the load there, lets it decay; largest error {largest:.2g} of rho g H at h = {spacing} m. "
        "The alternation is as large at every spacing, over about as many rows, so that its L2 norm falls "
        "with the root of h at best. Averages of neighbouring rows carry the load, with a fortieth of that "
        "error."
    )
    order = np.argsort(y, kind="stable")
    case.picture(
        "Vertical stress over the height",
        "Vertical stress [kPa]",
        "Elevation [m]",
        {
            "exact": (exact[order] / 1e3, y[order]),
            "TALUS": (stress[order] / 1e3, y[order], "."),
        },
    )


def relaxation():
    """Steps to equilibrium with scaled masses and with true ones."""
    short = [("duration = 0.05", "duration = 1.0e-6"), ("tolerance = 1.0e-7", "tolerance = 1.0e-5")]
    true_masses = int(weight(0.1, short, "true")[0].summary["steps"])
    scaled = [("mass_scaling = .false.", "mass_scaling = .true.")]
    scaled_masses = int(weight(0.1, short + scaled, "scaled")[0].summary["steps"])
    case.remedy(
        "masses scaled by stiffness make stiff layers on a soft one heavy; remedy: mass_scaling = .false.",
        f"{scaled_masses} steps to equilibrium",
        f"{true_masses} steps",
        scaled_masses > 2 * true_masses,
    )


def flows(spacings):
    for spacing in spacings:
        run = case.run("flow.nml", layers(spacing), name=f"flow_{spacing}")
        y = run.nodes[:, 1]
        head = run.field("pore_pressure") / WATER + y
        exact = head_exact(LOWER[spacing], y)
        case.study("flow", run, spacing, relative(run.area, head - 2, exact - 2), exact=True)
        history = run.history()
        flux = (history["water_in"][-1] - history["water_in"][0]) / (WIDTH * DURATION)
        out = (history["water_out"][-1] - history["water_out"][0]) / (WIDTH * DURATION)
        series = 1.0 / resistances(LOWER[spacing]).sum()
        case.target(
            f"h = {spacing} m: flux in against resistances in series", abs(flux / series - 1), 1e-6, "our own"
        )
        case.target(f"h = {spacing} m: flux out against the same", abs(out / series - 1), 1e-6, "our own")
        case.target(
            f"h = {spacing} m: largest error of head [m]", np.abs(head - exact).max(), 1e-5, "our own"
        )
        falls = rises(y, head)
        case.target(
            f"h = {spacing} m: heads are monotone: largest fall [m]", falls, 1e-5, "Newton's tolerance"
        )
        lost = abs(float(run.summary["water_error"]))
        case.target(f"h = {spacing} m: water error", lost, 1e-12, "limit", asked=True)
        wrong = arithmetic_flux(spacing) / series - 1
    case.remedy(
        "flux between soils with arithmetic means of conductivity at faces; "
        "remedy: halves of an edge in series",
        f"{wrong:.2g} relative error of the flux at h = {spacing} m",
        f"{abs(flux / series - 1):.1g}",
        abs(wrong) > 0.01,
        by="numpy stand-in on the same rows, not TALUS",
    )


def uneven():
    """The same flow on perturbed nodes, where the interface is as uneven as the rows."""
    for part in (0.3, 0.4) if case.full else (0.3,):
        run = case.run("flow.nml", [("perturbation = 0.0", f"perturbation = {part}")], name=f"uneven_{part}")
        history = run.history()
        flux = (history["water_in"][-1] - history["water_in"][0]) / (WIDTH * DURATION)
        series = 1.0 / resistances(LOWER[0.05]).sum()
        what = f"nodes perturbed by {part} h"
        case.target(f"{what}: flux against resistances in series", abs(flux / series - 1), 0.02, "our own")
        head = run.field("pore_pressure") / WATER + run.nodes[:, 1]
        beyond = max(head.max() - 3.0, 2.0 - head.min(), 0.0)
        case.target(f"{what}: heads beyond those of the boundary [m]", beyond, 1e-5, "monotone")
        fastest = np.abs(run.field("seepage_velocity")[:, 1]).max() / series
        case.check(f"{what}: fastest velocity over the flux", fastest, 1e3, "round-off of heads in open soil")


def rises(y, head):
    """Largest fall of the mean head from one row to the next higher one."""
    rows = [head[np.abs(y - row) < 1e-6].mean() for row in np.unique(np.round(y, 6))]
    return max(0.0, -np.diff(rows).min())


def arithmetic_flux(spacing):
    """Flux through the rows of nodes if faces between soils took the mean of both conductivities."""
    y = np.arange(round(HEIGHT / spacing) + 1) * spacing
    k = np.where((y > LOWER[spacing]) & (y < LOWER[spacing] + THICK), TIGHT, OPEN)
    return 1.0 / np.sum(spacing / (0.5 * (k[:-1] + k[1:])))


def perched():
    run = case.run("rain.nml")
    lost = abs(float(run.summary["water_error"]))
    case.target("rain that perches: water error", lost, 1e-12, "limit", asked=True)
    y, pressure = run.nodes[:, 1], run.field("pore_pressure")
    clay = (y > 0.625) & (y < 1.225)
    ponded = pressure[(y > 1.225) & (y < 1.3)].min()
    case.check_true(f"water perches on the clay: {ponded:.0f} Pa", ponded > 0)
    first = run.field("pore_pressure", snapshot=run.snapshots()[0])
    below = np.abs(pressure - first)[y < 0.6].max()
    case.check(
        "the gravel below the clay stays as it was [Pa]", below, 1.0, "clay lets nothing through in 10 h"
    )
    case.check_true("the clay takes up water", (pressure - first)[clay].max() > 0)


weights((0.1, 0.05, 0.025) if case.full else (0.1,))
relaxation()
flows((0.1, 0.05, 0.025) if case.full else (0.1,))
uneven()
perched()
sys.exit(case.verdict())
