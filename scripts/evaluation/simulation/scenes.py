# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of a robot that takes one sweep at each stop and turns as it likes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evaluation.common.poses import Array, wrap_angle

from .raycast import RayCaster
from .robot import Drive, stops_along
from .sensor import SensorOptions, exact_ranges, measure
from .simulation import Simulation, SimulationOptions
from .streams import stream
from .world import World


@dataclass(frozen=True)
class StrollOptions:
    """`turn_deg`: headings are drawn within this of the direction of travel, and change by no more from one stop to
    the next; 180 is any heading. `least_turn_deg`: they change by at least this much. `tilt_deg`: at every stop the
    laser's plane leans in any direction by up to this."""

    num_positions: int = 12
    spacing_m: float = 1.0
    spacing_jitter: float = 0.2
    turn_deg: float = 60.0
    least_turn_deg: float = 0.0
    tilt_deg: float = 0.0


def headings_along(stops: Array, options: StrollOptions, rng: np.random.Generator) -> Array:
    """`[p]` [rad]."""
    steps = np.diff(stops, axis=0)
    travel = np.arctan2(steps[:, 1], steps[:, 0])
    limit, least = np.deg2rad(options.turn_deg), np.deg2rad(options.least_turn_deg)
    headings = [travel[0]]
    for direction in np.append(travel, travel[-1]):
        turn = wrap_angle(direction + rng.uniform(-limit, limit) - headings[-1])
        if least > 0.0:
            turn = rng.choice([-1.0, 1.0]) * rng.uniform(least, limit)
        headings.append(headings[-1] + float(np.clip(turn, -limit, limit)))
    return np.asarray(wrap_angle(headings[1:]))


def stroll(seed: int, route: Array, options: StrollOptions) -> Drive:
    """Stops along the route, with one sweep at each."""
    num = options.num_positions
    jitter = stream(seed, "spacing").uniform(-options.spacing_jitter, options.spacing_jitter, size=num - 1)
    stops = stops_along(route, options.spacing_m * (1.0 + jitter))
    poses = np.concatenate([stops, headings_along(stops, options, stream(seed, "heading"))[:, None]], axis=1)
    rng = stream(seed, "tilt")
    climb, towards = np.tan(np.deg2rad(options.tilt_deg * rng.random(num))), rng.uniform(-np.pi, np.pi, num)
    return Drive(
        timestamps_s=np.arange(num, dtype=np.float64),
        map_from_robot=poses,
        map_from_sub_scan=poses[:, None, :],
        gradient=(climb[:, None] * np.stack([np.cos(towards), np.sin(towards)], axis=-1))[:, None, :],
        nominal_headings_rad=np.zeros(1),
    )


def laser(fov_deg: float, step_deg: float, max_range_m: float) -> SensorOptions:
    """A laser that looks ahead; one of 360 degrees has no beam twice."""
    beams = round(fov_deg / step_deg) + (fov_deg < 360.0)
    return SensorOptions(
        num_beams=beams,
        first_angle_deg=-0.5 * fov_deg,
        angle_step_deg=step_deg,
        max_range_m=max_range_m,
        mixed_pixel_share=0.02,
    )


def run_of(seed: int, world: World, drive: Drive, sensor: SensorOptions, exact: Array | None = None) -> Simulation:
    """The run with the sensor's errors; `exact` where something else than the world alone decides on the ranges."""
    ranges = exact_ranges(RayCaster(world), drive, sensor) if exact is None else exact
    return Simulation(SimulationOptions(seed=seed, sensor=sensor), world, drive, measure(seed, ranges, sensor))
