# SPDX-License-Identifier: LGPL-2.1-or-later
"""Command line: which results, where to, which times."""

import argparse
import math
import os
import sys
from pathlib import Path

from postprocess.pictures import Pictures
from postprocess.results import Results, ResultsError


def parse_times(text):
    try:
        times = [float(item) for item in text.split(",")]
    except ValueError:
        times = [math.nan]
    if not all(map(math.isfinite, times)):
        raise argparse.ArgumentTypeError(
            f"'{text}' is not a list of numbers separated by commas, such as 0,0.2,1"
        )
    return times


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
        results = Results(options.results)
        if not results.exist():
            raise ResultsError(
                f"there is neither statistics.csv nor interface.h5 in '{options.results}': "
                "give the output directory of a run"
            )
        pictures = Pictures(results, options.output or options.results, options.times)
        drawn = 0
        for picture in pictures.draw():
            say(picture)
            drawn += 1
    except (ResultsError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    note = pictures.note()
    if drawn == 0:
        print(f"error: nothing can be drawn of '{options.results}': {note}", file=sys.stderr)
        return 1
    if note:
        print(f"note: {note}", file=sys.stderr)
    return 0


def say(path):
    """Print a path; that nobody listens is no reason to stop."""
    try:
        print(os.fsencode(path).decode(errors="replace"), flush=True)
    except OSError:
        sys.stdout = open(os.devnull, "w")
