# SPDX-License-Identifier: GPL-3.0-or-later
"""The judge of real logs, on poses known by hand."""

import sys

import numpy as np
import pytest

from evaluation.commands.logs import main, markdown
from evaluation.judging.consecutive_pairs import LogScore, pair_errors, reference_poses
from evaluation.mapping.mapper import METHOD_ARGUMENTS


def test_a_pair_with_an_unplaced_scan_is_never_right():
    poses = [np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([2.0, 0.0, 0.0])]
    errors = pair_errors(poses, {0: poses[0], 1: np.array([1.1, 0.0, 0.1])})
    assert errors[0] == pytest.approx((0.1, np.degrees(0.1)))
    assert errors[1] == (float("inf"), float("inf"))


def test_errors_do_not_depend_on_where_the_map_lies():
    rng = np.random.default_rng(1)
    poses = [rng.uniform(-3, 3, 3) for _ in range(5)]
    cos, sin = np.cos(0.7), np.sin(0.7)
    moved = {}
    for i, (x, y, theta) in enumerate(poses):
        moved[i] = np.array([cos * x - sin * y + 4, sin * x + cos * y - 9, theta + 0.7])
    assert np.array(pair_errors(poses, moved)) == pytest.approx(np.zeros((4, 2)), abs=1e-9)


def test_reference_poses_are_the_first_three_fields_after_the_ranges(tmp_path):
    log = tmp_path / "a.log"
    log.write_text("ODOM 9 9 9 0 0 0 1 h 1\nFLASER 2 5.0 6.0 1 2 3 7 8 9 1.0 h 1.0\n")
    assert [list(pose) for pose in reference_poses(log)] == [[1.0, 2.0, 3.0]]


def test_the_table_has_the_mean_of_the_logs():
    table = markdown([LogScore("a", 11, 11, 10, 0.03, 1.0, 80.0), LogScore("b", 11, 6, 5, 0.03, 1.0, 80.0)])
    assert "| a | 11 | 11 | 100.0 %" in table
    assert "| mean | | | 75.0 %" in table


@pytest.mark.parametrize(("chosen", "method"), [([], "robust"), (["--method", "paper"], "paper")])
def test_the_mapper_is_told_the_method_and_what_is_passed_on(tmp_path, capsys, chosen, method):
    (tmp_path / "a.log").write_text("FLASER 1 5.0 0 0 0 0 0 0 1.0 h 1.0\n" * 2)
    mapper = tmp_path / "mapper"
    mapper.write_text(f"#!{sys.executable}\nimport sys\nsys.exit(' '.join(sys.argv))\n")
    mapper.chmod(0o755)
    assert main([str(tmp_path / "a.log"), "--cli", str(mapper), *chosen, "--arg=--threads", "--arg=2"]) == 1
    assert " ".join([*METHOD_ARGUMENTS[method], "--threads", "2"]) in capsys.readouterr().err
