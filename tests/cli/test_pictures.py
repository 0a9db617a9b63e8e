# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture shows: not what a single false reading says, free space on request, and walls that are straight."""
import json
import math

import numpy as np
import pytest
import synthetic_log
import yaml
from mapping_checks import poses_by_time, read_pgm, read_tum, relative

FAR_M = 75.0
SPOILT_SCAN, SPOILT_BEAM = 5, 100


def spoilt_log(no_return=()):
    """A false reading in one scan; the beams `no_return` of each scan hit nothing."""
    lines = []
    for i, pose in enumerate(synthetic_log.path(12)):
        ranges = synthetic_log.scan(pose)
        if i == SPOILT_SCAN:
            ranges[SPOILT_BEAM] = FAR_M
        for beam in no_return:
            ranges[beam] = synthetic_log.MAX_RANGE_M
        lines.append(synthetic_log.flaser(ranges, 1.0 + i))
    return "".join(lines)


@pytest.fixture
def mapped(run, tmp_path):
    """Maps a log: the run, the picture, map.yaml, the poses and the report."""

    def map_log(text, *arguments):
        (tmp_path / "in.log").write_text(text)
        outputs = ("--out", "map.pgm", "--report", "map.json", "--trajectory", "map.tum", "--force")
        result = run("in.log", *outputs, *arguments)
        assert result.returncode == 0, result.stderr
        return (
            result,
            read_pgm(tmp_path / "map.pgm"),
            yaml.safe_load((tmp_path / "map.yaml").read_text()),
            poses_by_time(read_tum(tmp_path / "map.tum")),
            json.loads((tmp_path / "map.json").read_text()),
        )

    return map_log


def map_of(report):
    return next(fragment for fragment in report["components"] if fragment["is_map"])


def test_a_false_reading_does_not_make_the_picture_large_and_is_counted(mapped):
    plain = mapped(synthetic_log.carmen_log())
    assert "outside" not in plain[0].stderr
    assert map_of(plain[4])["picture"]["num_outside"] == 0
    result, picture, meta, _, report = mapped(spoilt_log())
    assert picture.shape == plain[1].shape
    assert meta["origin"] == plain[2]["origin"]
    num_returns = 12 * synthetic_log.NUM_BEAMS
    assert f"1 of {num_returns} returns lies outside of the picture; --draw-all draws them\n" in result.stderr
    assert map_of(report)["picture"] == {"num_returns": num_returns, "num_outside": 1}
    assert report["options"]["draw-all"] is False

    everything, large, meta, _, report = mapped(spoilt_log(), "--draw-all")
    assert "outside" not in everything.stderr
    assert max(large.shape) * meta["resolution"] > FAR_M / 2
    assert map_of(report)["picture"]["num_outside"] == 0


def test_beams_without_return_clear_space_when_asked(mapped):
    beams = range(40, 60)
    num_free = []
    for arguments in ((), ("--clear-no-return-m", "2")):
        _, picture, _, _, report = mapped(spoilt_log(no_return=beams), *arguments)
        num_free.append(np.count_nonzero(picture > 140))
        assert report["options"]["clear-no-return-m"] == (2 if arguments else 0)
    assert num_free[1] > num_free[0]


def longest_straight_wall(picture):
    """Wall pixels in the fullest column or row."""
    walls = picture < 100
    return max(walls.sum(axis=0).max(), walls.sum(axis=1).max())


def test_walls_become_straight_and_all_that_is_written_turns_with_them(mapped):
    before, crooked, _, poses, _ = mapped(synthetic_log.carmen_log())
    result, straight, meta, turned, report = mapped(synthetic_log.carmen_log(), "--align-walls")
    assert "turned" not in before.stderr
    # The map has the frame of the first position, whose heading in the room is 8 degrees.
    walls = map_of(report)["walls"]
    assert walls["turned_deg"] == pytest.approx(8, abs=0.2)
    assert f"turned by {walls['turned_deg']:.2f} degrees" in result.stderr
    assert longest_straight_wall(straight) > 1.5 * longest_straight_wall(crooked)
    times = sorted(poses)
    for time in times:
        x, y, heading = poses[time]
        angle = math.radians(walls["turned_deg"])
        wanted = (x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle), heading + angle)
        assert turned[time] == pytest.approx(wanted, abs=1e-6)
        column = (turned[time][0] - meta["origin"][0]) / meta["resolution"]
        assert 0 <= column < straight.shape[1]
    for a, b in zip(times, times[1:]):
        assert relative(turned[a], turned[b]) == pytest.approx(relative(poses[a], poses[b]), abs=1e-6)
    reported = [position["map_from_robot"] for position in report["scans"]]
    assert [pose["x_m"] for pose in reported] == pytest.approx([turned[time][0] for time in times], abs=1e-6)


def test_a_round_room_is_not_turned_and_that_is_said(mapped):
    ranges = [3.0] * synthetic_log.NUM_BEAMS
    result, _, _, poses, report = mapped(synthetic_log.flaser(ranges, 1.0), "--align-walls")
    assert "not turned: no direction of walls dominates" in result.stderr
    assert map_of(report)["walls"]["turned_deg"] == 0
    assert poses[1.0] == pytest.approx((0, 0, 0), abs=1e-9)


def test_options_come_from_a_file_too(run, tmp_path, mapped):
    (tmp_path / "options.toml").write_text("draw-all = true\nclear-no-return-m = 1.5\nalign-walls = true\n")
    *_, report = mapped(spoilt_log(), "--config", "options.toml", "--no-draw-all")
    assert (report["options"]["draw-all"], report["options"]["align-walls"]) == (False, True)
    assert report["options"]["clear-no-return-m"] == 1.5
    (tmp_path / "in.log").write_text(spoilt_log())
    refused = run("in.log", "--out", "other.png", "--clear-no-return-m", "-1")
    assert refused.returncode == 2
    assert "--clear-no-return-m is '-1', expected a number from 0 to 1000" in refused.stderr
