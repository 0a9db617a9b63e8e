# SPDX-License-Identifier: GPL-3.0-or-later
"""The two formulas that say how probable a link between consecutive keyframes is, fitted to links whose truth is known.

A *lone* link is one that no loop holds, and is judged by its two scans: logistic regression on what
`match_probability()` says. A *revised* one is judged by all scans of both sides: a multinomial logit over its
candidates and none of them, as in `verify_edges()`. How much of a view two scans lack (`insufficient_view()`) speaks
against either. The weights in use and all tolerances are those that the mapper tells.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from evaluation.common.poses import Array, compose, inverse, wrap_angle
from evaluation.mapping.numbers import Numbers

REVISION_TERMS = (
    "score",
    "balance of all others",
    "the map has it",
    "none of them",
    "little (in the balance)",
    "none of them, per view shortfall",
    "how little the two scans hold the place",
    "a parallel link",
)

BANDS = (0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 1.0)

Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class EdgeNumbers:
    """What the mapper judges edges by: its tolerances, and the weights in use."""

    same_m: float  # nearer than this, two candidates are one place, and a candidate is right
    same_rad: float
    usual_slip_m: float
    near_m: float
    heading_rad: float
    deviations: float
    least_score: float
    neighbours: tuple[float, ...]  # constant, per log odds, per view shortfall
    revision: tuple[float, ...]  # of REVISION_TERMS

    @classmethod
    def of(cls, numbers: Numbers) -> EdgeNumbers:
        """Raises Failure for a number that the mapper does not tell."""
        same_candidate, same_place = ("inference", "agreement"), ("graph", "same_place")
        weights = "inference", "verification_weights"
        first = numbers.of(*weights, ("per_score", "by_others", "of_map", "none_of_them"))
        last = numbers.of(*weights, ("none_per_insufficient_view", "per_log_deviation", "by_parallel"))
        return cls(
            same_m=numbers(*same_candidate, "same_candidate_m"),
            same_rad=numbers(*same_candidate, "same_candidate_rad"),
            usual_slip_m=numbers("graph", "steps", "usual_slip_m"),
            near_m=numbers(*same_place, "near_m"),
            heading_rad=numbers(*same_place, "heading_rad"),
            deviations=numbers(*same_place, "deviations"),
            least_score=numbers(*weights, "least_score"),
            neighbours=numbers.of(
                "matching", "odometry_probability", ("constant", "per_log_odds", "per_insufficient_view")
            ),
            revision=(*first, numbers("graph", "edge_support", "little"), *last),
        )


def is_place(a_from_b: Array, place: Array, numbers: EdgeNumbers) -> bool:
    """Whether two poses `[3]` are the same place."""
    off = compose(inverse(place), a_from_b)
    return bool(np.hypot(off[0], off[1]) < numbers.same_m and abs(wrap_angle(off[2])) < numbers.same_rad)


def slides_to(a_from_b: Array, covariance: Array, place: Array, numbers: EdgeNumbers) -> bool:
    """Whether they are the same place as far as scans, by `covariance` `[3, 3]`, and the usual motion hold `a_from_b`:
    within so many deviations as in is_same_place()."""
    off = a_from_b[:2] - place[:2]
    motion = numbers.usual_slip_m**2 * np.eye(2)
    spread = motion @ np.linalg.inv(motion + covariance[:2, :2]) @ covariance[:2, :2]
    spread += numbers.near_m**2 * np.eye(2)
    is_near = off @ np.linalg.solve(spread, off) < numbers.deviations**2
    return bool(is_near and abs(wrap_angle(a_from_b[2] - place[2])) < numbers.heading_rad)


@dataclass(frozen=True)
class Candidates:
    """What is known of the candidates of a revised link: `poses` `[k, 3]`, `scores`, `for_it` and `against_it` `[k]`;
    `in_map` is the one that the map had; `right` `[k]` those that are at the true place; `deviations_m` `[k]` how
    little the two scans hold it, in the direction in which they hold it best; `vouched` `[k]` what a parallel link says
    for it."""

    poses: Array
    scores: Array
    for_it: Array
    against_it: Array
    in_map: int
    right: Bools
    deviations_m: Array
    vouched: Array
    numbers: EdgeNumbers
    view_shortfall: float = 0.0
    same: Bools = field(init=False)  # [k, k]: are one place

    def __post_init__(self) -> None:
        same = np.array([[is_place(a, b, self.numbers) for b in self.poses] for a in self.poses], bool)
        object.__setattr__(self, "same", same)

    def worths(self, weights: Sequence[float]) -> Array:
        per_score, by_others, of_map, _, little, _, per_loose, by_parallel = weights
        balance = (self.for_it - self.against_it) / (self.for_it + self.against_it + max(little, 1e-6))
        worths = per_score * np.maximum(self.numbers.least_score, self.scores) + by_others * balance
        worths += per_loose * np.log1p(self.deviations_m) + by_parallel * self.vouched
        worths[self.in_map] += of_map
        return np.asarray(worths)

    def places(self, worths: Array) -> list[int]:
        """The best candidate of each place, best first."""
        kept: list[int] = []
        for k in np.argsort(-worths, kind="stable"):
            if not any(self.same[k, other] for other in kept):
                kept.append(int(k))
        return kept

    def probabilities(self, weights: Sequence[float]) -> tuple[list[int], Array]:
        """The places, best first, and how probable each is; what is missing to 1 is none of them."""
        worths = self.worths(weights)
        places = self.places(worths)
        odds = np.append(worths[places], weights[3] + weights[5] * self.view_shortfall)
        shares = np.exp(odds - odds.max())
        return places, shares[:-1] / shares.sum()

    def likelihood(self, weights: Sequence[float]) -> float:
        """How likely the truth is: the right place, or, when no candidate is right, none of them."""
        places, shares = self.probabilities(weights)
        right = self.right[places]
        return float(shares[right].sum() if right.any() else 1.0 - shares.sum())


def log_odds(probability: Array) -> Array:
    """The log odds of probabilities, which are kept away from 0 and 1."""
    kept = np.clip(probability, 1e-9, 1 - 1e-9)
    return np.asarray(np.log(kept / (1 - kept)))


def match_log_odds(stated: Array, view_shortfall: Array, in_use: Sequence[float]) -> Array:
    """What `match_probability()` said, from what is stated of lone links with the weights in use."""
    return np.asarray((log_odds(stated) - in_use[0] - in_use[2] * view_shortfall) / in_use[1])


def best_weights(loss: Callable[[list[float]], float], in_use: Sequence[float], free: Sequence[int]) -> list[float]:
    """Those with the least loss; what is not in `free` stays as it is in use."""

    def with_free(values: Array) -> list[float]:
        weights = list(in_use)
        for k, value in zip(free, values, strict=True):
            weights[k] = float(value)
        return weights

    start = np.array([in_use[k] for k in free])
    options = {"maxiter": 1000, "xatol": 5e-3, "fatol": 1e-6}
    return with_free(minimize(lambda values: loss(with_free(values)), start, method="Nelder-Mead", options=options).x)


def fitted_neighbours(
    stated: Array, view_shortfall: Array, right: Bools, in_use: Sequence[float], free: Sequence[int]
) -> list[float]:
    """Constant, and weights of the log odds of `match_probability()` and of the view shortfall, by what is stated of
    lone links."""
    odds, sign = match_log_odds(stated, view_shortfall, in_use), np.where(right, 1.0, -1.0)

    def loss(weights: Sequence[float]) -> float:
        return float(np.mean(np.logaddexp(0.0, -sign * (weights[0] + weights[1] * odds + weights[2] * view_shortfall))))

    return best_weights(loss, in_use, free)


def mean_log_likelihood(links: Sequence[Candidates], weights: Sequence[float]) -> float:
    return float(np.mean([np.log(max(link.likelihood(weights), 1e-12)) for link in links]))


def fitted_revision(links: Sequence[Candidates], in_use: Sequence[float], free: Sequence[int]) -> list[float]:
    """Weights of REVISION_TERMS."""
    return best_weights(lambda weights: -mean_log_likelihood(links, weights), in_use, free)


def calibration_table(stated: Array, right: Bools) -> str:
    """How many of those stated to be so probable are right."""
    lines = ["| stated | number | right | mean stated |", "|---|---|---|---|"]
    for low, high in pairwise(BANDS):
        inside = (stated >= low) & ((stated < high) | (high == 1.0))
        if inside.any():
            share, mean = 100 * right[inside].mean(), 100 * stated[inside].mean()
            lines.append(f"| {low:g} to {high:g} | {inside.sum()} | {share:.1f} % | {mean:.1f} % |")
    return "\n".join(lines)
