# SPDX-License-Identifier: LGPL-2.1-or-later
"""The membrane as a thick line."""

from matplotlib import colors
from matplotlib.collections import LineCollection

from postprocess import style


def draw(axis, interface, width=3.0, color=None):
    """Draw it coloured by its composition (values beyond 0 and 1 take the colours of these), or in one colour."""
    ends = interface.points[interface.segments]  # segments x 2 ends x 2 coordinates
    lines = LineCollection(ends, linewidths=width, capstyle="round", zorder=3)
    if color is None:
        lines.set_cmap(style.COMPOSITION)
        lines.set_norm(colors.Normalize(0, 1))
        lines.set_array(interface.composition[interface.segments].mean(axis=1))
    else:
        lines.set_color(color)
    axis.add_collection(lines)
