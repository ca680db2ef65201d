# SPDX-License-Identifier: LGPL-2.1-or-later
"""Streamlines of the velocity."""

import numpy as np

from postprocess import style

# Below this speed the picture would show round-off.
LEAST_SPEED = 1e-12


def draw(axis, solution, window, resolution=120):
    """Draw them within `window` (left, right, bottom, top)."""
    x = np.linspace(window[0], window[1], resolution)
    y = np.linspace(window[2], window[3], resolution)
    velocity = on_grid(solution, "velocity", x, y)
    speed = np.hypot(velocity[..., 0], velocity[..., 1])
    if not np.any(speed > LEAST_SPEED):
        return
    u, v = np.ma.masked_invalid(velocity[..., 0]), np.ma.masked_invalid(velocity[..., 1])
    axis.streamplot(x, y, u, v, density=0.9, color=style.STREAMLINES, linewidth=0.6, arrowsize=0.6, zorder=1)


def on_grid(solution, name, x, y):
    """
    Values of a field at the points of the grid x, y (len(y) x len(x) x components), bilinear in each cell; nan
    outside the box.

    The cells are rectangles of a few sizes, each size on a lattice of its own, so that the cell of a point is
    found by rounding. (Triangulations do not help here: neighbours do not share vertices.)
    """
    corners = solution.nodes[solution.cells]  # cells x 4 x 2
    low, size = corners.min(axis=1), np.ptp(corners, axis=1)
    values = solution.fields[name][solution.cells]  # cells x 4 x components
    origin = low.min(axis=0)
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    result = np.full((len(points), values.shape[-1]), np.nan)

    scale = size.max()
    for h in np.unique(np.round(size / scale, 6), axis=0) * scale:
        chosen = np.flatnonzero(np.all(np.abs(size - h) < 1e-5 * scale, axis=1))
        order = chosen[np.argsort(lattice_keys(low[chosen] + h / 2, origin, h))]
        keys = lattice_keys(low[order] + h / 2, origin, h)
        wanted = lattice_keys(points, origin, h)
        place = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        inside = keys[place] == wanted
        cell = order[place[inside]]
        result[inside] = interpolate(corners[cell], values[cell], low[cell], h, points[inside])
    return result.reshape(len(y), len(x), -1)


def lattice_keys(points, origin, h):
    """One number for each rectangle of the lattice."""
    index = np.floor((points - origin) / h).astype(np.int64)
    return index[:, 0] * 2**31 + index[:, 1]


def interpolate(corners, values, low, h, points):
    """Bilinear interpolation between the corners, whatever their order."""
    local = ((points - low) / h)[:, None, :]
    corner = np.round((corners - low[:, None, :]) / h)  # 0 or 1
    weight = np.prod(np.where(corner > 0.5, local, 1 - local), axis=-1)
    return np.einsum("ij,ijk->ik", weight, values)
