#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Convert laser logs that shapemap does not read to its text format: ROS 1 bags, tinySLAM's logs, and lines of a pose
and ranges in millimetres. Recognised from content; each may be gzip-compressed."""

from __future__ import annotations

import argparse
import gzip
import sys
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from shapemap_sim.poses import Array
from shapemap_sim.sensor import SensorOptions
from shapemap_sim.write import SENSOR_NAME, range_text, sensor_line, write_whole

TINY_HEADER = 25  # time, battery, ticks, speeds, sonars and so on, before the ranges
TINY_BEAMS = 682
POSE_FIELDS = 3
EXAMPLE = """example:
  scripts/convert_logs.py lab.dat.gz lab.nist
  scripts/convert_logs.py --angle-step-deg=-0.5 vacuum.txt.gz vacuum.nist
  scripts/convert_logs.py --topic /scan walk.bag walk.nist"""


@dataclass(frozen=True)
class Recording:
    """`ranges` `[n, beams]` [m], NaN = no return; `references` `[n, 3]` where the log has poses."""

    sensor: SensorOptions
    min_range_m: float
    timestamps_s: Array
    ranges: Array
    references: Array | None = None


class UnknownLogError(ValueError):
    """What the file holds is none of the formats."""


def symmetric_laser(num_beams: int, step_deg: float, max_range_m: float) -> SensorOptions:
    """Beams to both sides of straight ahead, from right to left."""
    first = -0.5 * step_deg * (num_beams - 1)
    return SensorOptions(num_beams=num_beams, first_angle_deg=first, angle_step_deg=step_deg, max_range_m=max_range_m)


def read_rows(text: str, path: Path) -> tuple[list[list[float]], int]:
    """Lines of numbers with as many fields as most of them, and how many other lines there are."""
    try:
        rows = [[float(field) for field in line.split()] for line in text.splitlines() if line.strip()]
    except ValueError as error:
        raise UnknownLogError(f"{path}: neither a ROS bag nor lines of numbers: {error}") from None
    if not rows:
        raise UnknownLogError(f"{path}: empty")
    (length, _), *_ = Counter(len(row) for row in rows).most_common(1)
    whole = [row for row in rows if len(row) == length]
    return whole, len(rows) - len(whole)


def millimetres(readings: Array) -> Array:
    """[m]; what is not positive is no return."""
    return np.where(readings > 0.0, 1e-3 * readings, np.nan)


def tiny_slam(rows: Array) -> Recording:
    """Time in microseconds, wheel ticks and more, which are not used, and the 682 steps of a Hokuyo URG-04LX, 1024 to a
    full turn. Below 20 are error codes."""
    ranges = millimetres(np.where(rows[:, TINY_HEADER:] < 20.0, 0.0, rows[:, TINY_HEADER:]))
    times = 1e-6 * (rows[:, 0] - rows[0, 0])
    return Recording(symmetric_laser(TINY_BEAMS, 360.0 / 1024.0, 5.6), 0.02, times, ranges)


def poses_and_ranges(rows: Array, step_deg: float, max_range_m: float, min_range_m: float) -> Recording:
    """Lines of x, y [mm], heading [rad] and ranges [mm]; without times, one a second. The poses become references."""
    poses = rows[:, :POSE_FIELDS] * np.array([1e-3, 1e-3, 1.0])
    ranges = millimetres(rows[:, POSE_FIELDS:])
    times = np.arange(len(rows), dtype=np.float64)
    sensor = symmetric_laser(ranges.shape[1], step_deg, max_range_m)
    return Recording(sensor, min_range_m, times, ranges, poses)


def ros_bag(path: Path, topic: str) -> Recording:
    """The sensor_msgs/LaserScan messages of a topic. Raises UnknownLogError when there is none."""
    from rosbags.rosbag1 import Reader  # only bags need it
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    messages: list[Any] = []
    with Reader(path) as bag:
        lasers = [c for c in bag.connections if c.msgtype == "sensor_msgs/msg/LaserScan"]
        if topic:
            lasers = [c for c in lasers if c.topic == topic]
        topics = sorted({c.topic for c in lasers})
        if len(topics) != 1:
            raise UnknownLogError(f"{path}: expected one laser, found {', '.join(topics) or 'none'}; see --topic")
        messages = [store.deserialize_ros1(raw, c.msgtype) for c, _, raw in bag.messages(connections=lasers)]
    first = messages[0]
    sensor = SensorOptions(
        num_beams=len(first.ranges),
        first_angle_deg=float(np.rad2deg(first.angle_min)),
        angle_step_deg=float(np.rad2deg(first.angle_increment)),
        max_range_m=float(first.range_max),
    )
    stamps = [m.header.stamp.sec + 1e-9 * m.header.stamp.nanosec for m in messages]
    ranges = np.array([m.ranges for m in messages], dtype=np.float64)
    return Recording(sensor, float(first.range_min), np.array(stamps) - stamps[0], ranges)


def read(path: Path, arguments: argparse.Namespace) -> tuple[Recording, int]:
    """The log, and how many lines of it are not like the others and left out."""
    data = path.read_bytes()
    if data.startswith(b"#ROSBAG"):
        return ros_bag(path, arguments.topic), 0
    if data.startswith(b"\x1f\x8b"):
        data = gzip.decompress(data)
    rows, others = read_rows(data.decode("ascii", errors="replace"), path)
    if len(rows[0]) == TINY_HEADER + TINY_BEAMS:
        return tiny_slam(np.array(rows)), others
    if arguments.angle_step_deg is None:
        raise UnknownLogError(f"{path}: lines of {len(rows[0])} numbers; a pose and ranges need --angle-step-deg")
    limits = arguments.max_range_m, arguments.min_range_m
    return poses_and_ranges(np.array(rows), arguments.angle_step_deg, *limits), others


def text_of(log: Recording, name: str) -> str:
    """The log in shapemap's text format."""
    sensor = f"{sensor_line(log.sensor)} min_range {log.min_range_m:g}"
    lines: list[str] = ["shapemap-scans 1", f"# converted from {name}", "units m deg", sensor]
    poses: Iterable[Array | None] = [None] * len(log.ranges) if log.references is None else log.references
    for time, pose, ranges in zip(log.timestamps_s, poses, log.ranges):
        where = "" if pose is None else f" reference {pose[0]:.6f} {pose[1]:.6f} {np.rad2deg(pose[2]):.6f}"
        lines.append(f"position {time:.6f}{where}")
        lines.append(f"scan {SENSOR_NAME} heading 0 ranges " + " ".join(range_text(r) for r in ranges))
    return "\n".join(lines) + "\n"


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("log", type=Path, metavar="IN")
    parser.add_argument("out", type=Path, metavar="OUT", help="the log in shapemap's text format")
    parser.add_argument("--topic", default="", metavar="NAME", help="which laser of a bag, where it has several")
    parser.add_argument(
        "--angle-step-deg",
        type=float,
        metavar="DEG",
        help="of pose and ranges: angle between beams, negative clockwise",
    )
    parser.add_argument("--max-range-m", type=float, default=5.0, metavar="M", help="likewise (default %(default)s)")
    parser.add_argument("--min-range-m", type=float, default=0.1, metavar="M", help="likewise (default %(default)s)")
    return parser.parse_args(argv)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        log, others = read(arguments.log, arguments)
        write_whole(arguments.out, text_of(log, arguments.log.name))
    except (UnknownLogError, OSError) as error:
        print(f"convert_logs.py: {error}", file=sys.stderr)
        return 1
    returned = ((log.ranges >= log.min_range_m) & (log.ranges < log.sensor.max_range_m)).mean()
    print(f"{len(log.ranges)} scans of {log.ranges.shape[1]} beams, {100 * returned:.0f} % of them returned")
    if others:
        print(f"left out {others} lines that are not like the others", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
