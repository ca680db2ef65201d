"""snapshots.png: the membrane at several times, coloured by its composition, over streamlines."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import cm, colors

from postprocess import membrane, streamlines, style

MOST_SNAPSHOTS = 8


def figure(results, times=None):
    chosen = choose(results.interface_times(), times)
    interfaces = [results.interface(time) for time in chosen]
    window = common_window(interfaces)

    columns = min(4, len(interfaces))
    rows = -(-len(interfaces) // columns)
    height_of_one = (window[3] - window[2]) / (window[1] - window[0])
    width = 1.95
    result, axes = plt.subplots(
        rows,
        columns,
        figsize=(width * columns + 1.1, (width * height_of_one + 0.25) * rows + 0.45),
        sharex=True,
        sharey=True,
        squeeze=False,
        layout="constrained",
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


def choose(available, wanted):
    """Of the times available: those nearest to the wanted ones, or up to 8 spread evenly in time."""
    if wanted is None:
        if len(available) <= MOST_SNAPSHOTS:
            return available
        wanted = np.linspace(available[0], available[-1], MOST_SNAPSHOTS)
    nearest = {int(np.abs(available - time).argmin()) for time in wanted}
    return available[sorted(nearest)]


def common_window(interfaces):
    """(left, right, bottom, top) that holds the membrane at all times, with some room."""
    points = np.concatenate([interface.points for interface in interfaces])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.15 * (high - low).max()
    return low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin


def draw(axis, results, interface, window):
    solution = results.solution(interface.time)
    # The flow of another time may be another one altogether.
    is_of_this_time = solution is not None and abs(solution.time - interface.time) <= 1e-6 * max(1.0, interface.time)
    if is_of_this_time and "velocity" in solution.fields:
        streamlines.draw(axis, solution, window)
    membrane.draw(axis, interface)
    axis.set_xlim(window[:2])
    axis.set_ylim(window[2:])
    axis.set_aspect("equal")
    axis.locator_params(nbins=4)
    axis.set_title(f"$t = {interface.time:.4g}$")
