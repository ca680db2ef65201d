# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading the files of a run, also of one that is at work. Nothing here draws."""

import os
import re
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from postprocess import file_reading, outputs, statistics_file
from postprocess.errors import ResultsError, Unreadable
from postprocess.outputs import Interface, Solution

__all__ = ["Interface", "Results", "ResultsError", "Solution", "Unreadable"]


class Results:
    """
    The output directory of a run. Whatever is wrong with its files is raised as ResultsError; a file that is just being
    written is tried again for some seconds.

    Outputs that cannot be read are left out of the lists of times; `unreadable` says which, and why.
    """

    def __init__(self, directory):
        self.directory = Path(directory)
        self.interface_path = self.directory / "interface.h5"
        self.unreadable = {}  # what was left out, by its name, and the reason
        self._interfaces = None, []  # the State of the file when it was read, times and groups
        self._solution_times = {}  # name of each file -> its State when it was read, its time or None
        self._solutions()

    def statistics(self):
        """The table of statistics.csv: numbers, nan for what is none."""
        table, n_damaged = statistics_file.read(self.directory / "statistics.csv")
        if n_damaged > 0:
            self.unreadable["rows of statistics.csv"] = f"{n_damaged} damaged"
        return table

    def cpu_time(self):
        """CPU seconds of a finished run, from its log; nan if it has not finished, or the log cannot be read."""
        try:
            found = re.findall(r"([0-9.e+-]+) s CPU \(", file_reading.read_text(self.directory / "log.txt"))
            return float(found[-1]) if found else float("nan")
        except (ResultsError, ValueError):
            return float("nan")

    def exist(self):
        """Whether there is any file of a run, readable or not."""
        paths = self.directory / "statistics.csv", self.interface_path
        return bool(self._solution_times or self.unreadable) or any(map(os.path.lexists, paths))

    def has_interface(self):
        """Whether there is an interface.h5, readable or not."""
        return os.path.isfile(self.interface_path)

    def interface_times(self):
        """Times of the outputs of the membrane, ascending."""
        return np.array([time for time, _ in self._interface_groups()])

    def interface(self, time):
        """The output of the membrane nearest to `time`."""
        return self._read_group(time, outputs.interface_of)

    def interface_values(self, time, names):
        """Values at the points of interface(time), by name: any of the datasets of interface.h5."""

        def extract(group):
            missing = [name for name in names if name not in group]
            if missing:
                raise ResultsError(f"{self.interface_path} holds no {', '.join(missing)} of the membrane")
            n = len(group["points"])
            return {name: outputs.values_of(group, name, n) for name in names}

        return self._read_group(time, extract)

    def solution_times(self):
        """Times of the outputs of the fields, ascending; empty when there are none."""
        return [time for time, _ in self._solutions()]

    def solution(self, time):
        """The output of the fields nearest to `time`, or None."""
        solutions = self._solutions()
        if not solutions:
            return None
        nearest, path = min(solutions, key=lambda entry: abs(entry[0] - time))

        def extract(file):
            if file["nodes"].shape[1] != 2:
                raise ResultsError(f"{path} is three-dimensional: use ParaView with solution.xdmf")
            return outputs.solution_of(file, nearest)

        with self._noting(path.name):
            return file_reading.read_hdf5(path, extract)

    def _read_group(self, time, extract):
        """What `extract` makes of the group of the membrane's output nearest to `time`."""
        known = dict(self._interfaces[1])
        if time in known:  # as it was when the times were asked for: no need to read them all again
            result = self._read_known_group(known[time], time, extract)
            if result is not None:
                return result
        time, name = min(self._interface_groups(), key=lambda entry: abs(entry[0] - time))
        result = self._read_known_group(name, time, extract)
        if result is None:
            raise Unreadable(f"{name} of {self.interface_path}", file_reading.DAMAGED)
        return result

    def _read_known_group(self, name, time, extract):
        """The same of the group called `name`; None if the output of this time is there no more (a run was resumed)."""

        def extract_of_time(file):
            return extract(file[name]) if name in file and outputs.time_of(file[name]) == time else None

        with self._noting(f"{name} of {self.interface_path.name}"):
            return file_reading.read_hdf5(self.interface_path, extract_of_time, f"{name} of {self.interface_path}")

    def _interface_groups(self):
        """Times and names of the outputs of the membrane, ascending; read again only when the file has changed."""
        before = file_reading.state(self.interface_path)
        if self._interfaces[0] != before:
            groups, damaged = file_reading.read_hdf5(
                self.interface_path, list_groups, is_complete=lambda found: not found[1]
            )
            self.unreadable.update((f"{name} of {self.interface_path.name}", file_reading.DAMAGED) for name in damaged)
            self._interfaces = before, groups
        groups = self._interfaces[1]
        if not groups:
            raise ResultsError(f"{self.interface_path} holds no output of the membrane yet")
        return groups

    def _solutions(self):
        """Times and paths of the readable outputs of the fields, ascending; only what is new or has changed is read."""
        try:
            names = os.listdir(self.directory)
        except (FileNotFoundError, NotADirectoryError, ValueError) as error:
            raise ResultsError(
                f"there is no directory '{self.directory}': give the output directory of a run"
            ) from error
        except OSError as error:
            raise ResultsError(f"the directory '{self.directory}' cannot be read: {error.strerror}") from error
        found = []
        for name in sorted(filter(re.compile(r"solution-[0-9]{5,9}\.h5").fullmatch, names)):
            time = self._solution_time(name)
            if time is not None:
                found.append((time, self.directory / name))
        return sorted(found)

    def _solution_time(self, name):
        """The time of an output of the fields; None if it cannot be read, which is noted."""
        path = self.directory / name
        try:
            before = file_reading.state(path)
            if name not in self._solution_times or self._solution_times[name][0] != before:
                self._solution_times[name] = before, None
                with self._noting(name):
                    self._solution_times[name] = before, file_reading.read_hdf5(path, outputs.time_of)
        except Unreadable as error:
            self.unreadable[name] = error.reason
            return None
        return self._solution_times[name][1]

    @contextmanager
    def _noting(self, name):
        """Keep in mind whether what is called `name` can be read."""
        try:
            yield
        except Unreadable as error:
            self.unreadable[name] = error.reason
            raise
        self.unreadable.pop(name, None)


def list_groups(file):
    """Times and names of the outputs in an open interface.h5, ascending, and the names of those that are damaged."""
    groups, damaged = [], []
    for name in file:
        if not name.startswith("step_"):
            continue
        try:
            groups.append((outputs.time_of(file[name]), name))
        except Exception:  # as for the file as a whole
            damaged.append(name)
    return sorted(groups), damaged
