# SPDX-License-Identifier: GPL-3.0-or-later
"""Ray casting of a level laser for logs of many scans: exact as `RayCaster`, and some twenty times as fast.

A surface is only compared with the beams between its two ends as seen from the laser, and many scans are cast at once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from evaluation.common.poses import Array, wrap_angle

from .world import World, face_outline

NEAREST_M = 1e-6
SLACK_RAD = 1e-9
SCANS_AT_ONCE = 64  # what they need fits into the caches

Pairs = tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]  # scan, beam, surface


class PlanarCaster:
    """What of a world stands in the plane of a level laser."""

    def __init__(self, world: World, height_m: float) -> None:
        faces = [face for face in world.faces if face.bottom_m <= height_m <= face.top_m]
        arcs = [arc for arc in world.arcs if arc.bottom_m <= height_m <= arc.top_m]
        ends = np.array([face_outline(face, height_m) for face in faces], dtype=float).reshape(-1, 2, 2)
        self._start, self._along = ends[:, 0], ends[:, 1] - ends[:, 0]
        self._centre = np.array([arc.centre for arc in arcs], dtype=float).reshape(-1, 2)
        self._radius = np.array([arc.radius_m for arc in arcs], dtype=float)
        self._first = np.array([arc.first_rad for arc in arcs], dtype=float)
        self._span = np.array([arc.span_rad for arc in arcs], dtype=float)

    def cast(self, poses: Array, first_rad: float, step_rad: float, num_beams: int) -> Array:
        """Ranges `[n, beams]` [m] from poses `[n, 3]`, inf where a beam meets nothing. Beam i points at `first_rad +
        i * step_rad` from the heading; all within one turn."""
        ranges = np.full((len(poses), num_beams), np.inf)
        for start in range(0, len(poses), SCANS_AT_ONCE):
            chunk = slice(start, start + SCANS_AT_ONCE)
            beams = _Beams(poses[chunk], first_rad, step_rad, num_beams)
            self._faces(beams, ranges[chunk])
            self._arcs(beams, ranges[chunk])
        return ranges

    def _faces(self, beams: _Beams, ranges: Array) -> None:
        """A face is met where origin + t direction = start + u along."""
        start = self._start - beams.origins[:, None]
        end = start + self._along
        first = np.arctan2(start[..., 1], start[..., 0])
        turn = wrap_angle(np.arctan2(end[..., 1], end[..., 0]) - first)
        scan, beam, face = beams.within(first + np.minimum(turn, 0.0), np.abs(turn))
        direction, offset, along = beams.directions[scan, beam], start[scan, face], self._along[face]
        with np.errstate(divide="ignore", invalid="ignore"):
            cross = _cross(direction, along)
            t, u = _cross(offset, along) / cross, _cross(offset, direction) / cross
        met = (t > NEAREST_M) & (u >= 0.0) & (u <= 1.0)
        np.minimum.at(ranges, (scan[met], beam[met]), t[met])

    def _arcs(self, beams: _Beams, ranges: Array) -> None:
        """The nearer of a circle's two crossings that lies on the arc; seen from within, it is all around."""
        towards = self._centre - beams.origins[:, None]
        distance = np.hypot(towards[..., 0], towards[..., 1])
        ratio = self._radius / np.maximum(distance, 1e-12)
        half = np.where(ratio < 1.0, np.arcsin(np.minimum(ratio, 1.0)), np.pi)
        scan, beam, arc = beams.within(np.arctan2(towards[..., 1], towards[..., 0]) - half, 2.0 * half)
        direction, to_centre, radius = beams.directions[scan, beam], towards[scan, arc], self._radius[arc]
        middle = (direction * to_centre).sum(axis=1)
        squared = middle**2 - (to_centre**2).sum(axis=1) + radius**2
        root = np.sqrt(np.maximum(squared, 0.0))
        for t in (middle - root, middle + root):
            hit = t[:, None] * direction - to_centre
            turn = np.mod(np.arctan2(hit[:, 1], hit[:, 0]) - self._first[arc], 2.0 * np.pi)
            met = (squared >= 0.0) & (t > NEAREST_M) & (turn <= self._span[arc])
            np.minimum.at(ranges, (scan[met], beam[met]), t[met])


class _Beams:
    """The beams of several scans."""

    def __init__(self, poses: Array, first_rad: float, step_rad: float, num_beams: int) -> None:
        angles = poses[:, 2, None] + first_rad + step_rad * np.arange(num_beams)
        self.origins = poses[:, :2]
        self.directions = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        self._first, self._step, self._num = angles[:, :1], step_rad, num_beams

    def within(self, first_rad: Array, span_rad: Array) -> Pairs:
        """The beams of each scan that lie within intervals of angles `[n, surfaces]`; maybe one twice."""
        from_first = np.mod(first_rad - self._first, 2.0 * np.pi)
        parts = []
        for low in (from_first, from_first - 2.0 * np.pi):
            first = np.maximum(np.ceil((low - SLACK_RAD) / self._step), 0).astype(np.intp)
            last = np.minimum(np.floor((low + span_rad + SLACK_RAD) / self._step), self._num - 1).astype(np.intp)
            scan, surface = np.nonzero(last >= first)
            count = (last - first + 1)[scan, surface]
            order = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
            beam = np.repeat(first[scan, surface], count) + order
            parts.append((np.repeat(scan, count), beam, np.repeat(surface, count)))
        scans, beams, surfaces = (np.concatenate(column) for column in zip(*parts))
        return scans, beams, surfaces


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
