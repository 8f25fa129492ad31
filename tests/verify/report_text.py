# SPDX-License-Identifier: MIT
"""The text of tests/README.md, from the stories of the cases."""

import math
import re

from case_list import GROUPS, group_of, without_case

INTRODUCTION = """\
Written by `./talus verify`, which runs every case of [verify]({tests}/verify) and [hard]({tests}/hard)
with the real program, at all of its spacings, and compares with exact or published answers.
`./talus verify H3` (or `celia`, `hard4`, `hard`) runs a few and updates theirs; `./talus test` runs a
quick subset, without a report. Limits are part of the cases; nothing is fitted to pass. Tables:
[studies.csv](report/studies.csv), [targets.csv](report/targets.csv); all that was measured: the JSON
files in [report](report)."""

TIMES = """\
Times are wall times of the whole program, set-up and output included, with one thread, while other cases
ran on the other processors; runs of a tenth of a second vary by some tens of percent. Where a time is
compared, the run is the median of three. Node-steps per second are of the soil's steps, or of the water's
sub-steps where only water moves."""


# The targets that the requirements name, in their words, by the id of a case or the first word of it.
ASKED = {
    "M1": "machine precision",
    "M2": "machine precision",
    "M3": "order ≥ 1.9 in displacement (L2) for one level",
    "M4": "≤ 0.5 % at 20 nodes of depth",
    "M5": "arrival within 0.5 %; three lowest omega² within 5 % at one level, 10 % with ell = 3 h",
    "M6": "≤ 0.2 % in tan(phi)",
    "M7": "≤ 3 % at 20 nodes per half width",
    "D1": "with two levels, band width within 10 % and work within 2 % over h = ell/4, /8, /16",
    "D2": "with two levels the drift stops: < 1 % between the last two meshes",
    "D3": "inclination of the band between 45 + psi/2 and 45 + phi/2 degrees, peak and width converged",
    "H1": "≤ 0.5 % (L2, finest)",
    "H2": "≤ 0.1 % at 201 nodes, in less time than OpenGeoSys needs for that error",
    "H3": "≤ 1.5 % at 201 nodes, in less time than OpenGeoSys needs for that error",
    "H4": "≤ 0.5 %",
    "H5": "rigid ≤ 1 %, and the coupled run beside it",
    "H6": "≤ 1 %",
    "S1": "between 1.35 and 1.41 by strength reduction, with the mesh-converged value",
    "S1 bracket": "c/(gamma H) = 0.02 falls",
    "S3": "≤ 1 %",
    "S4": "failure line within 5 mm",
    "demo": "energy error ≤ 1e-3",
    "energy": "energy error ≤ 1e-3",
    "vertical cut": "energy error ≤ 1e-3",
    "hard 2": "three rigid modes, no spurious soft ones, right omega²; drift < 1e-6 over 1e5 steps",
    "hard 3": "tip deflection within 5 %",
    "hard 4": "water error ≤ 1e-12",
    "hard 6": "energy error ≤ 1e-3",
    "hard 7": "energy error ≤ 1e-3, water error ≤ 1e-12",
    "hard 8": "stable at 0.99 of the estimated step, not at 1.10",
    "hard 9": "half the step, and twice the stabilisation, change the displacement by < 1 %",
    "hard 10": "at three spacings time of failure within 3 %, mass of the slide within 5 %",
}


def number(value):
    """Three digits, four from 0.1 on, plain where that is readable: 0.00835, 1.381, 1.3e-13, 402."""
    if value is None:
        return "-"
    if not math.isfinite(value):
        return str(value)
    if value == int(value) and abs(value) < 1e6:
        return str(int(value))
    if 1e-3 <= abs(value) < 1e6:
        digits = max(0, (4 if abs(value) >= 0.1 else 3) - 1 - math.floor(math.log10(abs(value))))
        text = f"{value:.{digits}f}"
        return text.rstrip("0").rstrip(".") if "." in text else text
    mantissa, exponent = f"{value:.2e}".split("e")
    return f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}"


def cell(text):
    """Text of a table's cell."""
    return str(text).replace("|", "\\|").replace("\n", " ")


def table(head, rows, right=()):
    """A Markdown table; `right` holds the numbers of the columns that are aligned to the right."""
    rule = ["--:" if i in right else "---" for i in range(len(head))]
    lines = [[cell(value) for value in row] for row in (head, *rows)]
    lines.insert(1, rule)
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def wanted(target):
    """'<= 0.015' or '1.35 to 1.41'."""
    if target["low"] is None:
        return f"≤ {number(target['limit'])}"
    return f"{number(target['low'])} to {number(target['limit'])}"


def anchor(story):
    """The heading's anchor, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", heading(story).lower()).replace(" ", "-")


def heading(story):
    words = story["title"] or story["case"].replace("_", " ")
    words = words[:1].upper() + words[1:]
    text = f"{story['id']}: {words}" if re.search(r"\d", story["id"]) else words
    return text[:1].upper() + text[1:]


def link(story):
    return f"[{story['id'] or story['case']}](#{anchor(story)})"


def report_text(stories, missing, pictures, run, tests):
    """All of tests/README.md.

    `missing`: cases without results; `pictures`: (path, caption) by key; `run`: facts about the last run
    of all cases; `tests`: relative path of the folder of sources.
    """
    parts = ["# Verification report", verdict(stories, missing), "", INTRODUCTION.format(tests=tests)]
    parts += ["", machines(stories, run), "", TIMES, "", "## Targets", "", targets_tables(stories)]
    for letter, title in GROUPS:
        members = [s for s in stories if group_of(s["kind"], s["id"]) == letter]
        if members:
            parts += ["", f"## {title}"]
        for story in members:
            parts += ["", case_text(story, pictures[story["key"]], tests)]
    return "\n".join(parts) + "\n"


def verdict(stories, missing):
    """The first lines: what failed, is not met, or met only as worded; what has not run, or has no case."""
    targets = [(s, t) for s in stories for t in s["targets"]]
    missed = [(s, t) for s, t in targets if not t["met"]]
    lines = [""]
    for s in stories:
        if s["trouble"]:
            lines += [f"**Failed: {link(s)}**, {s['trouble']}", ""]
        elif s["failures"]:
            lines += [f"**Failed: {link(s)}**, {s['failures']} of its checks.", ""]
    if missed:
        lines += [f"**{len(missed)} of {len(targets)} targets are not met:**", ""]
        lines += [
            f"- {link(s)} {t['what']}: **{number(t['value'])}** measured, {wanted(t)} wanted ({t['why']})"
            for s, t in missed
        ]
    elif targets:
        lines += [f"**All {len(targets)} targets are met.**"]
    cautions = [f"- {link(s)} {text}" for s in stories for text in s["cautions"]]
    if cautions:
        lines += ["", "**Met as worded, read with care:**", "", *cautions]
    if missing:
        lines += ["", f"No results yet of: {', '.join(case.label for case in missing)}."]
    absent = without_case([s["id"] for s in stories] + [case.id for case in missing])
    if absent:
        lines += ["", f"**Without a case: {', '.join(absent)}.**"]
    return "\n".join(lines)


def machines(stories, run):
    """Machine, compiler, version, dates and times of what is reported."""

    def all_of(name):
        return " and ".join(sorted({str(s[name]) for s in stories if s.get(name)})) or "unknown"

    dates = sorted({s["date"] for s in stories if s.get("date")})
    when = dates[0] if len(dates) == 1 else f"{dates[0]} to {dates[-1]}" if dates else "unknown"
    seconds = sum(s.get("case_seconds", 0.0) for s in stories)
    lines = [
        f"Machine: {all_of('machine')}. Compiler: {all_of('compiler')}. "
        f"Program: TALUS {all_of('version')}. Date: {when}.",
        f"The {len(stories)} cases take {seconds:.0f} s, added up"
        + (
            f"; the last run of all of them took {run['elapsed']} s with {run['jobs']} at a time, "
            f"and began with {run['load']} jobs at work on the machine."
            if run
            else "."
        ),
    ]
    return "\n".join(lines)


def targets_tables(stories):
    """A table of the targets asked for, then one of our own for each group.

    Targets of a case that differ in the run only are one row.
    """
    parts, rows = [], []
    told = set()
    for s in stories:
        name = s["id"] if s["id"] in ASKED else s["id"].split(" ")[0]
        for row in collapsed([t for t in s["targets"] if t.get("asked")]):
            rows.append([link(s), "" if name in told else ASKED.get(name, ""), *row[:-1]])
            told.add(name)
    if rows:
        head = ["case", "asked for", "target", "measured", "wanted", "met"]
        parts += ["**Asked for**", "", table(head, rows, right=(3, 4)), ""]
    for letter, title in GROUPS:
        rows = [
            [link(s), *row]
            for s in stories
            if group_of(s["kind"], s["id"]) == letter
            for row in collapsed([t for t in s["targets"] if not t.get("asked")])
        ]
        if rows:
            head = ["case", "target", "measured", "wanted", "met", "why this"]
            parts += [f"**Our own: {title.lower()}**", "", table(head, rows, right=(2, 3)), ""]
    return "\n".join(parts[:-1])


def collapsed(targets):
    """Rows of targets: those with the same words after the last ': ' and the same limits become one.

    Its measured value is the worst of them, or the range where both ends are limited. A target that is
    not met keeps a row of its own.
    """
    groups = {}
    for t in targets:
        same = (t["what"].rsplit(": ", 1)[-1], t["low"], t["limit"], t["why"]) if t["met"] else id(t)
        groups.setdefault(same, []).append(t)
    rows = []
    for members in groups.values():
        first, values = members[0], [t["value"] for t in members]
        what, measured = first["what"], number(max(values))
        if len(members) > 1:
            what = f"{what.rsplit(': ', 1)[-1]} ({len(members)} runs"
            what += ", the worst)" if first["low"] is None else ")"
            if first["low"] is not None and number(min(values)) != measured:
                measured = f"{number(min(values))} to {measured}"
        rows.append(
            [what, f"**{measured}**", wanted(first), "yes" if first["met"] else "**no**", first["why"]]
        )
    return rows


def study_columns(story):
    """Head and rows of the study, from coarse to fine in each series."""
    order = list(dict.fromkeys(r["series"] for r in story["runs"]))
    rows = [
        [
            r["series"],
            r["nodes"],
            number(r["spacing"]),
            number(r["error"]),
            "-" if r["order"] is None else f"{r['order']:.2f}",
            f"{r['seconds']:.3g}" + (f" (median of {r['repeats']})" if r.get("repeats", 1) > 1 else ""),
            "-" if r["node_steps_per_second"] is None else f"{r['node_steps_per_second'] / 1e6:.2f}",
            r["smoothing"],
            number(r["stabilisation"]),
        ]
        for r in sorted(story["runs"], key=lambda r: (order.index(r["series"]), -r["spacing"]))
    ]
    head = ["series", "nodes", "spacing [m]", story.get("quantity", "error"), "order", "wall [s]"]
    return [*head, "10⁶ node-steps/s", "smoothing", "stabilisation"], rows


def study_lines(story):
    """The study as lines of a terminal."""
    head, rows = study_columns(story)
    lines = [[str(word) for word in row] for row in [head, *rows]]
    widths = [max(len(row[i]) for row in lines) for i in range(len(head))]
    return ["  ".join(word.ljust(width) for word, width in zip(row, widths)).rstrip() for row in lines]


def published_table(story):
    rows = [
        [p["program"], p["nodes"] or "-", number(p["error"]), number(p["seconds"])]
        for p in story["published"]
    ]
    return table(["others, published", "nodes", "error", "wall [s]"], rows, right=(1, 2, 3))


def case_text(story, pictures, tests):
    """One case: what it is, its reference, tables, targets, remedies, notes and pictures."""
    folder = f"{tests}/{story['kind']}/{story['case']}"
    facts = [f"Case: [{story['kind']}/{story['case']}]({folder})"]
    facts += [
        f"{name}: {story[name].rstrip('.')}"
        for name in ("reference", "error")
        if story[name] not in ("", "none")
    ]
    took = f"{story.get('case_seconds', 0.0):g} s on {story.get('date', 'an unknown date')}"
    parts = [f"### {heading(story)}", "", about(story["about"]), "", "; ".join(facts) + f". It took {took}."]
    if story["trouble"]:
        parts += ["", f"**It failed:** {story['trouble']}"]
    if not story.get("full", True):
        parts += ["", "Run at its quick spacings only."]
    if story["runs"]:
        parts += ["", table(*study_columns(story), right=range(1, 7))]
    if story["published"]:
        parts += ["", published_table(story), "", f"Source of these: {story['published_source']}"]
    if story["targets"]:
        rows = [
            [t["what"], f"**{number(t['value'])}**", wanted(t), "yes" if t["met"] else "**no**"]
            for t in story["targets"]
        ]
        parts += ["", table(["target", "measured", "wanted", "met"], rows, right=(1, 2))]
    if story["remedies"]:
        rows = [[r["what"], r["without"], r.get("by", "TALUS"), r["remedied"]] for r in story["remedies"]]
        parts += ["", table(["hazard and remedy", "without the remedy", "run without by", "with it"], rows)]
    for extra in story["tables"]:
        parts += ["", f"{extra['name']}:", "", table(extra["head"], extra["rows"])]
    if story.get("checks"):
        parts += ["", checks_line(story)]
    parts += ["", *[f"- {text}" for text in story["notes"]]] if story["notes"] else []
    for path, caption in pictures:
        parts += ["", f"![{cell(caption)}](report/{path.name})", "", f"*{caption}*"]
    return "\n".join(parts)


def checks_line(story):
    """How many checks there were besides the targets."""
    failed = story["failures"]
    return f"{story['checks']} checks beside targets and remedies" + (
        f"; **{failed} checks of the case failed**." if failed else " hold."
    )


def about(text):
    """The docstring of a check as paragraphs; its first line is a sentence of its own."""
    return "\n\n".join(" ".join(part.split()) for part in text.split("\n\n"))
