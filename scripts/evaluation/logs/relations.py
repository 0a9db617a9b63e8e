# SPDX-License-Identifier: GPL-3.0-or-later
"""Relations between scans, made by hand, and how well a trajectory keeps them (Kuemmerle et al. 2009).

Two kinds of files say the same: `.relations` has timestamps, `t1 t2 x y z roll pitch yaw`; `.scan_relations` has
indices of scans from 0, `i j dx dy dtheta`. Metres and radians; the pose is that of the second scan in the frame of the
first. The error of a relation is how far the estimated relative pose is from it, in metres and in degrees.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.common.poses import Array, compose, inverse

from .datasets import DatasetError

NEAR_S = 1e-4  # timestamps are written with six decimals
BAD_M = 0.5


@dataclass(frozen=True)
class Relation:
    """Indices are those of the log as it is mapped; `where` is file and line."""

    first: int
    second: int
    first_from_second: tuple[float, float, float]
    where: str


@dataclass(frozen=True)
class RelationFile:
    """`num_outside`: relations between scans that `every` and `first` leave out, or with a time that no scan has."""

    name: str
    relations: list[Relation]
    num_outside: int


def _numbers(line: str, count: int, where: str) -> list[float]:
    try:
        numbers = [float(word) for word in line.split()]
    except ValueError as error:
        raise DatasetError(f"{where}: {error}") from None
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise DatasetError(f"{where}: expected {count} finite numbers, found '{line.strip()}'")
    return numbers


class ScanIndex:
    """Which position of the mapped log a scan of the whole log is; None for one that is left out."""

    def __init__(self, timestamps_s: Sequence[float], every: int, num_positions: int) -> None:
        self._times = np.asarray(timestamps_s, dtype=np.float64)
        self._order = np.argsort(self._times, kind="stable")
        self._every, self._num_positions = every, num_positions

    @property
    def num_scans(self) -> int:
        return len(self._times)

    def position(self, scan: int) -> int | None:
        index, rest = divmod(scan, self._every)
        return None if rest or index >= self._num_positions else index

    def scan_at(self, time_s: float) -> int | None:
        """The first scan with this time."""
        at = int(np.searchsorted(self._times[self._order], time_s - NEAR_S))
        if at == len(self._order):
            return None
        scan = int(self._order[at])
        return scan if abs(self._times[scan] - time_s) <= NEAR_S else None


def read_relations(path: Path, index: ScanIndex) -> RelationFile:
    """Raises DatasetError that names file and line."""
    by_index = path.name.endswith(".scan_relations")
    relations: list[Relation] = []
    num_outside = 0
    for line_number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        where = f"{path}:{line_number}"
        numbers = _numbers(line, 5 if by_index else 8, where)
        pose = (numbers[2], numbers[3], numbers[4] if by_index else numbers[7])
        ends = [_scan(number, index, where) if by_index else index.scan_at(number) for number in numbers[:2]]
        places = [None if end is None else index.position(end) for end in ends]
        if places[0] is None or places[1] is None:
            num_outside += 1
        else:
            relations.append(Relation(places[0], places[1], pose, where))
    if not relations and not num_outside:
        raise DatasetError(f"{path}: no relation")
    return RelationFile(path.name, relations, num_outside)


def _scan(number: float, index: ScanIndex, where: str) -> int:
    if number != int(number) or not 0 <= number < index.num_scans:
        raise DatasetError(f"{where}: expected a scan from 0 to {index.num_scans - 1}, found {number:g}")
    return int(number)


def relation_errors(
    relations: Sequence[Relation], fragments: Sequence[Mapping[int, Array]]
) -> list[list[float] | None]:
    """Metres and degrees of each relation; None where not both of its scans are placed in one fragment."""
    errors: list[list[float] | None] = []
    for relation in relations:
        poses = next((f for f in fragments if relation.first in f and relation.second in f), None)
        if poses is None:
            errors.append(None)
            continue
        found = compose(inverse(poses[relation.first]), poses[relation.second])
        off = compose(inverse(np.array(relation.first_from_second)), found)
        errors.append([float(np.hypot(off[0], off[1])), float(abs(np.degrees(off[2])))])
    return errors


def summary(errors: Sequence[list[float] | None]) -> dict[str, Any]:
    """Mean and standard deviation of the absolute errors and of their squares, as in the publication, and more."""
    known = np.array([error for error in errors if error is not None]).reshape(-1, 2)
    result: dict[str, Any] = {"num": len(known), "num_missed": len(errors) - len(known)}
    if len(known):
        for column, unit in enumerate(("m", "deg")):
            values = known[:, column]
            result |= {f"mean_{unit}": float(values.mean()), f"sd_{unit}": float(values.std())}
            result |= {f"mean_squared_{unit}": float((values**2).mean()), f"median_{unit}": float(np.median(values))}
        result["share_over_half_m"] = float((known[:, 0] > BAD_M).mean())
    return result
