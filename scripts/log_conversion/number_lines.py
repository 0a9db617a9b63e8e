# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs that are lines of numbers: tinySLAM's, and those of a pose and ranges."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from .model import Array, LaserLog, LaserScan, UnknownLogError, counted, single_laser

NAME = "laser"
TINY_HEADER = 25  # time, battery, ticks, speeds, sonars and so on, before the ranges
TINY_BEAMS = 682
TINY_STEP_RAD = 2.0 * np.pi / 1024.0
TINY_RANGES_M = 0.02, 5.6  # below are error codes
POSE_FIELDS = 3


@dataclass(frozen=True)
class PoseLineOptions:
    """What lines of a pose and ranges do not say."""

    angle_step_deg: float | None = None
    max_range_m: float = 5.0
    min_range_m: float = 0.1


def number_log(text: str, options: PoseLineOptions) -> LaserLog:
    """Raises UnknownLogError."""
    rows, num_others = read_rows(text)
    if len(rows[0]) == TINY_HEADER + TINY_BEAMS:
        log = tiny_slam(np.array(rows))
    elif options.angle_step_deg is None:
        raise UnknownLogError(f"lines of {len(rows[0])} numbers; a pose and ranges need --angle-step-deg")
    elif len(rows[0]) <= POSE_FIELDS:
        raise UnknownLogError(f"lines of {len(rows[0])} numbers; expected a pose of three and ranges")
    else:
        log = poses_and_ranges(np.array(rows), options, options.angle_step_deg)
    if num_others:
        log.notes.append(f"left out {counted(num_others, 'line')} that are not like the others")
    return log


def read_rows(text: str) -> tuple[list[list[float]], int]:
    """Lines of numbers with as many fields as most of them, and how many other lines there are."""
    try:
        rows = [[float(field) for field in line.split()] for line in text.splitlines() if line.strip()]
    except ValueError:
        raise UnknownLogError("neither a ROS bag, nor a table, nor lines of numbers") from None
    if not rows:
        raise UnknownLogError("empty")
    (length, _), *_ = Counter(len(row) for row in rows).most_common(1)
    whole = [row for row in rows if len(row) == length]
    return whole, len(rows) - len(whole)


def symmetric_scans(
    times_ns: Array, ranges_m: Array, step_rad: float, limits_m: tuple[float, float]
) -> list[LaserScan]:
    """Of a laser with beams to both sides of straight ahead, from right to left where the step is positive."""
    first = -0.5 * step_rad * (ranges_m.shape[1] - 1)
    return [
        LaserScan(
            stamp_ns=round(float(time)),
            received_ns=0,
            ranges_m=ranges,
            first_angle_rad=first,
            angle_step_rad=step_rad,
            min_range_m=limits_m[0],
            max_range_m=limits_m[1],
        )
        for time, ranges in zip(times_ns, ranges_m)
    ]


def tiny_slam(rows: Array) -> LaserLog:
    """Time in microseconds, wheel ticks and more, which are not used, and the 682 steps of a Hokuyo URG-04LX in
    millimetres, 1024 to a full turn."""
    times_ns = 1e3 * (rows[:, 0] - rows[0, 0])
    scans = symmetric_scans(times_ns, 1e-3 * rows[:, TINY_HEADER:], TINY_STEP_RAD, TINY_RANGES_M)
    return single_laser(NAME, scans)


def poses_and_ranges(rows: Array, options: PoseLineOptions, angle_step_deg: float) -> LaserLog:
    """Lines of x, y [mm], heading [rad] and ranges [mm]; without times, one a second. The poses become references."""
    times_ns = 1e9 * np.arange(len(rows))
    limits = options.min_range_m, options.max_range_m
    ranges = 1e-3 * rows[:, POSE_FIELDS:]
    log = single_laser(NAME, symmetric_scans(times_ns, ranges, float(np.deg2rad(angle_step_deg)), limits))
    log.references = rows[:, :POSE_FIELDS] * np.array([1e-3, 1e-3, 1.0])
    return log
