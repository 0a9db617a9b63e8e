# SPDX-License-Identifier: GPL-3.0-or-later
"""What became of each pair: is the pose right, and if not, whose fault is it?"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from evaluation.common.poses import Array, pose_error, transform
from evaluation.judging import consecutive_pairs
from evaluation.logs.reference_log import ReferenceLog

NEIGHBOUR_M = 0.15  # points of two scans this close overlap
WITH_POSE = ("ok", "ambiguous", "degenerate")
DOUBT_MAX_M, DOUBT_MAX_DEG = 0.5, 25.0
SURE = 0.95
CHUNK = 512


@dataclass(frozen=True)
class PairOutcome:
    """`status` is the program's, or "crashed" when it gave no answer. Errors are of the first hypothesis, infinite
    without one; `rank` is the place of the first hypothesis that is right, from 0, -1 when there is none."""

    log: str
    gap: int
    reference: int
    query: int
    overlap: float
    rotation_deg: float
    true_pose: tuple[float, ...]
    status: str
    reason: str = ""
    probability: float = 0.0
    found_pose: tuple[float, ...] | None = None
    found_score: float | None = None
    given_score: float | None = None
    refined_score: float | None = None
    reference_score: float | None = None  # the better of the two; a refined pose that is not right does not count
    error_m: float = float("inf")
    error_deg: float = float("inf")
    rank: int = -1
    refined_is_right: bool = False
    in_doubt: bool = False  # failed, but the program has reason to think that the reference is wrong

    @property
    def first_is_right(self) -> bool:
        return self.rank == 0

    @property
    def is_right(self) -> bool:
        return self.first_is_right and self.status in WITH_POSE

    @property
    def failure(self) -> str:
        """Empty for a success; search: the true pose is not among the hypotheses; score: it is, but not the first;
        no pose: it is the first, but the program refused it, or gave no answer at all."""
        if self.is_right:
            return ""
        if self.status == "crashed" or self.first_is_right:
            return "no pose"
        return "search" if self.rank < 0 else "score"

    @property
    def reference_would_win(self) -> bool:
        """Failed by search alone: had the reference pose been among the hypotheses, it would have been the first."""
        if self.failure != "search" or self.reference_score is None:
            return False
        return self.found_score is None or self.reference_score > self.found_score


@dataclass(frozen=True)
class CrossOutcome:
    """A pair of positions from different places, which nothing should align."""

    reference_log: str
    query_log: str
    reference: int
    query: int
    status: str
    probability: float


def nearest_within(points: Array, others: Array, limit_m: float) -> int:
    """How many of `points` `[n, 2]` have one of `others` `[m, 2]` nearer than the limit."""
    if not len(points) or not len(others):
        return 0
    count = 0
    for first in range(0, len(points), CHUNK):
        part = points[first : first + CHUNK]
        squares = (part[:, None, 0] - others[None, :, 0]) ** 2 + (part[:, None, 1] - others[None, :, 1]) ** 2
        count += int(np.count_nonzero(squares.min(axis=1) < limit_m**2))
    return count


def overlap_of(reference: Array, query: Array, ref_from_query: Array) -> float:
    """Share of the points of both scans that have a neighbour in the other one."""
    total = len(reference) + len(query)
    if total == 0:
        return 0.0
    placed = transform(ref_from_query, query)
    near = nearest_within(reference, placed, NEIGHBOUR_M) + nearest_within(placed, reference, NEIGHBOUR_M)
    return near / total


def is_right(pose: Any, truth: Array) -> bool:
    return consecutive_pairs.is_right(*pose_error(np.array(pose), truth))


def reference_score_of(given: Mapping[str, Any] | None, refined: Mapping[str, Any] | None) -> float | None:
    return max((float(pose["score"]) for pose in (given, refined) if pose), default=None)


def judge(log: ReferenceLog, reference: int, query: int, answer: Mapping[str, Any], doubt_margin: float) -> PairOutcome:
    """The outcome of one line of the program's answer."""
    if (answer["reference"], answer["query"]) != (reference, query):
        raise ValueError(f"asked for {reference} {query}, answered {answer['reference']} {answer['query']}")
    truth = log.ref_from_query(reference, query)
    hypotheses, given, refined = answer["hypotheses"], answer["given"], answer["refined"]
    best = hypotheses[0] if hypotheses else None
    error_m, error_deg = pose_error(np.array(best["pose"]), truth) if best else (float("inf"), float("inf"))
    right = [is_right(hypothesis["pose"], truth) for hypothesis in hypotheses]
    refined_is_right = bool(refined) and is_right(refined["pose"], truth)
    reference_score = reference_score_of(given, refined if refined_is_right else None)
    doubt = False
    if best and reference_score is not None and not right[0]:
        near = error_m < DOUBT_MAX_M and error_deg < DOUBT_MAX_DEG
        doubt = near and best["score"] > reference_score + doubt_margin
    return PairOutcome(
        **about_pair(log, reference, query),
        status=answer["status"],
        reason=answer["reason"],
        probability=answer["probability"] or 0.0,
        found_pose=tuple(best["pose"]) if best else None,
        found_score=best["score"] if best else None,
        given_score=given["score"] if given else None,
        refined_score=refined["score"] if refined else None,
        error_m=error_m,
        error_deg=error_deg,
        rank=right.index(True) if any(right) else -1,
        reference_score=reference_score,
        refined_is_right=refined_is_right,
        in_doubt=doubt,
    )


def about_pair(log: ReferenceLog, reference: int, query: int) -> dict[str, Any]:
    """What is known of a pair before anything is aligned."""
    truth = log.ref_from_query(reference, query)
    return {
        "log": log.name,
        "gap": query - reference,
        "reference": reference,
        "query": query,
        "overlap": overlap_of(log.points[reference], log.points[query], truth),
        "rotation_deg": float(abs(np.rad2deg(truth[2]))),
        "true_pose": tuple(float(value) for value in truth),
    }


def crashed(log: ReferenceLog, pairs: list[tuple[int, int]], fault: str) -> list[PairOutcome]:
    """All pairs of a log to which the program gave no answer: failures, none forgotten."""
    return [PairOutcome(**about_pair(log, i, j), status="crashed", reason=fault) for i, j in pairs]
