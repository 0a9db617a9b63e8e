# SPDX-License-Identifier: GPL-3.0-or-later
"""A room without symmetry, seen from a path through it: logs whose truth is known."""
import math

NUM_BEAMS = 181
MAX_RANGE_M = 81.83

WALLS = [
    ((-3, -2), (7, -2)), ((7, -2), (7, 3)), ((7, 3), (5, 3)), ((5, 3), (5, 5)), ((5, 5), (-1, 5)),
    ((-1, 5), (-1, 3.4)), ((-1, 3.4), (-3, 2.5)), ((-3, 2.5), (-3, -2)),
    ((1.0, 2.6), (1.8, 2.9)), ((1.8, 2.9), (1.5, 3.7)), ((1.5, 3.7), (0.7, 3.4)), ((0.7, 3.4), (1.0, 2.6)),
    ((3.2, -1.2), (4.4, -1.0)), ((4.4, -1.0), (4.3, -0.4)), ((4.3, -0.4), (3.1, -0.6)), ((3.1, -0.6), (3.2, -1.2)),
]


def cast(x, y, angle):
    """Distance to the nearest wall along a beam."""
    dx, dy = math.cos(angle), math.sin(angle)
    nearest = MAX_RANGE_M
    for (ax, ay), (bx, by) in WALLS:
        ex, ey = bx - ax, by - ay
        cross = dx * ey - dy * ex
        if abs(cross) < 1e-12:
            continue
        along = ((ax - x) * ey - (ay - y) * ex) / cross
        share = ((ax - x) * dy - (ay - y) * dx) / cross
        if along > 0 and 0 <= share <= 1:
            nearest = min(nearest, along)
    return nearest


def path(num_positions):
    """Poses a few decimetres apart that turn by less than 2 degrees each."""
    return [(-1.5 + 0.3 * i, 0.3 + 0.05 * i, math.radians(8 + 1.2 * i)) for i in range(num_positions)]


def scan(pose):
    x, y, heading = pose
    first = heading - math.pi / 2
    return [cast(x, y, first + i * math.pi / (NUM_BEAMS - 1)) for i in range(NUM_BEAMS)]


def flaser(ranges, timestamp, fields=("0", "0", "0", "0", "0", "0")):
    values = " ".join(r if isinstance(r, str) else f"{r:.3f}" for r in ranges)
    return f"FLASER {len(ranges)} {values} {' '.join(fields)} {timestamp:.3f} robot {timestamp:.3f}\n"


def carmen_log(num_positions=12, fields=None):
    """`fields` gives the six pose and odometry fields of line i."""
    lines = []
    for i, pose in enumerate(path(num_positions)):
        lines.append(flaser(scan(pose), 1.0 + i, fields(i) if fields else ("0",) * 6))
    return "".join(lines)
