# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where pictures go, and that a picture is either whole or as it was before."""

import os
import resource
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from drawing import PICTURES, TOP, Drawn, write_small_results

from postprocess import snapshots


class Saving(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.results = Path(temporary.name) / "run"
        write_small_results(cls.results)

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name) / "pictures"

    def assert_nothing_drawn(self, drawn, *parts):
        self.assertEqual((drawn.code, drawn.pictures, len(drawn.messages)), (1, (), 1), drawn.messages)
        self.assertTrue(drawn.messages[0].startswith("error: nothing can be drawn"), drawn.messages)
        for part in parts:
            self.assertIn(part, drawn.messages[0])

    def test_a_full_disk_leaves_no_part_of_a_picture(self):
        self.folder.mkdir()
        (self.folder / "mesh.png").write_text("of an earlier run")
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (5000, before[1]))
        try:
            drawn = Drawn(self.results, "--output", self.folder)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)
        self.assert_nothing_drawn(drawn, "no timeseries.png, no snapshots.png, no mesh.png", "File too large")
        self.assertEqual(os.listdir(self.folder), ["mesh.png"])
        self.assertEqual((self.folder / "mesh.png").read_text(), "of an earlier run")

    def test_a_directory_that_cannot_be_made(self):
        (self.folder.parent / "file").write_text("")
        for folder in (self.folder.parent / "file", self.folder.parent / "file" / "below", Path("/proc/pictures")):
            drawn = Drawn(self.results, "--output", folder)
            self.assert_nothing_drawn(drawn, f"cannot be saved in '{folder}'", "--output")
            self.assertEqual(drawn.messages[0].count("cannot be saved"), 1)

    def test_one_picture_that_cannot_be_saved_does_not_stop_the_others(self):
        (self.folder / "snapshots.png").mkdir(parents=True)
        drawn = Drawn(self.results, "--output", self.folder)
        self.assertEqual((drawn.code, drawn.pictures), (0, ("timeseries.png", "mesh.png")))
        self.assertEqual(len(drawn.messages), 1)
        self.assertIn("note: no snapshots.png (it cannot be saved in", drawn.messages[0])
        self.assertEqual(sorted(os.listdir(self.folder)), sorted(PICTURES))

    def test_one_picture_that_cannot_be_drawn_does_not_stop_the_others(self):
        for error in (ValueError("image too large"), RuntimeError("no font"), MemoryError(), KeyError("x")):
            with mock.patch.object(snapshots, "draw", side_effect=error):
                drawn = Drawn(self.results, "--output", self.folder)
            self.assertEqual((drawn.code, drawn.pictures), (0, ("timeseries.png", "mesh.png")))
            self.assertEqual(len(drawn.messages), 1)
            reason = f"it cannot be drawn of these results, {type(error).__name__}"
            self.assertIn(f"no snapshots.png ({reason}", drawn.messages[0])

    def test_nobody_has_to_read_what_is_printed(self):
        for output in ("/dev/full", None):
            with open(output, "w") if output else self.closed_pipe() as out:
                finished = subprocess.run(
                    [sys.executable, "-m", "postprocess", str(self.results), "--output", str(self.folder)],
                    cwd=TOP,
                    stdout=out,
                    stderr=subprocess.PIPE,
                    text=True,
                )
            self.assertEqual((finished.returncode, finished.stderr), (0, ""))
            self.assertEqual(sorted(os.listdir(self.folder)), sorted(PICTURES))

    @staticmethod
    def closed_pipe():
        reading, writing = os.pipe()
        os.close(reading)
        return os.fdopen(writing, "w")

    def test_times_that_are_none(self):
        for times in ("nan", "0,inf", "", "0,,1", "soon"):
            with self.assertRaises(SystemExit) as ended, self.quiet():
                Drawn(self.results, "--times", times)
            self.assertEqual(ended.exception.code, 2)

    @staticmethod
    def quiet():
        return mock.patch("sys.stderr")


if __name__ == "__main__":
    unittest.main()
