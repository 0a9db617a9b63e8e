# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that lie about in the arena. Each maker returns faces and arcs around a centre; `scatter` keeps only those
that leave the route free and touch nothing else."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from evaluation.common.poses import Array, rotate

from .world import (
    Arc,
    Face,
    World,
    arc_outline,
    distance_to_polyline,
    face_outline,
    panel_faces,
    polygon_faces,
    rectangle_corners,
    squared_distances,
)

Objects = tuple[list[Face], list[Arc]]
Maker = Callable[[Array, float, np.random.Generator], Objects]


def make_box(centre: Array, angle_rad: float, rng: np.random.Generator) -> Objects:
    length, width, top = rng.uniform(0.2, 0.6), rng.uniform(0.2, 0.5), rng.uniform(0.25, 0.9)
    return polygon_faces(rectangle_corners(centre, length, width, angle_rad), top, "box"), []


def make_slanted_board(centre: Array, angle_rad: float, rng: np.random.Generator) -> Objects:
    """A board that leans by 15 to 50 degrees from the vertical."""
    half = rotate(np.array([0.5 * rng.uniform(0.5, 1.1), 0.0]), angle_rad)
    lean = np.tan(np.deg2rad(rng.uniform(15.0, 50.0)))
    top = rng.uniform(0.6, 1.0)
    return [Face(tuple(centre - half), tuple(centre + half), 0.0, top, lean, "board")], []


def make_barrel(centre: Array, angle_rad: float, rng: np.random.Generator) -> Objects:
    del angle_rad
    return [], [Arc(tuple(centre), rng.uniform(0.15, 0.30), top_m=0.9, kind="barrel")]


def make_tubes(centre: Array, angle_rad: float, rng: np.random.Generator) -> Objects:
    """A row of two to four upright tubes."""
    radius, pitch = rng.uniform(0.04, 0.08), rng.uniform(0.2, 0.3)
    places = [centre + rotate(np.array([i * pitch, 0.0]), angle_rad) for i in range(int(rng.integers(2, 5)))]
    return [], [Arc(tuple(place), radius, kind="tube") for place in places]


def make_curved_wall(centre: Array, angle_rad: float, rng: np.random.Generator) -> Objects:
    radius = rng.uniform(0.5, 1.1)
    span = rng.uniform(0.7, 1.2) / radius
    hub = centre - rotate(np.array([radius, 0.0]), angle_rad)
    return [], [Arc(tuple(hub), radius, angle_rad - 0.5 * span, span, kind="curved wall")]


def make_odd_wall(centre: Array, angle_rad: float, rng: np.random.Generator) -> Objects:
    half = rotate(np.array([0.5 * rng.uniform(0.6, 1.2), 0.0]), angle_rad)
    return panel_faces(centre - half, centre + half, "odd wall"), []


def make_rubble(centre: Array, angle_rad: float, rng: np.random.Generator) -> Objects:
    """A lump with three to six uneven sides."""
    corners = int(rng.integers(3, 7))
    angles = angle_rad + (np.arange(corners) + rng.uniform(-0.3, 0.3, corners)) * 2.0 * np.pi / corners
    radii = rng.uniform(0.08, 0.28, corners)
    outline = centre + radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return polygon_faces(outline, rng.uniform(0.3, 0.7), "rubble"), []


def make_step_field(centre: Array, angle_rad: float, rng: np.random.Generator) -> Objects:
    """Rows of 10 cm posts of uneven height; only those that reach the laser's plane are seen."""
    columns, rows, pitch = int(rng.integers(4, 7)), int(rng.integers(2, 5)), rng.uniform(0.13, 0.18)
    faces: list[Face] = []
    for i in range(columns):
        for j in range(rows):
            offset = np.array([i - 0.5 * (columns - 1), j - 0.5 * (rows - 1)]) * pitch
            corners = rectangle_corners(centre + rotate(offset, angle_rad), 0.1, 0.1, angle_rad)
            faces += polygon_faces(corners, rng.uniform(0.1, 0.6), "step field")
    return faces, []


MAKERS: list[tuple[Maker, float]] = [
    (make_box, 0.24),
    (make_rubble, 0.20),
    (make_slanted_board, 0.14),
    (make_odd_wall, 0.12),
    (make_barrel, 0.10),
    (make_curved_wall, 0.08),
    (make_tubes, 0.06),
    (make_step_field, 0.06),
]


def outline_points(faces: list[Face], arcs: list[Arc], step_m: float = 0.05) -> Array:
    """Points `[n, 2]` all around the objects, on the floor and, where a face leans, at its top, at most about
    `step_m` apart."""
    pieces = [arc_outline(arc) for arc in arcs]
    if faces:
        leaning = [face for face in faces if face.slant != 0.0]
        ends = np.array([(f.start, f.end) for f in faces] + [face_outline(f, f.top_m) for f in leaning])
        longest = np.hypot(*(ends[:, 1] - ends[:, 0]).T).max()
        t = np.linspace(0.0, 1.0, max(2, int(np.ceil(longest / step_m)) + 1))[:, None, None]
        pieces.append(((1.0 - t) * ends[:, 0] + t * ends[:, 1]).reshape(-1, 2))
    return np.concatenate([np.empty((0, 2)), *pieces])


def leaves_free(points: Array, route: Array, clearance_m: float, size_m: tuple[float, float]) -> bool:
    """Whether the points `[n, 2]` lie in the hall and keep `clearance_m` from the route `[m, 2]`."""
    inside = np.all((points >= 0.0) & (points <= np.array(size_m)))
    return bool(inside and distance_to_polyline(points, route).min() >= clearance_m)


def stands_apart(points: Array, others: Array, gap_m: float) -> bool:
    """Whether every point `[n, 2]` is at least `gap_m` from every other one `[m, 2]`."""
    near = np.all((others > points.min(axis=0) - gap_m) & (others < points.max(axis=0) + gap_m), axis=1)
    return not near.any() or bool(squared_distances(points, others[near]).min() >= gap_m**2)


def scatter(
    num_objects: int,
    world: World,
    clearance_m: float,
    rng: np.random.Generator,
    gap_m: float = 0.06,
    makers: Sequence[tuple[Maker, float]] = MAKERS,
) -> None:
    """Put up to `num_objects` random things between what stands there; one that finds no room beside the route in 20
    tries is left out. `makers` come with their shares."""
    taken = outline_points(world.faces, world.arcs)
    shares = np.array([share for _, share in makers])
    for _ in range(num_objects):
        maker = makers[int(rng.choice(len(makers), p=shares / shares.sum()))][0]
        for _ in range(20):
            centre = rng.uniform([0.0, 0.0], world.size_m)
            faces, arcs = maker(centre, rng.uniform(-np.pi, np.pi), rng)
            points = outline_points(faces, arcs)
            if leaves_free(points, world.route, clearance_m, world.size_m) and stands_apart(points, taken, gap_m):
                world.faces += faces
                world.arcs += arcs
                taken = np.concatenate([taken, points])
                break
