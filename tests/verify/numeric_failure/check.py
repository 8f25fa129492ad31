# SPDX-License-Identifier: MIT
"""A run whose numbers fail, and the exit codes of the program (README: 0 done, 1 files, 2 input, 3 numerics).

A crushed block ends with exit code 3, a message with stage, time, step, node, place and quantity, and
a readable snapshot last_good that is finite everywhere. Results that exist are not touched without
--overwrite, and unknown options and words are refused; both with exit code 2.
"""

import hashlib
import re
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="numeric failure",
    title="a run whose numbers fail ends in order",
    error="none",
    reference="README: exit codes 0 done, 1 files, 2 input, 3 numerics",
)
result = case.run("crush.nml", code=3)
message = result.done.stderr
print("     " + message.strip())
case.check_true(
    "message names stage, time, step, node, place and quantity",
    re.search(
        r"stage crush, time [0-9.e+-]+ s, step \d+, node \d+ at \([0-9.e+-]+, [0-9.e+-]+\) m: "
        r"the (soil is turned inside out|stress is not a finite number)",
        message,
    )
    is not None,
)
case.check_true("no backtrace", "Backtrace" not in message and message.count("\n") == 1)
with h5py.File(result.path) as file:
    good = file["snapshots/last_good"]
    case.check_true("last_good is finite", all(np.isfinite(good[name][:]).all() for name in good))
    case.check_true("last_good tells its time", 0 <= good.attrs["time"] < 1.0)
case.check_true(
    "the summary tells the failure",
    result.summary["exit_code"] == "3" and "inside out" in result.summary["failure"] + message,
)


def talus(*words):
    return subprocess.run([case.options.program, *words], cwd=result.place, capture_output=True, text=True)


def digest():
    return [hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(result.place.iterdir())]


case.picture(
    "Velocity one step before a crushed block turns inside out",
    "Vertical velocity [m/s]",
    "Height [m]",
    {
        "snapshot last_good, all nodes": (
            result.field("velocity", "last_good")[:, 1],
            result.nodes[:, 1],
            "C0.",
        )
    },
)
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
