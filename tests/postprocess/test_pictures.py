# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws synthetic results as a user would, and checks what is shown and what is complained about."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import matplotlib.image
import numpy as np

import synthetic_results

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP))

from postprocess import snapshots, streamlines  # noqa: E402
from postprocess.results import Results  # noqa: E402


def run(*arguments, as_folder=False):
    start = [str(TOP / "postprocess")] if as_folder else ["-m", "postprocess"]
    return subprocess.run(
        [sys.executable, *start, *map(str, arguments)],
        cwd="/" if as_folder else TOP,
        capture_output=True,
        text=True,
    )


class Pictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.results = Path(cls.temporary.name) / "results"
        synthetic_results.write(cls.results)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_all_pictures_are_drawn(self):
        output = Path(self.temporary.name) / "pictures"
        finished = run(self.results, "--output", output, "--times", "0,10")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        for name in ("timeseries.png", "snapshots.png", "mesh.png"):
            self.assertIn(str(output / name), finished.stdout)
            image = matplotlib.image.imread(output / name)
            self.assertGreater(min(image.shape[:2]), 400)
            self.assertGreater(image[..., :3].std(), 0.02, f"{name} is blank")
        # At t = 10 both phases are there: saturated red and blue.
        image = matplotlib.image.imread(output / "snapshots.png")[..., :3]
        left = image[:, : int(0.8 * image.shape[1])]  # without the colour bar
        self.assertGreater(np.sum(left[..., 0] - left[..., 2] > 0.5), 200)
        self.assertGreater(np.sum(left[..., 2] - left[..., 0] > 0.5), 200)

    def test_runs_as_a_folder_from_anywhere(self):
        output = Path(self.temporary.name) / "elsewhere"
        finished = run(self.results, "--output", output, "--times", "0", as_folder=True)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertTrue((output / "mesh.png").is_file())

    def test_fields_are_interpolated_exactly_where_they_are_bilinear(self):
        solution = Results(self.results).solution(10.0)
        x, y = np.linspace(-0.99, 0.99, 37), np.linspace(-0.98, 0.97, 23)
        pressure = streamlines.on_grid(solution, "pressure", x, y)[..., 0]
        np.testing.assert_allclose(pressure, np.broadcast_to(x, (23, 37)), atol=1e-12)
        outside = streamlines.on_grid(solution, "pressure", np.array([1.5]), np.array([0.0]))
        self.assertTrue(np.all(np.isnan(outside)))

    def test_times_of_the_snapshots(self):
        available = np.linspace(0, 10, 21)
        np.testing.assert_allclose(snapshots.choose(available, [0.2, 9.9, 10]), [0, 10])
        self.assertEqual(len(snapshots.choose(available, None)), 8)
        np.testing.assert_allclose(snapshots.choose(available[:3], None), available[:3])

    def test_missing_results_are_named(self):
        for path, part in ((self.results / "nowhere", "nowhere"), (Path(self.temporary.name), "statistics.csv")):
            finished = run(path)
            self.assertEqual(finished.returncode, 1)
            self.assertTrue(finished.stderr.startswith("error: "), finished.stderr)
            self.assertIn(part, finished.stderr)

    def test_interface_alone_is_enough_for_snapshots(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            synthetic_results.write_statistics(folder / "statistics.csv", np.linspace(0, 1, 5))
            synthetic_results.write_interface(folder / "interface.h5", [0.0, 1.0])
            finished = run(folder)
            self.assertEqual(finished.returncode, 0, finished.stderr)
            self.assertTrue((folder / "snapshots.png").is_file())
            self.assertFalse((folder / "mesh.png").exists())
            self.assertIn("no mesh.png", finished.stderr)

    def test_damaged_file_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            synthetic_results.write_statistics(folder / "statistics.csv", np.linspace(0, 1, 5))
            (folder / "interface.h5").write_bytes(b"no HDF5")
            finished = run(folder)
            self.assertEqual(finished.returncode, 0)  # the time series can be drawn
            self.assertTrue((folder / "timeseries.png").is_file())
            self.assertIn("interface.h5 cannot be read", finished.stderr)
            with h5py.File(folder / "interface.h5", "w"):
                pass
            self.assertIn("no output of the membrane yet", run(folder).stderr)


if __name__ == "__main__":
    unittest.main()
