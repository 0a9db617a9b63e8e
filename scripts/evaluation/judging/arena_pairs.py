# SPDX-License-Identifier: GPL-3.0-or-later
"""How well each consecutive pair of positions was aligned, from a mapper's report and the truth."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from evaluation.common.poses import Array, compose, inverse, pose_error, pose_from, transform
from evaluation.simulation.sensor import points_of
from evaluation.simulation.simulation import Simulation

STAGES = ("before ICP", "after ICP", "after decoupled ICP")  # of the paper's method
ROBUST_STAGES = ("robust",)
MAX_ERROR_M = 0.30
MAX_ERROR_DEG = 5.0


@dataclass(frozen=True)
class StageError:
    """Errors of one stage of one pair. `displacement_m` is how far the points ended up from where they truly were,
    the mean over each sub-scan's points and then over the sub-scans."""

    error_m: float
    error_deg: float
    displacement_m: float

    @property
    def ok(self) -> bool:
        return self.error_m <= MAX_ERROR_M and self.error_deg <= MAX_ERROR_DEG


@dataclass(frozen=True)
class PairResult:
    """Position `index` against the one before it. `errors` by stage; None when the mapper did not trust its alignment
    or gave none: `reason` then says why. `sure`: the mapper has no doubts about the pose."""

    seed: int
    index: int
    overlap: float
    errors: Mapping[str, StageError] | None
    reason: str = ""
    sure: bool = False

    def verdict(self, stage: str) -> str:
        """ok, wrong (a pose beyond the limits) or rejected (no pose)."""
        if self.errors is None:
            return "rejected"
        return "ok" if self.errors[stage].ok else "wrong"

    @property
    def final_verdict(self) -> str:
        """The verdict on what the mapper used."""
        return self.verdict(list(self.errors)[-1]) if self.errors else "rejected"


def stages_of(pairs: Iterable[PairResult]) -> tuple[str, ...]:
    """The stages of the method that made the pairs; the paper's when there is no pose to tell it by."""
    return next((tuple(pair.errors) for pair in pairs if pair.errors), STAGES)


def mean_displacement(estimates: Array, truths: Array, points: list[Array]) -> float:
    """Mean over sub-scans of the mean distance [m] between a sub-scan's points `[n, 2]` under its estimated and under
    its true pose (`[s, 3]` each); sub-scans without points do not count."""
    distances = [
        np.hypot(*(transform(e, p) - transform(t, p)).T).mean() for e, t, p in zip(estimates, truths, points) if len(p)
    ]
    return float(np.mean(distances)) if distances else 0.0


@dataclass(frozen=True)
class PairTruth:
    """What is known about a pair. Poses of the query's sub-scans `[s, 3]`: `ref_from_sub_scan` as they truly stood,
    `query_from_nominal` as the log says. `points[s]` `[n, 2]` in the frame of the sub-scan."""

    ref_from_query: Array
    ref_from_sub_scan: Array
    query_from_nominal: Array
    points: list[Array]


def pair_truth(simulation: Simulation, index: int) -> PairTruth:
    """The truth about position `index` and the one before it."""
    run, beams = simulation.drive, simulation.options.sensor.beam_angles_rad()
    ref_from_map = inverse(run.map_from_robot[index - 1])
    nominal = np.zeros((len(run.nominal_headings_rad), 3))
    nominal[:, 2] = run.nominal_headings_rad
    return PairTruth(
        compose(ref_from_map, run.map_from_robot[index]),
        compose(ref_from_map, run.map_from_sub_scan[index]),
        nominal,
        [points_of(ranges, beams) for ranges in simulation.ranges[index]],
    )


def stage_error(ref_from_query: Array, corrections: Array, truth: PairTruth) -> StageError:
    """Errors of a pose `[3]` with corrections `[s, 3]` of the sub-scans. The pose that counts has the mean of the
    corrections in it, so that corrections all one way make it better or worse."""
    error_m, error_deg = pose_error(compose(ref_from_query, corrections.mean(axis=0)), truth.ref_from_query)
    estimates = compose(ref_from_query, compose(corrections, truth.query_from_nominal))
    return StageError(error_m, error_deg, mean_displacement(estimates, truth.ref_from_sub_scan, truth.points))


def stage_errors(alignment: Mapping[str, Any], truth: PairTruth) -> dict[str, StageError]:
    """Errors of an alignment that has a pose, by stage."""
    none = np.zeros_like(truth.query_from_nominal)
    found = alignment["query_from_sweep"]
    corrections = np.array([pose_from(pose) for pose in found]) if found else none
    if corrections.shape != none.shape:
        raise ValueError(f"the report has {len(corrections)} sub-scans where the log has {len(none)}")
    if alignment["shape_ref_from_query"] is None:
        return {ROBUST_STAGES[0]: stage_error(pose_from(alignment["ref_from_query"]), corrections, truth)}
    stages = (("shape_ref_from_query", none), ("icp_ref_from_query", none), ("ref_from_query", corrections))
    return {
        name: stage_error(pose_from(alignment[key]), applied, truth) for name, (key, applied) in zip(STAGES, stages)
    }


def evaluate_pairs(simulation: Simulation, report: Mapping[str, Any], overlaps: Array) -> list[PairResult]:
    """One result for every consecutive pair of the run; positions that the report lacks are rejected pairs."""
    entries = {entry["index"]: entry for entry in report["scans"]}
    results = []
    for index in range(1, len(simulation.ranges)):
        entry = entries.get(index)
        alignment = entry["alignment"] if entry else None
        errors, reason, sure = None, "not in the report", False
        if alignment and alignment.get("ref_from_query") and not entry.get("starts_component"):
            errors, reason = stage_errors(alignment, pair_truth(simulation, index)), ""
            sure = alignment["status"] == "ok"
        elif entry:
            status = alignment["status"] if alignment else "not aligned"
            reason = f"{status}: {entry['reason']}" if entry["reason"] else status
        results.append(PairResult(simulation.options.seed, index, float(overlaps[index - 1]), errors, reason, sure))
    return results


def lost_run(seed: int, overlaps: Array, reason: str) -> list[PairResult]:
    """All pairs of a run whose mapper gave no report: rejected, none forgotten."""
    return [PairResult(seed, k + 1, float(value), None, reason) for k, value in enumerate(overlaps)]
