# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of a run: the scan log as text, its reference trajectory and the truth about every sub-scan."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .poses import Array
from .sensor import SensorOptions
from .simulation import Simulation

SENSOR_NAME = "laser"


def write_whole(path: Path, text: str) -> None:
    """The file appears whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{os.getpid()}.part")
    partial.write_text(text, encoding="utf-8")
    partial.replace(path)


def without_nan(fields: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers of nothing become null: JSON has no NaN."""
    return {key: None if isinstance(value, float) and np.isnan(value) else value for key, value in fields.items()}


def range_text(range_m: float) -> str:
    return f"{range_m:.3f}" if np.isfinite(range_m) else "-"


def sensor_line(sensor: SensorOptions) -> str:
    return (
        f"sensor {SENSOR_NAME} beams {sensor.num_beams} first_angle {sensor.first_angle_deg:g} "
        f"angle_step {sensor.angle_step_deg:g} max_range {sensor.max_range_m:g}"
    )


def nist_text(simulation: Simulation, title: str = "simulated rescue arena") -> str:
    """The run as a scan log, version 1."""
    run = simulation.drive
    lines = [
        "shapemap-scans 1",
        f"# {title}, seed {simulation.options.seed}",
        "units m deg",
        sensor_line(simulation.options.sensor),
    ]
    for time, pose, scans in zip(run.timestamps_s, run.map_from_robot, simulation.ranges):
        lines.append(f"position {time:.3f} reference {pose[0]:.6f} {pose[1]:.6f} {np.rad2deg(pose[2]):.6f}")
        for heading, ranges in zip(run.nominal_headings_rad, scans):
            readings = " ".join(range_text(r) for r in ranges)
            lines.append(f"scan {SENSOR_NAME} heading {np.rad2deg(heading):g} ranges {readings}")
    return "\n".join(lines) + "\n"


def tum_line(timestamp_s: float, pose: Array) -> str:
    """`t x y z qx qy qz qw` and a line end."""
    x, y, theta = pose
    return f"{timestamp_s:.3f} {x:.9f} {y:.9f} 0 0 0 {np.sin(theta / 2):.12f} {np.cos(theta / 2):.12f}\n"


def tum_text(simulation: Simulation) -> str:
    """The reference poses as TUM lines."""
    return "".join(map(tum_line, simulation.drive.timestamps_s, simulation.drive.map_from_robot))


def pose_dict(pose: Array) -> dict[str, float]:
    return {"x_m": float(pose[0]), "y_m": float(pose[1]), "theta_deg": float(np.rad2deg(pose[2]))}


def truth_text(simulation: Simulation, overlaps: Array) -> str:
    """Exact poses in the map of every position and of every sub-scan, as JSON."""
    run, positions = simulation.drive, []
    for k, time in enumerate(run.timestamps_s):
        sub_scans = [
            {
                "nominal_heading_deg": float(np.rad2deg(heading)),
                "map_from_sub_scan": pose_dict(pose),
                "gradient": [float(g) for g in gradient],
            }
            for heading, pose, gradient in zip(run.nominal_headings_rad, run.map_from_sub_scan[k], run.gradient[k])
        ]
        positions.append(
            {
                "timestamp_s": float(time),
                "map_from_robot": pose_dict(run.map_from_robot[k]),
                "overlap_with_previous": float(overlaps[k - 1]) if k else None,
                "sub_scans": sub_scans,
            }
        )
    return json.dumps({"seed": simulation.options.seed, "positions": positions}, indent=1) + "\n"
