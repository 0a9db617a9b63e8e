# SPDX-License-Identifier: GPL-3.0-or-later
"""Trajectories as TUM lines: `t x y z qx qy qz qw`, in the plane."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .poses import Array


def tum_line(timestamp_s: float, pose: Array) -> str:
    """`t x y z qx qy qz qw` and a line end."""
    x, y, theta = pose
    return f"{timestamp_s:.3f} {x:.9f} {y:.9f} 0 0 0 {np.sin(theta / 2):.12f} {np.cos(theta / 2):.12f}\n"


def parse_tum(text: str, name: str = "trajectory") -> dict[float, Array]:
    """Poses `[3]` by timestamp. Raises ValueError with `name` and line for what is no TUM line."""
    poses = {}
    for number, line in enumerate(text.splitlines(), 1):
        fields = line.split("#")[0].split()
        if not fields:
            continue
        try:
            t, x, y, _, _, _, qz, qw = (float(field) for field in fields)
        except ValueError:
            raise ValueError(f"{name}:{number}: expected 8 numbers, t x y z qx qy qz qw") from None
        poses[t] = np.array([x, y, 2.0 * np.arctan2(qz, qw)])
    return poses


def read_tum(path: Path) -> list[tuple[float, Array]]:
    """Time [s] and planar pose `[3]` of each line of a file."""
    return list(parse_tum(path.read_text(encoding="utf-8"), path.name).items())
