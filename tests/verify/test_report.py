#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The report says what was measured: misses first, right orders, each case with its own date."""

import contextlib
import csv
import io
import json
import sys
import tempfile
import types
import unittest
import unittest.mock
from pathlib import Path

import numpy as np
from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parent))

import case_list  # noqa: E402  (found through the path above)
import run_cases  # noqa: E402
from case_list import find_cases, select_cases  # noqa: E402
from report import load_stories, store_run, store_story, thinned, write_report  # noqa: E402
from report_pictures import drawn_rows  # noqa: E402
from report_text import ASKED, number  # noqa: E402
from talus_case import seconds_at  # noqa: E402

# A check.py that needs no program: targets met, missed, failed; or an end before the verdict.
CHECK = """\
\"\"\"A made-up case.

It tests the report.\"\"\"
import sys
sys.path.insert(0, {verify!r})
from talus_case import Case
case = Case(__file__.rsplit("/", 1)[0], id={id!r}, title="a made-up case", error="none", reference="none")
{body}
sys.exit(case.verdict())
"""
MET = 'case.target("drift", 0.5, 1.0, "by hand")'
CAREFUL = MET + '\ncase.caution("Half of it is drift.")'
MISSED = 'case.target("drift", 2.5, 1.0, "by hand", held=(2.0, 3.0))'
FAILED = 'case.target("drift", 9.5, 1.0, "by hand", held=(2.0, 3.0))'
CRASHED = 'raise ValueError("no such field")'


def story_of(name, targets=(), runs=(), **more):
    """A story as a case stores it; targets: (value, limit), runs: (series, spacing, error, seconds)."""
    return {
        "case": name,
        "kind": "verify",
        "id": name.upper(),
        "title": f"title of {name}",
        "failures": 0,
        "date": "2020-02-20",
        "machine": "abacus",
        "case_seconds": 1.5,
        "targets": [
            {"what": f"error {i}", "value": v, "limit": most, "low": None, "met": v <= most, "why": "because"}
            for i, (v, most) in enumerate(targets)
        ],
        "runs": [
            {
                "series": series,
                "nodes": round(1 / spacing),
                "spacing": spacing,
                "error": error,
                "seconds": seconds,
                "node_steps_per_second": 2.5e6,
                "threads": 1,
                "smoothing": "one level",
                "stabilisation": 0.05,
            }
            for series, spacing, error, seconds in runs
        ],
        **more,
    }


class Report(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.tests = self.folder / "tests"
        self.addCleanup(self.temporary.cleanup)

    def add_case(self, name, id="", body=MET, kind="verify"):
        """A case with this body."""
        path = self.tests / kind / name / "check.py"
        path.parent.mkdir(parents=True)
        path.write_text(CHECK.format(verify=str(Path(__file__).parent), id=id, body=body))

    def write(self, *stories):
        """Store stories, with cases for them, and return the lines of the report."""
        for story in stories:
            if not (self.tests / story["kind"] / story["case"]).exists():
                self.add_case(story["case"], story["id"], kind=story["kind"])
            store_story(self.folder / "out", story)
        path = write_report(self.folder / "out", find_cases(self.tests), self.tests)
        return path.read_text().splitlines()

    def rows(self, name):
        with (self.folder / "out" / "report" / name).open() as file:
            return list(csv.DictReader(file))

    def test_a_miss_leads_the_report(self):
        lines = self.write(story_of("h1", [(0.01, 0.02)]), story_of("h2", [(0.01, 0.02), (0.0345, 0.02)]))
        self.assertIn("1 of 3 targets are not met", lines[2])
        self.assertIn("[H2]", lines[4])
        self.assertIn("error 1: **0.0345** measured, ≤ 0.02 wanted", lines[4])
        self.assertEqual([row["met"] for row in self.rows("targets.csv")], ["yes", "yes", "no"])

    def test_all_met(self):
        lines = self.write(story_of("h1", [(0.01, 0.02)]))
        self.assertEqual(lines[2], "**All 1 targets are met.**")
        self.assertNotIn("not met", "\n".join(lines))

    def test_like_targets_are_one_row_with_the_worst_value(self):
        story = story_of("h1", [(1e-3, 0.02), (5e-3, 0.02), (0.9, 0.02), (2.0, 3.0)])
        for i, what in enumerate(("51 rows: error", "101 rows: error", "201 rows: error", "other")):
            story["targets"][i]["what"] = what
        rows = [line for line in self.write(story) if line.startswith("| [H1]")]
        self.assertEqual(len(rows), 3)
        self.assertIn("| error (2 runs, the worst) | **0.005** | ≤ 0.02 | yes |", rows[0])
        self.assertIn("| 201 rows: error | **0.9** | ≤ 0.02 | **no** |", rows[1])

    def test_long_curves_keep_their_peaks(self):
        x = np.linspace(0, 1, 30001)
        y = np.sin(2000 * x)
        y[12345] = 7.0
        thin_x, thin_y = thinned(x.tolist(), y.tolist(), 300)
        self.assertLessEqual(len(thin_x), 602)
        self.assertEqual((thin_x[0], thin_x[-1], max(thin_y)), (0.0, 1.0, 7.0))
        self.assertLess(min(thin_y), -0.999)
        self.assertTrue(np.all(np.diff(thin_x) > 0))
        self.assertEqual(thinned([1.0, 2.0], [3.0, 4.0], 300), ([1.0, 2.0], [3.0, 4.0]))

    def test_targets_asked_for_come_first(self):
        story = story_of("h1", [(0.01, 0.02), (0.03, 0.04)])
        story["targets"][1]["asked"] = True
        lines = self.write(story_of("m1", [(1, 2)]), story)
        first = lines.index("**Asked for**")
        self.assertLess(first, lines.index("**Our own: operators and mechanics**"))
        rows = [line for line in lines if line.startswith("| [H1]")]
        self.assertIn("| ≤ 0.5 % (L2, finest) | error 1 | **0.03** |", rows[0])
        self.assertIn("| error 0 | **0.01** |", rows[1])
        self.assertEqual([row["asked"] for row in self.rows("targets.csv")], ["no", "no", "yes"])

    def test_what_was_asked_is_told_once_a_case(self):
        stories = [
            story_of("beam", [(0.01, 0.05), (0.02, 0.03)], kind="hard", id="hard 3"),
            story_of("slopes", [(1.05, 1.0)], id="S1 bracket"),
            story_of("other", [(1.0, 2.0)], id="S1"),
        ]
        for story in stories:
            for target in story["targets"]:
                target["asked"] = True
        text = "\n".join(self.write(*stories))
        for words in (ASKED["hard 3"], ASKED["S1 bracket"], ASKED["S1"]):
            self.assertEqual(text.count(f"| {words} |"), 1)
        self.assertIn(") |  | error 1 | **0.02** |", text)
        self.assertNotIn("Our own", text)

    def test_cautions_stand_below_the_misses(self):
        careful = story_of("m7", [(0.01, 0.02)], cautions=["Soil is 1000 times as stiff."])
        lines = self.write(careful, story_of("h1", [(0.03, 0.02)]))
        place = lines.index("**Met as worded, read with care:**")
        self.assertIn("[H1]", lines[place - 2])
        self.assertEqual(lines[place + 2], "- [M7](#m7-title-of-m7) Soil is 1000 times as stiff.")
        self.assertLess(place + 3, next(i for i, k in enumerate(lines) if k.startswith("Written by")))
        self.assertNotIn("with care", "\n".join(self.write({**careful, "cautions": []})))

    def test_no_orders_where_they_mean_nothing(self):
        runs = [("fine", h, 3 * h**2, 1 / h) for h in (0.1, 0.05, 0.01)]
        runs += [("solved", h, 1e-6 / h, 1 / h) for h in (0.1, 0.05, 0.01)]
        solved = story_of("h1", runs=runs)
        for row in solved["runs"][3:]:
            row["exact"] = True
        zero = story_of("h2", runs=runs[:3], order=False, work=False, quantity="|distance|")
        text = "\n".join(self.write(solved, zero))
        orders = [row["order"] for row in self.rows("studies.csv")]
        self.assertEqual(orders, ["", "2.000", "2.000", *[""] * 6])
        self.assertIn("| series | nodes | spacing [m] | \\|distance\\| | order |", text)
        self.assertIn("verify_h1_convergence.png", text)
        self.assertNotIn("verify_h2_", text)
        self.assertEqual({row["series"] for row in drawn_rows(solved["runs"])}, {"fine"})

    def test_the_worst_of_a_class_is_drawn(self):
        rows = story_of("h1", runs=[(f"seed {i}", 0.1, i / 10, 1.0) for i in (2, 3, 1)])["runs"]
        for row in rows:
            row["curve"] = "all seeds"
        self.assertEqual([(r["series"], r["error"]) for r in drawn_rows(rows)], [("all seeds", 0.3)])

    def test_tables_captions_and_stand_ins(self):
        curve = {"name": "a", "x": [0.0, 1.0], "y": [0.0, 1.0], "style": "-"}
        picture = {"name": "One, two", "x_label": "x [m]", "y_label": "y [m]", "log_x": False, "log_y": False}
        remedy = {"what": "hazard", "without": "bad", "remedied": "good", "shown": True}
        story = story_of(
            "h1",
            tables=[{"name": "Thresholds", "head": ["times", "F"], "rows": [["3", "1.38"]]}],
            pictures=[{**picture, "curves": [curve]}],
            remedies=[remedy, {**remedy, "by": "numpy stand-in"}],
        )
        lines = self.write(story)
        self.assertIn("| 3 | 1.38 |", lines)
        self.assertIn("| hazard | bad | TALUS | good |", lines)
        self.assertIn("| hazard | bad | numpy stand-in | good |", lines)
        place = lines.index("![One, two](report/verify_h1_one_two.png)")
        self.assertEqual(lines[place + 1 : place + 3], ["", "*One, two*"])

    def test_studies_are_printed(self):
        story = story_of("h1", runs=[("fine", h, 3 * h**2, 1 / h) for h in (0.1, 0.05)])
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            run_cases.print_study(story)
        head, first, second = printed.getvalue().splitlines()
        self.assertEqual(head.split()[:3], ["series", "nodes", "spacing"])
        self.assertEqual(first.split()[:5], ["fine", "10", "0.1", "0.03", "-"])
        self.assertEqual(second.split()[4], "2.00")

    def test_failures_and_absent_cases_are_named_first(self):
        self.add_case("h3", "H3")
        lines = self.write(story_of("h1", [(0.01, 0.02)], failures=2), story_of("h2", trouble="it crashed"))
        self.assertIn("Failed: [H1]", lines[2])
        self.assertIn("2 of its checks", lines[2])
        self.assertIn("it crashed", lines[4])
        self.assertIn("No results yet of: h3 (H3).", lines)

    def test_benchmarks_without_a_case_are_named(self):
        for i, id in enumerate(case_list.WANTED):
            if id not in ("M6", "H5", "S1", "hard 6", "hard 11"):
                self.add_case(f"case{i}", id, kind="hard" if id.startswith("hard") else "verify")
        lines = self.write(story_of("dam", id="H5 rigid"), story_of("slopes", id="S1, S3"))
        self.assertIn("**Without a case: M6, hard 6, hard 11.**", lines)
        for name, id in (("six", "hard 6"), ("eleven", "hard 11")):
            self.add_case(name, id, kind="hard")
        self.assertNotIn("Without a case", "\n".join(self.write(story_of("m6"))))

    def test_observed_order(self):
        runs = [("fine", h, 3 * h**2, 1 / h) for h in (0.1, 0.05, 0.01)] + [("other", 0.1, 0.5, 1.0)]
        self.write(story_of("h1", runs=runs))
        orders = [row["order"] for row in self.rows("studies.csv")]
        self.assertEqual(orders, ["", "2.000", "2.000", ""])

    def test_each_case_keeps_its_date(self):
        self.write(story_of("h2", [(1, 2)]), story_of("h1", [(1, 2)]))
        lines = self.write(story_of("h2", [(3, 4)], date="2021-03-21"))
        rows = self.rows("targets.csv")
        self.assertEqual([row["id"] for row in rows], ["H1", "H2"])
        self.assertEqual([row["date"] for row in rows], ["2020-02-20", "2021-03-21"])
        self.assertEqual([row["measured"] for row in rows], ["1", "3"])
        self.assertTrue(any("Date: 2020-02-20 to 2021-03-21" in line for line in lines))

    def test_numbers_survive_storing(self):
        curve = {"name": "a", "x": [0.0, 1e-7, float("nan")], "y": [1 / 3, -2.5, 4e9], "style": "-"}
        picture = {"name": "One, two", "x_label": "x", "y_label": "y", "log_x": False, "log_y": False}
        self.write(story_of("h1", pictures=[{**picture, "curves": [curve]}]))
        (story,) = load_stories(self.folder / "out", find_cases(self.tests))
        np.testing.assert_allclose(story["pictures"][0]["curves"][0]["x"], curve["x"], rtol=1e-6)
        np.testing.assert_allclose(story["pictures"][0]["curves"][0]["y"], curve["y"], rtol=1e-6)

    def test_pictures_are_drawn_small_and_stale_ones_removed(self):
        points = [{"program": "other", "nodes": None, "error": e, "seconds": 1 / e} for e in (0.1, 0.01)]
        runs = [("fine", h, h, 1 / h) for h in (0.1, 0.05, 0.01)]
        stale = self.folder / "out" / "report" / "verify_gone.png"
        stale.parent.mkdir(parents=True)
        stale.write_bytes(b"")
        lines = self.write(story_of("h1", runs=runs, published=points, published_source="a book"))
        self.assertFalse(stale.exists())
        self.assertIn("Source of these: a book", lines)
        for name in ("verify_h1_work_precision.png", "verify_h1_convergence.png"):
            path = stale.parent / name
            self.assertTrue(any(f"(report/{name})" in line for line in lines))
            self.assertLess(path.stat().st_size, 60_000)
            with Image.open(path) as image:
                self.assertGreater(min(image.size), 200)
                self.assertGreater(len(image.convert("RGB").getcolors(2**24)), 10)

    def test_machine_and_times(self):
        store_run(self.folder / "out", elapsed=12, jobs=2, load=0.5)
        text = "\n".join(self.write(story_of("h1"), story_of("h2", version="1.2 (abc)", compiler="cc 9")))
        for words in ("Machine: abacus.", "cc 9", "TALUS 1.2 (abc)", "take 3 s", "took 12 s with 2"):
            self.assertIn(words, text)

    def test_cases_are_chosen_by_name_and_id(self):
        for kind, name, id in (
            ("verify", "celia", "H3"),
            ("verify", "column", "H5 rigid"),
            ("hard", "dry", "hard 4"),
            ("hard", "last", "hard 11"),
            ("hard", "celia", "hard 1"),
            ("verify", "plain", ""),
        ):
            self.add_case(name, id, kind=kind)
        cases = find_cases(self.tests)
        self.assertEqual([c.id for c in cases], ["H3", "H5 rigid", "", "hard 1", "hard 4", "hard 11"])
        for words, chosen in (
            ([], 6),
            (["h3"], 1),
            (["celia"], 2),
            (["H5"], 1),
            (["hard", "4"], 1),
            (["hard4", "H3"], 2),
            (["hard", "1"], 1),
            (["hard"], 3),
        ):
            self.assertEqual(len(select_cases(cases, words)[0]), chosen, words)
            self.assertEqual(select_cases(cases, words)[1], [], words)
        self.assertEqual(select_cases(cases, ["H3", "H9"])[1], ["H9"])

    def test_what_a_case_says_is_what_is_reported(self):
        states = {"met": CAREFUL, "missed": MISSED, "failed": FAILED, "crashed": CRASHED}
        for name, body in states.items():
            self.add_case(name, body=body)
        found = {}
        for case in find_cases(self.tests):
            story = run_cases.run_case(case, "/bin/true", self.folder, set())
            found[case.name] = run_cases.state_of(story)
            store_story(self.folder / "out", story)
        self.assertEqual(found, {"met": "ok", "missed": "miss", "failed": "FAIL", "crashed": "FAIL"})
        crashed = json.loads((self.folder / "out" / "report" / "verify_crashed.json").read_text())
        self.assertIn("no such field", crashed["trouble"])
        text = "\n".join(self.write())
        self.assertIn("**2 of 3 targets are not met:**", text)
        self.assertIn("A made-up case.", text)
        self.assertIn(" Half of it is drift.", text)

    def test_exit_codes(self):
        for name, body in {"met": MET, "missed": MISSED, "failed": FAILED}.items():
            self.add_case(name, body=body)
        for words, code in ((["met", "missed"], 0), (["met", "failed"], 1), (["nosuch"], 2)):
            arguments = ["/bin/true", "--output", str(self.folder / "out"), *words, "--jobs", "2"]
            printed, errors = io.StringIO(), io.StringIO()
            with (
                unittest.mock.patch.object(run_cases, "TESTS", self.tests),
                unittest.mock.patch.object(sys, "argv", ["verify", *arguments]),
                contextlib.redirect_stdout(printed),
                contextlib.redirect_stderr(errors),
            ):
                self.assertEqual(run_cases.main(), code, printed.getvalue())
            if code == 2:
                self.assertIn("no case 'nosuch'", errors.getvalue())
                self.assertIn("verify/missed", errors.getvalue())
            else:
                self.assertRegex(printed.getvalue(), r"MISS|2 targets, 1 not met")

    def test_a_case_that_ends_is_stored_at_once(self):
        self.add_case("met", body=MET)
        cases = find_cases(self.tests)
        options = types.SimpleNamespace(program="/bin/true", output=self.folder / "out", jobs=1)
        with contextlib.redirect_stdout(io.StringIO()):
            run_cases.run_all(cases, options, self.folder)
        self.assertEqual([s["case"] for s in load_stories(options.output, cases)], ["met"])

    def test_real_cases_are_found(self):
        found = find_cases(Path(__file__).resolve().parents[1])
        self.assertLessEqual({"celia", "srivastava_yeh", "patch"}, {case.name for case in found})
        self.assertEqual(case_list.without_case([case.id for case in found]), [])
        ids = {case.id for case in found}
        self.assertLessEqual(set(ASKED), ids | {id.split(" ")[0] for id in ids})


class Numbers(unittest.TestCase):
    def test_time_between_published_points(self):
        points = [{"error": e, "seconds": s} for e, s in ((1e-1, 1.0), (1e-2, 100.0), (1e-3, 200.0))]
        self.assertAlmostEqual(seconds_at(points, 10**-1.5), 10.0)
        self.assertAlmostEqual(seconds_at(points, 1e-2), 100.0)
        self.assertAlmostEqual(seconds_at(points, 1e-9), 200.0)  # never more than was published
        self.assertAlmostEqual(seconds_at(points, 1.0), 0.01)

    def test_three_digits(self):
        for value, text in (
            (0.0083539, "0.00835"),
            (1.0e-12, "1e-12"),
            (2.927e-15, "2.93e-15"),
            (402.0, "402"),
            (1.38076, "1.381"),
            (-4321.6, "-4322"),
            (None, "-"),
            (float("nan"), "nan"),
        ):
            self.assertEqual(number(value), text)


if __name__ == "__main__":
    unittest.main()
