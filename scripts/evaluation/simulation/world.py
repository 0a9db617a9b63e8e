# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands in the hall: flat faces and round faces, each with a height interval, and the route between them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from evaluation.common.poses import Array, rotate

WALL_TOP_M = 1.2


@dataclass(frozen=True)
class Face:
    """A flat face over the segment `start`..`end` on the floor. `slant` is how far it leans per metre of height, to
    the left of start -> end."""

    start: tuple[float, float]
    end: tuple[float, float]
    bottom_m: float = 0.0
    top_m: float = WALL_TOP_M
    slant: float = 0.0
    kind: str = "wall"


@dataclass(frozen=True)
class Arc:
    """An upright round face: `span_rad` of a circle, counterclockwise from `first_rad`."""

    centre: tuple[float, float]
    radius_m: float
    first_rad: float = 0.0
    span_rad: float = 2.0 * np.pi
    bottom_m: float = 0.0
    top_m: float = WALL_TOP_M
    kind: str = "barrel"


@dataclass
class World:
    """Faces and arcs in the map frame, and the route `[n, 2]` a robot can drive without touching any of them."""

    size_m: tuple[float, float]
    faces: list[Face] = field(default_factory=list)
    arcs: list[Arc] = field(default_factory=list)
    route: Array = field(default_factory=lambda: np.empty((0, 2)))


def rectangle_corners(centre: Array, length_m: float, width_m: float, angle_rad: float) -> Array:
    """Corners `[4, 2]`, counterclockwise."""
    half = 0.5 * np.array([[-length_m, -width_m], [length_m, -width_m], [length_m, width_m], [-length_m, width_m]])
    return rotate(half, angle_rad) + np.asarray(centre)


def polygon_faces(corners: Array, top_m: float, kind: str) -> list[Face]:
    """The upright sides of a closed polygon `[n, 2]`."""
    following = np.roll(corners, -1, axis=0)
    return [Face(tuple(a), tuple(b), 0.0, top_m, 0.0, kind) for a, b in zip(corners, following)]


def panel_faces(start: Array, end: Array, kind: str = "wall", thickness_m: float = 0.04) -> list[Face]:
    """A wall panel of plywood, a little longer than start..end so that neighbours close at the posts."""
    along = end - start
    length = float(np.hypot(*along))
    corners = rectangle_corners(0.5 * (start + end), length + thickness_m, thickness_m, np.arctan2(along[1], along[0]))
    return polygon_faces(corners, WALL_TOP_M, kind)


def face_outline(face: Face, height_m: float) -> Array:
    """Where the face is cut at a height: its two ends `[2, 2]`."""
    start, end = np.array(face.start), np.array(face.end)
    along = (end - start) / np.hypot(*(end - start))
    return np.stack([start, end]) + face.slant * height_m * np.array([-along[1], along[0]])


def arc_outline(arc: Arc, step_m: float = 0.05) -> Array:
    """Points `[n, 2]` along the arc, its two ends included."""
    num = max(8, int(np.ceil(arc.radius_m * arc.span_rad / step_m))) + 1
    angles = arc.first_rad + np.linspace(0.0, arc.span_rad, num)
    return np.array(arc.centre) + arc.radius_m * np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def distance_to_polyline(points: Array, polyline: Array) -> Array:
    """Distance [m] of each of `[n, 2]` points to the nearest piece of a polyline `[m, 2]`, m >= 2."""
    start, along = polyline[:-1], np.diff(polyline, axis=0)
    offset = points[:, None, :] - start[None]
    length_squared = np.maximum((along**2).sum(axis=1), 1e-12)
    t = np.clip((offset * along[None]).sum(axis=2) / length_squared, 0.0, 1.0)
    return np.sqrt(((offset - t[..., None] * along[None]) ** 2).sum(axis=2)).min(axis=1)


def squared_distances(a: Array, b: Array) -> Array:
    """`[n, m]` squared distances between points `[n, 2]` and `[m, 2]`, good to about 1e-12 in halls of 20 m."""
    return np.maximum((a**2).sum(axis=1)[:, None] + (b**2).sum(axis=1)[None] - 2.0 * a @ b.T, 0.0)
