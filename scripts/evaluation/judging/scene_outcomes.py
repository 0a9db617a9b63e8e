# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mapper said about each consecutive pair of positions, beside the truth: its pose, and how sure it was."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from evaluation.common.poses import Array, compose, inverse, pose_from, rotate
from evaluation.common.tum import parse_tum
from evaluation.simulation.simulation import Simulation, consecutive_overlaps

RIGHT_M = 0.20
RIGHT_DEG = 5.0
SURE = 0.95  # the mapper's own threshold for `ok`


@dataclass(frozen=True)
class PairOutcome:
    """Position `index` in the frame of its reference: the one before it, unless the mapper aligned it to another. The
    estimate is that of the report, also of pairs outside of the map, and NaN where there is none; probability NaN and
    covariance None where the report does not say them."""

    index: int
    overlap: float
    status: str
    reason: str
    probability: float
    covariance: Array | None
    ref_from_query: Array
    true_ref_from_query: Array
    ref_heading_rad: float
    reference: int | None = None  # None: index - 1

    @property
    def error(self) -> Array:
        """`[3]`: x, y along the axes of the map, and heading."""
        turn = compose(inverse(self.true_ref_from_query), self.ref_from_query)[2]
        shift = rotate(self.ref_from_query[:2] - self.true_ref_from_query[:2], self.ref_heading_rad)
        return np.array([shift[0], shift[1], turn])

    @property
    def error_m(self) -> float:
        return float(np.hypot(self.error[0], self.error[1]))

    @property
    def error_deg(self) -> float:
        return float(abs(np.rad2deg(self.error[2])))

    @property
    def right(self) -> bool:
        return self.error_m <= RIGHT_M and self.error_deg <= RIGHT_DEG

    @property
    def called_ok(self) -> bool:
        return self.status == "ok"

    def deviation_m(self, map_direction: tuple[float, float]) -> float:
        """Standard deviation of the position along a direction of the map; NaN where none is stated."""
        if self.covariance is None:
            return float("nan")
        direction = rotate(np.array(map_direction), -self.ref_heading_rad)
        return float(np.sqrt(direction @ self.covariance[:2, :2] @ direction))

    @property
    def deviation_deg(self) -> float:
        """Standard deviation of the heading; NaN where none is stated."""
        return float("nan") if self.covariance is None else float(np.rad2deg(np.sqrt(self.covariance[2, 2])))

    @property
    def falsely_certain(self) -> bool:
        """Wrong, and yet called ok; or called degenerate, sure of its place, and off in directions said to be held."""
        if self.right or not np.isfinite(self.error_m):
            return False
        if self.status == "degenerate" and self.covariance is not None and self.probability >= SURE:
            error = np.append(rotate(self.error[:2], -self.ref_heading_rad), self.error[2])
            return bool(error @ np.linalg.solve(self.covariance, error) > 5.0**2)
        return self.called_ok


def covariance_from(value: Any) -> Array | None:
    """`[3, 3]` from nine numbers, however nested, in metres and radians; None without."""
    if value is None:
        return None
    numbers = np.array(value, dtype=float).reshape(-1)
    return numbers.reshape(3, 3) if numbers.size == 9 and np.isfinite(numbers).all() else None


def estimated_pose(alignment: Mapping[str, Any], from_path: Array) -> Array:
    """`[3]`: that of the report or, where it has none although the pair is in the map, that of the trajectory."""
    fields = alignment.get("ref_from_query")
    return from_path if fields is None else pose_from(fields)


def pair_outcomes(simulation: Simulation, report: Mapping[str, Any], trajectory: str) -> list[PairOutcome]:
    """One outcome for each position but the first: the pair that it makes with its reference."""
    placed, entries = parse_tum(trajectory), {entry["index"]: entry for entry in report["scans"]}
    overlaps, truth = consecutive_overlaps(simulation), simulation.drive.map_from_robot
    nowhere = np.full(3, np.nan)
    poses = [placed.get(round(float(t), 3), nowhere) for t in simulation.drive.timestamps_s]
    outcomes = []
    for k in range(1, len(truth)):
        entry = entries.get(k, {})
        alignment = entry.get("alignment") or {}
        probability = alignment.get("probability")
        reference = alignment.get("reference")
        r = k - 1 if reference is None else int(reference)
        outcomes.append(
            PairOutcome(
                index=k,
                overlap=float(overlaps[k - 1]),
                status=alignment.get("status", "not aligned"),
                reason=entry.get("reason", "not in the report"),
                probability=float("nan") if probability is None else float(probability),
                covariance=covariance_from(alignment.get("covariance")),
                ref_from_query=estimated_pose(alignment, compose(inverse(poses[r]), poses[k])),
                true_ref_from_query=compose(inverse(truth[r]), truth[k]),
                ref_heading_rad=float(truth[r][2]),
                reference=r,
            )
        )
    return outcomes
