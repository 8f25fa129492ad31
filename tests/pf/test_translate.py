#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the translator refuses, because pFUnit would refuse or silently skip it."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TRANSLATOR = Path(__file__).with_name("translate.py")
GOOD = """module suite
  use funit
  implicit none
contains
  @Test
  subroutine one()
    @assertTrue(.true.)
  end subroutine one
end module suite
"""


def translate(text, name="suite.pf"):
    """Exit code, messages and output of the translator on a suite."""
    with tempfile.TemporaryDirectory() as folder:
        suite, program = Path(folder, name), Path(folder, "suite.f90")
        suite.write_text(text, encoding="utf-8")
        run = subprocess.run(
            [sys.executable, TRANSLATOR, suite, program], capture_output=True, text=True, check=False
        )
        return run.returncode, run.stderr, program.read_text(encoding="utf-8") if program.exists() else ""


class Translation(unittest.TestCase):
    def refused(self, old, new, line, reason, name="suite.pf"):
        self.assertIn(old, GOOD)
        code, message, program = translate(GOOD.replace(old, new), name)
        self.assertEqual(code, 1)
        self.assertIn(f":{line}: ", message)
        self.assertIn(reason, message)
        self.assertEqual(program, "", "nothing is written for a refused suite")

    def test_good_suite(self):
        code, message, program = translate(GOOD)
        self.assertEqual((code, message), (0, ""))
        self.assertIn("location=SourceLocation('suite.pf', 7))\nif (anyExceptions()) return\n", program)
        self.assertIn("call funit_test('one')\n    call one()", program)

    def test_before_and_after(self):
        fixtures = "contains\n  @Before\n  subroutine a()\n  end\n  @After\n  subroutine b()\n  end\n"
        program = translate(GOOD.replace("contains\n", fixtures))[2]
        self.assertIn("call a()\n    call one()\n    call b()", program)

    def test_disabled(self):
        program = translate(GOOD.replace("  @Test\n", "  @Test\n  @Disable\n"))[2]
        self.assertIn("call funit_disabled('one')", program)
        self.assertNotIn("call one()", program)

    def test_refusals(self):
        self.refused("(.true.)", "(.true.) ! why", 7, "alone on one line")
        self.refused("(.true.)", "(.true., &", 7, "alone on one line")
        self.refused("(.true.)", "(.true." + 90 * " " + ")", 7, "at most 105")
        self.refused("@assertTrue", "@assertTrueish", 7, "not supported")
        self.refused("  subroutine one()", "  pure subroutine one()", 6, "plain 'subroutine name'")
        self.refused("@Test", "@Test(ifdef=X)", 5, "not supported")
        self.refused("@Test", "@MpiTest", 5, "not supported")
        self.refused("  @Test\n", "", 8, "no @Test")
        self.refused("one", "one", 9, "share a name", name="other.pf")


if __name__ == "__main__":
    unittest.main()
