# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of points, one a line, in the order in which they were measured."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .model import Array, LaserLog, LaserScan, UnknownLogError, no_values
from .tables import checked_log, column_names, first_line

NANOSECONDS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}
METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
RADIANS = {"deg": np.pi / 180.0, "rad": 1.0}
TIME_NAMES = ("time", "timestamp", "stamp", "t")
ANGLE_NAMES = ("angle", "theta", "bearing")
DISTANCE_NAMES = ("distance", "range", "dist", "r")
QUALITY_NAMES = ("quality", "intensity")
SECOND_NS = 10**9


@dataclass(frozen=True)
class _Columns:
    """Where the columns are; -1: there is none. Without a separator, blanks separate."""

    names: list[str]
    separator: str | None

    def find(self, wanted: tuple[str, ...]) -> int:
        """The column with one of the names, to which `_unit` or ` [unit]` may be added."""
        for name in wanted:
            for column, found in enumerate(self.names):
                if re.split(r"[\s_\[(]", found)[0] == name:
                    return column
        return -1

    def unit(self, column: int, units: dict[str, float], default: str) -> float:
        words = re.split(r"[\s_\[\]()]+", self.names[column])
        return next((units[word] for word in words[1:] if word in units), units[default])


def _columns(text: str) -> _Columns:
    separator = next((mark for mark in ",;\t" if mark in first_line(text)), None)
    return _Columns(column_names(text, separator), separator)


def is_point_table(text: str) -> bool:
    columns = _columns(text)
    return columns.find(ANGLE_NAMES) >= 0 and columns.find(DISTANCE_NAMES) >= 0


def point_log(text: str, is_clockwise: bool) -> LaserLog:
    """A sweep ends where the angle jumps back, against the usual direction and by more than half of all that is swept.

    Without times, a sweep takes a second. Raises UnknownLogError.
    """
    columns = _columns(text)
    time, quality = columns.find(TIME_NAMES), columns.find(QUALITY_NAMES)
    angle, distance = columns.find(ANGLE_NAMES), columns.find(DISTANCE_NAMES)
    rows, num_bad = _rows(text, columns, [column for column in (time, angle) if column >= 0])
    angles = rows[:, angle] * columns.unit(angle, RADIANS, "deg")
    ranges = rows[:, distance] * columns.unit(distance, METRES, "mm")
    times_ns = None
    if time >= 0:
        times_ns = np.round(rows[:, time] * columns.unit(time, NANOSECONDS, "s")).astype(np.int64)
    scans = []
    for index, part in enumerate(_sweeps(angles)):
        scans.append(
            LaserScan(
                stamp_ns=index * SECOND_NS if times_ns is None else int(times_ns[part][0]),
                received_ns=0,
                ranges_m=ranges[part],
                intensities=rows[part, quality] if quality >= 0 else no_values(),
                angles_rad=-angles[part] if is_clockwise else angles[part],
                times_s=None if times_ns is None else np.round(1e-9 * (times_ns[part] - times_ns[part][0]), 9),
            )
        )
    log = checked_log(scans, num_bad)
    turn = "clockwise, as RPLidars count them" if is_clockwise else "counterclockwise"
    log.notes.append(f"the angles are taken as {turn}; --turn changes that")
    if times_ns is None:
        log.notes.append("the points have no times: a sweep is taken to last a second")
    return log


def _sweeps(angles_rad: Array) -> list[slice]:
    steps = np.diff(angles_rad)
    backwards = -steps if np.sum(steps > 0.0) >= np.sum(steps < 0.0) else steps
    jumps = np.flatnonzero(backwards > 0.5 * np.ptp(angles_rad)) + 1
    return [slice(begin, end) for begin, end in pairwise([0, *jumps.tolist(), len(angles_rad)])]


def _rows(text: str, columns: _Columns, finite: list[int]) -> tuple[Array, int]:
    """The lines whose values are numbers, finite ones in some columns, and how many other lines there are."""
    rows: list[list[float]] = []
    num_bad = 0
    for line in text.split("\n")[1:]:
        if not line.strip() or line.startswith("#"):
            continue
        try:
            values = [float(field) for field in line.split(columns.separator)]
        except ValueError:
            values = []
        if len(values) == len(columns.names) and np.isfinite([values[column] for column in finite]).all():
            rows.append(values)
        else:
            num_bad += 1
    if not rows:
        raise UnknownLogError("a table without a readable line")
    return np.array(rows), num_bad
