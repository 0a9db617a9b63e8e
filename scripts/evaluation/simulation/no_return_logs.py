# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs of lasers of all kinds, with and without special distances that mean "no return"."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .no_return_lasers import Laser, SensorLog, drive, in_world, random_box, random_laser, still, with_codes
from .streams import stream
from .world import Arc, Face, World, polygon_faces


@dataclass
class NoReturnLog:
    kind: str
    seed: int
    sensors: list[SensorLog]


# Logs with codes.


def limit_code(rng: np.random.Generator) -> list[SensorLog]:
    """One distance at or beyond the limit: the limit itself, a little below or above it, 65.533 m ..."""
    log = drive(rng)
    limit_m = log.laser.limit_m
    code_m = rng.choice([limit_m, limit_m - 0.04, limit_m + rng.uniform(0.05, 1.0), 65.533, 51.15, 81.91])
    log.ranges[log.ranges >= code_m] = np.nan
    with_codes(rng, log, np.array([code_m]), share=float(10 ** rng.uniform(-3, -0.1)))
    return [log]


def inner_code(rng: np.random.Generator) -> list[SensorLog]:
    """Lost readings get a distance in the midst of the others."""
    log = drive(rng)
    code_m = rng.uniform(0.2, 0.9) * log.laser.limit_m
    with_codes(rng, log, np.array([code_m]), share=float(10 ** rng.uniform(-2, -0.5)))
    return [log]


def spread_code(rng: np.random.Generator) -> list[SensorLog]:
    log = drive(rng)
    base_m = max(50.9, log.laser.limit_m + 0.5) + rng.uniform(0, 1)
    step_m = rng.choice([0.01, 0.02, 0.05])
    with_codes(rng, log, base_m + step_m * np.arange(1 + round(0.2 / step_m)), share=float(10 ** rng.uniform(-3, -0.3)))
    return [log]


def millimetre_code(rng: np.random.Generator) -> list[SensorLog]:
    log = drive(rng)
    with_codes(rng, log, np.array([0.001]), share=float(10 ** rng.uniform(-3, -0.3)))
    return [log]


def odd_longer(rng: np.random.Generator) -> list[SensorLog]:
    """Below a few false readings that are longer."""
    log = drive(rng)
    with_codes(rng, log, np.array([log.laser.limit_m + 1.05]), share=float(10 ** rng.uniform(-3, -0.3)))
    odd = rng.random(log.ranges.shape) < 3e-4
    odd &= ~log.on_code[0]
    log.ranges = np.where(odd, rng.uniform(1.05, 2.0, odd.shape) * log.laser.limit_m, log.ranges)
    return [log]


def changing_code(rng: np.random.Generator) -> list[SensorLog]:
    """Another level in the second session."""
    log = drive(rng, num=int(rng.integers(120, 400)))
    half = len(log.ranges) // 2
    lost = np.isnan(log.ranges) | (rng.random(log.ranges.shape) < 0.02)
    late = np.arange(len(lost))[:, None] >= half
    for code_m, part in ((50.0, ~late), (51.15, late)):
        log.ranges = np.where(lost & part, code_m, log.ranges)
        log.codes.append((code_m, code_m))
        log.on_code.append(lost & part)
    return [log]


def two_sensors(rng: np.random.Generator) -> list[SensorLog]:
    front, rear = drive(rng, num=150), drive(rng, num=150)
    front.label, rear.label = "front", "rear"
    with_codes(rng, front, np.array([29.96 if front.laser.limit_m < 29 else 60.03]), share=0.02)
    with_codes(rng, rear, np.array([0.001]), share=0.05)
    return [front, rear]


def small_header(rng: np.random.Generator) -> list[SensorLog]:
    log = limit_code(rng)[0]
    log.header_m = 0.4 * log.laser.limit_m
    return [log]


def error_codes(rng: np.random.Generator) -> list[SensorLog]:
    log = drive(rng)
    with_codes(rng, log, np.array([81.83, 81.87, 81.9, 81.91]), share=float(10 ** rng.uniform(-3, -0.3)))
    return [log]


def still_with_code(rng: np.random.Generator) -> list[SensorLog]:
    log = still(rng, turning=bool(rng.integers(2)), num=int(rng.integers(100, 1000)))
    with_codes(rng, log, np.array([log.laser.limit_m + 0.15]), share=float(rng.uniform(0.002, 0.1)))
    return [log]


# Logs without codes.


def truncated(rng: np.random.Generator) -> list[SensorLog]:
    """The sensor says itself that nothing was hit."""
    return [drive(rng, num=int(np.exp(rng.uniform(np.log(2), np.log(1000)))))]


def standing(rng: np.random.Generator) -> list[SensorLog]:
    return [still(rng, turning=False, num=int(np.exp(rng.uniform(np.log(100), np.log(3000)))))]


def turning(rng: np.random.Generator) -> list[SensorLog]:
    return [still(rng, turning=True, num=int(np.exp(rng.uniform(np.log(50), np.log(1500)))))]


def along_wall(rng: np.random.Generator) -> list[SensorLog]:
    """At a distance that never changes, with boxes on the other side; now and then pillars in front of the wall."""
    num = int(rng.integers(50, 600))
    away_m = float(rng.uniform(0.5, 8.0))
    long_m = 0.3 * num + 20.0
    world = World((long_m, 20.0), faces=[Face((-20.0, 0.0), (long_m, 0.0))])
    for _ in range(num // 4):
        world.faces.extend(random_box(rng, (-20.0, away_m + 2.0), (long_m, away_m + 9.0), 1.0))
    if rng.random() < 0.5:
        gap_m = rng.uniform(0.5, 3.0)
        world.arcs = [Arc((x, 0.3 * away_m), 0.1) for x in np.arange(-20.0, long_m, gap_m)]
    poses = np.stack([0.3 * np.arange(num), np.full(num, away_m), np.zeros(num)], axis=1)
    return [in_world(rng, world, poses)]


def corridor(rng: np.random.Generator) -> list[SensorLog]:
    num = int(rng.integers(50, 600))
    long_m, half_m = float(rng.uniform(30, 120)), float(rng.uniform(0.8, 2.0))
    corners = np.array([[0, -half_m], [long_m, -half_m], [long_m, half_m], [0, half_m]])
    world = World((long_m, 2 * half_m), faces=polygon_faces(corners, 1.2, "wall"))
    for x in np.arange(2.0, long_m, rng.uniform(2, 8)):
        world.faces.append(Face((x, half_m - 0.1), (x + 0.9, half_m - 0.1)))
    x = 2.0 + (long_m - 4.0) * (0.5 - 0.5 * np.cos(np.linspace(0, rng.uniform(1, 12), num)))
    poses = np.stack([x, rng.normal(0, 0.05, num), rng.normal(0, 0.05, num)], axis=1)
    return [in_world(rng, world, poses)]


def glass_hall(rng: np.random.Generator) -> list[SensorLog]:
    log = drive(rng)
    log.ranges[rng.random(log.ranges.shape) < 0.5] = np.nan
    return [log]


def round_room(rng: np.random.Generator) -> list[SensorLog]:
    num, radius_m = int(rng.integers(5, 400)), float(rng.uniform(1.0, 10.0))
    world = World((2 * radius_m, 2 * radius_m), arcs=[Arc((0.0, 0.0), radius_m)])
    away = rng.choice([0.0, 0.02, 0.5]) * radius_m
    angle = np.cumsum(rng.uniform(0, 0.3, num))
    poses = np.stack([away * np.cos(angle), away * np.sin(angle), angle], axis=1)
    return [in_world(rng, world, poses)]


def small_room(rng: np.random.Generator) -> list[SensorLog]:
    num = int(rng.integers(2, 30))
    size_m = float(rng.uniform(2, 8))
    corners = np.array([[0, 0], [size_m, 0], [size_m, 0.7 * size_m], [0, 0.7 * size_m]])
    world = World((size_m, size_m), faces=polygon_faces(corners, 1.2, "wall"))
    poses = np.column_stack([rng.uniform(0.3, 0.5, (num, 2)) * size_m, rng.choice([0.0, np.pi / 2], num)])
    laser = random_laser(rng)
    laser = Laser(laser.num_beams, laser.fov_deg, float(rng.choice([0.0, laser.sigma_m])), laser.step_m, laser.limit_m)
    return [in_world(rng, world, poses, laser)]


def pillars(rng: np.random.Generator) -> list[SensorLog]:
    """Rows of equal pillars along the way, and a wall far behind them."""
    num, gap_m, row_m = int(rng.integers(50, 600)), float(rng.uniform(1.0, 5.0)), float(rng.uniform(1.0, 5.0))
    long_m, step_m = 0.37 * num + 30.0, 0.37
    world = World((long_m, 40.0), faces=[Face((-30.0, 15.0), (long_m, 15.0)), Face((-30.0, -9.0), (long_m, -9.0))])
    radius_m = float(rng.uniform(0.1, 0.4))
    for x in np.arange(-30.0, long_m, gap_m):
        world.arcs.extend([Arc((x, row_m), radius_m), Arc((x, -row_m), radius_m)])
    poses = np.stack([step_m * np.arange(num), np.zeros(num), np.zeros(num)], axis=1)
    return [in_world(rng, world, poses)]


def coarse_steps(rng: np.random.Generator) -> list[SensorLog]:
    log = drive(rng)
    log.ranges = np.round(np.round(log.ranges / 0.05) * 0.05, 4)
    return [log]


def far_facade(rng: np.random.Generator) -> list[SensorLog]:
    """One long wall far away, square-on, while the robot stands, turns or drives along a yard full of boxes."""
    num, away_m = int(rng.integers(50, 1500)), float(rng.uniform(15, 38))
    world = World((100, 50), faces=[Face((-100.0, away_m), (200.0, away_m))])
    for _ in range(60):
        world.faces.extend(random_box(rng, (-20.0, -15.0), (60.0, 14.0), 2.0))
    laser = random_laser(rng, 40.0)
    x = np.linspace(0, rng.choice([0.0, 40.0]), num)
    heading = np.pi / 2 + np.deg2rad(rng.choice([0.0, 5.0])) * np.sin(0.1 * np.arange(num))
    return [in_world(rng, world, np.stack([x, np.zeros(num), heading], axis=1), laser)]


CODED: dict[str, Callable[[np.random.Generator], list[SensorLog]]] = {
    "limit": limit_code,
    "inner": inner_code,
    "spread": spread_code,
    "millimetre": millimetre_code,
    "odd-longer": odd_longer,
    "changing": changing_code,
    "two-sensors": two_sensors,
    "small-header": small_header,
    "error-codes": error_codes,
    "still-with-code": still_with_code,
}
REAL: dict[str, Callable[[np.random.Generator], list[SensorLog]]] = {
    "truncated": truncated,
    "standing": standing,
    "turning": turning,
    "along-wall": along_wall,
    "corridor": corridor,
    "glass-hall": glass_hall,
    "round-room": round_room,
    "small-room": small_room,
    "pillars": pillars,
    "coarse-steps": coarse_steps,
    "far-facade": far_facade,
}
KINDS = {**CODED, **REAL}


def simulate_no_return_log(kind: str, seed: int) -> NoReturnLog:
    return NoReturnLog(kind, seed, KINDS[kind](stream(seed, f"no return {kind}")))
