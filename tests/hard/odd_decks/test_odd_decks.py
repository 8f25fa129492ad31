#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Decks at the edge of what is allowed: each must run, or fail, for the right reason.

test_odd_decks.py PROGRAM
"""

import csv
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve()

BOX = {"kind": "box", "width": 2.0, "height": 2.0}
ELASTIC = {"name": "soil", "porosity": 0.4, "youngs_modulus": 1e7, "poisson_ratio": 0.3}
PLASTIC = {**ELASTIC, "plasticity": "drucker_prager", "cohesion": 5e3, "friction_angle": 25.0}
WATER = {"retention": "van_genuchten", "conductivity_x": 1e-5, "alpha": 1.0, "n": 2.0}
TABLE = {"pore_pressure": "hydrostatic", "water_table": 0.0}
BASE = {"where": "bottom", "displacement": "fixed"}
SIDES = [{"where": side, "displacement": "roller_x"} for side in ("left", "right")]
RAIN = {"where": "top", "water": "rain", "rain": 20.0}
GRAVITY = {"name": "gravity", "kind": "geostatic"}
STORM = {"name": "storm", "kind": "storm", "duration": 7200.0, "storm_step": 1800.0}
DYNAMIC = {"name": "slide", "kind": "dynamic", "duration": 0.2}


def group(name: str, keys: dict) -> str:
    """One namelist group."""

    def text(value) -> str:
        if isinstance(value, bool):
            return ".true." if value else ".false."
        if isinstance(value, str):
            return f"'{value}'"
        if isinstance(value, list):
            return ", ".join(text(item) for item in value)
        return repr(value)

    return f"&{name}\n" + "".join(f"  {k} = {text(v)}\n" for k, v in keys.items()) + "/\n"


class Outcome:
    """Exit code, summary and history of one run."""

    def __init__(self, folder: pathlib.Path, run: subprocess.CompletedProcess):
        self.code = run.returncode
        self.message, self.report = run.stderr.decode(), run.stdout.decode()
        self.files = sorted(path.name for path in folder.iterdir()) if folder.exists() else []
        self.summary, self.history = {}, []
        if (folder / "deck_summary.txt").exists():
            lines = (folder / "deck_summary.txt").read_text().splitlines()
            self.summary = dict(line.split(" = ", 1) for line in lines if " = " in line)
            with (folder / "deck_history.csv").open(newline="") as stream:
                rows = csv.DictReader(stream)
                self.history = [{k.split("[")[0]: v for k, v in row.items()} for row in rows]

    def lines_of(self, stage: str) -> list[dict]:
        """History lines of a stage."""
        return [row for row in self.history if row["stage"] == stage]


def run(*groups: tuple[str, dict], word: str = "run") -> Outcome:
    """Run, or check, a deck of (group, keys)."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "deck.nml").write_text("".join(group(*item) for item in groups))
        result = subprocess.run(
            [PROGRAM, word, "deck.nml"], cwd=folder, capture_output=True, timeout=120, check=False
        )
        return Outcome(folder / "results", result)


def check(*groups: tuple[str, dict]) -> dict[str, str]:
    """What `talus check` estimates: the rest of each line by its label, the last one of a label."""
    report = run(*groups, word="check").report
    report = report[report.index("What will be active") :]
    return {line[:26].strip(): line[26:] for line in report.splitlines()}


def model(soil: dict = ELASTIC, box: dict = BOX, spacing: float = 0.5) -> list[tuple[str, dict]]:
    """A box of one soil on a fixed base."""
    return [("geometry", box), ("nodes", {"spacing": spacing}), ("soil", soil), ("boundary", BASE)]


def rainy(soil: dict = ELASTIC, box: dict = BOX) -> list[tuple[str, dict]]:
    """The same with water, sides and rain."""
    return [
        *model(soil, box),
        ("water", WATER),
        ("initial", TABLE),
        *[("boundary", side) for side in SIDES],
        ("boundary", RAIN),
    ]


class OddDecks(unittest.TestCase):
    """One deck a test."""

    def stands(self, outcome: Outcome) -> None:
        """The run ended well."""
        self.assertEqual(outcome.code, 0, outcome.message)
        self.assertEqual(outcome.summary["failed"], ".false.")
        self.assertLess(abs(float(outcome.summary["water_error"])), 1e-12)

    def test_one_element(self):
        self.stands(
            run(
                *model(box={**BOX, "width": 1.0, "height": 1.0}, spacing=1.0),
                ("stage", GRAVITY),
                ("stage", DYNAMIC),
            )
        )

    def test_nothing_can_move(self):
        """Without a free node any step will do; neither stage may hang."""
        outcome = run(
            *model(box={**BOX, "width": 1.0, "height": 1.0}, spacing=1.0),
            ("boundary", {"where": "all", "displacement": "fixed"}),
            ("stage", GRAVITY),
            ("stage", DYNAMIC),
        )
        self.stands(outcome)
        self.assertEqual(float(outcome.summary["maximum_displacement"]), 0.0)

    def test_no_gravity(self):
        outcome = run(("run", {"gravity": 0.0}), *model(), ("stage", GRAVITY), ("stage", DYNAMIC))
        self.stands(outcome)
        self.assertEqual(float(outcome.summary["maximum_displacement"]), 0.0)
        self.assertNotIn("warning", outcome.summary)

    def test_storm_without_geostatic(self):
        outcome = run(*rainy(), ("stage", STORM))
        self.stands(outcome)
        self.assertIn("no geostatic stage", outcome.message)

    def test_displacement_counts_from_the_reset(self):
        """Settlement under gravity is 3 mm, and swelling in the storm far less."""
        outcome = run(*rainy(), ("stage", GRAVITY), ("stage", STORM))
        self.stands(outcome)
        self.assertLess(float(outcome.summary["maximum_displacement"]), 3e-4)

    def test_saturating_elastic_soil_stands(self):
        """Soil that fills with water stiffens; the step must follow, or elastic soil "fails"."""
        outcome = run(
            *rainy({**ELASTIC, "stress": "bishop"}, {**BOX, "width": 1.0, "height": 4.0}),
            ("stage", GRAVITY),
            ("stage", {**STORM, "duration": 36000.0}),
        )
        self.stands(outcome)

    def test_table_of_cohesion_alone(self):
        soil = {
            **PLASTIC,
            "softening": "table",
            "softening_table_strain": [0.0, 0.1, 0.2],
            "softening_table_cohesion": [5e3, 2e3, 1e3],
        }
        self.stands(run(*model(soil), ("stage", GRAVITY), ("stage", DYNAMIC)))

    def test_later_storms_are_skipped_after_a_failure(self):
        soil = {**PLASTIC, "cohesion": 2e3, "friction_angle": 5.0, "suction_strength": "phi_b", "phi_b": 25.0}
        groups = model(soil, {**BOX, "width": 4.0, "height": 4.0})
        outcome = run(
            *groups,
            ("water", WATER),
            ("initial", {"pore_pressure": "uniform", "suction": 3e4}),
            ("boundary", SIDES[0]),
            ("boundary", {**RAIN, "where": "all", "rain": 40.0}),
            ("stage", GRAVITY),
            ("stage", {**STORM, "duration": 3.6e5, "storm_step": 3600.0, "failure_displacement": 0.05}),
            ("stage", {**STORM, "name": "later"}),
            ("stage", {**DYNAMIC, "only_after_failure": True}),
        )
        self.assertEqual(outcome.code, 0, outcome.message)
        self.assertEqual(outcome.summary["failed"], ".true.")
        self.assertEqual(outcome.lines_of("later"), [])
        self.assertGreater(len(outcome.lines_of("slide")), 1)

    def test_slide_is_skipped_when_the_storm_stands(self):
        outcome = run(
            *rainy(), ("stage", GRAVITY), ("stage", STORM), ("stage", {**DYNAMIC, "only_after_failure": True})
        )
        self.stands(outcome)
        self.assertEqual(outcome.lines_of("slide"), [])

    def test_history_interval_of_a_storm(self):
        outcome = run(
            *rainy(),
            ("stage", GRAVITY),
            ("stage", {**STORM, "duration": 18000.0, "storm_step": 600.0}),
            ("output", {"history_interval": 6000.0}),
        )
        self.stands(outcome)
        times = [float(row["time"]) for row in outcome.lines_of("storm")]
        self.assertEqual(times, [0.0, 6000.0, 12000.0, 18000.0])

    def test_too_few_steps_say_how_far_they_came(self):
        """And where the soil moves still; the base does not."""
        outcome = run(*model(), ("stage", {**GRAVITY, "steps_max": 10}))
        self.assertEqual(outcome.code, 3)
        self.assertRegex(outcome.message, r"stage gravity, time 0\.0 s: .*out-of-balance force 0\.[1-9]")
        self.assertRegex(outcome.message, r"largest at node \d+ at \([\d., ]+\) m; largest displacement")
        self.assertRegex(outcome.message, r"displacement [\d.e-]+ m at node \d+ at \([\d.]+, [12]\.\d\) m;")
        self.assertIn("s saved as snapshot last_good", outcome.message)

    def test_check_ends_where_water_moves_fast(self):
        """A water table far above the body: a trial of a whole step of the storm would take hours."""
        table = {**TABLE, "water_table": 1e7, "suction_limit": 3e4}
        groups = [item for item in rainy() if item[0] != "initial"]
        outcome = run(*groups, ("initial", table), ("stage", {**STORM, "solve": "seepage"}), word="check")
        self.assertEqual(outcome.code, 0, outcome.message)
        self.assertRegex(outcome.report, r"seepage steps, about    \S+, by the first \S+e-5 % of")

    def test_every_probe_has_its_columns(self):
        points = [0.01 * i for i in range(201)]
        outcome = run(*model(), ("output", {"probe_x": points, "probe_y": points}), ("stage", GRAVITY))
        self.stands(outcome)
        columns = outcome.history[0].keys()
        self.assertEqual(sum(name.startswith("probe_") for name in columns), 402)
        self.assertIn("probe_201_displacement_y", columns)

    def test_names_are_words_in_the_summary(self):
        outcome = run(*model({**PLASTIC, "name": "b = c"}), ("stage", GRAVITY), ("stage", DYNAMIC))
        self.stands(outcome)
        self.assertIn("cone_fit_b___c", outcome.summary)
        self.assertRegex(outcome.summary["scaling_and_damping"], r"^gravity: .*; slide: .* damping 0\.0$")

    def test_a_body_that_falls_freely_is_warned_of(self):
        body = [item for item in model() if item[0] != "boundary"]
        outcome = run(*body, ("stage", {**DYNAMIC, "duration": 1.0}))
        self.stands(outcome)
        self.assertIn("warning: the soil moved 4.9", outcome.message)
        self.assertIn("further than the model is wide and high (2.828 m)", outcome.summary["warning"])

    def test_estimate_of_the_water_alone(self):
        """No soil, and the steps of the water within a factor of three: its first ones are the shortest."""
        groups = rainy(box={**BOX, "width": 1.0, "height": 20.0})
        groups += [("stage", {**STORM, "solve": "seepage", "duration": 72000.0, "storm_step": 3600.0})]
        told, outcome = check(*groups), run(*groups)
        self.stands(outcome)
        self.assertEqual((told["soil"], told["stabilisation"]), ("off", "off"))
        steps = float(told["seepage steps, about"].split(",")[0])
        self.assertLess(abs(math.log(steps / float(outcome.summary["seepage_steps"]))), math.log(3.0))
        self.assertIn("the program itself takes about 20 MB more", told["memory"])

    def test_estimate_of_the_search_and_of_output(self):
        """A slide step of milliseconds and a snapshot at each: said before it fills the disk."""
        stages = [("stage", GRAVITY), ("stage", STORM), ("stage", {**DYNAMIC, "duration": 20.0})]
        told = check(*rainy(PLASTIC), *stages)
        self.assertRegex(told["if it fails, about"], r"1\.05e4 more")
        self.assertRegex(told["output"], r"^\d+ snapshots at most, [\d.]+ MB on disk")
        self.assertNotIn("warning: that much takes", told)
        told = check(*rainy(PLASTIC), *stages, ("output", {"snapshot_interval": 1e-6}))
        self.assertGreater(int(told["output"].split()[0]), 1000)
        self.assertIn("warning: that much takes", told)

    def test_a_missing_boundary_is_told_before_anything_is_written(self):
        outcome = run(
            *model(),
            ("boundary", {"where": "box", "from_x": 0.1, "to_x": 0.2, "pressure": 10.0}),
            ("stage", GRAVITY),
        )
        self.assertEqual(outcome.code, 2)
        self.assertEqual(outcome.files, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
