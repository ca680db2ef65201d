# SPDX-License-Identifier: LGPL-2.1-or-later
"""The mathematics of the convergence study on curves and errors that are known, and the study with a made-up program."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import pandas as pd

import synthetic_program

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP))

from postprocess.case_runs import entries, varied  # noqa: E402
from postprocess.convergence import State  # noqa: E402
from postprocess.curves import Curve, PeriodicSpline, closed_curves  # noqa: E402
from postprocess.observed_order import observed_order, orders  # noqa: E402


def uneven_angles(n, seed, close=True):
    """Angles around the circle as quadrature points leave them: uneven, and some pairs all but the same."""
    random = np.random.default_rng(seed)
    angles = 2 * np.pi * (np.arange(n) + 0.3 * random.random(n)) / n
    return np.sort(np.concatenate([angles, angles[::7] + 1e-9])) if close else angles


def ellipse(angles, a=0.5, b=0.35):
    return np.column_stack([a * np.cos(angles), b * np.sin(angles)])


class Splines(unittest.TestCase):
    def test_fourth_order_with_uneven_knots(self):
        errors = []
        for n in (20, 40, 80):
            knots = 2 * np.pi * np.arange(n) / n
            knots += 0.3 * np.sin(3 * knots) / 3
            spline = PeriodicSpline(knots, np.exp(np.sin(knots)), 2 * np.pi)
            x = np.linspace(-7, 20, 1001)  # several periods
            errors.append(np.abs(spline(x) - np.exp(np.sin(x))).max())
            slope = np.cos(x) * np.exp(np.sin(x))
            self.assertLess(np.abs(spline(x, 1) - slope).max(), 1200 / n**3)
        self.assertGreater(np.log2(errors[1] / errors[2]), 3.7)
        self.assertLess(errors[2], 1e-5)

    def test_smooth_at_the_knots(self):
        knots = np.array([0.0, 0.3, 0.5, 1.2, 1.9])
        spline = PeriodicSpline(knots, np.array([1.0, 0.0, 2.0, -1.0, 0.5]), 2.5)
        for knot in knots:
            for derivative in (0, 1, 2):
                before, after = spline(np.array([knot - 1e-10, knot + 1e-10]), derivative)
                self.assertAlmostEqual(before, after, delta=1e-6)
        np.testing.assert_allclose(spline(knots), spline.values, atol=1e-14)


class Curves(unittest.TestCase):
    def test_distance_from_a_circle(self):
        angles = uneven_angles(200, 1)
        circle = Curve(ellipse(angles, 0.4, 0.4))
        for radius in (0.4, 0.401, 0.37):
            points = ellipse(uneven_angles(90, 2), radius, radius)
            np.testing.assert_allclose(circle.distances(points), abs(radius - 0.4), atol=2e-8)
        self.assertAlmostEqual(circle.length, 0.8 * np.pi, delta=2e-8)

    def test_a_shift_is_the_largest_distance(self):
        curve = Curve(ellipse(uneven_angles(400, 3)))
        moved = ellipse(np.arange(400) * np.pi / 200) + [1e-5, 0]
        self.assertAlmostEqual(curve.distances(moved).max(), 1e-5, delta=2e-8)

    def test_values_along_the_curve_do_not_depend_on_its_points(self):
        # On a circle around (0.1, 0.2) arclength is the angle.
        fractions = np.linspace(0, 1, 37, endpoint=False)
        wanted = np.sin(4 * np.pi * fractions) + 0.2 * np.cos(2 * np.pi * fractions)
        for seed, orientation, start in ((4, 1, 0), (5, -1, 100), (6, 1, 331)):
            angles = np.roll(uneven_angles(400, seed), start)[::orientation]
            values = np.sin(2 * angles) + 0.2 * np.cos(angles)
            curve = Curve(ellipse(angles, 0.3, 0.3) + [0.1, 0.2], {"f": values})
            np.testing.assert_allclose(curve.along("f", fractions), wanted, atol=2e-6)

    def test_fractions_are_of_the_arclength_not_of_the_parameter(self):
        # By symmetry quarters of the arclength are quarters of the angle; eighths are not.
        angles = uneven_angles(600, 7)
        curve = Curve(ellipse(angles, 0.6, 0.2), {"angle": np.cos(angles), "y": 0.2 * np.sin(angles)})
        np.testing.assert_allclose(
            curve.along("angle", np.array([0, 0.25, 0.5, 0.75])), [1, 0, -1, 0], atol=1e-6
        )
        t = np.linspace(0, np.pi / 2, 200001)
        length = np.concatenate([[0], np.cumsum(np.hypot(0.6 * np.sin(t), 0.2 * np.cos(t)))])
        eighth = t[np.searchsorted(length, length[-1] / 2) - 1]
        self.assertAlmostEqual(curve.along("y", np.array([0.125]))[0], 0.2 * np.sin(eighth), delta=1e-5)
        self.assertGreater(abs(eighth - np.pi / 4), 0.1)

    def test_two_curves_are_told_apart(self):
        angles = uneven_angles(60, 8)
        n = len(angles)
        points = np.concatenate([ellipse(angles, 0.1, 0.1), ellipse(angles, 0.3, 0.3) + 1])
        ring = np.column_stack([np.arange(n), (np.arange(n) + 1) % n])
        curves = closed_curves(points, np.concatenate([ring, ring + n]), {"f": np.arange(2.0 * n)})
        np.testing.assert_allclose([curve.length for curve in curves], [0.6 * np.pi, 0.2 * np.pi], rtol=1e-5)
        with self.assertRaises(ValueError):
            closed_curves(points, ring, {})


class Orders(unittest.TestCase):
    def test_the_order_of_a_power_is_found(self):
        for sizes in ([0.4, 0.2, 0.1], [0.4, 0.3, 0.05], [1e-3, 1e-4, 1e-5]):
            for order in (0.3, 1.0, 2.0, 3.7, -1.0):
                values = np.array(sizes) ** order
                found = observed_order(sizes, *np.abs(np.diff(values)))
                self.assertAlmostEqual(found, order, places=6)

    def test_no_order_of_no_difference(self):
        self.assertTrue(np.isnan(observed_order([0.4, 0.2, 0.1], 1e-3, 0.0)))
        self.assertTrue(np.isnan(observed_order([0.4, 0.2, 0.1], float("nan"), 1e-3)))

    def test_the_finest_run_is_not_taken_as_exact(self):
        sizes = np.array([0.4, 0.2, 0.1, 0.05])
        values = 1 + sizes**2
        found = orders(sizes, np.abs(np.diff(values)))
        np.testing.assert_allclose(found[1:-1], 2, atol=1e-9)
        self.assertTrue(np.isnan(found[0]) and np.isnan(found[-1]))
        to_finest = np.abs(values - values[-1])
        self.assertGreater(np.log2(to_finest[1] / to_finest[2]), 2.3)


class Study(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.program = synthetic_program.write(self.folder / "program")
        (self.folder / "case.prm").write_text("")
        self.output = self.folder / "study"

    def run_study(self, *arguments, values="3,4,5,6"):
        command = [sys.executable, "-m", "postprocess.convergence", self.folder / "case.prm"]
        command += ["--executable", self.program, "--parameter", "Mesh/Membrane level", "--values", values]
        command += ["--time", "0.5", "--output", self.output, *arguments]
        return subprocess.run([str(item) for item in command], cwd=TOP, capture_output=True, text=True)

    def n_computed(self):
        return len((self.output / "count").read_text())

    def test_table_and_picture(self):
        finished = self.run_study("--jobs", "2")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        table = pd.read_csv(self.output / "convergence.csv")
        h = 2.0 ** -np.arange(3, 7)
        np.testing.assert_allclose(table["size"], h)
        for name, exact, order in (
            ("centroid_x", 0.5 * h**2, 2),
            ("arclength", 2 * np.pi * h**3, 3),
            ("position", h**3, 3),
            ("f", 10 * h**4, 4),
        ):
            difference = table[f"{name}_difference"].to_numpy()
            np.testing.assert_allclose(difference[:-1], (exact - exact[-1])[:-1], rtol=0.01, atol=1e-8)
            np.testing.assert_allclose(table[f"{name}_order"][1:3], order, atol=0.02)
        self.assertTrue(np.all(table.energy_total_difference[:-1] == 0))
        self.assertTrue(np.all(np.isnan(table.energy_total_order)))
        self.assertEqual(list(table.cells), [64, 256, 1024, 4096])
        self.assertIn("| 4 | 256 |", finished.stdout)
        self.assertEqual(finished.stdout.strip(), (self.output / "convergence.md").read_text().strip())
        self.assertTrue((self.output / "convergence.png").is_file())

    def test_runs_are_used_again_if_nothing_has_changed(self):
        self.assertEqual(self.run_study(values="3,4").returncode, 0)
        self.assertEqual(self.n_computed(), 2)
        self.assertEqual(self.run_study(values="3,4,5").returncode, 0)
        self.assertEqual(self.n_computed(), 3)
        self.assertEqual(self.run_study("--set", "Fluid/Viscosity ratio=7", values="3,4,5").returncode, 0)
        self.assertEqual(self.n_computed(), 6)
        (self.output / "Membrane_level_4" / "interface.h5").unlink()
        self.assertEqual(self.run_study("--set", "Fluid/Viscosity ratio=7", values="3,4,5").returncode, 0)
        self.assertEqual(self.n_computed(), 7)
        self.assertEqual(self.run_study("--set", "Fluid/Viscosity ratio=7", "--fresh", values="3,4").returncode, 0)
        self.assertEqual(self.n_computed(), 9)

    def test_runs_whose_files_are_damaged_are_computed_again(self):
        settings = (self.program, self.folder / "case.prm", [], "Mesh/Membrane level", "3", 0.5, self.output)
        run = varied(*settings)
        self.assertFalse(run.is_finished())
        run.complete()
        self.assertTrue(run.is_finished())
        whole = {path: path.read_bytes() for path in run.directory.iterdir()}
        for name, content in (
            ("parameters.prm", None),
            ("parameters.prm", b""),
            ("parameters.prm", b"end\nset\nsubsection\n\xff\xfe\nset =\nend\nend\n"),
            ("statistics.csv", None),
            ("statistics.csv", whole[run.directory / "statistics.csv"][:-1]),
            ("statistics.csv", b"\xff\xfe\0\n\n"),
            ("interface.h5", None),
            ("interface.h5", b""),
            ("interface.h5", whole[run.directory / "interface.h5"][:3000]),
        ):
            with self.subTest(name=name, content=content and content[:9]):
                path = run.directory / name
                path.unlink()
                if content is None:
                    path.mkdir()
                else:
                    path.write_bytes(content)
                    os.utime(path, (1e9, 1e9))
                self.assertFalse(run.is_finished())
                if content is None:
                    path.rmdir()
                path.write_bytes(whole[path])
        (run.directory / "log.txt").write_bytes(b"\xff 1e+-. s CPU (")
        self.assertTrue(run.is_finished())
        self.assertTrue(np.isnan(State(run.directory, 0.5).costs["cpu_time"]))

    def test_what_cannot_be_saved_is_named(self):
        self.assertEqual(self.run_study(values="3,4").returncode, 0)
        (self.output / "convergence.png").unlink()
        (self.output / "convergence.png").mkdir()
        finished = self.run_study(values="3,4")
        self.assertEqual(finished.returncode, 1)
        self.assertIn("error: the results cannot be saved in", finished.stderr.splitlines()[-1])

    def test_mistakes_are_named(self):
        for arguments, values, part in (
            ((), "5,4", "do not get finer"),
            (("--set", "Fluid/Vicosity=1"), "3,4", "Fluid/Vicosity"),
            (("--executable", "nowhere"), "3,4", "nowhere"),
        ):
            finished = self.run_study(*arguments, values=values)
            self.assertEqual(finished.returncode, 1)
            self.assertTrue(finished.stderr.splitlines()[-1].startswith("error: "), finished.stderr)
            self.assertIn(part, finished.stderr)
        self.assertEqual(self.run_study(values="3,fine").returncode, 2)

    def test_a_parameter_that_changes_nothing_is_named(self):
        finished = self.run_study("--parameter", "Fluid/Viscosity ratio", values="3,2,1")
        self.assertEqual(finished.returncode, 1)
        self.assertIn("Fluid/Viscosity ratio = 3 and 2 are the same", finished.stderr)
        self.assertFalse((self.output / "convergence.png").exists())

    def test_parameter_files_are_compared_without_their_comments(self):
        one = "set End time = 2 # default: 1\nsubsection A\n  subsection B\n    set c   = 3\n  end\nend\n"
        other = "# made later\nset End time=2\nsubsection A\n subsection B\n  set c = 3\n end\nend\n"
        self.assertEqual(entries(one), entries(other))
        self.assertEqual(entries(one), {"End time": "2", "A/B/c": "3"})
        self.assertNotEqual(entries(one), entries(other.replace("3", "4")))


if __name__ == "__main__":
    unittest.main()
