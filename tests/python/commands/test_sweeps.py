# SPDX-License-Identifier: GPL-3.0-or-later
"""Walks with a rolling laser, and the program around a made-up mapper."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evaluation.commands import sweeps as sweeps_command
from evaluation.common.poses import wrap_angle
from evaluation.simulation.buildings import furnished_building
from evaluation.simulation.planar_raycast import PlanarCaster
from evaluation.simulation.sweeps import HOUSE, ROLLING, SweepOptions, Walk, simulate_sweeps, sweep_text
from evaluation_support import reporter

EXACT = replace(ROLLING, range_sigma_m=0.0)
SHORT = SweepOptions(seconds=3.0, sensor=EXACT)


def test_each_beam_is_cast_from_where_the_laser_is_at_its_time() -> None:
    run = simulate_sweeps(3, SHORT)
    world = furnished_building(3, HOUSE)
    walk, caster = Walk(world.route, SHORT), PlanarCaster(world, EXACT.height_m)
    for sweep, beam in ((0, 0), (4, 100), (9, 359)):
        pose = walk.at(np.array([run.timestamps_s[sweep] + beam * SHORT.period_s() / 360.0]))
        alone = caster.cast(pose, EXACT.beam_angles_rad()[beam], 1.0, 1)[0, 0]
        assert run.ranges[sweep, beam] == pytest.approx(alone, abs=1e-9)


def test_a_sweep_that_takes_no_time_is_not_bent() -> None:
    run = simulate_sweeps(3, replace(SHORT, sweep_share=0.0))
    world = furnished_building(3, HOUSE)
    caster = PlanarCaster(world, EXACT.height_m)
    whole = caster.cast(run.map_from_laser, EXACT.beam_angles_rad()[0], np.deg2rad(1.0), 360)
    whole[whole >= EXACT.max_range_m] = np.nan
    assert run.ranges == pytest.approx(whole, abs=1e-9, nan_ok=True)


def test_the_carrier_sways_and_walks_as_asked() -> None:
    run = simulate_sweeps(3, replace(SHORT, seconds=20.0, yaw_deg=30.0))
    turns = np.abs(wrap_angle(np.diff(run.map_from_laser[:, 2])))
    assert np.rad2deg(turns.max()) > 20.0
    speeds = np.hypot(*np.diff(run.map_from_laser[:, :2], axis=0).T) * 7.0
    assert speeds.max() == pytest.approx(0.8, abs=1e-6)
    assert np.nanmin(run.ranges) > 0.1


def test_stamps_may_be_those_of_the_last_beams() -> None:
    first, last = simulate_sweeps(3, SHORT), simulate_sweeps(3, replace(SHORT, stamp_share=1.0))
    assert np.array_equal(first.ranges, last.ranges, equal_nan=True)
    assert last.timestamps_s - first.timestamps_s == pytest.approx(SHORT.period_s())
    assert last.map_from_laser[:-1] == pytest.approx(first.map_from_laser[1:], abs=1e-6)


def test_the_log_may_tell_the_times_of_its_beams() -> None:
    run = simulate_sweeps(3, SHORT)
    assert "time_step" not in sweep_text(run)
    sensor = sweep_text(run, times=True).splitlines()[3]
    assert float(sensor.split()[-1]) == pytest.approx(1.0 / 7.0 / 360.0)


# Knows the truth from a file; the last position is a metre off.
NEARLY = """rows = [list(map(float, line.split())) for line in open(passed_on[0])]
for p, (t, x, y, *_, qz, qw) in zip(positions, rows):
    p['map_from_robot'] = dict(x_m=x, y_m=y, theta_deg=math.degrees(2 * math.atan2(qz, qw)))
positions[-1]['map_from_robot']['x_m'] += 1
report['loops'] = []
report['logs'] = [{'sweeps': {'sweep_time_s': 0.1}}]"""


def test_the_program_tells_of_each_map(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--yaw", "30", "--rate", "5", "--seeds", "1", "--seconds", "4", "--jobs", "1"]
    logs = [*words, "--logs", str(tmp_path)]
    assert sweeps_command.main([*logs, "--cli", str(reporter(tmp_path, "sys.exit('out of luck')"))]) == 1
    assert "no map: exit code 1: out of luck" in capsys.readouterr().out
    tum = tmp_path / "sweeps-5hz-30deg-1.tum"
    mapper = ["--cli", str(reporter(tmp_path, NEARLY)), f"--arg={tum}", "--json", str(tmp_path / "out.json")]
    assert sweeps_command.main([*words, *mapper]) == 0
    num = len(tum.read_text(encoding="utf-8").splitlines())
    found = capsys.readouterr().out
    assert f"| 5 Hz | 30 deg | 1 | {num} | {num} | {num - 2} of {num - 1} |" in found
    assert "| 0.1000 s |" in found
    run = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))["runs"][0]
    assert 0.5 < run["worst_m"] < 1.0


@pytest.mark.parametrize("words", [["--yaw", "x"], ["--rate", "0"], ["--seeds", "x"], ["--share", "2"]])
def test_wrong_usage(words: list[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        sweeps_command.main(words)
