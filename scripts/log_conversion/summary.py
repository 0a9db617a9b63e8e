# SPDX-License-Identifier: GPL-3.0-or-later
"""What a converted log holds, in lines for the user."""

from __future__ import annotations

import numpy as np

from .model import Laser, LaserLog, LaserScan, counted, printable


def summary(log: LaserLog) -> list[str]:
    """A line for each laser and one for each thing that is odd about it, and the notes of the log."""
    lines: list[str] = []
    for laser in log.lasers:
        name = printable(laser.name)
        lines.append(f"{name}: {_content(laser)}")
        lines += [f"{name}: {odd}" for odd in oddities(laser, log.uses_received_times)]
    return [*lines, *log.notes]


def _content(laser: Laser) -> str:
    counts = [len(scan.ranges_m) for scan in laser.scans]
    seen = [count for count in counts if count]
    parts = [counted(len(counts), "scan")]
    parts[0] += f" of {min(seen)} to {max(seen)} beams" if seen and min(seen) < max(seen) else ""
    parts[0] += f" of {seen[0]} beams" if seen and min(seen) == max(seen) else ""
    if len(seen) < len(counts):
        parts.append(f"{len(counts) - len(seen)} of them without readings")
    num_readings = sum(counts)
    if num_readings:
        share = 100.0 * sum(num_returned(scan) for scan in laser.scans) / num_readings
        knows_maximum = all(is_known(scan.max_range_m) for scan in laser.scans if len(scan.ranges_m))
        what = "returned" if knows_maximum else "are positive and finite"
        parts.append(f"{share:.0f} % of the readings {what}")
    return ", ".join(parts)


def is_known(max_range_m: float) -> bool:
    return bool(np.isfinite(max_range_m) and max_range_m > 0.0)


def num_returned(scan: LaserScan) -> int:
    """Readings between the limits of the header, as far as it has any."""
    ranges = scan.ranges_m
    returned = np.isfinite(ranges) & (ranges > 0.0)
    if np.isfinite(scan.min_range_m):
        returned &= ranges >= scan.min_range_m
    if is_known(scan.max_range_m):
        returned &= ranges < scan.max_range_m
    return int(returned.sum())


def oddities(laser: Laser, uses_received_times: bool) -> list[str]:
    """What headers say that others would not."""
    scans = [scan for scan in laser.scans if len(scan.ranges_m)]
    found = [
        (sum(not is_known(s.max_range_m) for s in scans), "no maximum range"),
        (sum(not _is_good(s.angle_step_rad) and s.angles_rad is None for s in scans), "no angle step"),
        (
            sum(not np.isfinite(s.first_angle_rad) for s in scans),
            "no first angle: their readings are left out",
        ),
        (sum(not np.isfinite(s.min_range_m) or s.min_range_m < 0.0 for s in scans), "no minimum range"),
        (sum(len(s.intensities) not in (0, len(s.ranges_m)) for s in scans), "too many or too few intensities"),
        (sum(bool(np.isneginf(s.ranges_m).any()) for s in scans), "readings of minus infinity, which say nothing"),
    ]
    odd = [f"{number} of {len(scans)} have {what}" for number, what in found if number]
    odd += _varying(scans)
    return odd + ([] if uses_received_times else _odd_stamps(laser.scans))


def _is_good(step_rad: float) -> bool:
    return bool(np.isfinite(step_rad) and step_rad != 0.0)


def _varying(scans: list[LaserScan]) -> list[str]:
    """Fields that are not the same in all headers."""
    fields = {
        "first angle": [s.first_angle_rad for s in scans],
        "angle step": [s.angle_step_rad for s in scans],
        "maximum range": [s.max_range_m for s in scans],
    }
    names = [name for name, values in fields.items() if len(np.unique(values)) > 1]
    verb = "vary" if len(names) > 1 else "varies"
    return [f"the {' and the '.join(names)} {verb} from scan to scan"] if names else []


def _odd_stamps(scans: list[LaserScan]) -> list[str]:
    stamps = np.array([scan.stamp_ns for scan in scans], dtype=np.int64)
    steps = np.diff(stamps)
    found = [
        (int((stamps[1:] == 0).sum()), "the time 0"),  # a log may begin there
        (int((steps == 0).sum()), "the time of the scan before"),
        (int((steps < 0).sum()), "a time before that of the scan before"),
    ]
    return [f"{counted(number, 'scan')} with {what}" for number, what in found if number]
