# SPDX-License-Identifier: MIT
"""M6, Drucker-Prager at collapse in plane strain: friction recovered in the plane is phi.

A block between smooth plates is confined and compressed, slowly and in real time, until its stress no
longer changes. There sin(phi) = (s1 - s3)/(s1 + s3 + 2 c cot(phi)) of the stress of its nodes, whatever
the intermediate stress (benchmarks.md M6). The fit `plane_strain` is matched for the
angle of dilation that the deck gives, associated or not (src/THEORY.md (3.7)): <= 0.2 % in tan(phi). The
other cones are run to show what they give: `compression` is far on the unsafe side.

At up to 25 nodes the block stays homogeneous. At 81, one level and psi = 0, it finds bands before it
collapses, and its mean stress is no longer that of a point; the second level prevents that.

Stress is the mean over the cells, averaged over the last fifth of the run. Real time, not a storm of
equilibria: a relaxation that overshoots leaves soil just inside its cone, the more so the longer the
storm step, so a limit load is read while the soil flows.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

DURATION, RATE = 20.0, 1.0e-3
#         phi, cohesion in Pa, pressure in Pa
SOILS = ((30, 10e3, 100e3), (20, 0.0, 100e3), (40, 5e3, 50e3), (30, 0.0, 400e3), (20, 50e3, 20e3))

case = Case(
    __file__.rsplit("/", 1)[0],
    id="M6",
    title="Drucker-Prager at collapse in plane strain",
    error="|tan(phi) recovered / tan(phi) - 1|",
    reference="Mohr-Coulomb: sin(phi) = (s1 - s3)/(s1 + s3 + 2 c cot(phi))",
)


def compress(soil, dilation, fit="plane_strain", spacing=0.5, smoothing="levels = 1"):
    """Result, axial strains and the ratio of tan(phi) recovered to tan(phi) over the run."""
    phi, cohesion, pressure = np.radians(soil[0]), soil[1], soil[2]
    passive = np.tan(np.pi / 4 + phi / 2)
    strength = pressure * passive**2 + 2 * cohesion * passive
    result = case.run(
        "biaxial.nml",
        [
            ("spacing = 0.25", f"spacing = {spacing}"),
            ("levels = 1", smoothing),
            # As stiff as needed to reach collapse within the same strain.
            ("youngs_modulus = 1.0e8", f"youngs_modulus = {300 * strength}"),
            ("cohesion = 10.0e3", f"cohesion = {cohesion}"),
            ("friction_angle = 30.0", f"friction_angle = {soil[0]}.0"),
            ("dilation_angle = 0.0", f"dilation_angle = {dilation}.0"),
            ("pressure = 100.0e3", f"pressure = {pressure}"),
            ("fit = 'plane_strain'", f"fit = '{fit}'"),
        ],
    )
    names = result.snapshots()[2:]
    share = result.area / result.area.sum()
    stress = np.array([share @ result.field("stress", name) for name in names])
    least, most = -stress[:, 0], -stress[:, 1]
    sine = (most - least) / (most + least + 2 * cohesion / np.tan(phi))
    ratio = np.tan(np.arcsin(np.clip(sine, -1, 0.999))) / np.tan(phi)
    return result, np.linspace(0, DURATION * RATE, len(names)), ratio


def last(ratio):
    return ratio[-len(ratio) // 5 :].mean()


curves = {}
recovered = {}
for dilation in (0, 10):
    worst = 0.0
    for spacing in (1.0, 0.5, 0.25) if case.full else (0.5,):
        result, strain, ratio = compress(SOILS[0], dilation, spacing=spacing)
        recovered[dilation] = last(ratio)
        worst = max(worst, abs(last(ratio) - 1))
        case.study(f"psi = {dilation}, phi = 30, c = 10 kPa, 100 kPa", result, spacing, abs(last(ratio) - 1))
    curves[f"plane strain cone, psi = {dilation}"] = (100 * strain, ratio)
    for soil in SOILS[1:] if case.full else SOILS[1:2]:
        result, strain, ratio = compress(soil, dilation)
        worst = max(worst, abs(last(ratio) - 1))
        what = f"psi = {dilation}, phi = {soil[0]}, c = {soil[1] / 1e3:g} kPa, {soil[2] / 1e3:g} kPa"
        case.study(what, result, 0.5, abs(last(ratio) - 1))
    case.target(
        f"tan(phi) recovered, psi = {dilation}, worst of all soils", worst, 0.002, "required, M6", asked=True
    )
for fit in ("compression", "extension") if case.full else ("compression",):
    result, strain, ratio = compress(SOILS[0], 0, fit)
    curves[f"{fit} cone, psi = 0"] = (100 * strain, ratio, "--")
    case.remedy(
        f"cone through the {fit} corners of the pyramid instead of one matched in plane strain",
        f"tan(phi) {100 * (last(ratio) - 1):+.1f} %",
        f"{100 * (recovered[0] - 1):+.2f} %",
        abs(last(ratio) - 1) > 0.005,
    )
if case.full:
    # Plane strain without dilation may localise before collapse, as soon as the nodes are close enough.
    strengths = {}
    for name, smoothing in {"one level": "levels = 1", "two levels": "levels = 2\n  length = 0.5"}.items():
        result, strain, ratio = compress(SOILS[0], 0, spacing=0.125, smoothing=smoothing)
        strengths[name] = last(ratio)
        case.study(f"psi = 0, close nodes, {name}", result, 0.125, abs(last(ratio) - 1))
        curves[f"{name}, psi = 0, 81 nodes"] = (100 * strain, ratio, ":")
    case.remedy(
        "block of 81 nodes that bifurcates into bands before collapse: second level, ell = 0.5 m",
        f"tan(phi) of the mean stress {100 * (strengths['one level'] - 1):+.1f} %",
        f"{100 * (strengths['two levels'] - 1):+.2f} %",
        abs(strengths["one level"] - 1) > 0.005 and abs(strengths["two levels"] - 1) < 0.002,
    )
case.picture(
    "Friction mobilised in the plane", "Axial strain [%]", "tan(phi) recovered / tan(phi) [-]", curves
)
sys.exit(case.verdict())
