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

case = Case(__file__.rsplit("/", 1)[0])


def measure(levels, spacing):
    result = case.run(
        "bar.nml", [("spacing = 0.25", f"spacing = {spacing}"), ("levels = 2\n  length = 1.0", levels)]
    )
    strain = result.field("strain")[:, 0]
    excess = np.clip(strain - np.median(strain), 0, None) * result.area
    x = result.nodes[:, 0]
    centre = np.sum(excess * x) / np.sum(excess)
    width = np.sqrt(12 * np.sum(excess * (x - centre) ** 2) / np.sum(excess))
    work = result.history()["energy_damage"][-1]
    print(
        f"     {levels.split()[2]} level(s), h = {spacing} m: work {work:.4g} J/m, width {width:.4g} m, "
        f"energy error {result.history()['energy_error'][-1]:.2g}"
    )
    return work, width


two = np.array([measure("levels = 2\n  length = 1.0", h) for h in (0.25, 0.125, 0.0625)])
one = np.array([measure("levels = 1", h) for h in (0.25, 0.125, 0.0625)])
case.check("two levels, spread of the work", np.ptp(two[:, 0]) / two[:, 0].min(), 0.02, "benchmarks.md D1")
case.check("two levels, spread of the width", np.ptp(two[:, 1]) / two[:, 1].min(), 0.10, "benchmarks.md D1")
ratio = one[1:] / one[:-1]
case.check(
    "one level, work of a mesh over that of one twice as coarse",
    ratio[:, 0].max(),
    0.6,
    "it halves: the band is as wide as the spacing",
)
case.check("one level, the same of the width", ratio[:, 1].max(), 0.6, "as the work")
sys.exit(case.verdict())
