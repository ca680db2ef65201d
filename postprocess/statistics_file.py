# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading statistics.csv, to which a run may be adding a row, and which may have ended in the middle of one."""

import csv
import io

import numpy as np
import pandas as pd

from postprocess.errors import ResultsError, Unreadable
from postprocess.file_reading import DAMAGED, read_text

COLUMNS_NEEDED = ("time", "time_step_size", "centroid_x", "centroid_y", "arclength", "energy_total")


def read(path):
    """
    The table, all numbers (nan for what is none), and how many rows had to be left out because they are damaged. The
    last line does not count until it is complete. Raises ResultsError if there is no such table.
    """
    header, rows = complete_lines(read_text(path))
    if not header:
        raise Unreadable(path, "it is empty, or its first line is not complete")
    n_separators = header.count(",")
    kept = [row for row in rows if row.count(",") == n_separators]
    try:
        table = pd.read_csv(
            io.StringIO("\n".join([header, *kept])),
            quoting=csv.QUOTE_NONE,
            index_col=False,
            float_precision="round_trip",
            low_memory=False,
        )
    except (pd.errors.ParserError, pd.errors.EmptyDataError, ValueError, OverflowError) as error:
        raise Unreadable(path, DAMAGED) from error
    missing = [name for name in COLUMNS_NEEDED if name not in table]
    if missing:
        raise ResultsError(f"{path} has no column {', '.join(missing)}: it is not by this version of gemmule")
    table = pd.DataFrame({name: numbers(column) for name, column in table.items()})
    table = table[np.isfinite(table.time)].reset_index(drop=True)
    if table.empty:
        raise ResultsError(f"{path} has no rows yet: no time step has been finished")
    return table, len(rows) - len(table)


def numbers(column):
    """The column as numbers, whole ones if all are, with nan for text."""
    result = pd.to_numeric(column, errors="coerce")
    return result if result.dtype.kind in "iuf" else result.astype(float)


def complete_lines(text):
    """The header and the rows of a text, without the last line if that has no end; blank lines are none."""
    lines = [line.strip("\r") for line in text.split("\n")[:-1]]
    return (lines[0].strip(), [line for line in lines[1:] if line.strip()]) if lines else ("", [])
