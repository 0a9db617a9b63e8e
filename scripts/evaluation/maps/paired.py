# SPDX-License-Identifier: GPL-3.0-or-later
"""Differences of paired values with their uncertainty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import binomtest

from evaluation.common.poses import Array

NUM_RESAMPLES = 4000
SEED = 0
CHUNK_VALUES = 2_000_000
LEVEL = 0.95


@dataclass(frozen=True)
class Sample:
    """One independent draw, such as a pair of positions, or all pairs of one arena: the sums of A's and of B's values
    and how many values there are."""

    sum_a: float
    sum_b: float
    count: int


@dataclass(frozen=True)
class Difference:
    """B minus A. `interval` is None where there are too few draws for one."""

    mean_a: float
    mean_b: float
    interval: tuple[float, float] | None

    @property
    def value(self) -> float:
        return self.mean_b - self.mean_a


def resampled_means(samples: Sequence[Sample], rng: np.random.Generator) -> Array:
    """The difference of the means (B minus A) for each of the resamples, drawn with replacement."""
    differences = np.array([sample.sum_b - sample.sum_a for sample in samples])
    counts = np.array([sample.count for sample in samples], dtype=np.float64)
    step = max(1, CHUNK_VALUES // len(samples))
    parts = []
    for first in range(0, NUM_RESAMPLES, step):
        drawn = rng.integers(len(samples), size=(min(step, NUM_RESAMPLES - first), len(samples)))
        parts.append(differences[drawn].sum(axis=1) / counts[drawn].sum(axis=1))
    return np.concatenate(parts)


def paired_difference(groups: Sequence[Sequence[Sample]]) -> Difference:
    """The mean over groups of each group's mean difference. The interval is that of the percentile bootstrap: the draws
    of each group are resampled by themselves, with A and B of a draw together; the groups stay. With a fixed seed.
    Raises ValueError when a group is empty."""
    if not groups or not all(groups):
        raise ValueError("nothing to compare")
    totals = [
        (sum(s.sum_a for s in group), sum(s.sum_b for s in group), sum(s.count for s in group)) for group in groups
    ]
    mean_a = float(np.mean([a / count for a, _, count in totals]))
    mean_b = float(np.mean([b / count for _, b, count in totals]))
    if any(len(group) < 2 for group in groups):
        return Difference(mean_a, mean_b, None)
    rng = np.random.default_rng(SEED)
    means = np.mean([resampled_means(group, rng) for group in groups], axis=0)
    low, high = np.quantile(means, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    return Difference(mean_a, mean_b, (float(low), float(high)))


def sign_test(num_a: int, num_b: int) -> float:
    """Two-sided p that of so many cases in which only one is better, A and B share as unevenly by chance. Over pairs of
    positions that one of two gets right this is the exact test of McNemar."""
    return float(binomtest(num_a, num_a + num_b, 0.5).pvalue) if num_a + num_b else 1.0
