# SPDX-License-Identifier: GPL-3.0-or-later
"""The walk round an office, what is told of growing runs, and the program around a made-up mapper."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from evaluation.commands import long_log as long_log_command
from evaluation.common.poses import wrap_angle
from evaluation.common.programs import run_measured
from evaluation.common.sampling import Sample, Sampler
from evaluation.common.tum import read_tum
from evaluation.judging.growth import (
    Growth,
    Stretch,
    first_and_last,
    memory_line,
    milestone_table,
    prefixes,
    quarters,
    stretches,
    table,
    wrong_places,
)
from evaluation.simulation.long_walk import SICK, WalkOptions, simulate_walk, walk
from evaluation.simulation.office import Office, OfficeOptions, build_office
from evaluation.simulation.planar_raycast import PlanarCaster
from evaluation_support import program, reporter

BARE = OfficeOptions(objects=0)


@pytest.fixture(name="office", scope="module")
def furnished_office() -> Office:
    return build_office(2, OfficeOptions(objects=60))


def test_each_room_has_its_door_on_the_corridor(office: Office) -> None:
    rooms = [room for side in office.rooms for room in side]
    assert len(rooms) >= 20
    caster = PlanarCaster(office.world, SICK.height_m)
    for room in rooms:
        for here, there in ((room.in_front, room.inside), (room.inside, room.middle)):
            way = there - here
            towards = np.array([[*here, np.arctan2(way[1], way[0])]])
            assert caster.cast(towards, 0.0, 0.1, 1)[0, 0] > np.hypot(*way) + 0.3


def test_the_walk_touches_nothing(office: Office) -> None:
    poses, _ = walk(office, WalkOptions(num_scans=4000), 2)
    nearest = PlanarCaster(office.world, SICK.height_m).cast(poses, 0.0, np.deg2rad(5.0), 72).min(axis=1)
    assert nearest.min() > 0.25


def test_the_walk_goes_everywhere_both_ways_and_never_the_same(office: Office) -> None:
    poses, times = walk(office, WalkOptions(num_scans=6000), 2)
    assert (np.diff(times) > 0.0).all()
    rooms = [room for side in office.rooms for room in side]
    visits = [np.hypot(*(poses[:, :2] - room.middle).T).min() < 0.5 for room in rooms]
    assert np.mean(visits) > 0.9
    in_south = (poses[:, 1] < 8.5) & (poses[:, 1] > 6.0) & (poses[:, 0] > 12.0) & (poses[:, 0] < 28.0)
    forth = np.cos(poses[in_south, 2])
    assert min((forth > 0.9).sum(), (forth < -0.9).sum()) > 50
    assert 0.1 < poses[in_south & (np.abs(np.cos(poses[:, 2])) > 0.95), 1].std() < 0.3
    turns = wrap_angle(np.diff(poses[:, 2]))
    assert np.abs(turns).max() < np.deg2rad(40.0)


@pytest.mark.parametrize("step_m", [0.05, 0.4])
def test_scans_are_as_far_apart_as_asked_for(office: Office, step_m: float) -> None:
    poses, _ = walk(office, WalkOptions(num_scans=1000, step_m=step_m), 2)
    steps = np.hypot(*np.diff(poses[:, :2], axis=0).T)
    assert steps.max() < 1.25 * step_m + 0.021
    ahead = steps[np.abs(wrap_angle(np.diff(poses[:, 2]))) < np.deg2rad(15.0)]
    assert 0.9 * step_m < np.median(ahead) < 1.1 * step_m + 0.02


def test_readings_are_noisy_ranges_of_the_office() -> None:
    simulation = simulate_walk(5, WalkOptions(num_scans=40), BARE)
    again = simulate_walk(5, WalkOptions(num_scans=40), BARE)
    assert np.array_equal(simulation.ranges, again.ranges, equal_nan=True)
    assert simulation.ranges.shape == (40, 1, 181)
    exact = PlanarCaster(simulation.world, SICK.height_m).cast(
        simulation.drive.map_from_robot, -np.pi / 2, np.deg2rad(1.0), 181
    )
    error = (simulation.ranges[:, 0] - exact)[np.isfinite(simulation.ranges[:, 0])]
    assert error.std() == pytest.approx(SICK.range_sigma_m, rel=0.1)
    assert 0.95 < np.isfinite(simulation.ranges).mean() < 1.0


def test_lengths_tell_the_first_from_the_last() -> None:
    assert prefixes(20_000, 1000) == [1000, 2000, 5000, 10_000, 19_000, 20_000]
    assert prefixes(4000, 1000) == [1000, 2000, 3000, 4000]
    assert prefixes(300, 1000) == [300]


def runs() -> list[Growth]:
    return [Growth(n, cpu_s=s, peak_memory_mib=m) for n, s, m in ((1000, 20, 80), (3000, 80, 90), (4000, 140, 99))]


def test_the_cost_of_more_scans_is_the_difference_of_runs() -> None:
    rows = [line.split("|") for line in table(runs()).splitlines()[2:]]
    assert [(row[7].strip(), row[8].strip()) for row in rows] == [
        ("20.0 ms", "20.0 ms"),
        ("26.7 ms", "30.0 ms"),
        ("35.0 ms", "60.0 ms"),
    ]
    line = first_and_last(runs(), 1000)
    assert line.startswith("first 1000 scans: 20.0 ms of CPU time each; last 1000 of 4000: 60.0 ms, 3.00 times as much")
    assert line.endswith("+19 MiB from 1000 scans to 4000")


def test_without_the_runs_for_it_nothing_is_compared() -> None:
    assert first_and_last(runs(), 500) == ""
    failed = [Growth(1000, "no end after 5 s"), *runs()[1:]]
    assert first_and_last(failed, 1000) == ""
    assert "| 1000 | no map: no end after 5 s |" in table(failed)


def test_what_is_far_off_is_told_in_stretches() -> None:
    found = stretches({0: 0.1, 3: 0.7, 4: 2.0, 5: 0.6, 6: 0.5, 7: 9.0})
    assert found == [Stretch(3, 5, 2.0), Stretch(7, 7, 9.0)]
    assert wrong_places(Growth(8, far_off=found)).splitlines()[0] == "of 8 scans, 3 to 5 are up to 2.00 m off"
    assert wrong_places(Growth(8)) == ""


def test_what_reading_took_is_told_for_each_part_of_the_log() -> None:
    marks = [
        {"num_scans": 1000.0 * k, "wall_s": 0.0, "cpu_s": cpu_s, "peak_memory_mib": 50.0 + k}
        for k, cpu_s in enumerate((10.0, 30.0, 50.0, 90.0), 1)
    ]
    run = Growth(4200, milestones=marks)
    assert milestone_table(run).splitlines()[2:4] == ["| 1000 | 10.0 ms | 51 MiB |", "| 2000 | 20.0 ms | 52 MiB |"]
    assert quarters(run).endswith(": 10.0, 20.0, 20.0, 40.0 ms")
    assert quarters(Growth(9, milestones=marks[:3])) == milestone_table(Growth(9)) == ""


def test_memory_over_time_is_at_equal_parts_of_it() -> None:
    run = Growth(9, samples=[Sample(k, k, 10.0 * k) for k in range(21)])
    assert memory_line(run, 4).endswith("at each 25 % of its time: 0, 50, 100, 150, 200 MiB")
    assert memory_line(Growth(9)) == ""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")
def test_the_sampler_sees_memory_grow(tmp_path: Path) -> None:
    body = "import time\ntime.sleep(0.4)\nheld = bytearray(b'x' * (64 << 20))\ntime.sleep(0.6)"
    with Sampler(0.05) as sampler:
        usage = run_measured([program(tmp_path / "hungry", body)], tmp_path, 60.0, sampler.watch)
    values = [sample.rss_mib for sample in sampler.samples]
    assert max(values) - values[0] > 40
    assert max(values) <= usage.peak_memory_mib + 1
    times = [sample.wall_s for sample in sampler.samples]
    assert times == sorted(times)
    assert sampler.samples[-1].cpu_s <= usage.cpu_s + 0.05


# Knows the truth from a file; puts every position there, in another frame, but the last one.
TRUTH = """rows = [list(map(float, line.split())) for line in open(passed_on[0])]
for p, (t, x, y, *_, qz, qw) in zip(positions, rows):
    p['map_from_robot'] = dict(x_m=-y, y_m=x, theta_deg=math.degrees(2 * math.atan2(qz, qw)) + 90)
positions[-1]['map_from_robot'] = None
report['num_placed'] -= 1
if len(positions) == 30: sys.exit('out of luck')"""


def test_the_program_maps_ever_more_of_the_log(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(long_log_command, "simulate_walk", lambda seed, options: simulate_walk(seed, options, BARE))
    arguments = ["--scans", "40", "--seed", "3", "--log", str(tmp_path / "walk.nist")]
    assert long_log_command.main([*arguments, "--no-mapping"]) == 0
    assert len(read_tum(tmp_path / "walk.tum")) == 40
    assert capsys.readouterr().out == ""
    arguments += ["--cli", str(reporter(tmp_path, TRUTH)), f"--arg={tmp_path / 'walk.tum'}"]
    arguments += ["--json", str(tmp_path / "out.json"), "--last", "10"]
    assert long_log_command.main([*arguments, "--prefixes", "40,10"]) == 0
    assert "| 40 | 20 | 39 | 0.0 cm | 0.0 cm |" in capsys.readouterr().out
    content = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))
    assert [run["num_scans"] for run in content["runs"]] == [10, 40]
    assert content["runs"][1]["stages_s"] == {"loops": 0.5}
    assert long_log_command.main(arguments) == 1  # 10, 30 and 40
    found = capsys.readouterr()
    assert "| 30 | no map: exit code 1: out of luck |" in found.out
    assert "30 scans: exit code 1: out of luck" in found.err


@pytest.mark.parametrize("words", [["--prefixes", "10,x"], ["--prefixes", "0"], ["--scans", "5", "--prefixes", "6"]])
def test_wrong_usage(words: list[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        long_log_command.main(words)
