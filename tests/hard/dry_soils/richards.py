# SPDX-License-Identifier: MIT
"""Richards' equation in a column by backward Euler and Picard's iteration (Celia et al. 1990), in numpy.

It shares nothing with TALUS but the soils. In mixed form with lumped storage it makes the reference of
this case (`python richards.py > fronts.csv`, some minutes); head form and consistent storage go wrong.
"""

import numpy as np
from scipy.linalg import solve_banded

SOILS = {  # conductivity [m/s], alpha [1/m], n, cut [m], residual and saturated water content, head [m]
    "loamy_sand": (6.26e-5, 2.8, 2.239, 0.0, 0.0286, 0.3658, -1000.0, 2400.0),
    "sand": (1.0e-4, 4.0, 7.0, 0.0, 0.04, 0.40, -10.0, 1600.0),
    "clay": (5.5556e-7, 0.8, 1.09, 0.02, 0.068, 0.38, -100.0, 80000.0),
}
STORAGE = 9.81e-6  # specific storage [1/m]: 1e-9 /Pa


def curves(soil, psi):
    """Water content, its slope and conductivity at pressure heads; law cut at the air entry."""
    k_sat, alpha, n, cut, dry, wet = SOILS[soil][:6]
    m = 1 - 1 / n
    suction = np.maximum(-psi, cut)
    full = (1 + (alpha * cut) ** n) ** -m
    root = 1 / (1 + (alpha * suction) ** n)  # S^(1/m)
    s = root**m / full
    slope = np.where(-psi > cut, m * n * alpha * (alpha * suction) ** (n - 1) * root ** (m + 1) / full, 0.0)
    top = -np.expm1(m * np.log1p(-np.minimum(root, 1 - 1e-16)))
    most = -np.expm1(m * np.log1p(-min(full ** (1 / m), 1 - 1e-16)))
    k = np.where(-psi > cut, np.sqrt(s) * (top / most) ** 2, 1.0)
    theta = dry + (wet - dry) * s + STORAGE * np.maximum(psi + cut, 0)
    return theta, (wet - dry) * slope + STORAGE * (psi > -cut), k_sat * (1e-12 + (1 - 1e-12) * k)


def infiltrate(soil, spacing, form="mixed", lumped=True, change=0.01, dt=None):
    """Water stands on a dry column of 1 m. Returns depth, psi, theta and inflow less stored over inflow."""
    rows = round(1 / spacing) + 1
    psi = np.full(rows, SOILS[soil][6])
    psi[0] = 0.0
    end, time, step = SOILS[soil][7], 0.0, dt or 1e-3
    share = np.full(rows, spacing)
    share[[0, -1]] /= 2
    # Storage couples neighbours where it is consistent: rows of (1, 4, 1)/6.
    mass = np.zeros((3, rows))
    mass[1] = share if lumped else share * 2 / 3
    mass[0, 1:] = mass[2, :-1] = 0 if lumped else spacing / 6
    theta = curves(soil, psi)[0]
    start, entered = times(mass, theta).sum(), 0.0
    while time < end * (1 - 1e-12):
        step = min(step, end - time)
        new, done = psi.copy(), False
        for _ in range(25):
            now, c, k = curves(soil, new)
            face = (k[1:] + k[:-1]) / 2
            flux = face * ((new[:-1] - new[1:]) / spacing + 1)
            net = np.zeros(rows)
            net[:-1] += flux
            net[1:] -= flux
            old = times(mass, now - theta) if form == "mixed" else times(mass, c * (new - psi))
            matrix = mass * c[None, :] / step
            matrix[1, :-1] += face / spacing
            matrix[1, 1:] += face / spacing
            matrix[0, 1:] -= face / spacing
            matrix[2, :-1] -= face / spacing
            right = -(old / step + net)
            matrix[1, [0, -1]], matrix[0, 1], matrix[2, -2], right[[0, -1]] = 1, 0, 0, 0
            correction = solve_banded((1, 1), matrix, right)
            new += correction
            done = np.abs(correction / (1 + np.abs(new))).max() < 1e-7
            if done or not np.isfinite(new).all():
                break
        after = curves(soil, new)[0]
        moved = np.abs(after - theta)[1:].max()
        if dt is None and (not done or moved > 2 * change):
            step /= 2 if done else 4
            continue
        # What entered at both ends: the flux at the face next to each, and what the end cell stored.
        stored = (
            times(mass, after - theta) if form == "mixed" else times(mass, curves(soil, new)[1] * (new - psi))
        )
        entered += step * (flux[0] - flux[-1]) + stored[0] + stored[-1]
        time += step
        psi, theta = new, after
        if dt is None:
            step *= min(1.5, change / max(moved, 1e-9))
    stored = times(mass, theta).sum() - start
    return np.linspace(0, 1, rows), psi, theta, (entered - stored) / entered


def times(band, x):
    """A tridiagonal matrix in bands times a vector."""
    y = band[1] * x
    y[:-1] += band[0, 1:] * x[1:]
    y[1:] += band[2, :-1] * x[:-1]
    return y


def front(depth, theta, soil):
    """Depth of the mean of the initial and the saturated water content [m]."""
    first = curves(soil, np.array([SOILS[soil][6]]))[0][0]
    half = (first + SOILS[soil][5]) / 2
    i = int(np.argmax(theta < half))
    return float(np.interp(half, [theta[i], theta[i - 1]], [depth[i], depth[i - 1]]))


if __name__ == "__main__":
    print(
        "# soil, depth of the front [m] at spacings of 1 and 0.5 mm; mixed form, lumped storage, steps that"
    )
    print("# change the water content by 0.004; made by richards.py")
    for name in SOILS:
        depths = []
        for spacing in (0.001, 0.0005):
            depth, _, theta, _ = infiltrate(name, spacing, change=0.004)
            depths.append(front(depth, theta, name))
        print(f"{name},{depths[0]:.6f},{depths[1]:.6f}", flush=True)
