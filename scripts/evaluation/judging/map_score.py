# SPDX-License-Identifier: GPL-3.0-or-later
"""A log of one session whose true poses are known: it is mapped, and the map held against them."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from evaluation.common.poses import Array
from evaluation.common.programs import Failure
from evaluation.mapping.mapper import Mapper
from evaluation.mapping.report import Report, placed_poses

from .absolute_errors import absolute_errors_m, root_mean_square
from .consecutive_pairs import pairs


@dataclass(frozen=True)
class MapScore:
    """How good the map of a log is, and what it took; `fault` says why there is none. Errors are those left after the
    planar motion that fits best."""

    num_scans: int
    num_placed: int = 0
    num_right: int = 0
    ate_m: float = math.nan
    worst_m: float = math.nan
    num_loops: int = 0
    cpu_s: float = 0.0
    peak_memory_mib: float = 0.0
    fault: str = ""

    @property
    def right_pairs(self) -> str:
        return f"{self.num_right} of {self.num_scans - 1}"

    @property
    def errors(self) -> list[str]:
        """Two cells of a table: the root mean square, and the largest."""
        return [f"{self.ate_m:.3f} m", f"{self.worst_m:.2f} m"]


def mapped_text(text: str, ending: str, truth: Array, mapper: Mapper) -> tuple[MapScore, Report | None]:
    """Maps a log that is given as text, and judges it by its true poses `[p, 3]`. No report where there is no map."""
    with tempfile.TemporaryDirectory(prefix="log_") as name:
        log = Path(name) / f"log{ending}"
        log.write_text(text, encoding="utf-8")
        try:
            report, usage = mapper.run([log], Path(name))
        except Failure as failure:
            return MapScore(len(truth), fault=str(failure)), None
    placed, errors_m = placed_poses(report), absolute_errors_m(report, [truth])
    score = MapScore(
        len(truth),
        num_placed=len(placed),
        num_right=sum(pairs(truth, [placed])["right"]),
        ate_m=root_mean_square(errors_m),
        worst_m=float(np.max(errors_m, initial=0.0)),
        num_loops=len(report["loops"]),
        cpu_s=usage.cpu_s,
        peak_memory_mib=usage.peak_memory_mib,
    )
    return score, report


def num_faults(scores: Sequence[MapScore]) -> int:
    return sum(bool(score.fault) for score in scores)
