# SPDX-License-Identifier: LGPL-2.1-or-later
"""The membrane and the fields in the box at one time, as the program writes them; what is not so is a ValueError."""

from dataclasses import dataclass

import h5py
import numpy as np


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


def time_of(item):
    """The time of a group or file, which is written last: without it something is missing."""
    time = float(item.attrs["time"])
    require(np.isfinite(time), "the time is no number")
    return time


def interface_of(group):
    """The Interface of a group of interface.h5."""
    points = points_of(group, "points", (2, 3))
    n = len(points)
    require(n < 2 or np.any(points != points[0]), "the points coincide")
    composition = values_of(group, "composition", n)
    require(composition.ndim == 1, "the composition is no list of numbers")
    return Interface(time_of(group), points, composition, indices_of(group, "connectivity", 2, n))


def solution_of(file, time):
    """The Solution of a solution-NNNNN.h5 in two dimensions."""
    nodes = points_of(file, "nodes", (2,))
    cells = indices_of(file, "cells", 4, len(nodes))
    require(len(cells) > 0, "there are no cells")
    require(np.all(np.ptp(nodes[cells], axis=1) > 0), "there are cells without extent")
    fields = {
        name: values_of(file, name, len(nodes))
        for name in file
        if name not in ("nodes", "cells") and isinstance(file[name], h5py.Dataset)
    }
    return Solution(time, nodes, cells, fields)


def points_of(group, name, dimensions):
    points = np.asarray(group[name][...], float)
    require(points.ndim == 2 and points.shape[1] in dimensions, f"{name} are no points")
    require(np.all(np.isfinite(points)), f"{name} has coordinates that are no numbers")
    return points


def indices_of(group, name, columns, limit):
    indices = np.asarray(group[name][...])
    require(indices.ndim == 2 and indices.shape[1] == columns, f"{name} has not {columns} columns")
    require(indices.size == 0 or (indices.min() >= 0 and indices.max() < limit), f"{name} is out of range")
    return indices.astype(int)


def values_of(group, name, n):
    """Numbers, one or several for each of n points."""
    values = np.asarray(group[name][...], float)
    require(values.ndim in (1, 2) and len(values) == n, f"{name} has not one value per point")
    return values


def require(condition, otherwise):
    if not condition:
        raise ValueError(otherwise)
