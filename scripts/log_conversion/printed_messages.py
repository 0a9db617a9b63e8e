# SPDX-License-Identifier: GPL-3.0-or-later
"""What `rostopic echo -p` prints of a LaserScan: a line with the names of the fields, and a line for each message."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .model import LaserLog, LaserScan, UnknownLogError
from .tables import checked_log, column_names

ECHO_FIELDS = {  # of the message, and what they are here
    "field.angle_min": "first_angle_rad",
    "field.angle_max": "last_angle_rad",
    "field.angle_increment": "angle_step_rad",
    "field.time_increment": "time_step_s",
    "field.range_min": "min_range_m",
    "field.range_max": "max_range_m",
}


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


def is_printed(text: str) -> bool:
    return "field.angle_min" in column_names(text, ",")


def printed_messages(text: str) -> LaserLog:
    """Lines of `rostopic echo -p` of a LaserScan. The first column is when the message was received."""
    names = column_names(text, ",")
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
    return checked_log(scans, num_bad)


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
