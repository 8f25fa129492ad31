# SPDX-License-Identifier: MIT
"""D1, softening bar with a weak middle, h = ell/4, ell/8, ell/16, ell = 1 m.

Damage by the energy norm with linear softening; the bar is pulled by a boundary that moves with the
storm clock to six times the displacement at which it cracks. With two levels the work that damage
dissipates agrees within 2 % and the width of the band within 10 % over the three spacings
(benchmarks.md D1). With one level both shrink with the spacing, which is why the second level
exists. The width is that of the rectangle with the same second moment as the strain in excess of
the unloaded bar's.
"""

import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="D1",
    title="Softening bar with a weak middle",
    error="departure of the dissipated work from its mean over the spacings",
    reference="the other spacings: work within 2 %, width of the band within 10 %",
    quantity="|work / mean - 1|",
    order=False,
    work=False,
)
SPACINGS = (0.25, 0.125, 0.0625) if case.full else (0.25, 0.125)
LEVELS = {"two levels, ell = 1 m": "levels = 2\n  length = 1.0", "one level": "levels = 1"}
curves = {}


def measure(name, spacing):
    """Result, dissipated work and width of the band."""
    result = case.run(
        "bar.nml",
        [("spacing = 0.25", f"spacing = {spacing}"), ("levels = 2\n  length = 1.0", LEVELS[name])],
    )
    strain = result.field("strain")[:, 0]
    excess = np.clip(strain - np.median(strain), 0, None) * result.area
    x = result.nodes[:, 0]
    centre = np.sum(excess * x) / np.sum(excess)
    width = np.sqrt(12 * np.sum(excess * (x - centre) ** 2) / np.sum(excess))
    work = result.history()["energy_damage"][-1]
    print(
        f"     {name}, h = {spacing} m: work {work:.4g} J/m, width {width:.4g} m, "
        f"energy error {result.history()['energy_error'][-1]:.2g}"
    )
    bottom = result.nodes[:, 1] < 1e-9
    order = np.argsort(x[bottom])
    curves[f"{name}, h = ell/{round(1 / spacing)}"] = (
        x[bottom][order],
        strain[bottom][order],
        "-" if "two" in name else "--",
    )
    return result, work, width


def listed(values):
    return ", ".join(f"{value:.3g}" for value in values)


found = {}
for name in LEVELS:
    runs = [measure(name, spacing) for spacing in SPACINGS]
    found[name] = np.array([run[1:] for run in runs])
    mean = found[name][:, 0].mean()
    for spacing, (result, work, _) in zip(SPACINGS, runs):
        case.study(name, result, spacing, abs(work / mean - 1))
two, one = found.values()
case.target(
    "two levels, spread of the work", np.ptp(two[:, 0]) / two[:, 0].min(), 0.02, "required, D1", asked=True
)
case.target(
    "two levels, spread of the width", np.ptp(two[:, 1]) / two[:, 1].min(), 0.10, "required, D1", asked=True
)
ratio = one[1:] / one[:-1]
case.remedy(
    "second level of smoothing against a band that is as wide as the spacing",
    f"work {listed(one[:, 0])} J/m and width {listed(one[:, 1])} m at h = {listed(SPACINGS)} m",
    f"{listed(two[:, 0])} J/m and {listed(two[:, 1])} m",
    ratio.max() < 0.6,
)
case.picture("Strain along the bar after it cracked", "x [m]", "Strain [-]", curves)
sys.exit(case.verdict())
