# SPDX-License-Identifier: GPL-3.0-or-later
"""The fit of how probable links are, on made-up links, and the program around a made-up mapper."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evaluation.commands import fit_edges as fit_edges_command
from evaluation.fitting.edge_fits import (
    Candidates,
    EdgeNumbers,
    calibration_table,
    fitted_neighbours,
    fitted_revision,
    is_place,
    mean_log_likelihood,
    slides_to,
)
from evaluation_support import NUMBERS, numbers, program, reporter, written_log

IN_USE = EdgeNumbers.of(numbers())
NEIGHBOURS = IN_USE.neighbours
PLACES = np.array([[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, 2.0, 1.0], [1.1, 0.1, 0.02]])  # the last is the first


def candidates(scores: list[float], right: int = -1, **columns: Any) -> Candidates:
    """At PLACES, of which number `right` is the true one."""
    count = len(scores)
    nothing = dict.fromkeys(("for_it", "against_it", "deviations_m", "vouched"), np.zeros(count))
    given: dict[str, Any] = {**nothing, "in_map": 0, **columns}
    is_right = np.array([right >= 0 and is_place(pose, PLACES[right], IN_USE) for pose in PLACES[:count]], bool)
    return Candidates(PLACES[:count], np.array(scores), right=is_right, numbers=IN_USE, **given)


@pytest.mark.parametrize(
    ("pose", "same"), [([1.3, 0, 0], True), ([1.5, 0, 0], False), ([1, 0, 0.13], True), ([1, 0, 0.15], False)]
)
def test_one_place_is_forty_centimetres_and_eight_degrees(pose: list[float], same: bool) -> None:
    assert is_place(np.array(pose), PLACES[0], IN_USE) is same


def test_neighbours_are_no_rivals() -> None:
    two, four = candidates([2.0, 0.0]), candidates([2.0, 0.0, -30.0, 2.0])
    places, shares = four.probabilities((1.0, 0.0, 0.0, -9.0, 1.0, 0.0, 0.0, 0.0))
    assert places == [0, 1, 2]
    assert shares[0] == pytest.approx(two.probabilities((1.0, 0.0, 0.0, -9.0, 1.0, 0.0, 0.0, 0.0))[1][0], rel=1e-4)


def test_it_may_be_none_of_them() -> None:
    bad = candidates([-8.0, -9.0])
    assert bad.likelihood((1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)) > 0.99
    assert candidates([-8.0, -9.0], right=0).likelihood((1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)) < 0.01


def drawn(weights: tuple[float, ...], count: int) -> list[Candidates]:
    """Links whose truth is drawn by `weights`."""
    random = np.random.default_rng(7)
    links = []
    for _ in range(count):
        scores = random.uniform(-6, 4, 3)
        said: dict[str, Any] = {name: random.uniform(0, 8, 3) for name in ("for_it", "against_it")}
        said["view_shortfall"] = random.choice([0.0, 0.2, 0.4])
        said["deviations_m"] = random.choice([0.02, 10.0], 3)
        said["vouched"] = random.choice([0.0, 5.0], 3)
        unknown = candidates(list(scores), **said)
        places, shares = unknown.probabilities(weights)
        right = random.choice([*places, -1], p=[*shares, 1 - shares.sum()])
        links.append(candidates(list(scores), int(right), **said))
    return links


def test_the_weights_that_made_the_links_are_found() -> None:
    weights = (1.0, 4.0, 0.5, -3.0, 1.2, 14.0, -0.8, 0.3)
    links = drawn(weights, 500)
    found = fitted_revision(links, IN_USE.revision, range(8))
    assert found[:4] == pytest.approx(weights[:4], abs=0.6)
    assert found[5] == pytest.approx(weights[5], abs=3.0)
    assert found[6:] == pytest.approx(weights[6:], abs=0.25)
    assert mean_log_likelihood(links, found) >= mean_log_likelihood(links, IN_USE.revision)


def test_what_is_stated_of_lone_links_is_fitted_when_it_is_wrong() -> None:
    random = np.random.default_rng(3)
    stated, shortfall = random.uniform(0.02, 0.98, 4000), random.choice([0.0, 0.2], 4000)
    found = fitted_neighbours(stated, shortfall, random.uniform(size=4000) < stated, NEIGHBOURS, range(3))
    assert found[:2] == pytest.approx(NEIGHBOURS[:2], abs=0.2)
    assert found[2] == pytest.approx(NEIGHBOURS[2], abs=1.5)
    sobered = fitted_neighbours(stated, shortfall, random.uniform(size=4000) < 0.5 * stated, NEIGHBOURS, range(3))
    assert sobered[0] < found[0] - 0.5
    half_blind = random.uniform(size=4000) < np.where(shortfall > 0, 0.5, 1) * stated
    for free in (range(3), [2]):
        blinded = fitted_neighbours(stated, shortfall, half_blind, NEIGHBOURS, free)
        assert blinded[2] < found[2] - 3.0
    assert blinded[:2] == list(NEIGHBOURS[:2])


def test_what_is_not_seen_speaks_for_none_of_them() -> None:
    weights = (1.0, 0.0, 0.0, -1.0, 1.0, 10.0, 0.0, 0.0)
    wide, narrow = candidates([2.0, 0.0], right=0), candidates([2.0, 0.0], right=0, view_shortfall=0.2)
    assert narrow.likelihood(weights) < wide.likelihood(weights) - 0.1


def test_what_is_hardly_held_counts_less_and_what_a_parallel_link_says_more() -> None:
    weights = (1.0, 0.0, 0.0, -1.0, 1.0, 0.0, -0.5, 0.5)
    plain = candidates([2.0, 2.0], right=0)
    loose = candidates([2.0, 2.0], right=0, deviations_m=np.array([9.0, 0.0]))
    vouched = candidates([2.0, 2.0], right=0, vouched=np.array([4.0, 0.0]))
    assert loose.likelihood(weights) < plain.likelihood(weights) - 0.1
    assert vouched.likelihood(weights) > plain.likelihood(weights) + 0.1


def test_the_table_counts_what_is_right() -> None:
    table = calibration_table(np.array([0.6, 0.65, 1.0]), np.array([True, False, True]))
    assert "| 0.5 to 0.7 | 2 | 50.0 % | 62.5 % |" in table
    assert "| 0.99 to 1 | 1 | 100.0 % | 100.0 % |" in table


@pytest.mark.parametrize(
    ("pose", "same"), [([2.3, 0, 0], True), ([3, 0, 0], False), ([1, 0.5, 0], False), ([1.5, 0, 0.2], False)]
)
def test_along_a_corridor_it_may_slide(pose: list[float], same: bool) -> None:
    assert slides_to(np.array(pose), np.diag([100.0, 1e-4, 1e-4]), PLACES[0], IN_USE) is same


# A metre from scan to scan, which is right; the second link was judged by all scans.
CHANGE = """
COVARIANCE = [[1e-4, 0, 0], [0, 1e-4, 0], [0, 0, 1e-4]]
for position in positions:
    position.update(held_by_loops=False, is_keyframe=True, alignment=None)
    if position['index'] > 0:
        position['alignment'] = dict(reference=position['index'] - 1, probability=0.9,
                                     ref_from_query=dict(x_m=1.0, y_m=0.0, theta_deg=0.0))
if '--trace' in words:
    def hypothesis(x_m, score):
        said = dict(for_it=3.0 - x_m, against_it=x_m, vouched=0.0)
        return dict(pose=[x_m, 0.0, 0.0], score=score, covariance=COVARIANCE, **said)
    record = dict(record='revision', reference=1, query=2, hypotheses=[hypothesis(2.0, 1.0), hypothesis(1.0, 0.0)],
                  in_map=0, alternative=1, probability=0.75)
    links = [dict(record='link', reference=k - 1, query=k, view_shortfall=0.1) for k in range(1, len(positions))]
    with open(words[words.index('--trace') + 1], 'w') as trace:
        for line in [dict(record='run'), *links, record]:
            trace.write(json.dumps(line, separators=(',', ':')) + chr(10))
"""


def test_the_program_holds_what_is_stated_against_the_truth(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = [str(written_log(tmp_path)), "--cli", str(reporter(tmp_path, CHANGE)), "--variants", "whole", "--jobs", "1"]
    assert fit_edges_command.main([*words, "--json", str(tmp_path / "out.json")]) == 0
    out = capsys.readouterr().out
    assert "5 lone links" in out
    assert "(in use: 2.5 + 0.6 -10)" in out
    assert "(0.7) score" in out
    assert "(20) none of them, per view shortfall" in out
    assert "| 0.9 to 0.95 | 5 | 100.0 % | 90.0 % |" in out
    assert "1 links in doubt" in out
    assert "| 0.7 to 0.8 | 1 | 100.0 % | 75.0 % |" in out
    found = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))[0]
    assert found["lone"] == [[0.9, 0.1, True]] * 5
    assert found["stated"] == [[0.75, True]]


def test_a_mapper_that_fails_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = [str(written_log(tmp_path)), "--cli", str(reporter(tmp_path, "sys.exit('out of luck')"))]
    assert fit_edges_command.main([*words, "--variants", "whole"]) == 1
    assert "out of luck" in capsys.readouterr().err


def test_weights_in_use_are_those_of_the_mapper() -> None:
    told = NUMBERS["inference"]["verification_weights"]
    assert IN_USE.revision[:4] == (told["per_score"], told["by_others"], told["of_map"], told["none_of_them"])
    assert IN_USE.revision[4:] == (1.5, 20.0, -0.4, 0.6)
    assert IN_USE.neighbours == (2.5, 0.6, -10.0)
    assert (IN_USE.same_m, IN_USE.same_rad, IN_USE.least_score) == (0.4, 0.14, -12.0)


def test_a_mapper_that_does_not_tell_its_numbers_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    silent = program(tmp_path / "silent", "print('[]')")
    assert fit_edges_command.main([str(written_log(tmp_path)), "--cli", str(silent), "--variants", "whole"]) == 1
    assert "the mapper has no number inference.verification_weights.per_score" in capsys.readouterr().err


def test_nothing_to_look_at_is_wrong_usage() -> None:
    with pytest.raises(SystemExit, match="2"):
        fit_edges_command.main([])
