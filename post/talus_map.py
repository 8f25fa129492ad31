# SPDX-License-Identifier: MIT
"""Draw a nodal field as a map of the nodal cells, on the reference or the deformed shape."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize, TwoSlopeNorm
from matplotlib.ticker import MaxNLocator

from talus_result import ResultError
from talus_style import GREY, INK, axis_label, display_units, finite_range, look_of

FROM_ZERO = ("damage", "plastic_strain", "opening", "displacement", "velocity", "seepage_velocity")


class FieldScale:
    """One colour scale and one unit for a field over some snapshots."""

    def __init__(self, result, field, snapshots, limits=None):
        self.field = field
        look = look_of(field)
        low, high = finite_range(result.field(field, s) for s in snapshots)
        self.factor, self.units = display_units(result.units(field, snapshots[-1]), max(abs(low), abs(high)))
        low, high = low * self.factor, high * self.factor
        if look.signed:
            high = max(abs(low), abs(high))
            low = -high
        elif field in FROM_ZERO:
            low, high = 0.0, (1.0 if field == "damage" else high)
        if limits is not None:
            low, high = limits
        if not high - low > 1e-12 * max(abs(low), abs(high), 1e-30):
            high = low + max(abs(low), 1.0) * 1e-3
        if look.split:
            reach = 0.05 * max(abs(low), abs(high))
            self.norm = TwoSlopeNorm(0.0, min(low, -reach), max(high, reach))
        else:
            self.norm = Normalize(low, high)
        self.span = low, high
        self.colours = plt.get_cmap(look.colours)
        self.label = axis_label(field, self.units)
        self.clipped = limits is not None

    def values(self, result, snapshot):
        """Nodal values in the units of the scale."""
        return result.field(self.field, snapshot) * self.factor

    def add_bar(self, figure, cells, **place):
        """Colour bar with its label, as long as the data; a line marks zero where maps have one."""
        bar = figure.colorbar(cells, label=self.label, extend="both" if self.clipped else "neither", **place)
        bar.outline.set_linewidth(0.7)
        if isinstance(self.norm, TwoSlopeNorm):
            low, high = self.span
            bar.ax.axhline(0.0, color=INK, linewidth=1.0)
            ticks = np.zeros(1)
            # No tick but zero on a side that is too short for one.
            if low <= self.norm.vmin:
                ticks = np.union1d(ticks, MaxNLocator(4).tick_values(low, min(high, 0.0)))
            if high >= self.norm.vmax:
                ticks = np.union1d(ticks, MaxNLocator(3).tick_values(max(low, 0.0), high))
            ticks = ticks[(ticks >= low) & (ticks <= high)]
            bar.ax.set_ylim(low, high)
            bar.set_ticks(ticks, labels=[f"{tick:.4g}".replace("-", "\u2212") for tick in ticks])
            bar.ax.minorticks_off()
        return bar


class FieldMap:
    """A map in an axes, which can be moved on to another snapshot."""

    def __init__(self, axes, result, scale, deformed=1.0):
        self.axes, self.result, self.scale, self.deformed = axes, result, scale, deformed
        edges, shared = result.edges
        self._outline = edges[shared == 1]
        self._contour = None
        self._cells = PolyCollection(
            [],
            cmap=scale.colours,
            norm=scale.norm,
            edgecolors="none",
            antialiased=False,
            rasterized=True,
        )
        self._border = LineCollection([], colors=INK, linewidths=0.8, capstyle="round")
        axes.add_collection(
            LineCollection(
                result.nodes[self._outline],
                colors=GREY,
                linewidths=0.7,
                linestyles=(0, (4, 2)),
                zorder=0.5,
            )
        )
        axes.add_collection(self._cells)
        axes.add_collection(self._border)
        axes.set_aspect("equal")
        width, height = np.ptp(result.nodes, axis=0)
        few = int(np.clip(7 * width / height, 1, 7))
        axes.xaxis.set_major_locator(MaxNLocator(few, steps=[1, 2, 5, 10], min_n_ticks=1))
        axes.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))

    def show(self, snapshot):
        """Draw a snapshot in place of the one shown."""
        positions = self.result.positions(snapshot, self.deformed)
        values = self.scale.values(self.result, snapshot)
        self._cells.set_verts(self.result.cell_shapes.at(positions))
        self._cells.set_array(values)
        self._border.set_segments(positions[self._outline])
        if self._contour is not None:
            self._contour.remove()
            self._contour = None
        if isinstance(self.scale.norm, TwoSlopeNorm):
            triangles = self.result.triangles()
            values = sided(values, triangles)
            if values.min() < 0.0 <= values.max():
                self._contour = self.axes.tricontour(
                    *positions.T, triangles, values, [0.0], colors=[INK], linewidths=1.0
                )
        return self._cells


def sided(values, triangles):
    """Values whose contour at zero (a side of it is >= 0) is free of round-off, and not shifted.

    What is zero to round-off is zero, on the side of the positive values where it touches one and else
    just below: no line follows a seepage face, or a wet surface over suction.
    """
    tiny = 1e-9 * np.abs(values).max()
    values = np.where(np.abs(values) > tiny, values, 0.0)
    wettest = np.full(len(values), -np.inf)
    np.maximum.at(wettest, triangles, values[triangles].max(axis=1, keepdims=True))
    return np.where((values == 0.0) & (wettest <= 0.0), -tiny, values)


def view_of(result, snapshots, deformed):
    """Limits ((x0, x1), (y0, y1)) that hold the body in all these snapshots, with a margin."""
    points = [result.nodes] + [result.positions(s, deformed) for s in snapshots]
    low = np.min([np.nanmin(p, axis=0) for p in points], axis=0)
    high = np.max([np.nanmax(p, axis=0) for p in points], axis=0)
    margin = 0.02 * (high - low).max()
    return (low[0] - margin, high[0] + margin), (low[1] - margin, high[1] + margin)


def map_size(view, width, height):
    """Size (width, height) of one map [inch] that fits into the given one."""
    (x0, x1), (y0, y1) = view
    slope = (y1 - y0) / (x1 - x0)
    across = min(width, height / slope)
    return across, across * slope


def default_field(result):
    """The field that tells most about a failure, of those stored."""
    for name in ("damage", "plastic_strain", "displacement", "pore_pressure"):
        if result.has(name) and np.ptp(result.field(name, result.snapshot())) > 0.0:
            return name
    for name in result.fields(result.snapshot()):
        if result.has(name):
            return name
    raise ResultError(f"{result.path}: no field to draw")


def add_map_options(parser):
    """Command-line options of every map."""
    parser.add_argument("--field", help="stored field or component, e.g. damage, stress_xy, displacement_x")
    shape = parser.add_mutually_exclusive_group()
    shape.add_argument(
        "--deformed",
        type=float,
        default=1.0,
        metavar="SCALE",
        help="draw positions + SCALE * displacement (1)",
    )
    shape.add_argument(
        "--reference",
        action="store_const",
        dest="deformed",
        const=0.0,
        help="draw the reference shape",
    )
    parser.add_argument(
        "--limits",
        type=float,
        nargs=2,
        metavar=("LOW", "HIGH"),
        help="ends of the colour scale, in its units",
    )


def shape_note(deformed):
    """What the reader must know about the shape drawn."""
    if deformed == 0.0:
        return "reference shape"
    if deformed == 1.0:
        return ""
    return f"displacements × {deformed:g}"
