# SPDX-License-Identifier: MIT
"""D3, biaxial compression of a softening sample with a weak seed: one shear band.

A sample of 1 x 2 m (phi = 30, psi = 10, cohesion softening from 50 to 25 kPa) between smooth platens. The
literature puts the inclination of its band between 45 + psi/2 (Roscoe) and 45 + phi/2 degrees (Coulomb); see
Vardoulakis 1980. With two-level smoothing of fixed length ell = 0.2 m peak load and width of the band agree
over h = ell/4, /6 and /8; with one level the band is as wide as the spacing allows.

The band is measured from the plastic strain at the end, in the reference configuration, over the middle
60 % of the width, free of seed and edges. Weights are the strain in excess of the median (the homogeneous
strain before the band), where it is above a tenth of its maximum, times the cell. Inclination: the principal
axis of these weights with the larger moment. Width: that of the rectangle with their second moment across the
axis. The load is the mean vertical stress by the divergence theorem, the integral of stress over the area.
"""

import math
import sys

import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="D3",
    title="Biaxial compression: inclination and width of a shear band",
    error="relative difference of the width of the band from that at h = ell/8, two levels",
    reference="between 45 + psi/2 (Roscoe) and 45 + phi/2 degrees (Coulomb), after Vardoulakis 1980",
)
LENGTH, HEIGHT, PHI, PSI = 0.2, 2.0, 30.0, 10.0
TWO = f"levels = 2\n  length = {LENGTH}"


def plastic_band(result):
    """Centre [m], direction and width [m] of the band, and the weights' base and peak strain."""
    strain, x = result.field("plastic_strain"), result.nodes
    inner = abs(x[:, 0] - 0.5) < 0.3 + 1e-9
    base, peak = np.median(strain[inner]), strain[inner].max()
    excess = np.where(inner & (strain > base + 0.1 * (peak - base)), strain - base, 0.0)
    weight = excess * result.area / np.sum(excess * result.area)
    centre = weight @ x
    moment, axes = np.linalg.eigh(np.einsum("i,ij,ik->jk", weight, x - centre, x - centre))
    along = axes[:, 1] * np.sign(axes[1, 1])
    return centre, along, math.sqrt(12.0 * moment[0])


class Sample:
    """One run and what it tells."""

    def __init__(self, levels, parts):
        self.spacing = LENGTH / parts
        smoothing = [(TWO, "levels = 1")] if levels == 1 else []
        self.result = case.run(
            "biaxial.nml",
            [("spacing = 0.05", f"spacing = {self.spacing:.10f}"), *smoothing],
            name=f"level_{levels}_{parts}",
        )
        names = self.result.snapshots()
        stress = [self.result.field("stress", name)[:, 1] for name in names]
        self.load = np.array([-np.sum(s * self.result.area) / HEIGHT for s in stress])
        self.shortening = np.array(
            [-self.result.field("displacement", name)[:, 1].min() / HEIGHT for name in names]
        )
        self.peak = self.load.max()
        self.centre, self.along, self.width = plastic_band(self.result)
        self.inclination = math.degrees(math.atan2(self.along[1], abs(self.along[0])))
        print(
            f"     {levels} level(s), h = {self.spacing:.4f} m: peak {self.peak / 1e3:.3f} kN/m, "
            f"band {self.inclination:.2f} degrees, {self.width:.4f} m wide"
        )

    def profile(self):
        """Plastic strain over the distance from the axis of the band, near its centre."""
        offset = self.result.nodes - self.centre
        across = offset @ np.array([-self.along[1], self.along[0]])
        near = (abs(offset @ self.along) < 0.15) & (abs(across) < 0.3)
        order = np.argsort(across[near])
        return across[near][order], self.result.field("plastic_strain")[near][order]


PARTS = (4, 6, 8) if case.full else (4,)
two = [Sample(2, parts) for parts in PARTS]
one = [Sample(1, parts) for parts in PARTS]
for sample in two:
    case.target(
        f"inclination of the band at h = {sample.spacing:.4f} m [degrees]",
        sample.inclination,
        45.0 + PHI / 2.0,
        "D3: Roscoe to Coulomb",
        low=45.0 + PSI / 2.0,
        asked=True,
    )
case.check_true("the load has passed its peak", two[0].load[-1] < 0.8 * two[0].peak)
case.check("one level over two, width at h = ell/4", one[0].width / two[0].width, 0.7, "no length of its own")

if case.full:
    finest = two[-1]
    for sample in (two[0], Sample(2, 5), two[1]):
        case.study(
            "two levels, ell = 0.2 m", sample.result, sample.spacing, abs(sample.width / finest.width - 1.0)
        )
    peaks, widths = np.array([[s.peak, s.width] for s in two]).T
    case.target(
        "spread of the peak load over three meshes",
        np.ptp(peaks) / peaks[-1],
        0.01,
        "D3: converged",
        asked=True,
    )
    case.target(
        "spread of the width over three meshes",
        np.ptp(widths) / widths[-1],
        0.10,
        "as of the softening bar",
        asked=True,
    )
    case.target(
        "change of the width between the last two", abs(widths[-1] / widths[-2] - 1), 0.03, "converged"
    )
    shrunk = one[-1].width / one[0].width
    case.remedy(
        "a shear band without a length of its own; remedy: smoothing over a fixed length (levels = 2)",
        "one level: width " + ", ".join(f"{1e3 * s.width:.0f}" for s in one) + " mm and end load "
        + ", ".join(f"{s.load[-1] / 1e3:.0f}" for s in one) + " kN/m for h = ell/4, /6, /8",
        "two levels: width " + ", ".join(f"{1e3 * s.width:.0f}" for s in two) + " mm and end load "
        + ", ".join(f"{s.load[-1] / 1e3:.0f}" for s in two) + " kN/m",
        shrunk < 0.65,
    )  # fmt: skip
    case.picture(
        "Load over shortening",
        "Shortening [%]",
        "Load [kN/m]",
        {
            **{f"two levels, h = ell/{p}": (100 * s.shortening, s.load / 1e3) for p, s in zip(PARTS, two)},
            **{
                f"one level, h = ell/{p}": (100 * s.shortening, s.load / 1e3, "--")
                for p, s in zip(PARTS, one)
            },
        },
    )
    case.picture(
        "Plastic strain across the band",
        "Distance from the axis of the band [m]",
        "Plastic strain [-]",
        {
            **{f"two levels, h = ell/{p}": (*s.profile(), ".") for p, s in zip(PARTS, two)},
            **{f"one level, h = ell/{p}": (*s.profile(), "x") for p, s in zip(PARTS, one)},
        },
    )
sys.exit(case.verdict())
