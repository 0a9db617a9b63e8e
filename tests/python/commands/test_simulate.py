# SPDX-License-Identifier: GPL-3.0-or-later
"""The simulated arena: exact geometry, honest noise, files that read back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evaluation.commands import simulate as simulate_command
from evaluation.common.poses import compose, inverse, transform
from evaluation.simulation.raycast import RayCaster
from evaluation.simulation.read import read_scan_log
from evaluation.simulation.robot import RobotOptions, stops_along
from evaluation.simulation.sensor import SensorOptions, exact_ranges, measure, mix_pixels, points_of
from evaluation.simulation.simulation import Simulation, SimulationOptions, consecutive_overlaps, overlap, simulate
from evaluation.simulation.world import (
    Arc,
    Face,
    World,
    arc_outline,
    distance_to_polyline,
    face_outline,
    polygon_faces,
    rectangle_corners,
)
from evaluation.simulation.write import nist_text, tum_text

EXACT = SimulationOptions(
    seed=3,
    robot=RobotOptions(
        num_positions=4,
        sub_scan_heading_sigma_deg=0.0,
        sub_scan_centre_sigma_m=0.0,
        tilt_sigma_deg=0.0,
        heading_uncertainty_deg=180.0,
    ),
    sensor=SensorOptions(range_sigma_m=0.0, drop_out_share=0.0),
)


@pytest.fixture(scope="module")
def arena() -> Simulation:
    return simulate(SimulationOptions(seed=1))


@pytest.fixture(scope="module")
def exact() -> Simulation:
    return simulate(EXACT)


def cast(
    world: World, origin: tuple[float, float], angles_deg: list[float], slope: float = 0.0, height_m: float = 0.35
) -> np.ndarray:
    angles = np.deg2rad(angles_deg)
    return RayCaster(world).cast(np.array(origin), height_m, angles, np.full(len(angles), slope))


def test_ranges_in_a_square_room_have_the_closed_form() -> None:
    room = World((4.0, 4.0), polygon_faces(rectangle_corners(np.array([2.0, 2.0]), 4.0, 4.0, 0.0), 1.2, "wall"))
    angles = np.arange(1.0, 360.0, 7.3)
    c, s = np.cos(np.deg2rad(angles)), np.sin(np.deg2rad(angles))
    expected = np.minimum(np.where(c > 0, 3.0, 1.0) / np.abs(c), np.where(s > 0, 2.5, 1.5) / np.abs(s))
    np.testing.assert_allclose(cast(room, (1.0, 1.5), list(angles)), expected, rtol=1e-12)


def test_ranges_to_a_circle_have_the_closed_form() -> None:
    world = World((9.0, 9.0), [], [Arc((3.0, 0.0), 1.0)])
    angle = np.rad2deg(np.arcsin(0.2))
    expected = 3.0 * np.cos(np.deg2rad(angle)) - np.sqrt(1.0 - (3.0 * 0.2) ** 2)
    np.testing.assert_allclose(cast(world, (0.0, 0.0), [0.0, angle, -angle]), [2.0, expected, expected], rtol=1e-12)
    assert np.isinf(cast(world, (0.0, 0.0), [np.rad2deg(np.arcsin(1.0 / 3.0)) + 0.01, 180.0])).all()
    np.testing.assert_allclose(cast(world, (3.0, 0.0), [12.0, 200.0]), [1.0, 1.0], rtol=1e-12)


def test_an_arc_is_hit_only_where_it_is() -> None:
    far_half = World((9.0, 9.0), [], [Arc((3.0, 0.0), 1.0, first_rad=-np.pi / 2, span_rad=np.pi)])
    np.testing.assert_allclose(cast(far_half, (0.0, 0.0), [0.0]), [4.0], rtol=1e-12)


def test_a_slanted_board_recedes_with_the_height_of_the_beam() -> None:
    board = World((9.0, 9.0), [Face((2.0, 1.0), (2.0, -1.0), 0.0, 1.0, slant=0.5)])  # leans towards +x
    np.testing.assert_allclose(cast(board, (0.0, 0.0), [0.0], height_m=0.4), [2.2], rtol=1e-12)
    # A climbing beam meets the plane x = 2 + 0.5 z at x = 2.2 / (1 - 0.05), measured along the beam.
    np.testing.assert_allclose(
        cast(board, (0.0, 0.0), [0.0], slope=0.1, height_m=0.4), [2.2 / 0.95 * np.sqrt(1.01)], rtol=1e-12
    )


def test_low_objects_are_passed_over() -> None:
    world = World((9.0, 9.0), [Face((2.0, 1.0), (2.0, -1.0), 0.0, 0.3), Face((5.0, 1.0), (5.0, -1.0))])
    np.testing.assert_allclose(cast(world, (0.0, 0.0), [0.0], height_m=0.35), [5.0])
    np.testing.assert_allclose(cast(world, (0.0, 0.0), [0.0], height_m=0.25), [2.0])


def test_tilt_clips_the_floor() -> None:
    slope = -np.tan(np.deg2rad(5.0))
    wall = World((99.0, 9.0), [Face((50.0, 1.0), (50.0, -1.0))])
    np.testing.assert_allclose(cast(wall, (0.0, 0.0), [0.0], slope=slope), [0.35 / np.sin(np.deg2rad(5.0))])
    assert np.isinf(cast(wall, (0.0, 0.0), [0.0], slope=-slope)).all()  # over the top of the wall


def test_more_tilt_shortens_the_ranges_of_a_run() -> None:
    def far_share(tilt_deg: float) -> float:
        robot = replace(EXACT.robot, tilt_sigma_deg=tilt_deg)
        return float((simulate(replace(EXACT, robot=robot)).ranges > 2.0).mean())

    assert far_share(15.0) < 0.6 * far_share(0.0)


def test_same_seed_same_files_other_seed_other_files(arena: Simulation) -> None:
    assert nist_text(simulate(SimulationOptions(seed=1))) == nist_text(arena)
    assert nist_text(simulate(SimulationOptions(seed=2))) != nist_text(arena)


def test_components_do_not_disturb_each_other(arena: Simulation) -> None:
    options = SimulationOptions(
        seed=1, robot=RobotOptions(spacing_m=1.0, tilt_sigma_deg=0.0), sensor=SensorOptions(range_sigma_m=0.05)
    )
    other = simulate(options)
    assert other.world.faces == arena.world.faces
    assert other.world.arcs == arena.world.arcs
    np.testing.assert_array_equal(other.drive.map_from_robot[:, 2], arena.drive.map_from_robot[:, 2])
    noisier = replace(SimulationOptions(seed=1), sensor=SensorOptions(range_sigma_m=0.05))
    np.testing.assert_array_equal(simulate(noisier).drive.map_from_sub_scan, arena.drive.map_from_sub_scan)


def world_points(world: World, height_m: float) -> np.ndarray:
    """Points 5 mm apart on everything that the laser's plane cuts."""
    pieces = []
    for face in world.faces:
        start, end = face_outline(face, height_m)
        pieces.append(np.linspace(start, end, max(2, int(np.hypot(*(end - start)) / 0.005) + 2)))
    return np.concatenate(pieces + [arc_outline(arc, 0.005) for arc in world.arcs])


def test_exact_scans_at_the_reference_poses_lie_on_the_world(exact: Simulation) -> None:
    surfaces = world_points(exact.world, EXACT.sensor.height_m)
    beams = EXACT.sensor.beam_angles_rad()
    for position, ranges in zip(exact.drive.map_from_robot, exact.ranges):
        for heading, readings in zip(exact.drive.nominal_headings_rad, ranges):
            points = transform(position, transform(np.array([0.0, 0.0, heading]), points_of(readings, beams)))
            assert len(points) > 200
            for point in points[::10]:
                assert np.hypot(*(surfaces - point).T).min() < 0.005


def test_sub_scan_errors_have_the_sigma_asked_for() -> None:
    errors = []
    for seed in range(3):
        run = simulate(SimulationOptions(seed=seed)).drive
        nominal = np.zeros((4, 3))
        nominal[:, 2] = run.nominal_headings_rad
        ideal = compose(run.map_from_robot[:, None, :], nominal)
        errors.append(compose(inverse(ideal), run.map_from_sub_scan).reshape(-1, 3))
    spread = np.concatenate(errors).std(axis=0)
    np.testing.assert_allclose(spread, [0.015, 0.015, np.deg2rad(0.7)], rtol=0.2)


def test_range_noise_and_drop_outs_have_the_statistics_asked_for() -> None:
    readings = measure(5, np.full((10, 4, 401), 3.0), SensorOptions(range_sigma_m=0.02, drop_out_share=0.05))
    seen = readings[np.isfinite(readings)]
    assert np.isnan(readings).mean() == pytest.approx(0.05, abs=0.006)
    assert seen.mean() == pytest.approx(3.0, abs=0.001)
    assert seen.std() == pytest.approx(0.02, rel=0.03)


def test_nothing_is_measured_from_the_maximum_range_on() -> None:
    exact = np.array([[[4.9, 5.0, 5.1, np.inf]]])
    readings = measure(0, exact, SensorOptions(range_sigma_m=0.0, drop_out_share=0.0, max_range_m=5.0))
    np.testing.assert_array_equal(readings, [[[4.9, np.nan, np.nan, np.nan]]])


def test_mixed_pixels_lie_between_the_two_sides_of_an_edge() -> None:
    ranges = np.array([1.0, 1.05, 4.0, 4.0, np.inf])
    mixed = mix_pixels(ranges, 1.0, np.random.default_rng(0))
    np.testing.assert_array_equal(mixed[[0, 2, 3, 4]], ranges[[0, 2, 3, 4]])
    assert 1.05 < mixed[1] < 4.0


def test_the_log_reads_back(arena: Simulation, tmp_path: Path) -> None:
    path = tmp_path / "arena.nist"
    path.write_text(nist_text(arena), encoding="utf-8")
    log = read_scan_log(path)
    assert log.ranges.shape == (16, 4, 401)
    np.testing.assert_allclose(log.ranges, arena.ranges, atol=0.00051)
    np.testing.assert_allclose(log.beam_angles_rad, arena.options.sensor.beam_angles_rad(), atol=1e-12)
    np.testing.assert_allclose(np.rad2deg(log.nominal_headings_rad), np.tile([0, 90, 180, 270], (16, 1)))
    assert log.map_from_robot is not None
    np.testing.assert_allclose(log.map_from_robot, arena.drive.map_from_robot, atol=1e-6)


@pytest.mark.parametrize("text", ["", "shapemap-scans 2\n", "shapemap-scans 1\nunits cm deg\n"])
def test_other_files_are_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.nist"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=r"bad\.nist"):
        read_scan_log(path)


def test_reference_trajectory_has_the_timestamps_and_poses_of_the_log(arena: Simulation) -> None:
    rows = np.array([[float(x) for x in line.split()] for line in tum_text(arena).splitlines()])
    np.testing.assert_array_equal(rows[:, 0], arena.drive.timestamps_s)
    np.testing.assert_allclose(rows[:, 1:3], arena.drive.map_from_robot[:, :2], atol=1e-9)
    np.testing.assert_allclose(2 * np.arctan2(rows[:, 6], rows[:, 7]), arena.drive.map_from_robot[:, 2], atol=1e-9)


def test_the_route_is_free_and_positions_keep_their_spacing() -> None:
    for seed in range(2):
        arena = simulate(replace(EXACT, seed=seed, robot=replace(EXACT.robot, num_positions=16)))
        stops = arena.drive.map_from_robot[:, :2]
        steps = np.hypot(*np.diff(stops, axis=0).T)
        assert steps.min() > 1.5 * 0.9 - 0.03
        assert steps.max() < 1.5 * 1.1 + 0.03
        assert distance_to_polyline(stops, arena.world.route).max() < 0.01
        floor = np.concatenate([np.linspace(np.array(f.start), np.array(f.end), 25) for f in arena.world.faces])
        assert distance_to_polyline(floor, arena.world.route).min() > 0.2


def test_stops_are_a_straight_distance_apart() -> None:
    corner = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 3.0]])
    stops = stops_along(corner, np.array([2.0, 2.0]))
    np.testing.assert_allclose(stops, [[0, 0], [2, 0], [3, np.sqrt(3)]], atol=0.03)
    with pytest.raises(ValueError, match="room for 3 positions"):
        stops_along(corner, np.array([2.0, 2.0, 2.0]))


def test_consecutive_scans_overlap_in_part() -> None:
    overlaps = np.concatenate([consecutive_overlaps(simulate(SimulationOptions(seed=seed))) for seed in range(3)])
    assert 0.5 < np.median(overlaps) < 0.8
    assert overlaps.min() > 0.2
    assert overlaps.max() <= 1.0
    assert (overlaps < 0.6).sum() >= 5


def test_overlap_counts_points_with_a_neighbour() -> None:
    query = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]])
    assert overlap(query, np.array([[0.0, 0.14], [1.0, 0.16], [3.1, 0.0]])) == 0.5
    assert overlap(query, np.empty((0, 2))) == 0.0


def test_program_writes_its_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--seed", "4", "--positions", "3", "--out", str(tmp_path / "a"), "--formats", "nist,truth"]
    assert simulate_command.main(arguments) == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.nist", "a.truth.json"]
    assert "overlap with the scan before" in capsys.readouterr().out


def test_program_says_when_the_route_is_too_short(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert simulate_command.main(["--positions", "60", "--spacing-m", "9", "--out", str(tmp_path / "a")]) == 1
    assert "the route has room for" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_picture_is_drawn(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    path = tmp_path / "world.png"
    simulate_command.main(["--positions", "2", "--quiet", "--out", str(tmp_path / "a"), "--picture", str(path)])
    assert path.read_bytes().startswith(b"\x89PNG")


def test_exact_ranges_cover_all_beams(exact: Simulation) -> None:
    ranges = exact_ranges(RayCaster(exact.world), exact.drive, EXACT.sensor)
    assert ranges.shape == (4, 4, 401)
    assert (ranges > 0.2).all()  # no position touches anything
