# SPDX-License-Identifier: GPL-3.0-or-later
"""What a method placed. A trajectory is a list of fragments, the largest first; each is a map of its own, with poses
`[3]` by position. Programs write one fragment today."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from evaluation.common.poses import Array
from evaluation.common.programs import Failure
from evaluation.common.tum import parse_tum

Fragment = dict[int, Array]


def read_trajectory(paths: Sequence[Path], num_positions: int) -> list[Fragment]:
    """One fragment from each file of TUM lines whose times are 1, 2, 3 ... s. Raises Failure that names file and line
    for what is no pose of a position, and for a position that comes twice."""
    fragments = [_read(path, num_positions) for path in paths]
    return sorted((fragment for fragment in fragments if fragment), key=len, reverse=True)


def _read(path: Path, num_positions: int) -> Fragment:
    fragment: Fragment = {}
    if not path.exists():
        raise Failure(f"wrote no {path.name}")
    for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        where = f"{path.name}:{number}"
        try:
            ((time, pose),) = parse_tum(line).items()
        except ValueError:
            raise Failure(f"{where}: no line of a trajectory: {line[:80]}") from None
        if not np.isfinite([time, *pose]).all():
            raise Failure(f"{where}: not finite: {line[:80]}")
        position = round(time) - 1
        if abs(time - 1 - position) > 1e-3 or not 0 <= position < num_positions:
            raise Failure(f"{where}: {time:g} is not the time of one of the {num_positions} positions")
        if position in fragment:
            raise Failure(f"{where}: position {position} comes twice")
        fragment[position] = pose
    return fragment


def as_lists(fragments: Sequence[Mapping[int, Array]]) -> list[list[list[float]]]:
    """The fragments for JSON: `position, x_m, y_m, theta_rad` of each."""
    return [
        [[position, *(round(float(value), 6) for value in fragment[position])] for position in sorted(fragment)]
        for fragment in fragments
    ]


def from_lists(fragments: Sequence[Sequence[Sequence[float]]]) -> list[Fragment]:
    return [{int(row[0]): np.array(row[1:4]) for row in fragment} for fragment in fragments]
