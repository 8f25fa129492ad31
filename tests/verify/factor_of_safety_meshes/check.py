# SPDX-License-Identifier: MIT
"""D2 and S1: does the factor of safety hang on the mesh?

The slope of factor_of_safety (Griffiths & Lane 1999, example 1, psi = 0: 1.380 by charts) on nested meshes.
Published finite elements without regularisation drift, 1.4217, 1.3867, 1.3093, for h = 0.908, 0.454, 0.227 m.
With two-level smoothing of fixed length the drift of the last two is below 1 %; with one level it is measured
beside it. The second level needs h <= ell/3, which leaves 0.454 and 0.227 m of these to ell = 1.4 m; with
ell = 2.8 m the first two share a length. The brackets are 0.002 wide, so
drifts are known to 0.15 %. The finest meshes take most of the time.
"""

import sys

sys.path.insert(0, __file__.rsplit("/", 2)[0])
from talus_case import Case  # noqa: E402

case = Case(
    __file__.rsplit("/", 1)[0],
    id="D2",
    title="Factor of safety over the mesh (D2, and S1 converged)",
    error="relative difference of the factor of safety from 1.380",
    reference="charts of Bishop & Morgenstern 1.380; published drift on nested meshes without regularisation",
    quantity="|F/1.380 - 1|",
    order=False,
    work=False,
)
CHARTS = 1.380
PUBLISHED = {0.908: 1.4217, 0.454: 1.3867, 0.227: 1.3093}
FINE = [
    ("steps_max = 10000", "steps_max = 100000"),
    ("factor_tolerance = 0.01", "factor_tolerance = 0.002"),
    ("factor_first = 1.0", "factor_first = 1.3"),
]
SERIES = {
    "one level": ("levels = 1", (0.908, 0.454, 0.227)),
    "two levels, ell = 1.4 m": ("levels = 2\n  length = 1.4", (0.454, 0.32, 0.227)),
    "two levels, ell = 2.8 m": ("levels = 2\n  length = 2.8", (0.908, 0.454)),
}
if not case.full:
    SERIES = {"two levels, ell = 2.8 m": SERIES["two levels, ell = 2.8 m"]}

found, seconds = {}, {}
for series, (levels, spacings) in SERIES.items():
    for h in spacings:
        result = case.run(
            "../factor_of_safety/slope.nml",
            [("levels = 1", levels), *FINE, ("spacing = 0.45", f"spacing = {h}")],
            name=f"{series}_{h}".replace(" ", "_").replace(",", ""),
        )
        found[series, h] = factor = float(result.summary["factor_of_safety"])
        seconds[series, h] = float(result.summary["wall_seconds"])
        print(f"     {series}, h = {h} m: factor {factor:.4f}")
        case.study(series, result, h, abs(factor / CHARTS - 1.0))


def drift(series, spacings=(0.454, 0.227)):
    coarse, fine = (found[series, h] for h in spacings)
    return abs(coarse - fine) / fine


series = "two levels, ell = 2.8 m"
case.check(f"drift from h = 0.908 to 0.454 m, {series}", drift(series, (0.908, 0.454)), 0.01, "as D2")
if not case.full:
    sys.exit(case.verdict())

published = abs(PUBLISHED[0.454] - PUBLISHED[0.227]) / PUBLISHED[0.227]
two = "two levels, ell = 1.4 m"
for series in ("one level", two):
    fine = found[series, 0.227]
    case.target(f"factor of safety, {series}, h = 0.227 m", fine, 1.41, "S1; charts 1.380", low=1.35)
case.target(
    f"drift of the factor from h = 0.454 to 0.227 m, {two}",
    drift(two),
    0.01,
    "D2; published 5.9 %",
    asked=True,
)
case.remedy(
    "a factor of safety that drifts with the mesh (psi = 0); remedy: smoothing over a fixed length",
    "one level: " + ", ".join(f"{found['one level', h]:.4f}" for h in PUBLISHED) + " for h = 0.908, 0.454, "
    f"0.227 m, {100 * drift('one level'):.2f} % between the last two (published: {100 * published:.1f} %)",
    f"ell = 1.4 m: {100 * drift(two):.2f} % (brackets are 0.15 % wide)",
    drift("one level") > drift(two),
)
case.note(
    f"Mesh-converged factor of safety of S1: {found[two, 0.227]:.3f} with ell = 1.4 m (h = 0.227 m; brackets "
    f"are 0.002 wide); with one level {found['one level', 0.227]:.3f} at that spacing."
)
case.picture(
    "Factor of safety over wall time",
    "Wall time [s]",
    "Factor of safety [-]",
    {
        **{
            s: ([seconds[s, h] for h in SERIES[s][1]], [found[s, h] for h in SERIES[s][1]], "o-")
            for s in SERIES
        },
        "charts of Bishop & Morgenstern": (
            [min(seconds.values()), max(seconds.values())],
            [CHARTS, CHARTS],
            "k:",
        ),
    },
    log_x=True,
)
case.picture(
    "Factor of safety over node spacing",
    "Node spacing h [m]",
    "Factor of safety [-]",
    {
        **{s: (SERIES[s][1], [found[s, h] for h in SERIES[s][1]], "o-") for s in SERIES},
        "published, no regularisation": (list(PUBLISHED), list(PUBLISHED.values()), "ks--"),
        "charts of Bishop & Morgenstern": ([0.227, 0.908], [CHARTS, CHARTS], "k:"),
    },
)
sys.exit(case.verdict())
