# SPDX-License-Identifier: GPL-3.0-or-later
"""How far off the scans of a map are, after the planar motion that fits all of them best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from evaluation.common.poses import Array
from evaluation.mapping.report import Report, place_in_log, placed_poses

from .whole_maps import fragment_errors


def absolute_errors_m(report: Report, references: Sequence[Array]) -> Array:
    """The error of each scan in the map, after the planar motion that fits all of them best. The true poses of a log
    are `references[log]` `[p, 3]`."""
    poses = placed_poses(report)
    if not poses:
        return np.empty(0)
    truth = np.full((len(report["scans"]), 3), np.nan)
    for index in poses:
        log, scan = place_in_log(report, index)
        truth[index] = references[log][scan]
    return fragment_errors(poses, truth).errors_m


def root_mean_square(values: Array) -> float:
    """The root mean square of some values, which is NaN where there are none."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else float("nan")
