# SPDX-License-Identifier: GPL-3.0-or-later
"""An office floor: a corridor all around a core, with rooms on both of its sides."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from evaluation.common.poses import Array

from .buildings import DOOR_M, FURNITURE, add_outline, add_wall
from .clutter import scatter
from .streams import stream
from .world import World

DOOR_TO_WALL_M = 0.8
STROLL_M = 0.5  # around the middle of a room


@dataclass(frozen=True)
class OfficeOptions:
    """Outer rooms are `depth_m` deep; rooms are about `room_m` wide. Furniture keeps `clearance_m` from the ways."""

    size_m: tuple[float, float] = (40.0, 25.0)
    depth_m: float = 6.0
    corridor_m: float = 2.2
    room_m: float = 4.8
    objects: int = 160
    clearance_m: float = 0.75


@dataclass(frozen=True)
class Room:
    """`in_front` is on the middle line of the corridor before the door, `door` in it, `inside` behind it; around
    `middle` there is room to walk about."""

    in_front: Array
    door: Array
    inside: Array
    middle: Array


@dataclass(frozen=True)
class Office:
    """`ring` `[4, 2]`: corners of the middle line of the corridor, counterclockwise. `rooms` lists those along each of
    its sides, from its first corner on."""

    world: World
    ring: Array
    rooms: list[list[Room]]


@dataclass(frozen=True)
class _Side:
    """A side of the ring: from `start` in `direction`, `length_m` long. The core lies to its left."""

    start: Array
    direction: Array
    length_m: float

    def at(self, along_m: float, left_m: float) -> tuple[float, float]:
        point = self.start + along_m * self.direction + left_m * np.array([-self.direction[1], self.direction[0]])
        return float(point[0]), float(point[1])


def build_office(seed: int, options: OfficeOptions) -> Office:
    """Widths of the rooms, places of the doors and the furniture are drawn; the route goes once around, into every
    room."""
    rng = stream(seed, "office")
    world = World(options.size_m)
    add_outline(world)
    (width, depth), half = options.size_m, 0.5 * options.corridor_m
    low, right, high = options.depth_m + half, width - options.depth_m - half, depth - options.depth_m - half
    ring = np.array([(low, low), (right, low), (right, high), (low, high)])
    rooms = []
    for k in range(4):
        along = ring[(k + 1) % 4] - ring[k]
        length = float(np.hypot(*along))
        side = _Side(ring[k], along / length, length)
        rooms.append(_add_long(world, side, options, rng) if k % 2 == 0 else _add_short(world, side, options, rng))
    add_wall(world, (low + half, 0.5 * depth), (right - half, 0.5 * depth))
    world.route = _tour(ring, rooms)
    scatter(options.objects, world, options.clearance_m, stream(seed, "furniture"), makers=FURNITURE)
    return Office(world, ring, rooms)


def _add_long(world: World, side: _Side, options: OfficeOptions, rng: np.random.Generator) -> list[Room]:
    """Outer rooms up to the corners of the building, and inner rooms on the other side."""
    half, outer = 0.5 * options.corridor_m, options.depth_m
    inner = 0.5 * options.size_m[1] - outer - options.corridor_m
    doors, reach = (half, side.length_m - half), half + outer
    rooms = _add_row(world, side, (-reach, side.length_m + reach), (-half, -half - outer), doors, options.room_m, rng)
    rooms += _add_row(world, side, doors, (half, half + inner), doors, options.room_m, rng)
    return sorted(rooms, key=lambda room: float((room.in_front - side.start) @ side.direction))


def _add_short(world: World, side: _Side, options: OfficeOptions, rng: np.random.Generator) -> list[Room]:
    """Outer rooms between those of the long sides; a wall before the core."""
    half = 0.5 * options.corridor_m
    ends = (-half, side.length_m + half)
    add_wall(world, side.at(half, half), side.at(side.length_m - half, half))
    return _add_row(world, side, ends, (-half, -half - options.depth_m), ends, options.room_m, rng)


def _add_row(
    world: World,
    side: _Side,
    ends: tuple[float, float],
    left_m: tuple[float, float],
    doors: tuple[float, float],
    room_m: float,
    rng: np.random.Generator,
) -> list[Room]:
    """Rooms from `ends[0]` to `ends[1]` along the side. Their front is `left_m[0]` to the left of it, their back
    `left_m[1]`; their doors are between `doors`."""
    num = max(1, round((doors[1] - doors[0]) / room_m))
    cuts = np.linspace(doors[0], doors[1], num + 1)
    cuts[1:-1] += rng.uniform(-0.7, 0.7, num - 1)
    cuts[[0, -1]] = ends
    front, deep = left_m[0], left_m[1] - left_m[0]
    rooms = []
    for low, high in pairwise(cuts):
        nearest, farthest = max(low, doors[0]) + DOOR_TO_WALL_M, min(high, doors[1]) - DOOR_TO_WALL_M
        door = float(rng.uniform(nearest, farthest))
        add_wall(world, side.at(low, front), side.at(door - 0.5 * DOOR_M, front))
        add_wall(world, side.at(door + 0.5 * DOOR_M, front), side.at(high, front))
        middle = float(np.clip(0.5 * (low + high), door - 1.5, door + 1.5))
        places = (door, 0.0), (door, front), (door, front + 0.25 * deep), (middle, front + 0.5 * deep)
        rooms.append(Room(*(np.array(side.at(*place)) for place in places)))
    for cut in cuts[1:-1]:
        add_wall(world, side.at(cut, front), side.at(cut, left_m[1]))
    return rooms


def _tour(ring: Array, rooms: list[list[Room]]) -> Array:
    stroll = STROLL_M * np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, 0.0)])
    route = []
    for corner, along in zip(ring, rooms):
        route.append(corner)
        for room in along:
            way = [room.in_front, room.door, room.inside, room.middle]
            route += [*way, *(room.middle + stroll), *reversed(way)]
    return np.array([*route, ring[0]])
