# SPDX-License-Identifier: GPL-3.0-or-later
"""Reference and baseline poses, by position of a trace, and errors against them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from evaluation.common.poses import Array, compose, inverse
from evaluation.common.tum import parse_tum
from evaluation.logs.reference_log import read_reference_log

from .trace import Trace

SAME_TIME_S = 1e-3


def poses_by_time(trace: Trace, path: Path) -> dict[int, Array]:
    """The poses of a TUM file for the positions that they have the timestamp of. Raises ValueError when none fits."""
    poses = parse_tum(path.read_text(encoding="utf-8"), str(path))
    if not poses:
        raise ValueError(f"{path}: no pose")
    times = np.array(sorted(poses))
    found = {}
    for index, position in trace.positions.items():
        nearest = float(times[np.abs(times - position.timestamp_s).argmin()])
        if abs(nearest - position.timestamp_s) <= SAME_TIME_S:
            found[index] = poses[nearest]
    if not found:
        raise ValueError(f"{path}: none of its timestamps is that of a position of {trace.path.name}")
    return found


def poses_in_log(trace: Trace, path: Path) -> dict[int, Array]:
    """The reference poses that a text log itself holds; empty for a log without any."""
    try:
        log = read_reference_log(path)
    except (ValueError, OSError, IndexError):
        return {}
    poses = log.map_from_robot
    if not np.any(poses):
        return {}
    wholes = {index: position.index_in_whole_log for index, position in trace.positions.items()}
    return {index: poses[whole] for index, whole in wholes.items() if whole < len(poses)}


def reference_poses(trace: Trace, log: Path | None, given: Path | None) -> dict[int, Array]:
    """From the file that is given, else from LOG.tum beside the log, else from the log; empty without any."""
    if given is not None:
        return poses_by_time(trace, given)
    if log is None:
        return {}
    beside = log.with_suffix(".tum")
    return poses_by_time(trace, beside) if beside.is_file() else poses_in_log(trace, log)


def in_frame_of(first: int, poses: Mapping[int, Array]) -> dict[int, Array]:
    """The same poses in the frame of one of them; of none, none."""
    if not poses:
        return {}
    to_first = inverse(poses[first])
    return {index: compose(to_first, pose) for index, pose in poses.items()}


def position_errors_m(poses: Mapping[int, Array], reference: Mapping[int, Array]) -> dict[int, float]:
    """Distances of the positions that both have, in the frame of the first of them."""
    both = sorted(set(poses) & set(reference))
    if not both:
        return {}
    found, truth = in_frame_of(both[0], poses), in_frame_of(both[0], reference)
    return {i: float(np.hypot(*(found[i] - truth[i])[:2])) for i in both}
