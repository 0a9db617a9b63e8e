# SPDX-License-Identifier: GPL-3.0-or-later
"""Made-up bags for the tests of the converter, and its output taken apart."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags import rosbag1, rosbag2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

import convert_logs

LASER_SCAN = "sensor_msgs/msg/LaserScan"
MULTI_ECHO = "sensor_msgs/msg/MultiEchoLaserScan"
IMU = "sensor_msgs/msg/Imu"
TRANSFORMS = "tf2_msgs/msg/TFMessage"
OLD_TRANSFORMS = "tf/msg/tfMessage"
SCAN_KEYS = (
    *("heading", "time", "first_angle", "angle_step", "last_angle", "max_range", "min_range", "time_step"),
    *("angles", "times", "ranges", "intensities"),
)


@cache
def store(version: int = 1) -> Any:
    found = get_typestore(Stores.ROS1_NOETIC if version == 1 else Stores.LATEST)
    for name in (TRANSFORMS, OLD_TRANSFORMS):
        if name not in found.types:
            found.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", name))
    return found


@dataclass(frozen=True)
class Message:
    """What `build` makes of it depends on the store: headers of ROS 1 have one field more."""

    topic: str
    type_name: str
    received_ns: int
    build: Callable[[Any], Any]


def header(types: Any, stamp_ns: int, frame: str) -> Any:
    stamp = types["builtin_interfaces/msg/Time"](sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    kind = types["std_msgs/msg/Header"]
    has_seq = "seq" in kind.__dataclass_fields__
    return kind(stamp=stamp, frame_id=frame, **({"seq": 0} if has_seq else {}))


def _single(values: Sequence[float]) -> Any:
    return np.array(values, dtype=np.float32)


def scan(
    stamp_s: float,
    ranges: Sequence[float] = (1.0, 2.0, 3.0),
    topic: str = "/scan",
    received_s: float | None = None,
    frame: str = "laser",
    intensities: Sequence[float] = (),
    fields: Mapping[str, float] | None = None,
    **more_fields: float,
) -> Message:
    """A LaserScan with beams from -0.5 rad on, 0.5 rad apart, if the fields do not say otherwise."""
    values = {
        "angle_min": -0.5,
        "angle_max": -0.5 + 0.5 * (len(ranges) - 1),
        "angle_increment": 0.5,
        "time_increment": 0.0,
        "scan_time": 0.1,
        "range_min": 0.02,
        "range_max": 5.6,
        **(fields or {}),
        **more_fields,
    }

    def build(types: Any) -> Any:
        return types[LASER_SCAN](
            header=header(types, round(stamp_s * 1e9), frame),
            ranges=_single(ranges),
            intensities=_single(intensities),
            **values,
        )

    return Message(topic, LASER_SCAN, round((stamp_s if received_s is None else received_s) * 1e9), build)


def multi_echo_scan(
    stamp_s: float, echoes: Sequence[Sequence[float]], intensities: Sequence[Sequence[float]] = ()
) -> Message:
    def build(types: Any) -> Any:
        echo = types["sensor_msgs/msg/LaserEcho"]
        return types[MULTI_ECHO](
            header=header(types, round(stamp_s * 1e9), "laser"),
            angle_min=-0.5,
            angle_max=0.5,
            angle_increment=0.5,
            time_increment=0.0,
            scan_time=0.1,
            range_min=0.02,
            range_max=5.6,
            ranges=[echo(echoes=_single(values)) for values in echoes],
            intensities=[echo(echoes=_single(values)) for values in intensities],
        )

    return Message("/echoes", MULTI_ECHO, round(stamp_s * 1e9), build)


def transform(
    parent: str,
    child: str,
    translation: Sequence[float] = (0.0, 0.0, 0.0),
    quaternion: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
    topic: str = "/tf_static",
    type_name: str = TRANSFORMS,
    received_s: float = 0.0,
) -> Message:
    def build(types: Any) -> Any:
        pose = types["geometry_msgs/msg/Transform"](
            translation=types["geometry_msgs/msg/Vector3"](**dict(zip("xyz", map(float, translation)))),
            rotation=types["geometry_msgs/msg/Quaternion"](**dict(zip("xyzw", map(float, quaternion)))),
        )
        stamped = types["geometry_msgs/msg/TransformStamped"](
            header=header(types, round(received_s * 1e9), parent), child_frame_id=child, transform=pose
        )
        return types[type_name](transforms=[stamped])

    return Message(topic, type_name, round(received_s * 1e9), build)


def imu(received_s: float = 0.0, topic: str = "/imu") -> Message:
    """A message of no laser."""

    def build(types: Any) -> Any:
        vector = types["geometry_msgs/msg/Vector3"](x=0.0, y=0.0, z=9.8)
        turn = types["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0)
        zeros = np.zeros(9)
        return types[IMU](
            header=header(types, 0, "imu"),
            orientation=turn,
            orientation_covariance=zeros,
            angular_velocity=vector,
            angular_velocity_covariance=zeros,
            linear_acceleration=vector,
            linear_acceleration_covariance=zeros,
        )

    return Message(topic, IMU, round(received_s * 1e9), build)


def write_bag(path: Path, messages: Sequence[Message], compression: str = "", chunk_bytes: int = 1 << 20) -> Path:
    """A ROS 1 bag."""
    known = store(1)
    writer = rosbag1.Writer(path)
    if compression:
        writer.set_compression(rosbag1.Writer.CompressionFormat[compression.upper()])
    writer.chunk_threshold = chunk_bytes
    with writer as bag:
        connections: dict[tuple[str, str], Any] = {}
        for message in messages:
            key = message.topic, message.type_name
            if key not in connections:
                connections[key] = bag.add_connection(*key, typestore=known)
            data = known.serialize_ros1(message.build(known.types), message.type_name)
            bag.write(connections[key], message.received_ns, data)
    return path


def write_ros2_bag(
    path: Path, messages: Sequence[Message], is_mcap: bool = False, compression: rosbag2.CompressionMode | None = None
) -> Path:
    """A folder with a ROS 2 bag."""
    known = store(2)
    plugin = rosbag2.StoragePlugin.MCAP if is_mcap else rosbag2.StoragePlugin.SQLITE3
    writer = rosbag2.Writer(path, version=9, storage_plugin=plugin)
    if compression is not None:
        writer.set_compression(compression, rosbag2.CompressionFormat.ZSTD)
    with writer as bag:
        connections: dict[tuple[str, str], Any] = {}
        for message in messages:
            key = message.topic, message.type_name
            if key not in connections:
                connections[key] = bag.add_connection(*key, typestore=known)
            data = known.serialize_cdr(message.build(known.types), message.type_name)
            bag.write(connections[key], message.received_ns, data)
    return path


@dataclass
class Scan:
    """The words of a scan by their key."""

    sensor: str
    words: dict[str, str] = field(default_factory=dict)

    @property
    def ranges(self) -> list[float]:
        return [float(word) for word in self.words["ranges"].split()]


@dataclass
class TextLog:
    """A converted log taken apart: sensors as the text after their name, positions as their time and scans."""

    sensors: dict[str, str] = field(default_factory=dict)
    positions: list[tuple[str, list[Scan]]] = field(default_factory=list)

    @property
    def scans(self) -> list[Scan]:
        return [one for _, scans in self.positions for one in scans]

    @property
    def times(self) -> list[str]:
        return [time for time, _ in self.positions]


def taken_apart(text: str) -> TextLog:
    log = TextLog()
    lines = text.splitlines()
    assert lines[0] == "shapemap-scans 2"
    for words in map(str.split, lines[1:]):
        if words[0] == "sensor":
            log.sensors[words[1]] = " ".join(words[2:])
        elif words[0] == "position":
            log.positions.append((words[1], []))
        elif words[0] == "scan":
            assert words[1] in log.sensors
            log.positions[-1][1].append(Scan(words[1], _by_key(words[2:])))
        else:
            assert words[0] in ("units", "#")
    return log


def _by_key(words: list[str]) -> dict[str, str]:
    found: dict[str, list[str]] = {}
    key = ""
    for word in words:
        if word in SCAN_KEYS:
            key = word
            assert key not in found
            found[key] = []
        else:
            found[key].append(word)
    return {name: " ".join(values) for name, values in found.items()}


def converted(source: Path, *options: str) -> TextLog:
    out = source.parent / "out.nist"
    assert convert_logs.main([*options, str(source), str(out)]) == 0
    return taken_apart(out.read_text(encoding="utf-8"))


def refusal(source: Path, capsys: pytest.CaptureFixture[str], *options: str) -> str:
    """The one line that is said about a log that cannot be used."""
    out = source.parent / "refused.nist"
    capsys.readouterr()
    assert convert_logs.main([*options, str(source), str(out)]) == 1
    assert not out.exists()
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"convert_logs.py: {source}")
    return str(line)
