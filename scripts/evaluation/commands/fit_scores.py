# SPDX-License-Identifier: GPL-3.0-or-later
"""Fit the two formulas of the robust method to real logs: the score of a pose, and the probability of an alignment.

The score is what makes the right one of a pair's hypotheses win: a conditional logit over the hypotheses of all pairs
that have a right one and a wrong one. Each log is also judged with weights fitted to the others. The probability is a
logistic regression on the best hypothesis, its margin and its share of agreeing points; pairs from different logs, with
nothing in common, have no right answer and count three times. What is printed, beside the weights in use as
`shapemap-cli numbers` tells them, belongs into matching_numbers.hpp.
"""

from __future__ import annotations

import argparse

import numpy as np

from evaluation.common.command_line import add_logs, add_program, command_parser, complain
from evaluation.common.programs import Failure
from evaluation.common.project import found_log
from evaluation.fitting.score_fits import (
    GAPS,
    Pair,
    ScoreNumbers,
    fitted_probability,
    fitted_score,
    pairs_of_different_logs,
    pairs_of_log,
    probability_terms,
    share_right,
)
from evaluation.mapping.numbers import numbers_of

SURE = 0.95
EXAMPLE = """example:
  SHAPEMAP_DATASETS=logs scripts/evaluate.py fit-scores carmen/{intel,orebro,belgioioso}-corrected.log.gz"""


def print_weights(title: str, weights: np.ndarray, in_use: tuple[float, ...], terms: tuple[str, ...]) -> None:
    print(f"{title} (in use):")
    for term, weight, used in zip(terms, weights, in_use, strict=True):
        print(f"  {weight:7.2f} ({used:g}) {term}")


def print_score(pairs: list[Pair], numbers: ScoreNumbers) -> None:
    everything = fitted_score(pairs, numbers)
    print_weights("score", everything, numbers.score, numbers.score_names())
    print("right with weights fitted to the other logs, with weights fitted to all:")
    for log in sorted({pair.log for pair in pairs}):
        others = fitted_score([pair for pair in pairs if pair.log != log], numbers)
        for gap in GAPS:
            own = [pair for pair in pairs if pair.log == log and pair.gap == gap]
            shares = [share_right(own, weights, numbers) for weights in (others, everything)]
            print(f"  {log} gap {gap}: {shares[0]:.4f} {shares[1]:.4f}")


def print_probability(pairs: list[Pair], numbers: ScoreNumbers) -> None:
    weights = fitted_probability(pairs, numbers)
    print_weights("log odds of the probability", weights, numbers.probability, numbers.probability_names())
    for gap in (*GAPS, 0):
        own = [pair for pair in pairs if pair.gap == gap]
        stated = 1 / (1 + np.exp(-np.array([probability_terms(pair, numbers) for pair in own]) @ weights))
        right = np.array([pair.right[0] for pair in own])
        sure = stated >= SURE
        of_these = f"{right[sure].mean():.4f} of these right" if sure.any() else "none of these"
        name = f"gap {gap}" if gap else "different logs"
        print(f"  {name}: {sure.mean():.4f} stated as {SURE} or more, {of_these}")


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add_logs(parser)
    add_program(parser)
    parser.add_argument("--cross", type=int, default=4000, metavar="N", help="pairs from different logs")
    arguments = parser.parse_args(argv)
    if len(arguments.logs) < 2:
        parser.error("two logs or more are needed: each is judged by weights from the others")
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    paths, cli = [found_log(log) for log in arguments.logs], arguments.cli.resolve()
    try:
        numbers = ScoreNumbers.of(numbers_of(cli))
        pairs = [pair for path in paths for pair in pairs_of_log(cli, path)]
        print_score(pairs, numbers)
        print_probability(pairs + pairs_of_different_logs(cli, paths, arguments.cross), numbers)
    except (Failure, OSError, ValueError) as error:
        complain(__name__, str(error))
        return 1
    return 0
