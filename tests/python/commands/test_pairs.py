# SPDX-License-Identifier: GPL-3.0-or-later
"""The judge of single pairs: logs with known poses, made-up answers with known mistakes, a made-up program."""

from __future__ import annotations

import gzip
import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evaluation.commands import pairs as pairs_command
from evaluation.logs.reference_log import ReferenceLog, no_return_m, read_reference_log, strip_carmen
from evaluation.pairs.outcomes import PairOutcome, judge, overlap_of
from evaluation.pairs.program import random_cross_pairs
from evaluation.pairs.tables import (
    confidence_rows,
    reliability,
    rotation_band,
    success_markdown,
    success_row,
    success_tables,
)

POSES = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.5, 0.3), (2.5, 1.5, 1.0)]
RIGHT = PairOutcome("a", 1, 0, 1, 0.8, 10.0, (1.0, 0.0, 0.0), "ok", probability=0.99, error_m=0.04, error_deg=1, rank=0)


def carmen_text(poses: list[tuple[float, float, float]]) -> str:
    lines = ["# remark with 1.25", "PARAM robot_front_laser_max 50.0", "PARAM robot_frontlaser_offset 9.75"]
    for i, (x, y, theta) in enumerate(poses):
        ranges = " ".join(f"{2 + 0.01 * k:.2f}" for k in range(180)) + " 81.83"
        lines += [f"ODOM {x} {y} {theta} 0 0 0 {i} robot {i}"]
        lines += [f"FLASER 181 {ranges} {x} {y} {theta} 7.125 8.125 9.125 {i}.5 robot {i}.5"]
    return "\n".join(lines) + "\n"


@pytest.fixture
def log(tmp_path: Path) -> ReferenceLog:
    (tmp_path / "a.log").write_text(carmen_text(POSES), encoding="utf-8")
    return read_reference_log(tmp_path / "a.log")


def hypothesis(pose: Any, score: float) -> dict[str, Any]:
    return {"pose": [float(value) for value in pose], "score": score}


def answer(log: ReferenceLog, offsets: list[float], status: str = "ok", refined_offset: float = 0.01) -> dict[str, Any]:
    """For positions 0 and 1: hypotheses that are so many metres off, with scores 5, 4, ...; the reference has 2."""
    truth = log.ref_from_query(0, 1)
    off = np.array([0.0, 1.0, 0.0])
    return {
        **{"reference": 0, "query": 1, "status": status, "reason": "", "probability": 0.7 if offsets else None},
        "hypotheses": [hypothesis(truth + offset * off, 5.0 - k) for k, offset in enumerate(offsets)],
        "given": hypothesis(truth, 1.5),
        "refined": hypothesis(truth + refined_offset * off, 2.0),
    }


def test_a_carmen_log_gives_poses_points_and_a_copy_without_poses(log: ReferenceLog) -> None:
    assert len(log) == 4
    assert log.ref_from_query(0, 2) == pytest.approx([2.0, 0.5, 0.3])
    assert log.points[0].shape == (180, 2), "the last beam has no return"
    assert log.points[0][0] == pytest.approx([0.0, -2.0], abs=1e-9)
    assert log.without_poses.count("FLASER 181 2.00 2.01") == 4
    for trace in ("ODOM", "7.125", "offset", "remark", " 2.0 0.5 0.3"):
        assert trace not in log.without_poses
    assert "PARAM robot_front_laser_max 50.0" in log.without_poses
    assert log.without_poses.splitlines()[2].endswith(" 81.83 0 0 0 0 0 0 1.5 robot 1.5")


def test_stripping_twice_changes_nothing() -> None:
    once = strip_carmen(carmen_text(POSES))
    assert strip_carmen(once) == once


def test_a_packed_log_is_read_and_one_without_scans_refused(tmp_path: Path) -> None:
    (tmp_path / "a.log.gz").write_bytes(gzip.compress(carmen_text(POSES[:2]).encode()))
    assert len(read_reference_log(tmp_path / "a.log.gz")) == 2
    (tmp_path / "none.log").write_text("ODOM 1 2 3\n", encoding="utf-8")
    with pytest.raises(ValueError, match="no FLASER line"):
        read_reference_log(tmp_path / "none.log")


def test_an_arena_gives_the_points_of_all_its_sub_scans(tmp_path: Path) -> None:
    (tmp_path / "a.nist").write_text(
        "shapemap-scans 1\nunits m deg\nsensor laser beams 3 first_angle -90 angle_step 90 max_range 20\n"
        "position 0.0 reference 1 2 90\nscan laser heading 0 ranges 1 2 -\nscan laser heading 180 ranges - 3 -\n"
        "position 1.0 reference 1 3 90\nscan laser heading 0 ranges 1 2 -\nscan laser heading 180 ranges - 3 20\n",
        encoding="utf-8",
    )
    log = read_reference_log(tmp_path / "a.nist")
    assert log.ref_from_query(0, 1) == pytest.approx([1.0, 0.0, 0.0])
    assert log.points[0] == pytest.approx(np.array([[0.0, -1.0], [2.0, 0.0], [-3.0, 0.0]]))
    assert "reference" not in log.without_poses
    assert "position 1.0\n" in log.without_poses
    assert log.ending == ".nist"


def test_the_distance_without_return_is_one_that_comes_over_and_over() -> None:
    assert no_return_m([np.array([3.0, 50.0])] * 10) == 50.0
    assert no_return_m([np.array([3.0, 50.0])] * 9) == 81.8
    assert no_return_m([np.array([81.83])] * 20) == 81.8


def test_overlap_counts_the_points_of_both_scans() -> None:
    row = np.stack([np.arange(10.0), np.zeros(10)], axis=-1)
    assert overlap_of(row, row, np.zeros(3)) == 1.0
    assert overlap_of(row, row, np.array([5.1, 0.0, 0.0])) == pytest.approx(0.5)
    assert overlap_of(row, row, np.array([0.5, 0.0, 0.0])) == 0.0
    assert overlap_of(row, row[:0], np.zeros(3)) == 0.0


@pytest.mark.parametrize(
    ("offsets", "status", "failure"),
    [
        ([0.1], "ok", ""),
        ([0.1], "ambiguous", ""),
        ([0.19, 1.0], "degenerate", ""),
        ([0.21], "ok", "search"),
        ([1.0, 2.0], "ok", "search"),
        ([1.0, 2.0, 0.1], "ok", "score"),
        ([0.1], "too-little-overlap", "no pose"),
        ([], "no-correspondences", "search"),
    ],
)
def test_a_failure_has_one_cause(log: ReferenceLog, offsets: list[float], status: str, failure: str) -> None:
    pair = judge(log, 0, 1, answer(log, offsets, status), doubt_margin=1.0)
    assert pair.failure == failure
    assert pair.is_right == (failure == "")
    assert pair.refined_is_right


def test_a_turn_of_more_than_five_degrees_is_wrong(log: ReferenceLog) -> None:
    turned = answer(log, [0.0])
    turned["hypotheses"][0]["pose"][2] += np.deg2rad(5.1) + 2 * np.pi
    pair = judge(log, 0, 1, turned, 1.0)
    assert pair.failure == "search"
    assert pair.error_deg == pytest.approx(5.1)


def test_the_reference_is_in_doubt_when_a_better_pose_is_near_it(log: ReferenceLog) -> None:
    def in_doubt(offset: float, margin: float) -> bool:
        return judge(log, 0, 1, answer(log, [offset]), margin).in_doubt

    assert in_doubt(0.3, 1.0)
    assert not in_doubt(0.3, 3.5), "scores are 5 against 2"
    assert not in_doubt(0.6, 1.0)
    assert not in_doubt(0.1, 1.0), "no failure"
    assert not in_doubt(0.3, 3.1)
    drifting = answer(log, [0.3], refined_offset=0.3)
    assert judge(log, 0, 1, drifting, 3.1).in_doubt, "refined to the pose that was found: the other one has 1.5"


def test_a_search_that_missed_a_better_reference_is_told_from_one_that_would_not_have_helped(log: ReferenceLog) -> None:
    missed = answer(log, [1.0])
    assert not judge(log, 0, 1, missed, 1.0).reference_would_win
    missed["hypotheses"][0]["score"] = 1.9
    assert judge(log, 0, 1, missed, 1.0).reference_would_win
    assert judge(log, 0, 1, answer(log, []), 1.0).reference_would_win


def test_scans_without_shape_are_failures_with_no_reference_score(log: ReferenceLog) -> None:
    pair = judge(log, 0, 1, {**answer(log, [], "no-shape"), "given": None, "refined": None}, 1.0)
    assert pair.failure == "search"
    assert pair.probability == 0.0
    assert not pair.refined_is_right
    assert not pair.reference_would_win


def test_answers_to_other_pairs_are_refused(log: ReferenceLog) -> None:
    with pytest.raises(ValueError, match="asked for 1 2, answered 0 1"):
        judge(log, 1, 2, answer(log, [0.0]), 1.0)


def test_the_mean_gives_each_log_the_same_weight() -> None:
    wrong = replace(RIGHT, rank=-1)
    pairs = [RIGHT, RIGHT, RIGHT, wrong, replace(RIGHT, log="b"), replace(wrong, log="b", error_m=9.0)]
    row = success_row("all", pairs)
    assert (row.right.count, row.right.total) == (4, 6)
    assert row.log_mean == pytest.approx((0.75 + 0.5) / 2)
    assert row.median_m == pytest.approx(0.04), "of those that are right"
    assert row.failures == {"search": 2, "score": 0, "no pose": 0}
    assert "| all | 6 | 66.7 % (30.0-90.3) | 62.5 % | 4.0 cm, 1.00 deg | 0.0 %" in success_markdown("log", [row])


def test_every_pair_is_in_one_row_of_each_table() -> None:
    pairs = [replace(RIGHT, gap=g, overlap=0.2 * g, rotation_deg=44.0 * g) for g in (1, 2, 3, 4)]
    for title, rows in success_tables(pairs, {}).items():
        assert sum(row.right.total for row in rows if row.name != "all") == 4, title
    assert [rotation_band(turn) for turn in (0, 14.9, 15, 90, 180)] == ["0-15", "0-15", "15-45", "90-180", "90-180"]


def test_confidence_is_about_the_first_hypothesis() -> None:
    pairs = [RIGHT, replace(RIGHT, rank=1), replace(RIGHT, probability=0.05, status="ambiguous", rank=-1)]
    row = confidence_rows(pairs)[-1]
    assert (row.sure.count, row.sure.total) == (2, 3)
    assert (row.right_when_sure.count, row.right_when_sure.total) == (1, 2)
    assert row.brier == pytest.approx((0.01**2 + 0.99**2 + 0.05**2) / 3)
    bins = reliability([*pairs, replace(RIGHT, probability=1.0)])
    assert [b.right.total for b in bins] == [1, 0, 0, 0, 0, 0, 0, 0, 0, 3]
    assert bins[9].mean_probability == pytest.approx((0.99 * 2 + 1) / 3)
    assert bins[9].right.count == 2


def test_cross_pairs_are_of_different_logs_and_the_same_for_a_seed(log: ReferenceLog) -> None:
    logs = [log, replace(log, name="b"), replace(log, name="c")]
    drawn = random_cross_pairs(logs, 200, seed=3)
    assert sum(map(len, drawn.values())) == 200
    assert len(drawn) == 6
    assert all(a != b for a, b in drawn)
    assert drawn == random_cross_pairs(logs, 200, seed=3)
    assert drawn != random_cross_pairs(logs, 200, seed=4)
    assert random_cross_pairs(logs[:1], 200, seed=3) == {}


PROGRAM = """
import json, pathlib, sys
words = sys.argv[1:]
assert words[0] == 'align' and '--passed-on' in words
logs = words[1:words.index('--pairs')]
for path in logs:
    assert '7.125' not in pathlib.Path(path).read_text()
lines = [line.split() for line in open(words[words.index('--pairs') + 1])]
answers = []
for line in lines:
    good = len(line) == 5 and line[0] != '1'
    pose = [float(word) for word in line[2:]] or [0, 0, 0]
    hypothesis = {'pose': pose if good else [pose[0] + 1, *pose[1:]], 'score': 5}
    given = {'given': {'pose': pose, 'score': 3}, 'refined': {'pose': pose, 'score': 3}} if len(logs) == 1 else {}
    answers.append({'reference': int(line[0]), 'query': int(line[1]), 'status': 'ok' if good else 'ambiguous',
                    'reason': '', 'probability': 0.99 if good else None, 'hypotheses': [hypothesis], **given})
with open(words[words.index('--out') + 1], 'w') as out:
    out.writelines(json.dumps(answer) + '\\n' for answer in answers)
"""


def made_up_program(folder: Path, body: str) -> str:
    path = folder / "program"
    path.write_text(f"#!{sys.executable}\n{body}\n", encoding="utf-8")
    path.chmod(0o755)
    return str(path)


@pytest.fixture
def log_paths(tmp_path: Path) -> list[str]:
    for name in ("a.log", "b.log"):
        (tmp_path / name).write_text(carmen_text(POSES), encoding="utf-8")
    return [str(tmp_path / "a.log"), str(tmp_path / "b.log")]


def test_the_program_is_run_and_judged(
    tmp_path: Path, log_paths: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "results"
    options = ["--gaps", "2,1", "--cross", "20", "--arg=--passed-on", "--json", str(out / "e.json")]
    options += ["--markdown", str(out / "e.md"), "--cli", made_up_program(tmp_path, PROGRAM)]
    assert pairs_command.main([*log_paths, *options]) == 0
    shown = capsys.readouterr()
    assert shown.err == ""
    assert "| a.log | 5 | 60.0 %" in shown.out
    assert "| all | 10 | 60.0 % (31.3-83.2) | 60.0 % | 0.0 cm, 0.00 deg | 100.0 % (72.2-100.0) |" in shown.out
    assert "| all | 20 | 0.0 % (0.0-16.1) | 0.0 % (0.0-16.1) |" in shown.out
    assert (out / "e.md").read_text(encoding="utf-8") == shown.out
    result = json.loads((out / "e.json").read_text(encoding="utf-8"))
    assert [pair["failure"] for pair in result["pairs"][:5]] == [None, None, "search", "search", None]
    assert result["success"]["gap"][0]["right"]["value"] == pytest.approx(2 / 3)
    assert len(result["cross"]) == 20
    assert sorted(path.name for path in out.iterdir()) == ["e.json", "e.md"]


def test_pictures_are_drawn_for_failures_only(tmp_path: Path, log_paths: list[str]) -> None:
    pytest.importorskip("matplotlib")
    options = ["--gaps", "1", "--arg=--passed-on", "--cli", made_up_program(tmp_path, PROGRAM)]
    options += ["--failures", str(tmp_path / "failures"), "--reliability", str(tmp_path / "r.png")]
    assert pairs_command.main([log_paths[0], *options]) == 0
    assert [path.name for path in (tmp_path / "failures").iterdir()] == ["a_gap1_00001.png"]
    assert (tmp_path / "r.png").read_bytes().startswith(b"\x89PNG")


def test_missing_logs_are_named_and_the_others_judged(
    tmp_path: Path, log_paths: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("SHAPEMAP_DATASETS", str(tmp_path))
    options = ["--arg=--passed-on", "--cross", "5", "--cli", made_up_program(tmp_path, PROGRAM)]
    assert pairs_command.main(["a.log", "carmen/gone.log.gz", *options]) == 1
    shown = capsys.readouterr()
    assert "SKIPPED, missing: carmen/gone.log.gz" in shown.err
    assert "--cross needs two logs" in shown.err
    assert "| a.log | 6 |" in shown.out


def test_a_crashed_run_is_a_row_of_failures(
    tmp_path: Path, log_paths: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    program = made_up_program(tmp_path, "import sys\nsys.exit('out of luck')")
    assert pairs_command.main([*log_paths, "--gaps", "1", "--cross", "3", "--cli", program]) == 1
    shown = capsys.readouterr()
    assert "| a.log (crashed: exit code 1: out of luck) | 3 | 0.0 % (0.0-56.1) |" in shown.out
    assert "a.log: exit code 1: out of luck" in shown.err
    assert " against " in shown.err


def test_fewer_answers_than_pairs_are_no_answer(tmp_path: Path, log_paths: list[str]) -> None:
    program = made_up_program(tmp_path, "import sys\nopen(sys.argv[sys.argv.index('--out') + 1], 'w')")
    assert pairs_command.main([log_paths[0], "--cli", program]) == 1


@pytest.mark.parametrize("options", [["--gaps", "0"], ["--gaps", "x"], ["--cross", "-1"], ["--cli", "/nowhere"]])
def test_wrong_usage_is_refused(options: list[str], tmp_path: Path, log_paths: list[str]) -> None:
    program = ["--cli", made_up_program(tmp_path, PROGRAM)]
    with pytest.raises(SystemExit):
        pairs_command.main([log_paths[0], *program, *options])
    with pytest.raises(SystemExit):
        pairs_command.main([log_paths[0], log_paths[0], *program])
