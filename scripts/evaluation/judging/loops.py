# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the loops that a mapper closed are where the reference poses have them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from evaluation.common.poses import Array, compose, inverse, pose_error, pose_from, transform
from evaluation.common.tables import table as markdown
from evaluation.logs.evaluation_log import EvaluationLog
from evaluation.mapping.report import Report, place_in_log
from evaluation.simulation.simulation import overlap

FALSE, IMPRECISE, RIGHT = "false", "imprecise", "right"


@dataclass(frozen=True)
class Limits:
    """A loop that is off by more than these is false, or imprecise. The reference itself errs by 5 to 10 cm."""

    false_m: float = 1.0
    false_deg: float = 10.0
    imprecise_m: float = 0.3
    imprecise_deg: float = 3.0

    def verdict(self, error_m: float, error_deg: float) -> str:
        if not (error_m <= self.false_m and error_deg <= self.false_deg):  # what is no number is false
            return FALSE
        return RIGHT if error_m <= self.imprecise_m and error_deg <= self.imprecise_deg else IMPRECISE


@dataclass(frozen=True)
class CheckedLoop:
    """Positions `a` and `b` of the log. `agree_loop` and `agree_reference`: share of the points of b that lie on those
    of a, at the pose of the loop and at that of the reference; only of loops that are not right. Where the first is
    much the larger, the reference may be wrong."""

    a: int
    b: int
    error_m: float
    error_deg: float
    strength: float
    verdict: str
    agree_loop: float | None = None
    agree_reference: float | None = None


def agreement(log: EvaluationLog, a: int, b: int, a_from_b: Array) -> float:
    return overlap(transform(a_from_b, log.content.points[b]), log.content.points[a])


def check_loops(log: EvaluationLog, report: Report, limits: Limits) -> list[CheckedLoop]:
    """Each loop of a report on this log alone, strongest first."""
    checked = []
    for loop in report["loops"]:
        a, b = (place_in_log(report, loop[end])[1] for end in ("a", "b"))
        found, truth = pose_from(loop["a_from_b"]), log.content.ref_from_query(a, b)
        error_m, error_deg = pose_error(found, truth)
        verdict = limits.verdict(error_m, error_deg)
        shares: tuple[float, ...] = ()
        if verdict != RIGHT:
            shares = (agreement(log, a, b, found), agreement(log, a, b, truth))
        checked.append(CheckedLoop(a, b, error_m, error_deg, loop["strength"], verdict, *shares))
    return checked


def false_loops(report: Report, map_from_robot: Array) -> int:
    """How many loops of a report are false, by the reference poses `[p, 3]` of a log that was mapped alone."""
    verdicts = []
    for loop in report["loops"]:
        a, b = (place_in_log(report, loop[end])[1] for end in ("a", "b"))
        truth = compose(inverse(map_from_robot[a]), map_from_robot[b])
        verdicts.append(Limits().verdict(*pose_error(pose_from(loop["a_from_b"]), truth)))
    return verdicts.count(FALSE)


def num_of(loops: Sequence[CheckedLoop], verdict: str) -> int:
    return sum(loop.verdict == verdict for loop in loops)


def table(checked: dict[str, list[CheckedLoop]]) -> str:
    """A row for each log."""
    rows = []
    for name, loops in checked.items():
        worst_m = max((loop.error_m for loop in loops), default=math.nan)
        worst_deg = max((loop.error_deg for loop in loops), default=math.nan)
        worst = [f"{worst_m:.2f} m", f"{worst_deg:.1f} deg"] if loops else ["-", "-"]
        rows.append([name, len(loops), num_of(loops, FALSE), num_of(loops, IMPRECISE), *worst])
    return markdown(("log", "loops", "false", "imprecise", "worst", "worst turn"), rows)


def describe(name: str, loop: CheckedLoop) -> str:
    """A line on one that is not right."""
    agree = ""
    if loop.agree_loop is not None and loop.agree_reference is not None:
        agree = f"; points on points: {loop.agree_loop:.2f} at the loop, {loop.agree_reference:.2f} at the reference"
    return (
        f"{name}: {loop.verdict}: {loop.a} - {loop.b}, off by {loop.error_m:.2f} m and {loop.error_deg:.1f} deg, "
        f"strength {loop.strength:.1f}{agree}"
    )
