# SPDX-License-Identifier: GPL-3.0-or-later
"""One alignment of the paper's method with the coordinates behind its indices, and which one a figure should show."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from evaluation.common.poses import Array, compose, inverse, rotate, transform

from .trace import Trace

STAGES = ("lcs", "spread", "segments", "kept")
RIGHT_M = 0.20  # a correspondence whose points are nearer at the reference pose is right


@dataclass(frozen=True)
class Match:
    """All in the reference's frame [m]. `target_scan` and `query_scan` `[n, 2]` are the returns; the query is turned by
    the winning rotation and not moved. `pairs[stage]` `[n, 2, 2]` are target and query point of each correspondence."""

    reference: int
    query: int
    targets: list[int]
    rotation_rad: float
    target_scan: Array
    query_scan: Array
    pairs: dict[str, Array]
    segments: list[Array]
    ref_from_query: Array  # by shape, before ICP
    overlap_ratio: float

    @property
    def aligned_query_scan(self) -> Array:
        """The query's returns where the segment-wise translation puts them."""
        return self.query_scan + self.ref_from_query[:2]

    def is_right(self, stage: str, true_ref_from_query: Array) -> NDArray[np.bool_]:
        """Which correspondences join points that truly are one place."""
        pairs = self.pairs[stage]
        at_truth = transform(true_ref_from_query, rotate(pairs[:, 1], -self.rotation_rad))
        return np.hypot(*(at_truth - pairs[:, 0]).T) < RIGHT_M


def match_of(trace: Trace, query: int) -> Match:
    """The alignment of position `query`, which must have found a correspondence."""
    record = trace.alignments[query]
    rotation_rad = float(record["rotations"][record["best_rotation"]]["rotation_rad"])
    corrections = {t["position"]: np.array(t["robot_from_sub_scan"]) for t in record["targets"]}
    ref_from_robot = {t["position"]: np.array(t["ref_from_robot"]) for t in record["targets"]}
    target_points = {
        i: transform(ref_from_robot[i], trace.positions[i].corrected_points(corrections[i])) for i in ref_from_robot
    }
    scans = [transform(ref_from_robot[i], trace.positions[i].corrected_scan(corrections[i])) for i in ref_from_robot]
    turned = rotate(trace.positions[query].points[:, :2], rotation_rad)

    def coordinates(names: list[list[int]]) -> Array:
        pairs = [(target_points[scan][point], turned[k]) for k, scan, point in names]
        return np.array(pairs).reshape(-1, 2, 2)

    segments = [coordinates(segment) for segment in record["segments"]]
    stages: dict[str, Any] = {stage: coordinates(record[stage]) for stage in ("lcs", "spread", "kept")}
    stages["segments"] = np.concatenate([coordinates([]), *segments])
    return Match(
        reference=record["reference"],
        query=query,
        targets=list(ref_from_robot),
        rotation_rad=rotation_rad,
        target_scan=np.concatenate(scans),
        query_scan=rotate(np.concatenate(trace.positions[query].scan_points), rotation_rad),
        pairs=stages,
        segments=segments,
        ref_from_query=np.array(record["shape_ref_from_query"]),
        overlap_ratio=float(record["overlap_ratio"]),
    )


def true_step(reference: Mapping[int, Array], i: int, j: int) -> Array | None:
    """The reference pose of j in the frame of i, if both are known."""
    return compose(inverse(reference[i]), reference[j]) if i in reference and j in reference else None


def is_aligned(match: Match | None, status: str, truth: Array | None) -> bool:
    """Whether the shape alone gave the right pose; without reference poses, whether the alignment was trusted."""
    if match is None or truth is None:
        return match is not None and status == "ok"
    return float(np.hypot(*(match.ref_from_query - truth)[:2])) < RIGHT_M


def _shown(trace: Trace, query: int) -> Match | None:
    record = trace.alignments.get(query)
    return None if record is None or record["best_rotation"] is None else match_of(trace, query)


def _best(trace: Trace, value: Callable[[dict[str, Any]], tuple[float, ...]]) -> int | None:
    """The query of the alignment with the largest value; of equals the first."""
    found = [record for record in trace.alignments.values() if record["best_rotation"] is not None]
    return max(found, key=value)["query"] if found else None


def hard_pair(pairwise: Trace, main: Trace, reference: Mapping[int, Array]) -> int | None:
    """The query that the scan before it helps least and the partial map helps, for figures 2 and 3. With reference
    poses the first is where fewest correspondences are right, without them where the aligned scans overlap least."""

    def hardness(record: dict[str, Any]) -> tuple[float, ...]:
        query = record["query"]
        truth = true_step(reference, record["reference"], query)
        in_map = _shown(main, query)
        helped = is_aligned(in_map, main.alignments[query]["status"] if in_map else "", truth)
        alone = -float(record["overlap_ratio"])
        if truth is not None:
            match = match_of(pairwise, query)
            alone = -float(match.is_right("lcs", truth).sum()) / max(1, len(match.pairs["lcs"]))
        return helped, in_map is not None and len(in_map.targets) > 1, alone

    return _best(pairwise, hardness)


def filtered_pair(pairwise: Trace, reference: Mapping[int, Array]) -> int | None:
    """The query that shows best what the filters do, for figure 4. With reference poses that is where they drop most
    correspondences that are wrong and the pose is right, without them where they drop most."""

    def dropped(record: dict[str, Any]) -> tuple[float, ...]:
        match = match_of(pairwise, record["query"])
        count = float(len(match.pairs["lcs"]) - len(match.pairs["segments"]))
        truth = true_step(reference, record["reference"], record["query"])
        if truth is not None:
            count -= float(match.is_right("lcs", truth).sum()) - float(match.is_right("segments", truth).sum())
        return is_aligned(match, record["status"], truth), count

    return _best(pairwise, dropped)
