# SPDX-License-Identifier: MIT
"""Read a TALUS result file (HDF5). Layout of the file: README.md beside this module."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import h5py
import numpy as np

COMPONENTS = {2: ("x", "y"), 4: ("xx", "yy", "zz", "xy")}


class ResultError(Exception):
    """Something asked for is not in the file; the text says what is."""


def as_text(value):
    """Text of an HDF5 string, whichever way it was stored."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace").rstrip("\x00")
    return str(value)


@dataclass(frozen=True)
class Snapshot:
    """One stored state: group name, simulated time [s], stage, number of steps."""

    name: str
    time: float
    stage: str
    step: int


class Result:
    """A result file, open for reading; a run may go on writing it."""

    def __init__(self, path):
        self.path = Path(path)
        if not self.path.is_file():
            raise ResultError(f"{self.path}: no such file")
        try:
            self._file = h5py.File(self.path, "r", locking=False)
            mesh = self._file["mesh"]
            self.nodes = mesh["nodes"][...]
        except (OSError, KeyError) as error:
            raise ResultError(f"{self.path}: not a TALUS result file ({error})") from error
        self.soil = mesh["soil"][...]
        self.soil_names = [as_text(name) for name in mesh["soil_names"][...]]
        self.cell_area = mesh["cell_area"][...]
        self.element_offset = mesh["element_offset"][...]
        self.element_nodes = mesh["element_nodes"][...]
        self.title = as_text(self._file.attrs.get("title", self.path.stem))
        self.snapshots = self._read_snapshots()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._file.close()

    def _read_snapshots(self):
        groups = self._file.get("snapshots", {})
        found = [
            Snapshot(
                name,
                float(group.attrs["time"]),
                as_text(group.attrs["stage"]),
                int(group.attrs["step"]),
            )
            for name, group in groups.items()
        ]
        return sorted(found, key=lambda s: (not s.name.isdigit(), s.name))

    def numbered(self):
        """Snapshots of the run itself, without named ones such as last_good."""
        numbered = [s for s in self.snapshots if s.name.isdigit()]
        if not numbered:
            raise ResultError(f"{self.path}: no snapshot yet")
        return numbered

    def snapshot(self, name=None, time=None):
        """The snapshot of this name or number (-1: the last), or the nearest to a time [s]."""
        numbered = self.numbered()
        if time is not None:
            return min(numbered, key=lambda s: abs(s.time - time))
        if name is None:
            return numbered[-1]
        for snapshot in self.snapshots:
            if snapshot.name == name:
                return snapshot
        try:
            return numbered[int(name)]
        except (ValueError, IndexError):
            listed = [f"{numbered[0].name} to {numbered[-1].name}"]
            listed += [s.name for s in self.snapshots if not s.name.isdigit()]
            raise ResultError(f"{self.path}: no snapshot '{name}'; there are {', '.join(listed)}") from None

    def fields(self, snapshot):
        """Names of the stored fields."""
        return sorted(self._file["snapshots"][snapshot.name])

    def has(self, name, snapshot=None):
        """True when the field, or the field of this component, is in the (last) snapshot."""
        try:
            self._dataset(name, snapshot or self.snapshot())
        except ResultError:
            return False
        return True

    def _dataset(self, name, snapshot):
        """Dataset of a field and the component wanted: an index, 'size' for vectors, or None."""
        group = self._file["snapshots"][snapshot.name]
        if name in group:
            data = group[name]
            if data.ndim == 1:
                return data, None
            if data.shape[1] == 2:
                return data, "size"
            choices = ", ".join(f"{name}_{part}" for part in COMPONENTS[data.shape[1]])
            raise ResultError(f"field '{name}' has components; choose one of {choices}")
        stem, _, part = name.rpartition("_")
        if stem in group and group[stem].ndim == 2:
            parts = COMPONENTS.get(group[stem].shape[1], ())
            if part in parts:
                return group[stem], parts.index(part)
        raise ResultError(
            f"{self.path}: no field '{name}' in snapshot {snapshot.name}; "
            f"there are {', '.join(self.fields(snapshot))} (and components, e.g. stress_xy)"
        )

    def field(self, name, snapshot):
        """Nodal values (n,): a scalar, a component such as stress_xy, or the length of a vector."""
        data, part = self._dataset(name, snapshot)
        if part is None:
            return data[...]
        if part == "size":
            return np.hypot(*data[...].T)
        return data[:, part]

    def units(self, name, snapshot):
        """Units of a field as stored, '1' for none."""
        data, _ = self._dataset(name, snapshot)
        return as_text(data.attrs.get("units", "1"))

    def positions(self, snapshot, scale=1.0):
        """Node positions [m], (n, 2), moved by `scale` times the displacement."""
        group = self._file["snapshots"][snapshot.name]
        if scale == 0.0 or "displacement" not in group:
            return self.nodes
        return self.nodes + scale * group["displacement"][...]

    def history(self):
        """Columns of the history by name, cut to their common length."""
        group = self._file.get("history")
        if group is None or "time" not in group:
            raise ResultError(f"{self.path}: no history yet")
        rows = min(column.shape[0] for column in group.values())
        columns = {name: column[:rows] for name, column in group.items()}
        if "stage" in columns:
            columns["stage"] = np.array([as_text(stage) for stage in columns["stage"]])
        return columns

    def history_units(self, name):
        """Units of a history column as stored, '1' for none."""
        return as_text(self._file["history"][name].attrs.get("units", "1"))

    def stage_start(self, snapshot):
        """Time at which the stage of a snapshot begins [s]."""
        times = [s.time for s in self.snapshots if s.stage == snapshot.stage]
        try:
            history = self.history()
            times.extend(history["time"][history["stage"] == snapshot.stage][:1])
        except ResultError:
            pass
        return min(times)

    def factor_of_safety(self, stage):
        """Middle between the largest factor that stood and the least that failed, or None."""
        try:
            history = self.history()
            rows = history["stage"] == stage
            factor, stands = history["factor"][rows], history["factor_stands"][rows] > 0.5
        except (ResultError, KeyError):
            return None
        if stands.all() or not stands.any():
            return None
        return 0.5 * (factor[stands].max() + factor[~stands].min())

    def elements(self, corners):
        """Corners (m, corners) of the elements that have this many."""
        first = self.element_offset[:-1][np.diff(self.element_offset) == corners]
        return self.element_nodes[first[:, None] + np.arange(corners)]

    @cached_property
    def edges(self):
        """All edges of the elements once, (m, 2), and how many elements share each."""
        sides = [
            np.stack([cells, np.roll(cells, -1, axis=1)], axis=2).reshape(-1, 2)
            for cells in (self.elements(3), self.elements(4))
        ]
        low, high = np.sort(np.concatenate(sides), axis=1).astype(np.int64).T
        keys, shared = np.unique(low * len(self.nodes) + high, return_counts=True)
        return np.stack(np.divmod(keys, len(self.nodes)), axis=1), shared

    @cached_property
    def cell_shapes(self):
        """Outlines of the nodal cells."""
        return CellShapes(self)

    def triangles(self):
        """Elements as triangles (m, 3), quadrilaterals cut in two."""
        quads = self.elements(4)
        return np.concatenate([self.elements(3), quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


class CellShapes:
    """Outlines of the nodal cells: middles of sides and centroids of elements around each node."""

    def __init__(self, result):
        self._edges, shared = result.edges
        self._elements = [c for c in (result.elements(3), result.elements(4)) if len(c)]
        points = self._points(result.nodes)
        # Corners of the outlines as (node, point): sides give two, elements one a corner, and a
        # node on the boundary is a corner of its own cell.
        border = np.unique(self._edges[shared == 1])
        count, first = len(result.nodes), len(self._edges)
        nodes = [self._edges[:, 0], self._edges[:, 1]]
        ids = [np.arange(first), np.arange(first)]
        for corners in self._elements:
            nodes.append(corners.ravel())
            ids.append(np.repeat(first + np.arange(len(corners)), corners.shape[1]))
            first += len(corners)
        nodes, ids = np.concatenate([*nodes, border]), np.concatenate([*ids, first + border])
        # In order of the angle about the middle of these points, node by node.
        sizes = np.bincount(nodes, minlength=count)
        middle = np.stack([np.bincount(nodes, points[ids, k], count) for k in (0, 1)], axis=1)
        arm = points[ids] - (middle / np.maximum(sizes, 1)[:, None])[nodes]
        order = np.lexsort((np.arctan2(arm[:, 1], arm[:, 0]), nodes))
        starts = np.cumsum(sizes) - sizes
        # Every outline as long as the longest: the last point is repeated.
        place = np.minimum(np.arange(sizes.max()), np.maximum(sizes, 1)[:, None] - 1)
        self._corners = ids[order][np.minimum(starts[:, None] + place, len(ids) - 1)]

    def _points(self, positions):
        """Middles of the sides, centroids of the elements, nodes."""
        middles = positions[self._edges].mean(axis=1)
        return np.concatenate(
            [middles, *(positions[corners].mean(axis=1) for corners in self._elements), positions]
        )

    def at(self, positions):
        """Outlines (n, longest, 2) when the nodes are at these positions."""
        return self._points(positions)[self._corners]


def along_vertical(result, positions, values, x):
    """Elevations [m], rising, and values where the vertical line at `x` [m] cuts element sides."""
    edges, _ = result.edges
    left, right = edges[:, 0], edges[:, 1]
    xl, xr = positions[left, 0], positions[right, 0]
    span = xr - xl
    tiny = 1e-9 * np.ptp(positions[:, 0])
    crossed = (np.minimum(xl, xr) <= x) & (np.maximum(xl, xr) >= x) & (np.abs(span) > tiny)
    left, right = left[crossed], right[crossed]
    share = (x - xl[crossed]) / span[crossed]
    y = (1 - share) * positions[left, 1] + share * positions[right, 1]
    value = (1 - share) * values[left] + share * values[right]
    order = np.argsort(y)
    return y[order], value[order]
