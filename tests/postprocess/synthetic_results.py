# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results as a run would leave them, of a made-up vesicle: an ellipse that relaxes and drifts."""

from pathlib import Path

import h5py
import numpy as np
import pandas as pd

COLUMNS = """time,step,time_step_size,cells,flow_dofs,surface_dofs,centroid_x,centroid_y,area,arclength,mass_f,
mass_total,energy_surface,energy_phase,energy_constraint,energy_bending,energy_total,dissipation_viscous,
dissipation_phase,max_velocity,tension_min,tension_max,f_total_min,f_total_max,composition_min,composition_max,
phase_boundaries,components,curvature_max,deformation,area_correction,linear_iterations,wall_time""".replace(
    "\n", ""
).split(
    ","
)
BOX = 1.0


def shape(time):
    """Centre and half axes of the ellipse."""
    stretch = 0.2 * np.exp(-time / 4)
    return 0.02 * time, 0.42 * np.exp(stretch), 0.42 * np.exp(-stretch)


def composition(angle, time):
    separated = 0.5 * (1 + np.tanh(np.sin(2 * angle) / 0.15))
    mixed = 0.5 + 0.01 * np.sin(4 * angle)
    weight = 1 - np.exp(-time)
    return weight * separated + (1 - weight) * mixed


def write_statistics(path, times):
    table = pd.DataFrame(0.0, index=range(len(times)), columns=COLUMNS)
    table["time"] = times
    table["step"] = np.arange(len(times))
    table["time_step_size"] = np.concatenate([[0.0], np.diff(times)])
    table["centroid_x"] = [shape(time)[0] for time in times]
    table["centroid_y"] = 0.001 * np.sin(times)
    table["area"] = np.pi * 0.42**2 * (1 + 1e-14 * np.sin(40 * times))
    table["arclength"] = 2.6 + 0.1 * np.exp(-times)
    table["mass_f"] = 1.3 * (1 + 2e-16 * np.arange(len(times)))
    table["mass_total"] = 2.6
    table["energy_surface"] = 2.3 + 0.1 * np.exp(-times)
    table["energy_phase"] = 0.03 + 0.04 * np.exp(-3 * times)
    table["energy_constraint"] = 0.01 * np.exp(-2 * times)
    table["energy_total"] = table.energy_surface + table.energy_phase + table.energy_constraint
    table["phase_boundaries"] = np.where(times < 0.5, 8, 4)
    table.to_csv(path, index=False)


def write_interface(path, times, n=400):
    angle = 2 * np.pi * np.arange(n) / n
    with h5py.File(path, "w") as file:
        for number, time in enumerate(times):
            centre, a, b = shape(time)
            points = np.column_stack([centre + a * np.cos(angle), b * np.sin(angle)])
            group = file.create_group(f"step_{number:05d}")
            group.attrs["time"] = time
            group["points"] = points
            group["composition"] = composition(angle, time)
            group["connectivity"] = np.column_stack([np.arange(n), (np.arange(n) + 1) % n]).astype(np.uint32)


def write_solution(path, time, levels=(16, 64)):
    """Cells of two sizes, fine near the membrane; vertices are not shared, their order is cyclic."""
    centre, a, b = shape(time)
    corners = []
    for level, fine in zip(levels, (False, True)):
        h = 2 * BOX / level
        coarse = 2 * BOX / levels[0]
        for i in range(level):
            for j in range(level):
                x, y = -BOX + i * h, -BOX + j * h
                parent = np.floor((np.array([x, y]) + BOX + 1e-9) / coarse + 0.0) * coarse - BOX + coarse / 2
                radius = np.hypot((parent[0] - centre) / a, parent[1] / b)
                if (abs(radius - 1) < 0.3) == fine:
                    corners.append([[x, y], [x + h, y], [x + h, y + h], [x, y + h]])
    nodes = np.array(corners).reshape(-1, 2)
    x, y = nodes.T
    # Of the stream function (1 - x^2)^2 (1 - y^2)^2 x y: no flow through the walls.
    fx, fy = (1 - x**2) ** 2 * x, (1 - y**2) ** 2 * y
    dfx = (1 - x**2) ** 2 - 4 * x**2 * (1 - x**2)
    dfy = (1 - y**2) ** 2 - 4 * y**2 * (1 - y**2)
    with h5py.File(path, "w") as file:
        file.attrs["time"] = time
        file["nodes"] = nodes
        file["cells"] = np.arange(len(nodes), dtype=np.uint32).reshape(-1, 4)
        file["velocity"] = np.column_stack([fx * dfy, -dfx * fy, np.zeros_like(x)])
        file["pressure"] = x[:, None]


def write(directory, end_time=10.0):
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    write_statistics(directory / "statistics.csv", np.geomspace(0.01, end_time + 0.01, 300) - 0.01)
    write_interface(directory / "interface.h5", np.linspace(0, end_time, 21))
    for number, time in enumerate(np.linspace(0, end_time, 6)):
        write_solution(directory / f"solution-{number:05d}.h5", time)
