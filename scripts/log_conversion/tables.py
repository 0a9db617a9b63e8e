# SPDX-License-Identifier: GPL-3.0-or-later
"""What all logs that are tables with named columns share."""

from __future__ import annotations

from .model import LaserLog, LaserScan, UnknownLogError, counted, single_laser

NAME = "laser"


def first_line(text: str) -> str:
    return text[: text.find("\n") if "\n" in text else len(text)].lstrip("\ufeff# ")


def column_names(text: str, separator: str | None) -> list[str]:
    """Of the first line; without a separator, blanks separate."""
    return [name.strip().strip('"').lower() for name in first_line(text).split(separator)]


def checked_log(scans: list[LaserScan], num_bad: int) -> LaserLog:
    """Raises UnknownLogError where there is no reading."""
    if not any(len(scan.ranges_m) for scan in scans):
        raise UnknownLogError("a table without a readable line")
    log = single_laser(NAME, scans)
    if num_bad:
        log.notes.append(f"left out {counted(num_bad, 'line')} that cannot be read")
    log.uses_received_times = all(s.stamp_ns == 0 for s in scans) and any(s.received_ns for s in scans)
    if log.uses_received_times:
        log.notes.append("the headers have no times: the times at which the messages were received are used")
    return log
