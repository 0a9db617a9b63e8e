# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads back the scan logs that `write` makes (one sensor, metres and degrees)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .poses import Array


@dataclass(frozen=True)
class ScanLog:
    """`ranges` `[p, s, beams]` [m], NaN = no return; `map_from_robot` `[p, 3]` or None without references."""

    timestamps_s: Array
    map_from_robot: Array | None
    nominal_headings_rad: Array
    beam_angles_rad: Array
    max_range_m: float
    ranges: Array


def _options_of(fields: list[str]) -> dict[str, float]:
    return {key: float(value) for key, value in zip(fields[::2], fields[1::2])}


def _reading(text: str, max_range_m: float) -> float:
    value = float("nan") if text == "-" else float(text)
    return value if 0.0 < value < max_range_m else float("nan")


def read_scan_log(path: Path) -> ScanLog:
    """Raises ValueError for anything but a version 1 log in metres and degrees with equally built positions."""
    lines = [line.split("#")[0].split() for line in path.read_text(encoding="utf-8").splitlines()]
    lines = [fields for fields in lines if fields]
    if not lines or lines[0] != ["shapemap-scans", "1"]:
        raise ValueError(f"{path}: not a shapemap scan log, version 1")
    sensor: dict[str, float] = {}
    times: list[float] = []
    references: list[list[float]] = []
    headings: list[list[float]] = []
    ranges: list[list[list[float]]] = []
    for fields in lines[1:]:
        if fields[0] == "units" and fields[1:] != ["m", "deg"]:
            raise ValueError(f"{path}: expected units m deg, found {' '.join(fields[1:])}")
        if fields[0] == "sensor":
            sensor = _options_of(fields[2:])
        elif fields[0] == "position":
            times.append(float(fields[1]))
            headings.append([])
            ranges.append([])
            if len(fields) == 6 and fields[2] == "reference":
                references.append([float(fields[3]), float(fields[4]), float(np.deg2rad(float(fields[5])))])
        elif fields[0] == "scan":
            headings[-1].append(float(np.deg2rad(float(fields[3]))))
            ranges[-1].append([_reading(text, sensor["max_range"]) for text in fields[5:]])
    angles = np.deg2rad(sensor["first_angle"] + sensor["angle_step"] * np.arange(int(sensor["beams"])))
    return ScanLog(
        np.array(times),
        np.array(references) if len(references) == len(times) else None,
        np.array(headings),
        angles,
        sensor["max_range"],
        np.array(ranges),
    )
