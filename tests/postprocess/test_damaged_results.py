# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results in which something is missing, half-written or damaged: what can be drawn is drawn, with one note."""

import itertools
import os
import shutil
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

import synthetic_results
from drawing import PICTURES, Drawn, age, change_hdf5, cut, replace, write_small_results

from postprocess import mesh, snapshots, style, time_series
from postprocess.convergence import State
from postprocess.results import Results, ResultsError
from postprocess.selection import read_chosen

NOT_WHOLE = "it is damaged, or was not written to its end"


def unlink_and(make):
    def change(path):
        path.unlink()
        make(path)

    return change


# What can be wrong with a file of HDF5, and what is said about it.
DAMAGES = {
    "empty": (lambda path: path.write_bytes(b""), "it is empty"),
    "cut in the header": (lambda path: cut(path, 0.01), NOT_WHOLE),
    "cut in the middle": (lambda path: cut(path, 0.5), NOT_WHOLE),
    "cut at the end": (lambda path: cut(path, 0.999), NOT_WHOLE),
    "of another kind": (lambda path: path.write_text("no HDF5\n" * 1000), NOT_WHOLE),
    "all zeros": (lambda path: path.write_bytes(bytes(os.path.getsize(path))), NOT_WHOLE),
    "a directory": (unlink_and(lambda path: path.mkdir()), "it is a directory"),
    "a pipe": (unlink_and(os.mkfifo), "it is not a file"),
    "a link to nothing": (unlink_and(lambda path: path.symlink_to("nothing")), "it is missing"),
    "a link to itself": (unlink_and(lambda path: path.symlink_to(path.name)), "Too many levels of symbolic links"),
}
DAMAGES_OF_SOLUTIONS = {
    **DAMAGES,
    "without time": (change_hdf5(lambda file: file.attrs.pop("time")), NOT_WHOLE),
    "with text for its time": (change_hdf5(lambda file: file.attrs.create("time", "late")), NOT_WHOLE),
    "with a time that is no number": (change_hdf5(lambda file: file.attrs.create("time", np.nan)), NOT_WHOLE),
    "without nodes": (change_hdf5(replace("nodes", None)), NOT_WHOLE),
    "without cells": (change_hdf5(replace("cells", None)), NOT_WHOLE),
    "with no cells": (change_hdf5(replace("cells", np.empty((0, 4), np.uint32))), NOT_WHOLE),
    "with nodes of zeros": (change_hdf5(lambda file: file["nodes"].write_direct(0 * file["nodes"][...])), NOT_WHOLE),
    "with a group for its nodes": (
        change_hdf5(lambda file: (replace("nodes", None)(file), file.create_group("nodes"))),
        NOT_WHOLE,
    ),
    "with points beyond the last": (change_hdf5(replace("cells", np.full((9, 4), 10**6))), NOT_WHOLE),
    "with a short field": (change_hdf5(replace("velocity", np.zeros((3, 3)))), NOT_WHOLE),
}
DAMAGES_OF_GROUPS = {
    "without points": replace("points", None),
    "without composition": replace("composition", None),
    "without connectivity": replace("connectivity", None),
    "without time": lambda group: group.attrs.pop("time"),
    "with points that are no numbers": replace("points", np.full((60, 2), np.nan)),
    "with points of zeros": replace("points", np.zeros((60, 2))),
    "with a short composition": replace("composition", np.zeros(59)),
    "with points beyond the last": replace("connectivity", np.full((60, 2), 60)),
    "with text": replace("composition", "mixed"),
    "with nothing": lambda group: [replace(name, None)(group) for name in list(group)],
}


class Damaged(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.undamaged = Path(temporary.name) / "undamaged"
        write_small_results(cls.undamaged)
        cls.numbers = itertools.count()

    def setUp(self):
        self.folder = self.results()

    def results(self):
        """Undamaged ones, in a folder of their own."""
        return Path(shutil.copytree(self.undamaged, self.undamaged.with_name(f"run{next(self.numbers)}")))

    def assert_drawn(self, drawn, pictures, *parts):
        """These pictures, and one note with these parts, or none without parts."""
        self.assertEqual((drawn.code, drawn.pictures), (0, pictures), drawn.messages)
        self.assertEqual(len(drawn.messages), 1 if parts else 0, drawn.messages)
        for part in parts:
            self.assertIn(part, drawn.messages[0])
            self.assertTrue(drawn.messages[0].startswith("note: "))

    # Fields.

    def test_a_damaged_solution_is_left_out(self):
        for kind, (damage, reason) in DAMAGES_OF_SOLUTIONS.items():
            with self.subTest(kind):
                folder = self.results()
                damage(folder / "solution-00002.h5")
                age(folder)
                results = Results(folder)
                with style.applied():
                    axis = mesh.figure(results).axes[0]
                self.assertIn("t = 1$", axis.get_title())  # the last one that can be read
                self.assertEqual(results.unreadable, {"solution-00002.h5": reason})

    def test_pictures_without_a_damaged_solution(self):
        for kind in ("empty", "without nodes"):
            damage, reason = DAMAGES_OF_SOLUTIONS[kind]
            folder = self.results()
            damage(folder / "solution-00001.h5")
            age(folder)
            drawn = Drawn(folder, "--times", "0,1,2")
            self.assert_drawn(drawn, PICTURES, f"note: left out: solution-00001.h5 ({reason})")

    def test_many_damaged_solutions_make_one_note(self):
        for number in range(3, 12):
            (self.folder / f"solution-{number:05d}.h5").write_bytes(b"")
        (self.folder / "solution-00012.h5").write_text("no HDF5")
        age(self.folder)
        names = ", ".join(f"solution-{number:05d}.h5" for number in range(3, 8))
        self.assert_drawn(
            Drawn(self.folder),
            PICTURES,
            f"note: left out: {names} and 4 more (it is empty), solution-00012.h5 ({NOT_WHOLE})",
        )

    def test_without_any_readable_solution(self):
        for path in self.folder.glob("solution-*.h5"):
            cut(path, 0.5)
        age(self.folder)
        part = "no mesh.png (there is no solution-NNNNN.h5 that can be read in"
        self.assert_drawn(Drawn(self.folder), PICTURES[:2], part, NOT_WHOLE)

    def test_files_of_similar_names_are_none_of_the_results(self):
        (self.folder / "solution-copy.h5").write_text("mine")
        (self.folder / "solution-00001.h5.part").write_text("mine")
        self.assert_drawn(Drawn(self.folder), PICTURES)

    # The membrane.

    def test_without_a_readable_interface(self):
        for kind, (damage, reason) in DAMAGES.items():
            with self.subTest(kind):
                folder = self.results()
                damage(folder / "interface.h5")
                age(folder)
                results = Results(folder)
                with self.assertRaisesRegex(ResultsError, reason):
                    results.interface_times()
                with self.assertRaisesRegex(ResultsError, reason):
                    results.interface(0)
                with self.assertRaisesRegex(ResultsError, reason):
                    State(folder, 2.0)
        self.assert_drawn(
            Drawn(folder), ("timeseries.png", "mesh.png"), "note: no snapshots.png (", "interface.h5 cannot be read"
        )

    def test_an_interface_without_outputs(self):
        with h5py.File(self.folder / "interface.h5", "w") as file:
            file.attrs["schema_version"] = 1
        age(self.folder)
        self.assert_drawn(Drawn(self.folder), ("timeseries.png", "mesh.png"), "holds no output of the membrane yet")

    def test_a_damaged_output_of_the_membrane_is_left_out(self):
        for kind, damage in DAMAGES_OF_GROUPS.items():
            with self.subTest(kind):
                folder = self.results()
                with h5py.File(folder / "interface.h5", "r+") as file:
                    damage(file["step_00001"])
                age(folder)
                results = Results(folder)
                interfaces = read_chosen(results.interface_times(), lambda times: times, results.interface)
                self.assertEqual([interface.time for interface in interfaces], [0.0, 2.0])
                self.assertEqual(results.unreadable, {"step_00001 of interface.h5": NOT_WHOLE})
        with style.applied():
            titles = [axis.get_title() for axis in snapshots.figure(Results(folder)).axes]
        self.assertEqual(titles, ["$t = 0$", "$t = 2$", ""])  # the last axis is that of the colour bar
        self.assert_drawn(Drawn(folder), PICTURES, f"left out: step_00001 of interface.h5 ({NOT_WHOLE})")

    def test_values_of_the_membrane(self):
        results = Results(self.folder)
        with self.assertRaisesRegex(ResultsError, "holds no tension"):
            results.interface_values(0, ("composition", "tension"))
        with h5py.File(self.folder / "interface.h5", "r+") as file:
            file["step_00000/f"] = np.zeros(7)
        age(self.folder)
        with self.assertRaisesRegex(ResultsError, "step_00000 of .*interface.h5 cannot be read"):
            results.interface_values(0, ("f",))

    # statistics.csv.

    def test_a_row_that_is_being_written_does_not_count(self):
        path = self.folder / "statistics.csv"
        text = path.read_text()
        last = text.splitlines()[-1]
        for n_missing in (1, 2, 40, len(last) - 1, len(last)):
            path.write_text(text[:-n_missing] if n_missing > 1 else text[:-1])
            self.assertEqual(list(Results(self.folder).statistics().time), [0.0, 1.0])
        self.assert_drawn(Drawn(self.folder), PICTURES)

    def test_damaged_rows_are_left_out(self):
        path = self.folder / "statistics.csv"
        header, *rows = path.read_text().splitlines()
        n = header.count(",")
        for row in ("1.5,3", "1.5" + n * ",1" + ",1", "late" + n * ",1", "nan" + n * ",1", "\0" * 300, header, '"1.5'):
            with self.subTest(row[:20]):
                path.write_text("\n".join([header, rows[0], row, *rows[1:]]) + "\n")
                results = Results(self.folder)
                self.assertEqual(list(results.statistics().time), [0.0, 1.0, 2.0])
                self.assertEqual(results.unreadable, {"rows of statistics.csv": "1 damaged"})

    def test_text_and_what_is_no_number_make_gaps(self):
        path = self.folder / "statistics.csv"
        header, *rows = path.read_text().splitlines()
        n = header.count(",")
        odd = ("late", "-nan", "nan", "inf", "-inf", "", " ", "1e999", "0x12", "True", "1_0", "9" * 400)
        odd_rows = [f"{0.01 * number}" + n * f",{text}" for number, text in enumerate(odd)]
        for table in ([*odd_rows, *rows], [*rows, *odd_rows], *([row] for row in odd_rows)):
            path.write_text("\n".join([header, *table]) + "\n")
            statistics = Results(self.folder).statistics()
            self.assertEqual(len(statistics), len(table))
            self.assertTrue(all(kind.kind in "iuf" for kind in statistics.dtypes))
            with style.applied():
                figure = time_series.figure(statistics)
        self.assertTrue(np.all(np.isnan(statistics.arclength) | (statistics.arclength > 1e300)))
        with style.applied():
            style.save(figure, self.folder / "timeseries.png")

    def test_bytes_that_are_no_text(self):
        path = self.folder / "statistics.csv"
        path.write_bytes(path.read_bytes() + b"\xff\xfe\x80\n")
        self.assertEqual(len(Results(self.folder).statistics()), 3)

    def test_without_statistics_the_rest_is_drawn(self):
        path = self.folder / "statistics.csv"
        header = path.read_text().splitlines()[0]
        for text, part in (
            (None, "it is missing"),
            ("", "it is empty"),
            (header[:40], "its first line is not complete"),
            (header, "its first line is not complete"),
            (header + "\n", "has no rows yet"),
            (header + "\n0.5,1", "has no rows yet"),
            ("x,y\n1,2\n", "has no column time"),
            ("\0" * 100 + "\n", "has no column time"),
            ("\n\n", "it is empty"),
        ):
            with self.subTest(part):
                path.unlink(missing_ok=True)
                if text is not None:
                    path.write_text(text)
                with self.assertRaisesRegex(ResultsError, part):
                    Results(self.folder).statistics()
        path.unlink()
        parts = "note: no timeseries.png (", "statistics.csv cannot be read"
        self.assert_drawn(Drawn(self.folder), PICTURES[1:], *parts)

    # Everything.

    def test_if_nothing_can_be_drawn_it_is_an_error(self):
        for path in self.folder.iterdir():
            path.write_bytes(b"")
        age(self.folder)
        drawn = Drawn(self.folder)
        self.assertEqual((drawn.code, drawn.pictures, len(drawn.messages)), (1, (), 1), drawn.messages)
        self.assertTrue(drawn.messages[0].startswith("error: nothing can be drawn of"), drawn.messages)
        self.assertEqual([path for path in self.folder.iterdir() if path.suffix == ".png"], [])

    def test_a_directory_without_results(self):
        for path in self.folder.iterdir():
            path.unlink()
        (self.folder / "log.txt").write_text("of something else")
        drawn = Drawn(self.folder)
        self.assertEqual((drawn.code, len(drawn.messages)), (1, 1))
        self.assertIn("error: there is neither statistics.csv nor interface.h5 in", drawn.messages[0])
        self.assertIn("give the output directory of a run", drawn.messages[0])

    def test_a_directory_that_is_none(self):
        for path in (self.folder / "nowhere", self.folder / "statistics.csv", "a\0b"):
            drawn = Drawn(path)
            self.assertEqual((drawn.code, len(drawn.messages)), (1, 1))
            self.assertIn("error: there is no directory", drawn.messages[0])
        self.assertIn("cannot be read: File name too long", Drawn("x" * 300).messages[0])

    def test_whatever_is_left_of_the_files_only_results_errors_are_raised(self):
        random = np.random.default_rng(1)
        for name in ("interface.h5", "solution-00001.h5", "statistics.csv"):
            path = self.folder / name
            whole = path.read_bytes()
            for _ in range(40):
                place, kind = int(random.integers(len(whole))), random.integers(3)
                tail = {0: b"", 1: bytes(len(whole) - place), 2: random.bytes(8) + whole[place + 8 :]}[kind]
                path.write_bytes(whole[:place] + tail)
                age(self.folder)
                results = Results(self.folder)
                for read in (
                    results.statistics,
                    lambda: [results.interface(time) for time in results.interface_times()],
                    lambda: [results.solution(time) for time in results.solution_times()],
                    lambda: State(self.folder, 1.0),
                ):
                    try:
                        read()
                    except ResultsError as error:
                        self.assertNotEqual(str(error), "")
            path.write_bytes(whole)


class UnusualRuns(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def test_a_run_that_has_not_begun_to_step(self):
        write_small_results(self.folder, times=[0.0])
        drawn = Drawn(self.folder)
        self.assertEqual((drawn.code, drawn.pictures, drawn.messages), (0, PICTURES, []))

    def test_several_membranes(self):
        write_small_results(self.folder)
        with h5py.File(self.folder / "interface.h5", "r+") as file:
            for group in file.values():
                points, ring = 0.3 * group["points"][...], group["connectivity"][...]
                replace("points", np.concatenate([points - 0.5, points + 0.5]))(group)
                replace("composition", np.tile(group["composition"][...], 2))(group)
                replace("connectivity", np.concatenate([ring, ring + len(points)]))(group)
        age(self.folder)
        drawn = Drawn(self.folder)
        self.assertEqual((drawn.code, drawn.pictures, drawn.messages), (0, PICTURES, []))

    def test_a_membrane_that_has_vanished_leaves_a_gap(self):
        write_small_results(self.folder)
        with h5py.File(self.folder / "interface.h5", "r+") as file:
            group = file["step_00002"]
            replace("points", np.empty((0, 2)))(group)
            replace("composition", np.empty(0))(group)
            replace("connectivity", np.empty((0, 2), np.uint32))(group)
        age(self.folder)
        self.assertEqual(len(Results(self.folder).interface(2.0).points), 0)
        drawn = Drawn(self.folder)
        self.assertEqual((drawn.code, drawn.pictures), (0, PICTURES), drawn.messages)

    def test_three_dimensional_results(self):
        synthetic_results.write_statistics(self.folder / "statistics.csv", np.array([0.0, 1.0]))
        with h5py.File(self.folder / "interface.h5", "w") as file:
            group = file.create_group("step_00000")
            group.attrs["time"] = 0.0
            group["points"] = np.eye(3)
            group["composition"] = np.zeros(3)
            group["connectivity"] = np.empty((0, 2), np.uint32)
        with h5py.File(self.folder / "solution-00000.h5", "w") as file:
            file.attrs["time"] = 0.0
            file["nodes"] = np.eye(3)
        age(self.folder)
        drawn = Drawn(self.folder)
        self.assertEqual((drawn.code, drawn.pictures), (0, PICTURES[:1]), drawn.messages)
        self.assertEqual(drawn.messages[0].count("is three-dimensional: use ParaView"), 2, drawn.messages)


if __name__ == "__main__":
    unittest.main()
