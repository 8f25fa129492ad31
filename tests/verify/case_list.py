# SPDX-License-Identifier: MIT
"""Which cases there are, and which of them a user's words mean."""

import ast
import re
from dataclasses import dataclass
from pathlib import Path

# The order of the report: the benchmarks' letters, then what has no number, then the hard cases.
GROUPS = (
    ("M", "Operators and mechanics"),
    ("D", "Localisation"),
    ("H", "Seepage and coupling"),
    ("S", "Slopes"),
    ("", "Further properties of the program"),
    ("hard", "Hard cases"),
)

# Benchmarks that must or should be met (P1 and P2 of benchmarks.md), and the hard cases.
WANTED = (
    *(f"M{i}" for i in range(1, 8)),
    *(f"D{i}" for i in range(1, 4)),
    *(f"H{i}" for i in range(1, 8)),
    *("S1", "S3", "S4"),
    *(f"hard {i}" for i in range(1, 12)),
)


@dataclass(frozen=True)
class CaseFile:
    """A check.py that is built on talus_case.py."""

    kind: str  # verify or hard, the folder it lies in
    name: str
    id: str
    about: str  # its docstring
    path: Path

    @property
    def key(self):
        """Name of its stored files."""
        return f"{self.kind}_{self.name}"

    @property
    def label(self):
        """'celia (H3)'."""
        return f"{self.name} ({self.id})" if self.id else self.name


def find_cases(tests):
    """All cases of tests/verify and tests/hard, in the order of the report."""
    found = []
    for kind in ("verify", "hard"):
        for path in sorted((Path(tests) / kind).glob("*/check.py")):
            tree = ast.parse(path.read_text(encoding="utf-8"), str(path))
            call = next((n for n in ast.walk(tree) if calls_case(n)), None)
            if call is not None:
                about = ast.get_docstring(tree) or ""
                found.append(CaseFile(kind, path.parent.name, id_of(call), about, path))
    return sorted(found, key=lambda case: report_order(case.kind, case.id, case.name))


def calls_case(node):
    """Is this `Case(...)`?"""
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Case"


def id_of(call):
    """The id that a call of Case is given as plain text, or nothing."""
    values = [word.value for word in call.keywords if word.arg == "id"] + call.args[1:2]
    texts = [v.value for v in values if isinstance(v, ast.Constant) and isinstance(v.value, str)]
    return texts[0] if texts else ""


def group_of(kind, id):
    """Letter of GROUPS that a case belongs to."""
    if kind == "hard":
        return "hard"
    letter = re.match(r"([MDHS])\d", id)
    return letter[1] if letter else ""


def report_order(kind, id, name):
    """Sorting key: group, number in the id, id, name."""
    letters = [letter for letter, _ in GROUPS]
    number = re.search(r"\d+", id)
    return letters.index(group_of(kind, id)), int(number[0]) if number else 0, id, name


def without_case(ids):
    """Which of WANTED no case has in its id; 'H5 rigid' and 'S1, S3' count for what they name."""
    named = {word for id in ids for word in re.findall(r"[MDHS]\d+|hard \d+", id)}
    return [id for id in WANTED if id not in named]


def words_of(case):
    """Every word that means this case, without blanks and in lower case."""
    words = {case.name, case.key, case.kind}
    if case.id:
        # 'H5 coupled' is meant by H5 too, and 'S1, S3' by either.
        words |= {case.id, *re.split(r"\s*[,/&+]\s*", case.id)}
        words |= {word for word in case.id.replace(",", " ").split() if re.fullmatch(r"[A-Z]\d+", word)}
    return {plain(word) for word in words}


def plain(word):
    return re.sub(r"[\s_-]+", "", word).lower()


def select_cases(cases, words):
    """The cases that the words mean (all, without words), and the words that mean none.

    A number belongs to the word before it: `hard 4` is one case, as `hard4` is.
    """
    wanted = []
    for word in words:
        if re.fullmatch(r"\d+[a-z]?", word) and wanted and re.fullmatch(r"[A-Za-z]+", wanted[-1]):
            wanted[-1] += word
        else:
            wanted.append(word)
    unknown = [word for word in wanted if not any(plain(word) in words_of(case) for case in cases)]
    chosen = {plain(word) for word in wanted}
    return [case for case in cases if not wanted or chosen & words_of(case)], unknown
