# SPDX-License-Identifier: GPL-3.0-or-later
"""Where lasers sit: by the transforms of a bag, or by option; and which scans of several belong together."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import convert_logs
from conversion_support import TextLog, converted, imu, refusal, scan, transform, write_bag
from log_conversion.model import Mount
from log_conversion.transforms import FixedTransforms, Transform, mount_of

UPSIDE_DOWN = (1.0, 0.0, 0.0, 0.0)  # half a turn about x
LEFT = (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))  # a quarter turn about z


def mount(log: TextLog, sensor: str = "scan") -> list[float]:
    words = log.sensors[sensor].split()
    return [float(word) for word in words[words.index("mount") + 1 :]] if "mount" in words else [0.0] * 6


def turned(yaw: float, pitch: float, roll: float) -> np.ndarray:
    """By yaw, then pitch, then roll, from the turns about single axes."""
    cy, sy, cp, sp, cr, sr = (f(a) for a in (yaw, pitch, roll) for f in (math.cos, math.sin))
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    return about_z @ about_y @ about_x


def test_yaw_pitch_and_roll_are_those_of_the_matrix() -> None:
    rng = np.random.default_rng(0)
    for _ in range(100):
        yaw, roll = rng.uniform(-math.pi, math.pi, 2)
        pitch = rng.choice([rng.uniform(-1.5, 1.5), math.pi / 2, -math.pi / 2])
        matrix = np.eye(4)
        matrix[:3, :3] = turned(yaw, pitch, roll)
        found = mount_of(matrix)
        np.testing.assert_allclose(turned(found.yaw, found.pitch, found.roll), matrix[:3, :3], atol=1e-6)


def test_a_quaternion_turns_as_it_should() -> None:
    about_z = Transform("base", "laser", (0, 0, 0), (0, 0, math.sin(0.3), math.cos(0.3))).matrix()
    np.testing.assert_allclose(about_z[:3, :3], turned(0.6, 0, 0), atol=1e-12)
    long = Transform("base", "laser", (0, 0, 0), (2 * math.sin(0.2), 0, 0, 2 * math.cos(0.2))).matrix()
    np.testing.assert_allclose(long[:3, :3], turned(0, 0, 0.4), atol=1e-12)
    np.testing.assert_array_equal(Transform("base", "laser", (0, 0, 0), (0, 0, 0, 0)).matrix(), np.eye(4))


def test_a_laser_upside_down_at_the_end_of_a_chain(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    messages = [
        transform("/base_link", "/mast", (1.0, 0.0, 0.5), LEFT),
        transform("mast", "laser", (2.0, 0.0, 0.0), UPSIDE_DOWN),
        transform("base_footprint", "base_link", (0.0, 0.0, 0.3)),
        scan(1.0, frame="/laser"),
    ]
    log = converted(write_bag(tmp_path / "walk.bag", messages))
    assert mount(log) == pytest.approx([1.0, 2.0, 0.5, math.pi / 2, 0.0, math.pi], abs=1e-6)
    assert "mounted as the transform from base_link tells" in capsys.readouterr().err


def test_transforms_that_change_or_stand_in_the_world_are_no_mounts(tmp_path: Path) -> None:
    messages = [
        transform("map", "odom", (9.0, 9.0, 0.0)),
        *[transform("odom", "robot", (float(k), 0.0, 0.0), topic="/tf", received_s=k) for k in range(3)],
        *[transform("robot", "laser", (0.2, 0.0, 0.0), topic="/tf", received_s=k) for k in range(3)],
        *[scan(k) for k in range(3)],
    ]
    log = converted(write_bag(tmp_path / "walk.bag", messages))
    assert mount(log) == pytest.approx([0.2, 0, 0, 0, 0, 0])
    moving = FixedTransforms()
    for k in range(3):
        moving.add(Transform("robot", "laser", (0.1 * k, 0.0, 0.0), (0, 0, 0, 1)))
    assert moving.mounts(["laser"]) == ("", {})


def test_a_quaternion_and_its_negative_are_the_same_turn() -> None:
    fixed = FixedTransforms()
    fixed.add(Transform("robot", "laser", (0.1, 0.0, 0.0), LEFT_TUPLE))
    fixed.add(Transform("robot", "laser", (0.1, 0.0, 0.0), tuple(-v for v in LEFT_TUPLE)))  # type: ignore[arg-type]
    assert fixed.mounts(["laser"])[1]["laser"].yaw == pytest.approx(math.pi / 2)


LEFT_TUPLE = (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))


def test_circles_of_transforms_end() -> None:
    fixed = FixedTransforms()
    fixed.add(Transform("a", "b", (1.0, 0.0, 0.0), (0, 0, 0, 1)))
    fixed.add(Transform("b", "a", (-1.0, 0.0, 0.0), (0, 0, 0, 1)))
    assert fixed.mounts(["a", "b"])[1].keys() == {"a", "b"}


def test_the_old_type_of_transforms_is_read(tmp_path: Path) -> None:
    messages = [transform("base_link", "laser", (0.5, 0, 0), topic="/tf", type_name="tf/msg/tfMessage"), scan(1.0)]
    assert mount(converted(write_bag(tmp_path / "walk.bag", messages))) == pytest.approx([0.5, 0, 0, 0, 0, 0])


def test_mounts_by_option(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag = write_bag(tmp_path / "walk.bag", [transform("base_link", "laser", (1, 1, 1)), scan(1.0)])
    for name in ("scan", "/scan"):
        log = converted(bag, "--mount", f"{name}=0.1,0.2,0,90,0,180")
        assert mount(log) == pytest.approx([0.1, 0.2, 0, math.pi / 2, 0, math.pi])
    assert "no such laser; there is scan" in refusal(bag, capsys, "--mount", "rear=0,0,0,0,0,0")
    for text in ("scan=1,2", "scan", "=0,0,0,0,0,0", "scan=0,0,0,0,0,x", "scan=0,0,0,0,0,nan"):
        with pytest.raises(SystemExit):
            convert_logs.parse_arguments(["a", "b", "--mount", text])


def test_a_mount_of_a_log_that_is_no_bag(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "points.csv"
    path.write_text("time_s,angle_deg,distance_mm\n1,2,3\n1.1,4,5\n", encoding="utf-8")
    assert mount(converted(path, "--mount", "laser=0,0,0,0,0,180"), "laser")[5] == pytest.approx(math.pi)
    assert "there is laser" in refusal(path, capsys, "--mount", "scan=0,0,0,0,0,180")


def test_a_topic_that_is_made_from_another_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    messages = [scan(1.0 + k, topic=topic) for k in range(4) for topic in ("/scan", "/scan_filtered")]
    converted(write_bag(tmp_path / "twins.bag", messages))
    assert "scan and scan_filtered have the same frame and times" in capsys.readouterr().err
    messages = [scan(1.0 + k, topic=name, frame=name) for k in range(4) for name in ("/front", "/rear")]
    converted(write_bag(tmp_path / "two.bag", messages))
    assert "same frame" not in capsys.readouterr().err


def test_without_transforms_a_warning_says_what_to_do(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = converted(write_bag(tmp_path / "walk.bag", [scan(1.0)]))
    assert "mount" not in log.sensors["scan"]
    assert "--mount scan=x,y,z,yaw,pitch,roll (metres, degrees)" in capsys.readouterr().err


def test_two_lasers_at_the_same_time_make_a_position(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    backwards = (0, 0, 1, 0)
    messages = [
        transform("base_link", "front", (0.3, 0, 0)),
        transform("base_link", "rear", (-0.3, 0, 0), backwards),
    ]
    for k in range(5):
        messages.append(scan(10 + 0.1 * k, [1.0 + k], topic="/front", frame="front"))
        if k != 2:
            messages.append(scan(9.98 + 0.1 * k, [2.0 + k], topic="/rear", frame="rear"))
    log = converted(write_bag(tmp_path / "walk.bag", messages))
    assert mount(log, "front") == pytest.approx([0.3, 0, 0, 0, 0, 0])
    assert mount(log, "rear") == pytest.approx([-0.3, 0, 0, math.pi, 0, 0], abs=1e-6)
    assert log.times == ["9.98", "10.08", "10.2", "10.28", "10.38"]
    alone, both = [("front", "0")], [("rear", "0"), ("front", "0.02")]
    offsets = [[(one.sensor, one.words.get("time", "0")) for one in scans] for _, scans in log.positions]
    assert offsets == [both, both, alone, both, both]
    assert [one.ranges for _, scans in log.positions for one in scans if one.sensor == "rear"] == [[2], [3], [5], [6]]
    assert "9 scans of 2 lasers make 5 positions, 4 of them with scans of several" in capsys.readouterr().err


def test_lasers_of_different_rates(tmp_path: Path) -> None:
    messages = [scan(0.1 * k + 1, topic="/slow") for k in range(4)]
    messages += [scan(0.025 * k + 1.004, topic="/fast") for k in range(16)]
    messages.append(scan(1.101, topic="/rare"))
    log = converted(write_bag(tmp_path / "walk.bag", sorted(messages, key=lambda m: m.received_ns)))
    together = [[one.sensor for one in scans] for _, scans in log.positions if len(scans) > 1]
    assert together == [["slow", "fast"], ["slow", "rare", "fast"], ["slow", "fast"], ["slow", "fast"]]
    assert sum(len(scans) for _, scans in log.positions) == 21
    assert log.times == sorted(log.times, key=float)


def test_lasers_that_do_not_overlap_stay_apart(tmp_path: Path) -> None:
    messages = [scan(0.1 * k, topic="/a") for k in range(3)] + [scan(60 + 0.1 * k, topic="/b") for k in range(3)]
    log = converted(write_bag(tmp_path / "walk.bag", [imu(), *messages]))
    assert [len(scans) for _, scans in log.positions] == [1] * 6


def test_a_laser_without_times_makes_all_use_the_times_of_receiving(tmp_path: Path) -> None:
    messages = []
    for k in range(3):
        messages += [scan(5.0 + k, topic="/a", received_s=100.0 + k), scan(0.0, topic="/b", received_s=100.1 + k)]
    log = converted(write_bag(tmp_path / "walk.bag", messages))
    assert log.times == ["100.0", "101.0", "102.0"]
    assert [[one.words.get("time") for one in scans] for _, scans in log.positions] == [[None, "0.1"]] * 3


def test_a_mount_of_zeros_is_left_out() -> None:
    assert Mount() == Mount(-0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
