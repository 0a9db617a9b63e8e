# SPDX-License-Identifier: GPL-3.0-or-later
"""Metrics of trajectories and maps, against values worked out by hand or by other means."""

from __future__ import annotations

import numpy as np
import pytest

from evaluation.common.poses import compose
from evaluation.judging import consecutive_pairs
from evaluation.maps import trajectory_errors
from evaluation.maps.ceiling import chain
from evaluation.maps.map_agreement import map_agreement, occupied_cells, share_near
from evaluation_support import straight

LOOP = np.array([[0.0, 0, 0], [4, 0, 0.3], [4, 3, 1.5], [1, 5, 3.0], [-2, 2, -2.0], [-1, 0, -1.0]])
SOMEWHERE = np.array([12.0, -7.0, 2.1])


def placed(poses: np.ndarray) -> dict[int, np.ndarray]:
    return dict(enumerate(poses))


def test_pairs_are_right_within_both_limits() -> None:
    poses = straight(6)
    poses[1:, 0] += 0.19  # within 0.20 m
    poses[2:, 0] += 0.21  # beyond
    poses[3:, 2] += np.radians(4.9)
    found = consecutive_pairs.pairs(straight(5), [placed(poses[:4])])
    assert found["right"] == [1, 0, 1, 0]
    assert found["error_m"] == [pytest.approx(0.19), pytest.approx(0.21), pytest.approx(0.0), None]
    assert found["error_deg"][2] == pytest.approx(4.9)


def test_a_pair_across_fragments_is_wrong_and_one_inside_of_any_counts() -> None:
    poses = straight(5)
    fragments = [{0: poses[0], 1: poses[1]}, {2: compose(SOMEWHERE, poses[2]), 3: compose(SOMEWHERE, poses[3])}]
    assert consecutive_pairs.pairs(poses, fragments)["right"] == [1, 0, 1, 0]


def test_a_moved_map_has_no_error() -> None:
    found = trajectory_errors.trajectory_errors(LOOP, placed(compose(SOMEWHERE, LOOP)))
    assert found["ate"]["rmse_m"] == pytest.approx(0.0, abs=1e-9)
    assert found["ate"]["rmse_deg"] == pytest.approx(0.0, abs=1e-5)
    assert compose(found["aligned_by"], SOMEWHERE) == pytest.approx(np.zeros(3), abs=1e-9)


def test_a_mirrored_map_is_not_turned_upside_down_in_space() -> None:
    """In space a turn about the x axis would make it fit."""
    found = trajectory_errors.trajectory_errors(LOOP, placed(LOOP * [1.0, -1.0, -1.0]))
    assert found["ate"]["rmse_m"] > 1.0


def best_by_search(reference: np.ndarray, found: np.ndarray) -> float:
    """Root mean square error over a fine grid of turns, each with the best shift."""
    best = np.inf
    for angle in np.linspace(-np.pi, np.pi, 20001):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        off = reference - found @ turn.T
        best = min(best, float(np.sqrt(((off - off.mean(axis=0)) ** 2).sum(axis=1).mean())))
    return best


def test_the_absolute_error_is_the_least_that_any_motion_leaves() -> None:
    rng = np.random.default_rng(3)
    bent = compose(SOMEWHERE, LOOP + rng.normal(0, 0.4, LOOP.shape))
    found = trajectory_errors.trajectory_errors(LOOP, placed(bent))
    assert found["ate"]["rmse_m"] == pytest.approx(best_by_search(LOOP[:, :2], bent[:, :2]), rel=1e-5)
    assert [k for k, _ in found["ate"]["error_m"]] == list(range(6))


def test_only_placed_positions_count_and_three_are_needed() -> None:
    some = {k: LOOP[k] for k in (0, 2, 5)}
    assert trajectory_errors.trajectory_errors(LOOP, some)["ate"]["rmse_m"] == pytest.approx(0.0, abs=1e-9)
    two = trajectory_errors.trajectory_errors(LOOP, {k: LOOP[k] for k in (0, 2)})
    assert two == {"ate": None, "rpe": None, "rpe_10m": None, "aligned_by": None}


def test_positions_at_one_place_cannot_be_aligned_and_those_on_a_line_can() -> None:
    assert trajectory_errors.alignment(LOOP, placed(np.zeros((6, 3)))) is None
    assert trajectory_errors.alignment(straight(4), placed(straight(4))) == pytest.approx(np.zeros(3), abs=1e-9)


def test_the_relative_error_is_that_of_each_step() -> None:
    """Steps of 1.1 m instead of 1 m: each is 0.1 m off, and ten of them 1 m."""
    found = trajectory_errors.trajectory_errors(straight(30), placed(straight(30, 1.1)))
    assert found["rpe"]["rmse_m"] == pytest.approx(0.1)
    assert found["rpe"]["rmse_deg"] == pytest.approx(0.0, abs=1e-6)
    # 20 stretches of 10 m, and one of 9 m at the end, which is within evo's tolerance.
    assert found["rpe_10m"]["rmse_m"] == pytest.approx(np.sqrt((20 * 1.0**2 + 0.9**2) / 21))
    assert trajectory_errors.trajectory_errors(straight(5), placed(straight(5)))["rpe_10m"] is None, "4 m of path"


def test_one_turn_costs_one_step_but_all_of_the_map() -> None:
    turned = straight(20)
    turned[10:] = compose([9.0, 0.0, np.pi / 2], straight(11)[1:])
    found = trajectory_errors.trajectory_errors(straight(20), placed(turned))
    assert found["rpe"]["median_m"] == pytest.approx(0.0, abs=1e-9)
    assert found["rpe"]["max_m"] == pytest.approx(np.sqrt(2.0))
    assert found["ate"]["rmse_m"] > 2.0


def wall(y_m: float = 0.0) -> np.ndarray:
    """Points in the middle of twenty cells in a row."""
    return np.stack([0.025 + 0.05 * np.arange(20), np.full(20, 0.025 + y_m)], axis=-1)


def test_cells_are_counted_once() -> None:
    twice = occupied_cells({0: np.zeros(3), 1: np.zeros(3)}, [wall(), wall() + 0.01])
    assert twice == pytest.approx(wall())
    assert occupied_cells({}, []).shape == (0, 2)


@pytest.mark.parametrize(("shift_m", "share"), [(0.05, 1.0), (0.10, 1.0), (0.15, 0.0)])
def test_a_cell_agrees_within_ten_centimetres(shift_m: float, share: float) -> None:
    assert share_near(wall(), wall(shift_m)) == share
    assert share_near(wall(), wall()[:0]) == 0.0
    assert share_near(wall()[:0], wall()) is None


def test_agreement_of_a_map_with_one_of_two_walls_displaced() -> None:
    """Seen from two positions; the second is placed half a metre off along y, so its wall is."""
    points = [wall(), wall(2.0)]
    truth = np.zeros((2, 3))
    found = map_agreement(truth, {0: np.zeros(3), 1: np.array([0.0, 0.5, 0.0])}, points, np.zeros(3))
    assert found == {"precision": 0.5, "recall": 0.5, "num_cells": 40}
    half = map_agreement(truth, {0: np.zeros(3)}, points, np.zeros(3))
    assert half == {"precision": 1.0, "recall": 0.5, "num_cells": 20}


def test_the_map_is_aligned_before_it_is_compared() -> None:
    away = {k: compose(SOMEWHERE, pose) for k, pose in enumerate(LOOP)}
    reference_from_map = trajectory_errors.alignment(LOOP, away)
    assert reference_from_map is not None
    found = map_agreement(LOOP, away, [wall()] * 6, reference_from_map)
    assert (found["precision"], found["recall"]) == (1.0, 1.0)


def test_refined_poses_are_chained_and_a_gap_begins_a_fragment() -> None:
    step = [1.0, 0.0, np.pi / 2]
    fragments = chain([step, step, None, step])
    assert [sorted(fragment) for fragment in fragments] == [[0, 1, 2], [3, 4]]
    assert fragments[0][2] == pytest.approx([1.0, 1.0, np.pi])
