#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Look at a result file as a kill after each single write of the HDF5 library would leave it.

A program linked with log_writes.f90 logs all that the library writes. Each state is put together
from the log, also those in the middle of a write that ends a page of memory, where a kill can stop
the system; small writes only, since a large one is of values that have no name yet. From the first
snapshot on every state must be readable, with all the snapshots of the state before.
"""

import argparse
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

from killed_result import check_file

PAGE = 4096
SMALL = 5 * PAGE


def states(log):
    """The file after each step of the log: number of the write, what it was, content."""
    image = bytearray()
    at = number = 0
    while at < len(log):
        kind, offset, count = struct.unpack_from("<3q", log, at)
        at += 24
        number += 1
        image.extend(bytes(max(0, offset - len(image))))
        if kind == 1:
            del image[offset:]
            yield number, f"length {offset}", image
            continue
        done = 0
        while done < count:
            piece = count - done
            if count <= SMALL:
                piece = min(piece, PAGE - (offset + done) % PAGE)
            image[offset + done : offset + done + piece] = log[at + done : at + done + piece]
            done += piece
            yield number, f"{done} of {count} bytes at {offset}", image
        at += count


def main():
    """Exit code 0 when every state can be read."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("writer", type=Path, help="the program write_logged")
    parser.add_argument("--snapshots", type=int, default=14)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        command = [arguments.writer.resolve(), str(arguments.snapshots)]
        subprocess.run(command, cwd=folder, check=True)
        log = (Path(folder) / "writes.log").read_bytes()
    looked = unreadable = snapshots = 0
    for number, what, image in states(log):
        try:
            with h5py.File(h5py.h5f.open_file_image(bytes(image))) as file:
                found = check_file(file)
                assert found >= snapshots, f"{found} snapshots after {snapshots}"
                snapshots = found
        except (OSError, KeyError, RuntimeError, ValueError, AssertionError) as error:
            if snapshots > 0:
                unreadable += 1
                print(f"write {number}, {what}: {error!r}")
        looked += snapshots > 0
    print(f"{looked} states with {snapshots} snapshots at last, {unreadable} unreadable")
    return 1 if unreadable or snapshots != arguments.snapshots else 0


if __name__ == "__main__":
    sys.exit(main())
