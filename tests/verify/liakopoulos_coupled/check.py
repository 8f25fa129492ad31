# SPDX-License-Identifier: MIT
"""H5 with a deformable skeleton: drainage of Liakopoulos' column, E = 1.3 MPa, nu = 0.4, rho_s = 2000 kg/m3.

OpenGeoSys 6.5.9 (Richards mechanics, 80 rows, benchmarks.md) has at 7200 s at the top a pressure of -9231 Pa,
a saturation of 0.9164 and a settlement of 1.56 mm. The same column with a rigid skeleton runs beside it.
"""

import pathlib
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from talus_case import Case  # noqa: E402

THEIRS = {"pressure": -9231.0, "saturation": 0.9164, "settlement": 1.56e-3}
MODULUS = 1.3e6 * 0.6 / (1.4 * 0.2)

case = Case(
    pathlib.Path(__file__).parent,
    id="H5",
    title="Liakopoulos' column with a deformable skeleton",
    error="relative difference of the pressure at the top at 7200 s from OpenGeoSys 6.5.9",
    reference="OpenGeoSys 6.5.9, Richards mechanics, 80 rows (benchmarks.md)",
)


def top_history(result):
    """Times, mean pressure, saturation and settlement of the top in the drainage."""
    top = result.nodes[:, 1] > 1 - 1e-6
    rows = []
    with h5py.File(result.path) as file:
        for name in result.snapshots():
            group = file["snapshots"][name]
            stage = group.attrs["stage"]
            if (stage.decode() if isinstance(stage, bytes) else stage) != "drainage":
                continue
            sunk = -group["displacement"][:, 1][top].mean() if "displacement" in group else 0.0
            pressure, saturation = (group[name][:][top].mean() for name in ("pore_pressure", "saturation"))
            rows.append((group.attrs["time"], pressure, saturation, sunk))
    return np.array(rows)


def by_hand(result):
    """Settlement that the final pressures ask for: relief of weight and suction over the modulus.

    d sigma'_yy = d sigma_yy + d(chi p); the column starts saturated at p = 0.
    """
    y, pressure, saturation = result.nodes[:, 1], result.field("pore_pressure"), result.field("saturation")
    rows = np.unique(np.round(y, 6))
    at = [np.abs(y - row) < 1e-6 for row in rows]
    s, p = (np.array([field[a].mean() for a in at]) for field in (saturation, pressure))
    lost = 0.2975 * 9810.0 * (1 - s)
    relief = np.array([np.trapezoid(lost[k:], rows[k:]) for k in range(len(rows))])
    lowest = 0.00524354438071
    chi = np.where(p < 0, (s - lowest) / (1 - lowest), 1.0)
    return np.trapezoid(-chi * p - relief, rows) / MODULUS


last, curves = {}, {}
for rows in (11, 21, 41) if case.full else (11,):
    spacing = 1 / (rows - 1)
    change = [("width = 0.05", f"width = {spacing}"), ("spacing = 0.05", f"spacing = {spacing}")]
    result = case.run("coupled.nml", change, name=f"rows_{rows}")
    story = top_history(result)
    last = dict(zip(("pressure", "saturation", "settlement"), story[-1, 1:]))
    case.study(
        "two columns of nodes, coupled", result, spacing, abs(last["pressure"] / THEIRS["pressure"] - 1)
    )
    for name, theirs in THEIRS.items():
        off = last[name] / theirs - 1
        case.note(f"{rows} rows: {name} {last[name]:.6g}, OpenGeoSys {theirs:.6g}, difference {off:+.2%}.")
    case.check(f"{rows} rows: water error", abs(float(result.summary["water_error"])), 1e-12, "round-off")
    left = float(result.summary["coupling_error"])
    case.check(f"{rows} rows: pressure left to later steps", left, 1e-2, "src/THEORY.md section 5.6")
for name, theirs in THEIRS.items():
    case.target(
        f"{name} at the top at 7200 s, difference from OpenGeoSys",
        abs(last[name] / theirs - 1),
        0.05,
        "our own limit",
        asked=True,
    )
case.target(
    "settlement against the one that the final pressures ask for",
    abs(last["settlement"] / by_hand(result) - 1),
    0.01,
    "our own: equilibrium, reckoned with small strains",
)
text = (case.folder / "coupled.nml").read_text()
weight = text[text.index("&stage") : text.index("&stage", text.index("&stage") + 1)]
rigid = case.run(
    "coupled.nml", change + [(weight, ""), ("solve = 'both'", "solve = 'seepage'")], name="rigid"
)
beside = top_history(rigid)
case.picture(
    "Pressure at the top",
    "Time [s]",
    "Pore pressure [Pa]",
    {
        "coupled": (story[:, 0], story[:, 1]),
        "rigid": (beside[:, 0], beside[:, 1], "--"),
        "OpenGeoSys, coupled": ([7200.0], [THEIRS["pressure"]], "ko"),
    },
)
case.picture(
    "Settlement of the top",
    "Time [s]",
    "Settlement [mm]",
    {
        "coupled": (story[:, 0], 1e3 * story[:, 3]),
        "OpenGeoSys, coupled": ([7200.0], [1e3 * THEIRS["settlement"]], "ko"),
    },
)
case.note(f"Rigid skeleton: {beside[-1, 1]:.6g} Pa at the top at 7200 s; {beside[10, 1]:.6g} Pa at 600 s,")
case.note(f"where the coupled column, which also has to settle, has {story[10, 1]:.6g} Pa.")
sys.exit(case.verdict())
