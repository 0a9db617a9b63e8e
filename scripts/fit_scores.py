#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fit the two formulas of the robust method to real logs: the score of a pose, and the probability of an alignment.

The score is what makes the right one of a pair's hypotheses win: a conditional logit over the hypotheses of all pairs
that have a right one and a wrong one. Each log is also judged with weights fitted to the others. The probability is a
logistic regression on the best hypothesis, its margin and its share of agreeing points; pairs from different logs, with
nothing in common, have no right answer and count three times. What is printed belongs into visibility_score(),
refined_hypothesis() and match_probability().
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import minimize

from evaluate_logs import MAX_ERROR_DEG, MAX_ERROR_M, ROOT, reference_poses
from shapemap_sim.poses import compose, inverse

GAPS = (1, 2, 3, 5)
MANY_HYPOTHESES = ["--kept-hypotheses", "12", "--refined-hypotheses", "24"]
SCORE_TERMS = ("log(0.05 + agree + 0.25 unclear)", "log(0.05 + cross_agree)", "log(0.02 + crossed)", "rms_m / 0.05")
PROBABILITY_TERMS = ("1", "margin", "log(margin)", "score", "log(0.02 + agree)")
LEAST_MARGIN, FULL_MARGIN = 0.05, 20.0
CROSS_WEIGHT = 3.0
SURE = 0.95
EXAMPLE = """example:
  SHAPEMAP_DATASETS=logs scripts/fit_scores.py carmen/{intel,orebro,belgioioso}-corrected.log.gz"""


@dataclass(frozen=True)
class Pair:
    """Hypotheses of one pair, best first; `right` says which are within tolerance of the reference."""

    log: str
    gap: int  # 0: from different logs
    hypotheses: list[dict[str, Any]]
    right: np.ndarray

    def terms(self) -> np.ndarray:
        return np.array([score_terms(hypothesis) for hypothesis in self.hypotheses])


def score_terms(hypothesis: dict[str, Any]) -> list[float]:
    return [
        np.log(0.05 + hypothesis["agree"] + 0.25 * hypothesis["unclear"]),
        np.log(0.05 + hypothesis["cross_agree"]),
        np.log(0.02 + hypothesis["crossed"]),
        hypothesis["rms_m"] / 0.05,
    ]


def probability_terms(pair: Pair) -> list[float]:
    scores = [hypothesis["score"] for hypothesis in pair.hypotheses]
    margin = scores[0] - scores[1] if len(scores) > 1 else FULL_MARGIN
    margin = min(max(margin, LEAST_MARGIN), FULL_MARGIN)
    return [1.0, margin, np.log(margin), scores[0], np.log(0.02 + pair.hypotheses[0]["agree"])]


def align(cli: Path, *arguments: Any) -> list[dict[str, Any]]:
    """Runs the mapper on pairs. Raises RuntimeError with its last line when it fails."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "pairs.jsonl"
        command = [cli, "align", *arguments, "--out", out, "--quiet", *MANY_HYPOTHESES]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError((done.stderr.strip().splitlines() or ["no message"])[-1])
        return [json.loads(line) for line in out.read_text(encoding="utf-8").splitlines()]


def is_right(truth: np.ndarray, hypothesis: dict[str, Any]) -> bool:
    error = compose(inverse(truth), np.array(hypothesis["pose"]))
    return bool(np.hypot(error[0], error[1]) < MAX_ERROR_M and abs(np.degrees(error[2])) < MAX_ERROR_DEG)


def pairs_of_log(cli: Path, path: Path) -> list[Pair]:
    reference = reference_poses(path)
    pairs = []
    for gap in GAPS:
        for found in align(cli, path, "--gap", gap):
            if not found["hypotheses"]:
                continue
            truth = compose(inverse(reference[found["reference"]]), reference[found["query"]])
            right = np.array([is_right(truth, hypothesis) for hypothesis in found["hypotheses"]])
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


def fitted_score(pairs: list[Pair]) -> np.ndarray:
    useful = [(pair.terms(), pair.right) for pair in pairs if pair.right.any() and not pair.right.all()]

    def loss(weights: np.ndarray) -> tuple[float, np.ndarray]:
        value, slope = 0.0, np.zeros_like(weights)
        for terms, right in useful:
            odds = terms @ weights
            likely = np.exp(odds - odds.max())
            of_right = likely * right
            value -= np.log(of_right.sum() / likely.sum() + 1e-12)
            slope -= terms.T @ (of_right / (of_right.sum() + 1e-300) - likely / likely.sum())
        return value / len(useful) + 5e-5 * weights @ weights, slope / len(useful) + 1e-4 * weights

    return minimize(loss, np.zeros(len(SCORE_TERMS)), jac=True).x


def share_right(pairs: list[Pair], weights: np.ndarray) -> float:
    return float(np.mean([pair.right[np.argmax(pair.terms() @ weights)] for pair in pairs]))


def fitted_probability(pairs: list[Pair]) -> np.ndarray:
    terms = np.array([probability_terms(pair) for pair in pairs])
    right = np.array([float(pair.right[0]) for pair in pairs])
    counts = np.array([CROSS_WEIGHT if pair.gap == 0 else 1.0 for pair in pairs])
    counts /= counts.sum()

    def loss(weights: np.ndarray) -> tuple[float, np.ndarray]:
        odds = terms @ weights
        value = counts @ np.logaddexp(0.0, -(2.0 * right - 1.0) * odds)
        return value + 5e-5 * weights @ weights, terms.T @ (counts * (1 / (1 + np.exp(-odds)) - right)) + 1e-4 * weights

    return minimize(loss, np.zeros(len(PROBABILITY_TERMS)), jac=True).x


def print_score(pairs: list[Pair]) -> None:
    print("score:")
    for term, weight in zip(SCORE_TERMS, fitted_score(pairs), strict=True):
        print(f"  {weight:7.2f} {term}")
    print("right with weights fitted to the other logs, with weights fitted to all:")
    everything = fitted_score(pairs)
    for log in sorted({pair.log for pair in pairs}):
        others = fitted_score([pair for pair in pairs if pair.log != log])
        for gap in GAPS:
            own = [pair for pair in pairs if pair.log == log and pair.gap == gap]
            print(f"  {log} gap {gap}: {share_right(own, others):.4f} {share_right(own, everything):.4f}")


def print_probability(pairs: list[Pair]) -> None:
    weights = fitted_probability(pairs)
    print("log odds of the probability:")
    for term, weight in zip(PROBABILITY_TERMS, weights, strict=True):
        print(f"  {weight:7.2f} {term}")
    for gap in (*GAPS, 0):
        own = [pair for pair in pairs if pair.gap == gap]
        stated = 1 / (1 + np.exp(-np.array([probability_terms(pair) for pair in own]) @ weights))
        right = np.array([pair.right[0] for pair in own])
        sure = stated >= SURE
        of_these = f"{right[sure].mean():.4f} of these right" if sure.any() else "none of these"
        name = f"gap {gap}" if gap else "different logs"
        print(f"  {name}: {sure.mean():.4f} stated as {SURE} or more, {of_these}")


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("logs", nargs="+", type=Path, metavar="LOG", help="path, or path below SHAPEMAP_DATASETS")
    parser.add_argument("--cli", type=Path, default=ROOT / "build/release/bin/shapemap-cli", metavar="FILE")
    parser.add_argument("--cross", type=int, default=4000, metavar="N", help="pairs from different logs")
    arguments = parser.parse_args(argv)
    folder = Path(os.environ.get("SHAPEMAP_DATASETS", "."))
    paths = [log if log.exists() else folder / log for log in arguments.logs]
    if len(paths) < 2:
        parser.error("two logs or more are needed: each is judged by weights from the others")
    try:
        pairs = [pair for path in paths for pair in pairs_of_log(arguments.cli, path)]
        print_score(pairs)
        print_probability(pairs + pairs_of_different_logs(arguments.cli, paths, arguments.cross))
    except (RuntimeError, OSError, ValueError) as error:
        print(f"fit_scores.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
