# SPDX-License-Identifier: MIT
"""A run on two threads beside processes that keep every processor busy.

Threads that spin while they wait keep the one that they wait for from running: with the defaults of GNU's
OpenMP this run takes some two hundred times as long. Two threads of four busy processes get about half of the
processors; ten times the quiet time, and a second, leaves room for a machine that has other work as well.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import time

PROGRAM, DECK = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
STORM = ("duration = 129600.0", "duration = 7200.0")
WAITING = ("GOMP_SPINCOUNT", "OMP_WAIT_POLICY")
ENVIRONMENT = {name: value for name, value in os.environ.items() if name not in WAITING}


def seconds(folder):
    """Wall time of a run."""
    start = time.monotonic()
    words = [PROGRAM, "run", "short.nml", "--threads", "2", "--overwrite"]
    subprocess.run(words, cwd=folder, env=ENVIRONMENT, check=True, capture_output=True, timeout=120)
    return time.monotonic() - start


def main():
    with tempfile.TemporaryDirectory() as folder:
        text = DECK.read_text()
        assert STORM[0] in text
        (pathlib.Path(folder) / "short.nml").write_text(text.replace(*STORM))
        quiet = min(seconds(folder) for _ in range(2))
        spin = [sys.executable, "-c", "while True: pass"]
        busy = [subprocess.Popen(spin) for _ in range(os.cpu_count() or 2)]
        try:
            loaded = seconds(folder)
        finally:
            for process in busy:
                process.kill()
                process.wait()
    print(f"{quiet:.2f} s on its own, {loaded:.2f} s beside {len(busy)} busy processes")
    return 0 if loaded <= 10 * quiet + 1 else 1


if __name__ == "__main__":
    sys.exit(main())
