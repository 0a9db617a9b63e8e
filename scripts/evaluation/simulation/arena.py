# SPDX-License-Identifier: GPL-3.0-or-later
"""The arena as a whole: plan, walls, clutter and route from a seed."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from evaluation.common.poses import Array, rotate

from .clutter import leaves_free, outline_points, scatter
from .maze import MazeOptions, cell_centres, doorway_panels, outer_panels, plan_openings, plan_route, wall_panels
from .streams import stream
from .world import World, panel_faces


@dataclass(frozen=True)
class ArenaOptions:
    """`clutter` 0 is a bare maze, 1 as full as it gets while one can still drive."""

    maze: MazeOptions = field(default_factory=MazeOptions)
    clutter: float = 0.8
    objects_at_full_clutter: int = 130
    num_doors: int = 3
    clearance_m: float = 0.25
    panel_jitter_m: float = 0.01
    turned_panel_share: float = 0.15


def turn_panel(
    panel: Array, route: Array, options: ArenaOptions, size_m: tuple[float, float], rng: np.random.Generator
) -> Array:
    """The panel `[2, 2]` swung about one end by 8 to 30 degrees, or as it was when that would block the route."""
    angle = np.deg2rad(rng.uniform(8.0, 30.0)) * rng.choice([-1.0, 1.0])
    swung = np.stack([panel[0], panel[0] + rotate(panel[1] - panel[0], angle)])
    points = outline_points(panel_faces(swung[0], swung[1]), [])
    return swung if leaves_free(points, route, options.clearance_m, size_m) else panel


def build_world(seed: int, options: ArenaOptions) -> World:
    """The arena of a seed; plan, walls and clutter draw from streams of their own."""
    maze = options.maze
    size = (maze.columns * maze.cell_m, maze.rows * maze.cell_m)
    plan_rng, wall_rng = stream(seed, "plan"), stream(seed, "walls")
    openings = plan_openings(maze, plan_rng)
    route = cell_centres(plan_route(openings, maze, plan_rng), maze)
    route = route + plan_rng.uniform(-maze.route_jitter_m, maze.route_jitter_m, size=route.shape)
    world = World(size_m=size, route=route)
    for panel in outer_panels(maze, options.num_doors, plan_rng):
        world.faces += panel_faces(panel[0], panel[1], "hall")
    for panel in wall_panels(openings, maze):
        ends = panel + wall_rng.normal(0.0, options.panel_jitter_m, size=(2, 2))
        if wall_rng.random() < options.turned_panel_share:
            ends = turn_panel(ends, route, options, size, wall_rng)
        world.faces += panel_faces(ends[0], ends[1], "wall")
    for panel in doorway_panels(openings, maze, stream(seed, "doorways")):
        faces = panel_faces(panel[0], panel[1], "wall")
        if leaves_free(outline_points(faces, []), route, options.clearance_m, size):
            world.faces += faces
    num_objects = round(options.clutter * options.objects_at_full_clutter)
    scatter(num_objects, world, options.clearance_m, stream(seed, "clutter"))
    return world
