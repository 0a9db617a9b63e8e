# SPDX-License-Identifier: GPL-3.0-or-later
"""Traces of `shapemap-cli --trace` (docs/formats.md): what led to a map, step by step."""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.common.poses import Array, compose, transform

FORMAT, FORMAT_VERSION = "shapemap-trace", 1
RECORDS = ("run", "position", "alignment", "link", "choice", "revision", "result", "end")


@dataclass(frozen=True)
class ScanPosition:
    """One position, in the robot's frame: `scan_points[s]` `[n, 2]` and `segments[s]` `[m, 4]` (two ends) of each
    sub-scan, and the shape `points` `[k, 4]` (x, y, tangent, sub-scan). `histograms` `[k, 36]`, largest bin 1 unless
    the options say otherwise, only by the paper's method."""

    index: int
    index_in_whole_log: int
    timestamp_s: float
    scan_points: list[Array]
    segments: list[Array]
    points: Array
    histograms: Array | None

    def corrected_scan(self, robot_from_sub_scan: Array) -> Array:
        """All returns `[n, 2]`, each sub-scan with its correction."""
        return np.concatenate([transform(pose, part) for pose, part in zip(robot_from_sub_scan, self.scan_points)])

    def corrected_points(self, robot_from_sub_scan: Array) -> Array:
        """The shape points `[k, 2]` likewise."""
        poses = robot_from_sub_scan[self.points[:, 3].astype(int)]
        return compose(poses, np.pad(self.points[:, :2], ((0, 0), (0, 1))))[:, :2]


@dataclass(frozen=True)
class Trace:
    """`positions` and `results` by index; `alignments`, `links`, `choices` and `revisions` by the index of their
    query."""

    path: Path
    run: dict[str, Any]
    positions: dict[int, ScanPosition]
    alignments: dict[int, dict[str, Any]]
    links: dict[int, dict[str, Any]]
    results: dict[int, dict[str, Any]]
    largest_fragment: int
    choices: dict[int, dict[str, Any]] = field(default_factory=dict)
    revisions: dict[int, dict[str, Any]] = field(default_factory=dict)

    @property
    def method(self) -> str:
        return str(self.run["options"]["method"])

    @property
    def is_pairwise(self) -> bool:
        """Whether each scan was aligned to a single other one."""
        return self.method == "paper" and int(self.run["options"]["target-scans"]) == 1

    @property
    def placed(self) -> list[int]:
        """Indices of the positions in the map, in order."""
        return [i for i, result in sorted(self.results.items()) if result["fragment"] == self.largest_fragment >= 0]

    def map_poses(self) -> dict[int, Array]:
        """The poses `[3]` that the run ended with."""
        return {i: np.array(self.results[i]["fragment_from_robot"]) for i in self.placed}

    def shape_poses(self) -> dict[int, Array]:
        """The poses before ICP: those from shape alone, in a row. Empty for any method but the paper's."""
        poses: dict[int, Array] = {}
        for i in self.placed if self.method == "paper" else []:
            if self.results[i]["starts_fragment"]:
                poses[i] = np.zeros(3)
            else:
                step = self.alignments[i]
                poses[i] = compose(poses[step["reference"]], np.array(step["shape_ref_from_query"]))
        return poses

    def corrections(self, index: int) -> Array:
        """Poses `[s, 3]` of the sub-scans in the robot's frame, as decoupled ICP left them."""
        return np.array(self.results[index]["robot_from_sub_scan"]).reshape(-1, 3)


def is_trace(path: Path) -> bool:
    """Whether the file begins as a trace does."""
    try:
        with _opened(path) as lines:
            return next(lines, "").startswith('{"record":"run"')
    except (OSError, UnicodeDecodeError, EOFError):
        return False


def _opened(path: Path) -> Any:
    with path.open("rb") as file:
        packed = file.read(2) == b"\x1f\x8b"
    return gzip.open(path, "rt", encoding="utf-8") if packed else path.open(encoding="utf-8")


def _histograms(record: dict[str, Any], scale: float) -> Array | None:
    if "histograms" not in record:
        return None
    all_bins = np.zeros((len(record["histograms"]), 36))
    for row, pairs in zip(all_bins, record["histograms"]):
        row[pairs[::2]] = pairs[1::2]
    return all_bins / scale


def _position(record: dict[str, Any], scale: float) -> ScanPosition:
    return ScanPosition(
        index=record["index"],
        index_in_whole_log=record["index_in_whole_log"],
        timestamp_s=float("nan") if record["timestamp_s"] is None else record["timestamp_s"],
        scan_points=[np.array(part["scan_points"]).reshape(-1, 2) for part in record["sub_scans"]],
        segments=[np.array(part["segments"]).reshape(-1, 4) for part in record["sub_scans"]],
        points=np.array(record["points"]).reshape(-1, 4),
        histograms=_histograms(record, scale),
    )


def _records(path: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    with _opened(path) as lines:
        for number, line in enumerate(lines, 1):
            try:
                record = json.loads(line)
                kind = record["record"]
            except (ValueError, TypeError, KeyError):
                raise ValueError(f"{path}:{number}: not a record of a trace") from None
            if (number == 1) != (kind == "run"):
                raise ValueError(f"{path}:{number}: a trace begins with its only 'run' record, found '{kind}'")
            if kind == "run" and (record.get("format"), record.get("format_version")) != (FORMAT, FORMAT_VERSION):
                raise ValueError(f"{path}:{number}: expected {FORMAT}, version {FORMAT_VERSION}")
            if kind not in RECORDS:
                raise ValueError(f"{path}:{number}: '{kind}' is no record of a trace")
            yield kind, record


def read_trace(path: Path) -> Trace:
    """Raises ValueError naming file and line for what is no whole trace, OSError for what cannot be read."""
    found: dict[str, list[dict[str, Any]]] = {kind: [] for kind in RECORDS}
    positions: dict[int, ScanPosition] = {}
    for number, (kind, record) in enumerate(_records(path), 1):
        if kind == "position":
            try:
                position = _position(record, found["run"][0]["histogram_scale"])
            except (KeyError, TypeError, ValueError, IndexError) as error:
                raise ValueError(f"{path}:{number}: a 'position' record without or with a bad {error}") from None
            positions[position.index] = position
        else:
            found[kind].append(record)
    if not found["end"]:
        raise ValueError(f"{path}: the trace has no end; it was cut off")
    return Trace(
        path=path,
        run=found["run"][0],
        positions=positions,
        alignments={record["query"]: record for record in found["alignment"]},
        links={record["query"]: record for record in found["link"]},
        results={record["index"]: record for record in found["result"]},
        largest_fragment=found["end"][0]["largest_fragment"],
        choices={record["query"]: record for record in found["choice"]},
        revisions={record["query"]: record for record in found["revision"]},
    )
