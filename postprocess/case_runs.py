# SPDX-License-Identifier: LGPL-2.1-or-later
"""Running a case with different parameters, each run in a directory of its own, and keeping what has been run."""

import os
import re
import subprocess
import sys
from pathlib import Path

from postprocess.file_reading import read_text
from postprocess.results import Results, ResultsError

SAME_TIME = 1e-9


def varied(executable, case, settings, key, value, end_time, directory):
    """The run with one parameter set to a value."""
    name = f"{key.split('/')[-1]}={value}"
    return Run(executable, case, [*settings, f"{key}={value}"], f"{key} = {value}", name, end_time, directory)


class Run:
    """One run of a case: what is set, what it is called in messages and as a directory, where its results are."""

    def __init__(self, executable, case, settings, title, name, end_time, directory):
        self.title, self.end_time = title, end_time
        self.directory = Path(directory) / re.sub(r"[^A-Za-z0-9.+-]+", "_", name)
        # The later setting wins, also the end that the comparison needs; the program takes each only once.
        chosen = {}
        # Times of a case for which the comparison may end too early.
        for setting in ["Output/Output times=", *settings, f"End time={end_time!r}"]:
            key, _, value = setting.partition("=")
            chosen[key.strip()] = value
        self.command = [str(executable), str(case)]
        for key, value in chosen.items():
            self.command += ["--set", f"{key}={value}"]
        self.command += ["--output", str(self.directory)]

    def is_finished(self):
        """Do results with just these parameters exist, up to the end?"""
        try:
            written = entries(read_text(self.directory / "parameters.prm"))
        except ResultsError:
            return False
        if written != self.parameters():
            return False
        try:
            results = Results(self.directory)
            last_times = results.statistics().time.iloc[-1], results.interface_times()[-1]
        except ResultsError:
            return False
        return all(abs(time - self.end_time) <= SAME_TIME * max(1.0, self.end_time) for time in last_times)

    def parameters(self):
        """All parameters of the run, section/key -> value, as the program understands them."""
        return entries(self._output("--print-parameters"))

    def start(self):
        """Compute it, on one core; the output of the program goes to run.log."""
        self.directory.mkdir(parents=True, exist_ok=True)
        threads = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "DEAL_II_NUM_THREADS")}
        with open(self.directory / "run.log", "w") as log:
            finished = subprocess.run(
                self.command, stdout=log, stderr=subprocess.STDOUT, env={**os.environ, **threads}
            )
        if finished.returncode != 0:
            tail = read_text(self.directory / "run.log").strip().splitlines()[-3:]
            raise ResultsError(
                f"the run with {self.title} ended with code {finished.returncode}: "
                + " / ".join(tail)
                + f" (all of it: {self.directory / 'run.log'})"
            )

    def complete(self, fresh=False):
        """Compute it unless that has been done, or again if `fresh`."""
        if not fresh and self.is_finished():
            print(f"{self.title}: using {self.directory}", file=sys.stderr, flush=True)
            return
        print(f"{self.title}: computing", file=sys.stderr, flush=True)
        self.start()

    def _output(self, option):
        finished = subprocess.run([*self.command, option], capture_output=True, text=True)
        if finished.returncode != 0:
            raise ResultsError(finished.stderr.strip() or f"{self.command[0]} {option} failed")
        return finished.stdout


def entries(text):
    """Section/key -> value of a parameter file, without its comments. What makes no sense there is passed over."""
    result, sections = {}, []
    for line in text.splitlines():
        words = line.split("#")[0].split(maxsplit=1)
        if not words:
            continue
        if words[0] == "subsection":
            sections.append(words[-1].strip())
        elif words[0] == "end":
            del sections[-1:]
        elif words[0] == "set" and len(words) > 1:
            name, _, value = words[1].partition("=")
            result["/".join([*sections, name.strip()])] = value.strip()
    return result
