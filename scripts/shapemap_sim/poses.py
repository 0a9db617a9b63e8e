# SPDX-License-Identifier: GPL-3.0-or-later
"""Planar poses as arrays `[..., 3]` of x [m], y [m], theta [rad]; all functions broadcast over leading axes."""

from __future__ import annotations

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
