#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every figure of post/ is drawn from a tiny result file, and its numbers are the file's."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import h5py
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

POST = Path(__file__).resolve().parents[2] / "post"
sys.path.insert(0, str(POST))

import animate  # noqa: E402  (found through the path above)
import plot_all  # noqa: E402
import plot_field  # noqa: E402
import plot_profiles  # noqa: E402
import plot_sequence  # noqa: E402
import plot_water_balance  # noqa: E402
from plot_water_balance import balance_of  # noqa: E402
from talus_map import FieldMap, FieldScale, sided  # noqa: E402
from talus_result import CellShapes, Result, ResultError, along_vertical  # noqa: E402
from talus_style import display_units, seconds, time_text, use_style  # noqa: E402


def write_result(path):
    """A slanted block of 5 x 4 nodes, quadrilaterals with one column cut into triangles."""
    nx, ny = 5, 4
    j, i = np.divmod(np.arange(nx * ny), nx)
    nodes = np.stack([i * 1.0, j * (0.5 + 0.1 * i)], axis=1)
    offset, corners = [0], []
    for row in range(ny - 1):
        for column in range(nx - 1):
            a = row * nx + column
            quad = [a, a + 1, a + nx + 1, a + nx]
            for cell in [quad[:3], [a, *quad[2:]]] if column == 1 else [quad]:
                corners += cell
                offset.append(len(corners))
    with h5py.File(path, "w") as file:
        file.attrs["schema_version"] = 1
        file.attrs["title"] = np.bytes_(b"tiny")
        file["mesh/nodes"] = nodes
        file["mesh/soil"] = np.ones(len(nodes), np.int32)
        file["mesh/soil_names"] = np.array([b"silt"])
        file["mesh/cell_area"] = np.full(len(nodes), 0.5)
        file["mesh/element_offset"] = np.array(offset, np.int32)
        file["mesh/element_nodes"] = np.array(corners, np.int32)
        for k, (time, stage) in enumerate([(0, "gravity"), (7200, "storm"), (7201.5, "slide")]):
            group = file.create_group(f"snapshots/{k:06d}")
            group.attrs.update(time=float(time), stage=np.bytes_(stage.encode()), step=10 * k)
            push = np.stack([-0.1 * k * nodes[:, 1], 0 * nodes[:, 1]], axis=1)
            fields = {
                "displacement": (push, b"m"),
                "velocity": (push, b"m/s"),
                "stress": (-1e4 * np.ones((len(nodes), 4)), b"Pa"),
                "plastic_strain": (0.1 * k * nodes[:, 0], b"1"),
                "damage": (0.05 * k * nodes[:, 0], b"1"),
                "pore_pressure": (-9810.0 * (nodes[:, 1] - 0.7), b"Pa"),
                "saturation": (1.0 - 0.2 * nodes[:, 1], b"1"),
            }
            for name, (data, units) in fields.items():
                group[name] = data
                group[name].attrs["units"] = np.bytes_(units)
        time = np.r_[0:1:5j, 10:7200:5j, 7200.5:7201.5:5j]
        columns = {
            "time": (time, b"s"),
            "maximum_displacement": (1e-4 * time, b"m"),
            "kinetic_energy": (time, b"J/m"),
            "energy_error": (0 * time, b"1"),
            "water_in": (time / 7200, b"m3/m"),
            "water_stored": (1 + time / 7200, b"m3/m"),
            "water_error": (1e-16 + 0 * time, b"1"),
        }
        for name, (data, units) in columns.items():
            file["history/" + name] = data
            file["history/" + name].attrs["units"] = np.bytes_(units)
        file["history/stage"] = np.repeat([b"gravity", b"storm", b"slide"], 5)
        file["history/step"] = np.arange(15)


class Figures(unittest.TestCase):
    """Files that the scripts write."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        cls.path = cls.folder / "tiny.h5"
        write_result(cls.path)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def assert_drawn(self, path):
        """The image has a size, and is not of one colour."""
        with Image.open(path) as image:
            self.assertGreater(min(image.size), 100, path)
            colours = image.convert("RGB").getcolors(maxcolors=2**24)
        self.assertGreater(len(colours), 20, f"{path} looks empty")

    def test_all_figures(self):
        written = plot_all.draw_all(self.folder, dpi=50)
        names = {path.name for path in written}
        wanted = {"tiny_damage.png", "tiny_damage_sequence.png", "tiny_profiles.png"}
        wanted |= {"tiny_histories.png", "tiny_water_balance.png", "tiny_damage.gif"}
        self.assertLessEqual(wanted, names)
        for path in written:
            self.assertEqual(path.parent, self.folder / "figures")
            self.assert_drawn(path)
        with Image.open(self.folder / "figures" / "tiny_damage.gif") as movie:
            self.assertEqual(movie.n_frames, 3)

    def test_mechanism_of_strength_reduction(self):
        """Its snapshot has a name and no number, and a figure of its own."""
        path = self.folder / "reduced" / "tiny.h5"
        path.parent.mkdir()
        write_result(path)
        with h5py.File(path, "a") as file:
            file.copy("snapshots/000002", "snapshots/mechanism")
        with Result(path) as result:
            self.assertEqual(len(result.numbered()), 3)
            plan = plot_all.figures_of(result, path.parent, 50)
            self.assertEqual(time_text(result, result.snapshot("mechanism")), "slide")
            options = [o for _, o in plan if "plastic_strain_mechanism" in o[2]]
            self.assertEqual(len(options), 1)
            self.assert_drawn(plot_field.draw(result, plot_field.parser().parse_args(options[0])))

        with h5py.File(path, "a") as file:
            file["history/factor"] = np.r_[np.ones(10), 1.0, 2.0, 1.5, 1.25, 1.375]
            file["history/factor_stands"] = np.r_[np.ones(10), 1.0, 0.0, 0.0, 1.0, 0.0]
        with Result(path) as result:
            text = time_text(result, result.snapshot("mechanism"))
            self.assertEqual(text, "slide, factor of safety 1.312")

    def test_no_water_balance_where_no_water_moves(self):
        path = self.folder / "dry" / "tiny.h5"
        path.parent.mkdir()
        write_result(path)
        with h5py.File(path, "a") as file:
            file["history/water_in"][...] = 0.0
        options = plot_water_balance.parser().parse_args([str(path)])
        with Result(path) as result, self.assertRaisesRegex(ResultError, "no stage moves water"):
            plot_water_balance.draw(result, options)

    def script(self, name, *options):
        """Run one script as a user does."""
        return subprocess.run(
            [sys.executable, POST / name, self.path, *options],
            capture_output=True,
            text=True,
            cwd=self.folder,
            check=False,
        )

    def test_options(self):
        use_style()
        cases = (
            (plot_field, "--field", "stress_xy", "--reference", "--snapshot", "0"),
            (plot_field, "--field", "displacement_x", "--time", "2h", "--limits", "-1", "1"),
            (plot_sequence, "--field", "saturation", "--times", "0", "120min", "--columns", "1"),
            (plot_profiles, "--x", "0", "1.3", "--deformed", "--fields", "pore_pressure"),
            (animate, "--field", "velocity", "--deformed", "2", "--rate", "4"),
        )
        for case, (module, *options) in enumerate(cases):
            output = self.folder / f"{case}{'.gif' if module is animate else '.png'}"
            common = [str(self.path), "--output", str(output), "--dpi", "50"]
            with Result(self.path) as result:
                module.draw(result, module.parser().parse_args([*common, *options]))
            self.assert_drawn(output)

    def test_script_names_its_file(self):
        done = self.script("plot_water_balance.py", "--dpi", "50")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(Path(done.stdout.strip()).name, "tiny_water_balance.png")
        self.assert_drawn(Path(done.stdout.strip()))

    def test_mistakes_are_explained(self):
        wrong_field = self.script("plot_field.py", "--field", "damge")
        self.assertEqual(wrong_field.returncode, 2)
        self.assertIn("no field 'damge'", wrong_field.stderr)
        self.assertIn("plastic_strain", wrong_field.stderr)
        cases = (
            (("plot_profiles.py", "--x", "1", "99"), "no soil at x = 99 m; the body spans 0 to 4 m"),
            (("plot_field.py", "--output", "/proc/x.png"), "cannot write /proc/x.png: No such file"),
            (("plot_field.py", "--output", "x.docs"), "cannot write x.docs: Format 'docs' is not supported"),
            (("animate.py", "--output", "/proc/x.gif"), "cannot write /proc/x.gif: No such file"),
            (("plot_histories.py", "--output", "tiny.h5/x.png"), "cannot write tiny.h5/x.png: "),
        )
        for options, words in cases:
            done = self.script(*options)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        with Result(self.path) as result, self.assertRaisesRegex(ResultError, "000000 to 000002"):
            result.snapshot("9")
        with self.assertRaisesRegex(ResultError, "nothing.h5"):
            Result(self.folder / "nothing.h5")


class Reading(unittest.TestCase):
    """Numbers behind the figures."""

    def setUp(self):
        with tempfile.TemporaryDirectory() as folder:
            write_result(Path(folder) / "tiny.h5")
            self.result = Result(Path(folder) / "tiny.h5")

    def tearDown(self):
        self.result.__exit__()

    def test_cells_tile_the_body(self):
        x, y = np.moveaxis(CellShapes(self.result).at(self.result.nodes), 2, 0)
        areas = 0.5 * np.sum(x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1), axis=1)
        # A block 4 wide, 1.5 high at the left and 2.7 at the right; round-off only.
        self.assertAlmostEqual(areas.sum(), 4 * (1.5 + 2.7) / 2, delta=1e-13)
        self.assertGreater(areas.min(), 0.0)

    def test_vertical_line_is_exact_for_linear_fields(self):
        nodes = self.result.nodes
        y, value = along_vertical(self.result, nodes, 3.0 * nodes[:, 0] - 2.0 * nodes[:, 1], 1.3)
        np.testing.assert_allclose(value, 3.0 * 1.3 - 2.0 * y, atol=1e-13)
        np.testing.assert_allclose([y[0], y[-1]], [0.0, 3 * (0.5 + 0.13)], atol=1e-13)

    def water_table(self, pressure):
        """Points (n, 2) of the line that a map of this pressure has at zero, and the ends of its bar."""
        last = self.result.snapshot()
        figure, axes = plt.subplots()
        with mock.patch.object(self.result, "field", lambda *_: pressure):
            scale = FieldScale(self.result, "pore_pressure", [last])
            field_map = FieldMap(axes, self.result, scale, 0.0)
            bar = scale.add_bar(figure, field_map.show(last))
        plt.close(figure)
        paths = field_map._contour.get_paths() if field_map._contour else []
        return np.concatenate([np.empty((0, 2)), *(path.vertices for path in paths)]), bar.ax.get_ylim()

    def test_water_table_is_at_zero(self):
        """On a row of nodes and between two; round-off along a surface is no water table."""
        x, y = self.result.nodes.T
        row = np.arange(20) // 5
        noise = 1e-10 * (-1.0) ** np.arange(20)
        # Between nodes the line is where a linear pressure is zero.
        line, ends = self.water_table(-9810.0 * (y - 0.7))
        np.testing.assert_allclose(line[:, 1], 0.7, atol=1e-12)
        np.testing.assert_allclose([line[:, 0].min(), line[:, 0].max()], [0.0, 4.0], atol=1e-12)
        np.testing.assert_allclose(ends, [-9.81 * (2.7 - 0.7), 9.81 * 0.7])
        # Zero to round-off on the second row of nodes, wet below.
        line, _ = self.water_table(-9810.0 * (row - 1) + noise)
        np.testing.assert_allclose(line[:, 1], 0.5 + 0.1 * line[:, 0], atol=1e-12)
        self.assertEqual(np.ptp(line[:, 0]), 4.0)
        # A seepage face over wet soil, a wet surface over suction: no line, and no invented colours.
        line, ends = self.water_table(9810.0 * (3 - row) + noise)
        self.assertEqual(len(line), 0)
        np.testing.assert_allclose(ends, [0.0, 29.43], atol=1e-9)
        line, ends = self.water_table(-9810.0 * (3 - row) + noise)
        self.assertEqual(len(line), 0)
        np.testing.assert_allclose(ends, [-29.43, 0.0], atol=1e-9)
        # A water table that meets a seepage face of zeros ends at the highest of them.
        pressure = np.where((x == 4.0) & (row < 2), 0.0, 9810.0 * (1.5 - row))
        line, _ = self.water_table(pressure)
        self.assertAlmostEqual(line[line[:, 0] == 4.0, 1].min(), 0.9)
        # Values beyond round-off are as they were.
        np.testing.assert_array_equal(sided(pressure, self.result.triangles()), pressure)

    def test_components_and_sizes(self):
        last = self.result.snapshot()
        push = self.result.field("displacement", last)
        np.testing.assert_allclose(push, 0.2 * self.result.nodes[:, 1])
        np.testing.assert_allclose(self.result.field("displacement_x", last), -push)
        self.assertEqual(self.result.units("stress_zz", last), "Pa")
        with self.assertRaisesRegex(ResultError, "stress_xx"):
            self.result.field("stress", last)

    def test_times_as_text(self):
        texts = [time_text(self.result, s) for s in self.result.snapshots]
        self.assertEqual(texts[2], "slide, 120.01 min + 1.00 s")
        self.assertEqual(seconds("1.5h"), 5400.0)
        self.assertEqual(seconds("90min"), 5400.0)
        self.assertEqual(seconds("12s"), seconds("12"))

    def test_water_counters_add_up_over_stages(self):
        history = {
            "stage": np.repeat(["gravity", "wet", "dry", "wet again"], 3),
            "water_in": np.array([0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 2, 4.0]),
            "water_out": np.array([0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1.0]),
            "water_stored": np.array([9, 9, 8, 7, 8, 8, 8, 8, 8, 8, 10, 11.0]),
        }
        rows, totals = balance_of(history)
        self.assertEqual(list(balance_of({n: c[:3] for n, c in history.items()})[0]), [])
        self.assertEqual(list(rows), [3, 4, 5, 9, 10, 11])
        self.assertEqual(list(totals["water_in"]), [0, 1, 2, 2, 4, 6])
        difference = totals["water_in"] - totals["water_out"] - totals["water_stored"]
        self.assertEqual(list(difference), [0.0] * 6)

    def test_units_for_readers(self):
        self.assertEqual(display_units("Pa", 25e3), (1e-3, "kPa"))
        self.assertEqual(display_units("Pa", 25.0), (1.0, "Pa"))
        self.assertEqual(display_units("m/s", 1e-6)[1], "mm/h")
        self.assertEqual(display_units("1", 0.5), (1.0, ""))


if __name__ == "__main__":
    unittest.main()
