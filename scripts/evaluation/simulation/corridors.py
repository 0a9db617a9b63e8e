# SPDX-License-Identifier: GPL-3.0-or-later
"""Corridors with doors, most of them closed: a long one there and back, and a building of many that look alike."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from evaluation.common.poses import Array

from .buildings import FURNITURE, add_wall
from .clutter import scatter
from .streams import stream
from .world import Face, World, polygon_faces, rectangle_corners

HIGH_M = 3.0
ON_THE_WAY_M = 0.3  # a robot goes so far aside of the middle of a corridor


@dataclass(frozen=True)
class DoorOptions:
    """Closed doors lie `recess_m` behind the walls, one every `every_m` or so; `open_share` of them are open."""

    every_m: float = 4.5
    recess_m: tuple[float, float] = (0.06, 0.2)
    open_share: float = 0.12
    room_m: float = 4.0


@dataclass(frozen=True)
class CorridorOptions:
    """One corridor, with `side_corridors` that lead nowhere."""

    length_m: float = 150.0
    width_m: float = 2.6
    side_corridors: int = 3
    objects: int = 25
    doors: DoorOptions = field(default_factory=DoorOptions)


@dataclass(frozen=True)
class CorridorsOptions:
    """`blocks` of `block_m` each, with corridors of the same width between and around them; `things` stand along their
    walls."""

    blocks: tuple[int, int] = (2, 2)
    block_m: tuple[float, float] = (44.0, 28.0)
    width_m: float = 2.6
    crossings: int = 18
    things: int = 70
    doors: DoorOptions = field(default_factory=DoorOptions)


@dataclass(frozen=True)
class _Wall:
    """From `start`, `length_m` long in direction `along`; what is behind it lies towards `out`."""

    start: Array
    along: Array
    out: Array
    length_m: float

    def at(self, along_m: float, out_m: float = 0.0) -> tuple[float, float]:
        point = self.start + along_m * self.along + out_m * self.out
        return float(point[0]), float(point[1])


def long_corridor(seed: int, options: CorridorOptions) -> World:
    """Walls with doors, most of them closed, and a few corridors aside; there and back again."""
    rng = stream(seed, "long corridor")
    length, width, room = options.length_m, options.width_m, options.doors.room_m
    world = World((length, 2.0 * room + width))
    sides = np.sort(rng.uniform(0.1, 0.9, options.side_corridors)) * length
    for k, (y, out) in enumerate(((room, -1.0), (room + width, 1.0))):
        wall = _Wall(np.array([0.0, y]), np.array([1.0, 0.0]), np.array([0.0, out]), length)
        _add_wall_with_doors(world, wall, sides[k::2], options.doors, rng)
    for x in (0.0, length):
        add_wall(world, (x, room), (x, room + width))
    middle = room + 0.5 * width
    there = np.array([(1.0, middle), (0.35 * length, middle), (0.7 * length, middle), (length - 1.0, middle)])
    world.route = np.concatenate([there, there[::-1][1:]])
    scatter(options.objects, world, 0.7, rng, makers=FURNITURE)
    return world


def corridors(seed: int, options: CorridorsOptions) -> World:
    """A building of corridors that all look alike; a way from crossing to crossing that comes by again."""
    rng = stream(seed, "corridors")
    width, margin = options.width_m, options.doors.room_m
    pitch = np.array(options.block_m) + width
    size = np.array(options.blocks) * pitch + width + 2.0 * margin
    world = World((float(size[0]), float(size[1])))
    for column in range(options.blocks[0]):
        for row in range(options.blocks[1]):
            low = np.array([column, row]) * pitch + width + margin
            _add_rectangle(world, low, low + np.array(options.block_m), 1.0, options.doors, rng)
    _add_rectangle(world, np.full(2, margin), size - margin, -1.0, options.doors, rng)
    half = 0.5 * width
    world.route = margin + route_of_crossings(options.blocks, pitch, half, options.crossings, ON_THE_WAY_M, rng)
    for _ in range(options.things):
        world.faces += _thing_by_the_wall(options, pitch, rng)
    return world


def _thing_by_the_wall(options: CorridorsOptions, pitch: Array, rng: np.random.Generator) -> list[Face]:
    """Somewhere along a side of a block."""
    block = rng.integers([0, 0], options.blocks)
    low = block * pitch + options.width_m + options.doors.room_m
    side, far_end = int(rng.integers(2)), bool(rng.integers(2))  # along x or y, at the low or the high end of the other
    long, deep = rng.uniform(0.3, 1.6), rng.uniform(0.1, 0.4)
    size = np.array([deep, deep])
    size[side] = long
    corner = low + rng.uniform(1.0, np.array(options.block_m) - 1.0 - long)
    corner[1 - side] = low[1 - side] + (options.block_m[1 - side] if far_end else -deep)
    return polygon_faces(rectangle_corners(corner + 0.5 * size, size[0], size[1], 0.0), HIGH_M, "thing")


def _add_rectangle(
    world: World, low: Array, high: Array, inward: float, doors: DoorOptions, rng: np.random.Generator
) -> None:
    """Walls with doors all around, which lead into it for `inward` 1, out of it for -1."""
    corners = np.array([low, (high[0], low[1]), high, (low[0], high[1])])
    for start, end in zip(corners, np.roll(corners, -1, axis=0)):
        length = float(np.hypot(*(end - start)))
        along = (end - start) / length
        _add_wall_with_doors(
            world, _Wall(start, along, inward * np.array([-along[1], along[0]]), length), np.empty(0), doors, rng
        )


def _add_wall_with_doors(
    world: World, wall: _Wall, sides: Array, options: DoorOptions, rng: np.random.Generator
) -> None:
    """Doors and rooms lead out, and wide corridors at `sides`."""
    at = 0.0
    while at < wall.length_m:
        piece = min(options.every_m * rng.uniform(0.5, 1.5), wall.length_m - at)
        aside = sides[(sides > at) & (sides < at + piece + 2.0)]
        opening = float(rng.uniform(1.8, 2.4)) if len(aside) else 0.95
        add_wall(world, wall.at(at), wall.at(at + piece))
        at += piece
        if at + opening >= wall.length_m:
            add_wall(world, wall.at(at), wall.at(wall.length_m))
            return
        is_open = len(aside) > 0 or rng.random() < options.open_share
        deep = options.room_m if is_open else float(rng.uniform(*options.recess_m))
        far = at + opening + (rng.uniform(0.0, 2.5) if is_open and not len(aside) else 0.0)
        for start, end in (((at, 0.0), (at, deep)), ((at, deep), (far, deep)), ((far, deep), (far, 0.0))):
            add_wall(world, wall.at(*start), wall.at(*end))
        if far > at + opening:
            add_wall(world, wall.at(at + opening), wall.at(far))
        at = far


def route_of_crossings(
    blocks: tuple[int, int], pitch: Array, half_m: float, num: int, aside_m: float, rng: np.random.Generator
) -> Array:
    """From crossing to crossing of a grid, seldom back at once, and rather where it has not been. The ways are
    2 `half_m` wide, `pitch` apart."""
    at, before = (0, 0), (-1, -1)
    visits: dict[frozenset[tuple[int, int]], int] = {}
    route = [np.array([half_m, half_m])]
    for _ in range(num):
        ways = [(at[0] + dx, at[1] + dy) for dx, dy in ((1, 0), (0, 1), (-1, 0), (0, -1))]
        ways = [w for w in ways if 0 <= w[0] <= blocks[0] and 0 <= w[1] <= blocks[1] and w != before]
        cost = [visits.get(frozenset((at, way)), 0) + rng.uniform(0.0, 0.9) for way in ways]
        way = ways[int(np.argmin(cost))]
        visits[frozenset((at, way))] = visits.get(frozenset((at, way)), 0) + 1
        at, before = way, at
        route.append(np.array(at) * pitch + half_m + rng.uniform(-aside_m, aside_m, 2))
    return np.array(route)
