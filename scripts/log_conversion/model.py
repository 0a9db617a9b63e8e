# SPDX-License-Identifier: GPL-3.0-or-later
"""A log as its messages tell it: scans with the header that each of them has, the lasers, and where they sit."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]  # messages have single precision

MOST_TEXT = 80  # characters of a name from a file that a message repeats


class UnknownLogError(ValueError):
    """What the file holds is none of the formats, or has no laser scans."""


def no_values() -> Array:
    return np.empty(0, dtype=np.float32)


@dataclass(frozen=True)
class LaserScan:
    """One sweep. The fields are those of its message and may be anything: NaN, infinite, zero, contradictory.

    `angles_rad` and `times_s` (after the stamp) are given where the log has them for each reading.
    """

    stamp_ns: int
    received_ns: int
    ranges_m: Array
    first_angle_rad: float = 0.0
    angle_step_rad: float = 0.0
    last_angle_rad: float | None = None
    time_step_s: float = 0.0
    min_range_m: float = 0.0
    max_range_m: float = 0.0
    intensities: Array = field(default_factory=no_values)
    angles_rad: Array | None = None
    times_s: Array | None = None


@dataclass(frozen=True)
class Mount:
    """The laser in the frame of the robot: metres and radians, turned by yaw, then pitch, then roll."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    yaw: float = 0.0
    pitch: float = 0.0
    roll: float = 0.0

    def values(self) -> tuple[float, ...]:
        return self.x, self.y, self.z, self.yaw, self.pitch, self.roll


@dataclass
class Laser:
    """The scans of one laser in the order in which they were recorded; `mount` is None where nothing tells it."""

    name: str
    frame: str
    scans: list[LaserScan]
    mount: Mount | None = None


@dataclass(frozen=True)
class Moment:
    """What was seen from one place: scans `(laser, scan)` by index that overlap in time, the earliest first."""

    scans: tuple[tuple[int, int], ...]


@dataclass
class LaserLog:
    """`references` `[n, 3]` are the poses of the moments where the log has them; `notes` are for the user.

    Where `uses_received_times` holds, the headers have no times, and those at which the messages came stand for them.
    """

    lasers: list[Laser]
    moments: list[Moment]
    notes: list[str] = field(default_factory=list)
    references: Array | None = None
    uses_received_times: bool = False

    def time_ns(self, laser: int, scan: int) -> int:
        found = self.lasers[laser].scans[scan]
        return found.received_ns if self.uses_received_times else found.stamp_ns


def single_laser(name: str, scans: list[LaserScan]) -> LaserLog:
    """A log of one laser with a moment for each scan."""
    moments = [Moment(((0, index),)) for index in range(len(scans))]
    return LaserLog([Laser(name, "", scans)], moments)


def printable(text: str) -> str:
    """Text from a file for a terminal: without control characters, and not too long."""
    escaped = "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text[: MOST_TEXT + 1])
    return escaped if len(escaped) <= MOST_TEXT else escaped[:MOST_TEXT] + "..."


def counted(number: int, noun: str) -> str:
    """`1 message`, `2 messages`."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
