#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Animation (GIF) of one field on the deformed shape, one colour scale throughout."""

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

from talus_map import FieldMap, FieldScale, add_map_options, default_field, map_size, view_of
from talus_style import figure_path, parser_of, run_main, time_text, write


def draw(result, arguments):
    """Draw and save; returns the file's name."""
    snapshots = result.numbered()
    if len(snapshots) > arguments.frames:
        pick = np.linspace(0, len(snapshots) - 1, arguments.frames).round().astype(int)
        snapshots = [snapshots[i] for i in pick]
    field = arguments.field or default_field(result)
    scale = FieldScale(result, field, snapshots, arguments.limits)
    view = view_of(result, snapshots, arguments.deformed)
    width, height = map_size(view, 5.6, 6.5)
    figure, axes = plt.subplots(figsize=(max(width + 1.6, 3.2), height + 0.9), dpi=arguments.dpi)
    field_map = FieldMap(axes, result, scale, arguments.deformed)
    cells = field_map.show(snapshots[0])
    axes.set(xlim=view[0], ylim=view[1], xlabel="x [m]", ylabel="y [m]", title=" ")
    scale.add_bar(figure, cells, cax=axes.inset_axes([1.0 + 0.1 / width, 0.0, 0.12 / width, 1.0]))
    figure.canvas.draw()
    figure.set_layout_engine("none")
    frames = []
    for snapshot in snapshots:
        field_map.show(snapshot)
        axes.set_title(time_text(result, snapshot))
        figure.canvas.draw()
        frames.append(Image.fromarray(np.asarray(figure.canvas.buffer_rgba())[..., :3].copy()))
    path = arguments.output or figure_path(result.path, field, ".gif")
    step = round(1000 / arguments.rate)
    # One palette for all frames, from the last one, which shows most colours.
    palette = frames[-1].quantize(255, method=Image.Quantize.MEDIANCUT)
    frames = [f.quantize(palette=palette, dither=Image.Dither.NONE) for f in frames]
    how = {"save_all": True, "append_images": frames[1:], "loop": 0, "optimize": False}
    how["duration"] = [step] * (len(frames) - 1) + [max(1500, step)]
    return write(path, lambda place: frames[0].save(place, **how), figure)


def parser():
    """Command line."""
    options = parser_of(__doc__)
    options.set_defaults(dpi=110.0)
    add_map_options(options)
    options.add_argument("--rate", type=float, default=8.0, help="frames per second (8)")
    options.add_argument("--frames", type=int, default=120, help="at most this many frames (120)")
    return options


if __name__ == "__main__":
    run_main(parser(), draw)
