# SPDX-License-Identifier: GPL-3.0-or-later
"""The fit of the score and of the probability, on made-up pairs."""

import numpy as np
import pytest

from evaluation.commands.fit_scores import main, print_weights
from evaluation.fitting.score_fits import (
    Pair,
    ScoreNumbers,
    fitted_probability,
    fitted_score,
    probability_terms,
    share_right,
)
from evaluation.pairs.outcomes import is_right
from evaluation_support import numbers

UNKNOWN = np.zeros(2, bool)
IN_USE = ScoreNumbers.of(numbers())


def hypothesis(score=0.0, **shares):
    return {"agree": 0.3, "unclear": 0.1, "cross_agree": 0.3, "crossed": 0.05, "rms_m": 0.03, "score": score} | shares


def pairs_that_agreement_decides(count=200):
    """The right one agrees more, and being crossed means nothing."""
    random = np.random.default_rng(3)
    pairs = []
    for _ in range(count):
        shares = random.uniform(0.05, 0.6, 4)
        hypotheses = [hypothesis(agree=share, crossed=random.uniform(0, 0.3)) for share in shares]
        pairs.append(Pair("a.log", 1, hypotheses, shares == shares.max()))
    return pairs


def test_the_score_finds_what_decides():
    pairs = pairs_that_agreement_decides()
    weights = fitted_score(pairs, IN_USE)
    assert weights[0] > 5 * abs(weights[2])
    assert share_right(pairs, weights, IN_USE) > 0.95


def test_the_score_of_pairs_that_nothing_tells_apart_is_nothing():
    same = [Pair("a.log", 1, [hypothesis(), hypothesis()], np.array([True, False]))] * 10
    assert fitted_score(same, IN_USE) == pytest.approx(np.zeros(4), abs=1e-6)


def test_the_probability_grows_with_the_margin():
    random = np.random.default_rng(5)
    pairs = []
    for _ in range(400):
        margin = random.uniform(0, 8)
        right = random.uniform() < 1 / (1 + np.exp(4 - 2 * margin))
        pairs.append(Pair("a.log", 1, [hypothesis(margin), hypothesis(0.0)], np.array([right, False])))
    weights = fitted_probability(pairs, IN_USE)
    asked = [Pair("", 1, [hypothesis(margin), hypothesis(0.0)], UNKNOWN) for margin in (1, 3, 6)]
    odds = [np.dot(weights, probability_terms(pair, IN_USE)) for pair in asked]
    assert odds[0] < odds[1] < odds[2]


def test_margins_are_bounded():
    alone = Pair("", 1, [hypothesis(2.0)], UNKNOWN)
    tie = Pair("", 1, [hypothesis(2.0), hypothesis(2.0)], UNKNOWN)
    assert probability_terms(alone, IN_USE)[1] == 15.0
    assert probability_terms(tie, IN_USE)[1] == 0.1


def test_terms_are_those_of_the_mapper_and_its_weights_stand_beside(capsys):
    terms = Pair("", 1, [hypothesis()], UNKNOWN).terms(IN_USE)[0]
    assert terms == pytest.approx([np.log(0.40), np.log(0.36), np.log(0.08), 0.6])
    assert IN_USE.score == pytest.approx((7.0, 1.5, -3.0, -2.0))
    assert IN_USE.probability == (-0.5, 0.7, 0.2, 0.5, 1.0)
    print_weights("score", np.array([1.0, 2.0, 3.0, 4.0]), IN_USE.score, IN_USE.score_names())
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "score (in use):"
    assert lines[1] == "     1.00 (7) log(0.05 + agree + 0.5 unclear)"
    assert lines[4] == "     4.00 (-2) rms_m / 0.05"


@pytest.mark.parametrize(
    ("pose", "right"), [([1.1, 0, 0], True), ([1.3, 0, 0], False), ([1, 0, 0.05], True), ([1, 0, 0.1], False)]
)
def test_right_is_within_twenty_centimetres_and_five_degrees(pose, right):
    assert is_right(pose, np.array([1.0, 0.0, 0.0])) is right


def test_one_log_cannot_judge_itself(capsys):
    with pytest.raises(SystemExit) as exit_status:
        main(["a.log"])
    assert exit_status.value.code == 2
    assert "two logs" in capsys.readouterr().err
