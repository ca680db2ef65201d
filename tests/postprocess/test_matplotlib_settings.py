# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures are the same whatever a user has set for matplotlib."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import matplotlib
import numpy as np

import synthetic_results
from drawing import TOP, Drawn, age

SETTINGS = """
backend: TkAgg
interactive: True
text.usetex: True
text.latex.preamble: \\usepackage{nowhere}
font.family: No Such Font
font.size: 40
mathtext.fontset: stix
axes.formatter.use_locale: True
axes.formatter.limits: 0, 0
axes.grid: True
axes.labelpad: 200
figure.autolayout: True
figure.dpi: 3
figure.facecolor: black
figure.subplot.left: 0.7
figure.constrained_layout.w_pad: 5
savefig.format: pdf
savefig.bbox: tight
savefig.transparent: True
lines.linewidth: 30
lines.marker: o
image.cmap: jet
path.effects: []
agg.path.chunksize: 7
"""
BROKEN = {
    "unknown keys": "no.such.key: 1\nfont.size: huge\nbackend: nowhere\naxes.prop_cycle: cycler(\nno colon\n",
    "no text": b"\xff\xfe\x00font.size: 3\n\x80",
}


class MatplotlibSettings(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.results = cls.folder / "run"
        cls.results.mkdir()
        synthetic_results.write_statistics(cls.results / "statistics.csv", np.linspace(0, 1, 30))
        synthetic_results.write_interface(cls.results / "interface.h5", [0.0], n=60)
        synthetic_results.write_solution(cls.results / "solution-00000.h5", 0.0, levels=(4, 8))
        age(cls.results)
        cls.expected = cls.pictures(cls.folder, {})

    @classmethod
    def pictures(cls, directory, environment):
        """The pictures as drawn in the directory with these variables; name -> bytes."""
        output = Path(tempfile.mkdtemp(dir=cls.folder))
        finished = subprocess.run(
            [sys.executable, str(TOP / "postprocess"), str(cls.results), "--output", str(output)],
            cwd=directory,
            env={**os.environ, **{name: str(value) for name, value in environment.items()}},
            capture_output=True,
            text=True,
        )
        assert (finished.returncode, finished.stderr) == (0, ""), finished.stderr
        return {path.name: path.read_bytes() for path in output.iterdir()}

    def test_three_pictures_are_expected(self):
        self.assertEqual(sorted(self.expected), ["mesh.png", "snapshots.png", "timeseries.png"])

    def test_a_matplotlibrc_has_no_influence(self):
        (self.folder / "user.rc").write_text(SETTINGS)
        environment = {"MATPLOTLIBRC": self.folder / "user.rc", "MPLBACKEND": "TkAgg", "DISPLAY": "", "LC_ALL": "xx_XX"}
        self.assertEqual(self.pictures(self.folder, environment), self.expected)

    def test_a_matplotlibrc_where_one_works_has_no_influence(self):
        directory = Path(tempfile.mkdtemp(dir=self.folder))
        (directory / "matplotlibrc").write_text(SETTINGS)
        self.assertEqual(self.pictures(directory, {}), self.expected)

    def test_a_broken_matplotlibrc_has_no_influence(self):
        for text in BROKEN.values():
            directory = Path(tempfile.mkdtemp(dir=self.folder))
            (directory / "matplotlibrc").write_bytes(text if isinstance(text, bytes) else text.encode())
            self.assertEqual(self.pictures(directory, {"MPLBACKEND": "nowhere"}), self.expected)

    def test_settings_of_a_script_that_draws_stay(self):
        with matplotlib.rc_context({"text.usetex": True, "font.family": "No Such Font", "lines.linewidth": 30}):
            drawn = Drawn(self.results, "--output", self.folder / "own")
            self.assertEqual((drawn.code, drawn.messages), (0, []))
            self.assertEqual(matplotlib.rcParams["lines.linewidth"], 30)
            self.assertTrue(matplotlib.rcParams["text.usetex"])
        for name, content in self.expected.items():
            self.assertEqual((self.folder / "own" / name).read_bytes(), content, name)

    def test_no_window_is_made(self):
        code = (
            "import sys; from postprocess.command_line import main;"
            f"main([{str(self.results)!r}, '--output', {str(self.folder / 'windows')!r}]);"
            "print('matplotlib.pyplot' in sys.modules)"
        )
        finished = subprocess.run([sys.executable, "-c", code], cwd=TOP, capture_output=True, text=True)
        self.assertEqual(finished.stdout.splitlines()[-1], "False", finished.stderr)


if __name__ == "__main__":
    unittest.main()
