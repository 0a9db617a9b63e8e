# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether each scan is placed right against the scan before it, by the relative pose of both and the reference."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.common.poses import Array, compose, inverse, pose_error
from evaluation.common.programs import Failure
from evaluation.common.shares import Share
from evaluation.logs.reference_log import reference_poses
from evaluation.mapping.mapper import Mapper
from evaluation.mapping.report import placed_poses

MAX_ERROR_M, MAX_ERROR_DEG = 0.20, 5.0


def is_right(error_m: float, error_deg: float) -> bool:
    return error_m < MAX_ERROR_M and error_deg < MAX_ERROR_DEG


def pair_errors(reference: Sequence[Array], placed: Mapping[int, Array]) -> list[tuple[float, float]]:
    """Error of each consecutive pair in metres and degrees; infinite when one of the two is not in the map."""
    errors = []
    for i in range(1, len(reference)):
        if i not in placed or i - 1 not in placed:
            errors.append((float("inf"), float("inf")))
            continue
        truth = compose(inverse(reference[i - 1]), reference[i])
        errors.append(pose_error(compose(inverse(placed[i - 1]), placed[i]), truth))
    return errors


def pairs(reference: Array, fragments: Sequence[Mapping[int, Array]]) -> dict[str, list[Any]]:
    """Each pair of consecutive scans: `right` when both are in one fragment and their relative pose is within 0.20 m
    and 5 degrees. Errors are None for the others without a place."""
    best = [(float("inf"), float("inf"))] * max(0, len(reference) - 1)
    for fragment in fragments:
        best = [min(pair) for pair in zip(best, pair_errors(list(reference), dict(fragment)))]
    return {
        "right": [int(is_right(*errors)) for errors in best],
        "error_m": [round(m, 6) if np.isfinite(m) else None for m, _ in best],
        "error_deg": [round(deg, 6) if np.isfinite(deg) else None for _, deg in best],
    }


@dataclass(frozen=True)
class LogScore:
    """What became of the consecutive pairs of a log, and what mapping it took."""

    name: str
    num_scans: int
    num_placed: int
    num_right: int
    median_m: float
    cpu_s: float
    peak_mib: float

    @property
    def num_pairs(self) -> int:
        return max(0, self.num_scans - 1)

    @property
    def right(self) -> Share:
        return Share(self.num_right, self.num_pairs)


def score_log(path: Path, cli: Path, arguments: Sequence[str], every: int = 1) -> LogScore:
    """Maps every so manieth scan of one log. Raises Failure that names it when it gives no map."""
    mapper = Mapper(cli, ("--every", str(every), *arguments))
    with tempfile.TemporaryDirectory(prefix="log_") as folder:
        try:
            report, _ = mapper.run([path], Path(folder))
        except Failure as failure:
            raise Failure(f"{path.name}: {failure}") from None
    placed, reference = placed_poses(report), reference_poses(path)[::every]
    right = [errors[0] for errors in pair_errors(reference, placed) if is_right(*errors)]
    return LogScore(
        path.name,
        len(reference),
        len(placed),
        len(right),
        float(np.median(right)) if right else float("nan"),
        float(report["seconds"]["cpu"]),
        float(report["peak_memory_mib"]),
    )
