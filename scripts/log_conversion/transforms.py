# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the lasers sit on the robot, from the transforms of a bag that never change."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

import numpy as np

from .model import Array, Mount

TOLERANCE = 1e-6  # metres and parts of a unit quaternion: rounding, where a program sends the same transform again
# Frames that stand in the world and not on the robot, by the conventions for mobile robots (REP 105). In a log of a
# robot that does not know where it is, they may never change, and are no part of the robot all the same.
WORLD_FRAMES = ("map", "odom", "earth", "world")
BASE_FRAME = "base_link"  # the robot's own, by the same conventions


@dataclass(frozen=True)
class Transform:
    """The pose of a frame in its parent's; the quaternion is x, y, z, w."""

    parent: str
    child: str
    translation_m: tuple[float, float, float]
    quaternion: tuple[float, float, float, float]

    def matrix(self) -> Array:
        """`parent_from_child` `[4, 4]`. A quaternion of length zero, which some programs write, turns nothing."""
        result = np.eye(4)
        result[:3, 3] = self.translation_m
        length = float(np.linalg.norm(self.quaternion))
        if length > 0.0 and np.isfinite(length):
            result[:3, :3] = rotation_matrix(np.array(self.quaternion) / length)
        return result

    def is_same(self, other: Transform) -> bool:
        if (self.parent, self.child) != (other.parent, other.child):
            return False
        shift = np.subtract(self.translation_m, other.translation_m)
        turn = [np.subtract(self.quaternion, other.quaternion), np.add(self.quaternion, other.quaternion)]
        return bool(np.abs(shift).max() <= TOLERANCE and min(np.abs(t).max() for t in turn) <= TOLERANCE)


def rotation_matrix(q: Array) -> Array:
    x, y, z, w = q
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def mount_of(robot_from_laser: Array) -> Mount:
    """Yaw, pitch and roll of the matrix. Where the laser looks straight up or down, yaw and roll are one turn, which is
    called yaw."""
    r = robot_from_laser[:3, :3]
    pitch = np.arctan2(-r[2, 0], np.hypot(r[0, 0], r[1, 0]))
    if np.hypot(r[0, 0], r[1, 0]) > TOLERANCE:
        yaw, roll = np.arctan2(r[1, 0], r[0, 0]), np.arctan2(r[2, 1], r[2, 2])
    else:
        yaw, roll = np.arctan2(-r[0, 1], r[1, 1]), 0.0
    x, y, z = map(float, robot_from_laser[:3, 3])
    return Mount(x, y, z, float(yaw), float(pitch), float(roll))


@dataclass
class FixedTransforms:
    """The transforms that never change in a log."""

    fixed: dict[str, Transform] = field(default_factory=dict)  # by child
    moving: set[str] = field(default_factory=set)

    def add(self, transform: Transform) -> None:
        child = transform.child
        if child in self.moving or not np.isfinite((*transform.translation_m, *transform.quaternion)).all():
            return
        if transform.parent.split("/")[-1] in WORLD_FRAMES or child.split("/")[-1] in WORLD_FRAMES:
            return
        known = self.fixed.setdefault(child, transform)
        if known is not transform and not known.is_same(transform):
            del self.fixed[child]
            self.moving.add(child)

    def mounts(self, frames: list[str]) -> tuple[str, dict[str, Mount]]:
        """The frame of the robot, and the mounts in it of the lasers that are joined to it by fixed transforms.

        The robot's frame is base_link where the first laser that has transforms is joined to it, otherwise the frame
        that this laser's transforms lead up to.
        """
        for frame in frames:
            reached = self._reached_from(frame)
            if len(reached) == 1:
                continue
            base = next((name for name in sorted(reached) if name.split("/")[-1] == BASE_FRAME), self._root(frame))
            robot_from = {name: np.linalg.inv(reached[base]) @ reached[name] for name in frames if name in reached}
            return base, {name: mount_of(matrix) for name, matrix in robot_from.items()}
        return "", {}

    def _root(self, frame: str) -> str:
        seen = {frame}
        while frame in self.fixed and self.fixed[frame].parent not in seen:
            frame = self.fixed[frame].parent
            seen.add(frame)
        return frame

    def _reached_from(self, frame: str) -> dict[str, Array]:
        """`frame_from_other` of all frames that fixed transforms join to one."""
        reached: dict[str, Array] = {frame: np.eye(4)}
        waiting = deque([frame])
        while waiting:
            at = waiting.popleft()
            for transform in self.fixed.values():
                for near, far, matrix in (
                    (transform.parent, transform.child, transform.matrix()),
                    (transform.child, transform.parent, np.linalg.inv(transform.matrix())),
                ):
                    if near == at and far not in reached:
                        reached[far] = reached[at] @ matrix
                        waiting.append(far)
        return reached
