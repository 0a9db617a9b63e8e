# SPDX-License-Identifier: GPL-3.0-or-later
"""A robot that goes round an office again and again, never twice the same way, and scans as it goes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from evaluation.common.poses import Array

from .office import STROLL_M, Office, OfficeOptions, Room, build_office
from .planar_raycast import PlanarCaster
from .robot import Drive
from .sensor import SensorOptions, measure
from .simulation import Simulation, SimulationOptions
from .streams import stream
from .world import World

SICK = SensorOptions(num_beams=181, first_angle_deg=-90.0, angle_step_deg=1.0, max_range_m=30.0)
MOVE_M = 0.02  # it moves in steps so small
TURN_RAD = math.radians(4.0)
STEER_RAD_PER_M = 3.0
TURN_ON_SPOT_RAD = math.radians(60.0)  # a target farther aside than this is turned to first
FACES_RAD = math.radians(10.0)


@dataclass(frozen=True)
class WalkOptions:
    """A scan is taken each `step_m`, give or take a quarter, and each `turn_deg`. `lateral_sigma_m`: how far the robot
    is aside of the middle of the corridor. At each door it goes in, or turns back, with these probabilities."""

    num_scans: int = 20_000
    step_m: float = 0.4
    turn_deg: float = 20.0
    lateral_sigma_m: float = 0.2
    enter: float = 0.25
    turn_back: float = 0.03
    sway_sigma_deg: float = 2.0
    seconds_per_m: float = 2.0


@dataclass(frozen=True)
class Target:
    """A place to go to, and how near is there."""

    x_m: float
    y_m: float
    reached_m: float


def target(place: Array, reached_m: float) -> Target:
    return Target(float(place[0]), float(place[1]), reached_m)


def targets(office: Office, options: WalkOptions, rng: np.random.Generator) -> Iterator[Target]:
    """Without end."""
    stations: list[Array | Room] = []
    for corner, rooms in zip(office.ring, office.rooms):
        stations += [corner, *rooms]
    at, direction = 0, 1
    while True:
        station = stations[at % len(stations)]
        is_room = isinstance(station, Room)
        place = station.in_front if isinstance(station, Room) else station
        aside = np.clip(options.lateral_sigma_m * rng.standard_normal(2), -0.4, 0.4)
        yield target(place + aside, 0.3)
        if isinstance(station, Room) and rng.random() < options.enter:
            yield from _visit(station, rng)
        if is_room and rng.random() < options.turn_back:
            direction = -direction
        at += direction


def _visit(room: Room, rng: np.random.Generator) -> Iterator[Target]:
    """In, about, and out again."""
    yield target(room.in_front, 0.1)
    yield target(room.door + rng.uniform(-0.05, 0.05, 2), 0.05)
    yield target(room.inside, 0.2)
    for _ in range(int(rng.integers(1, 4))):
        yield target(room.middle + rng.uniform(-0.7, 0.7, 2) * STROLL_M, 0.15)
    yield target(room.inside, 0.1)
    yield target(room.door + rng.uniform(-0.05, 0.05, 2), 0.05)
    yield target(room.in_front, 0.3)


def walk(office: Office, options: WalkOptions, seed: int) -> tuple[Array, Array]:
    """Poses `[n, 3]` at which scans are taken, and their times [s]."""
    rng = stream(seed, "walk")
    return follow(targets(office, options, rng), options, rng)


def follow(goals: Iterator[Target], options: WalkOptions, rng: np.random.Generator) -> tuple[Array, Array]:
    """As `walk`, from goal to goal, until there is none left or there are as many scans as wanted."""
    goal: Target | None = next(goals)
    x, y, heading = goal.x_m, goal.y_m, 0.0
    moved, turned, time, next_m = math.inf, 0.0, 0.0, 0.0
    turns_on_spot, limit = False, math.radians(options.turn_deg)
    poses: list[tuple[float, float, float]] = []
    times: list[float] = []
    while len(poses) < options.num_scans:
        while goal is not None and math.hypot(goal.x_m - x, goal.y_m - y) < goal.reached_m:
            goal = next(goals, None)
        if goal is None:
            break
        aside = math.remainder(math.atan2(goal.y_m - y, goal.x_m - x) - heading, 2.0 * math.pi)
        turns_on_spot = abs(aside) > (FACES_RAD if turns_on_spot else TURN_ON_SPOT_RAD)
        most = TURN_RAD if turns_on_spot else STEER_RAD_PER_M * MOVE_M
        turn = max(-most, min(most, aside))
        heading += turn
        turned += abs(turn)
        time += options.seconds_per_m * MOVE_M
        if not turns_on_spot:
            x, y, moved = x + MOVE_M * math.cos(heading), y + MOVE_M * math.sin(heading), moved + MOVE_M
        if moved >= next_m or turned >= limit:
            poses.append((x, y, heading))
            times.append(time)
            moved, turned, next_m = 0.0, 0.0, options.step_m * rng.uniform(0.75, 1.25)
    sway = np.deg2rad(options.sway_sigma_deg) * rng.standard_normal(len(poses))
    return np.array(poses) + np.column_stack([np.zeros((len(poses), 2)), sway]), np.array(times)


def simulate_walk(seed: int, options: WalkOptions, office: OfficeOptions | None = None) -> Simulation:
    """The same options give the same arrays."""
    built = build_office(seed, office or OfficeOptions())
    poses, times_s = walk(built, options, seed)
    return scanned(seed, built.world, poses, times_s, SICK)


def scanned(seed: int, world: World, poses: Array, times_s: Array, sensor: SensorOptions) -> Simulation:
    """A level laser's readings from poses `[n, 3]`."""
    angles = sensor.beam_angles_rad()
    caster = PlanarCaster(world, sensor.height_m)
    exact = caster.cast(poses, float(angles[0]), float(np.deg2rad(sensor.angle_step_deg)), sensor.num_beams)[:, None]
    drive = Drive(times_s, poses, poses[:, None], np.zeros((len(poses), 1, 2)), np.zeros(1))
    return Simulation(SimulationOptions(seed, sensor=sensor), world, drive, measure(seed, exact, sensor))
