#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Convert laser logs that shapemap does not read to its text format: ROS 1 and ROS 2 bags (a file, or a folder of ROS
2), tables that `rostopic echo -p` printed, tables of points with time, angle and distance, tinySLAM's logs, and lines
of a pose and ranges in millimetres. Recognised from content; each may be gzip-compressed. Files that are cut off or
damaged are used as far as they are whole."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

from evaluation.common.files import write_whole
from log_conversion.bags import BagOptions
from log_conversion.model import LaserLog, Mount, UnknownLogError
from log_conversion.number_lines import PoseLineOptions
from log_conversion.reading import ReadOptions, read_log
from log_conversion.ros_messages import Echo
from log_conversion.summary import summary
from log_conversion.text_format import text_of

EXAMPLE = """examples:
  scripts/convert_logs.py walk.bag walk.nist
  scripts/convert_logs.py --topic /scan --mount scan=0,0,0,0,0,180 walk.bag.gz walk.nist    (upside down)
  scripts/convert_logs.py lab.dat.gz lab.nist
  scripts/convert_logs.py --angle-step-deg=-0.5 vacuum.txt.gz vacuum.nist"""


def named_mount(text: str) -> tuple[str, Mount]:
    """NAME=x,y,z,yaw,pitch,roll in metres and degrees."""
    name, _, numbers = text.rpartition("=")
    try:
        x, y, z, *angles = (float(number) for number in numbers.split(","))
        yaw, pitch, roll = (float(angle) for angle in np.deg2rad(angles))
    except ValueError:
        name = ""
    if not name or not np.isfinite((x, y, z, yaw, pitch, roll)).all():
        raise argparse.ArgumentTypeError(f"expected NAME=x,y,z,yaw,pitch,roll, found '{text}'")
    return name, Mount(x, y, z, yaw, pitch, roll)


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("log", type=Path, metavar="IN")
    parser.add_argument("out", type=Path, metavar="OUT", help="the log in shapemap's text format")
    parser.add_argument(
        "--mount",
        action="append",
        default=[],
        type=named_mount,
        metavar="NAME=X,Y,Z,YAW,PITCH,ROLL",
        help="where a laser sits on the robot, in metres and degrees, instead of what the transforms of a bag say; "
        "NAME is its topic in bags and 'laser' otherwise; roll 180 is upside down; may be repeated",
    )
    bags = parser.add_argument_group("bags")
    bags.add_argument(
        "--topic", action="append", default=[], metavar="NAME", help="of a laser; may be repeated (default: all lasers)"
    )
    bags.add_argument(
        "--echo",
        type=Echo,
        choices=list(Echo),
        default=Echo.FIRST,
        help="which of several echoes of a beam counts (default %(default)s)",
    )
    points = parser.add_argument_group("tables of points")
    points.add_argument(
        "--turn",
        choices=("clockwise", "counterclockwise"),
        default="clockwise",
        help="which way angles grow, seen from above (default %(default)s)",
    )
    lines = parser.add_argument_group("lines of pose and ranges")
    lines.add_argument("--angle-step-deg", type=float, metavar="DEG", help="between beams, negative clockwise")
    lines.add_argument("--max-range-m", type=float, default=5.0, metavar="M", help="(default %(default)s)")
    lines.add_argument("--min-range-m", type=float, default=0.1, metavar="M", help="(default %(default)s)")
    return parser.parse_args(argv)


def read_options(arguments: argparse.Namespace) -> ReadOptions:
    return ReadOptions(
        bag=BagOptions(tuple(arguments.topic), arguments.echo),
        pose_lines=PoseLineOptions(arguments.angle_step_deg, arguments.max_range_m, arguments.min_range_m),
        is_clockwise=arguments.turn == "clockwise",
        mounts=dict(arguments.mount),
    )


def read(path: Path, arguments: argparse.Namespace) -> LaserLog:
    """Raises UnknownLogError or OSError."""
    return read_log(path, read_options(arguments))


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        log = read(arguments.log, arguments)
        write_whole(arguments.out, text_of(log, arguments.log.name))
    except (UnknownLogError, OSError) as error:
        print(f"convert_logs.py: {error}", file=sys.stderr)
        return 1
    print("\n".join(summary(log)), file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
