# SPDX-License-Identifier: GPL-3.0-or-later
"""Success, confidence and false acceptance as numbers and as Markdown."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from evaluation.common.shares import Share, share_of
from evaluation.common.tables import percent, table
from evaluation.judging.arena_rates import BANDS, band_of

from .outcomes import SURE, CrossOutcome, PairOutcome

ROTATIONS_DEG = ((0, 15), (15, 45), (45, 90), (90, 180))
NUM_BINS = 10
FAILURES = ("search", "score", "no pose")


@dataclass(frozen=True)
class SuccessRow:
    """Medians are over the pairs that are right; `log_mean` gives each log that has such pairs the same weight."""

    name: str
    right: Share
    ceiling: Share  # refined from the reference pose
    log_mean: float
    ceiling_log_mean: float
    median_m: float
    median_deg: float
    failures: dict[str, int]
    num_would_win: int
    num_in_doubt: int


def mean_over_logs(pairs: Sequence[PairOutcome], good: Callable[[PairOutcome], bool]) -> float:
    by_log: dict[str, list[bool]] = {}
    for pair in pairs:
        by_log.setdefault(pair.log, []).append(good(pair))
    return float(np.mean([np.mean(flags) for flags in by_log.values()])) if by_log else float("nan")


def success_row(name: str, pairs: Sequence[PairOutcome]) -> SuccessRow:
    right = [(pair.error_m, pair.error_deg) for pair in pairs if pair.is_right]
    median_m, median_deg = np.median(right, axis=0) if right else (float("nan"), float("nan"))
    return SuccessRow(
        name,
        share_of([pair.is_right for pair in pairs]),
        share_of([pair.refined_is_right for pair in pairs]),
        mean_over_logs(pairs, lambda pair: pair.is_right),
        mean_over_logs(pairs, lambda pair: pair.refined_is_right),
        float(median_m),
        float(median_deg),
        {kind: sum(pair.failure == kind for pair in pairs) for kind in FAILURES},
        sum(pair.reference_would_win for pair in pairs),
        sum(pair.in_doubt for pair in pairs),
    )


def rotation_band(rotation_deg: float) -> str:
    """A value on a border belongs to the higher band."""
    low, high = next(band for band in reversed(ROTATIONS_DEG) if rotation_deg >= band[0])
    return f"{low}-{high}"


def rows_by(
    pairs: Sequence[PairOutcome], name_of: Callable[[PairOutcome], str], names: Sequence[str]
) -> list[SuccessRow]:
    """A row for each name, in order, also for those that no pair has."""
    groups: dict[str, list[PairOutcome]] = {name: [] for name in names}
    for pair in pairs:
        groups[name_of(pair)].append(pair)
    return [success_row(name, group) for name, group in groups.items()]


def success_tables(pairs: Sequence[PairOutcome], faults: dict[str, str]) -> dict[str, list[SuccessRow]]:
    """The tables by title of the column that tells their rows apart. A log whose run crashed says so."""
    logs = list(dict.fromkeys(pair.log for pair in pairs))
    gaps = sorted({pair.gap for pair in pairs})

    def log_name(log: str) -> str:
        return f"{log} (crashed: {faults[log]})" if log in faults else log

    by_log = rows_by(pairs, lambda pair: log_name(pair.log), [log_name(log) for log in logs])
    by_both = rows_by(pairs, lambda p: f"{p.log}, {p.gap}", [f"{log}, {gap}" for log in logs for gap in gaps])
    by_gap = rows_by(pairs, lambda pair: str(pair.gap), [str(gap) for gap in gaps])
    overlaps = [f"{low:.2f}-{high:.2f}" for low, high in BANDS]
    rotations = [f"{low}-{high}" for low, high in ROTATIONS_DEG]
    return {
        "log": [*by_log, success_row("all", pairs)],
        "log, gap": by_both,
        "gap": by_gap,
        "overlap": rows_by(pairs, lambda pair: band_of(pair.overlap), overlaps),
        "rotation [deg]": rows_by(pairs, lambda pair: rotation_band(pair.rotation_deg), rotations),
    }


def success_markdown(title: str, rows: Sequence[SuccessRow]) -> str:
    head = [title, "pairs", "right (95 % interval)", "mean of logs", "median error"]
    head += ["refined from reference", "mean of logs", *FAILURES, "reference would win", "reference in doubt"]
    return table(
        head,
        [
            [
                *[row.name, row.right.total, row.right, percent(row.log_mean)],
                "-" if np.isnan(row.median_m) else f"{100 * row.median_m:.1f} cm, {row.median_deg:.2f} deg",
                *[row.ceiling, percent(row.ceiling_log_mean), *row.failures.values()],
                *[row.num_would_win, row.num_in_doubt],
            ]
            for row in rows
        ],
    )


@dataclass(frozen=True)
class ConfidenceRow:
    """`right` counts pairs whose first hypothesis is right, which is what the probability is about."""

    name: str
    num_pairs: int
    sure: Share
    right_when_sure: Share
    ok: Share
    right_when_ok: Share
    brier: float


def confidence_row(name: str, pairs: Sequence[PairOutcome]) -> ConfidenceRow:
    sure = [pair for pair in pairs if pair.probability >= SURE]
    ok = [pair for pair in pairs if pair.status == "ok"]
    squares = [(pair.probability - pair.first_is_right) ** 2 for pair in pairs]
    return ConfidenceRow(
        name,
        len(pairs),
        Share(len(sure), len(pairs)),
        share_of([pair.first_is_right for pair in sure]),
        Share(len(ok), len(pairs)),
        share_of([pair.first_is_right for pair in ok]),
        float(np.mean(squares)) if squares else float("nan"),
    )


def confidence_rows(pairs: Sequence[PairOutcome]) -> list[ConfidenceRow]:
    logs = dict.fromkeys(pair.log for pair in pairs)
    rows = [confidence_row(log, [pair for pair in pairs if pair.log == log]) for log in logs]
    return [*rows, confidence_row("all", pairs)]


def confidence_markdown(rows: Sequence[ConfidenceRow]) -> str:
    head = ["log", "pairs", f"probability >= {SURE}", "of these right", "status ok", "of these right", "Brier score"]
    return table(
        head,
        [[r.name, r.num_pairs, r.sure, r.right_when_sure, r.ok, r.right_when_ok, f"{r.brier:.4f}"] for r in rows],
    )


@dataclass(frozen=True)
class ReliabilityBin:
    low: float
    high: float
    mean_probability: float
    right: Share


def reliability(pairs: Sequence[PairOutcome]) -> list[ReliabilityBin]:
    """Pairs by probability; a value on a border belongs to the higher bin."""
    bins = []
    for k in range(NUM_BINS):
        inside = [pair for pair in pairs if min(int(pair.probability * NUM_BINS), NUM_BINS - 1) == k]
        mean = float(np.mean([pair.probability for pair in inside])) if inside else float("nan")
        share = share_of([pair.first_is_right for pair in inside])
        bins.append(ReliabilityBin(k / NUM_BINS, (k + 1) / NUM_BINS, mean, share))
    return bins


def reliability_markdown(bins: Sequence[ReliabilityBin]) -> str:
    rows = [[f"{b.low:.1f}-{b.high:.1f}", b.right.total, percent(b.mean_probability), b.right] for b in bins]
    return table(["probability", "pairs", "mean probability", "right (95 % interval)"], rows)


@dataclass(frozen=True)
class CrossRow:
    name: str
    ok: Share
    sure: Share


def cross_rows(outcomes: Sequence[CrossOutcome]) -> list[CrossRow]:
    def row(name: str, some: Sequence[CrossOutcome]) -> CrossRow:
        return CrossRow(
            name, share_of([o.status == "ok" for o in some]), share_of([o.probability >= SURE for o in some])
        )

    logs = dict.fromkeys(outcome.reference_log for outcome in outcomes)
    return [*[row(log, [o for o in outcomes if o.reference_log == log]) for log in logs], row("all", outcomes)]


def cross_markdown(rows: Sequence[CrossRow]) -> str:
    head = ["log of the reference", "pairs", "status ok (95 % interval)", f"probability >= {SURE} (95 % interval)"]
    return table(head, [[row.name, row.ok.total, row.ok, row.sure] for row in rows])
