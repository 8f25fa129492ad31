# SPDX-License-Identifier: MIT
"""H4, Terzaghi's column: loaded at once without drainage, then drained through its top.

Reference: U(T_v) of benchmarks.md H4, with c_v = k/(gamma_w (1/M + S_s)). The load is carried by the
pore water but for the share S_s/(S_s + 1/M). Limit 2 % of the final value for pressure and
settlement (the aim is 0.5 %), 0.5 % for the undrained pressure. S_s = 1/M here: the soil follows
each step of the water without drainage, which is accurate while the staggering number of the summary
stays below 10 (src/THEORY.md section 5.6).
"""

import sys

import h5py
import numpy as np

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

MODULUS, STORAGE, LOAD, CONDUCTIVITY, WATER = 1.0e7, 1.0e-7, 1.0e4, 1.0e-7, 9810.0
EXACT = {0.05: 0.2523, 0.1: 0.3568, 0.2: 0.5041, 0.4: 0.6979, 0.6: 0.8156, 0.9: 0.9120}

case = Case(__file__.rsplit("/", 1)[0])
result = case.run("column.nml")
c_v = CONDUCTIVITY / (WATER * (1 / MODULUS + STORAGE))
undrained = LOAD / (1 + STORAGE * MODULUS)
top = result.nodes[:, 1] > 1 - 1e-6
still = WATER * (1 - result.nodes[:, 1])
seen = []
with h5py.File(result.path) as file:
    for name in result.snapshots():
        group = file["snapshots"][name]
        stage = group.attrs["stage"]
        stage = stage.decode() if isinstance(stage, bytes) else stage
        excess = group["pore_pressure"][:] - still
        settlement = -group["displacement"][:, 1][top].mean()
        if stage == "load" and group.attrs["time"] > 0:
            case.check(
                "undrained pressure",
                np.abs(excess / undrained - 1).max(),
                5e-3,
                "the weight strains the column by 0.1 to 0.2 % first",
            )
        if stage != "drain":
            continue
        reached = c_v * group.attrs["time"]
        for time, degree in EXACT.items():
            if abs(reached - time) > 1e-6:
                continue
            seen.append(time)
            mean = 1 - np.sum(excess * result.area) / np.sum(result.area) / undrained
            settled = (settlement * MODULUS / LOAD - 0.5) / 0.5
            case.check(f"T_v = {time}: degree by pressure {mean:.4f}", abs(mean - degree), 0.02, "issue 2")
            case.check(
                f"T_v = {time}: degree by settlement {settled:.4f}", abs(settled - degree), 0.02, "issue 2"
            )
case.check_true("all times of the table were reached", sorted(seen) == sorted(EXACT))
case.check("staggering number", float(result.summary["staggering_number"]), 10.0, "src/THEORY.md section 5.6")
case.check("water balance", float(result.summary["water_error"]), 1e-12, "round-off")
sys.exit(case.verdict())
