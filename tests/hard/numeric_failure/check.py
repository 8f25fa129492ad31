# SPDX-License-Identifier: MIT
"""A run whose numbers fail, and the exit codes of the program (README: 0 done, 1 files, 2 input, 3 numerics).

A block that is crushed (det F <= 0) and one whose numbers overflow end with exit code 3, a message with
stage, time, step, node, place and quantity, and a snapshot last_good that is finite everywhere, from which
another run goes on when the cause is taken away. Results that exist are not touched without --overwrite,
and unknown options and words are refused; both with exit code 2.
"""

import hashlib
import pathlib
import re
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "verify"))
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="hard 11",
    title="det F <= 0 and numbers that overflow",
    error="greatest difference of displacement from last_good [m]",
    order=False,
    reference="exit code 3, node and place, restartable",
)
PLACE = r"time [0-9.e+-]+ s, step \d+, node (\d+) at \(([0-9.e+-]+), ([0-9.e+-]+)\) m: "


def failure(result, stage, what):
    """The message of a failed run names stage, time, step, node, its place, and what went wrong."""
    message = result.done.stderr.splitlines()[-1]
    print("     " + message)
    found = re.search(rf"stage {stage}, {PLACE}{what}", message)
    good = found is not None
    if good:
        at = result.nodes[int(found.group(1)) - 1]
        good = np.allclose(at, [float(found.group(2)), float(found.group(3))], rtol=1e-6)
    case.check_true(f"{stage}: message names stage, time, step, node, place and quantity", good)
    case.check_true(f"{stage}: the summary has the exit code", result.summary["exit_code"] == "3")
    with h5py.File(result.path) as file:
        state = file["snapshots/last_good"]
        finite = all(np.isfinite(state[name][:]).all() for name in state)
        saved = file["restart/last_good"]
        finite = finite and all(np.isfinite(saved[name][:]).all() for name in saved)
    case.check_true(f"{stage}: last_good is finite", finite)


def start(result):
    """Replacement that makes a deck start from the last good state of a run."""
    key = f"&initial\n  from_result = '../{result.name}/{result.name}.h5'  snapshot = 'last_good'\n/\n"
    return ("&soil\n", key + "&soil\n")


GRAVITY = "&stage\n  name = 'rest'\n  kind = 'geostatic'\n/\n"
result = case.run("crush.nml", code=3)
message = result.done.stderr
failure(result, "crush", r"the soil is turned inside out \(det F <= 0\)")

# The crushed block under a load that it bears: relaxed from the last good state it finds its equilibrium.
LIGHT = [
    ("pressure = 1.0e6", "pressure = 2.0e3"),
    (GRAVITY, ""),
    (
        "kind = 'dynamic'\n  duration = 1.0",
        "kind = 'storm'\n  solve = 'soil'\n  duration = 1.0\n  storm_step = 1.0\n  tolerance = 1.0e-7",
    ),
]
light = case.run("crush.nml", [*LIGHT, start(result)], name="lightened")
direct = case.run("crush.nml", LIGHT, name="never_crushed")
case.check_true(
    "crushed block: from last_good under a light load it finds equilibrium, and its time goes on",
    light.summary["failed"] == ".false."
    and abs(float(light.summary["simulated_seconds"]) - 1.0 - float(result.summary["simulated_seconds"]))
    < 1e-3,
)
settled = direct.field("displacement")
distance = np.abs(light.field("displacement") - settled).max() / np.abs(settled).max()
case.note(
    f"The displacement left differs by {distance:.2g} of that of a block that was never crushed: the rate "
    "law of stress depends on the path where the elastic strain is as large (src/THEORY.md section 7)."
)
with h5py.File(result.path) as file:
    left = np.abs(light.field("displacement", "000000") - file["snapshots/last_good/displacement"][:]).max()
case.target(
    "it starts from the displacement of last_good: greatest difference [m]", float(left), 0.0, "bit by bit"
)
case.study("crushed, gone on from last_good", light, 0.1, left)
middle = np.flatnonzero(np.abs(light.nodes[:, 0] - 0.5) < 1e-6)
middle = middle[np.argsort(light.nodes[middle, 1])]
height = light.nodes[middle, 1]
case.picture(
    "Under the light load, in the middle of the block",
    "Settlement [mm]",
    "Height [m]",
    {
        "last_good, before it": (-1e3 * light.field("displacement", "000000")[middle, 1], height, "o-"),
        "gone on from last_good": (-1e3 * light.field("displacement")[middle, 1], height, "s-"),
        "never crushed": (-1e3 * settled[middle, 1], height, "k--"),
    },
)

# Numbers that overflow. A debug program stops where that happens, by signal 8, and writes no summary.
try:
    result_overflow = case.run("overflow.nml", code=(3, -8))
except FileNotFoundError:
    result_overflow = None
    case.note("This program traps the overflow itself.")
if result_overflow is not None:
    failure(result_overflow, "pull", "the stress is not a finite number")
    sound = case.run(
        "overflow.nml",
        [
            ("youngs_modulus = 1.0e-150", "youngs_modulus = 1.0e6"),
            ("traction_y = 1.0e10", "traction_y = 1.0e3"),
            start(result_overflow),
        ],
        name="sound",
    )
    case.check_true(
        "pull: runs from last_good with a sound modulus", np.isfinite(sound.field("stress")).all()
    )
case.remedy(
    "numbers that fail; remedy: stop, name the place, save the last good state",
    f"{result.summary['failure'].split(': ', 1)[1].split(';')[0]} after {result.summary['steps']} steps",
    f"the run from last_good ends with exit code 0 at {float(light.summary['simulated_seconds']):.4g} s, "
    f"largest displacement {float(light.summary['maximum_displacement']):.3g} m",
    result.summary["exit_code"] == "3",
)
case.check_true("no backtrace", "Backtrace" not in message and message.count("\n") == 1)


def talus(*words):
    return subprocess.run([case.options.program, *words], cwd=result.place, capture_output=True, text=True)


def digest():
    return [hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(result.place.iterdir())]


before = digest()
done = talus("run", "crush.nml", "--output", ".")
case.check_true(
    "results are kept without --overwrite: exit code 2", done.returncode == 2 and "--overwrite" in done.stderr
)
case.check_true("every file is unchanged", digest() == before)
for words in (
    ["run", "crush.nml", "--no-such-option"],
    ["walk", "crush.nml"],
    ["run"],
    ["run", "crush.nml", "--threads", "none"],
    ["run", "crush.nml", "other.nml"],
):
    done = talus(*words)
    case.check_true(
        f"refused with exit code 2: {' '.join(words)}", done.returncode == 2 and len(done.stderr) > 0
    )
done = talus("run", "no_such_deck.nml")
case.check_true(
    f"a deck that is not there: exit code {done.returncode}",
    done.returncode in (1, 2) and "no_such_deck.nml" in done.stderr,
)
case.check_true("nothing else was written", digest() == before)
sys.exit(case.verdict())
