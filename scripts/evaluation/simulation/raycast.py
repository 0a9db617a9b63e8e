# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact ray casting against faces, arcs and the floor, vectorised over beams x surfaces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evaluation.common.poses import Array

from .world import World

PARALLEL = 1e-12
NEAREST_M = 1e-6


class RayCaster:
    """The world as flat arrays, made once and asked for many scans."""

    def __init__(self, world: World) -> None:
        starts = np.array([face.start for face in world.faces], dtype=float).reshape(-1, 2)
        ends = np.array([face.end for face in world.faces], dtype=float).reshape(-1, 2)
        self._start, self._end = starts, ends
        self._length = np.hypot(*(ends - starts).T)
        self._along = (ends - starts) / self._length[:, None]
        self._normal = np.stack([-self._along[:, 1], self._along[:, 0]], axis=-1)
        self._slant = np.array([face.slant for face in world.faces], dtype=float)
        self._face_z = np.array([(face.bottom_m, face.top_m) for face in world.faces], dtype=float).reshape(-1, 2)
        self._centre = np.array([arc.centre for arc in world.arcs], dtype=float).reshape(-1, 2)
        self._radius = np.array([arc.radius_m for arc in world.arcs], dtype=float)
        self._first = np.array([arc.first_rad for arc in world.arcs], dtype=float)
        self._span = np.array([arc.span_rad for arc in world.arcs], dtype=float)
        self._arc_z = np.array([(arc.bottom_m, arc.top_m) for arc in world.arcs], dtype=float).reshape(-1, 2)

    def cast(self, origin: Array, height_m: float, angles_rad: Array, slopes: Array) -> Array:
        """Range [m] along each beam to the first surface, inf where there is none.

        `origin` `[2]` in the map frame, `height_m` above the floor; beam i leaves in the direction `angles_rad[i]`
        of the map and climbs `slopes[i]` metres per horizontal metre.
        """
        directions = np.stack([np.cos(angles_rad), np.sin(angles_rad)], axis=-1)
        nearest = self._floor(height_m, slopes)
        ahead = self._ahead(origin, angles_rad)
        if ahead.any():
            nearest = np.minimum(nearest, self._faces(ahead, origin, height_m, directions, slopes).min(axis=1))
        if len(self._radius):
            nearest = np.minimum(nearest, self._arcs(origin, height_m, directions, slopes).min(axis=1))
        return nearest * np.sqrt(1.0 + slopes**2)

    def face_hit(self, origin: Array, height_m: float, angles_rad: Array, slopes: Array) -> NDArray[np.int64]:
        """Which flat face each beam meets first; -1 where it meets something round, the floor or nothing."""
        directions = np.stack([np.cos(angles_rad), np.sin(angles_rad)], axis=-1)
        every = np.ones(len(self._length), dtype=bool)
        if not every.any():
            return np.full(len(angles_rad), -1)
        distances = self._faces(every, origin, height_m, directions, slopes)
        nearest = self.cast(origin, height_m, angles_rad, slopes) / np.sqrt(1.0 + slopes**2)
        is_face = np.isfinite(nearest) & (distances.min(axis=1) <= nearest + NEAREST_M)
        return np.where(is_face, distances.argmin(axis=1), -1)

    @staticmethod
    def _floor(height_m: float, slopes: Array) -> Array:
        """Horizontal distance [m] at which a descending beam meets the floor."""
        return np.where(slopes < -PARALLEL, height_m / np.maximum(-slopes, PARALLEL), np.inf)

    def _ahead(self, origin: Array, angles_rad: Array) -> NDArray[np.bool_]:
        """`[faces]` of bool: False for faces that lie wholly beside the wedge of the beams; saves most of the work."""
        first, last = angles_rad.min(), angles_rad.max()
        if last - first > np.pi - PARALLEL:
            return np.ones(len(self._length), dtype=bool)
        right, left = np.array([-np.sin(first), np.cos(first)]), np.array([np.sin(last), -np.cos(last)])
        start, end = self._start - origin, self._end - origin
        beside = [(start @ inwards < -NEAREST_M) & (end @ inwards < -NEAREST_M) for inwards in (right, left)]
        return (self._slant != 0.0) | ~(beside[0] | beside[1])

    def _faces(
        self, ahead: NDArray[np.bool_], origin: Array, height_m: float, directions: Array, slopes: Array
    ) -> Array:
        """Horizontal distances `[beams, faces ahead]`. A face that leans by s per metre of height is met where
        normal . (origin + t direction - start) = s (height + t slope)."""
        along, normal, slant = self._along[ahead], self._normal[ahead], self._slant[ahead]
        offset = origin - self._start[ahead]
        numerator = slant * height_m - (normal * offset).sum(axis=1)
        denominator = directions @ normal.T - slopes[:, None] * slant
        with np.errstate(divide="ignore", invalid="ignore"):
            t = np.where(np.abs(denominator) > PARALLEL, numerator / denominator, np.inf)
            u = (along * offset).sum(axis=1) + t * (directions @ along.T)
            z = height_m + t * slopes[:, None]
            met = (t > NEAREST_M) & (u >= 0.0) & (u <= self._length[ahead]) & _between(z, self._face_z[ahead])
        return np.where(met, t, np.inf)

    def _arcs(self, origin: Array, height_m: float, directions: Array, slopes: Array) -> Array:
        """Horizontal distances `[beams, arcs]`: the nearer of the circle's two crossings that lies on the arc."""
        offset = origin - self._centre
        half_b = directions @ offset.T
        discriminant = half_b**2 - ((offset**2).sum(axis=1) - self._radius**2)
        root = np.sqrt(np.maximum(discriminant, 0.0))
        nearest = np.full(half_b.shape, np.inf)
        for t in (-half_b + root, -half_b - root):
            hit = offset[None] + t[..., None] * directions[:, None, :]
            turn = np.mod(np.arctan2(hit[..., 1], hit[..., 0]) - self._first, 2.0 * np.pi)
            z = height_m + t * slopes[:, None]
            met = (discriminant >= 0.0) & (t > NEAREST_M) & (turn <= self._span) & _between(z, self._arc_z)
            nearest = np.where(met & (t < nearest), t, nearest)
        return nearest


def _between(z: Array, limits: Array) -> NDArray[np.bool_]:
    return (z >= limits[:, 0]) & (z <= limits[:, 1])
