# SPDX-License-Identifier: LGPL-2.1-or-later
"""Necks of closed curves: where two sheets are nearest to each other, and what a neck cuts off."""

from dataclasses import dataclass

import numpy as np

# Every curve is searched with this many points first; a neck narrower than their spacing may be missed.
SEARCH_POINTS = 800


@dataclass
class Neck:
    """A chord between two points of a curve, the shortest one among its neighbours, through the inside."""

    width: float
    ends: np.ndarray  # 2 x 2: the two points
    areas: tuple  # of the two parts of the inside, the smaller one first

    @property
    def bud_area(self):
        return self.areas[0]


def narrowest_neck(curves):
    """The narrowest neck of several curves (curves.Curve), or None: a convex curve has none."""
    necks = [neck for curve in curves for neck in find_necks(curve)]
    return min(necks, key=lambda neck: neck.width, default=None)


def find_necks(curve, inside=True):
    """
    All necks of a curve: local minima of |x(s) - x(t)| over both parameters whose chord runs through the inside
    (inside=False: the gaps, whose chord runs outside). A convex curve has none, because its chords get shorter
    towards the ends of the curve.
    """
    parameters = curve.parameters_at(np.arange(SEARCH_POINTS) / SEARCH_POINTS)
    points = curve.spline(parameters)
    necks = []
    for i, j in local_minima(distances(points)):
        s, t = refine(curve.spline, parameters[i], parameters[j], curve.spline.period / SEARCH_POINTS)
        if s is None:
            continue
        ends = curve.spline(np.array([s, t]))
        if is_inside(ends.mean(axis=0), points) != inside:
            continue
        areas = sorted(abs(part) for part in areas_of_parts(curve, s, t))
        necks.append(Neck(float(np.linalg.norm(ends[1] - ends[0])), ends, tuple(areas)))
    return necks


def distances(points):
    difference = points[:, None, :] - points[None, :, :]
    return np.hypot(difference[..., 0], difference[..., 1])


def local_minima(table):
    """Pairs i < j where a symmetric periodic table is not larger than at its eight neighbours, off the diagonal."""
    n = len(table)
    smallest = np.ones((n, n), bool)
    for di in (-1, 0, 1):
        for dj in (-1, 0, 1):
            if (di, dj) != (0, 0):
                smallest &= table <= np.roll(table, (di, dj), axis=(0, 1))
    first, second = np.nonzero(np.triu(smallest, 3))
    separate = n - (second - first) > 3  # also across the end of the parametrisation
    return list(zip(first[separate], second[separate]))


def refine(spline, s, t, limit):
    """Newton's method for a stationary point of |x(s) - x(t)|^2 / 2; (None, None) if it is no minimum."""
    for _ in range(40):
        x, y = spline(np.array([s, t]))
        dx, dy = spline(np.array([s, t]), 1)
        ddx, ddy = spline(np.array([s, t]), 2)
        chord = x - y
        gradient = np.array([chord @ dx, -(chord @ dy)])
        hessian = np.array(
            [[dx @ dx + chord @ ddx, -(dx @ dy)], [-(dx @ dy), dy @ dy - chord @ ddy]]
        )
        values, vectors = np.linalg.eigh(hessian)
        if values[0] <= 0:  # downhill until the distance is convex
            values = np.maximum(np.abs(values), 1e-3 * values.max())
        step = -vectors @ ((vectors.T @ gradient) / values)
        step *= min(1.0, limit / max(np.abs(step).max(), 1e-300))
        s, t = s + step[0], t + step[1]
        if np.abs(step).max() < 1e-13 * spline.period:
            break
    return (s, t) if np.all(np.linalg.eigvalsh(hessian) > 0) else (None, None)


def is_inside(point, polygon):
    """By the number of edges that a ray to the right crosses."""
    x, y = polygon.T
    next_x, next_y = np.roll(x, -1), np.roll(y, -1)
    crosses = (y > point[1]) != (next_y > point[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        at = x + (point[1] - y) / (next_y - y) * (next_x - x)
    return bool(np.sum(crosses & (at > point[0])) % 2)


def areas_of_parts(curve, s, t):
    """Areas on both sides of the chord between the parameters s and t."""
    spline = curve.spline
    first, second = sorted(np.mod([s, t], spline.period))
    return [area_of_arc(spline, first, second), area_of_arc(spline, second, first + spline.period)]


def area_of_arc(spline, begin, end):
    """Area between the arc from begin to end and its chord: half the integral of x dy - y dx, by Gauss' rule."""
    knots = np.concatenate([spline.knots, spline.knots + spline.period])
    knots = np.concatenate([[begin], knots[(knots > begin) & (knots < end)], [end]])
    middle, half = (knots[1:] + knots[:-1]) / 2, np.diff(knots) / 2
    area = 0.0
    for node, weight in zip(*np.polynomial.legendre.leggauss(3)):  # exact: the integrand has degree five
        x, y = spline(middle + node * half).T
        dx, dy = spline(middle + node * half, 1).T
        area += np.sum(weight * half * (x * dy - y * dx)) / 2
    (x0, y0), (x1, y1) = spline(np.array([begin, end]))
    return area + (x1 * y0 - y1 * x0) / 2
