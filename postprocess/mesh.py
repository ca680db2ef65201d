"""mesh.png: the cells of the last output, or those around the membrane at several times, with the membrane."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

from postprocess import membrane, snapshots

MOST_COLUMNS = 3
FLAT = 0.6  # height over width of a window below which panels are stacked


def figure(results, times=None):
    """Without times the whole box at the last output; else a panel for each, of the part where the membrane is."""
    available = np.array(results.solution_times())
    chosen = available[-1:] if times is None else snapshots.choose(available, times)
    solutions = [results.solution(time) for time in chosen]
    interfaces = [results.interface(time) if results.has_interface() else None for time in chosen]

    if times is None or not results.has_interface():
        nodes = solutions[-1].nodes
        window = np.column_stack([nodes.min(axis=0), nodes.max(axis=0)]).ravel()
    else:
        window = np.array(snapshots.common_window(interfaces))
    ratio = (window[3] - window[2]) / (window[1] - window[0])
    columns = min(MOST_COLUMNS if ratio > FLAT else 1, len(chosen))
    rows = -(-len(chosen) // columns)
    size = 5.6 if columns == 1 else 3.4
    height = size * min(1.0, ratio) + (0.4 if columns == 1 else 0.2)
    result, axes = plt.subplots(
        rows,
        columns,
        figsize=(size * columns, max(height, 2.2) * rows),
        sharex=True,
        sharey=True,
        squeeze=False,
        layout="constrained",
    )
    for axis, solution, interface in zip(axes.flat, solutions, interfaces):
        draw(axis, solution, interface, window)
    for axis in axes.flat[len(chosen) :]:
        axis.set_visible(False)
    for row in axes:
        row[0].set_ylabel("$y$")
    for place in range(columns):
        axes[(len(chosen) - 1 - place) // columns, place].set_xlabel("$x$")
    return result


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
