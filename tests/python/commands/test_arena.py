# SPDX-License-Identifier: GPL-3.0-or-later
"""The evaluation: errors of made-up reports with known mistakes, rates, and the program around a made-up mapper."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evaluation.commands import arena as arena_command
from evaluation.common.argument_types import parse_seeds
from evaluation.common.poses import Array, compose, inverse, pose_error
from evaluation.common.shares import wilson_interval
from evaluation.judging.arena_pairs import (
    ROBUST_STAGES,
    STAGES,
    PairResult,
    StageError,
    evaluate_pairs,
    lost_run,
    pair_truth,
    stages_of,
)
from evaluation.judging.arena_rates import all_rates, band_of, markdown, rate, sureness
from evaluation.simulation.robot import RobotOptions
from evaluation.simulation.simulation import Simulation, SimulationOptions, simulate

NO_ERROR = StageError(0.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def arena() -> Simulation:
    return simulate(SimulationOptions(seed=2, robot=RobotOptions(num_positions=3)))


def fields(pose: Array) -> dict[str, float]:
    return {"x_m": float(pose[0]), "y_m": float(pose[1]), "theta_deg": float(np.rad2deg(pose[2]))}


def perfect_report(arena: Simulation) -> dict[str, Any]:
    """Exact poses before and after ICP, and exact corrections of every sub-scan."""
    positions: list[dict[str, Any]] = [{"index": 0, "reason": "", "alignment": None}]
    for index in range(1, len(arena.ranges)):
        truth = pair_truth(arena, index)
        pose = fields(truth.ref_from_query)
        query_from_sub_scan = compose(inverse(truth.ref_from_query), truth.ref_from_sub_scan)
        corrections = compose(query_from_sub_scan, inverse(truth.query_from_nominal))
        positions.append(
            {
                "index": index,
                "reason": "",
                "alignment": {
                    "status": "ok",
                    "shape_ref_from_query": pose,
                    "icp_ref_from_query": pose,
                    "ref_from_query": pose,
                    "query_from_sweep": [fields(c) for c in corrections],
                },
            }
        )
    return {"scans": positions}


def test_perfect_poses_leave_only_the_sub_scans_own_errors(arena: Simulation) -> None:
    for pair in evaluate_pairs(arena, perfect_report(arena), np.array([0.5, 0.6])):
        assert pair.errors is not None
        before, icp, decoupled = (pair.errors[stage] for stage in STAGES)
        assert before == icp
        assert before.error_m < 1e-9
        assert 0.003 < before.displacement_m < 0.08
        assert decoupled.displacement_m < 1e-9
        assert decoupled.error_m < 0.03  # the mean of the four sub-scans' own errors


def test_a_known_mistake_is_measured_at_its_stage(arena: Simulation) -> None:
    report = perfect_report(arena)
    alignment = report["scans"][2]["alignment"]
    wrong = compose(pair_truth(arena, 2).ref_from_query, np.array([0.3, 0.4, np.deg2rad(6.0)]))
    alignment["shape_ref_from_query"] = fields(wrong)
    first, second = evaluate_pairs(arena, report, np.array([0.5, 0.6]))
    assert [first.verdict(stage) for stage in STAGES] == ["ok", "ok", "ok"]
    assert [second.verdict(stage) for stage in STAGES] == ["wrong", "ok", "ok"]
    assert second.errors is not None
    assert second.errors["before ICP"].error_m == pytest.approx(0.5)
    assert second.errors["before ICP"].error_deg == pytest.approx(6.0)


def test_corrections_all_one_way_are_an_error_of_the_pose(arena: Simulation) -> None:
    report = perfect_report(arena)
    report["scans"][1]["alignment"]["query_from_sweep"] = [fields(np.array([0.4, 0.0, 0.0]))] * 4
    pair = evaluate_pairs(arena, report, np.array([0.5, 0.6]))[0]
    assert [pair.verdict(stage) for stage in STAGES] == ["ok", "ok", "wrong"]
    assert pair.errors is not None
    assert pair.errors[STAGES[2]].error_m == pytest.approx(0.4)


def test_a_method_of_one_stage_has_one_verdict(arena: Simulation) -> None:
    report = perfect_report(arena)
    for entry, status in zip(report["scans"][1:], ("ok", "ambiguous")):
        entry["alignment"] |= {"status": status, "shape_ref_from_query": None, "icp_ref_from_query": None}
        entry["alignment"]["query_from_sweep"] = []
    pairs = evaluate_pairs(arena, report, np.array([0.5, 0.6]))
    assert stages_of(pairs) == ROBUST_STAGES
    assert [pair.final_verdict for pair in pairs] == ["ok", "ok"]
    assert [pair.sure for pair in pairs] == [True, False]
    assert sureness(pairs) == "1 of 2 pairs are called sure; 0 of these are wrong."
    assert [row.stage for row in all_rates(pairs) if row.num_pairs] == [ROBUST_STAGES[0]] * 3


def test_a_pose_that_splits_the_map_is_rejected(arena: Simulation) -> None:
    report = perfect_report(arena)
    report["scans"][1]["starts_component"] = True
    first, second = evaluate_pairs(arena, report, np.array([0.5, 0.6]))
    assert (first.final_verdict, second.final_verdict) == ("rejected", "ok")


def test_rejected_and_missing_pairs_are_not_wrong_poses(arena: Simulation) -> None:
    report = perfect_report(arena)
    report["scans"][1] |= {"reason": "3 of 800 points", "alignment": {"status": "too-little-overlap"}}
    del report["scans"][2]
    first, second = evaluate_pairs(arena, report, np.array([0.5, 0.6]))
    assert (first.verdict(STAGES[0]), first.reason) == ("rejected", "too-little-overlap: 3 of 800 points")
    assert (second.verdict(STAGES[2]), second.reason) == ("rejected", "not in the report")


def test_a_report_of_another_log_is_refused(arena: Simulation) -> None:
    report = perfect_report(arena)
    report["scans"][1]["alignment"]["query_from_sweep"].pop()
    with pytest.raises(ValueError, match="3 sub-scans where the log has 4"):
        evaluate_pairs(arena, report, np.array([0.5, 0.6]))


def test_pose_error_does_not_depend_on_full_turns() -> None:
    error_m, error_deg = pose_error(np.array([1.0, 0.0, np.deg2rad(179)]), np.array([1.0, 0.0, np.deg2rad(-179)]))
    assert error_m == 0.0
    assert error_deg == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("failures", "total", "low", "high"),
    [(0, 10, 0.0, 0.2775), (5, 10, 0.2366, 0.7634), (10, 10, 0.7225, 1.0), (20, 100, 0.1334, 0.2888), (0, 0, 0.0, 1.0)],
)
def test_wilson_interval_has_the_published_values(failures: int, total: int, low: float, high: float) -> None:
    assert wilson_interval(failures, total) == pytest.approx((low, high), abs=5e-5)


@pytest.mark.parametrize(
    ("overlap", "name"),
    [
        (0.0, "0.00-0.30"),
        (0.29, "0.00-0.30"),
        (0.3, "0.30-0.45"),
        (0.6, "0.60-0.75"),
        (0.75, "0.75-1.00"),
        (1.0, "0.75-1.00"),
    ],
)
def test_bands_share_no_overlap_and_leave_none_out(overlap: float, name: str) -> None:
    assert band_of(overlap) == name


def made_up_pairs() -> list[PairResult]:
    def pair(index: int, overlap: float, error_m: float) -> PairResult:
        return PairResult(0, index, overlap, {stage: StageError(error_m, 1.0, 2 * error_m) for stage in STAGES})

    return [pair(1, 0.5, 0.02), pair(2, 0.5, 0.04), pair(3, 0.7, 0.31), *lost_run(1, np.array([0.8]), "crashed")]


def test_rates_count_wrong_and_rejected_apart_and_take_medians_of_the_rest() -> None:
    row = rate("all", STAGES[0], made_up_pairs())
    assert (row.num_pairs, row.num_wrong, row.num_rejected, row.failure_ratio) == (4, 1, 1, 0.5)
    assert row.median_m == pytest.approx(0.03)
    assert row.median_displacement_m == pytest.approx(0.06)


def test_every_pair_is_in_one_band_and_the_table_shows_each() -> None:
    rows = all_rates(made_up_pairs())
    banded = [row for row in rows if row.band != "all" and row.stage == STAGES[0]]
    assert sum(row.num_pairs for row in banded) == 4
    table = markdown(rows).splitlines()
    assert len(table) == 2 + 6 * 3
    assert table[-1].startswith("| all | after decoupled ICP | 4 | 2 | 50.0 % (15.0-85.0) | 1 | 1 | 3.0 cm, 1.00 deg")


def test_limits_belong_to_success() -> None:
    assert StageError(0.30, 5.0, 9.0).ok
    assert not StageError(0.31, 0.0, 0.0).ok
    assert not StageError(0.0, 5.1, 0.0).ok
    assert NO_ERROR.ok


def test_seeds_are_lists_and_ranges() -> None:
    assert parse_seeds("0-3,7,2") == [0, 1, 2, 3, 7]
    for bad in ("", "a", "3-1", "1-"):
        with pytest.raises(argparse.ArgumentTypeError):
            parse_seeds(bad)


def made_up_mapper(folder: Path, body: str) -> Path:
    program = folder / "mapper"
    program.write_text(f"#!{sys.executable}\nimport json, sys\n{body}\n", encoding="utf-8")
    program.chmod(0o755)
    return program


def test_program_runs_a_mapper_and_writes_what_it_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    body = """
assert '--passed-on' in sys.argv
assert sys.argv[sys.argv.index('--method') + 1] == 'paper'
pose = {'x_m': 0.0, 'y_m': 0.0, 'theta_deg': 0.0}
ok = {'status': 'ok', 'shape_ref_from_query': pose, 'icp_ref_from_query': pose, 'ref_from_query': pose,
      'query_from_sub_scan': []}
no = {'status': 'no-shape', 'reason': 'nothing'}
positions = [{'index': k, 'reason': '', 'alignment': a} for k, a in enumerate([None, ok, no])]
json.dump({'positions': positions, 'seconds': {'wall': 0.5}}, open(sys.argv[sys.argv.index('--report') + 1], 'w'))
sys.exit(4)"""
    status = arena_command.main(
        [
            "--seeds",
            "5",
            "--positions",
            "3",
            "--jobs",
            "1",
            "--method",
            "paper",
            "--arg=--passed-on",
            "--cli",
            str(made_up_mapper(tmp_path, body)),
            "--json",
            str(tmp_path / "e.json"),
            "--failures",
            str(tmp_path / "failures"),
        ]
    )
    assert status == 0
    assert "| all | before ICP | 2 | 2 | 100.0 %" in capsys.readouterr().out
    result = json.loads((tmp_path / "e.json").read_text(encoding="utf-8"))
    assert [pair["verdicts"][STAGES[2]] for pair in result["pairs"]] == ["wrong", "rejected"]
    assert result["pairs"][0]["errors"]["after ICP"]["error_m"] == pytest.approx(1.5, abs=0.2)
    assert len(list((tmp_path / "failures").glob("*.png"))) == 2


def test_program_counts_a_crashed_mapper_and_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = made_up_mapper(tmp_path, "sys.exit('out of luck')")
    assert arena_command.main(["--seeds", "5", "--positions", "3", "--jobs", "1", "--cli", str(program)]) == 1
    shown = capsys.readouterr()
    assert "| all | before ICP | 2 | 2 | 100.0 % (34.2-100.0) | 0 | 2 |" in shown.out
    assert "seed 5: exit code 1: out of luck" in shown.err
