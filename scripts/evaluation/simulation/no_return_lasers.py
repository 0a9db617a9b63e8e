# SPDX-License-Identifier: GPL-3.0-or-later
"""Lasers of all kinds in buildings of all sizes, and special distances that mean "no return" in what they read."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from evaluation.common.poses import Array

from .planar_raycast import PlanarCaster
from .world import Arc, Face, World, polygon_faces, rectangle_corners

LASER_HEIGHT_M = 0.3
Mask = NDArray[np.bool_]
CROWDED_SHARE = 0.25  # of the beams, at most


@dataclass(frozen=True)
class Laser:
    num_beams: int
    fov_deg: float
    sigma_m: float
    step_m: float  # of its readings
    limit_m: float


@dataclass
class SensorLog:
    """`ranges` are lists `[beams]` of readings, NaN: the sensor itself says that nothing was hit."""

    label: str
    laser: Laser
    ranges: Array
    codes: list[tuple[float, float]] = field(default_factory=list)
    on_code: list[Mask] = field(default_factory=list)  # of each code: which readings
    header_m: float = 0.0


def random_laser(rng: np.random.Generator, limit_m: float | None = None) -> Laser:
    """60 to 1440 beams over 90 to 360 degrees, noise of 1 mm to 5 cm, readings in steps of 1 mm to 5 cm."""
    num_beams = int(np.exp(rng.uniform(np.log(60), np.log(1440))))
    fov_deg = float(rng.choice([90.0, 120.0, 180.0, 240.0, 270.0, 359.0]))
    sigma_m = float(np.exp(rng.uniform(np.log(0.001), np.log(0.05))))
    step_m = float(rng.choice([0.001, 0.004, 0.01, 0.05]))
    return Laser(num_beams, fov_deg, sigma_m, step_m, limit_m or float(rng.uniform(8.0, 40.0)))


def random_box(
    rng: np.random.Generator, low: tuple[float, float], high: tuple[float, float], largest_m: float
) -> list[Face]:
    """One box, its middle within limits, with sides of 0.2 m up to `largest_m`."""
    length_m, width_m = rng.uniform(0.2, largest_m, 2)
    corners = rectangle_corners(rng.uniform(low, high), length_m, width_m, float(rng.uniform(0, np.pi)))
    return polygon_faces(corners, 1.2, "box")


def random_building(rng: np.random.Generator, size_m: float) -> World:
    """Walls with gaps, boxes and pillars; open on some sides."""
    world = World((size_m, size_m))
    for side in range(4):
        for part in range(4):
            if rng.random() < 0.75:
                low, high = part * size_m / 4, (part + 1) * size_m / 4
                at = 0.0 if side < 2 else size_m
                ends = ((low, at), (high, at)) if side % 2 else ((at, low), (at, high))
                world.faces.append(Face(*ends))
    for _ in range(int(rng.integers(3, 9))):
        x, y = rng.uniform(0.1, 0.9, 2) * size_m
        long = rng.uniform(0.1, 0.4) * size_m
        end = (x + long, y) if rng.random() < 0.5 else (x, y + long)
        world.faces.append(Face((x, y), end))
    for _ in range(int(rng.integers(5, 25))):
        world.faces.extend(random_box(rng, (0.0, 0.0), (size_m, size_m), 1.5))
    for _ in range(int(rng.integers(0, 15))):
        world.arcs.append(Arc(tuple(rng.uniform(0, size_m, 2)), float(rng.uniform(0.05, 0.4))))
    return world


def smooth_walk(rng: np.random.Generator, num: int, size_m: float, step_m: float) -> Array:
    """Poses `[n, 3]` of a robot that drives round and about in the middle of a square."""
    phase = np.cumsum(np.full(num, step_m)) / (0.25 * size_m)
    shape = rng.uniform(0.6, 1.6, 2)
    start = rng.uniform(0, 2 * np.pi, 2)
    x = size_m * (0.5 + 0.3 * np.sin(shape[0] * phase + start[0]))
    y = size_m * (0.5 + 0.3 * np.sin(shape[1] * phase + start[1]))
    heading = np.arctan2(np.gradient(y), np.gradient(x)) if num > 1 else np.zeros(1)
    return np.stack([x, y, heading], axis=1)


def exact(world: World, poses: Array, laser: Laser) -> Array:
    first = -0.5 * np.deg2rad(laser.fov_deg)
    step = np.deg2rad(laser.fov_deg) / (laser.num_beams - 1)
    return PlanarCaster(world, LASER_HEIGHT_M).cast(poses, first, step, laser.num_beams)


def measured(rng: np.random.Generator, ranges: Array, laser: Laser) -> Array:
    """With noise, in steps; NaN beyond the limit and too near."""
    noisy = ranges + laser.sigma_m * rng.standard_normal(ranges.shape)
    noisy = np.where((noisy > 2 * laser.step_m) & (noisy < laser.limit_m), noisy, np.nan)
    return np.round(np.round(noisy / laser.step_m) * laser.step_m, 4)


def with_codes(rng: np.random.Generator, log: SensorLog, values: Array, share: float) -> None:
    """Readings beyond the limit, and a share of the others, become one of the `values`."""
    lost = np.isnan(log.ranges) | (rng.random(log.ranges.shape) < share)
    log.ranges = np.where(lost, rng.choice(values, log.ranges.shape), log.ranges)
    log.codes.append((float(values.min()), float(values.max())))
    log.on_code.append(lost)


def drive(rng: np.random.Generator, limit_m: float | None = None, num: int | None = None) -> SensorLog:
    """A robot in a building of random size, hardly ever far smaller than what the laser sees."""
    laser = random_laser(rng, limit_m)
    size_m = laser.limit_m * float(rng.uniform(0.6, 2.5))
    num = num or int(np.exp(rng.uniform(np.log(40), np.log(400))))
    poses = smooth_walk(rng, num, size_m, float(rng.uniform(0.02, 0.08)) * size_m)
    return SensorLog("laser", laser, measured(rng, exact(random_building(rng, size_m), poses, laser), laser))


def still(rng: np.random.Generator, turning: bool, num: int, size_share: float = 1.0) -> SensorLog:
    """In one place, with people walking by."""
    laser = random_laser(rng)
    size_m = size_share * laser.limit_m
    poses = np.repeat(smooth_walk(rng, 1, size_m, 1.0), num, axis=0)
    if turning:
        poses[:, 2] += np.cumsum(rng.uniform(0.0, np.deg2rad(5.0), num))
    seen = exact(random_building(rng, size_m), poses, laser)
    for _ in range(3):
        width = int(rng.uniform(0.0, CROWDED_SHARE / 3) * laser.num_beams)
        at = np.abs(np.cumsum(rng.normal(0.0, 2.0, num)) + rng.integers(laser.num_beams)).astype(int)
        away = 1.0 + np.abs(np.cumsum(rng.normal(0.0, 0.05, num)))
        for i in range(num):
            beams = np.arange(at[i], at[i] + width) % laser.num_beams
            seen[i, beams] = np.minimum(seen[i, beams], away[i])
    return SensorLog("laser", laser, measured(rng, seen, laser))


def in_world(rng: np.random.Generator, world: World, poses: Array, laser: Laser | None = None) -> SensorLog:
    laser = laser or random_laser(rng)
    return SensorLog("laser", laser, measured(rng, exact(world, poses, laser), laser))
