# SPDX-License-Identifier: GPL-3.0-or-later
"""The score of a pose and the probability of an alignment, fitted to pairs of scans whose truth is known."""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import minimize

from evaluation.common.poses import compose, inverse
from evaluation.common.programs import run_quietly
from evaluation.logs.reference_log import reference_poses
from evaluation.mapping.numbers import Numbers
from evaluation.pairs.outcomes import is_right

GAPS = (1, 2, 3, 5)
MANY_HYPOTHESES = ["--kept-candidates", "12", "--refined-candidates", "24"]
RESIDUAL_UNIT_M = 0.05  # so that all weights of the score are of one size, as the fit asks for
CROSS_WEIGHT = 3.0


@dataclass(frozen=True)
class ScoreNumbers:
    """What the mapper adds to shares before it takes logarithms, its margins, and the weights in use."""

    agree_offset: float
    cross_agree_offset: float
    crossed_offset: float
    unclear_share: float
    probability_agree_offset: float
    least_margin: float
    full_margin: float
    score: tuple[float, ...]  # of score_names()
    probability: tuple[float, ...]  # of probability_names()

    @classmethod
    def of(cls, numbers: Numbers) -> ScoreNumbers:
        """Raises Failure for a number that the mapper does not tell."""
        score, probability = ("matching", "score"), ("matching", "match_probability")
        residual_per_m = numbers(*score, "residual_per_m")
        return cls(
            agree_offset=numbers(*score, "agree_offset"),
            cross_agree_offset=numbers(*score, "cross_agree_offset"),
            crossed_offset=numbers(*score, "crossed_offset"),
            unclear_share=numbers(*score, "unclear_share"),
            probability_agree_offset=numbers(*probability, "agree_offset"),
            least_margin=numbers(*probability, "least_margin"),
            full_margin=numbers(*probability, "full_margin"),
            score=(*numbers.of(*score, ("agree", "cross_agree", "crossed")), residual_per_m * RESIDUAL_UNIT_M),
            probability=numbers.of(
                *probability, ("constant", "per_margin", "per_log_margin", "per_score", "per_log_agree")
            ),
        )

    def score_names(self) -> tuple[str, ...]:
        return (
            f"log({self.agree_offset:g} + agree + {self.unclear_share:g} unclear)",
            f"log({self.cross_agree_offset:g} + cross_agree)",
            f"log({self.crossed_offset:g} + crossed)",
            f"rms_m / {RESIDUAL_UNIT_M:g}",
        )

    def probability_names(self) -> tuple[str, ...]:
        return ("1", "margin", "log(margin)", "score", f"log({self.probability_agree_offset:g} + agree)")


@dataclass(frozen=True)
class Pair:
    """Hypotheses of one pair, best first; `right` says which are within tolerance of the reference."""

    log: str
    gap: int  # 0: from different logs
    hypotheses: list[dict[str, Any]]
    right: np.ndarray

    def terms(self, numbers: ScoreNumbers) -> np.ndarray:
        return np.array([score_terms(hypothesis, numbers) for hypothesis in self.hypotheses])


def score_terms(hypothesis: dict[str, Any], numbers: ScoreNumbers) -> list[float]:
    return [
        np.log(numbers.agree_offset + hypothesis["agree"] + numbers.unclear_share * hypothesis["unclear"]),
        np.log(numbers.cross_agree_offset + hypothesis["cross_agree"]),
        np.log(numbers.crossed_offset + hypothesis["crossed"]),
        hypothesis["rms_m"] / RESIDUAL_UNIT_M,
    ]


def probability_terms(pair: Pair, numbers: ScoreNumbers) -> list[float]:
    scores = [hypothesis["score"] for hypothesis in pair.hypotheses]
    margin = scores[0] - scores[1] if len(scores) > 1 else numbers.full_margin
    margin = min(max(margin, numbers.least_margin), numbers.full_margin)
    agree = numbers.probability_agree_offset + pair.hypotheses[0]["agree"]
    return [1.0, margin, np.log(margin), scores[0], np.log(agree)]


def align(cli: Path, *arguments: Any) -> list[dict[str, Any]]:
    """Runs the mapper on pairs. Raises Failure with its last line when it fails."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "pairs.jsonl"
        run_quietly([cli, "align", *arguments, "--out", out, "--quiet", *MANY_HYPOTHESES], done=(0,))
        return [json.loads(line) for line in out.read_text(encoding="utf-8").splitlines()]


def pairs_of_log(cli: Path, path: Path) -> list[Pair]:
    reference = reference_poses(path)
    pairs = []
    for gap in GAPS:
        for found in align(cli, path, "--gap", gap):
            if not found["hypotheses"]:
                continue
            truth = compose(inverse(reference[found["reference"]]), reference[found["query"]])
            right = np.array([is_right(hypothesis["pose"], truth) for hypothesis in found["hypotheses"]])
            pairs.append(Pair(path.name, gap, found["hypotheses"], right))
    return pairs


def pairs_of_different_logs(cli: Path, paths: list[Path], count: int) -> list[Pair]:
    """Random pairs, the same in every run."""
    random = np.random.default_rng(0)
    sizes = [len(reference_poses(path)) for path in paths]
    pairs = []
    couples = [(a, b) for a in range(len(paths)) for b in range(len(paths)) if a != b]
    for a, b in couples:
        with tempfile.TemporaryDirectory() as folder:
            listing = Path(folder) / "pairs.txt"
            each = count // len(couples)
            lines = [f"{random.integers(sizes[a])} {random.integers(sizes[b])}\n" for _ in range(each)]
            listing.write_text("".join(lines), encoding="utf-8")
            for found in align(cli, paths[a], paths[b], "--pairs", listing):
                if found["hypotheses"]:
                    nothing = np.zeros(len(found["hypotheses"]), bool)
                    pairs.append(Pair(f"{paths[a].name} x {paths[b].name}", 0, found["hypotheses"], nothing))
    return pairs


def fitted_score(pairs: list[Pair], numbers: ScoreNumbers) -> np.ndarray:
    useful = [(pair.terms(numbers), pair.right) for pair in pairs if pair.right.any() and not pair.right.all()]

    def loss(weights: np.ndarray) -> tuple[float, np.ndarray]:
        value, slope = 0.0, np.zeros_like(weights)
        for terms, right in useful:
            odds = terms @ weights
            likely = np.exp(odds - odds.max())
            of_right = likely * right
            value -= np.log(of_right.sum() / likely.sum() + 1e-12)
            slope -= terms.T @ (of_right / (of_right.sum() + 1e-300) - likely / likely.sum())
        return value / len(useful) + 5e-5 * weights @ weights, slope / len(useful) + 1e-4 * weights

    return minimize(loss, np.zeros(len(numbers.score)), jac=True).x


def share_right(pairs: list[Pair], weights: np.ndarray, numbers: ScoreNumbers) -> float:
    return float(np.mean([pair.right[np.argmax(pair.terms(numbers) @ weights)] for pair in pairs]))


def fitted_probability(pairs: list[Pair], numbers: ScoreNumbers) -> np.ndarray:
    terms = np.array([probability_terms(pair, numbers) for pair in pairs])
    right = np.array([float(pair.right[0]) for pair in pairs])
    counts = np.array([CROSS_WEIGHT if pair.gap == 0 else 1.0 for pair in pairs])
    counts /= counts.sum()

    def loss(weights: np.ndarray) -> tuple[float, np.ndarray]:
        odds = terms @ weights
        value = counts @ np.logaddexp(0.0, -(2.0 * right - 1.0) * odds)
        return value + 5e-5 * weights @ weights, terms.T @ (counts * (1 / (1 + np.exp(-odds)) - right)) + 1e-4 * weights

    return minimize(loss, np.zeros(len(numbers.probability)), jac=True).x
