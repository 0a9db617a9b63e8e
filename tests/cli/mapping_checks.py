# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads what a run has written, and compares it with reference poses."""
import gzip
import itertools
import json
import math
import statistics

import numpy as np
import yaml
from evo.tools import file_interface


def relative(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    dx, dy = b[0] - a[0], b[1] - a[1]
    return c * dx + s * dy, -s * dx + c * dy, b[2] - a[2]


def read_tum(path):
    """As evo reads it. Times are the log's, and some real logs repeat one time in all lines."""
    trajectory = file_interface.read_tum_trajectory_file(path)
    details = trajectory.check()[1]
    assert details["SE(3) conform"] == "yes" and details["quaternions"] == "ok", details
    return trajectory


def poses_by_time(trajectory):
    """x [m], y [m], heading [rad] by timestamp."""
    quaternions = trajectory.orientations_quat_wxyz
    headings = 2 * np.arctan2(quaternions[:, 3], quaternions[:, 0])
    return dict(zip(trajectory.timestamps, np.column_stack((trajectory.positions_xyz[:, :2], headings))))


def flaser_poses(path, num):
    with gzip.open(path, "rt", errors="replace") as lines:
        rows = [words for words in map(str.split, lines) if words and words[0] == "FLASER"][:num]
    return {i: [float(v) for v in row[2 + int(row[1]) : 5 + int(row[1])]] for i, row in enumerate(rows)}


def reported_poses(report):
    """By index in the whole log; without the positions that are not placed."""
    poses = {}
    for position in report["scans"]:
        pose = position["map_from_robot"]
        if pose is not None:
            poses[position["index_in_whole_log"]] = (pose["x_m"], pose["y_m"], math.radians(pose["theta_deg"]))
    return poses


def pair_errors(truth, found):
    """Metres and degrees for each consecutive pair of the truth; infinite where one of the two is not placed."""
    keys, errors = sorted(truth), []
    for a, b in itertools.pairwise(keys):
        if a not in found or b not in found:
            errors.append((math.inf, math.inf))
            continue
        wanted, got = relative(truth[a], truth[b]), relative(found[a], found[b])
        turn = math.remainder(wanted[2] - got[2], 2 * math.pi)
        errors.append((math.hypot(wanted[0] - got[0], wanted[1] - got[1]), abs(math.degrees(turn))))
    return errors


def num_within(errors, max_m, max_deg):
    return sum(m < max_m and deg < max_deg for m, deg in errors)


def median_m(errors):
    return statistics.median(m for m, _ in errors)


def read_report(path):
    return json.loads(path.read_text())


def read_pgm(path):
    magic, size, depth, pixels = path.read_bytes().split(b"\n", 3)
    assert magic == b"P5"
    assert depth == b"255"
    width, height = map(int, size.split())
    return np.frombuffer(pixels, np.uint8).reshape(height, width)


def check_map(image_path, poses):
    """map.yaml describes this image, which has walls and free space, and all poses lie in it, outside of walls."""
    image = read_pgm(image_path)
    meta = yaml.safe_load(image_path.with_suffix(".yaml").read_text())
    assert meta["image"] == image_path.name
    assert meta["mode"] == "trinary"
    assert meta["negate"] == 0
    resolution_m = meta["resolution"]
    occupancy = (255 - image.astype(float)) / 255
    num_occupied = np.count_nonzero(occupancy > meta["occupied_thresh"])
    num_free = np.count_nonzero(occupancy < meta["free_thresh"])
    assert num_occupied > 100, "walls of at least five metres"
    assert num_free > num_occupied, "what beams have crossed is an area, walls are lines"
    height, width = image.shape
    states = []
    for x, y, _ in poses.values():
        column = int((x - meta["origin"][0]) / resolution_m)
        row = height - 1 - int((y - meta["origin"][1]) / resolution_m)
        assert 0 <= column < width
        assert 0 <= row < height
        states.append(occupancy[row, column])
    # A laser in front of the robot that looks ahead leaves the place of the robot itself unknown.
    assert max(states) < meta["occupied_thresh"], "no robot stands in a wall"
    assert statistics.median(states) < meta["free_thresh"], "most robots stand where beams have passed"
    return meta, image
