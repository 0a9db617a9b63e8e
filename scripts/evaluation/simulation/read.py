# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads back the scan logs that `write` makes, and converted logs of one laser whose header never changes."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from evaluation.common.poses import Array


@dataclass(frozen=True)
class ScanLog:
    """`ranges` `[p, s, beams]` [m], NaN = no return; `map_from_robot` `[p, 3]` or None without references."""

    timestamps_s: Array
    map_from_robot: Array | None
    nominal_headings_rad: Array
    beam_angles_rad: Array
    max_range_m: float
    ranges: Array


LISTS = ("angles", "times", "ranges", "intensities", "mount")
FIXED = ("first_angle", "angle_step", "last_angle", "max_range", "min_range", "angles")  # for all scans of a sensor
LENGTHS_M = {"m": 1.0}
ANGLES_RAD = {"deg": np.pi / 180.0, "rad": 1.0}


def _words_by_key(fields: list[str]) -> dict[str, list[str]]:
    """The words after each key: one, or of a list all up to the next key."""
    found: dict[str, list[str]] = {}
    position = 0
    while position < len(fields):
        key, end = fields[position], position + 2
        if key in LISTS:
            end = next((at for at in range(position + 1, len(fields)) if _is_key(fields[at])), len(fields))
        elif end > len(fields):
            raise ValueError(f"'{key}' without a value")
        found[key] = fields[position + 1 : end]
        position = end
    return found


def _is_key(word: str) -> bool:
    return word[0].isalpha() and word not in ("nan", "inf")


def _reading(text: str, sensor: dict[str, float]) -> float:
    value = float("nan") if text == "-" else float(text)
    maximum = sensor.get("max_range", 0.0)
    is_near = value < maximum if np.isfinite(maximum) and maximum > 0.0 else np.isfinite(value)
    return value if is_near and value > 0.0 and value >= sensor.get("min_range", 0.0) else float("nan")


@dataclass
class _Draft:
    """What the statements so far say."""

    rad: float = ANGLES_RAD["deg"]  # the unit of angles
    sensor: dict[str, float] = field(default_factory=dict)
    times: list[float] = field(default_factory=list)
    references: list[list[float]] = field(default_factory=list)
    headings: list[list[float]] = field(default_factory=list)
    ranges: list[list[list[float]]] = field(default_factory=list)

    def add(self, fields: list[str]) -> None:
        """One statement. Raises ValueError, IndexError or KeyError."""
        if fields[0] == "units":
            if len(fields) != 3 or fields[1] not in LENGTHS_M or fields[2] not in ANGLES_RAD:
                raise ValueError(f"expected units m deg or m rad, found {' '.join(fields[1:])}")
            self.rad = ANGLES_RAD[fields[2]]
        elif fields[0] == "sensor":
            if self.sensor:
                raise ValueError("a second sensor")
            self.sensor = {key: float(words[0]) for key, words in _words_by_key(fields[2:]).items() if words != ["any"]}
        elif fields[0] == "position":
            self.times.append(float(fields[1]))
            self.headings.append([])
            self.ranges.append([])
            if len(fields) > 2:
                self.references.append(_reference(fields[2:], self.rad))
        elif fields[0] == "scan":
            self._add_scan(_words_by_key(fields[2:]))

    def _add_scan(self, words: dict[str, list[str]]) -> None:
        if changed := [key for key in FIXED if key in words]:
            raise ValueError(f"a scan with its own {changed[0]}")
        self.headings[-1].append(float(words["heading"][0]) * self.rad)
        self.ranges[-1].append([_reading(text, self.sensor) for text in words["ranges"]])


def _reference(fields: list[str], rad: float) -> list[float]:
    if len(fields) != 4 or fields[0] != "reference":
        raise ValueError(f"expected reference x y heading, found {' '.join(fields)}")
    pose = [float(fields[1]), float(fields[2]), float(fields[3]) * rad]
    if not np.isfinite(pose).all():
        raise ValueError(f"reference pose {' '.join(fields[1:])} is not finite")
    return pose


def read_scan_log(path: Path) -> ScanLog:
    """Raises ValueError for anything but a log in metres with one sensor and equally built positions."""
    lines = [line.split("#")[0].split() for line in path.read_text(encoding="utf-8").splitlines()]
    statements = [(number, fields) for number, fields in enumerate(lines, 1) if fields]
    if not statements or statements[0][1] not in (["shapemap-scans", "1"], ["shapemap-scans", "2"]):
        raise ValueError(f"{path}: not a shapemap scan log, version 1 or 2")
    draft = _Draft()
    for number, fields in statements[1:]:
        try:
            draft.add(fields)
        except (ValueError, IndexError, KeyError) as error:
            raise ValueError(f"{path}:{number}: {error}") from None
    sensor = draft.sensor
    counts = {len(ranges) for position in draft.ranges for ranges in position}
    if len(counts) != 1:
        raise ValueError(f"{path}: expected scans with as many beams each, found {sorted(counts)}")
    steps = np.arange(counts.pop(), dtype=np.float64)
    angles: Array = draft.rad * (sensor.get("first_angle", 0.0) + sensor["angle_step"] * steps)
    return ScanLog(
        np.array(draft.times),
        np.array(draft.references) if len(draft.references) == len(draft.times) else None,
        np.array(draft.headings),
        angles,
        sensor.get("max_range", float("inf")),
        np.array(draft.ranges),
    )
