# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that lie about in the arena. Each maker returns faces and arcs around a centre; `scatter` keeps only those
that leave the route free."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .poses import Array, rotate
from .world import Arc, Face, arc_outline, distance_to_polyline, face_outline, panel_faces, polygon_faces
from .world import rectangle_corners

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
    (make_box, 0.24), (make_rubble, 0.20), (make_slanted_board, 0.14), (make_odd_wall, 0.12), (make_barrel, 0.10),
    (make_curved_wall, 0.08), (make_tubes, 0.06), (make_step_field, 0.06),
]


def outline_points(faces: list[Face], arcs: list[Arc]) -> Array:
    """Points `[n, 2]` all around the objects, on the floor and at their tops, 5 cm apart or less."""
    pieces = [np.empty((0, 2))]
    for face in faces:
        for height in (face.bottom_m, face.top_m):
            start, end = face_outline(face, height)
            num = max(2, int(np.ceil(np.hypot(*(end - start)) / 0.05)) + 1)
            pieces.append(np.linspace(start, end, num))
    pieces += [arc_outline(arc) for arc in arcs]
    return np.concatenate(pieces)


def leaves_free(faces: list[Face], arcs: list[Arc], route: Array, clearance_m: float, size_m: tuple[float, float]) -> bool:
    """Whether the objects lie in the hall and keep `clearance_m` from the route `[n, 2]`."""
    points = outline_points(faces, arcs)
    inside = np.all((points >= 0.0) & (points <= np.array(size_m)))
    return bool(inside and distance_to_polyline(points, route).min() >= clearance_m)


def scatter(num_objects: int, route: Array, clearance_m: float, size_m: tuple[float, float],
            rng: np.random.Generator) -> Objects:
    """Up to `num_objects` random things; one that finds no room beside the route in 20 tries is left out."""
    faces: list[Face] = []
    arcs: list[Arc] = []
    shares = np.array([share for _, share in MAKERS])
    for _ in range(num_objects):
        maker = MAKERS[int(rng.choice(len(MAKERS), p=shares / shares.sum()))][0]
        for _ in range(20):
            centre = rng.uniform([0.0, 0.0], size_m)
            new_faces, new_arcs = maker(centre, rng.uniform(-np.pi, np.pi), rng)
            if leaves_free(new_faces, new_arcs, route, clearance_m, size_m):
                faces += new_faces
                arcs += new_arcs
                break
    return faces, arcs
