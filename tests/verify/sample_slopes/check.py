# SPDX-License-Identifier: MIT
"""The demo slope slides in the rain and comes to rest; its twin without rain stays put.

The limits are what the decks promise: a slide of more than a metre, triggered by the storm and over
before the run ends, with the energy balance of its real time within 1e-3 and water conserved to
round-off; and less than a centimetre without rain. A deck that is called dry must differ from the
other by its rain only.
"""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from talus_case import Case  # noqa: E402

SAMPLES = pathlib.Path(__file__).parents[3] / "input"

case = Case(SAMPLES)

rain = case.run("rain_slope/case.nml", name="rain_slope", threads=2)
summary, history = rain.summary, rain.history()
case.check_true("nodes between 2500 and 4000", 2500 <= int(summary["nodes"]) <= 4000)
case.check_true("the storm ends in failure", summary["failed"] == ".true.")
trigger = float(summary["trigger_time"])
case.check_true("after the slope has stood for hours of rain", 4 * 3600 < trigger < 36 * 3600)
case.check("1 m over the slide [-]", 1.0 / float(summary["maximum_displacement"]), 1.0, "more than a metre")
speed = history["maximum_velocity"]
case.check("last speed over the greatest [-]", speed[-1] / speed.max(), 0.2, "it comes to rest")
case.check("water error", float(summary["water_error"]), 1e-12, "round-off")
case.check("energy error of the slide", float(summary["energy_error"]), 1e-3, "issue's limit")
damage, strain = rain.field("damage"), rain.field("plastic_strain")
band = strain > 0.5 * strain.max()
case.check_true("damage lies along the band", damage[band].min() > 0.2 and (damage > 0).mean() < 0.3)

dry = case.run("dry_slope/case.nml", name="dry_slope", threads=2)
case.check_true("without rain there is no failure", dry.summary["failed"] == ".false.")
case.check("displacement without rain [m]", float(dry.summary["maximum_displacement"]), 0.01, "stays put")

rainy, without = ((SAMPLES / name / "case.nml").read_text() for name in ("rain_slope", "dry_slope"))
rainy = re.sub(r"&boundary\n  name = 'rain'.*?\n/\n", "", rainy, flags=re.S)
told = [re.sub(r"^!.*\n", "", re.sub(r"  title = .*\n", "", text)) for text in (rainy, without)]
case.check_true("the decks differ by the rain only", told[0] == told[1])

sys.exit(case.verdict())
