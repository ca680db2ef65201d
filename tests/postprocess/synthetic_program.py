# SPDX-License-Identifier: LGPL-2.1-or-later
"""A program that behaves like gemmule: its errors and its costs are known functions of its parameters."""

import stat
import sys
from pathlib import Path

# A circle whose radius, position and f have errors h^3, h^2 and h^4, h = 2^-level, level being that of the membrane. An
# adaptive mesh has 100 2^level unknowns of the flow, a uniform one 10 4^level.
PROGRAM = '''#!{python}
import sys
from pathlib import Path
sys.path.insert(0, {folder!r})
import h5py
import numpy as np
import pandas as pd
import synthetic_results

arguments = sys.argv[2:]
values = {{"Output directory": "", "End time": "1", "Output/Output times": "", "Fluid/Viscosity ratio": "1", "Mesh/Bulk level": "2",
           "Mesh/Membrane level": "3", "Mesh/Phase boundary level": "3", "Mesh/Finest level": "4",
           "Mesh/Curvature tolerance": "0.5", "Mesh/Cells per gap": "4", "Mesh/Cells per phase boundary": "0"}}
while "--set" in arguments:
    place = arguments.index("--set")
    key, _, value = arguments[place + 1].partition("=")
    if key not in values:
        sys.exit("error: unknown parameter " + key)
    values[key] = value
    del arguments[place : place + 2]
values["Output directory"] = arguments[arguments.index("--output") + 1]
text = "# made up\\n"
for key, value in values.items():
    section, _, name = key.rpartition("/")
    if section:
        text += f"subsection {{section}}\\n  set {{name}} = {{value}} # default: 1\\nend\\n"
    else:
        text += f"set {{name}} = {{value}}\\n"
if "--print-parameters" in arguments:
    print(text)
    sys.exit()
folder = Path(values["Output directory"])
with open(folder.parent / "count", "a") as count:
    count.write("x")
time, level = float(values["End time"]), int(values["Mesh/Membrane level"])
is_uniform = values["Mesh/Bulk level"] == values["Mesh/Membrane level"]
h = 2.0**-level
(folder / "parameters.prm").write_text(text)
table = pd.DataFrame(0.0, index=range(2), columns=synthetic_results.COLUMNS)
table["time"] = [0.0, time]
table["step"] = [0, 10 * level]
table["cells"] = 4**level
table["flow_dofs"] = 10 * 4**level if is_uniform else 100 * 2**level
table["centroid_x"] = 0.1 + 0.5 * h**2
table["arclength"] = 2 * np.pi * (0.4 + h**3)
table["energy_total"] = 1.0
table["curvature_max"] = 2.5 + h
table.to_csv(folder / "statistics.csv", index=False)
n = 200 + 20 * level
angle = 2 * np.pi * np.arange(n) / n
with h5py.File(folder / "interface.h5", "w") as file:
    group = file.create_group("step_00000")
    group.attrs["time"] = time
    group["points"] = (0.4 + h**3) * np.column_stack([np.cos(angle), np.sin(angle)])
    group["composition"] = group["f"] = (1 + 10 * h**4) * np.cos(angle)
    group["f_total"] = np.ones(n)
    group["connectivity"] = np.column_stack([np.arange(n), (np.arange(n) + 1) % n]).astype(np.uint32)
(folder / "log.txt").write_text(f"finished: t = 1, 9 steps, 0 rejected, {{0.5 * level}} s CPU (7 s wall clock)\\n")
'''


def write(path):
    """Write it, executable."""
    path.write_text(PROGRAM.format(python=sys.executable, folder=str(Path(__file__).parent)))
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path
