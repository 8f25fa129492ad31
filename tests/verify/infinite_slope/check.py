# SPDX-License-Identifier: MIT
"""S3, the infinite slope with suction, by strength reduction against its closed form

F = (c + gamma z cos^2 b tan(phi) + s tan(phi_b))/(gamma z sin b cos b).

A piece of a layer at 30 degrees, z = 2 m deep, on a rough base, cut off by two vertical planes. On these act
the tractions of the infinite slope at its limit, linear with depth: stress normal and shear to the slope by
statics, stress along the slope where Mohr's circle touches the strength at the base. That field is in
equilibrium and nowhere beyond strength, and sliding as one body needs no more load, so that for psi = phi the
closed form is exact for the piece, too (both theorems of limit analysis), however short it is.
The slip is half a spacing above the base, so the error falls with h and not with h^2; it must do so.
"""

import math
import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="S3",
    title="Infinite slope with suction",
    error="relative difference of the factor of safety from the closed form",
    reference="closed form F = (c + gamma z cos^2 b tan(phi) + s tan(phi_b))/(gamma z sin b cos b)",
)
SLOPE, DEPTH, WIDTH = math.radians(30.0), 2.0, 1.0
COHESION, TAN_PHI, TAN_PHI_B = 2.0e3, math.tan(math.radians(25.0)), math.tan(math.radians(12.0))
GRADING = 10.0  # of the rows, fine at the base
TIP = 1e-4  # half size of the box around a node or edge [m]


def closed_form(weight, suction):
    normal, shear = weight * DEPTH * math.cos(SLOPE) ** 2, weight * DEPTH * math.sin(SLOPE) * math.cos(SLOPE)
    return (COHESION + normal * TAN_PHI + suction * TAN_PHI_B) / shear


def mesh(rows):
    """Nodes (rows+1, columns+1, 2) of the piece, the base first."""
    x = np.linspace(0.0, WIDTH, round(rows * WIDTH / DEPTH) + 1)
    up = np.cumsum(np.geomspace(1.0, GRADING, rows))
    up = np.concatenate([[0.0], up * DEPTH / up[-1]])
    return np.stack(np.broadcast_arrays(x[None, :], x[None, :] * math.tan(SLOPE) + up[:, None]), axis=-1)


def mesh_text(nodes):
    rows, columns = nodes.shape[0] - 1, nodes.shape[1] - 1
    lines = [f"nodes {nodes.shape[0] * nodes.shape[1]}"]
    lines += [f"{x:.12g} {y:.12g}" for x, y in nodes.reshape(-1, 2)]
    lines.append(f"elements {rows * columns}")
    for i in range(rows):
        for j in range(columns):
            first = i * (columns + 1) + j + 1
            lines.append(f"4 {first} {first + 1} {first + columns + 2} {first + columns + 1}")
    return "\n".join(lines) + "\n"


def box(low, high, effect):
    return (
        f"&boundary\n  where = 'box'\n  from_x = {low[0] - TIP:.8f}\n  to_x = {high[0] + TIP:.8f}\n"
        f"  from_y = {low[1] - TIP:.8f}\n  to_y = {high[1] + TIP:.8f}\n  {effect}\n/\n"
    )


def boundaries(nodes, weight, factor):
    """The held base, and the tractions on each edge of the two cuts."""
    text = "".join(box(node, node, "displacement = 'fixed'") for node in nodes[0])
    along = np.array([math.cos(SLOPE), math.sin(SLOPE)])
    normal = np.array([-math.sin(SLOPE), math.cos(SLOPE)])
    for column, outward in ((0, -1.0), (-1, 1.0)):
        for low, high in zip(nodes[:-1, column], nodes[1:, column]):
            depth = nodes[-1, column, 1] - 0.5 * (low[1] + high[1])
            across, shear = weight * depth * math.cos(SLOPE) * np.array([normal[1], along[1]])
            lengthwise = across + 2.0 * shear * TAN_PHI / factor
            stress = (
                -across * np.outer(normal, normal)
                - lengthwise * np.outer(along, along)
                - shear * (np.outer(normal, along) + np.outer(along, normal))
            )
            x, y = outward * stress[:, 0]
            text += box(low, high, f"traction_x = {x:.6f}\n  traction_y = {y:.6f}")
    return text


def run(rows, suction, weight):
    name = f"rows_{rows}_suction_{suction / 1e3:.0f}"
    place = case.scratch / name
    place.mkdir(parents=True, exist_ok=True)
    nodes = mesh(rows)
    (place / "slab.mesh").write_text(mesh_text(nodes))
    exact = closed_form(weight, suction)
    return case.run(
        "slab.nml",
        [
            ("suction = 20.0e3", f"suction = {suction}"),
            ("&stage\n  name = 'gravity'", boundaries(nodes, weight, exact) + "&stage\n  name = 'gravity'"),
            (
                "kind = 'strength_reduction'",
                "kind = 'strength_reduction'\n  factor_tolerance = 0.002\n  factor_first = 1.1",
            ),
        ],
        name=name,
    )


def unit_weight(suction):
    """Of soil with Gardner's saturation exp(-alpha s/gamma_w) and water of 9810 N/m3."""
    return 0.6 * 2650.0 * 9.81 + 0.4 * math.exp(-0.3 * suction / 9810.0) * 9810.0


def factor_at(rows, suction):
    """Factor of safety found and exact, and the run."""
    weight = unit_weight(suction)
    exact = closed_form(weight, suction)
    result = run(rows, suction, weight)
    dry = abs(result.field("saturation") / math.exp(-0.3 * suction / 9810.0) - 1).max()
    case.check("saturation is that of the unit weight", dry, 1e-3, "table of the retention curve")
    factor = float(result.summary["factor_of_safety"])
    print(
        f"     suction {suction / 1e3:.0f} kPa, {rows} rows: factor {factor:.4f}, closed form {exact:.4f}, "
        f"error {factor / exact - 1:+.4f}; {result.summary['factor_trials']} trials"
    )
    return factor, exact, result


SUCTIONS, ROWS = ((20.0e3, 40.0e3), (12, 24, 48)) if case.full else ((20.0e3,), (6, 12))
found = {rows: {} for rows in ROWS}
for suction in SUCTIONS:
    errors = []
    for rows in ROWS:
        found[rows][suction], exact, result = factor_at(rows, suction)
        errors.append(found[rows][suction] / exact - 1)
        case.study(f"suction {suction / 1e3:.0f} kPa", result, DEPTH / rows, abs(errors[-1]))
    if case.full:
        case.target(
            f"error of the factor at {suction / 1e3:.0f} kPa, {rows} rows", abs(errors[-1]), 0.01, "S3"
        )
    case.check(
        f"suction {suction / 1e3:.0f} kPa: error over that of half the rows",
        errors[-1] / errors[-2],
        0.65,
        "first order, and the width of the bracket",
    )
if case.full:
    for suction in (10.0e3, 60.0e3):
        found[24][suction] = factor_at(24, suction)[0]
    suctions = np.linspace(10.0e3, 60.0e3, 51)
    case.picture(
        "suction",
        "suction [kPa]",
        "factor of safety [-]",
        {
            "closed form": (suctions / 1e3, [closed_form(unit_weight(s), s) for s in suctions]),
            **{
                f"{rows} rows": (
                    np.array(sorted(found[rows])) / 1e3,
                    [found[rows][s] for s in sorted(found[rows])],
                    "o",
                )
                for rows in (24, 48)
            },
        },
    )
sys.exit(case.verdict())
