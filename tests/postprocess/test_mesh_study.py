# SPDX-License-Identifier: LGPL-2.1-or-later
"""The mesh study with a made-up program whose errors and costs are known."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import matplotlib.image
import numpy as np
import pandas as pd

import synthetic_program

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP))

from postprocess.mesh_study import factor_of_unknowns, level_settings, uniform_settings  # noqa: E402


class Settings(unittest.TestCase):
    CASE = {
        "Mesh/Bulk level": "3",
        "Mesh/Membrane level": "6",
        "Mesh/Phase boundary level": "7",
        "Mesh/Finest level": "9",
        "Mesh/Curvature tolerance": "0.5",
        "Mesh/Cells per gap": "4",
        "Mesh/Cells per phase boundary": "0",
    }

    def settings(self, level):
        return dict(setting.split("=") for setting in level_settings(self.CASE, level))

    def test_a_level_halves_all_lengths(self):
        finer = self.settings(8)
        self.assertEqual(finer["Mesh/Membrane level"], "7")
        self.assertEqual(finer["Mesh/Phase boundary level"], "8")
        self.assertEqual(finer["Mesh/Finest level"], "10")
        self.assertEqual(float(finer["Mesh/Curvature tolerance"]), 0.25)
        self.assertEqual(float(finer["Mesh/Cells per gap"]), 8)
        self.assertEqual(float(finer["Mesh/Cells per phase boundary"]), 0)
        same = self.settings(7)
        for key, value in self.CASE.items():
            self.assertEqual(float(same[key]), float(value), key)

    def test_the_bulk_is_never_finer_than_the_membrane(self):
        self.assertEqual(self.settings(3)["Mesh/Bulk level"], "2")
        self.assertEqual(self.settings(5)["Mesh/Bulk level"], "3")

    def test_uniform_meshes_have_one_level(self):
        settings = dict(setting.split("=") for setting in uniform_settings(5))
        for key in ("Bulk level", "Membrane level", "Phase boundary level", "Finest level"):
            self.assertEqual(settings[f"Mesh/{key}"], "5")


class Factors(unittest.TestCase):
    def test_unknowns_for_the_same_error(self):
        # Errors 1/n of adaptive, 1/sqrt(n) of uniform meshes: for the error e they need 1/e and 1/e^2 unknowns.
        adaptive = pd.DataFrame({"unknowns": [10, 100, 1000, 5000]})
        adaptive["f_difference"] = [0.1, 0.01, 0.001, np.nan]
        uniform = pd.DataFrame({"unknowns": [400, 1600, 160000, 10**8]})
        uniform["f_difference"] = uniform.unknowns**-0.5
        np.testing.assert_allclose(factor_of_unknowns(adaptive, uniform, "f"), [20, 40, 400, np.nan])


class Study(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.program = synthetic_program.write(self.folder / "program")
        (self.folder / "case.prm").write_text("")
        self.output = self.folder / "study"

    def run_study(self, *arguments):
        command = [sys.executable, "-m", "postprocess.mesh_study", self.folder / "case.prm"]
        command += ["--executable", self.program, "--time", "0.5", "--output", self.output, *arguments]
        return subprocess.run([str(item) for item in command], cwd=TOP, capture_output=True, text=True)

    def n_computed(self):
        return len((self.output / "count").read_text())

    def test_adaptive_against_uniform(self):
        finished = self.run_study("--values", "4,5,6,7", "--uniform", "4,5,6")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertEqual(self.n_computed(), 7)
        table = pd.read_csv(self.output / "mesh_study.csv")
        adaptive, uniform = table[table.series == "adaptive"], table[table.series == "uniform"]
        h, finest = 2.0 ** -np.arange(4, 8), 2.0**-7
        exact = 0.5 * (h**2 - finest**2)
        np.testing.assert_allclose(adaptive.centroid_x_difference, [*exact[:3], np.nan], rtol=1e-6)
        np.testing.assert_allclose(uniform.centroid_x_difference, exact[:3], rtol=1e-6)
        np.testing.assert_allclose(adaptive.centroid_x_order[1:3], 2, atol=0.02)
        np.testing.assert_allclose(adaptive.curvature_max_order[1:3], 1, atol=0.02)
        self.assertTrue(np.all(np.isnan(table.neck_width)))
        np.testing.assert_allclose(adaptive.unknowns, 100 * 2.0 ** np.arange(4, 8))
        np.testing.assert_allclose(uniform.unknowns, 10 * 4.0 ** np.arange(4, 7))
        np.testing.assert_allclose(uniform.cpu_time, [2, 2.5, 3])
        # Both have the same error at the same level.
        text = (self.output / "mesh_study.md").read_text()
        self.assertEqual(finished.stdout.strip(), text.strip())
        self.assertIn("| 6 | adaptive | 6.4 |", text)
        image = matplotlib.image.imread(self.output / "mesh_study.png")
        self.assertGreater(image[..., :3].std(), 0.02)

    def test_runs_are_used_again(self):
        self.assertEqual(self.run_study("--values", "4,5").returncode, 0)
        self.assertEqual(self.run_study("--values", "4,5,6", "--uniform", "4,5").returncode, 0)
        self.assertEqual(self.n_computed(), 5)
        (self.output / "uniform_level_5" / "statistics.csv").write_text("time\n")
        self.assertEqual(self.run_study("--values", "4,5,6", "--uniform", "4,5").returncode, 0)
        self.assertEqual(self.n_computed(), 6)

    def test_series_and_other_parameters(self):
        finished = self.run_study(
            *("--vary", "curvature", "--values", "1,0.5,0.25"),
            *("--series", "coarse:Mesh/Membrane level=4", "--series", "fine:Mesh/Membrane level=5"),
        )
        self.assertEqual(finished.returncode, 0, finished.stderr)
        table = pd.read_csv(self.output / "mesh_study.csv")
        self.assertEqual(list(table.series), ["coarse"] * 3 + ["fine"] * 3)
        # The tolerance does nothing in this program: only the series differ.
        np.testing.assert_allclose(table.centroid_x_difference[3:], 0.5 * (4.0**-4 - 4.0**-5), rtol=1e-6)
        np.testing.assert_allclose(table.centroid_x_difference[:2], 0)

    def test_mistakes_are_named(self):
        for arguments, part in (
            (("--values", "5,4"), "do not get finer"),
            (("--values", "4,5", "--series", "a:Mesh/Nothing=1"), "Mesh/Nothing"),
            (("--values", "4,5", "--reference", "nobody"), "no series 'nobody'"),
        ):
            finished = self.run_study(*arguments)
            self.assertEqual(finished.returncode, 1)
            self.assertTrue(finished.stderr.splitlines()[-1].startswith("error: "), finished.stderr)
            self.assertIn(part, finished.stderr)
        self.assertEqual(self.run_study("--values", "4,5", "--vary", "nothing").returncode, 2)


if __name__ == "__main__":
    unittest.main()
