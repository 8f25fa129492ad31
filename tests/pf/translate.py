#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Translate a pFUnit test suite (.pf) into a Fortran program for the module funit beside this file.

Understands a subset of pFUnit (the directives and asserts below), and refuses what pFUnit itself would
refuse or silently skip, so that a suite which passes here also means something there. Line markers
keep compiler messages and failures on the lines of the .pf file.
"""

import argparse
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

ASSERTS = {
    name.lower(): name
    for name in (
        "assertEqual",
        "assertTrue",
        "assertFalse",
        "assertLessThan",
        "assertLessThanOrEqual",
        "assertGreaterThan",
        "assertGreaterThanOrEqual",
        "assertRelativelyEqual",
        "assertIsFinite",
        "assertIsNaN",
        "assertFail",
    )
}
# pFUnit adds to an assert's line; beyond this its line could pass Fortran's limit of 132.
LONGEST_ASSERT = 105

DIRECTIVE = re.compile(r"\s*@(\w+)\s*(?:\((.*)\))?\s*$")
SUBROUTINE = re.compile(r"\s*subroutine\s+(\w+)\s*(?:\(([\w\s,]*)\))?\s*(?:!.*)?$", re.I)
TYPE = re.compile(r"\s*type\b.*?(?:::\s*|\s)(\w+)\s*$", re.I)
MODULE = re.compile(r"\s*module\s+(\w+)\s*$", re.I)


class PfError(Exception):
    """A line the translator refuses."""


@dataclass
class Suite:
    """What the directives of one .pf file declare."""

    module: str = ""
    tests: list = field(default_factory=list)  # (name, disabled)
    before: str = ""
    after: str = ""
    case: str = ""
    constructor: str = ""
    parameter: str = ""
    parameters: str = ""


def option(text, pattern):
    """Value of an option inside a directive's parentheses, or ''."""
    match = re.search(pattern, text or "", re.I)
    return match.group(1) if match else ""


def assert_lines(line, number, name):
    """Fortran for one @assert line."""
    match = DIRECTIVE.match(line)
    if not match or match.group(2) is None:
        raise PfError("an assert stands alone on one line, without continuation or comment")
    word, arguments = match.group(1).lower(), match.group(2).strip()
    if word not in ASSERTS:
        raise PfError(f"@{match.group(1)} is not supported; there are: " + ", ".join(ASSERTS.values()))
    if len(line.rstrip()) > LONGEST_ASSERT:
        raise PfError(f"an assert line holds at most {LONGEST_ASSERT} columns")
    comma = ", " if arguments else ""
    return [
        f"call {ASSERTS[word]}({arguments}{comma}&",
        f"  location=SourceLocation('{name}', {number}))",
        "if (anyExceptions()) return",
        f'# {number + 1} "{name}"',
    ]


class Translator:
    """Reads the lines of one .pf file in order."""

    def __init__(self, path):
        self.path = path
        self.lines = path.read_text(encoding="utf-8").splitlines()
        self.at = 0
        self.suite = Suite()
        self.out = [f'# 1 "{path.name}"']

    def fail(self, reason):
        raise PfError(f"{self.path}:{self.at}: {reason}")

    def next_code(self):
        """The next line that is neither blank nor comment; skipped lines are kept."""
        while self.at < len(self.lines):
            line = self.lines[self.at]
            self.at += 1
            if line.strip() and not line.lstrip().startswith("!"):
                return line
            self.out.append(line)
        return self.fail("the file ends after a directive")

    def declared(self, pattern, what):
        """The name declared by the line after a directive, and that line."""
        line = self.next_code()
        match = pattern.match(line)
        if not match:
            self.fail(f"expected {what} after the directive, found: {line.strip()}")
        self.out.append(line)
        return match.group(1)

    def directive(self, line):
        match = DIRECTIVE.match(line)
        if not match:
            self.fail(f"cannot read the directive: {line.strip()}")
        word, options = match.group(1).lower(), match.group(2)
        suite = self.suite
        self.out.append("!" + line)
        if word == "test":
            if options:
                self.fail("options of @Test are not supported")
            disabled = self.disabled()
            suite.tests.append((self.declared(SUBROUTINE, "a plain 'subroutine name'"), disabled))
        elif word == "before":
            suite.before = self.declared(SUBROUTINE, "a plain 'subroutine name'")
        elif word == "after":
            suite.after = self.declared(SUBROUTINE, "a plain 'subroutine name'")
        elif word == "testparameter":
            suite.parameter = self.declared(TYPE, "a type")
        elif word == "testcase":
            suite.constructor = option(options, r"constructor\s*=\s*(\w+)")
            suite.parameters = option(options, r"testParameters\s*=\s*\{(.*)\}")
            suite.case = self.declared(TYPE, "a type")
        else:
            self.fail(f"@{match.group(1)} is not supported")

    def disabled(self):
        if self.at < len(self.lines) and self.lines[self.at].strip().lower() == "@disable":
            self.out.append("!" + self.lines[self.at])
            self.at += 1
            return True
        return False

    def translate(self):
        while self.at < len(self.lines):
            line = self.lines[self.at]
            self.at += 1
            if line.lstrip().lower().startswith("@assert"):
                try:
                    self.out += assert_lines(line, self.at, self.path.name)
                except PfError as error:
                    self.fail(error)
            elif line.lstrip().startswith("@"):
                self.directive(line)
            else:
                match = MODULE.match(line)
                if match and not self.suite.module:
                    self.suite.module = match.group(1)
                self.out.append(line)
        if self.suite.module.lower() != self.path.stem.lower():
            self.fail(f"module '{self.suite.module}' and file '{self.path.name}' must share a name")
        if not self.suite.tests:
            self.fail("no @Test in this file")
        if self.suite.parameters and not self.suite.parameter:
            self.fail("testParameters needs a type marked @TestParameter")
        return self.out + driver(self.suite)


def driver(suite):
    """The main program that runs every test of the suite."""
    out = ["", f"program run_{suite.module}", f"  use {suite.module}", "  use funit", "  implicit none", ""]
    out.append(f"  call funit_begin('{suite.module}_suite')")
    for number, (name, disabled) in enumerate(suite.tests, 1):
        out.append(f"  call funit_disabled('{name}')" if disabled else f"  call run_{number}()")
    out += ["  call funit_end()", "contains"]
    for number, (name, disabled) in enumerate(suite.tests, 1):
        if not disabled:
            out += case_runner(suite, number, name) if suite.case else plain_runner(suite, number, name)
    return out + [f"end program run_{suite.module}", ""]


def plain_runner(suite, number, name):
    calls = [suite.before, name, suite.after]
    return [
        f"  subroutine run_{number}()",
        f"    call funit_test('{name}')",
        *[f"    call {each}()" for each in calls if each],
        f"  end subroutine run_{number}",
    ]


def case_runner(suite, number, name):
    """Runs a test of a @TestCase once, or once for each of its parameters."""
    out = [f"  subroutine run_{number}()", f"    type({suite.case}) :: test_case"]
    if suite.parameters:
        build = suite.constructor or suite.case
        out += [
            f"    type({suite.parameter}), allocatable :: parameters(:)",
            "    integer :: at_parameter",
            f"    parameters = {suite.parameters}",
            "    do at_parameter = 1, size(parameters)",
            f"    call funit_test('{name}['//parameters(at_parameter)%toString()//']')",
            f"    test_case = {build}(parameters(at_parameter))",
            "    test_case%testParameter = parameters(at_parameter)",
        ]
    else:
        out.append(f"    call funit_test('{name}')")
        if suite.constructor:
            out.append(f"    test_case = {suite.constructor}()")
    out += ["    call test_case%setUp()", f"    call {name}(test_case)", "    call test_case%tearDown()"]
    if suite.parameters:
        out.append("    end do")
    return out + [f"  end subroutine run_{number}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("suite", type=Path, help="the .pf file")
    parser.add_argument("program", type=Path, help="the Fortran file to write")
    arguments = parser.parse_args()
    try:
        lines = Translator(arguments.suite).translate()
    except PfError as error:
        print(error, file=sys.stderr)
        return 1
    arguments.program.write_text("\n".join(lines), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
