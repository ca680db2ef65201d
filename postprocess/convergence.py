# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the results of a case converge with one of its parameters: runs it, compares, writes a table and a picture.

python3 -m postprocess.convergence CASE.prm --executable build/release/gemmule --parameter "Mesh/Membrane level"
    --values 4,5,6,7 --time 0.5 --output results/convergence
"""

import argparse
import sys

try:
    import numpy as np
    import pandas as pd

    from postprocess import studies
    from postprocess.case_runs import SAME_TIME, varied
    from postprocess.curves import closed_curves
    from postprocess.necks import narrowest_neck
    from postprocess.observed_order import orders
    from postprocess.results import Results, ResultsError
except ModuleNotFoundError as error:
    sys.exit(
        f"error: the Python package '{error.name}' is missing for {sys.executable}. Run this in the top folder of "
        "the program, with a Python that has numpy, h5py, matplotlib and pandas (Debian: /usr/bin/python3)."
    )

COLUMNS = ("centroid_x", "centroid_y", "arclength", "energy_total", "curvature_max")
NECK = ("neck_width", "bud_area")
SCALARS = (*COLUMNS, *NECK)
FIELDS = ("f", "f_total")
QUANTITIES = (*SCALARS, "position", *FIELDS)
COSTS = ("cells", "flow_dofs", "surface_dofs", "steps", "wall_time", "cpu_time")
LABELS = {
    "centroid_x": "centroid $x$",
    "centroid_y": "centroid $y$",
    "arclength": "arclength",
    "energy_total": "energy",
    "curvature_max": "largest curvature",
    "neck_width": "neck width",
    "bud_area": "bud area",
    "position": "position",
    "f": "$f$",
    "f_total": r"$\bar f$",
}
MEASURES = {"value": lambda x: x, "level": lambda x: 2.0**-x, "inverse": lambda x: 1.0 / x}


class State:
    """What is compared of one run at one time."""

    def __init__(self, directory, time):
        results = Results(directory)
        statistics = results.statistics()
        row = statistics.iloc[(statistics.time - time).abs().argmin()]
        interface = results.interface(time)
        for found in (row.time, interface.time):
            if abs(found - time) > SAME_TIME * max(1.0, abs(time)):
                raise ResultsError(f"'{directory}' has no results at t = {time:g}; the nearest are at {found:g}")
        self.scalars = {name: float(row.get(name, np.nan)) for name in COLUMNS}
        self.costs = {name: row.get(name, np.nan) for name in COSTS}
        self.costs["steps"] = row.get("step", np.nan)
        self.costs["cpu_time"] = results.cpu_time()
        self.points = interface.points
        if self.points.shape[1] != 2:
            raise ResultsError(f"'{directory}' is three-dimensional: membranes are compared in two dimensions only")
        try:
            self.curves = closed_curves(interface.points, interface.segments, results.interface_values(time, FIELDS))
        except ValueError as error:
            raise ResultsError(f"'{directory}' at t = {time:g}: {error}")
        neck = narrowest_neck(self.curves)
        self.scalars["neck_width"] = neck.width if neck else np.nan
        self.scalars["bud_area"] = neck.bud_area if neck else np.nan


def difference(one, other, quantity):
    """How far two states are apart, the second being the more accurate one; nan if they cannot be compared."""
    if quantity in SCALARS:
        return abs(one.scalars[quantity] - other.scalars[quantity])
    if quantity == "position":
        return float(np.min([curve.distances(one.points) for curve in other.curves], axis=0).max())
    if len(one.curves) != len(other.curves):
        return float("nan")
    return max(
        float(np.abs(mine.along(quantity) - theirs.along(quantity)).max())
        for mine, theirs in zip(one.curves, other.curves)
    )


def compare(values, sizes, states, reference=None):
    """
    The table: one row per run, the last one the finest. Differences are those to the reference, by default the
    finest run; the reference itself has none. Orders come from each run and its two neighbours alone.
    """
    reference = reference or states[-1]
    table = pd.DataFrame({"value": values, "size": sizes})
    for name in COSTS:
        table[name] = [state.costs[name] for state in states]
    for name in SCALARS:
        table[name] = [state.scalars[name] for state in states]
    for name in QUANTITIES:
        successive = [difference(*pair, name) for pair in zip(states, states[1:])]
        table[f"{name}_difference"] = [
            np.nan if state is reference else difference(state, reference, name) for state in states
        ]
        table[f"{name}_successive"] = [*successive, np.nan]
        table[f"{name}_order"] = orders(np.asarray(sizes), successive)
    return table


def markdown(table, key, time, reference="the last run"):
    """What a reader wants to see of the table."""

    def number(value, form):
        return "-" if not np.isfinite(value) else format(value, form)

    shown = [name for name in QUANTITIES if np.any(table[f"{name}_difference"] > 0)]
    header = [key, "cells", "unknowns", "steps", "CPU time/s"]
    for name in shown:
        header += [name, "order"]
    lines = [
        f"Differences to {reference} at t = {time:g}; orders from each run and its two neighbours.",
        "",
        "| " + " | ".join(header) + " |",
        "|" + "---:|" * len(header),
    ]
    for _, row in table.iterrows():
        unknowns = row.flow_dofs + row.surface_dofs
        cells = [str(row.value), *(number(x, ".0f") for x in (row.cells, unknowns, row.steps))]
        cells.append(number(row.cpu_time if np.isfinite(row.cpu_time) else row.wall_time, ".3g"))
        for name in shown:
            cells += [number(row[f"{name}_difference"], ".2e"), number(row[f"{name}_order"], ".2f")]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def figure(table, key, time, measure):
    from postprocess import style

    result, axis = style.subplots(figsize=(5.2, 4.2))
    sizes = table["size"].to_numpy()[:-1]
    largest = []
    for name, marker in zip(QUANTITIES, "os^Dvx+*<>"):
        values = table[f"{name}_difference"].to_numpy()[:-1]
        if np.any(values > 0):
            axis.loglog(
                sizes, np.where(values > 0, values, np.nan), marker=marker, markersize=4, label=LABELS[name]
            )
            largest.append(np.nanmax(values))
    if largest and len(sizes) > 1:
        for order in (2, 3):
            guide = 2 * max(largest) * (sizes / sizes[0]) ** order
            axis.loglog(sizes, guide, ":", color=style.INK, linewidth=0.8)
            axis.annotate(f" {order}", (sizes[-1], guide[-1]), fontsize=8)
        axis.legend(ncols=2)
    form = {"value": "{}", "level": "2^-({})", "inverse": "1/({})"}[measure]
    axis.set_xlabel(form.format(key))
    axis.set_ylabel(f"difference to the finest run at $t = {time:g}$")
    axis.spines[["top", "right"]].set_visible(False)
    return result


def parse_values(text):
    values = [item.strip() for item in text.split(",")]
    try:
        [float(item) for item in values]
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a list of numbers separated by commas, such as 4,5,6")
    if len(values) < 2:
        raise argparse.ArgumentTypeError(f"'{text}' is one value: give at least two, three for an order")
    return values


def parser():
    result = argparse.ArgumentParser(prog="python3 -m postprocess.convergence", description=__doc__.split("\n")[0])
    studies.add_arguments(result)
    result.add_argument("--parameter", required=True, metavar="SECTION/KEY", help="the parameter that is varied")
    result.add_argument("--values", type=parse_values, required=True, help="its values, the finest last: 4,5,6,7")
    result.add_argument(
        "--measure",
        choices=MEASURES,
        help="what orders refer to: the value, 2^-value (default for names that end in 'level'), or its inverse",
    )
    return result


def study(options):
    measure = options.measure or ("level" if options.parameter.lower().endswith("level") else "value")
    studies.check_files(options)
    program = options.executable.resolve()
    runs = [
        varied(program, options.case, options.set, options.parameter, value, options.time, options.output)
        for value in options.values
    ]
    for run in runs:
        run.parameters()  # what is wrong with them is better known before the first one is computed
    sizes = [MEASURES[measure](float(value)) for value in options.values]
    if min(sizes) <= 0 or any(fine >= coarse for coarse, fine in zip(sizes, sizes[1:])):
        raise ResultsError(
            f"the values {', '.join(options.values)} do not get finer: --values needs the finest last, "
            f"and --measure {measure} has to be right"
        )
    studies.complete(runs, options)

    states = [State(run.directory, options.time) for run in runs]
    for value, finer, one, other in zip(options.values, options.values[1:], states, states[1:]):
        if one.scalars == other.scalars and one.costs["steps"] == other.costs["steps"]:
            raise ResultsError(
                f"the runs with {options.parameter} = {value} and {finer} are the same: it changes nothing there"
            )
    table = compare(options.values, sizes, states)
    text = markdown(table, options.parameter, options.time)
    studies.write(
        options.output, "convergence", table, text, lambda: figure(table, options.parameter, options.time, measure)
    )
    return text


def main(arguments=None):
    return studies.main(study, parser().parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
