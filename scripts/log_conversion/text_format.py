# SPDX-License-Identifier: GPL-3.0-or-later
"""shapemap's text format, version 2."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from .model import Array, Laser, LaserLog, LaserScan, Mount

MOST_DECIMALS = 6
# Fields that a sensor and a scan may have, and their names here.
FIELDS = {
    "first_angle": "first_angle_rad",
    "angle_step": "angle_step_rad",
    "last_angle": "last_angle_rad",
    "max_range": "max_range_m",
    "min_range": "min_range_m",
    "time_step": "time_step_s",
}


def text_of(log: LaserLog, source: str) -> str:
    """The log; `source` is said in a remark."""
    return "\n".join(_lines(log, source)) + "\n"


def _lines(log: LaserLog, source: str) -> Iterator[str]:
    yield "shapemap-scans 2"
    yield f"# converted from {remark(source)}"
    yield "units m rad"
    names = sensor_names(log.lasers)
    headers = [header_of(laser) for laser in log.lasers]
    for laser, name, header in zip(log.lasers, names, headers):
        yield sensor_line(laser, name, header)
    for index, moment in enumerate(log.moments):
        start_ns = log.time_ns(*moment.scans[0])
        pose = None if log.references is None else log.references[index]
        reference = "" if pose is None else f" reference {pose[0]:.6f} {pose[1]:.6f} {pose[2]:.9f}"
        yield f"position {seconds(start_ns)}{reference}"
        for laser_index, scan_index in moment.scans:
            offset_ns = log.time_ns(laser_index, scan_index) - start_ns
            scan = log.lasers[laser_index].scans[scan_index]
            yield scan_line(names[laser_index], scan, headers[laser_index], offset_ns)


def remark(text: str) -> str:
    return "".join(c if c.isprintable() else " " for c in text)


def sensor_names(lasers: list[Laser]) -> list[str]:
    """Single words without `#`, which begins a remark; different ones for different lasers."""
    names: list[str] = []
    for laser in lasers:
        word = re.sub(r"[\s#]|[^ -~]", "_", laser.name) or "laser"
        number = 2
        name = word
        while name in names:
            name, number = f"{word}-{number}", number + 1
        names.append(name)
    return names


def header_of(laser: Laser) -> LaserScan:
    """The scan whose header stands for all of the laser: the first with readings that have a place."""
    return next((scan for scan in laser.scans if len(scan.ranges_m) and has_place(scan)), laser.scans[0])


def sensor_line(laser: Laser, name: str, header: LaserScan) -> str:
    counts = {len(scan.ranges_m) if has_place(scan) else 0 for scan in laser.scans}
    beams = str(counts.pop()) if len(counts) == 1 and counts != {0} else "any"
    words = [f"sensor {name} beams {beams}", *_field_words(header, None)]
    if laser.mount is not None and laser.mount != Mount():
        words.append("mount " + " ".join(value_text(value) for value in laser.mount.values()))
    return " ".join(words)


def _field_words(scan: LaserScan, header: LaserScan | None) -> list[str]:
    """The header of a scan, as far as it differs from the sensor's. Each message has all fields, so that none needs to
    be taken back."""
    words = []
    for word, name in FIELDS.items():
        value = getattr(scan, name)
        known = None if header is None else getattr(header, name)
        if word in ("first_angle", "angle_step", "last_angle") and scan.angles_rad is not None:
            continue
        is_default = header is None and (value is None or (value == 0.0 and word != "angle_step"))
        if is_default or (header is not None and (value == known or (_is_nan(value) and _is_nan(known)))):
            continue
        words.append(f"{word} {value_text(value)}")
    return words


def has_place(scan: LaserScan) -> bool:
    """Whether the first angle is a number, without which readings have no place: the format knows no other."""
    return scan.angles_rad is not None or bool(np.isfinite(scan.first_angle_rad))


def _is_nan(value: float | None) -> bool:
    return value is not None and np.isnan(value)


def scan_line(name: str, scan: LaserScan, header: LaserScan, offset_ns: int) -> str:
    words = [f"scan {name} heading 0"]
    if not has_place(scan):
        return f"{words[0]} ranges"
    if offset_ns:
        words.append(f"time {seconds(offset_ns)}")
    words += _field_words(scan, header)
    for word, values in (("angles", scan.angles_rad), ("times", scan.times_s)):
        if values is not None and len(values):
            words.append(f"{word} {values_text(values)}")
    words.append(f"ranges {values_text(scan.ranges_m.astype(np.float32))}".rstrip())
    if len(scan.intensities) and len(scan.intensities) == len(scan.ranges_m):
        words.append(f"intensities {values_text(scan.intensities.astype(np.float32))}")
    return " ".join(words)


def seconds(nanoseconds: int) -> str:
    """Exactly, also where a floating-point number could not."""
    sign, rest = ("-", -nanoseconds) if nanoseconds < 0 else ("", nanoseconds)
    fraction = f"{rest % 10**9:09d}".rstrip("0") or "0"
    return f"{sign}{rest // 10**9}.{fraction}"


def value_text(value: float) -> str:
    """As many digits as a number of single precision needs to read back as the same."""
    text = f"{value:.9g}"
    with np.errstate(over="ignore", invalid="ignore"):
        single = np.float32(value)
        if np.isfinite(single) and float(single) == value:
            text = str(single)
    return "0" if text in ("-0", "0.0", "-0.0") else text


def values_text(values: Array) -> str:
    """With the fewest decimals that read back as the same; what is minus infinite, which is how drivers say
    "too near", becomes 0, which says as little."""
    wide = values.astype(np.float64)
    if np.isneginf(wide).any():
        wide = np.where(np.isneginf(wide), 0.0, wide)
    finite = wide[np.isfinite(wide)]
    for decimals in range(2, MOST_DECIMALS + 1):
        if (np.round(finite, decimals).astype(values.dtype) == finite).all():
            return " ".join(map(repr, np.round(wide, decimals).tolist()))
    return " ".join(f"{value:.9g}" for value in wide.tolist())
