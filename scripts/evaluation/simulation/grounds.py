# SPDX-License-Identifier: GPL-3.0-or-later
"""Large places of other kinds than offices and arenas: streets between buildings, corridors, an exhibition."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from evaluation.common.poses import Array, rotate

from .buildings import add_outline
from .clutter import Objects, leaves_free, make_box, make_odd_wall, make_tubes, outline_points, scatter, stands_apart
from .corridors import CorridorOptions, CorridorsOptions, corridors, long_corridor, route_of_crossings
from .long_walk import WalkOptions, follow, scanned, target
from .sensor import SensorOptions
from .simulation import Simulation
from .streams import stream
from .world import Arc, Face, World, polygon_faces, rectangle_corners

HIGH_M = 3.0
LASER = SensorOptions(num_beams=361, first_angle_deg=-90.0, angle_step_deg=0.5, max_range_m=50.0, range_sigma_m=0.02)
WALK = WalkOptions(num_scans=100_000, turn_deg=40.0)  # the route ends before
REACHED_M = 0.5


@dataclass(frozen=True)
class StreetOptions:
    """`blocks` buildings of about `building_m` each, with streets of `street_m` between and around them."""

    blocks: tuple[int, int] = (3, 2)
    building_m: tuple[float, float] = (42.0, 30.0)
    street_m: float = 16.0
    trees: int = 90
    cars: int = 50
    crossings: int = 22


@dataclass(frozen=True)
class HallOptions:
    """The way makes up to `turns` turns between partitions and showcases, of which those in its way are left out."""

    size_m: tuple[float, float] = (46.0, 30.0)
    partitions: int = 22
    showcases: int = 40
    turns: int = 26


def streets(seed: int, options: StreetOptions) -> World:
    """Outdoors: buildings with recesses, trees and parked cars; a way from crossing to crossing that comes by again."""
    rng = stream(seed, "streets")
    (columns, rows), street = options.blocks, options.street_m
    pitch = np.array(options.building_m) + street
    world = World((columns * pitch[0] + street, rows * pitch[1] + street))
    for column in range(columns):
        for row in range(rows):
            low = np.array([column, row]) * pitch + street
            world.faces += polygon_faces(_building(low, np.array(options.building_m), rng), HIGH_M, "building")
    _far_sides(world, rng)
    world.route = route_of_crossings(options.blocks, pitch, 0.5 * street, options.crossings, 2.0, rng)
    _put_up(options.trees, world, _tree, 1.0, rng)
    _put_up(options.cars, world, _car, 1.2, rng)
    return world


def _building(low: Array, size: Array, rng: np.random.Generator) -> Array:
    """Corners, counterclockwise: a rectangle with a recess in each of its sides, and slightly turned."""
    ends = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]) * size
    corners = []
    for start, end in zip(ends, np.roll(ends, -1, axis=0)):
        along = end - start
        inward = np.array([-along[1], along[0]]) / np.hypot(*along)
        first, last = np.sort(rng.uniform(0.15, 0.85, 2))
        deep = rng.uniform(0.4, 6.0) * inward
        corners += [start, start + first * along, start + first * along + deep, start + last * along + deep]
        corners += [start + last * along]
    middle = 0.5 * size
    return low + middle + rotate(np.array(corners) - middle, np.deg2rad(rng.uniform(-2.0, 2.0)))


def _far_sides(world: World, rng: np.random.Generator) -> None:
    """Pieces of fences and houses on the other side of the outer streets, with gaps."""
    width, depth = world.size_m
    corners = np.array([(0.0, 0.0), (width, 0.0), (width, depth), (0.0, depth)])
    for start, end in zip(corners, np.roll(corners, -1, axis=0)):
        along = end - start
        length = float(np.hypot(*along))
        at = 0.0
        while at < length:
            piece, gap, back = rng.uniform(4.0, 18.0), rng.uniform(1.0, 12.0), rng.uniform(0.0, 3.0)
            outward = back * np.array([along[1], -along[0]]) / length
            a, b = (start + min(m, length) / length * along + outward for m in (at, at + piece))
            world.faces.append(Face((a[0], a[1]), (b[0], b[1]), 0.0, HIGH_M, 0.0, "fence"))
            at += piece + gap


def _tree(centre: Array, angle_rad: float, rng: np.random.Generator) -> Objects:
    return [], [Arc(tuple(centre), float(rng.uniform(0.08, 0.35)), 0.0, 2.0 * np.pi, 0.0, HIGH_M, "tree")]


def _car(centre: Array, angle_rad: float, rng: np.random.Generator) -> Objects:
    along = np.round(angle_rad / (0.5 * np.pi)) * 0.5 * np.pi + rng.uniform(-0.1, 0.1)
    return polygon_faces(rectangle_corners(centre, rng.uniform(3.6, 4.8), 1.75, along), 1.4, "car"), []


def _put_up(
    num: int,
    world: World,
    make: Callable[[Array, float, np.random.Generator], Objects],
    clearance_m: float,
    rng: np.random.Generator,
) -> None:
    """In the open: not within buildings, which are known by their outlines alone."""
    outlines = outline_points([face for face in world.faces if face.kind == "building"], [], 0.5)
    for _ in range(num):
        for _ in range(40):
            centre = rng.uniform([0.0, 0.0], world.size_m)
            faces, arcs = make(centre, rng.uniform(-np.pi, np.pi), rng)
            points = outline_points(faces, arcs)
            is_free = leaves_free(points, world.route, clearance_m, world.size_m)
            if is_free and stands_apart(points, outlines, 0.5) and not _is_inside(centre, world):
                world.faces += faces
                world.arcs += arcs
                break


def _is_inside(point: Array, world: World) -> bool:
    """Whether a point lies in a building: a line to the left crosses its outline an odd number of times."""
    crossed = 0
    for face in world.faces:
        (ax, ay), (bx, by) = face.start, face.end
        if face.kind != "building" or (ay > point[1]) == (by > point[1]):
            continue
        crossed += int(ax + (point[1] - ay) / (by - ay) * (bx - ax) < point[0])
    return crossed % 2 == 1


def exhibition(seed: int, options: HallOptions) -> World:
    """One hall with partitions at any angle, showcases and pillars; the way wanders through it."""
    rng = stream(seed, "exhibition")
    world = World(options.size_m)
    add_outline(world)
    for x in np.arange(6.0, options.size_m[0] - 3.0, 8.0):
        for y in np.arange(6.0, options.size_m[1] - 3.0, 9.0):
            world.arcs.append(Arc((float(x), float(y)), 0.3, 0.0, 2.0 * np.pi, 0.0, HIGH_M, "pillar"))
    pillars = np.array([arc.centre for arc in world.arcs])
    route = [np.array([2.5, 2.5])]
    while len(route) < options.turns:
        place = rng.uniform([2.0, 2.0], np.array(options.size_m) - 2.0)
        way = np.linspace(route[-1], place, 60)
        if np.hypot(*(place - route[-1])) < 6.0 or np.hypot(*(way[:, None] - pillars).transpose(2, 0, 1)).min() < 1.0:
            continue
        route.append(place)
    world.route = np.array(route)
    scatter(options.partitions, world, 0.7, rng, makers=[(_partition, 1.0)])
    scatter(options.showcases, world, 0.6, rng, makers=[(make_box, 0.6), (make_odd_wall, 0.2), (make_tubes, 0.2)])
    return world


def _partition(centre: Array, angle_rad: float, rng: np.random.Generator) -> Objects:
    return polygon_faces(rectangle_corners(centre, rng.uniform(1.5, 5.0), 0.12, angle_rad), 2.0, "partition"), []


GROUNDS: dict[str, Callable[[int], World]] = {
    "streets": lambda seed: streets(seed, StreetOptions()),
    "corridors": lambda seed: corridors(seed, CorridorsOptions()),
    "long-corridor": lambda seed: long_corridor(seed, CorridorOptions()),
    "exhibition": lambda seed: exhibition(seed, HallOptions()),
}


def simulate_ground(name: str, seed: int, step_m: float) -> Simulation:
    """Along the route of a world, a scan each `step_m` or `WALK.turn_deg`."""
    world = GROUNDS[name](seed)
    goals = (target(place, REACHED_M) for place in world.route)
    poses, times_s = follow(goals, replace(WALK, step_m=step_m), stream(seed, "walk"))
    return scanned(seed, world, poses, times_s, LASER)
