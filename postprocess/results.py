"""Reading the files of a run. Nothing here draws."""

import re
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
import pandas as pd

COLUMNS_NEEDED = ("time", "time_step_size", "centroid_x", "centroid_y", "arclength", "energy_total")


class ResultsError(Exception):
    """Results that are missing or cannot be read; the message is for the user."""


@dataclass
class Interface:
    """The membrane at one time: n points, values there, and segments between them."""

    time: float
    points: np.ndarray  # n x dim
    composition: np.ndarray  # n
    segments: np.ndarray  # m x 2, indices of points


@dataclass
class Solution:
    """The fields at one time: every cell has four vertices of its own."""

    time: float
    nodes: np.ndarray  # n x 2
    cells: np.ndarray  # m x 4, vertices in cyclic order
    fields: dict  # name -> n or n x 3 values


class Results:
    """The output directory of a run."""

    def __init__(self, directory):
        self.directory = Path(directory)
        if not self.directory.is_dir():
            raise ResultsError(f"there is no directory '{directory}': give the output directory of a run")
        self.interface_path = self.directory / "interface.h5"
        self._solutions = self._find_solutions()

    def statistics(self):
        path = self.directory / "statistics.csv"
        if not path.is_file():
            raise ResultsError(f"{path} is missing: is '{self.directory}' the output directory of a run?")
        try:
            table = pd.read_csv(path)
        except (pd.errors.ParserError, pd.errors.EmptyDataError) as error:
            raise ResultsError(f"{path} cannot be read: {error}")
        missing = [name for name in COLUMNS_NEEDED if name not in table]
        if missing:
            raise ResultsError(f"{path} has no column {', '.join(missing)}: it is not by this version of gemmule")
        if table.empty:
            raise ResultsError(f"{path} has no rows yet: no time step has been finished")
        return table

    def cpu_time(self):
        """CPU seconds of a finished run, from its log; nan if it has not finished."""
        path = self.directory / "log.txt"
        found = re.findall(r"([0-9.e+-]+) s CPU \(", path.read_text()) if path.is_file() else []
        return float(found[-1]) if found else float("nan")

    def has_interface(self):
        return self.interface_path.is_file()

    def interface_times(self):
        """Times of the outputs of the membrane, ascending."""
        return np.array(sorted(time for time, _ in self._interface_groups()))

    def interface(self, time):
        """The output of the membrane nearest to `time`."""
        _, group = min(self._interface_groups(), key=lambda entry: abs(entry[0] - time))
        with self._open(self.interface_path) as file:
            data = file[group]
            return Interface(
                float(data.attrs["time"]),
                data["points"][...],
                data["composition"][...],
                data["connectivity"][...].astype(int),
            )

    def interface_values(self, time, names):
        """Values at the points of interface(time), by name: any of the datasets of interface.h5."""
        _, group = min(self._interface_groups(), key=lambda entry: abs(entry[0] - time))
        with self._open(self.interface_path) as file:
            missing = [name for name in names if name not in file[group]]
            if missing:
                raise ResultsError(f"{self.interface_path} holds no {', '.join(missing)} of the membrane")
            return {name: file[group][name][...] for name in names}

    def solution_times(self):
        """Times of the outputs of the fields, ascending; empty when there are none."""
        return [time for time, _ in self._solutions]

    def solution(self, time):
        """The output of the fields nearest to `time`, or None."""
        if not self._solutions:
            return None
        nearest, path = min(self._solutions, key=lambda entry: abs(entry[0] - time))
        with self._open(path) as file:
            if file["nodes"].shape[1] != 2:
                raise ResultsError(f"{path} is three-dimensional: use ParaView with solution.xdmf")
            nodes = file["nodes"][...]
            cells = file["cells"][...].astype(int)
            fields = {name: file[name][...] for name in file if name not in ("nodes", "cells")}
        return Solution(nearest, nodes, cells, fields)

    def _interface_groups(self):
        with self._open(self.interface_path) as file:
            groups = [
                (float(group.attrs["time"]), name)
                for name, group in file.items()
                if name.startswith("step_") and "time" in group.attrs
            ]
        if not groups:
            raise ResultsError(f"{self.interface_path} holds no output of the membrane yet")
        return groups

    def _find_solutions(self):
        solutions = []
        for path in sorted(self.directory.glob("solution-*.h5")):
            with self._open(path) as file:
                if "time" in file.attrs:
                    solutions.append((float(file.attrs["time"]), path))
        return sorted(solutions)

    @staticmethod
    def _open(path):
        try:
            return h5py.File(path, "r")
        except OSError as error:
            raise ResultsError(f"{path} cannot be read ({error}): it is missing, damaged or being written")
