# SPDX-License-Identifier: LGPL-2.1-or-later
"""timeseries.png: how the numbers of statistics.csv develop."""

import numpy as np
from matplotlib.ticker import MaxNLocator

from postprocess import style

ENERGIES = {
    "energy_total": "total",
    "energy_surface": "surface",
    "energy_phase": "phase",
    "energy_constraint": "arclength",
    "energy_bending": "bending",
}


def figure(statistics):
    statistics = statistics.replace([np.inf, -np.inf], np.nan)  # which no axis can show
    result, axes = style.subplots(3, 2, figsize=(7.5, 7.2), sharex=True)
    panels = (centroid, arclength, energies, conservation, phase_boundaries, time_step)
    for axis, panel, letter in zip(axes.flat, panels, "abcdef"):
        panel(axis, statistics)
        axis.set_title(f"({letter})", loc="left")
        axis.spines[["top", "right"]].set_visible(False)
        if len(statistics) == 1:
            show_points(axis)
    for axis in axes[-1]:
        axis.set_xlabel("time $t$ (dimensionless)")
    if statistics.time.iloc[-1] > statistics.time.iloc[0]:
        axes[0, 0].set_xlim(statistics.time.iloc[0], statistics.time.iloc[-1])
    return result


def show_points(axis):
    """One row makes no line."""
    for line in axis.get_lines():
        line.set_marker("o")
        line.set_markersize(3)
    if axis.get_legend():
        axis.legend()


def first(values):
    """The first one that is a number; nan if there is none."""
    numbers = values.dropna()
    return numbers.iloc[0] if len(numbers) > 0 else np.nan


def centroid(axis, table):
    axis.plot(table.time, table.centroid_x, label=r"$x$")
    axis.plot(table.time, table.centroid_y, "--", label=r"$y$")
    axis.set_ylabel("centroid")
    axis.legend()


def arclength(axis, table):
    axis.plot(table.time, table.arclength)
    axis.set_ylabel("arclength $L$")
    axis.ticklabel_format(axis="y", useOffset=False)


def energies(axis, table):
    """Changes since the start: the energies themselves are large beside what they change by."""
    for number, (name, label) in enumerate(ENERGIES.items()):
        if name in table and (name == "energy_total" or np.any(table[name] != 0.0)):
            change = table[name] - first(table[name])
            axis.plot(table.time, change, "-" if number == 0 else "--", label=label)
    axis.set_ylabel("energy $E - E(0)$")
    axis.legend(ncols=2)


def conservation(axis, table):
    """Relative deviations from the first row, on a logarithmic axis; what is exact lies on the floor."""
    floor = 1e-16
    for name, label in (("mass_f", r"$\int f$"), ("mass_total", r"$\int \bar f$"), ("area", "area")):
        if name in table and first(table[name]) != 0.0:
            error = np.abs(table[name] / first(table[name]) - 1.0)
            axis.plot(table.time, np.maximum(error, floor), label=label)
    axis.set_yscale("log")
    lower, upper = axis.get_ylim()
    axis.set_ylim(0.5 * floor, max(upper, 1e-12))
    axis.set_ylabel("relative error")
    if axis.get_lines():
        axis.legend(ncols=3, loc="upper left")


def phase_boundaries(axis, table):
    if "phase_boundaries" in table:
        axis.step(table.time, table.phase_boundaries, where="post")
        axis.set_ylim(0, max(4, 1.15 * table.phase_boundaries.max()))
    axis.yaxis.set_major_locator(MaxNLocator(integer=True))
    axis.set_ylabel("phase boundaries")


def time_step(axis, table):
    steps = table[table.time_step_size > 0.0]
    axis.plot(steps.time, steps.time_step_size)
    axis.set_yscale("log")
    axis.set_ylabel(r"time step $\Delta t$")
