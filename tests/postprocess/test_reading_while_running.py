# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads results while another process writes them, as a user does who looks at a run."""

import collections
import os
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path
from unittest import mock

import h5py
import numpy as np

import synthetic_results
import synthetic_run

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP))

from postprocess import file_reading  # noqa: E402
from postprocess.results import Results, ResultsError, Unreadable  # noqa: E402


class ReadingWhileRunning(unittest.TestCase):
    TRIES = 20

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.run_in_background = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("synthetic_run.py")), str(self.folder)]
        )
        self.addCleanup(self.run_in_background.wait)
        self.addCleanup(self.run_in_background.kill)
        limit = time.monotonic() + 30
        while not (self.folder / "solution-00001.h5").exists() and time.monotonic() < limit:
            time.sleep(0.05)

    def read_last_outputs(self):
        """What a script would read of a run; every value has to be that of its time."""
        results = Results(self.folder)
        statistics = results.statistics()
        np.testing.assert_allclose(statistics.time, synthetic_run.STEP * np.arange(len(statistics)), rtol=1e-12)
        self.assertTrue(np.all(statistics.energy_total == 1.25))

        times = results.interface_times()
        np.testing.assert_allclose(times, synthetic_run.STEP * np.arange(len(times)), atol=1e-12)
        interface = results.interface(times[-1])
        number = round(interface.time / synthetic_run.STEP)
        np.testing.assert_allclose(interface.points, synthetic_run.membrane(number), atol=1e-14)
        self.assertTrue(np.all(interface.composition == 1 + number))
        values = results.interface_values(times[0], ("f", "weights"))
        self.assertTrue(np.all(values["f"] == 1) and np.all(values["weights"] == 1))

        solution = results.solution(results.solution_times()[-1])
        number = round(solution.time / synthetic_run.STEP)
        self.assertTrue(np.all(solution.fields["velocity"] == 1 + number))
        self.assertEqual(results.unreadable, {})

    def test_nearly_every_try_succeeds_and_none_gives_wrong_values(self):
        outcomes = collections.Counter()
        for _ in range(self.TRIES):
            try:
                self.read_last_outputs()
                outcomes["read"] += 1
            except ResultsError as error:
                outcomes[str(error)] += 1
        self.assertIsNone(self.run_in_background.poll(), "the run has ended before its time")
        self.assertGreaterEqual(outcomes["read"], 0.95 * self.TRIES, outcomes)

    def test_all_pictures_are_drawn(self):
        pictures = self.folder / "pictures"
        finished = subprocess.run(
            [sys.executable, "-m", "postprocess", str(self.folder), "--output", str(pictures)],
            cwd=TOP,
            capture_output=True,
            text=True,
        )
        self.assertEqual((finished.returncode, finished.stderr), (0, ""))
        self.assertEqual(
            sorted(os.listdir(pictures)), ["mesh.png", "snapshots.png", "timeseries.png"], finished.stdout
        )


class Resuming(unittest.TestCase):
    def test_outputs_that_a_resumed_run_has_replaced(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "interface.h5"
            synthetic_results.write_interface(path, [0.0, 1.0, 2.0], n=60)
            results = Results(folder)
            np.testing.assert_allclose(results.interface_times(), [0, 1, 2])
            synthetic_results.write_interface(path, [0.0, 1.5], n=60)
            self.assertEqual(results.interface(1.0).time, 1.5)  # another one of the same name
            self.assertEqual(results.interface(2.0).time, 1.5)  # its group is there no more
            self.assertEqual(results.interface(0.0).time, 0.0)
            np.testing.assert_allclose(results.interface_times(), [0, 1.5])

    def test_new_outputs_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            results = Results(folder)
            self.assertEqual(results.solution_times(), [])
            self.assertIsNone(results.solution(0))
            path = Path(folder) / "solution-00000.h5"
            path.write_bytes(b"")
            os.utime(path, (1e9, 1e9))
            self.assertEqual(results.solution_times(), [])
            self.assertEqual(results.unreadable, {"solution-00000.h5": "it is empty"})
            synthetic_results.write_solution(path, 1.5, levels=(4, 8))
            self.assertEqual(results.solution_times(), [1.5])
            self.assertEqual(results.unreadable, {})
            path.unlink()
            self.assertEqual(results.solution_times(), [])


class Patience(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.path = Path(temporary.name) / "solution-00000.h5"

    @staticmethod
    def time_of(file):
        return float(file.attrs["time"])

    def test_a_file_is_read_as_soon_as_it_is_complete(self):
        self.path.write_bytes(b"")

        def complete():
            time.sleep(0.3)
            synthetic_results.write_solution(self.path, 2.5, levels=(4, 8))

        writer = threading.Thread(target=complete)
        writer.start()
        try:
            self.assertEqual(file_reading.read_hdf5(self.path, self.time_of), 2.5)
        finally:
            writer.join()

    def test_a_file_that_keeps_changing_is_given_up(self):
        self.path.write_bytes(b"")
        stop = threading.Event()

        def change():
            while not stop.wait(0.002):
                with open(self.path, "ab") as file:
                    file.write(b"no HDF5")

        writer = threading.Thread(target=change)
        writer.start()
        try:
            with mock.patch.object(file_reading, "PATIENCE", 0.4):
                begin = time.monotonic()
                with self.assertRaisesRegex(Unreadable, "solution-00000.h5 cannot be read: it is damaged, or was not"):
                    file_reading.read_hdf5(self.path, self.time_of)
                self.assertGreater(time.monotonic() - begin, 0.35)
        finally:
            stop.set()
            writer.join()

    def test_an_old_file_is_not_waited_for(self):
        tries = []

        def extract(file):
            tries.append(file.id)
            return self.time_of(file)

        with h5py.File(self.path, "w"):
            pass
        os.utime(self.path, (1e9, 1e9))
        with self.assertRaises(Unreadable):
            file_reading.read_hdf5(self.path, extract)
        self.assertEqual(len(tries), 1)

    def test_a_file_that_a_kill_has_left_open_is_read(self):
        synthetic_results.write_solution(self.path, 1.5, levels=(4, 8))
        with open(self.path, "r+b") as file:
            os.posix_fallocate(file.fileno(), os.path.getsize(self.path), 131072)
        os.utime(self.path, (1e9, 1e9))
        self.assertEqual(file_reading.read_hdf5(self.path, self.time_of), 1.5)

    def test_what_was_read_while_the_file_changed_is_read_again(self):
        """The values of a try count only if nobody was writing meanwhile."""
        synthetic_results.write_solution(self.path, 1.0, levels=(4, 8))
        tries = []

        def extract(file):
            tries.append(self.time_of(file))
            if len(tries) < 3:
                with open(self.path, "r+b") as other:
                    other.truncate(os.path.getsize(self.path) + 4096)
            elif len(tries) == 3:
                size = int.from_bytes(self.path.read_bytes()[40:48], "little")
                with open(self.path, "r+b") as other:
                    other.truncate(size)
            return len(tries)

        self.assertEqual(file_reading.read_hdf5(self.path, extract), 4)

    def test_locks_of_others_are_no_hindrance(self):
        import fcntl

        synthetic_results.write_solution(self.path, 1.5, levels=(4, 8))
        with open(self.path, "r+b") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            self.assertEqual(file_reading.read_hdf5(self.path, self.time_of), 1.5)


if __name__ == "__main__":
    unittest.main()
