"""mesh.png: the cells of the last output, with the membrane."""

import matplotlib.pyplot as plt
from matplotlib.collections import PolyCollection

from postprocess import membrane


def figure(results):
    solution = results.solution(results.solution_times()[-1])
    result, axis = plt.subplots(figsize=(5.6, 5.6), layout="constrained")
    axis.add_collection(
        PolyCollection(
            solution.nodes[solution.cells], facecolors="none", edgecolors="#9a9a9a", linewidths=0.3, zorder=1
        )
    )
    if results.has_interface():
        membrane.draw(axis, results.interface(solution.time), width=1.8)
    low, high = solution.nodes.min(axis=0), solution.nodes.max(axis=0)
    axis.set_xlim(low[0], high[0])
    axis.set_ylim(low[1], high[1])
    axis.set_aspect("equal")
    axis.set_xlabel("$x$")
    axis.set_ylabel("$y$")
    axis.set_title(f"$t = {solution.time:.4g}$")
    return result
