# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of a run: the scan log as text, its reference trajectory and the truth about every sub-scan."""

from __future__ import annotations

import json

import numpy as np

from evaluation.common.poses import Array
from evaluation.common.tum import tum_line

from .sensor import SensorOptions
from .simulation import Simulation

SENSOR_NAME = "laser"


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
