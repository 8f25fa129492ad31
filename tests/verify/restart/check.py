# SPDX-License-Identifier: MIT
"""A run that is split in two gives the fields of the whole run, bit by bit.

For soil alone (a dynamic stage that goes on from another), seepage alone, and coupled soil that breaks:
the second half starts from the state that the first half saved at its end. The factor of safety found
from a saved state of the storm is that of the same run. What does not fit is refused with exit code 2,
all of it at once.
"""

import re
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="restart",
    title="A run split in two",
    error="greatest difference of all fields, over the greatest value",
    reference="the same run in one piece",
)


def stages(deck):
    """Text before the stages, and that of each stage."""
    text = (case.folder / deck).read_text()
    at = [match.start() for match in re.finditer(r"^&stage", text, re.M)] + [len(text)]
    return text[: at[0]], [text[a:b] for a, b in zip(at, at[1:])]


def without(deck, gone, replace=()):
    """Replacements that take stages out of a deck, and their names out of its boundaries."""
    names = [re.search(r"name = '([^']*)'", part).group(1) for part in gone]
    text, _ = stages(deck)
    replace = list(replace) + [(part, "") for part in gone]
    for boundary in re.findall(r"^&boundary\n.*?^/\n", text, re.M | re.S):
        acts = re.search(r"stages = ((?:'[^']*',? *)+)", boundary)
        if not acts:
            continue
        left = [name for name in re.findall(r"'([^']*)'", acts.group(1)) if name not in names]
        less = boundary.replace(acts.group(1), ", ".join(f"'{name}'" for name in left) + "  ")
        replace.append((boundary, less if left else ""))
    return replace


def split(deck, first, replace=(), stem=None):
    """The whole run, the run of its `first` stages, and that of the others from the saved state."""
    stem = stem or deck.split(".")[0]
    _, parts = stages(deck)
    whole = case.run(deck, list(replace), name=stem)
    head = case.run(deck, without(deck, parts[first:], replace), name=f"{stem}_head")
    tail = case.run(deck, without(deck, parts[:first], [*replace, *start(deck, head)]), name=f"{stem}_tail")
    return whole, head, tail


def start(deck, earlier, snapshot="last"):
    """Replacements that make a deck start from another result."""
    text, _ = stages(deck)
    key = f"&initial\n  from_result = '../{earlier.name}/{earlier.name}.h5'  snapshot = '{snapshot}'\n/\n"
    found = re.search(r"^&initial.*?^/\n", text, re.M | re.S)
    return [(found.group(), key)] if found else [("&soil\n", key + "&soil\n")]


def difference(one, other, snapshot_one=None, snapshot_other=None):
    """Greatest difference of all fields of two snapshots over the greatest value of each."""
    with h5py.File(one.path) as a, h5py.File(other.path) as b:
        a = a["snapshots"][snapshot_one or one.snapshots()[-1]]
        b = b["snapshots"][snapshot_other or other.snapshots()[-1]]
        worst = 0.0 if sorted(a) == sorted(b) and a.attrs["time"] == b.attrs["time"] else np.inf
        for name in a:
            x, y = a[name][:], b[name][:]
            if not np.array_equal(x, y):
                worst = max(worst, np.abs(x - y).max() / np.abs(x).max())
        return worst


BITS = "bit by bit"
SECOND = """&soil
  name = 'clay'  from_y = 2.0
  porosity = 0.4  youngs_modulus = 1.0e7  poisson_ratio = 0.3
  plasticity = 'drucker_prager'  cohesion = 6.0e3  friction_angle = 25.0
/
"""
for deck, first, what, spacing in (
    ("soil.nml", 2, "soil that softens and breaks", 0.3),
    ("seepage.nml", 1, "seepage with ponding", 0.05),
    ("coupled.nml", 2, "coupled soil that breaks", 0.6),
):
    whole, head, tail = split(deck, first)
    case.target(f"{what}: split run against whole run", difference(whole, tail), 0.0, BITS)
    for part, run in (("in one piece", whole), ("the second part", tail)):
        case.study(f"{what}, {part}", run, spacing, difference(whole, run))
    case.check_true(
        f"{what}: the second run tells where it started from, and counts its own steps",
        tail.summary["started_from_snapshot"] == head.snapshots()[-1]
        and int(whole.summary["steps"]) == int(head.summary["steps"]) + int(tail.summary["steps"])
        and int(whole.summary["seepage_steps"])
        == int(head.summary["seepage_steps"]) + int(tail.summary["seepage_steps"]),
    )
    history, rest = whole.history(), tail.history()
    rows = len(rest["time"])
    if deck == "soil.nml":
        soil_head = head
    case.check_true(f"{what}: time goes on", np.array_equal(history["time"][-rows:], rest["time"]))
    if deck == "soil.nml":
        case.check(
            "the slide starts with the velocity that the push left [m/s]",
            np.abs(
                np.linalg.norm(tail.field("velocity", "000000"), axis=1).max()
                / np.linalg.norm(head.field("velocity"), axis=1).max()
                - 1.0
            ),
            1e-2,
            "but for the other half step",
        )
        case.picture(
            "Kinetic energy of the push and the slide",
            "Time [s]",
            "Kinetic energy [J/m]",
            {
                "in one run": (history["time"], history["energy_kinetic"]),
                "second run": (rest["time"], rest["energy_kinetic"], "--"),
            },
        )

# Soil that remembers how far it is open.
CLOSING = [
    ("levels = 2  length = 0.9", "levels = 1"),
    ("tension_cutoff = 0.0", "tension_cutoff = 0.0  crack_closure = .true."),
]
whole, _, tail = split("soil.nml", 2, CLOSING, "closing")
case.target("soil that opens and closes: split run against whole run", difference(whole, tail), 0.0, BITS)
case.check_true("some of it is open", whole.field("opening").max() > 0.01)

# The water alone: between two runs with soil it hands on their soil; by itself it keeps none, and soil that
# starts from it is at rest.
_, parts = stages("coupled.nml")
alone = parts[1].replace("kind = 'storm'", "kind = 'storm'  solve = 'seepage'")
between = case.run(
    "coupled.nml",
    without("coupled.nml", [parts[0], *parts[2:]], [*start("coupled.nml", head), (parts[1], alone)]),
    name="water_between",
)
after = case.run(
    "coupled.nml", without("coupled.nml", parts[:2], start("coupled.nml", between)), name="after_water"
)
case.target(
    "soil that a run of the water hands on: displacement",
    np.abs(after.field("displacement", "000000") - head.field("displacement")).max(),
    0.0,
    BITS,
)
water = case.run(
    "coupled.nml", without("coupled.nml", [parts[0], *parts[2:]], [(parts[1], alone)]), name="water_alone"
)
with h5py.File(water.path) as file:
    saved = file["restart"][water.snapshots()[-1]]
    case.check_true("a run of the water alone saves no soil", "stress" not in saved and "content" in saved)
soil = case.run(
    "coupled.nml", without("coupled.nml", parts[1:], start("coupled.nml", water)), name="water_first"
)
case.target(
    "soil that starts from the water alone: pressure",
    np.abs(soil.field("pore_pressure") - water.field("pore_pressure")).max(),
    0.0,
    BITS,
)

# Strength reduction at the end of the rain, in the same run and from the saved state.
_, parts = stages("coupled.nml")
rain = case.run(
    "coupled.nml",
    without("coupled.nml", parts[2:3], [("&soil\n", "&output\n  restart = 'all'\n/\n&soil\n")]),
    name="rain_and_factor",
)
saved = case.run(
    "coupled.nml", without("coupled.nml", parts[:3], start("coupled.nml", rain, "5")), name="saved_factor"
)
for key in ("factor_of_safety", "factor_lower", "factor_upper", "factor_upper_displacement"):
    distance = abs(float(saved.summary[key]) - float(rain.summary[key]))
    case.target(f"{key} from the saved state less that of the run", distance, 0.0, BITS)
early = case.run(
    "coupled.nml", without("coupled.nml", parts[:3], start("coupled.nml", rain, "1")), name="early_factor"
)
case.check(
    "factor of safety after the rain over that before it, from two snapshots of one run",
    float(saved.summary["factor_of_safety"]) / float(early.summary["factor_of_safety"]),
    0.97,
    "the rain takes strength",
)


def refused(what, replace, *expected, snapshot="last", earlier=None):
    """A deck that may not start, and what its messages must say."""
    text = (case.folder / "soil.nml").read_text()
    _, parts = stages("soil.nml")
    earlier = earlier or f"../{soil_head.name}/{soil_head.name}.h5"
    key = f"&initial\n  from_result = '{earlier}'  snapshot = '{snapshot}'\n/\n&soil\n"
    for old, new in without("soil.nml", parts[:2], [("&soil\n", key)]) + list(replace):
        if old not in text:
            sys.exit(f"nothing to replace: {old!r}")
        text = text.replace(old, new)
    place = case.scratch / "refused"
    place.mkdir(exist_ok=True)
    (place / "refused.nml").write_text(text)
    done = subprocess.run(
        [case.options.program, "run", "refused.nml", "--output", "out"],
        cwd=place,
        capture_output=True,
        text=True,
    )
    messages = [line for line in done.stderr.splitlines() if re.match(r"refused\.nml:(\d+:)? error: ", line)]
    good = done.returncode == 2 and not (place / "out").exists()
    good = good and len(messages) == len(expected) and all(any(e in m for m in messages) for e in expected)
    case.check_true(f"refused: {what}" + ("" if good else f"\n{done.stderr}"), good)


(case.scratch / "refused").mkdir(exist_ok=True)
(case.scratch / "refused" / "text.h5").write_text("no HDF5\n")
with h5py.File(case.scratch / "refused" / "other.h5", "w") as file:
    file["data"] = np.zeros(3)
refused("a file that is not HDF5", (), "no HDF5 file", earlier="text.h5")
refused("an HDF5 file of something else", (), "no result file of talus", earlier="other.h5")
refused("no file", (), "no such file", earlier="none.h5")
refused("other nodes", [("crest_width = 4.5", "crest_width = 4.8")], "nodes, this deck")
refused("nodes elsewhere", [("spacing = 0.3", "spacing = 0.3  perturbation = 0.1")], "m there, at (")
refused("no such snapshot", (), "no such snapshot; allowed: '000000', '000004'", snapshot="99")
refused("a snapshot without all of the state", (), "not all of the state was saved", snapshot="3")
refused(
    "without damage and stabilisation",
    [("&damage\n", "&damage  soil = 'silt'\n"), ("length = 0.9", "length = 0.9  stabilisation = 0.0")],
    "has what this deck leaves out: stabilisation",
)
refused(
    "several faults, all at once",
    [("&soil\n  name", "&soil\n  to_y = 2.0  name"), ("&damage", SECOND + "&damage")],
    "nodes lie in another soil there",
    "no such snapshot",
    snapshot="last_good",
)
refused(
    "a second account of the pore pressure and the stress",
    [("snapshot = 'last'", "snapshot = 'last'  stress = 'k0'  lateral_stress_ratio = 0.5")],
    "has a stress already",
)

# The file that a run starts from is not replaced by its results, whatever path leads there.
before = soil_head.path.read_bytes()
deck = (case.scratch / "soil_tail" / "soil_tail.nml").read_text()
(case.scratch / "refused" / f"{soil_head.name}.nml").write_text(deck)
link = case.scratch / "refused" / "link"
link.unlink(missing_ok=True)
link.symlink_to(soil_head.place, target_is_directory=True)
for folder in (f"../{soil_head.name}", "link"):
    done = subprocess.run(
        [case.options.program, "run", f"{soil_head.name}.nml", "--output", folder, "--overwrite"],
        cwd=case.scratch / "refused",
        capture_output=True,
        text=True,
    )
    case.check_true(
        f"results over the file they start from are refused: --output {folder}",
        done.returncode == 2 and "would replace" in done.stderr and soil_head.path.read_bytes() == before,
    )
sys.exit(case.verdict())
