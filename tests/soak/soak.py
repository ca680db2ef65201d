#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run a case for thousands of steps and watch memory, area and masses.

    soak.py EXECUTABLE [CASE.prm] [--steps 5000] [--output DIR] [--set "Section/Key=value"]...

The default is parameters/paper/constrained_elongated_ellipse.prm on a coarse mesh with steps of fixed size. The
resident memory of the program (VmRSS) is read several times a second and assigned to the step the program has
reached; it may not grow after the warm-up. Enclosed area and both masses may not leave their initial
values by more than round-off. A table of the figures is printed, memory.csv is written next to the results; the
exit code is 0 when everything holds.
"""

import argparse
import csv
import math
import os
import pathlib
import subprocess
import sys
import time

TOP = pathlib.Path(__file__).resolve().parents[2]
COARSE = ["Mesh/Membrane level=4", "Mesh/Phase boundary level=4", "Time stepping/Adaptive=false",
          "Output/Progress line=false"]


def resident_kilobytes(pid):
    """VmRSS of a process, or None when it is gone."""
    try:
        for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
            if line.startswith("VmRSS:"):
                return int(line.split()[1])
    except (FileNotFoundError, ProcessLookupError):
        pass
    return None


def count_lines(stream, state):
    """Complete lines of a growing file; state is the number seen so far."""
    while block := stream.read(1 << 20):
        state += block.count(b"\n")
    return state


def run(command, statistics, log):
    """Run the program; list of (step, kilobytes) and its exit code."""
    samples = []
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", DEAL_II_NUM_THREADS="1")
    with open(log, "w") as out:
        process = subprocess.Popen(command, stdout=out, stderr=subprocess.STDOUT, env=environment)
        stream, lines = None, 0
        while process.poll() is None:
            # the program replaces an earlier file, so it is opened only when the run has begun to write its own
            if stream is None and statistics.exists():
                stream = open(statistics, "rb")
            if stream is not None:
                lines = count_lines(stream, lines)
            kilobytes = resident_kilobytes(process.pid)
            if kilobytes is not None and lines > 1:
                samples.append((lines - 2, kilobytes))
            time.sleep(0.2)
        if stream is not None:
            stream.close()
    return samples, process.returncode


def largest_drift(rows, name):
    """Largest relative deviation of a column from its first value; infinite where a value is not a number."""
    first = float(rows[0][name])
    deviations = [abs(float(row[name]) - first) for row in rows]
    return max(d if math.isfinite(d) else math.inf for d in deviations) / abs(first)


def slope(samples):
    """Least-squares growth in kilobytes per 1000 steps."""
    n = len(samples)
    mean_step = sum(s for s, _ in samples) / n
    mean_kilobytes = sum(k for _, k in samples) / n
    variance = sum((s - mean_step) ** 2 for s, _ in samples)
    if variance == 0:
        return 0.0
    return 1000 * sum((s - mean_step) * (k - mean_kilobytes) for s, k in samples) / variance


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("executable")
    parser.add_argument("case", nargs="?", default=str(TOP / "parameters/paper/constrained_elongated_ellipse.prm"))
    parser.add_argument("--steps", type=int, default=5000)
    parser.add_argument("--step-size", type=float, default=0.0003)
    parser.add_argument("--output", default="results/soak")
    parser.add_argument("--set", action="append", default=[], help="as for gemmule; replaces a setting of ours")
    parser.add_argument("--growth", type=float, default=3.0,
                        help="largest growth of the memory after the warm-up, in per cent")
    parser.add_argument("--drift", type=float, default=1e-10, help="largest relative drift of area and masses")
    arguments = parser.parse_args()

    settings = dict(s.split("=", 1) for s in COARSE)
    settings["End time"] = repr(arguments.steps * arguments.step_size)
    settings["Time stepping/Initial time step"] = repr(arguments.step_size)
    settings.update(s.split("=", 1) for s in arguments.set)
    output = pathlib.Path(arguments.output)
    output.mkdir(parents=True, exist_ok=True)
    statistics = output / "statistics.csv"
    statistics.unlink(missing_ok=True)
    command = [arguments.executable, arguments.case, "--output", str(output)]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]

    samples, code = run(command, statistics, output / "screen.txt")
    if not statistics.exists() or code not in (0, 2):
        print((output / "screen.txt").read_text(), file=sys.stderr)
        return 1
    with open(statistics) as stream:
        rows = list(csv.DictReader(stream))
    with open(output / "memory.csv", "w") as stream:
        stream.write("step,resident_kilobytes\n")
        stream.writelines(f"{step},{kilobytes}\n" for step, kilobytes in samples)

    n_steps = int(rows[-1]["step"])
    if code != 0 or n_steps < arguments.steps * 0.9:
        print((output / "screen.txt").read_text().splitlines()[-1])
        print(f"FAILED: the run ended after {n_steps} steps with exit code {code}")
        return 1

    # The warm-up: until the mesh, the factorisation and the allocator's pools have had their largest size.
    warm = [s for s in samples if s[0] > 0.2 * n_steps]
    halves = [[k for s, k in samples if 0.2 * n_steps < s <= 0.6 * n_steps],
              [k for s, k in samples if s > 0.6 * n_steps]]
    means = [sum(half) / len(half) for half in halves]
    growth = 100 * (means[1] / means[0] - 1)
    print("  step   resident memory (MB)")
    for tenth in range(11):
        step, kilobytes = min(samples, key=lambda s: abs(s[0] - tenth * n_steps / 10))
        print(f"{step:6d}   {kilobytes / 1024:.1f}")
    print(f"growth from steps 20-60 % to 60-100 %: {growth:+.2f} % of {means[0] / 1024:.1f} MB; "
          f"trend {slope(warm) / 1024:+.3f} MB per 1000 steps")
    failed = growth > arguments.growth
    for name in ("area", "mass_f", "mass_total"):
        if float(rows[0][name]) != 0:
            drift = largest_drift(rows, name)
            failed = failed or not drift <= arguments.drift
            print(f"largest relative drift of {name}: {drift:.2e}")
    print(f"{'FAILED' if failed else 'passed'}: {n_steps} steps to t = {float(rows[-1]['time']):g}")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
