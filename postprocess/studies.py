# SPDX-License-Identifier: LGPL-2.1-or-later
"""What studies of several runs have in common: arguments, the runs themselves, table, text and picture of the result."""

import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from postprocess import matplotlib_loading
from postprocess.results import ResultsError


def add_arguments(parser):
    """The case and how to run it."""
    parser.add_argument("case", type=Path, metavar="CASE.prm")
    parser.add_argument("--executable", type=Path, required=True, help="the program, build/release/gemmule")
    parser.add_argument("--time", type=float, required=True, help="when to compare; the runs end there")
    parser.add_argument("--output", type=Path, required=True, help="directory of the runs, the table and the plot")
    parser.add_argument("--set", action="append", default=[], metavar="SECTION/KEY=VALUE", help="for all runs")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time (default: 1)")
    parser.add_argument("--fresh", action="store_true", help="compute again what has been computed")


def check_files(options):
    """Raise ResultsError if there is no program or no case."""
    for path in (options.executable, options.case):
        if not path.is_file():
            raise ResultsError(f"there is no file '{path}'")


def complete(runs, options):
    """Compute all runs, as many at the same time as the options say."""
    with ThreadPoolExecutor(max(1, options.jobs)) as pool:
        list(pool.map(lambda run: run.complete(options.fresh), runs))


def write(directory, name, table, text, figure):
    """Write `name`.csv, .md and .png; `figure` is called to make the picture. Raises ResultsError."""
    from postprocess import style

    try:
        table.to_csv(directory / f"{name}.csv", index=False)
        (directory / f"{name}.md").write_text(text)
        with style.applied():
            style.save(figure(), directory / f"{name}.png")
    except OSError as error:
        raise ResultsError(f"the results cannot be saved in '{directory}': {error.strerror or error}") from error


def main(study, options):
    """Print the text that `study` makes of the options, or what keeps it from that; the exit code."""
    try:
        matplotlib_loading.load()  # before the runs: if it is missing they would be in vain
        print(study(options))
    except ModuleNotFoundError as error:
        print(f"error: the Python package '{error.name}' is missing for {sys.executable}", file=sys.stderr)
        return 1
    except (ResultsError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0
