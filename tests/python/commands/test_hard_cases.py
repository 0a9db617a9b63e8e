# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that are hard for any mapper: that they are what they say, that their checks can fail, and what becomes of
them with shapemap-cli, where it is built (build/release/bin, or the program that SHAPEMAP_CLI names)."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evaluation.commands import hard_cases as hard_cases_command
from evaluation.common.poses import compose, inverse, rotate, wrap_angle
from evaluation.common.project import BIN
from evaluation.judging.hard_scenes import SCENES, mostly_right
from evaluation.judging.scene_outcomes import PairOutcome, covariance_from, pair_outcomes
from evaluation.simulation.buildings import bare_corridor, twin_rooms
from evaluation.simulation.disturbances import lose_beams, lose_blocks, ranges_with_crowd, ranges_with_glass
from evaluation.simulation.raycast import RayCaster
from evaluation.simulation.robot import Drive
from evaluation.simulation.scenes import StrollOptions, laser, stroll
from evaluation.simulation.sensor import exact_ranges
from evaluation.simulation.world import Face, World
from evaluation.simulation.write import tum_text

CLI = Path(os.environ.get("SHAPEMAP_CLI", BIN / "shapemap-cli"))

# Where the mapper does not do what the scene asks for, and why; docs/results/hard_scenes.md says more.
OTHER = "a like piece of another wall is called ok"
KNOWN_FAILURES = {
    ("crowd", 0): "people seen by one scan stand in the way of the other's beams, which speaks against the true pose",
    ("laser-100-0.25-20", 5): OTHER,
    ("laser-100-2-8", 0): OTHER,
    ("laser-100-2-8", 5): OTHER,
}
MENDED = [("half-blocks", 8)]
RUNS = [(name, 0) for name in SCENES] + [run for run in KNOWN_FAILURES if run[1] != 0] + MENDED


@pytest.mark.skipif(not os.access(CLI, os.X_OK), reason=f"{CLI} is not built")
@pytest.mark.parametrize(
    ("name", "seed"),
    [
        pytest.param(
            *run,
            marks=[pytest.mark.xfail(strict=True, raises=AssertionError, reason=KNOWN_FAILURES[run])]
            if run in KNOWN_FAILURES
            else [],
            id=f"{run[0]}-seed{run[1]}",
        )
        for run in RUNS
    ],
)
def test_scene_is_as_stated(name: str, seed: int) -> None:
    result = hard_cases_command.run_scene(name, seed, CLI)
    if not result.outcomes:
        raise RuntimeError("; ".join(result.broken))  # no map at all is no known failure
    assert result.broken == []


def still(heading_rad: float = 0.0) -> Drive:
    """One position at the origin."""
    pose = np.array([[0.0, 0.0, heading_rad]])
    return Drive(np.zeros(1), pose, pose[:, None, :], np.zeros((1, 1, 2)), np.zeros(1))


def pair(error: tuple[float, float, float] = (0.0, 0.0, 0.0), **other: object) -> PairOutcome:
    """A pair one metre apart along x, seen from a position that looks along y, off by `error` in the map."""
    true = np.array([0.0, -1.0, 0.0])
    shift = np.append(rotate(np.array(error[:2]), -0.5 * np.pi), error[2])
    fields: dict[str, object] = {"status": "ok", "reason": "", "probability": 0.99, "covariance": np.eye(3) * 1e-4}
    return PairOutcome(
        index=1,
        overlap=0.5,
        ref_from_query=true + shift,
        true_ref_from_query=true,
        ref_heading_rad=0.5 * np.pi,
        **{**fields, **other},  # type: ignore[arg-type]
    )


def along_x(along_m: float, across_m: float) -> np.ndarray:
    """A covariance in the frame of a position that looks along y, of deviations along the map's x and y."""
    return np.diag([across_m**2, along_m**2, 1e-4])


def test_errors_and_deviations_are_along_the_axes_of_the_map() -> None:
    off = pair((0.3, -0.1, 0.02), covariance=along_x(2.0, 0.01))
    np.testing.assert_allclose(off.error, [0.3, -0.1, 0.02], atol=1e-12)
    assert off.deviation_m((1.0, 0.0)) == pytest.approx(2.0)
    assert off.deviation_m((0.0, 1.0)) == pytest.approx(0.01)


def test_only_a_wrong_pair_that_is_called_ok_is_falsely_certain() -> None:
    assert not pair((0.19, 0.0, 0.0)).falsely_certain
    assert pair((0.21, 0.0, 0.0)).falsely_certain
    assert pair((0.0, 0.0, 0.1)).falsely_certain
    assert not pair((2.0, 0.0, 0.0), status="ambiguous", probability=0.5).falsely_certain
    assert not pair((2.0, 0.0, 0.0), status="degenerate", covariance=along_x(2.0, 0.01)).falsely_certain
    assert pair((0.0, 2.0, 0.0), status="degenerate", covariance=along_x(2.0, 0.01)).falsely_certain
    assert not pair((np.nan, 0.0, 0.0), status="too-little-overlap").falsely_certain


def test_rooms_need_right_pairs_and_no_false_certainty() -> None:
    _, check = mostly_right(0.8)
    doubted = pair((1.0, 0.0, 0.0), status="ambiguous", probability=0.4)
    assert check([pair()] * 4 + [doubted]) == []
    assert "3 of 5" in check([pair()] * 3 + [doubted] * 2)[0]
    assert "called ok" in check([pair()] * 9 + [pair((1.0, 0.0, 0.0))])[0]


def test_corridor_fails_when_its_length_is_said_to_be_known() -> None:
    check, held = SCENES["corridor-360"].check, along_x(5.0, 0.01)
    assert check([pair((3.0, 0.0, 0.0), status="degenerate", covariance=held)]) == []
    assert check([pair((3.0, 0.0, np.pi), status="ambiguous", probability=0.4, covariance=held)]) == []
    assert check([pair((3.0, 0.0, np.pi), status="degenerate", covariance=held)])
    assert check([pair(status="ok", covariance=held)])
    assert check([pair(status="degenerate", covariance=along_x(0.1, 0.01))])
    assert check([pair(status="degenerate", covariance=along_x(5.0, 1.0))])
    assert check([pair((0.0, 0.3, 0.0), status="ambiguous", probability=0.2, covariance=held)])
    assert check([pair((0.0, 0.0, 0.5), status="ambiguous", probability=0.2, covariance=held)])
    assert check([pair((np.nan, 0.0, 0.0), status="too-little-overlap", covariance=None, probability=np.nan)])


def test_round_room_fails_when_the_heading_is_said_to_be_known() -> None:
    check = SCENES["round-room"].check
    assert check([pair(status="ambiguous", probability=0.1)]) == []
    assert check([pair(status="ambiguous", probability=0.9)])
    assert check([pair(covariance=np.diag([1e-4, 1e-4, 1.0]))]) == []
    assert check([pair()])


def test_outcomes_follow_report_and_trajectory() -> None:
    run = SCENES["round-room"].make(3)
    matrix = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]]
    said: dict[str, object] = {"status": "ambiguous", "probability": 0.3, "covariance": matrix}
    report = {"scans": [{"index": k, "reason": "", "alignment": said if k else None} for k in range(6)]}
    lines = tum_text(run).splitlines()
    outcomes = pair_outcomes(run, report, "\n".join(lines[:4] + lines[5:]))
    assert [p.right for p in outcomes] == [True, True, True, False, False]  # position 4 has no place
    assert [p.probability for p in outcomes] == [0.3] * 5
    assert outcomes[0].covariance is not None
    np.testing.assert_array_equal(outcomes[0].covariance, matrix)
    assert covariance_from(None) is None
    said["ref_from_query"] = {"x_m": 9.0, "y_m": 0.0, "theta_deg": 90.0}
    far = pair_outcomes(run, report, "")[4]
    np.testing.assert_allclose(far.ref_from_query, [9.0, 0.0, 0.5 * np.pi])
    assert not far.right


def test_an_outcome_is_judged_against_the_keyframe_that_it_is_aligned_to() -> None:
    run = SCENES["round-room"].make(3)
    truth = run.drive.map_from_robot
    there = compose(inverse(truth[1]), truth[3])
    pose = {"x_m": there[0], "y_m": there[1], "theta_deg": np.rad2deg(there[2])}
    said = {"status": "ok", "probability": 0.9, "covariance": None, "reference": 1, "ref_from_query": pose}
    report = {"scans": [{"index": 3, "reason": "", "alignment": said}]}
    assert pair_outcomes(run, report, "")[2].right
    said["reference"] = 2
    assert not pair_outcomes(run, report, "")[2].right


def test_lost_beams_are_half_of_them() -> None:
    readings = np.full((6, 1, 541), 3.0)
    assert np.isnan(lose_beams(readings, 0.5, 1)).mean() == pytest.approx(0.5, abs=0.03)
    lost = np.isnan(lose_blocks(readings, 0.5, 4, 1))
    assert (lost.sum(axis=-1) == round(0.5 * 541)).all()
    assert (np.abs(np.diff(lost.astype(int), axis=-1)).sum(axis=-1) <= 8).all()  # four blocks have eight ends
    assert (lost[0] != lost[1]).any()


def test_crowd_hides_a_third_of_the_beams_and_moves() -> None:
    world, sensor = bare_corridor(), laser(270.0, 0.5, 20.0)
    walk = stroll(0, world.route, StrollOptions(num_positions=4))
    exact = exact_ranges(RayCaster(world), walk, sensor)
    ranges, crowds = ranges_with_crowd(exact, walk, sensor, 1.0 / 3.0, 0)
    hidden = (ranges < exact).mean(axis=(1, 2))
    assert ((hidden > 0.3) & (hidden < 0.4)).all()
    assert (ranges > 0.3).all()
    assert {arc.radius_m for crowd in crowds for arc in crowd} == {0.25}
    assert crowds[0][0].centre != crowds[1][0].centre


def test_glass_returns_nothing_or_what_is_behind() -> None:
    pane = Face((2.0, 1.0), (2.0, -1.0), kind="glass")
    wall = Face((5.0, 9.0), (5.0, -9.0))
    sensor = laser(100.0, 1.0, 20.0)
    bare = ranges_with_glass(World((9.0, 9.0), [wall]), still(), sensor, 0.0, 0)
    through = ranges_with_glass(World((9.0, 9.0), [pane, wall]), still(), sensor, 1.0, 0)
    dark = ranges_with_glass(World((9.0, 9.0), [pane, wall]), still(), sensor, 0.0, 0)
    np.testing.assert_array_equal(through, bare)
    met = np.abs(np.tan(sensor.beam_angles_rad())) <= 0.5
    np.testing.assert_array_equal(np.isinf(dark[0, 0]), met)


def test_corridor_ends_are_out_of_sight() -> None:
    run = SCENES["corridor-360"].make(0)
    stops, reach = run.drive.map_from_robot, run.options.sensor.max_range_m
    assert stops[:, 0].min() > reach
    assert stops[:, 0].max() < run.world.size_m[0] - reach


def test_twin_rooms_look_the_same_from_the_same_place() -> None:
    world, sensor = twin_rooms(0, 2.0), laser(360.0, 1.0, 1.9)  # so short that it does not leave the room
    here = still()
    scans = [
        exact_ranges(RayCaster(world), replace(here, map_from_sub_scan=np.array([[[x, 2.1, 0.3]]])), sensor)
        for x in (2.5, 9.5)
    ]
    near = scans[0] < 1.9
    assert near.sum() > 50
    np.testing.assert_allclose(scans[0][near], scans[1][near], atol=1e-9)


def test_tilt_makes_a_wall_of_the_floor() -> None:
    flat, leaning = (SCENES[name].make(0) for name in ("half-random", "tilted"))
    assert (np.nan_to_num(leaning.ranges, nan=0.0) < np.nan_to_num(flat.ranges, nan=99.0) - 0.3).mean() > 0.1


@pytest.mark.parametrize(("turn_deg", "least_deg"), [(30.0, 0.0), (180.0, 90.0)])
def test_turns_keep_their_limits(turn_deg: float, least_deg: float) -> None:
    route = np.array([[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]])
    options = StrollOptions(turn_deg=turn_deg, least_turn_deg=least_deg)
    turns = np.rad2deg(np.abs(wrap_angle(np.diff(stroll(2, route, options).map_from_robot[:, 2]))))
    assert turns.max() <= turn_deg + 1e-9
    assert turns.min() >= least_deg - 1e-9
    assert np.ptp(turns) > 10.0


def test_lasers_have_their_field_of_view() -> None:
    assert laser(180.0, 1.0, 80.0).num_beams == 181
    full = laser(360.0, 0.5, 12.0)
    assert full.num_beams == 720
    assert np.rad2deg(np.ptp(full.beam_angles_rad())) == pytest.approx(359.5)


def test_same_seed_same_scene_other_seed_another() -> None:
    for name in ("crowd", "glass-clear", "half-blocks"):
        np.testing.assert_array_equal(SCENES[name].make(2).ranges, SCENES[name].make(2).ranges)
    assert not np.array_equal(SCENES["crowd"].make(2).ranges, SCENES["crowd"].make(3).ranges, equal_nan=True)


def test_picture_is_drawn(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    run = SCENES["round-room"].make(0)
    report = {"scans": [{"index": k, "reason": "", "alignment": {"status": "ok"}} for k in range(6)]}
    outcomes = pair_outcomes(run, report, tum_text(run))
    hard_cases_command.save_pictures(tmp_path, [hard_cases_command.SceneResult("round-room", 0, outcomes, [])])
    assert (tmp_path / "hard_round_room.png").read_bytes().startswith(b"\x89PNG")


def test_estimated_path_starts_at_the_true_one() -> None:
    pytest.importorskip("matplotlib")
    from evaluation.judging.scene_picture import estimated_poses

    run = SCENES["round-room"].make(0)
    report = {"scans": [{"index": k, "reason": "", "alignment": {"status": "ok"}} for k in range(6)]}
    moved = replace(run, drive=replace(run.drive, map_from_robot=compose([3.0, 1.0, 2.0], run.drive.map_from_robot)))
    poses = estimated_poses(run, pair_outcomes(run, report, tum_text(moved)))
    np.testing.assert_allclose(poses[:, :2], run.drive.map_from_robot[:, :2], atol=1e-6)


def test_program_fails_without_a_map(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cli = tmp_path / "cli"
    cli.write_text("#!/bin/sh\necho broken >&2\nexit 3\n", encoding="utf-8")
    cli.chmod(0o755)
    assert hard_cases_command.main(["--scenes", "round-room", "--cli", str(cli), "--jobs", "1"]) == 1
    assert "no map: exit code 3: broken" in capsys.readouterr().out
