# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs with reference poses: the poses and the points for the judge, and the log without any pose for the program."""

from __future__ import annotations

import gzip
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TextIO

import numpy as np

from evaluation.common.poses import Array, compose, inverse
from evaluation.simulation.read import read_scan_log
from evaluation.simulation.sensor import points_of

FIRST_NO_RETURN_M = 81.8  # of SICK lasers; nearer maxima show as a value that comes over and over
FEWEST_ON_MAXIMUM = 10
STEPS_DEG = {180: 1.0, 181: 1.0, 360: 0.5, 361: 0.5}
LASER_MAXIMA = ("robot_front_laser_max", "robot_frontlaser_max")


@dataclass(frozen=True)
class ReferenceLog:
    """`map_from_robot` `[p, 3]`; `points[i]` `[n, 2]` are the returns of position i in its own frame [m]."""

    name: str
    ending: str
    without_poses: str = field(repr=False)
    map_from_robot: Array = field(repr=False)
    points: list[Array] = field(repr=False)

    def __len__(self) -> int:
        return len(self.map_from_robot)

    def ref_from_query(self, reference: int, query: int) -> Array:
        return compose(inverse(self.map_from_robot[reference]), self.map_from_robot[query])

    def pairs(self, gaps: list[int]) -> list[tuple[int, int]]:
        """All pairs of each gap, ordered by their reference."""
        return [(i, i + gap) for i in range(len(self)) for gap in gaps if i + gap < len(self)]


def opened(path: Path) -> TextIO:
    """A log to read as text, plain or gzip."""
    opener = gzip.open if path.suffix == ".gz" else open
    return opener(path, "rt", encoding="utf-8", errors="replace")


def reference_poses(path: Path) -> list[Array]:
    """x [m], y [m], heading [rad] of each FLASER line. Raises ValueError for one that is cut off."""
    with opened(path) as lines:
        return [pose for _, pose in _flasers(path.name, lines)]


def read_reference_log(path: Path, needs_poses: bool = True) -> ReferenceLog:
    """Raises ValueError for a log without reference poses, OSError for a file that cannot be read. A log that does not
    need poses and has none gets NaN."""
    with opened(path) as file:
        text = file.read()
    return _nist(path, text, needs_poses) if text.startswith("shapemap-scans") else _carmen(path.name, text)


def _nist(path: Path, text: str, needs_poses: bool) -> ReferenceLog:
    log = read_scan_log(path)
    poses = log.map_from_robot
    if poses is None:
        if needs_poses:
            raise ValueError(f"{path.name}: not every position has a reference pose")
        poses = np.full((len(log.timestamps_s), 3), np.nan)
    points = []
    for headings_rad, ranges in zip(log.nominal_headings_rad, log.ranges):
        parts = [points_of(sweep, log.beam_angles_rad + turn) for turn, sweep in zip(headings_rad, ranges)]
        points.append(np.concatenate(parts))
    return ReferenceLog(path.name, ".nist", strip_nist(text), poses, points)


def strip_nist(text: str) -> str:
    lines = []
    for line in text.splitlines():
        words = line.split()
        lines.append(" ".join(words[:2]) if words[:1] == ["position"] else line)
    return "\n".join(lines) + "\n"


def _carmen(name: str, text: str) -> ReferenceLog:
    found = list(_flasers(name, text.splitlines()))
    if not found:
        raise ValueError(f"{name}: no FLASER line")
    scans, poses = [scan for scan, _ in found], [pose for _, pose in found]
    maximum_m = no_return_m(scans)
    points = [
        points_of(np.where((scan > 0) & (scan < maximum_m), scan, np.nan), beam_angles_rad(len(scan))) for scan in scans
    ]
    return ReferenceLog(name, ".log", strip_carmen(text), np.array(poses), points)


def _flasers(name: str, lines: Iterable[str]) -> Iterator[tuple[Array, Array]]:
    """Readings and pose of each FLASER line. Raises ValueError that names file and line."""
    for number, words in enumerate(map(str.split, lines), 1):
        if words[:1] == ["FLASER"]:
            try:
                yield _flaser(words)
            except (ValueError, IndexError) as error:
                raise ValueError(f"{name}:{number}: {error}") from None


def _flaser(words: list[str]) -> tuple[Array, Array]:
    """Readings and pose."""
    count = int(words[1])
    pose = [float(word) for word in words[2 + count : 5 + count]]
    if len(pose) < 3 or not np.isfinite(pose).all():
        raise ValueError(f"expected {count} readings and a pose of three numbers")
    return np.array([float(word) for word in words[2 : 2 + count]]), np.array(pose)


def strip_carmen(text: str) -> str:
    """Scans, times and the laser's maximum; zeros for the poses."""
    lines = []
    for words in map(str.split, text.splitlines()):
        if words[:1] == ["FLASER"]:
            count = int(words[1])
            lines.append(" ".join([*words[: 2 + count], *["0"] * 6, *words[8 + count :]]))
        elif words[:1] == ["PARAM"] and words[1:2] and words[1] in LASER_MAXIMA:
            lines.append(" ".join(words))
    return "\n".join(lines) + "\n"


def beam_angles_rad(num_beams: int) -> Array:
    """The convention of FLASER lines. Raises ValueError where there is none."""
    if num_beams not in STEPS_DEG:
        raise ValueError(f"a FLASER with {num_beams} readings has no convention for its angles")
    return np.deg2rad(-90.0 + STEPS_DEG[num_beams] * np.arange(num_beams))


def no_return_m(scans: list[Array]) -> float:
    """From where on readings are no returns: the longest distance in the log, if it comes over and over."""
    far = Counter(float(r) for scan in scans for r in scan if r < FIRST_NO_RETURN_M)
    longest_m = max(far, default=FIRST_NO_RETURN_M)
    return longest_m if far[longest_m] >= FEWEST_ON_MAXIMUM else FIRST_NO_RETURN_M
