# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which outputs a picture shows."""

import numpy as np

from postprocess.errors import ResultsError

MOST_SNAPSHOTS = 8


def choose(available, wanted):
    """Of the times available: those nearest to the wanted ones, or up to 8 spread evenly in time."""
    if wanted is None:
        if len(available) <= MOST_SNAPSHOTS:
            return available
        wanted = np.linspace(available[0], available[-1], MOST_SNAPSHOTS)
    nearest = {int(np.abs(available - time).argmin()) for time in wanted}
    return available[sorted(nearest)]


def read_chosen(available, choose_of, read):
    """
    What `read` gives for the times that `choose_of` takes of those available. Where that raises a ResultsError the
    choice is made again without the time. Raises the last of these errors if no time is left.
    """
    available = np.asarray(available, float)
    read_already, last_error = {}, ResultsError("there are no outputs")
    while len(available) > 0:
        chosen, failed = choose_of(available), []
        for time in chosen:
            try:
                if time not in read_already:
                    read_already[time] = read(time)
            except ResultsError as error:
                failed.append(time)
                last_error = error
        if not failed:
            return [read_already[time] for time in chosen]
        available = available[~np.isin(available, failed)]
    raise last_error
