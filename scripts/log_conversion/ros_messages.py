# SPDX-License-Identifier: GPL-3.0-or-later
"""The messages of bags: laser scans, and transforms between frames."""

from __future__ import annotations

import struct
from collections.abc import Callable
from enum import StrEnum
from functools import cache
from typing import Any

import numpy as np

from .bag_content import Channel, RawMessage
from .model import Array, LaserScan, UnknownLogError
from .transforms import Transform

LASER_SCAN = "sensor_msgs/msg/LaserScan"
MULTI_ECHO = "sensor_msgs/msg/MultiEchoLaserScan"
LASERS = (LASER_SCAN, MULTI_ECHO)
TRANSFORMS = "tf2_msgs/msg/TFMessage"
OLD_TRANSFORMS = "tf/msg/tfMessage"  # the same content
OTHER_RANGES = ("sensor_msgs/msg/PointCloud2", "sensor_msgs/msg/PointCloud", "sensor_msgs/msg/Range")


class Echo(StrEnum):
    """Which of the echoes of a beam counts."""

    FIRST = "first"
    STRONGEST = "strongest"
    LAST = "last"


class UnreadableMessageError(ValueError):
    """The bytes are not those of the message's type."""


def is_wanted(type_name: str) -> bool:
    return type_name in (*LASERS, TRANSFORMS, OLD_TRANSFORMS)


@cache
def _store(encoding: str) -> Any:
    try:
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore
    except ImportError:
        raise UnknownLogError("ROS bags need the Python package rosbags (pip install rosbags)") from None
    store = get_typestore(Stores.ROS1_NOETIC if encoding == "ros1" else Stores.LATEST)
    if TRANSFORMS not in store.types:
        store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", TRANSFORMS))
    return store


def _decoder(channel: Channel) -> Callable[[bytes], Any]:
    store = _store(channel.encoding)
    type_name = TRANSFORMS if channel.type_name == OLD_TRANSFORMS else channel.type_name
    if channel.encoding == "ros1":
        return lambda data: store.deserialize_ros1(data, type_name)
    if channel.encoding == "cdr":
        return lambda data: store.deserialize_cdr(data, type_name)
    raise UnreadableMessageError


def decoded(message: RawMessage) -> Any:
    """Raises UnreadableMessageError."""
    from rosbags.serde import SerdeError

    try:
        return _decoder(message.channel)(message.data)
    except (SerdeError, struct.error, ValueError, IndexError, KeyError, AssertionError, MemoryError) as error:
        raise UnreadableMessageError(str(error)) from None


def stamp_ns(header: Any) -> int:
    """ROS 1 counts seconds without a sign, which the types of ROS 2 do not know."""
    return int(header.stamp.sec) % 2**32 * 10**9 + int(header.stamp.nanosec)


def frame_name(frame: str) -> str:
    """Old programs begin names with a slash."""
    return frame.removeprefix("/")


def laser_scan(message: Any, received_ns: int, echo: Echo) -> LaserScan:
    """A LaserScan or MultiEchoLaserScan as it is."""
    ranges, intensities = message.ranges, message.intensities
    if isinstance(ranges, list):
        ranges, intensities = one_echo(ranges, intensities, echo)
    return LaserScan(
        stamp_ns=stamp_ns(message.header),
        received_ns=received_ns,
        ranges_m=np.asarray(ranges, dtype=np.float32),
        first_angle_rad=float(message.angle_min),
        angle_step_rad=float(message.angle_increment),
        last_angle_rad=float(message.angle_max),
        time_step_s=float(message.time_increment),
        min_range_m=float(message.range_min),
        max_range_m=float(message.range_max),
        intensities=np.asarray(intensities, dtype=np.float32),
    )


def one_echo(ranges: list[Any], intensities: list[Any], echo: Echo) -> tuple[Array, Array]:
    """One echo of each beam; NaN where it has none. Without intensities the strongest is not known, and the first
    counts."""
    has_intensities = [len(e.echoes) for e in ranges] == [len(e.echoes) for e in intensities]
    chosen = np.full(len(ranges), np.nan, dtype=np.float32)
    strengths = np.full(len(ranges) if has_intensities else 0, np.nan, dtype=np.float32)
    for beam, echoes in enumerate(ranges):
        if not len(echoes.echoes):
            continue
        index = -1 if echo is Echo.LAST else 0
        if has_intensities:
            values = intensities[beam].echoes
            index = int(np.argmax(values)) if echo is Echo.STRONGEST else index
            strengths[beam] = values[index]
        chosen[beam] = echoes.echoes[index]
    return chosen, strengths


def transforms(message: Any) -> list[Transform]:
    found = []
    for item in message.transforms:
        shift, turn = item.transform.translation, item.transform.rotation
        found.append(
            Transform(
                parent=frame_name(item.header.frame_id),
                child=frame_name(item.child_frame_id),
                translation_m=(shift.x, shift.y, shift.z),
                quaternion=(turn.x, turn.y, turn.z, turn.w),
            )
        )
    return found
