# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drawing pictures within the test's process, which is quicker than a process of its own, and damaging results."""

import contextlib
import io
import os
import sys
from pathlib import Path

import h5py
import numpy as np

import synthetic_results

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP))

from postprocess import command_line  # noqa: E402

PICTURES = ("timeseries.png", "snapshots.png", "mesh.png")


class Drawn:
    """Exit code, the names of the pictures that were printed, and the lines on standard error."""

    def __init__(self, *arguments):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            self.code = command_line.main([str(argument) for argument in arguments])
        self.pictures = tuple(Path(line).name for line in out.getvalue().splitlines())
        self.messages = err.getvalue().splitlines()


def write_small_results(folder, times=(0.0, 1.0, 2.0)):
    """Results with an output of everything at each time."""
    folder.mkdir(parents=True, exist_ok=True)
    synthetic_results.write_statistics(folder / "statistics.csv", np.array(times, float))
    synthetic_results.write_interface(folder / "interface.h5", times, n=60)
    for number, time in enumerate(times):
        synthetic_results.write_solution(folder / f"solution-{number:05d}.h5", time, levels=(4, 8))
    age(folder)


def age(folder):
    """Nobody is writing any more: so reading does not wait for it."""
    for path in folder.iterdir():
        if path.is_file():
            os.utime(path, (1e9, 1e9))


def cut(path, part):
    """Leave this part of the file."""
    with open(path, "r+b") as file:
        file.truncate(int(part * os.path.getsize(path)))


def change_hdf5(change):
    """What makes of a path the HDF5 file there, changed."""

    def make(path):
        with h5py.File(path, "r+") as file:
            change(file)

    return make


def replace(name, values):
    """A change of an HDF5 file or group: other values of a dataset; none without values."""

    def change(file):
        del file[name]
        if values is not None:
            file[name] = values

    return change
