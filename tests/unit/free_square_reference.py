#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lowest frequencies of a free elastic unit square in plane strain (E = rho = 1, nu = 0.3).

Reference of test_talus_spectrum.pf, by a method that shares nothing with TALUS: nine-node
quadrilaterals with consistent mass and 3 x 3 Gauss points. Prints omega^2 of the first modes after
the three rigid ones for finer and finer grids. Needs numpy and scipy.
"""

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

NU = 0.3
LAME, SHEAR = NU / ((1 + NU) * (1 - 2 * NU)), 1 / (2 * (1 + NU))
ELASTIC = np.array([[LAME + 2 * SHEAR, LAME, 0], [LAME, LAME + 2 * SHEAR, 0], [0, 0, SHEAR]])


def element(h):
    """Stiffness and mass of one square element with sides h."""
    points, weights = np.polynomial.legendre.leggauss(3)
    stiffness, mass = np.zeros((18, 18)), np.zeros((18, 18))
    for xi, wx in zip(points, weights):
        for eta, wy in zip(points, weights):

            def line(s):
                return (
                    np.array([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2]),
                    np.array([s - 0.5, -2 * s, s + 0.5]) * 2 / h,
                )

            (nx, dx), (ny, dy) = line(xi), line(eta)
            value = np.outer(ny, nx).ravel()
            strain = np.zeros((3, 18))
            strain[0, 0::2] = strain[2, 1::2] = np.outer(ny, dx).ravel()
            strain[1, 1::2] = strain[2, 0::2] = np.outer(dy, nx).ravel()
            area = wx * wy * h * h / 4
            stiffness += area * strain.T @ ELASTIC @ strain
            mass += area * np.kron(np.outer(value, value), np.eye(2))
    return stiffness, mass


def frequencies(cells):
    """omega^2 of the modes 4 to 8 on a grid of cells x cells elements."""
    side = 2 * cells + 1
    stiffness, mass = element(1 / cells)
    rows, columns, k, m = [], [], [], []
    for j in range(cells):
        for i in range(cells):
            nodes = [(2 * j + b) * side + 2 * i + a for b in range(3) for a in range(3)]
            freedoms = np.array([2 * n + d for n in nodes for d in range(2)])
            rows.append(np.repeat(freedoms, 18))
            columns.append(np.tile(freedoms, 18))
            k.append(stiffness.ravel())
            m.append(mass.ravel())
    index = (np.concatenate(rows), np.concatenate(columns))
    size = 2 * side * side
    k = sp.csc_matrix((np.concatenate(k), index), (size, size))
    m = sp.csc_matrix((np.concatenate(m), index), (size, size))
    return np.sort(sla.eigsh(k, 8, m, sigma=-0.1, return_eigenvectors=False))[3:]


if __name__ == "__main__":
    for cells in (4, 8, 16, 32):
        print(cells, " ".join(f"{w:.6f}" for w in frequencies(cells)))
