# SPDX-License-Identifier: LGPL-2.1-or-later
"""What all figures share: matplotlib's defaults, our fonts and colours, how they are made and saved."""

import io
import os
import warnings
from contextlib import contextmanager, suppress

import matplotlib
from cycler import cycler
from matplotlib import colors
from matplotlib.figure import Figure

# Blue (c = 0) over a dark neutral to red (c = 1): lightness falls towards the middle, so that the membrane
# stands out from white paper at every composition.
COMPOSITION = colors.LinearSegmentedColormap.from_list(
    "composition", ["#1f6fd6", "#4a5fb0", "#5d5470", "#a84a5a", "#e0312f"]
)
INK = "#222222"
STREAMLINES = "#b5b5b5"
LINES = ["#0b5fa5", "#c8442b", "#3a8f4d", "#8659a8", "#b8860b", "#555555"]
SETTINGS = {
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.labelsize": 9,
    "legend.fontsize": 8,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "axes.edgecolor": INK,
    "axes.linewidth": 0.8,
    "axes.prop_cycle": cycler(color=LINES),
    "axes.grid": False,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "savefig.dpi": 200,
}


@contextmanager
def applied():
    """
    While figures are made and saved: our settings and matplotlib's own defaults instead of those of a matplotlibrc, so
    that pictures are the same for everybody. What was set before is set again afterwards.

    Warnings are about defaults that nobody has asked for, or about odd numbers, which the picture shows.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        defaults = {name: value for name, value in matplotlib.rcParamsDefault.items() if name != "backend"}
        with matplotlib.rc_context({**defaults, **SETTINGS}):
            yield


def subplots(rows=1, columns=1, **options):
    """A figure that belongs to no window, which would need a display, and its axes."""
    size = options.pop("figsize")
    figure = Figure(figsize=size, layout="constrained")
    return figure, figure.subplots(rows, columns, **options)


def save(figure, path):
    """Write the figure as PNG. What was there before stays if that fails, with an OSError."""
    picture = io.BytesIO()
    figure.savefig(picture, format="png")
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        unfinished.write_bytes(picture.getbuffer())
        unfinished.replace(path)
    finally:
        with suppress(OSError):
            unfinished.unlink()
    return path
