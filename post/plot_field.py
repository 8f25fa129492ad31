#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Map of one field at one time, drawn as nodal cells on the deformed shape."""

import matplotlib.pyplot as plt

from talus_map import FieldMap, FieldScale, add_map_options, default_field, map_size, shape_note, view_of
from talus_style import figure_path, parser_of, run_main, save, seconds, time_text


def draw(result, arguments):
    """Draw and save; returns the file's name."""
    snapshot = result.snapshot(arguments.snapshot, arguments.time)
    field = arguments.field or default_field(result)
    scale = FieldScale(result, field, [snapshot], arguments.limits)
    view = view_of(result, [snapshot], arguments.deformed)
    width, height = map_size(view, 5.6, 6.5)
    figure, axes = plt.subplots(figsize=(max(width + 1.6, 3.2), height + 0.9))
    cells = FieldMap(axes, result, scale, arguments.deformed).show(snapshot)
    axes.set(xlim=view[0], ylim=view[1], xlabel="x [m]", ylabel="y [m]")
    note = shape_note(arguments.deformed)
    axes.set_title(time_text(result, snapshot) + (f" ({note})" if note else ""))
    scale.add_bar(figure, cells, cax=axes.inset_axes([1.0 + 0.1 / width, 0.0, 0.12 / width, 1.0]))
    path = arguments.output or figure_path(result.path, field)
    return save(figure, path, arguments.dpi)


def parser():
    """Command line."""
    options = parser_of(__doc__)
    add_map_options(options)
    when = options.add_mutually_exclusive_group()
    when.add_argument("--snapshot", help="number or name; -1 is the last (default), last_good, mechanism")
    when.add_argument("--time", type=seconds, help="nearest snapshot to a time: 5400, 90min, 1.5h")
    return options


if __name__ == "__main__":
    run_main(parser(), draw)
