# SPDX-License-Identifier: MIT
"""The deck printed in README.md is a valid deck: `talus check` accepts it without a message."""

import pathlib
import re
import subprocess
import sys
import tempfile

program, readme = sys.argv[1:]
deck = re.search(r"```fortran\n(.*?)```", pathlib.Path(readme).read_text(), re.S)
if deck is None:
    sys.exit("README.md shows no deck")
with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder) / "readme.nml"
    path.write_text(deck.group(1))
    done = subprocess.run([program, "check", str(path)], capture_output=True, text=True)
print(done.stderr, end="")
sys.exit(done.returncode or bool(done.stderr))
