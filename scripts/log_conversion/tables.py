# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs as tables with named columns: what `rostopic echo -p` prints, and points one a line."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .model import Array, LaserLog, LaserScan, UnknownLogError, counted, no_values, printable, single_laser

NAME = "laser"
NANOSECONDS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}
METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
RADIANS = {"deg": np.pi / 180.0, "rad": 1.0}
TIME_NAMES = ("time", "timestamp", "stamp", "t")
ANGLE_NAMES = ("angle", "theta", "bearing")
DISTANCE_NAMES = ("distance", "range", "dist", "r")
QUALITY_NAMES = ("quality", "intensity")
ECHO_FIELDS = {  # of the message, and what they are here
    "field.angle_min": "first_angle_rad",
    "field.angle_max": "last_angle_rad",
    "field.angle_increment": "angle_step_rad",
    "field.time_increment": "time_step_s",
    "field.range_min": "min_range_m",
    "field.range_max": "max_range_m",
}


def is_table(text: str) -> bool:
    """Whether the first line names columns, as far as one can tell without reading them."""
    names = column_names(text)
    return "field.angle_min" in names or (_find(names, ANGLE_NAMES) >= 0 and _find(names, DISTANCE_NAMES) >= 0)


def table_log(text: str, is_clockwise: bool) -> LaserLog:
    """Raises UnknownLogError."""
    return printed_messages(text) if "field.angle_min" in column_names(text) else points(text, is_clockwise)


def column_names(text: str) -> list[str]:
    first = text[: text.find("\n") if "\n" in text else len(text)]
    return [name.strip().strip('"').lower() for name in first.lstrip("\ufeff# ").split(",")]


def _find(names: list[str], wanted: tuple[str, ...]) -> int:
    """The column with one of the names, to which `_unit` or ` [unit]` may be added; -1 if there is none."""
    for name in wanted:
        for column, found in enumerate(names):
            if re.split(r"[\s_\[(]", found)[0] == name:
                return column
    return -1


def _unit(name: str, units: dict[str, float], default: str) -> float:
    words = re.split(r"[\s_\[\]()]+", name)
    return next((units[word] for word in words[1:] if word in units), units[default])


@dataclass(frozen=True)
class _EchoColumns:
    names: dict[str, int]
    num_ranges: int
    num_intensities: int

    @property
    def num_others(self) -> int:
        return len(self.names) - self.num_ranges - self.num_intensities

    def readings(self, num_fields: int) -> tuple[int, int]:
        """How many ranges and intensities a line has: the first message named the columns, and others may have other
        numbers of beams. Raises ValueError where that is not clear."""
        if num_fields == len(self.names):
            return self.num_ranges, self.num_intensities
        values = num_fields - self.num_others
        if values < 0:
            raise ValueError("too few fields")
        if self.num_intensities == 0:
            return values, 0
        if self.num_intensities != self.num_ranges or values % 2:
            raise ValueError("ranges and intensities cannot be told apart")
        return values // 2, values // 2


def printed_messages(text: str) -> LaserLog:
    """Lines of `rostopic echo -p` of a LaserScan. The first column is when the message was received."""
    names = column_names(text)
    columns = _EchoColumns(
        {name: column for column, name in enumerate(names)},
        sum(name.startswith("field.ranges") for name in names),
        sum(name.startswith("field.intensities") for name in names),
    )
    missing = [name for name in ("field.header.stamp", *ECHO_FIELDS) if name not in columns.names]
    if missing:
        raise UnknownLogError(f"a printed message without {', '.join(missing)}; expected those of a LaserScan")
    lines = text.split("\n")[1:]
    scans: list[LaserScan] = []
    num_bad = 0
    for number, line in enumerate(lines):
        fields = line.split(",")
        is_cut = number == len(lines) - 1 and len(fields) != len(names)  # no line end: the file was cut off
        if not line.strip():
            continue
        try:
            if is_cut:
                raise ValueError("cut off")
            scans.append(_printed_scan(fields, columns))
        except ValueError:
            num_bad += 1
    return _checked(scans, num_bad)


def _printed_scan(fields: list[str], columns: _EchoColumns) -> LaserScan:
    num_ranges, num_intensities = columns.readings(len(fields))
    at = columns.num_others  # arrays are the last columns
    values = np.array(fields[at : at + num_ranges + num_intensities], dtype=np.float32)
    header = {name: float(fields[columns.names[column]]) for column, name in ECHO_FIELDS.items()}
    return LaserScan(
        stamp_ns=int(fields[columns.names["field.header.stamp"]]),
        received_ns=int(fields[0]),
        ranges_m=values[:num_ranges],
        intensities=values[num_ranges:],
        first_angle_rad=header["first_angle_rad"],
        last_angle_rad=header["last_angle_rad"],
        angle_step_rad=header["angle_step_rad"],
        time_step_s=header["time_step_s"],
        min_range_m=header["min_range_m"],
        max_range_m=header["max_range_m"],
    )


def _checked(scans: list[LaserScan], num_bad: int) -> LaserLog:
    if not any(len(scan.ranges_m) for scan in scans):
        raise UnknownLogError("a table without a readable line")
    log = single_laser(NAME, scans)
    if num_bad:
        log.notes.append(f"left out {counted(num_bad, 'line')} that cannot be read")
    log.uses_received_times = all(s.stamp_ns == 0 for s in scans) and any(s.received_ns for s in scans)
    if log.uses_received_times:
        log.notes.append("the headers have no times: the times at which the messages were received are used")
    return log


def points(text: str, is_clockwise: bool) -> LaserLog:
    """A point a line, in the order in which they were measured. A sweep ends where the angle jumps back, against the
    usual direction and by more than half of all that is swept."""
    names = column_names(text)
    time, angle = _find(names, TIME_NAMES), _find(names, ANGLE_NAMES)
    distance, quality = _find(names, DISTANCE_NAMES), _find(names, QUALITY_NAMES)
    if time < 0:
        raise UnknownLogError(f"a table of {printable(', '.join(names))}; expected a column time")
    rows, num_bad = _rows(text, len(names))
    times_ns = np.round(rows[:, time] * _unit(names[time], NANOSECONDS, "s")).astype(np.int64)
    angles = rows[:, angle] * _unit(names[angle], RADIANS, "deg")
    ranges = rows[:, distance] * _unit(names[distance], METRES, "mm")
    steps = np.diff(angles)
    backwards = -steps if np.sum(steps > 0.0) >= np.sum(steps < 0.0) else steps
    jumps = np.flatnonzero(backwards > 0.5 * np.ptp(angles)) + 1
    bounds = [0, *jumps.tolist(), len(rows)]
    scans = []
    for begin, end in pairwise(bounds):
        part = slice(begin, end)
        scans.append(
            LaserScan(
                stamp_ns=int(times_ns[begin]),
                received_ns=0,
                ranges_m=ranges[part],
                intensities=rows[part, quality] if quality >= 0 else no_values(),
                angles_rad=-angles[part] if is_clockwise else angles[part],
                times_s=np.round(1e-9 * (times_ns[part] - times_ns[begin]), 9),
            )
        )
    log = _checked(scans, num_bad)
    turn = "clockwise, as RPLidars count them" if is_clockwise else "counterclockwise"
    log.notes.append(f"the angles are taken as {turn}; --turn changes that")
    return log


def _rows(text: str, num_columns: int) -> tuple[Array, int]:
    rows: list[list[float]] = []
    num_bad = 0
    for line in text.split("\n")[1:]:
        fields = line.split(",")
        try:
            values = [float(field) for field in fields]
        except ValueError:
            num_bad += bool(line.strip())
            continue
        if len(values) == num_columns and np.isfinite(values).all():
            rows.append(values)
        else:
            num_bad += 1
    if not rows:
        raise UnknownLogError("a table without a readable line")
    return np.array(rows), num_bad
