# SPDX-License-Identifier: MIT
"""Constant rain on a dry, deep column: the exact solution of Broadbridge and White (1988).

Their transform turns dTheta/dt = d/dz(D dTheta/dz) - dK/dz into the heat equation u_tau = u_zetazeta/4 on
zeta > 0, with u = exp(2 rho zeta) at the start (dry soil) and u = exp(rho (rho + 1) tau) at zeta = 0 (the
rain). u is solved here with the heat kernel and its image; theta and depth follow from it as parameters
of zeta. Checked against the published table by check.py.
"""

import math

import numpy as np

C_PARAMETER, RAIN = 1.5, 0.5  # C, and rain over the conductivity of full saturation
LENGTH = 2.0  # the deck's D is twice that of unit capillary length, so lengths and times double

erfc = np.vectorize(math.erfc)


def exact_theta(time, depth):
    """Theta (0 dry, 1 full) at depths, at a time, both in the units of the deck's comment."""
    m = 4 * C_PARAMETER * (C_PARAMETER - 1)
    rho, tau = RAIN / m, m * time / LENGTH
    a, r = rho * (rho + 1), math.sqrt(tau)
    b = math.sqrt(a)
    zeta = np.linspace(0.0, 12.0, 12001)

    def u(z):
        start = np.exp(2 * rho * z) * erfc(-z / r - rho * r) - np.exp(-2 * rho * z) * erfc(z / r - rho * r)
        rain = np.exp(-2 * b * z) * erfc(z / r - b * r) + np.exp(2 * b * z) * erfc(z / r + b * r)
        return 0.5 * (np.exp(rho**2 * tau) * start + np.exp(a * tau) * rain)

    slope = (u(zeta + 1e-5) - u(zeta - 1e-5)) / 2e-5
    z = LENGTH / C_PARAMETER * (a * tau + (2 * rho + 1) * zeta - np.log(u(zeta)))
    theta = C_PARAMETER * (1 - 1 / (2 * rho + 1 - slope / u(zeta)))
    return np.interp(depth, z, theta)
