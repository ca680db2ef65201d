# SPDX-License-Identifier: LGPL-2.1-or-later
"""mesh.png: the cells of the last output, or those around the membrane at several times, with the membrane."""

import numpy as np
from matplotlib.collections import PolyCollection

from postprocess import membrane, snapshots, style
from postprocess.errors import ResultsError
from postprocess.selection import choose, read_chosen

MOST_COLUMNS = 3
FLAT = 0.6  # height over width of a window below which panels are stacked


def figure(results, times=None):
    """Without times the whole box at the last output; else a panel for each, of the part where the membrane is."""
    if not results.solution_times():
        raise ResultsError(f"there is no solution-NNNNN.h5 that can be read in '{results.directory}'")
    solutions = read_chosen(
        results.solution_times(),
        lambda available: available[-1:] if times is None else choose(available, times),
        results.solution,
    )
    interfaces = [membrane_at(results, solution.time) for solution in solutions]
    membranes = [interface for interface in interfaces if interface is not None]

    if times is None or not membranes:
        nodes = solutions[-1].nodes
        window = np.column_stack([nodes.min(axis=0), nodes.max(axis=0)]).ravel()
    else:
        window = np.array(snapshots.common_window(membranes))
    ratio = (window[3] - window[2]) / (window[1] - window[0])
    columns = min(MOST_COLUMNS if ratio > FLAT else 1, len(solutions))
    rows = -(-len(solutions) // columns)
    size = 5.6 if columns == 1 else 3.4
    height = size * min(1.0, ratio) + (0.4 if columns == 1 else 0.2)
    result, axes = style.subplots(
        rows,
        columns,
        figsize=(size * columns, max(height, 2.2) * rows),
        sharex=True,
        sharey=True,
        squeeze=False,
    )
    for axis, solution, interface in zip(axes.flat, solutions, interfaces):
        draw(axis, solution, interface, window)
    for axis in axes.flat[len(solutions) :]:
        axis.set_visible(False)
    for row in axes:
        row[0].set_ylabel("$y$")
    for place in range(columns):
        axes[(len(solutions) - 1 - place) // columns, place].set_xlabel("$x$")
    return result


def membrane_at(results, time):
    """The membrane, or None: the cells can be drawn without."""
    try:
        return snapshots.planar(results, time)
    except ResultsError:
        return None


def draw(axis, solution, interface, window):
    axis.add_collection(
        PolyCollection(
            solution.nodes[solution.cells], facecolors="none", edgecolors="#9a9a9a", linewidths=0.3, zorder=1
        )
    )
    if interface is not None:
        membrane.draw(axis, interface, width=1.8)
    axis.set_xlim(window[:2])
    axis.set_ylim(window[2:])
    axis.set_aspect("equal")
    axis.set_title(f"$t = {solution.time:.4g}$, {len(solution.cells)} cells")
