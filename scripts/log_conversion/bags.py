# SPDX-License-Identifier: GPL-3.0-or-later
"""A log from the messages of a bag, of whichever kind."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from .bag_content import BagContent, RawMessage
from .lasers import mount_as_given, mount_by_transforms, twin_notes
from .model import Laser, LaserLog, LaserScan, Moment, Mount, UnknownLogError, counted, printable
from .moments import group
from .ros_messages import (
    LASERS,
    MULTI_ECHO,
    OTHER_RANGES,
    Echo,
    UnreadableMessageError,
    decoded,
    frame_name,
    laser_scan,
    transforms,
)
from .transforms import FixedTransforms

MOST_LISTED = 8  # topics in an error


@dataclass(frozen=True)
class BagOptions:
    """`topics` are those of the lasers that are wanted, all if there is none."""

    topics: tuple[str, ...] = ()
    echo: Echo = Echo.FIRST


@dataclass
class _Decoded:
    """`scans` by topic and frame, each with its place in the order of the bag."""

    scans: dict[tuple[str, str], list[tuple[int, LaserScan]]] = field(default_factory=dict)
    fixed: FixedTransforms = field(default_factory=FixedTransforms)
    unreadable: dict[str, int] = field(default_factory=dict)


def bag_log(content: BagContent, options: BagOptions, mounts: Mapping[str, Mount]) -> LaserLog:
    """`mounts` are by the name of the laser and override the transforms of the bag.

    Raises UnknownLogError where the bag has no laser scans, or not those that are asked for.
    """
    topics = chosen_topics(content, options.topics)
    found = _decode(content, topics, options.echo)
    if not found.scans:
        raise UnknownLogError(f"no readable laser scan{_ending([*content.damages, *_unreadable_notes(found)])}")
    if not any(len(scan.ranges_m) for scans in found.scans.values() for _, scan in scans):
        raise UnknownLogError("none of the laser scans has a reading")
    lasers = _lasers(found)
    notes = [*content.damages, *_unreadable_notes(found), *_left_out_notes(content, options.topics)]
    scans = [scan for laser in lasers for scan in laser.scans]
    uses_received = needs_received_times(lasers)
    if uses_received:
        notes.append("the headers have no times: the times at which the messages were received are used")
    if any(type_name == MULTI_ECHO for topic, type_name in content.counts if topic in topics):
        notes.append(f"of several echoes of a beam, the {options.echo} counts; --echo changes that")
    mount_as_given(lasers, mounts)
    notes += [*mount_by_transforms(lasers, found.fixed), *twin_notes(lasers)]
    log = LaserLog(lasers, [], notes, uses_received_times=uses_received)
    log.moments = _moments(log, [[place for place, _ in found.scans[key]] for key in found.scans])
    if len(lasers) > 1:
        together = sum(len(moment.scans) > 1 for moment in log.moments)
        notes.append(
            f"{len(scans)} scans of {len(lasers)} lasers make {counted(len(log.moments), 'position')}, "
            f"{together} of them with scans of several"
        )
    return log


def chosen_topics(content: BagContent, wanted: tuple[str, ...]) -> set[str]:
    """The topics of lasers. Raises UnknownLogError where there is none, or where one that is wanted is none."""
    lasers = {topic for topic, type_name in content.counts if type_name in LASERS}
    if not lasers:
        has = f"{_listed(content.counts)}{_ending(content.damages)}"
        raise UnknownLogError(f"no laser scans (LaserScan, MultiEchoLaserScan); the bag has {has}")
    topics = {topic for topic, _ in content.counts}
    named = {topic if topic in topics or f"/{topic}" not in topics else f"/{topic}" for topic in wanted}
    for topic in sorted(named - lasers):
        what = "no laser scans on" if topic in topics else "no topic"
        raise UnknownLogError(
            f"the bag has {what} {printable(topic)}; its lasers are on {', '.join(map(printable, sorted(lasers)))}"
        )
    return named or lasers


def _listed(counts: Mapping[tuple[str, str], int]) -> str:
    if not counts:
        return "no messages"
    names = [f"{printable(topic)} ({printable(type_name)})" for topic, type_name in sorted(counts)]
    more = f" and {len(names) - MOST_LISTED} more" if len(names) > MOST_LISTED else ""
    return ", ".join(names[:MOST_LISTED]) + more


def _decode(content: BagContent, topics: set[str], echo: Echo) -> _Decoded:
    found = _Decoded()
    for place, raw in enumerate(content.messages):
        is_laser = raw.channel.type_name in LASERS
        if is_laser and raw.channel.topic not in topics:
            continue
        try:
            _take(found, raw, place, echo, is_laser)
        except UnreadableMessageError:
            topic = raw.channel.topic
            found.unreadable[topic] = found.unreadable.get(topic, 0) + 1
    return found


def _take(found: _Decoded, raw: RawMessage, place: int, echo: Echo, is_laser: bool) -> None:
    message = decoded(raw)
    if not is_laser:
        for transform in transforms(message):
            found.fixed.add(transform)
        return
    key = raw.channel.topic, frame_name(message.header.frame_id)
    found.scans.setdefault(key, []).append((place, laser_scan(message, raw.received_ns, echo)))


def _lasers(found: _Decoded) -> list[Laser]:
    """A topic with several frames has several lasers."""
    topics = [topic for topic, _ in found.scans]
    lasers = []
    for (topic, frame), scans in found.scans.items():
        name = topic.removeprefix("/") or topic
        lasers.append(
            Laser(name if topics.count(topic) == 1 else f"{name}:{frame}", frame, [scan for _, scan in scans])
        )
    return lasers


def needs_received_times(lasers: list[Laser]) -> bool:
    """The clocks of headers and of receiving differ, so that all lasers use the same."""
    has_none = any(all(scan.stamp_ns == 0 for scan in laser.scans) for laser in lasers)
    return has_none and any(scan.received_ns for laser in lasers for scan in laser.scans)


def _moments(log: LaserLog, places: list[list[int]]) -> list[Moment]:
    times = [
        np.array([log.time_ns(index, scan) for scan in range(len(laser.scans))], dtype=np.int64)
        for index, laser in enumerate(log.lasers)
    ]
    return group(times, places)


def _unreadable_notes(found: _Decoded) -> list[str]:
    return [
        f"{printable(topic)}: left out {counted(number, 'message')} that cannot be read"
        for topic, number in found.unreadable.items()
    ]


def _left_out_notes(content: BagContent, wanted: tuple[str, ...]) -> list[str]:
    """Topics with ranges that are no laser scans; only where nobody chose topics."""
    left_out = sorted({topic for topic, type_name in content.counts if type_name in OTHER_RANGES})
    return [] if wanted else [f"{printable(topic)}: left out, only laser scans are read" for topic in left_out]


def _ending(reasons: list[str]) -> str:
    return f" ({'; '.join(reasons)})" if reasons else ""
