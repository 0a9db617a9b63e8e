# SPDX-License-Identifier: GPL-3.0-or-later
"""The laser: 401 beams over 100 degrees, with noise, drop-outs and a maximum range."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evaluation.common.poses import Array

from .raycast import RayCaster
from .robot import Drive
from .streams import stream


@dataclass(frozen=True)
class SensorOptions:
    """Beam i points at `first_angle_deg + i * angle_step_deg` in the frame of the sub-scan."""

    num_beams: int = 401
    first_angle_deg: float = -50.0
    angle_step_deg: float = 0.25
    max_range_m: float = 20.0
    height_m: float = 0.35
    range_sigma_m: float = 0.015
    drop_out_share: float = 0.01
    mixed_pixel_share: float = 0.0

    def beam_angles_rad(self) -> Array:
        return np.deg2rad(self.first_angle_deg + self.angle_step_deg * np.arange(self.num_beams))


def exact_ranges(caster: RayCaster, drive: Drive, options: SensorOptions) -> Array:
    """Ranges `[p, s, beams]` [m] without any error of the sensor; inf where a beam meets nothing."""
    poses, beams = drive.map_from_sub_scan, options.beam_angles_rad()
    ranges = np.empty((*poses.shape[:2], options.num_beams))
    for index in np.ndindex(*poses.shape[:2]):
        angles = poses[index][2] + beams
        slopes = drive.gradient[index] @ np.stack([np.cos(angles), np.sin(angles)])
        ranges[index] = caster.cast(poses[index][:2], options.height_m, angles, slopes)
    return ranges


def mix_pixels(ranges: Array, share: float, rng: np.random.Generator, min_jump_m: float = 0.2) -> Array:
    """At a depth edge a beam may fall on both sides and report a range between the two."""
    following = np.concatenate([ranges[..., 1:], ranges[..., -1:]], axis=-1)
    chosen, weight = rng.random(ranges.shape) < share, rng.random(ranges.shape)
    finite = np.isfinite(ranges) & np.isfinite(following)
    jump = np.where(finite, following, 0.0) - np.where(finite, ranges, 0.0)
    return np.where(chosen & finite & (np.abs(jump) > min_jump_m), ranges + weight * jump, ranges)


def measure(seed: int, exact: Array, options: SensorOptions) -> Array:
    """Readings `[p, s, beams]` [m]; NaN is "no return"."""
    ranges = mix_pixels(exact, options.mixed_pixel_share, stream(seed, "mixed pixels"))
    noise = options.range_sigma_m * stream(seed, "range noise").standard_normal(exact.shape)
    dropped = stream(seed, "drop-outs").random(exact.shape) < options.drop_out_share
    readings = np.maximum(ranges + noise, 0.01)
    return np.where(dropped | (readings >= options.max_range_m), np.nan, readings)


def points_of(ranges: Array, beam_angles_rad: Array) -> Array:
    """End points `[n, 2]` of the beams that returned, in the frame of the sub-scan, in the order of the beams."""
    seen = np.isfinite(ranges)
    return ranges[seen, None] * np.stack([np.cos(beam_angles_rad[seen]), np.sin(beam_angles_rad[seen])], axis=-1)
