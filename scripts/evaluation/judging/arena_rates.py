# SPDX-License-Identifier: GPL-3.0-or-later
"""Failure rates with their uncertainty, by overlap band and stage, as a table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evaluation.common.shares import Share, wilson_interval
from evaluation.common.tables import table

from .arena_pairs import PairResult, stages_of

HEAD = (
    *("overlap", "stage", "pairs", "failures", "rate (95 % interval)", "wrong", "rejected", "median error"),
    "median point displacement",
)
BANDS = ((0.0, 0.3), (0.3, 0.45), (0.45, 0.6), (0.6, 0.75), (0.75, 1.0))


@dataclass(frozen=True)
class Rate:
    """One row: pairs of a band at a stage. Failures are wrong poses and rejected pairs; medians are over the rest."""

    band: str
    stage: str
    num_pairs: int
    num_wrong: int
    num_rejected: int
    interval: tuple[float, float]
    median_m: float
    median_deg: float
    median_displacement_m: float

    @property
    def num_failures(self) -> int:
        return self.num_wrong + self.num_rejected

    @property
    def failure_ratio(self) -> float:
        return self.num_failures / self.num_pairs if self.num_pairs else float("nan")


def rate(band: str, stage: str, pairs: list[PairResult]) -> Rate:
    verdicts = [pair.verdict(stage) for pair in pairs]
    good = np.array(
        [(e.error_m, e.error_deg, e.displacement_m) for pair in pairs if pair.errors and (e := pair.errors[stage]).ok]
    ).reshape(-1, 3)
    medians = np.median(good, axis=0) if len(good) else np.full(3, np.nan)
    wrong, rejected = verdicts.count("wrong"), verdicts.count("rejected")
    return Rate(
        band,
        stage,
        len(pairs),
        wrong,
        rejected,
        wilson_interval(wrong + rejected, len(pairs)),
        float(medians[0]),
        float(medians[1]),
        float(medians[2]),
    )


def band_of(overlap: float) -> str:
    """The band that holds an overlap; a value on a border belongs to the higher one."""
    low, high = next(band for band in reversed(BANDS) if overlap >= band[0])
    return f"{low:.2f}-{high:.2f}"


def all_rates(pairs: list[PairResult]) -> list[Rate]:
    """Every band at every stage, then all pairs."""
    names, stages = [f"{low:.2f}-{high:.2f}" for low, high in BANDS], stages_of(pairs)
    rows = [rate(name, stage, [p for p in pairs if band_of(p.overlap) == name]) for name in names for stage in stages]
    return rows + [rate("all", stage, pairs) for stage in stages]


def sureness(pairs: list[PairResult]) -> str:
    """One line: how often the mapper has no doubts, and how often it should have had."""
    sure = [pair for pair in pairs if pair.sure]
    wrong = sum(pair.final_verdict == "wrong" for pair in sure)
    return f"{len(sure)} of {len(pairs)} pairs are called sure; {wrong} of these are wrong."


def markdown(rates: list[Rate]) -> str:
    """The rows as a Markdown table."""
    rows: list[list[object]] = []
    for r in rates:
        if not r.num_pairs:
            rows.append([r.band, r.stage, 0])
            continue
        share = Share(r.num_failures, r.num_pairs)
        error = f"{100 * r.median_m:.1f} cm, {r.median_deg:.2f} deg"
        displacement = f"{100 * r.median_displacement_m:.1f} cm"
        if r.num_failures == r.num_pairs:
            error = displacement = "-"
        counts = [r.num_pairs, r.num_failures, share, r.num_wrong, r.num_rejected]
        rows.append([r.band, r.stage, *counts, error, displacement])
    return table(HEAD, rows)
