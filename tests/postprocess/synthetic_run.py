# SPDX-License-Identifier: LGPL-2.1-or-later
"""A run that goes on until it is ended: python3 synthetic_run.py DIRECTORY. Writes as the program does."""

import os
import sys
import time
from pathlib import Path

import h5py
import numpy as np

import synthetic_results

N_POINTS = 200
STEP = 0.01  # of the time of the run, from one output to the next


def membrane(number):
    """Points of the output of this number, from which it can be told."""
    angle = 2 * np.pi * np.arange(N_POINTS) / N_POINTS
    return (0.3 + 1e-5 * number) * np.column_stack([np.cos(angle), np.sin(angle)])


def append_interface(path, number):
    """The file is opened for each output, gets room first, and the attribute comes last."""
    with open(path, "r+b") as file:
        os.posix_fallocate(file.fileno(), os.path.getsize(path), 200000)
    with h5py.File(path, "r+", locking=False) as file:
        group = file.create_group(f"step_{number:05d}")
        group["points"] = membrane(number)
        for name in ("composition", "f", "f_total", "tension", "curvature", "weights"):
            group[name] = np.full(N_POINTS, 1.0 + number)
        ring = np.arange(N_POINTS)
        group["connectivity"] = np.column_stack([ring, (ring + 1) % N_POINTS]).astype(np.uint32)
        file.flush()
        group.attrs["time"] = STEP * number


def write_solution(path, number):
    """The attribute comes when the rest has been closed."""
    nodes = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    with h5py.File(path, "w", locking=False) as file:
        file["nodes"] = nodes
        file["cells"] = np.arange(4, dtype=np.uint32)[None, :]
        file["velocity"] = np.full((4, 3), 1.0 + number)
    with h5py.File(path, "r+", locking=False) as file:
        file.attrs["time"] = STEP * number


def main(directory):
    with h5py.File(directory / "interface.h5", "w", locking=False) as file:
        file.attrs["schema_version"] = 1
    with open(directory / "statistics.csv", "w") as statistics:
        statistics.write(",".join(synthetic_results.COLUMNS) + "\n")
        for number in range(100000):
            row = ",".join([repr(STEP * number), str(number)] + ["1.25"] * (len(synthetic_results.COLUMNS) - 2)) + "\n"
            half = len(row) // 2
            for part in (row[:half], row[half:]):
                statistics.write(part)
                statistics.flush()
            append_interface(directory / "interface.h5", number)
            if number % 10 == 0:
                write_solution(directory / f"solution-{number // 10:05d}.h5", number)
            time.sleep(0.005)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
