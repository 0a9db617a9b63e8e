# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion of bags: each message with its own header, whatever that says."""

from __future__ import annotations

import gzip
import math
from pathlib import Path

import pytest

from conversion_support import converted, imu, multi_echo_scan, refusal, scan, transform, write_bag, write_ros2_bag

NAN, INF = math.nan, math.inf


def test_a_log_that_never_changes_says_its_header_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag = write_bag(tmp_path / "walk.bag", [scan(100.5, [1.0, INF, 2.5]), scan(101.5, [1.0, NAN, 7.0])])
    log = converted(bag)
    assert log.sensors == {
        "scan": "beams 3 first_angle -0.5 angle_step 0.5 last_angle 0.5 max_range 5.6 min_range 0.02"
    }
    assert log.times == ["100.5", "101.5"]
    assert [one.words for one in log.scans] == [
        {"heading": "0", "ranges": "1.0 inf 2.5"},
        {"heading": "0", "ranges": "1.0 nan 7.0"},
    ]
    assert "scan: 2 scans of 3 beams, 50 % of the readings returned" in capsys.readouterr().err


@pytest.mark.parametrize("compression", ["", "bz2", "lz4"])
@pytest.mark.parametrize("is_zipped", [False, True])
def test_compressed_bags(compression: str, is_zipped: bool, tmp_path: Path) -> None:
    messages = [scan(k, [1.0 + k] * 50) for k in range(20)]
    bag = write_bag(tmp_path / "walk.bag", messages, compression, chunk_bytes=1000)
    if is_zipped:
        bag.write_bytes(gzip.compress(bag.read_bytes()))
    log = converted(bag)
    assert [one.ranges for one in log.scans] == [[1.0 + k] * 50 for k in range(20)]


def test_each_message_has_its_own_beams(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    messages = [scan(1.0, [1.0] * 4, angle_increment=0.4), scan(2.0, [1.0] * 5, angle_increment=0.3, angle_max=0.7)]
    log = converted(write_bag(tmp_path / "walk.bag", messages))
    assert log.sensors["scan"].startswith("beams any first_angle -0.5 angle_step 0.4 last_angle 1.0")
    assert [len(one.ranges) for one in log.scans] == [4, 5]
    assert log.scans[1].words["angle_step"] == "0.3"
    assert log.scans[1].words["last_angle"] == "0.7"
    said = capsys.readouterr().err
    assert "2 scans of 4 to 5 beams" in said
    assert "the angle step varies" in said


def test_each_message_has_its_own_angles_and_limits(tmp_path: Path) -> None:
    messages = [scan(1.0), scan(2.0, angle_min=2.5, angle_max=3.5, range_max=8.0, range_min=0.1), scan(3.0)]
    log = converted(write_bag(tmp_path / "walk.bag", messages))
    assert log.scans[1].words == {
        "heading": "0",
        "first_angle": "2.5",
        "last_angle": "3.5",
        "max_range": "8.0",
        "min_range": "0.1",
        "ranges": "1.0 2.0 3.0",
    }
    assert log.scans[2].words == log.scans[0].words == {"heading": "0", "ranges": "1.0 2.0 3.0"}


def test_scans_without_readings_are_kept_and_counted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = converted(write_bag(tmp_path / "walk.bag", [scan(1.0, []), scan(2.0), scan(3.0, [])]))
    assert log.sensors["scan"].startswith("beams any first_angle -0.5 angle_step 0.5 last_angle 0.5")  # of the second
    assert [one.words["ranges"] for one in log.scans] == ["", "1.0 2.0 3.0", ""]
    assert "3 scans of 3 beams, 2 of them without readings" in capsys.readouterr().err


@pytest.mark.parametrize(("maximum", "text"), [(INF, "inf"), (NAN, "nan"), (0.0, ""), (-1.0, "-1.0")])
def test_a_maximum_that_is_none(maximum: float, text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    messages = [scan(k, [1.0, 0.0, INF, 90.0], range_max=maximum) for k in range(3)]
    log = converted(write_bag(tmp_path / "walk.bag", messages))
    assert ("max_range " + text in log.sensors["scan"]) if text else ("max_range" not in log.sensors["scan"])
    assert all(set(one.words) == {"heading", "ranges"} for one in log.scans)  # NaN is the same as NaN
    said = capsys.readouterr().err
    assert "50 % of the readings are positive and finite" in said
    assert "3 of 3 have no maximum range" in said


@pytest.mark.parametrize("name", ["angle_min", "angle_max", "angle_increment", "time_increment", "range_min"])
@pytest.mark.parametrize("value", [NAN, INF, -INF, 0.0, -3.0, 3e38])
def test_odd_headers_are_written_as_they_are(name: str, value: float, tmp_path: Path) -> None:
    log = converted(write_bag(tmp_path / "walk.bag", [scan(1.0), scan(2.0, fields={name: value})]))
    words = {
        "angle_min": "first_angle",
        "angle_max": "last_angle",
        "angle_increment": "angle_step",
        "time_increment": "time_step",
        "range_min": "min_range",
    }
    if name == "angle_min" and not math.isfinite(value):
        assert log.scans[1].words == {"heading": "0", "ranges": ""}  # readings without a place
        return
    is_same = name == "time_increment" and value == 0.0
    found = float(log.scans[1].words.get(words[name], "nan" if not is_same else "0"))
    assert found == pytest.approx(value, rel=1e-6, nan_ok=True)


def test_time_between_beams_and_intensities(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    messages = [
        scan(1.0, intensities=[10, 200, 47.5], time_increment=1e-4),
        scan(2.0, intensities=[10, 200], time_increment=0.0),
    ]
    log = converted(write_bag(tmp_path / "walk.bag", messages))
    assert log.sensors["scan"].endswith("time_step 1e-04")
    assert log.scans[0].words["intensities"] == "10.0 200.0 47.5"
    assert log.scans[1].words["time_step"] == "0"
    assert "intensities" not in log.scans[1].words
    assert "1 of 2 have too many or too few intensities" in capsys.readouterr().err


def test_readings_of_minus_infinity_say_nothing(tmp_path: Path) -> None:
    log = converted(write_bag(tmp_path / "walk.bag", [scan(1.0, [-INF, 1.0, -4.0])]))
    assert log.scans[0].words["ranges"] == "0.0 1.0 -4.0"


def test_readings_keep_all_their_digits(tmp_path: Path) -> None:
    values = [1.0, 1.0000001, 0.1, 123.456, 1e-7, 3e20]
    log = converted(write_bag(tmp_path / "walk.bag", [scan(1.0, values)]))
    assert log.scans[0].ranges == pytest.approx(values, rel=3e-8)


def test_headers_without_times(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = converted(write_bag(tmp_path / "walk.bag", [scan(0.0, received_s=50.0 + k) for k in range(3)]))
    assert log.times == ["50.0", "51.0", "52.0"]
    assert "the times at which the messages were received are used" in capsys.readouterr().err


def test_odd_stamps_stay_and_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    stamps = [5.0, 5.0, 4.0, 0.0, 6.0]
    log = converted(write_bag(tmp_path / "walk.bag", [scan(s, received_s=9.0 + k) for k, s in enumerate(stamps)]))
    assert log.times == ["5.0", "5.0", "4.0", "0.0", "6.0"]
    said = capsys.readouterr().err
    assert "1 scan with the time 0" in said
    assert "1 scan with the time of the scan before" in said
    assert "2 scans with a time before that of the scan before" in said


def test_stamps_keep_their_nanoseconds(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "walk.bag", [scan(1.0)])
    data = bag.read_bytes()
    stamp = (1).to_bytes(4, "little") + bytes(4) + (5).to_bytes(4, "little") + b"laser"
    assert stamp in data
    late = (4_000_000_000).to_bytes(4, "little") + (123_456_789).to_bytes(4, "little") + stamp[8:]
    bag.write_bytes(data.replace(stamp, late))
    assert converted(bag).times == ["4000000000.123456789"]


@pytest.mark.parametrize(("options", "ranges"), [((), "1.0 nan 3.0"), (("--echo", "last"), "2.0 nan 3.0")])
def test_several_echoes(options: tuple[str, ...], ranges: str, tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "walk.bag", [multi_echo_scan(1.0, [[1.0, 1.5, 2.0], [], [3.0]])])
    assert converted(bag, *options).scans[0].words["ranges"] == ranges


def test_the_strongest_echo(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    messages = [
        multi_echo_scan(1.0, [[1.0, 1.5, 2.0], [], [3.0]], [[5.0, 9.0, 1.0], [], [4.0]]),
        multi_echo_scan(2.0, [[1.0, 1.5, 2.0], [], [3.0]]),  # without intensities the first counts
    ]
    log = converted(write_bag(tmp_path / "walk.bag", messages), "--echo", "strongest")
    assert log.scans[0].words["ranges"] == "1.5 nan 3.0"
    assert log.scans[0].words["intensities"] == "9.0 nan 4.0"
    assert log.scans[1].words["ranges"] == "1.0 nan 3.0"
    assert "the strongest counts" in capsys.readouterr().err


@pytest.mark.parametrize("is_mcap", [False, True])
def test_ros2_bags(is_mcap: bool, tmp_path: Path) -> None:
    messages = [imu(0.5), scan(100.5, [1.0, INF], intensities=[3, 4]), scan(101.5, [2.0, 2.5])]
    messages.append(transform("base_link", "laser", (0.1, 0.2, 0.3)))
    folder = write_ros2_bag(tmp_path / "walk", messages, is_mcap)
    (file,) = folder.glob("*.mcap" if is_mcap else "*.db3")
    alone = tmp_path / "alone"
    alone.write_bytes(file.read_bytes())
    zipped = tmp_path / "zipped.gz"
    zipped.write_bytes(gzip.compress(file.read_bytes()))
    for source in (folder, file, alone, zipped):
        log = converted(source)
        assert log.times == ["100.5", "101.5"]
        assert log.sensors["scan"].endswith("mount 0.1 0.2 0.3 0 0 0")
        assert log.scans[0].words == {"heading": "0", "ranges": "1.0 inf", "intensities": "3.0 4.0"}


@pytest.mark.parametrize("mode", ["FILE", "MESSAGE", "STORAGE"])
@pytest.mark.parametrize("is_mcap", [False, True])
def test_compressed_ros2_bags(mode: str, is_mcap: bool, tmp_path: Path) -> None:
    from rosbags.rosbag2 import CompressionMode

    if mode == "STORAGE" and not is_mcap:
        pytest.skip("SQLite has no compression of its own")
    messages = [scan(k, [1.0 + k] * 50) for k in range(20)]
    folder = write_ros2_bag(tmp_path / "walk", messages, is_mcap, CompressionMode[mode])
    assert [one.ranges for one in converted(folder).scans] == [[1.0 + k] * 50 for k in range(20)]


def test_bags_without_lasers_say_what_they_have(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    messages = [imu(topic=f"/imu{k}") for k in range(20)] + [transform("a", "b")]
    line = refusal(write_bag(tmp_path / "walk.bag", messages), capsys)
    assert "no laser scans" in line
    assert "/imu0 (sensor_msgs/msg/Imu)" in line
    assert "and 13 more" in line
    assert "the bag has no messages" in refusal(write_bag(tmp_path / "empty.bag", []), capsys)
    assert "none of the laser scans has a reading" in refusal(write_bag(tmp_path / "a.bag", [scan(1.0, [])]), capsys)


def test_topics_are_chosen(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    messages = [scan(k, topic=topic) for k in range(2) for topic in ("/back", "/front/scan", "/top")] + [imu()]
    bag = write_bag(tmp_path / "walk.bag", messages)
    assert list(converted(bag, "--topic", "/back").sensors) == ["back"]
    assert list(converted(bag, "--topic", "/front/scan", "--topic", "top").sensors) == ["front/scan", "top"]
    assert "no topic /left; its lasers are on /back, /front/scan, /top" in refusal(bag, capsys, "--topic", "/left")
    assert "no laser scans on /imu" in refusal(bag, capsys, "--topic", "/imu")


def test_a_laser_without_any_reading_beside_another(tmp_path: Path) -> None:
    log = converted(write_bag(tmp_path / "walk.bag", [scan(1.0), scan(1.0, [], topic="/dead")]))
    assert log.sensors["dead"].startswith("beams any ")


def test_names_from_a_bag_cannot_write_to_the_terminal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = "/sc\x1b[31man #1" + "x" * 200
    log = converted(write_bag(tmp_path / "walk.bag", [scan(1.0, topic=name)]))
    (sensor,) = log.sensors
    assert "#" not in sensor
    assert "\x1b" not in sensor
    said = capsys.readouterr().err
    assert "\x1b" not in said
    assert "x" * 100 not in said


def test_a_topic_with_two_frames_has_two_lasers(tmp_path: Path) -> None:
    messages = [scan(0.1 * k, frame=frame) for k in range(4) for frame in ("left", "right")]
    log = converted(write_bag(tmp_path / "walk.bag", messages))
    assert list(log.sensors) == ["scan:left", "scan:right"]
    assert [len(scans) for _, scans in log.positions] == [2, 2, 2, 2]
