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

case = Case(
    SAMPLES,
    id="demo",
    title="the demo slope slides in the rain, and stands without",
    error="relative energy error of the slide, and of standing without rain",
    reference="what the sample decks promise",
    quantity="energy error",
    order=False,
    work=False,
)
SPACING = 0.35  # of both decks
THREADS = 1 if case.full else 2

rain = case.run("rain_slope/case.nml", name="rain_slope", threads=THREADS)
summary, history = rain.summary, rain.history()
case.check_true("nodes between 2500 and 4000", 2500 <= int(summary["nodes"]) <= 4000)
case.check_true("the storm ends in failure", summary["failed"] == ".true.")
trigger = float(summary["trigger_time"])
case.check_true("after the slope has stood for hours of rain", 4 * 3600 < trigger < 36 * 3600)
slide = float(summary["maximum_displacement"])
case.target("slide [m]", slide, 20.0, "more than a metre; less than the slope is wide", low=1.0)
speed = history["maximum_velocity"]
case.check("last speed over the greatest [-]", speed[-1] / speed.max(), 0.2, "it comes to rest")
case.target("water error of the storm", abs(float(summary["water_error"])), 1e-12, "round-off")
lost = float(summary["energy_error"])
case.target("energy error of the slide", lost, 1e-3, "the accuracy asked for", asked=True)
case.note(
    f"{summary['nodes']} nodes; it fails after {trigger / 3600:.1f} h of rain; the run takes "
    f"{float(summary['wall_seconds']):.0f} s with {THREADS} thread{'s' if THREADS > 1 else ''}."
)
case.study("with rain, it slides", rain, SPACING, float(summary["energy_error"]))
damage, strain = rain.field("damage"), rain.field("plastic_strain")
band = strain > 0.5 * strain.max()
case.check_true("damage lies along the band", damage[band].min() > 0.2 and (damage > 0).mean() < 0.3)

dry = case.run("dry_slope/case.nml", name="dry_slope", threads=THREADS)
case.check_true("without rain there is no failure", dry.summary["failed"] == ".false.")
case.study("without rain, it stands", dry, SPACING, float(dry.summary["energy_error"]))
still = float(dry.summary["maximum_displacement"])
case.target("displacement without rain [m]", still, 0.01, "it stays put")

rainy, without = ((SAMPLES / name / "case.nml").read_text() for name in ("rain_slope", "dry_slope"))
rainy = re.sub(r"&boundary\n  name = 'rain'.*?\n/\n", "", rainy, flags=re.S)
told = [re.sub(r"^!.*\n", "", re.sub(r"  title = .*\n", "", text)) for text in (rainy, without)]
case.check_true("the decks differ by the rain only", told[0] == told[1])

curves = {}
for name, columns, style in (("with rain", history, "C0.-"), ("without rain", dry.history(), "C1.--")):
    storm = (columns["stage"] == "storm") & (columns["maximum_displacement"] > 0)
    curves[name] = (columns["time"][storm] / 3600, columns["maximum_displacement"][storm], style)
case.picture(
    "Largest displacement over the storm", "Time [h]", "Largest displacement [m]", curves, log_y=True
)
sliding = history["stage"] == "slide"
time = history["time"][sliding] - history["time"][sliding][0]
case.picture(
    "The slide",
    "Time of the slide [s]",
    "Largest displacement [m]",
    {"with rain": (time, history["maximum_displacement"][sliding], "C0-")},
)
sys.exit(case.verdict())
