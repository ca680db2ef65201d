# SPDX-License-Identifier: LGPL-2.1-or-later
"""snapshots.png: the membrane at several times, coloured by its composition, over streamlines."""

import numpy as np
from matplotlib import cm, colors

from postprocess import membrane, streamlines, style
from postprocess.errors import ResultsError
from postprocess.selection import choose, read_chosen


def figure(results, times=None):
    interfaces = read_chosen(
        results.interface_times(), lambda available: choose(available, times), lambda time: planar(results, time)
    )
    window = common_window(interfaces)

    columns = min(4, len(interfaces))
    rows = -(-len(interfaces) // columns)
    height_of_one = (window[3] - window[2]) / (window[1] - window[0])
    width = 1.95
    result, axes = style.subplots(
        rows,
        columns,
        figsize=(width * columns + 1.1, (width * height_of_one + 0.25) * rows + 0.45),
        sharex=True,
        sharey=True,
        squeeze=False,
    )
    for axis, interface in zip(axes.flat, interfaces):
        draw(axis, results, interface, window)
    for axis in axes.flat[len(interfaces) :]:
        axis.set_visible(False)
    for column in range(columns):
        last = (len(interfaces) - 1 - column) // columns
        axes[last, column].set_xlabel("$x$")
        axes[last, column].xaxis.set_tick_params(labelbottom=True)
    for row in axes:
        row[0].set_ylabel("$y$")
    bar = result.colorbar(
        cm.ScalarMappable(colors.Normalize(0, 1), style.COMPOSITION), ax=axes, aspect=30 * rows / 2, pad=0.02
    )
    bar.set_label(r"composition $c = f/\bar f$")
    return result


def planar(results, time):
    """The membrane at a time, in two dimensions and with points."""
    interface = results.interface(time)
    if interface.points.shape[1] != 2:
        raise ResultsError(f"{results.interface_path} is three-dimensional: use ParaView with interface.xdmf")
    if len(interface.points) == 0:
        raise ResultsError(f"{results.interface_path} has no points of the membrane")
    return interface


def common_window(interfaces):
    """(left, right, bottom, top) that holds the membrane at all times, with some room."""
    points = np.concatenate([interface.points for interface in interfaces])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.15 * (high - low).max()
    return low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin


def draw(axis, results, interface, window):
    solution = flow_at(results, interface.time)
    if solution is not None:
        streamlines.draw(axis, solution, window)
    membrane.draw(axis, interface)
    axis.set_xlim(window[:2])
    axis.set_ylim(window[2:])
    axis.set_aspect("equal")
    axis.locator_params(nbins=4)
    axis.set_title(f"$t = {interface.time:.4g}$")


def flow_at(results, time):
    """The fields at just this time, or None: the flow of another time may be another one altogether."""
    limit = 1e-6 * max(1.0, abs(time))
    if not any(abs(other - time) <= limit for other in results.solution_times()):
        return None
    try:
        solution = results.solution(time)
    except ResultsError:  # the membrane can be drawn without
        return None
    velocity = solution.fields.get("velocity", np.empty(0))
    return solution if velocity.ndim == 2 and velocity.shape[1] >= 2 else None
