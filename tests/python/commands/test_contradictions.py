# SPDX-License-Identifier: GPL-3.0-or-later
"""Walks of which some scans are spoilt: that they are what they say, how a mapper's word on them is counted, and what
shapemap-cli says of them, where it is built (build/release/bin, or the program that SHAPEMAP_CLI names)."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest

from evaluation.commands import contradictions as contradictions_command
from evaluation.commands.contradictions import LogOutcome, Outcome, log_table, run_simulated, simulated_table
from evaluation.common.poses import compose
from evaluation.common.project import BIN
from evaluation.simulation.scenes import laser
from evaluation.simulation.spoilt_runs import KINDS, JudgedScan, judged_scans, misplaced, slants_deg, spoilt_run

CLI = Path(os.environ.get("SHAPEMAP_CLI", BIN / "shapemap-cli"))


def scan(index: int, off: float, flagged: bool, is_misplaced: bool = False) -> JudgedScan:
    return JudgedScan(index, off, is_misplaced, flagged, 1.0, 0.0)


@pytest.mark.parametrize("kind", KINDS)
def test_only_the_chosen_scans_are_spoilt(kind: str) -> None:
    run = spoilt_run(kind, seed=3, num_positions=20, share=0.2)
    assert len(run.off) == 20
    assert run.off[0] == 0.0
    spoilt = np.flatnonzero(run.off > 0.02)
    assert len(spoilt) <= 4
    if kind == "crowd":
        assert len(spoilt) == 4
        assert (run.off[spoilt] > 0.3).all()
    if kind == "elsewhere":
        assert len(spoilt) == 4
        assert (run.off[spoilt] > 0.5).all()
    if kind == "tilted":
        assert len(spoilt) >= 2
    if kind in ("none", "glass"):
        assert not run.off.any()


def test_walls_of_glass_are_there_for_beams_that_meet_them_aslant() -> None:
    beams = laser(90.0, 1.0, 20.0)
    square = slants_deg(2.0 / np.cos(beams.beam_angles_rad()), beams)
    np.testing.assert_allclose(square[50:-1], np.arange(5, 45) + 0.5, atol=1.0)
    glass = spoilt_run("glass", seed=3, num_positions=20)
    assert {face.kind for face in glass.simulation.world.faces} >= {"glass"}


def test_the_same_seed_gives_the_same_walk() -> None:
    one, two = (spoilt_run("crowd", seed=1, num_positions=12) for _ in range(2))
    np.testing.assert_array_equal(one.simulation.ranges, two.simulation.ranges)
    np.testing.assert_array_equal(one.off, two.off)


def test_a_pose_is_misplaced_whatever_the_frame_of_the_map() -> None:
    rng = np.random.default_rng(1)
    truth = rng.uniform(-5.0, 5.0, (30, 3))
    found = truth + rng.normal(0.0, 0.02, truth.shape)
    found[7, :2] += [0.0, 0.9]
    found[8, 2] += 0.5
    found[9, :2] += [0.2, 0.0]
    wrong = misplaced(compose(np.array([7.0, -3.0, 2.0]), found), truth)
    assert np.flatnonzero(wrong).tolist() == [7, 8]


def test_scans_outside_of_the_map_are_not_judged() -> None:
    run = spoilt_run("crowd", seed=2, num_positions=12)
    entries = []
    for k, pose in enumerate(run.simulation.drive.map_from_robot):
        fields = {"x_m": pose[0], "y_m": pose[1], "theta_deg": np.rad2deg(pose[2])}
        said = {"agree": 0.6, "through": 0.1, "in_free": 0.2, "contradicts_map": k == 4}
        entries.append({"index": k, "map_from_robot": fields, "consistency": said})
    entries[3] |= {"map_from_robot": None, "consistency": None}
    entries[5]["consistency"] = {"agree": 0.0, "through": 0.0, "in_free": 0.0, "contradicts_map": False}
    scans = judged_scans(run, {"scans": entries})
    assert [s.index for s in scans] == [0, 1, 2, 4, 5, 6, 7, 8, 9, 10, 11]
    assert [s.index for s in scans if s.flagged] == [4]
    assert not any(s.misplaced for s in scans)
    assert scans[0].contradicting == pytest.approx(1.0 / 3.0)
    assert np.isnan(scans[4].contradicting)
    assert [s.off for s in scans] == [run.off[s.index] for s in scans]


def test_the_table_counts_what_is_found_missed_and_reported_in_vain() -> None:
    scans = [scan(0, 0.0, False), scan(1, 0.9, True), scan(2, 0.9, False), scan(3, 0.05, True)]
    scans += [scan(4, 0.2, True), scan(5, 0.0, True, is_misplaced=True)]
    line = simulated_table([Outcome("crowd", 0, scans)]).splitlines()[2]
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    assert cells[:4] == ["crowd", "6", "3", "2"]
    assert cells[4].startswith("67 %")
    assert cells[5:7] == ["2", "1"]
    assert cells[7].startswith("67 %")
    assert cells[8] == "1 of 1"
    assert "| - |" in simulated_table([Outcome("none", 0, [scan(0, 0.0, False)])])


def test_the_table_of_logs_says_shares_and_costs() -> None:
    one = LogOutcome("a.log", 4, (2,), (0.0, 0.1, 0.2, 0.3), (10.0, 0.2))
    lines = log_table([one, LogOutcome("b.log", fault="exit code 3")]).splitlines()
    assert lines[2] == "| a.log | 4 | 1 | 0.200, 0.300, 0.300 | 0.20 s of 10.0 s |"
    assert "exit code 3" in lines[3]


@pytest.mark.skipif(not os.access(CLI, os.X_OK), reason=f"{CLI} is not built")
def test_the_mapper_finds_scans_of_a_crowd_and_no_others() -> None:
    outcome = run_simulated("crowd", 1, CLI, [])
    assert outcome.fault == ""
    spoilt = [s for s in outcome.scans if s.spoilt]
    assert len(outcome.scans) >= 50
    assert len(spoilt) >= 8
    assert sum(s.flagged for s in spoilt) >= 0.7 * len(spoilt)
    assert not any(s.flagged for s in outcome.scans if s.clean)


@pytest.mark.skipif(not os.access(CLI, os.X_OK), reason=f"{CLI} is not built")
def test_a_log_that_gives_no_map_is_said_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    broken = tmp_path / "broken.log"
    broken.write_text("nothing", encoding="utf-8")
    rows = tmp_path / "rows.json"
    arguments = ["--kinds", "", "--logs", str(broken), "--cli", str(CLI), "--json", str(rows)]
    assert contradictions_command.main(arguments) == 1
    assert "no map" in capsys.readouterr().out
    assert json.loads(rows.read_text(encoding="utf-8"))["logs"][0]["fault"]
