# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds beside the rescue arena: a furnished building, a bare corridor, a round room, two rooms that are alike."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from .clutter import Maker, make_barrel, make_box, make_odd_wall, make_rubble, make_tubes, scatter
from .streams import stream
from .world import Arc, World, panel_faces

FURNITURE: list[tuple[Maker, float]] = [
    (make_box, 0.5),
    (make_tubes, 0.2),
    (make_barrel, 0.1),
    (make_odd_wall, 0.1),
    (make_rubble, 0.1),
]
WALL_M = 0.12
DOOR_M = 0.95


@dataclass(frozen=True)
class BuildingOptions:
    """Three rooms on either side of a corridor. `glass`: the walls between corridor and rooms are of glass."""

    size_m: tuple[float, float] = (14.0, 10.5)
    corridor_m: tuple[float, float] = (4.4, 6.1)
    objects: int = 45
    clearance_m: float = 0.3
    glass: bool = False


def add_wall(world: World, start: tuple[float, float], end: tuple[float, float], kind: str = "wall") -> None:
    world.faces += panel_faces(np.array(start), np.array(end), kind, WALL_M)


def add_wall_with_door(world: World, y: float, ends: tuple[float, float], door_x: float, kind: str = "wall") -> None:
    """A wall along x at `y` with an opening around `door_x`."""
    add_wall(world, (ends[0], y), (door_x - 0.5 * DOOR_M, y), kind)
    add_wall(world, (door_x + 0.5 * DOOR_M, y), (ends[1], y), kind)


def add_outline(world: World) -> None:
    """Walls all around."""
    width, depth = world.size_m
    corners = [(0.0, 0.0), (width, 0.0), (width, depth), (0.0, depth)]
    for start, end in zip(corners, corners[1:] + corners[:1]):
        add_wall(world, start, end)


def furnished_building(seed: int, options: BuildingOptions) -> World:
    """Rooms of uneven width, their doors and their furniture are drawn; the route visits one room after the other."""
    rng = stream(seed, "building")
    (width, depth), (low, high) = options.size_m, options.corridor_m
    world = World(options.size_m)
    add_outline(world)
    kind = "glass" if options.glass else "wall"
    visits = []
    for y, far in ((low, 0.0), (high, depth)):
        cuts = np.array([0.0, 1.0, 2.0, 3.0]) * width / 3.0
        cuts[1:3] += rng.uniform(-0.8, 0.8, 2)
        for left, right in pairwise(cuts):
            door = rng.uniform(left + 0.9, right - 0.9)
            add_wall_with_door(world, y, (left, right), door, kind)
            visits.append((door, 0.5 * (y + far), 0.5 * (left + right)))
        for x in cuts[1:3]:
            add_wall(world, (x, y), (x, far))
    middle = 0.5 * (low + high)
    route = [(0.8, middle)]
    for door, room_y, room_x in sorted(visits):
        route += [(door, middle), (door, room_y), (room_x, room_y), (door, room_y), (door, middle)]
    world.route = np.array(route)
    scatter(options.objects, world, options.clearance_m, stream(seed, "furniture"), makers=FURNITURE)
    return world


def bare_corridor(length_m: float = 60.0, width_m: float = 2.4) -> World:
    """Two parallel walls and nothing else; its ends lie farther away than the laser sees."""
    world = World((length_m, width_m), route=np.array([(0.4 * length_m, 0.5 * width_m), (length_m, 0.5 * width_m)]))
    add_wall(world, (0.0, 0.0), (length_m, 0.0))
    add_wall(world, (length_m, width_m), (0.0, width_m))
    return world


def round_room(radius_m: float = 4.0) -> World:
    """A circular wall; the route leads across, past the middle."""
    world = World((2.0 * radius_m, 2.0 * radius_m), route=np.array([(0.25, 0.8), (1.75, 1.25)]) * radius_m)
    world.arcs.append(Arc((radius_m, radius_m), radius_m, kind="curved wall"))
    return world


def twin_rooms(seed: int, between_m: float = 0.0) -> World:
    """Two rooms with the same walls and the same furniture in the same places, one behind the other. The doors between
    them lie face to face, `between_m` apart, with a passage where that is not 0."""
    width, depth = 5.0, 4.2
    room = World((width, depth))
    door_y = 0.5 * depth
    room.route = np.array([(0.0, door_y), (width, door_y)])
    scatter(9, room, 0.35, stream(seed, "furniture"), makers=FURNITURE)
    pitch = width + between_m
    world = World((2.0 * width + between_m, depth))
    for offset in (0.0, pitch):
        world.faces += [
            replace(face, start=(face.start[0] + offset, face.start[1]), end=(face.end[0] + offset, face.end[1]))
            for face in room.faces
        ]
        world.arcs += [replace(arc, centre=(arc.centre[0] + offset, arc.centre[1])) for arc in room.arcs]
        for y in (0.0, depth):
            add_wall(world, (offset, y), (offset + width, y))
        for x in (offset, offset + width):
            add_wall(world, (x, 0.0), (x, door_y - 0.5 * DOOR_M))
            add_wall(world, (x, door_y + 0.5 * DOOR_M), (x, depth))
    if between_m > 0.0:
        for y in (door_y - 0.5 * DOOR_M, door_y + 0.5 * DOOR_M):
            add_wall(world, (width, y), (pitch, y))
    world.route = np.array([(0.9, door_y), (world.size_m[0] - 0.7, door_y)])
    return world
