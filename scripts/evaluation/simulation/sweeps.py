# SPDX-License-Identifier: GPL-3.0-or-later
"""A rolling laser carried through a furnished building: each beam is cast from where the laser is at its own time, so
that every sweep is bent by what the carrier does meanwhile."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from evaluation.common.poses import Array, wrap_angle

from .buildings import BuildingOptions, furnished_building
from .planar_raycast import PlanarCaster
from .sensor import SensorOptions, measure
from .world import World
from .write import SENSOR_NAME, range_text, sensor_line

ROLLING = SensorOptions(
    num_beams=360,
    first_angle_deg=-180.0,
    angle_step_deg=1.0,
    max_range_m=12.0,
    range_sigma_m=0.01,
    drop_out_share=0.0,
)
HOUSE = BuildingOptions(size_m=(14.0, 9.0), corridor_m=(3.7, 5.3), objects=40)


@dataclass(frozen=True)
class SweepOptions:
    """The carrier walks along the route at `speed_m_s`, turns on the spot at `turn_deg_s`, and sways about its heading
    by `yaw_deg` at `yaw_hz`. A sweep starts each `1 / rate_hz` and takes `sweep_share` of that. Each is stamped
    `stamp_share` of the sweep after its first beam."""

    rate_hz: float = 7.0
    yaw_deg: float = 20.0
    yaw_hz: float = 1.0
    speed_m_s: float = 0.8
    turn_deg_s: float = 57.3
    seconds: float = 40.0
    sweep_share: float = 1.0
    stamp_share: float = 0.0
    sensor: SensorOptions = ROLLING
    building: BuildingOptions = field(default_factory=lambda: HOUSE)

    def period_s(self) -> float:
        return 1.0 / self.rate_hz

    def beam_step_s(self) -> float:
        return self.sweep_share * self.period_s() / self.sensor.num_beams


@dataclass(frozen=True)
class SweepRun:
    """`map_from_laser` `[n, 3]` is where the laser was at `timestamps_s`; `ranges` `[n, beams]`."""

    seed: int
    options: SweepOptions
    timestamps_s: Array
    map_from_laser: Array
    ranges: Array


class Walk:
    """Where the carrier is at any time."""

    def __init__(self, route: Array, options: SweepOptions) -> None:
        legs = np.diff(route, axis=0)
        headings = np.arctan2(legs[:, 1], legs[:, 0])
        times, poses = [0.0], [(*route[0], headings[0])]
        for leg, heading, end in zip(legs, headings, route[1:]):
            turn = float(wrap_angle(heading - poses[-1][2]))
            if turn != 0.0:
                times.append(times[-1] + abs(turn) / np.deg2rad(options.turn_deg_s))
                poses.append((*poses[-1][:2], poses[-1][2] + turn))
            times.append(times[-1] + float(np.hypot(*leg)) / options.speed_m_s)
            poses.append((*end, poses[-1][2]))
        self._times, self._poses, self._options = np.array(times), np.array(poses), options

    def duration_s(self) -> float:
        return float(self._times[-1])

    def at(self, times_s: Array) -> Array:
        """Poses `[..., 3]`."""
        poses = np.stack([np.interp(times_s, self._times, column) for column in self._poses.T], axis=-1)
        sway = np.deg2rad(self._options.yaw_deg) * np.sin(2.0 * np.pi * self._options.yaw_hz * times_s)
        poses[..., 2] += sway
        return poses


def simulate_sweeps(seed: int, options: SweepOptions) -> SweepRun:
    """The same options give the same arrays."""
    world = furnished_building(seed, options.building)
    walk = Walk(world.route, options)
    last_s = min(options.seconds, walk.duration_s()) - options.period_s()
    starts = np.arange(0.0, last_s, options.period_s())
    beam_times = starts[:, None] + options.beam_step_s() * np.arange(options.sensor.num_beams)
    exact = cast_beams(world, walk.at(beam_times), options.sensor)
    sweep_s = options.beam_step_s() * options.sensor.num_beams
    stamps = starts + options.stamp_share * sweep_s
    readings = measure(seed, exact, options.sensor)
    return SweepRun(seed, options, stamps, walk.at(stamps), readings)


def cast_beams(world: World, poses: Array, sensor: SensorOptions) -> Array:
    """Exact ranges `[n, beams]` [m] of beams that each have a pose `[n, beams, 3]` of their own."""
    towards = poses.reshape(-1, 3) + np.array([0.0, 0.0, 1.0]) * np.tile(sensor.beam_angles_rad(), len(poses))[:, None]
    caster = PlanarCaster(world, sensor.height_m)
    return caster.cast(towards, 0.0, 1.0, 1).reshape(poses.shape[:2])


def sweep_text(run: SweepRun, times: bool = False) -> str:
    """The run as a scan log with exact poses. `times`: the time of each beam is told."""
    sensor = sensor_line(run.options.sensor)
    if times:
        sensor += f" time_step {run.options.beam_step_s():.9g}"
    lines = ["shapemap-scans 1", f"# a rolling laser that is carried, seed {run.seed}", "units m deg", sensor]
    for time, pose, ranges in zip(run.timestamps_s, run.map_from_laser, run.ranges):
        lines.append(f"position {time:.6f} reference {pose[0]:.6f} {pose[1]:.6f} {np.rad2deg(pose[2]):.6f}")
        lines.append(f"scan {SENSOR_NAME} heading 0 ranges {' '.join(map(range_text, ranges))}")
    return "\n".join(lines) + "\n"
