"""Command line: which results, where to, which times."""

import argparse
import sys
from pathlib import Path

from postprocess.results import Results, ResultsError


def parse_times(text):
    try:
        return [float(item) for item in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"'{text}' is not a list of numbers separated by commas, such as 0,0.2,1"
        )


def parser():
    description = "Draw timeseries.png, snapshots.png and mesh.png from the results of a run."
    result = argparse.ArgumentParser(prog="postprocess", description=description)
    result.add_argument("results", type=Path, help="output directory of the run")
    result.add_argument(
        "--output", type=Path, help="directory of the pictures (default: that of the results)"
    )
    result.add_argument(
        "--times",
        type=parse_times,
        metavar="T,T,...",
        help="times of the snapshots and of the mesh; the nearest outputs are taken (default: up to 8 snapshots, evenly "
        "spread, and the last mesh)",
    )
    return result


def main(arguments=None):
    options = parser().parse_args(arguments)
    try:
        for picture in draw(options):
            print(picture)
    except (ResultsError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


def draw(options):
    """Draw everything that the results allow; the paths of the pictures, as they get ready."""
    import matplotlib

    matplotlib.use("Agg")
    from postprocess import mesh, snapshots, style, time_series

    results = Results(options.results)
    statistics = results.statistics()
    folder = options.output or options.results
    folder.mkdir(parents=True, exist_ok=True)
    style.apply()

    yield style.save(time_series.figure(statistics), folder / "timeseries.png")
    if results.has_interface():
        yield style.save(snapshots.figure(results, options.times), folder / "snapshots.png")
    else:
        print(f"note: no {results.interface_path}, so no snapshots.png", file=sys.stderr)
    if results.solution_times():
        yield style.save(mesh.figure(results, options.times), folder / "mesh.png")
    else:
        print("note: no solution-NNNNN.h5 in the results, so no mesh.png", file=sys.stderr)
