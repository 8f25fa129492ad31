# SPDX-License-Identifier: MIT
"""The same deck gives bitwise the same results with 1, 2 and 4 threads.

Every dataset of the HDF5 file and every history line is compared bit by bit. The deck uses rain,
suction, plasticity, softening, damage, two levels, relaxation and real time.
"""

import sys

import h5py
import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="threads",
    title="bitwise the same results with any number of threads",
    error="share of the datasets that differ",
    quantity="share that differs",
    reference="the run with one thread",
)
SPACING = 0.35  # of the deck
runs = {}
for count in (1, 2, 4):
    runs[count] = case.run("wet.nml", threads=count)
    keep = case.scratch / f"threads_{count}"
    runs[count].place.rename(keep)
    runs[count].place = keep


def datasets(path):
    found = {}
    with h5py.File(path) as file:

        def take(name, item):
            if isinstance(item, h5py.Dataset):
                found[name] = item[()]

        file.visititems(take)
    return found


case.study("1 thread", runs[1], SPACING, 0.0)
first = datasets(runs[1].place / "wet.h5")
changed = [name for name in first if name.endswith("plastic_strain")]
case.check_true("soil yields and water moves", first[changed[-1]].max() > 1e-3)
for threads in (2, 4):
    other = datasets(runs[threads].place / "wet.h5")
    same = first.keys() == other.keys()
    different = [
        name
        for name in first
        if same and np.asarray(first[name]).tobytes() != np.asarray(other[name]).tobytes()
    ]
    case.check_true(f"{threads} threads: the same {len(first)} datasets", same)
    case.study(f"{threads} threads", runs[threads], SPACING, len(different) / len(first))
    case.target(f"datasets that differ with {threads} threads", len(different), 0, f"none of {len(first)}")
    print(f"     different: {different}")
    lines = [(runs[n].place / "wet_history.csv").read_bytes() for n in (1, threads)]
    case.check_true(f"{threads} threads: history equal", lines[0] == lines[1])
curves = {}
for threads, style in ((1, "C7-"), (4, "C0:")):
    history = runs[threads].history()
    last = history["stage"] == "motion"
    time = history["time"][last] - history["time"][last][0]
    curves[f"{threads} thread{'s' if threads > 1 else ''}"] = (
        time,
        history["maximum_displacement"][last],
        style,
    )
case.picture("The slide after the storm", "Time of the slide [s]", "Largest displacement [m]", curves)
sys.exit(case.verdict())
