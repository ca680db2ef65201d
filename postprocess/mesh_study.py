# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a case depends on its mesh: adaptive and uniform meshes on the same axes, against unknowns and CPU time.

python3 -m postprocess.mesh_study CASE.prm --executable build/release/gemmule --time 1 --values 4,5,6,7
    --uniform 4,5,6 --output results/mesh_study

Writes mesh_study.csv, mesh_study.md and mesh_study.png. The runs stay in directories below the output; those that are
complete and have the same parameters are used again.
"""

import argparse
import sys

try:
    import numpy as np
    import pandas as pd

    from postprocess import studies
    from postprocess.case_runs import Run
    from postprocess.convergence import LABELS, QUANTITIES, State, compare, markdown, parse_values
    from postprocess.results import ResultsError
except ModuleNotFoundError as error:
    sys.exit(
        f"error: the Python package '{error.name}' is missing for {sys.executable}. Run this in the top folder of "
        "the program, with a Python that has numpy, h5py, matplotlib and pandas (Debian: /usr/bin/python3)."
    )

# What --vary may name: title in the table, size that orders refer to, parameter.
VARIATIONS = {
    "level": ("level", lambda x: 2.0**-x, None),
    "curvature": ("curvature tolerance", lambda x: x, "Mesh/Curvature tolerance"),
    "phase boundary": ("cells per phase boundary", lambda x: 1 / x, "Mesh/Cells per phase boundary"),
    "gap": ("cells per gap", lambda x: 1 / x, "Mesh/Cells per gap"),
    "flow error": ("flow error tolerance", lambda x: x, "Mesh/Flow error tolerance"),
    "time": ("tolerance of the time step", lambda x: x, "Time stepping/Tolerance"),
}
UNIFORM = "uniform"


def level_settings(parameters, level):
    """
    Settings that make every cell of the case's mesh 2^shift times smaller, such that the larger one of "Membrane
    level" and "Phase boundary level" becomes `level`. The bulk level stays unless the membrane gets coarser than it.
    """
    membrane, phase = int(parameters["Mesh/Membrane level"]), int(parameters["Mesh/Phase boundary level"])
    shift = level - max(membrane, phase)
    if membrane + shift < 0:
        raise ResultsError(f"level {level} is too coarse for a case whose membrane level is {membrane}")
    settings = {
        "Mesh/Bulk level": min(int(parameters["Mesh/Bulk level"]), membrane + shift),
        "Mesh/Membrane level": membrane + shift,
        "Mesh/Phase boundary level": phase + shift,
    }
    if "Mesh/Finest level" in parameters:
        settings["Mesh/Finest level"] = max(level, int(parameters["Mesh/Finest level"]) + shift)
    for key, power in (("Curvature tolerance", -1), ("Cells per gap", 1), ("Cells per phase boundary", 1)):
        if f"Mesh/{key}" in parameters:
            settings[f"Mesh/{key}"] = float(parameters[f"Mesh/{key}"]) * 2.0 ** (power * shift)
    return [f"{key}={value}" for key, value in settings.items()]


def uniform_settings(level):
    """A mesh of equal cells."""
    keys = ("Bulk level", "Membrane level", "Phase boundary level", "Finest level")
    return [f"Mesh/{key}={level}" for key in keys] + [f"Mesh/{key}=0" for key in ("Cells per phase boundary",)]


def number(text):
    return int(text) if text.lstrip("+-").isdigit() else float(text)


class Series:
    """Runs that get finer one after the other."""

    def __init__(self, name, title, values, sizes, runs):
        self.name, self.title, self.values, self.sizes, self.runs = name, title, values, sizes, runs


def make_series(options):
    """Every series of the study, those of adaptive meshes first."""
    title, size, key = VARIATIONS[options.vary]
    program = options.executable.resolve()

    def run(name, value, settings):
        return Run(
            program,
            options.case,
            [*options.set, *settings],
            f"{name}, {title if name != UNIFORM else 'level'} {value}",
            f"{name}_{(title if name != UNIFORM else 'level').replace(' ', '_')}={value}",
            options.time,
            options.output,
        )

    parameters = run("case", "", []).parameters()
    result = []
    for name, settings in options.series or [("adaptive", [])]:
        with_series = {**parameters, **dict(setting.split("=", 1) for setting in settings)}
        runs = []
        for value in options.values:
            varied = level_settings(with_series, int(value)) if key is None else [f"{key}={value}"]
            runs.append(run(name, value, [*settings, *varied]))
        result.append(Series(name, title, options.values, [size(float(value)) for value in options.values], runs))
    if options.uniform:
        sizes = [2.0 ** -float(value) for value in options.uniform]
        runs = [run(UNIFORM, value, uniform_settings(int(value))) for value in options.uniform]
        result.append(Series(UNIFORM, "level", options.uniform, sizes, runs))
    for series in result:
        if min(series.sizes) <= 0 or any(fine >= coarse for coarse, fine in zip(series.sizes, series.sizes[1:])):
            raise ResultsError(
                f"the values {', '.join(series.values)} of '{series.name}' do not get finer: the finest has to be last"
            )
    return result


def reference_series(all_series, name):
    """The series whose finest run the others are compared with: the first one unless it is named."""
    for series in all_series:
        if name is None or series.name == name:
            return series
    raise ResultsError(f"there is no series '{name}': there are {', '.join(series.name for series in all_series)}")


def tables(all_series, time, reference):
    """One table per series; differences are those to the finest run of the series `reference`."""
    states = [[State(run.directory, time) for run in series.runs] for series in all_series]
    finest = states[all_series.index(reference)][-1]
    result = []
    for series, own in zip(all_series, states):
        table = compare(series.values, series.sizes, own, finest)
        table.insert(0, "series", series.name)
        table.insert(5, "unknowns", table.flow_dofs + table.surface_dofs)
        result.append(table)
    return result


def factor_of_unknowns(adaptive, uniform, quantity):
    """
    How many times more unknowns uniform meshes need for the error that each uniform run has: interpolated between the
    adaptive runs (logarithms); nan where these do not reach that error. One number per uniform run.
    """
    name = f"{quantity}_difference"
    known = adaptive[np.isfinite(adaptive[name]) & (adaptive[name] > 0)].sort_values(name)
    factors = []
    for _, row in uniform.iterrows():
        error = row[name]
        if not (error > 0) or len(known) < 2 or not known[name].iloc[0] <= error <= known[name].iloc[-1]:
            factors.append(np.nan)
            continue
        unknowns = np.exp(np.interp(np.log(error), np.log(known[name]), np.log(known.unknowns.astype(float))))
        factors.append(row.unknowns / unknowns)
    return factors


def figure(all_series, all_tables, time):
    from postprocess import style

    shown = [name for name in QUANTITIES if any(np.any(table[f"{name}_difference"] > 0) for table in all_tables)]
    if not shown:
        raise ResultsError("all runs give the same results: there is no error to draw")
    columns = min(5, len(shown))
    blocks = -(-len(shown) // columns)
    result, axes = style.subplots(
        2 * blocks, columns, figsize=(2.3 * columns + 0.4, 4.2 * blocks), squeeze=False
    )
    for axis in axes.flat:
        axis.set_visible(False)
    for place, name in enumerate(shown):
        for row, (cost, label) in enumerate((("unknowns", "unknowns"), ("cpu_time", "CPU time/s"))):
            axis = axes[2 * (place // columns) + row, place % columns]
            axis.set_visible(True)
            for series, table, marker in zip(all_series, all_tables, "osD^v<>"):
                error = table[f"{name}_difference"].to_numpy()
                keep = (error > 0) & np.isfinite(table[cost])
                axis.loglog(table[cost][keep], error[keep], marker=marker, markersize=4, label=series.name)
            axis.set_xlabel(label)
            axis.spines[["top", "right"]].set_visible(False)
            if row == 0:
                axis.set_title(LABELS[name])
            if place % columns == 0:
                axis.set_ylabel(f"error at $t = {time:g}$")
    # In the panel that the quantities leave empty, if there is one: several series would hide the first curves.
    empty = [axis for axis in axes.flat if not axis.get_visible()]
    if empty:
        empty[-1].set_visible(True)
        empty[-1].axis("off")
        empty[-1].legend(*axes[0, 0].get_legend_handles_labels(), loc="center")
    else:
        axes[0, 0].legend()
    return result


def parse_series(text):
    name, colon, settings = text.partition(":")
    if not colon or not name.strip():
        raise argparse.ArgumentTypeError(f"'{text}' is not NAME:SECTION/KEY=VALUE;SECTION/KEY=VALUE")
    return name.strip(), [item.strip() for item in settings.split(";") if item.strip()]


def parser():
    result = argparse.ArgumentParser(prog="python3 -m postprocess.mesh_study", description=__doc__.split("\n")[0])
    studies.add_arguments(result)
    result.add_argument(
        "--vary",
        choices=VARIATIONS,
        default="level",
        help="what gets finer (default: level, by which all lengths of the mesh are halved)",
    )
    result.add_argument(
        "--values", type=parse_values, required=True, help="its values, the finest, which is the reference, last: 4,5,6"
    )
    result.add_argument("--uniform", type=parse_values, default=[], help="levels of uniform meshes: 4,5,6")
    result.add_argument(
        "--series",
        type=parse_series,
        action="append",
        metavar="NAME:SECTION/KEY=VALUE;...",
        help="a series of adaptive meshes with these settings; may be repeated (default: one, as the case is)",
    )
    result.add_argument(
        "--reference",
        metavar="NAME",
        help="series whose finest run the others are compared with (default: the first). Adaptive meshes of one kind "
        "share errors, such as that of a coarse bulk, which only another kind of mesh shows",
    )
    return result


def report(all_series, all_tables, time, reference):
    """The tables in Markdown, and what uniform meshes need more."""
    finest = f"'{reference.name}' with {reference.title} {reference.values[-1]}"
    parts = [
        f"### {series.name}\n\n" + markdown(table, series.title, time, finest)
        for series, table in zip(all_series, all_tables)
    ]
    if all_series[-1].name == UNIFORM:
        uniform = all_tables[-1]
        shown = [name for name in QUANTITIES if np.any(uniform[f"{name}_difference"] > 0)]
        lines = [
            "### unknowns of uniform meshes over those of adaptive meshes with the same error",
            "",
            "| level | series | " + " | ".join(shown) + " |",
            "|---:|---|" + "---:|" * len(shown),
        ]
        for series, table in zip(all_series[:-1], all_tables):
            factors = {name: factor_of_unknowns(table, uniform, name) for name in shown}
            for i, value in enumerate(all_series[-1].values):
                cells = ["-" if np.isnan(factors[name][i]) else f"{factors[name][i]:.1f}" for name in shown]
                lines.append(f"| {value} | {series.name} | " + " | ".join(cells) + " |")
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def study(options):
    studies.check_files(options)
    all_series = make_series(options)
    reference = reference_series(all_series, options.reference)
    studies.complete([run for series in all_series for run in series.runs], options)

    all_tables = tables(all_series, options.time, reference)
    text = report(all_series, all_tables, options.time, reference)
    studies.write(
        options.output,
        "mesh_study",
        pd.concat(all_tables),
        text,
        lambda: figure(all_series, all_tables, options.time),
    )
    return text


def main(arguments=None):
    return studies.main(study, parser().parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
