# SPDX-License-Identifier: GPL-3.0-or-later
"""The ceiling of every score: each scan aligned to the one before it by the robust method's refinement (ICP to lines),
started at the reference pose, and the relative poses chained. It has no search, so what it misses no search can find;
it drifts, as any chain does."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from evaluation.common.poses import Array, compose, pose_error
from evaluation.common.programs import check_program
from evaluation.logs.evaluation_log import EvaluationLog
from evaluation.pairs.program import Program

from .trajectories import Fragment


def ceiling_trajectory(log: EvaluationLog, cli: Path, timeout_s: float) -> list[Fragment]:
    """No fragment for a log without reference poses. Raises Failure."""
    if log.reference is None:
        return []
    pairs = [(i, j, log.content.ref_from_query(i, j)) for i, j in log.content.pairs([1])]
    return chain(refined_poses(log, pairs, cli, timeout_s))


def ceiling_relation_errors(log: EvaluationLog, cli: Path, timeout_s: float) -> list[list[list[float] | None]]:
    """For each file: errors of its relations when the two scans of each are aligned, started at the relation itself;
    no chain. Raises Failure."""
    asked = {
        (relation.first, relation.second, relation.first_from_second): None
        for file in log.relations
        for relation in file.relations
    }
    pairs = [(i, j, np.array(pose)) for i, j, pose in asked]
    found = dict(zip(asked, refined_poses(log, pairs, cli, timeout_s)))
    return [
        [pose_errors(found[r.first, r.second, r.first_from_second], r.first_from_second) for r in file.relations]
        for file in log.relations
    ]


def pose_errors(found: list[float] | None, truth: tuple[float, float, float]) -> list[float] | None:
    return None if found is None else list(pose_error(np.array(found), np.array(truth)))


def refined_poses(
    log: EvaluationLog, pairs: list[tuple[int, int, Array]], cli: Path, timeout_s: float
) -> list[list[float] | None]:
    """The pose of each pair that the refinement reaches from the given one; None without shape. Raises Failure."""
    check_program(cli)
    lines = [f"{i} {j} {' '.join(repr(float(value)) for value in pose)}" for i, j, pose in pairs]
    answers = Program(cli, [], timeout_s).align(log.content, log.content, lines) if lines else []
    return [answer["refined"] and answer["refined"]["pose"] for answer in answers]


def chain(relative_poses: list[list[float] | None]) -> list[Fragment]:
    """Positions 0, 1, ... from the pose of each in the frame of the one before it; None begins a new fragment."""
    fragments: list[Fragment] = [{0: np.zeros(3)}]
    for position, relative in enumerate(relative_poses, 1):
        if relative is None:
            fragments.append({position: np.zeros(3)})
        else:
            fragments[-1][position] = compose(fragments[-1][position - 1], np.array(relative))
    return sorted(fragments, key=len, reverse=True)
