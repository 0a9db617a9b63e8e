# SPDX-License-Identifier: GPL-3.0-or-later
"""Planar poses as arrays `[..., 3]` of x [m], y [m], theta [rad]; all functions broadcast over leading axes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def wrap_angle(angle_rad: ArrayLike) -> Array:
    """The same angle in [-pi, pi]."""
    angle = np.asarray(angle_rad, dtype=float)
    return angle - 2.0 * np.pi * np.round(angle / (2.0 * np.pi))


def rotate(points: ArrayLike, angle_rad: ArrayLike) -> Array:
    """Points `[..., 2]` turned counterclockwise about the origin."""
    p = np.asarray(points, dtype=float)
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    return np.stack([c * p[..., 0] - s * p[..., 1], s * p[..., 0] + c * p[..., 1]], axis=-1)


def compose(c_from_b: ArrayLike, b_from_a: ArrayLike) -> Array:
    """c_from_a."""
    outer, inner = np.asarray(c_from_b, dtype=float), np.asarray(b_from_a, dtype=float)
    xy = rotate(inner[..., :2], outer[..., 2]) + outer[..., :2]
    theta = wrap_angle(outer[..., 2] + inner[..., 2])
    return np.concatenate([xy, theta[..., None]], axis=-1)


def inverse(b_from_a: ArrayLike) -> Array:
    """a_from_b."""
    pose = np.asarray(b_from_a, dtype=float)
    xy = rotate(-pose[..., :2], -pose[..., 2])
    return np.concatenate([xy, wrap_angle(-pose[..., 2])[..., None]], axis=-1)


def transform(b_from_a: ArrayLike, points_in_a: ArrayLike) -> Array:
    """One pose `[3]` applied to points `[n, 2]`."""
    pose = np.asarray(b_from_a, dtype=float)
    return rotate(points_in_a, pose[2]) + pose[:2]


def pose_from(fields: Mapping[str, float]) -> Array:
    """`[3]` from a report's x_m, y_m, theta_deg."""
    return np.array([fields["x_m"], fields["y_m"], np.deg2rad(fields["theta_deg"])])


def pose_error(estimate: Array, truth: Array) -> tuple[float, float]:
    """Distance [m] and angle [deg] between two poses `[3]` in the same frame."""
    difference = compose(inverse(truth), estimate)
    return float(np.hypot(difference[0], difference[1])), float(abs(np.rad2deg(difference[2])))


def best_motion(found: Array, truth: Array) -> Array:
    """The planar motion `[3]` that brings the places `[n, 3]` of `found` nearest to those of `truth`, by least squares;
    of a single place, that which makes the pose the same."""
    if len(found) == 1:
        theta = truth[0, 2] - found[0, 2]
    else:
        a, b = found[:, :2] - found[:, :2].mean(axis=0), truth[:, :2] - truth[:, :2].mean(axis=0)
        theta = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
    shift = truth[:, :2].mean(axis=0) - rotate(found[:, :2].mean(axis=0), theta)
    return np.array([*shift, wrap_angle(theta)])
