# SPDX-License-Identifier: GPL-3.0-or-later
"""A log of any kind, recognised from its content."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from . import mcap_bag, ros1_bag, sqlite_bag
from .bag_content import BagContent
from .bags import BagOptions, bag_log
from .compressed import Content, file_content
from .lasers import mount_as_given
from .model import LaserLog, Mount, UnknownLogError
from .number_lines import PoseLineOptions, number_log
from .point_tables import is_point_table, point_log
from .printed_messages import is_printed, printed_messages
from .ros_messages import is_wanted

BAG_ENDINGS = (".db3", ".mcap", ".db3.zstd", ".mcap.zstd", ".db3.gz", ".mcap.gz")


@dataclass(frozen=True)
class ReadOptions:
    """What logs of some kinds do not say."""

    bag: BagOptions = field(default_factory=BagOptions)
    pose_lines: PoseLineOptions = field(default_factory=PoseLineOptions)
    is_clockwise: bool = True  # the angles of points
    mounts: Mapping[str, Mount] = field(default_factory=dict)  # by the name of the laser


def read_log(path: Path, options: ReadOptions) -> LaserLog:
    """Raises UnknownLogError, which names the file, or OSError."""
    try:
        return _folder_log(path, options) if path.is_dir() else _file_log(path, options)
    except UnknownLogError as error:
        text = str(error)
        raise UnknownLogError(text if text.startswith(str(path)) else f"{path}: {text}") from None


def _file_log(path: Path, options: ReadOptions) -> LaserLog:
    file = file_content(path)
    content = bag_content(path, file)
    if content is not None:
        content.damages[:0] = [file.damage] if file.damage else []
        return bag_log(content, options.bag, options.mounts)
    text = file.data[:].decode("utf-8", errors="replace")
    if is_printed(text):
        log = printed_messages(text)
    elif is_point_table(text):
        log = point_log(text, options.is_clockwise)
    else:
        log = number_log(text, options.pose_lines)
    mount_as_given(log.lasers, options.mounts)
    if file.damage:
        log.notes.insert(0, file.damage)
    return log


def bag_content(path: Path, file: Content) -> BagContent | None:
    """The messages of a bag that matter here; None for a file that is no bag."""
    start = file.data[:16]
    wants: Callable[[str], bool] = is_wanted
    if start.startswith(ros1_bag.MAGIC):
        return ros1_bag.read_ros1_bag(file.data, wants)
    if start.startswith(mcap_bag.MAGIC):
        return mcap_bag.read_mcap_bag(file.data, wants)
    if start.startswith(sqlite_bag.MAGIC):
        return sqlite_bag.read_sqlite_bag(path, file.data if isinstance(file.data, bytes) else None, wants)
    return None


def _folder_log(path: Path, options: ReadOptions) -> LaserLog:
    """A ROS 2 bag: all its files, one after the other. What lies beside them tells nothing that they do not."""
    files = sorted(p for p in path.iterdir() if p.name.endswith(BAG_ENDINGS))
    if not files:
        raise UnknownLogError("a folder without a file of a ROS 2 bag (.db3, .mcap)")
    whole = BagContent()
    for name in files:
        file = file_content(name)
        content = bag_content(name, file)
        if content is None:
            raise UnknownLogError(f"{name.name} is no bag")
        whole.messages += content.messages
        for key, count in content.counts.items():
            whole.counts[key] = whole.counts.get(key, 0) + count
        whole.damages += [f"{name.name}: {text}" for text in ([file.damage] if file.damage else []) + content.damages]
    whole.messages.sort(key=lambda message: message.received_ns)
    return bag_log(whole, options.bag, options.mounts)
