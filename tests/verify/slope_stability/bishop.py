# SPDX-License-Identifier: MIT
"""Factor of safety of a dry homogeneous slope on rigid ground by Bishop's simplified method.

A. W. Bishop, The use of the slip circle in the stability analysis of slopes, Geotechnique 5 (1955) 7-17:

    F = sum( (c b + W tan(phi)) / m ) / sum(W sin(a)),   m = cos(a) + sin(a) tan(phi)/F,

over vertical slices of width b, weight W and base angle a, with the circle that gives the least F. The toe
is the origin; the ground below it is rigid, so that no circle goes below y = 0. Run alone, it prints the
factors of Griffiths & Lane's example 1 (charts of Bishop & Morgenstern 1960 for c/(gamma H) = 0.05: 1.380).
"""

import itertools
import math

import numpy as np

SLICES = 100


def factor_of_circle(cohesion, tan_friction, height, ratio, weight, low, high, sag):
    """Of the circle from `low` on the face to `high` on the ground, `sag` times the chord deep; or None."""
    chord = np.subtract(high, low)
    length = math.hypot(*chord)
    radius = length * (0.125 / sag + 0.5 * sag)
    normal = np.array([-chord[1], chord[0]]) / length
    centre = 0.5 * np.add(low, high) + (radius - sag * length) * normal
    edges = np.linspace(low[0], high[0], SLICES + 1)
    x, width = 0.5 * (edges[1:] + edges[:-1]), edges[1] - edges[0]
    inside = radius**2 - (x - centre[0]) ** 2
    if inside.min() <= 0.0:
        return None
    base = centre[1] - np.sqrt(inside)
    depth = np.minimum(x / ratio, height) - base
    if base.min() < -1e-9 * height or depth.min() < 0.0:
        return None
    sine = (x - centre[0]) / radius
    cosine = np.sqrt(1.0 - sine**2)
    load = weight * depth * width
    drive = np.sum(load * sine)
    if drive <= 0.0:
        return None
    factor = 1.0
    for _ in range(100):
        share = cosine + sine * tan_friction / factor
        if share.min() <= 0.0:
            return None
        new = np.sum((cohesion * width + load * tan_friction) / share) / drive
        if abs(new - factor) < 1e-9:
            return new
        factor = new
    return None


def factor_of_slope(cohesion, friction, height=10.0, ratio=2.0, weight=20e3):
    """Least factor over circles, by a grid that is refined about the best one. Pa, degrees, m, N/m3."""
    tangent = math.tan(math.radians(friction))
    run = ratio * height
    # Exit on the face from the toe up, entry on the face or the crest, sag over chord.
    low, high = np.array([0.0, 0.3 * run, 0.005]), np.array([0.5 * run, 2.0 * run, 0.35])
    bounds, best = (low, high), (math.inf, None)
    for _ in range(6):
        for start, end, sag in itertools.product(*(np.linspace(a, b, 13) for a, b in zip(low, high))):
            if end <= start + 0.05 * run:
                continue
            factor = factor_of_circle(
                cohesion, tangent, height, ratio, weight,
                (start, start / ratio), (end, min(end / ratio, height)), sag,
            )  # fmt: skip
            if factor is not None and factor < best[0]:
                best = (factor, np.array([start, end, sag]))
        reach = (high - low) / 6.0
        low, high = np.maximum(best[1] - reach, bounds[0]), np.minimum(best[1] + reach, bounds[1])
    return best


if __name__ == "__main__":
    for number in (0.05, 0.02, 0.01):
        found, (start, end, sag) = factor_of_slope(number * 200e3, 20.0)
        print(f"c/(gamma H) = {number}: {found:.4f}, from x = {start:.2f} to {end:.2f} m, sag {sag:.3f}")
