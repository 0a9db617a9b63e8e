# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the robot stops along the route, and how it truly stands for each sub-scan."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evaluation.common.poses import Array, compose

from .streams import stream

SUB_SCAN_HEADINGS_DEG = (0.0, 90.0, 180.0, 270.0)


@dataclass(frozen=True)
class RobotOptions:
    """Errors are standard deviations unless they say otherwise."""

    num_positions: int = 16
    spacing_m: float = 1.5
    spacing_jitter: float = 0.1
    heading_uncertainty_deg: float = 2.0
    sub_scan_heading_sigma_deg: float = 0.7
    sub_scan_centre_sigma_m: float = 0.015
    tilt_sigma_deg: float = 1.5
    sub_scan_tilt_share: float = 0.3
    seconds_per_position: float = 10.0


@dataclass(frozen=True)
class Drive:
    """`map_from_robot` `[p, 3]`: the exact reference pose of each position. `map_from_sub_scan` `[p, s, 3]`: how the
    robot truly stood for each sub-scan. `gradient` `[p, s, 2]`: climb of the laser's plane along the map's x and y."""

    timestamps_s: Array
    map_from_robot: Array
    map_from_sub_scan: Array
    gradient: Array
    nominal_headings_rad: Array


def resample(route: Array, step_m: float = 0.02) -> Array:
    """Points `[m, 2]` about `step_m` apart along a polyline."""
    lengths = np.hypot(*np.diff(route, axis=0).T)
    travelled = np.concatenate([[0.0], np.cumsum(lengths)])
    at = np.linspace(0.0, travelled[-1], max(2, int(np.ceil(travelled[-1] / step_m)) + 1))
    return np.stack([np.interp(at, travelled, route[:, 0]), np.interp(at, travelled, route[:, 1])], axis=-1)


def stops_along(route: Array, distances_m: Array) -> Array:
    """Stops `[n + 1, 2]`: the start, then each time the first point of the route that is `distances_m[i]` away in a
    straight line. Raises ValueError when the route ends before."""
    points = resample(route)
    index, stops = 0, [points[0]]
    for distance in distances_m:
        away = np.hypot(*(points[index:] - points[index]).T)
        reached = np.flatnonzero(away >= distance)
        if not len(reached):
            raise ValueError(
                f"the route has room for {len(stops)} positions at this spacing, "
                f"not for {len(distances_m) + 1}: ask for fewer positions or a smaller spacing"
            )
        index += int(reached[0])
        stops.append(points[index])
    return np.array(stops)


def drive(seed: int, route: Array, options: RobotOptions) -> Drive:
    """Stop along the route and take four sub-scans at each stop."""
    num, turns = options.num_positions, np.deg2rad(SUB_SCAN_HEADINGS_DEG)
    jitter = stream(seed, "spacing").uniform(-options.spacing_jitter, options.spacing_jitter, size=num - 1)
    stops = stops_along(route, options.spacing_m * (1.0 + jitter))
    limit = np.deg2rad(options.heading_uncertainty_deg)
    headings = limit * stream(seed, "heading").uniform(-1.0, 1.0, size=num)
    map_from_robot = np.concatenate([stops, headings[:, None]], axis=1)
    nominal = np.zeros((num, len(turns), 3))
    nominal[..., 2] = turns
    error = np.zeros_like(nominal)
    error[..., :2] = options.sub_scan_centre_sigma_m * stream(seed, "centre").standard_normal((num, len(turns), 2))
    sigma = np.deg2rad(options.sub_scan_heading_sigma_deg)
    error[..., 2] = sigma * stream(seed, "sub-scan heading").standard_normal((num, len(turns)))
    robot_from_sub_scan = compose(error, nominal)
    return Drive(
        timestamps_s=options.seconds_per_position * np.arange(num, dtype=np.float64),
        map_from_robot=map_from_robot,
        map_from_sub_scan=compose(map_from_robot[:, None, :], robot_from_sub_scan),
        gradient=draw_tilt(seed, num, len(turns), options),
        nominal_headings_rad=turns,
    )


def draw_tilt(seed: int, num_positions: int, num_sub_scans: int, options: RobotOptions) -> Array:
    """`[p, s, 2]`: the floor under a position tilts all of its sub-scans alike, turning on it changes it a little."""
    rng = stream(seed, "tilt")
    common = rng.standard_normal((num_positions, 1, 2))
    own = options.sub_scan_tilt_share * rng.standard_normal((num_positions, num_sub_scans, 2))
    return np.tan(np.deg2rad(options.tilt_sigma_deg) * (common + own))
