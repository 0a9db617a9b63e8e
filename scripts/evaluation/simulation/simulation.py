# SPDX-License-Identifier: GPL-3.0-or-later
"""One simulated run: world, drive and readings from a seed."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from evaluation.common.poses import Array, transform

from .arena import ArenaOptions, build_world
from .raycast import RayCaster
from .robot import Drive, RobotOptions, drive
from .sensor import SensorOptions, exact_ranges, measure, points_of
from .world import World, squared_distances


@dataclass(frozen=True)
class SimulationOptions:
    seed: int = 0
    arena: ArenaOptions = field(default_factory=ArenaOptions)
    robot: RobotOptions = field(default_factory=RobotOptions)
    sensor: SensorOptions = field(default_factory=SensorOptions)


@dataclass(frozen=True)
class Simulation:
    """`ranges` `[p, s, beams]` [m], NaN = no return."""

    options: SimulationOptions
    world: World
    drive: Drive
    ranges: Array


def simulate(options: SimulationOptions) -> Simulation:
    """The same options give the same arrays. Raises ValueError when the route is too short for the positions."""
    world = build_world(options.seed, options.arena)
    run = drive(options.seed, world.route, options.robot)
    exact = exact_ranges(RayCaster(world), run, options.sensor)
    return Simulation(options, world, run, measure(options.seed, exact, options.sensor))


def scan_in_map(simulation: Simulation, position: int) -> Array:
    """Points `[n, 2]` of a whole position in the map, at its reference pose and nominal headings: what a mapper with
    perfect poses would draw."""
    run, beams = simulation.drive, simulation.options.sensor.beam_angles_rad()
    points = [
        transform([0.0, 0.0, heading], points_of(ranges, beams))
        for heading, ranges in zip(run.nominal_headings_rad, simulation.ranges[position])
    ]
    return transform(run.map_from_robot[position], np.concatenate(points))


def overlap(query: Array, reference: Array, within_m: float = 0.15) -> float:
    """Share of the points `[n, 2]` of `query` with a neighbour in `reference` `[m, 2]` that is at most `within_m`
    away; 0 when one of them is empty."""
    if not len(query) or not len(reference):
        return 0.0
    return float((squared_distances(query, reference).min(axis=1) <= within_m**2).mean())


def consecutive_overlaps(simulation: Simulation) -> Array:
    """`[p - 1]`: overlap of each position's scan with the one before it."""
    scans = [scan_in_map(simulation, k) for k in range(len(simulation.ranges))]
    return np.array([overlap(scans[k], scans[k - 1]) for k in range(1, len(scans))])


def travel_visible(simulation: Simulation) -> Array:
    """`[p - 1]` of bool: whether each position sees the next one along a straight line."""
    caster, stops = RayCaster(simulation.world), simulation.drive.map_from_robot[:, :2]
    visible = []
    for here, there in pairwise(stops):
        step = there - here
        free = caster.cast(here, simulation.options.sensor.height_m, np.arctan2(step[1:], step[:1]), np.zeros(1))[0]
        visible.append(free > np.hypot(*step))
    return np.array(visible)
