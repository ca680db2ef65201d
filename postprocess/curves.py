# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closed curves through the points of a membrane: smooth interpolation, distances, values along the curve."""

import numpy as np

# Points nearer to their neighbour than this part of the typical spacing are left out: the quadrature points of two
# cells can all but coincide, and the slope between such points is round-off.
SMALLEST_SPACING = 0.05
FRACTIONS = np.arange(1024) / 1024


class PeriodicSpline:
    """Cubic spline through values (n, or n x components) at ascending knots, of the given period. Fourth order."""

    def __init__(self, knots, values, period):
        self.knots = np.asarray(knots, float)
        self.values = np.asarray(values, float)
        self.period = period
        self.steps = np.diff(np.append(self.knots, self.knots[0] + period))
        if len(self.knots) < 3 or np.any(self.steps <= 0):
            raise ValueError("a periodic spline needs three knots in ascending order within a period")
        self.slopes = self._slopes()

    def _slopes(self):
        """Slopes at the knots that make the second derivative continuous."""
        after, before = self.steps, np.roll(self.steps, 1)
        shape = (-1,) + (1,) * (self.values.ndim - 1)
        rise = (np.roll(self.values, -1, axis=0) - self.values) / after.reshape(shape)
        right = 3 * (np.roll(rise, 1, axis=0) / before.reshape(shape) + rise / after.reshape(shape))
        return solve_cyclic_tridiagonal(1 / before, 2 / before + 2 / after, 1 / after, right)

    def __call__(self, positions, derivative=0):
        x = self.knots[0] + np.mod(np.asarray(positions, float) - self.knots[0], self.period)
        i = np.clip(np.searchsorted(self.knots, x, side="right") - 1, 0, len(self.knots) - 1)
        j = (i + 1) % len(self.knots)
        shape = x.shape + (1,) * (self.values.ndim - 1)
        h = self.steps[i].reshape(shape)
        t = (x - self.knots[i]).reshape(shape) / h
        rise = self.values[j] - self.values[i]
        left, right = self.slopes[i] * h, self.slopes[j] * h
        quadratic, cubic = 3 * rise - 2 * left - right, left + right - 2 * rise
        if derivative == 0:
            return self.values[i] + t * (left + t * (quadratic + t * cubic))
        if derivative == 1:
            return (left + t * (2 * quadratic + 3 * t * cubic)) / h
        return (2 * quadratic + 6 * t * cubic) / h**2


def solve_cyclic_tridiagonal(lower, diagonal, upper, right):
    """
    x of lower[i] x[i-1] + diagonal[i] x[i] + upper[i] x[i+1] = right[i], indices modulo n, diagonally dominant:
    elimination without the two corners, which are a change of rank one.
    """
    n = len(diagonal)
    shift = -diagonal[0]
    main = diagonal.copy()
    main[0] -= shift
    main[-1] -= lower[0] * upper[-1] / shift
    columns = np.zeros((n, 1 + int(np.prod(right.shape[1:]))))
    columns[:, 1:] = right.reshape(n, -1)
    columns[0, 0], columns[-1, 0] = shift, upper[-1]
    for i in range(1, n):
        factor = lower[i] / main[i - 1]
        main[i] -= factor * upper[i - 1]
        columns[i] -= factor * columns[i - 1]
    columns[-1] /= main[-1]
    for i in range(n - 2, -1, -1):
        columns[i] = (columns[i] - upper[i] * columns[i + 1]) / main[i]
    corner, solution = columns[:, 0], columns[:, 1:]
    end = lower[0] / shift
    solution -= np.outer(corner, (solution[0] + end * solution[-1]) / (1 + corner[0] + end * corner[-1]))
    return solution.reshape(right.shape)


class Curve:
    """A closed curve, run through counterclockwise from its rightmost point, with values at its points."""

    def __init__(self, points, values=None):
        points, values = np.asarray(points, float), dict(values or {})
        x, y = points.T
        if np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) < 0:
            points = points[::-1]
            values = {name: value[::-1] for name, value in values.items()}
        keep = spaced(points)
        self.points = points[keep]
        chords = np.linalg.norm(np.roll(self.points, -1, axis=0) - self.points, axis=1)
        knots = np.concatenate([[0.0], np.cumsum(chords)[:-1]])
        self.spline = PeriodicSpline(knots, self.points, chords.sum())
        self._measure()
        self.values = {name: PeriodicSpline(knots, value[keep], chords.sum()) for name, value in values.items()}

    def _measure(self):
        """Arclength at many parameters of the spline, by Gauss' rule with three points between them."""
        self._parameters = refined(self.spline, 4)
        ends = np.append(self._parameters, self._parameters[0] + self.spline.period)
        middle, half = (ends[1:] + ends[:-1]) / 2, np.diff(ends) / 2
        lengths = sum(
            weight * half * np.linalg.norm(self.spline(middle + node * half, 1), axis=1)
            for node, weight in ((-np.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (np.sqrt(0.6), 5 / 9))
        )
        self._arclengths = np.concatenate([[0.0], np.cumsum(lengths)])
        self._ends = ends
        self.length = self._arclengths[-1]

    def rightmost(self):
        """Parameter of the spline of the point with the largest x."""
        position = self._parameters[np.argmax(self.spline(self._parameters)[:, 0])]
        limit = 2 * self.spline.steps.max()
        for _ in range(20):
            slope, bend = self.spline(position, 1)[0], self.spline(position, 2)[0]
            if bend >= 0:
                break
            step = np.clip(-slope / bend, -limit, limit)
            position += step
            if abs(step) < 1e-14 * self.spline.period:
                break
        return position

    def parameters_at(self, fractions):
        """Parameters of the spline where these fractions of the arclength have passed since the rightmost point."""
        first = np.mod(self.rightmost() - self._ends[0], self.spline.period) + self._ends[0]
        start = self._arclength(first)
        wanted = np.mod(start + np.asarray(fractions) * self.length, self.length)
        result = np.interp(wanted, self._arclengths, self._ends)
        for _ in range(3):  # Newton, with the speed of the parametrisation
            speed = np.linalg.norm(self.spline(result, 1), axis=1)
            result = np.clip(result - (self._arclength(result) - wanted) / speed, self._ends[0], self._ends[-1])
        return result

    def _arclength(self, parameters):
        """Arclength from the first knot; the remainder beyond a tabulated one by Gauss' rule."""
        parameters = np.asarray(parameters, float)
        i = np.clip(np.searchsorted(self._ends, parameters, side="right") - 1, 0, len(self._ends) - 2)
        half = (parameters - self._ends[i]) / 2
        middle = self._ends[i] + half
        rest = sum(
            weight * half * np.linalg.norm(self.spline(middle + node * half, 1), axis=-1)
            for node, weight in ((-np.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (np.sqrt(0.6), 5 / 9))
        )
        return self._arclengths[i] + rest

    def along(self, name, fractions=FRACTIONS):
        """The values called `name` at fractions of the arclength from the rightmost point."""
        return self.values[name](self.parameters_at(fractions))

    def distances(self, points):
        """Distance of each point from the curve."""
        samples = self.spline(self._parameters)
        nearest = np.empty(len(points), int)
        for begin in range(0, len(points), 256):  # a bounded table of distances at a time
            part = points[begin : begin + 256]
            squares = np.sum((part[:, None, :] - samples[None, :, :]) ** 2, axis=-1)
            nearest[begin : begin + 256] = squares.argmin(axis=1)
        position = self._parameters[nearest]
        limit = np.diff(self._ends)[nearest]
        best = np.linalg.norm(points - samples[nearest], axis=1)
        for _ in range(6):
            difference, tangent = self.spline(position) - points, self.spline(position, 1)
            slope = np.sum(difference * tangent, axis=1)
            bend = np.sum(tangent**2, axis=1) + np.sum(difference * self.spline(position, 2), axis=1)
            step = np.where(bend > 0, -slope / np.where(bend > 0, bend, 1), 0)
            position = position + np.clip(step, -limit, limit)
            best = np.minimum(best, np.linalg.norm(self.spline(position) - points, axis=1))
        return best


def spaced(points):
    """Which points to keep so that no two neighbours all but coincide."""
    chords = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    least = SMALLEST_SPACING * np.median(chords)
    keep = [0]
    for i in range(1, len(points)):
        if np.linalg.norm(points[i] - points[keep[-1]]) > least:
            keep.append(i)
    while len(keep) > 3 and np.linalg.norm(points[keep[-1]] - points[0]) <= least:
        keep.pop()
    return np.array(keep)


def refined(spline, parts):
    """The knots, with every interval divided evenly."""
    return (spline.knots[:, None] + spline.steps[:, None] * np.arange(parts) / parts).ravel()


def closed_curves(points, segments, values):
    """The curves that the segments form, longest first. Every point has to have one successor."""
    successor = np.full(len(points), -1)
    successor[segments[:, 0]] = segments[:, 1]
    if np.any(successor < 0) or len(segments) != len(points):
        raise ValueError("the segments of the membrane do not form closed curves")
    curves, visited = [], np.zeros(len(points), bool)
    for first in range(len(points)):
        chain, point = [], first
        while not visited[point]:
            visited[point] = True
            chain.append(point)
            point = successor[point]
        if len(chain) > 2:
            curves.append(Curve(points[chain], {name: value[chain] for name, value in values.items()}))
    return sorted(curves, key=lambda curve: -curve.length)
