# SPDX-License-Identifier: GPL-3.0-or-later
"""How good a trajectory is, against reference poses. The errors of trajectories are evo's."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from evo.core import filters, geometry, lie_algebra
from evo.core.metrics import APE, RPE, PoseRelation, Unit
from evo.core.trajectory import PoseTrajectory3D

from evaluation.common.poses import Array, compose

RPE_DISTANCE_M = 10.0
FEWEST_POSES = 3


def alignment(reference: Array, poses: Mapping[int, Array]) -> Array | None:
    """`reference_from_map` `[3]`: the planar motion that brings the placed positions nearest to their references
    (least squares over positions, by Umeyama's method); None where too few are placed or all at one place.

    In the plane: in space, evo's own would turn a mirrored map upside down and call it right."""
    placed = sorted(poses)
    if len(placed) < FEWEST_POSES:
        return None
    here = np.array([poses[k][:2] for k in placed])
    there = np.asarray(reference)[placed, :2]
    try:
        rotation, shift, _ = geometry.umeyama_alignment(here.T, there.T, with_scale=False)
    except geometry.GeometryException:
        return None
    return np.array([shift[0], shift[1], np.arctan2(rotation[1, 0], rotation[0, 0])])


def _evo_trajectory(poses: Array, positions: Sequence[int]) -> PoseTrajectory3D:
    matrices = []
    for x, y, theta in poses:
        rotation = np.array(
            [[np.cos(theta), -np.sin(theta), 0.0], [np.sin(theta), np.cos(theta), 0.0], [0.0, 0.0, 1.0]]
        )
        matrices.append(lie_algebra.se3(rotation, np.array([x, y, 0.0])))
    return PoseTrajectory3D(poses_se3=matrices, timestamps=np.array(positions, dtype=float))


def trajectory_errors(reference: Array, poses: Mapping[int, Array]) -> dict[str, Any]:
    """Absolute error after alignment, relative error of consecutive placed positions and over 10 m of path; of one
    fragment. Members are None where they cannot be had."""
    result: dict[str, Any] = {"ate": None, "rpe": None, "rpe_10m": None, "aligned_by": None}
    aligned_by = alignment(reference, poses)
    placed = sorted(poses)
    if aligned_by is None:
        return result
    truth = _evo_trajectory(np.asarray(reference)[placed], placed)
    found = _evo_trajectory(compose(aligned_by, np.array([poses[k] for k in placed])), placed)
    absolute, turned = APE(PoseRelation.translation_part), APE(PoseRelation.rotation_angle_deg)
    for metric in (absolute, turned):
        metric.process_data((truth, found))
    result["aligned_by"] = [float(value) for value in aligned_by]
    result["ate"] = _statistics(absolute, turned)
    result["ate"]["error_m"] = [[k, round(float(e), 6)] for k, e in zip(placed, absolute.error)]
    result["rpe"] = _relative(truth, found, 1.0, Unit.frames)
    result["rpe_10m"] = _relative(truth, found, RPE_DISTANCE_M, Unit.meters)
    return result


def _relative(truth: PoseTrajectory3D, found: PoseTrajectory3D, delta: float, unit: Unit) -> dict[str, float] | None:
    over_distance = unit is Unit.meters
    if over_distance and truth.path_length < delta:
        return None
    both = [
        RPE(relation, delta, unit, all_pairs=over_distance, pairs_from_reference=True)
        for relation in (PoseRelation.translation_part, PoseRelation.rotation_angle_deg)
    ]
    try:
        for metric in both:
            metric.process_data((truth, found))
    except filters.FilterException:
        return None
    return _statistics(*both)


def _statistics(shift: APE | RPE, turn: APE | RPE) -> dict[str, Any]:
    metres, degrees = shift.get_all_statistics(), turn.get_all_statistics()
    return {
        "rmse_m": float(metres["rmse"]),
        "median_m": float(metres["median"]),
        "max_m": float(metres["max"]),
        "rmse_deg": float(degrees["rmse"]),
        "median_deg": float(degrees["median"]),
    }
