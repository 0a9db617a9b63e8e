# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads back the scan logs that `write` makes (one sensor, metres and degrees)."""

from __future__ import annotations

from dataclasses import dataclass, field
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


@dataclass
class _Draft:
    """What the statements so far say."""

    sensor: dict[str, float] = field(default_factory=dict)
    times: list[float] = field(default_factory=list)
    references: list[list[float]] = field(default_factory=list)
    headings: list[list[float]] = field(default_factory=list)
    ranges: list[list[list[float]]] = field(default_factory=list)

    def add(self, fields: list[str]) -> None:
        """One statement. Raises ValueError, IndexError or KeyError."""
        if fields[0] == "units" and fields[1:] != ["m", "deg"]:
            raise ValueError(f"expected units m deg, found {' '.join(fields[1:])}")
        if fields[0] == "sensor":
            self.sensor = _options_of(fields[2:])
        elif fields[0] == "position":
            self.times.append(float(fields[1]))
            self.headings.append([])
            self.ranges.append([])
            if len(fields) > 2:
                self.references.append(_reference(fields[2:]))
        elif fields[0] == "scan":
            self.headings[-1].append(float(np.deg2rad(float(fields[3]))))
            self.ranges[-1].append([_reading(text, self.sensor["max_range"]) for text in fields[5:]])


def _reference(fields: list[str]) -> list[float]:
    if len(fields) != 4 or fields[0] != "reference":
        raise ValueError(f"expected reference x y heading, found {' '.join(fields)}")
    pose = [float(fields[1]), float(fields[2]), float(np.deg2rad(float(fields[3])))]
    if not np.isfinite(pose).all():
        raise ValueError(f"reference pose {' '.join(fields[1:])} is not finite")
    return pose


def read_scan_log(path: Path) -> ScanLog:
    """Raises ValueError for anything but a version 1 log in metres and degrees with equally built positions."""
    lines = [line.split("#")[0].split() for line in path.read_text(encoding="utf-8").splitlines()]
    statements = [(number, fields) for number, fields in enumerate(lines, 1) if fields]
    if not statements or statements[0][1] != ["shapemap-scans", "1"]:
        raise ValueError(f"{path}: not a shapemap scan log, version 1")
    draft = _Draft()
    for number, fields in statements[1:]:
        try:
            draft.add(fields)
        except (ValueError, IndexError, KeyError) as error:
            raise ValueError(f"{path}:{number}: {error}") from None
    sensor = draft.sensor
    angles = np.deg2rad(sensor["first_angle"] + sensor["angle_step"] * np.arange(int(sensor["beams"])))
    return ScanLog(
        np.array(draft.times),
        np.array(draft.references) if len(draft.references) == len(draft.times) else None,
        np.array(draft.headings),
        angles,
        sensor["max_range"],
        np.array(draft.ranges),
    )


def read_tum(path: Path) -> list[tuple[float, Array]]:
    """Time [s] and planar pose `[3]` of each line of a trajectory in TUM's format."""
    poses = []
    for line in path.read_text(encoding="utf-8").splitlines():
        fields = line.split("#")[0].split()
        if not fields:
            continue
        time, x, y, _, _, _, qz, qw = map(float, fields)
        poses.append((time, np.array([x, y, 2.0 * np.arctan2(qz, qw)])))
    return poses
