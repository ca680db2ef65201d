# SPDX-License-Identifier: LGPL-2.1-or-later
"""Necks of curves whose narrowest place and areas are known."""

import sys
import unittest
from pathlib import Path

import numpy as np

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP))

from postprocess.curves import Curve  # noqa: E402
from postprocess.necks import find_necks, narrowest_neck  # noqa: E402


def cassini(a, c, n, shift=(0.0, 0.0), angle=0.0):
    """The Cassini oval with foci at -+c: one curve with a waist of the width 2 sqrt(a^2 - c^2) for c < a < sqrt(2) c."""
    theta = 2 * np.pi * (np.arange(n) + 0.3 * np.sin(5 * np.arange(n))) / n
    radius = np.sqrt(c**2 * np.cos(2 * theta) + np.sqrt(a**4 - c**4 * np.sin(2 * theta) ** 2))
    x, y = radius * np.cos(theta), radius * np.sin(theta)
    return np.column_stack([x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)]) + shift


def cassini_area(a, c):
    """Half the integral of r^2, exact to round-off for a periodic integrand."""
    theta = 2 * np.pi * np.arange(4096) / 4096
    return np.pi * np.mean(np.sqrt(a**4 - c**4 * np.sin(2 * theta) ** 2))


class Necks(unittest.TestCase):
    def test_waist_of_cassini_ovals(self):
        for a, c in ((0.42, 0.4), (0.45, 0.4), (0.401, 0.4)):
            width, area = 2 * np.sqrt(a**2 - c**2), cassini_area(a, c)
            for shift, angle in (((0, 0), 0), ((0.11, -0.07), 0.8), ((-0.3, 0.2), 2.5)):
                necks = find_necks(Curve(cassini(a, c, 900, shift, angle)))
                self.assertEqual(len(necks), 1)
                self.assertAlmostEqual(necks[0].width / width, 1, delta=2e-5)
                np.testing.assert_allclose(necks[0].areas, area / 2, rtol=2e-5)
                np.testing.assert_allclose(necks[0].ends.mean(axis=0), shift, atol=1e-5)

    def test_the_width_converges(self):
        a, c = 0.42, 0.4
        exact = 2 * np.sqrt(a**2 - c**2)
        errors = [abs(find_necks(Curve(cassini(a, c, n)))[0].width - exact) for n in (60, 120, 240)]
        self.assertLess(errors[2], 2e-5 * exact)
        self.assertGreater(np.log2(errors[0] / errors[2]) / 2, 3.0)

    def test_convex_curves_have_no_neck(self):
        angle = 2 * np.pi * np.arange(300) / 300
        for a, b in ((0.4, 0.4), (0.5, 0.35), (0.5, 0.18)):
            curve = Curve(np.column_stack([a * np.cos(angle), b * np.sin(angle)]))
            self.assertIsNone(narrowest_neck([curve]))
        self.assertIsNone(narrowest_neck([Curve(cassini(0.6, 0.4, 300))]))  # beyond sqrt(2) c: convex

    def test_a_gap_through_the_outside_is_no_neck(self):
        # A horseshoe of the width 0.2: its ends are nearest to each other, but the outside lies between them.
        bend = np.linspace(0.35, 2 * np.pi - 0.35, 400)
        outer = 0.5 * np.column_stack([np.cos(bend), np.sin(bend)])
        inner = 0.3 * np.column_stack([np.cos(bend[::-1]), np.sin(bend[::-1])])

        def cap(center, start):
            turn = start + np.linspace(0, np.pi, 60)[1:-1]
            return center + 0.1 * np.column_stack([np.cos(turn), np.sin(turn)])

        end = 0.4 * np.array([np.cos(bend[-1]), np.sin(bend[-1])])
        begin = 0.4 * np.array([np.cos(bend[0]), np.sin(bend[0])])
        horseshoe = np.concatenate([outer, cap(end, bend[-1]), inner, cap(begin, bend[0] + np.pi)])
        curve = Curve(horseshoe)
        self.assertTrue(all(neck.width > 0.19 for neck in find_necks(curve)))
        gap = min(found.width for found in find_necks(curve, inside=False))
        self.assertAlmostEqual(gap, 0.8 * np.sin(0.35) - 0.2, delta=1e-5)

    def test_a_small_bud_on_a_large_vesicle(self):
        # Two circles that meet where each is 0.12 thick.
        grid = np.linspace(0, 2 * np.pi, 600, endpoint=False)
        big, small, joint = 0.4, 0.12, 0.06
        foot = np.arcsin(joint / big)
        bud_center = big * np.cos(foot) + np.sqrt(small**2 - joint**2)
        around = grid[(grid > foot) & (grid < 2 * np.pi - foot)]
        body = big * np.column_stack([np.cos(around), np.sin(around)])
        edge = np.arcsin(joint / small)
        turn = np.linspace(-np.pi + edge, np.pi - edge, 260)
        bud = np.column_stack([bud_center + small * np.cos(turn), small * np.sin(turn)])
        curve = Curve(np.concatenate([body, bud]))
        neck = narrowest_neck([curve])
        self.assertAlmostEqual(neck.width, 2 * joint, delta=3e-3)  # the spline rounds the corners
        circle_part = small**2 * (np.pi - edge + np.sin(edge) * np.cos(edge))
        self.assertAlmostEqual(neck.bud_area, circle_part, delta=0.02 * circle_part)


if __name__ == "__main__":
    unittest.main()
