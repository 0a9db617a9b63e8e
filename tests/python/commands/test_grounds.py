# SPDX-License-Identifier: GPL-3.0-or-later
"""Streets, a long corridor and an exhibition, and the program around a made-up mapper."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from evaluation.commands import grounds as grounds_command
from evaluation.common.poses import wrap_angle
from evaluation.simulation.grounds import GROUNDS, LASER, simulate_ground
from evaluation.simulation.planar_raycast import PlanarCaster
from evaluation.simulation.simulation import Simulation
from evaluation_support import reporter


@pytest.fixture(name="ground", scope="module", params=sorted(GROUNDS))
def simulated(request: pytest.FixtureRequest) -> tuple[str, Simulation]:
    return request.param, simulate_ground(request.param, 3, 1.0)


def test_the_way_touches_nothing(ground: tuple[str, Simulation]) -> None:
    _, simulation = ground
    around = PlanarCaster(simulation.world, LASER.height_m)
    assert around.cast(simulation.drive.map_from_robot, 0.0, np.deg2rad(5.0), 72).min() > 0.25


def test_scans_are_a_metre_apart_and_turn_little(ground: tuple[str, Simulation]) -> None:
    _, simulation = ground
    poses = simulation.drive.map_from_robot
    assert len(poses) > 200
    steps = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    assert steps.max() < 1.3
    assert np.abs(wrap_angle(np.diff(poses[:, 2]))).max() < np.deg2rad(60.0)


def test_places_are_passed_again(ground: tuple[str, Simulation]) -> None:
    _, simulation = ground
    places = simulation.drive.map_from_robot[:, :2]
    far_apart = np.abs(np.subtract.outer(np.arange(len(places)), np.arange(len(places)))) > 50
    distance = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
    assert ((distance < 3.0) & far_apart).any(axis=1).mean() > 0.2


def test_the_same_seed_is_the_same_log_and_another_is_not(ground: tuple[str, Simulation]) -> None:
    name, simulation = ground
    again = simulate_ground(name, 3, 1.0)
    assert np.array_equal(again.ranges, simulation.ranges, equal_nan=True)
    other = simulate_ground(name, 4, 1.0)
    assert other.ranges.shape != simulation.ranges.shape or not np.allclose(
        other.ranges, simulation.ranges, equal_nan=True
    )


def test_a_long_corridor_shows_its_end_from_near_only() -> None:
    simulation = simulate_ground("long-corridor", 3, 1.0)
    ahead = simulation.ranges[:, 0, LASER.num_beams // 2]
    assert np.isnan(ahead).mean() > 0.2


# Knows the truth from a file; the last position is a metre off.
NEARLY = """rows = [list(map(float, line.split())) for line in open(passed_on[0])]
for p, (t, x, y, *_, qz, qw) in zip(positions, rows):
    p['map_from_robot'] = dict(x_m=x, y_m=y, theta_deg=math.degrees(2 * math.atan2(qz, qw)))
positions[-1]['map_from_robot']['x_m'] += 1
report['loops'] = [{}, {}]"""


def test_the_program_tells_of_each_map(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--grounds", "exhibition", "--seeds", "1", "--step-m", "4", "--jobs", "1"]
    logs = [*words, "--logs", str(tmp_path)]
    assert grounds_command.main([*logs, "--cli", str(reporter(tmp_path, "sys.exit('out of luck')"))]) == 1
    assert "no map: exit code 1: out of luck" in capsys.readouterr().out
    tum = tmp_path / "exhibition-1.tum"
    mapper = ["--cli", str(reporter(tmp_path, NEARLY)), f"--arg={tum}", "--json", str(tmp_path / "out.json")]
    assert grounds_command.main([*words, *mapper]) == 0
    num = len(tum.read_text(encoding="utf-8").splitlines())
    assert f"| exhibition | 1 | {num} | {num} | {num - 2} of {num - 1} | 2 |" in capsys.readouterr().out
    run = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))["runs"][0]
    assert 0.9 < run["worst_m"] < 1.0
    assert run["num_right"] == num - 2


@pytest.mark.parametrize("words", [["--grounds", "moon"], ["--seeds", "x"], ["--step-m", "0"]])
def test_wrong_usage(words: list[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        grounds_command.main(words)
