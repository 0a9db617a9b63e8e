# SPDX-License-Identifier: GPL-3.0-or-later
"""The messages of ROS 1 bags (format 2.0), record by record from the beginning.

The index at a bag's end is not used: a bag that was cut off or never closed has none, and one way to read all bags is
tested more often than two. After a damaged place, reading goes on at the next chunk.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from .bag_content import BagContent, Channel, RawMessage
from .compressed import Bytes, chunk_stream, salvage
from .model import UnknownLogError, counted

MAGIC = b"#ROSBAG V"
VERSION = b"2.0\n"
MESSAGE, BAG_HEADER, INDEX, CHUNK, CHUNK_INFO, CONNECTION = 2, 3, 4, 5, 6, 7
CHUNK_FIELDS = b"compression="
# Where the header of a chunk may begin before the name of its field `compression`: its size of 4 bytes, the field's
# own, and whichever of `op` (8 bytes) and `size` (13 bytes) come first.
CHUNK_STARTS = (8, 16, 21, 29)

Header = dict[bytes, bytes]


class BrokenRecordError(ValueError):
    """There is no whole record."""


@dataclass(frozen=True)
class Record:
    """`is_whole` is false where the data end before the record does."""

    fields: Header
    data: memoryview
    size: int  # that the data should have
    end: int
    is_whole: bool

    @property
    def op(self) -> int:
        value = self.fields.get(b"op", b"")
        return value[0] if len(value) == 1 else 0


def read_record(data: memoryview, start: int) -> Record:
    """The record that starts there. Raises BrokenRecordError."""
    fields, position = _header(data, start)
    size, position = _size(data, position)
    end = position + size
    return Record(fields, data[position:end], size, end, end <= len(data))


def _size(data: memoryview, start: int) -> tuple[int, int]:
    if start + 4 > len(data):
        raise BrokenRecordError
    return int.from_bytes(data[start : start + 4], "little"), start + 4


def _header(data: memoryview, start: int) -> tuple[Header, int]:
    size, position = _size(data, start)
    end = position + size
    if end > len(data):
        raise BrokenRecordError
    return parse_fields(bytes(data[position:end])), end


def parse_fields(raw: bytes) -> Header:
    """The fields `name=value` of a header. Raises BrokenRecordError."""
    fields: Header = {}
    position = 0
    while position < len(raw):
        size = int.from_bytes(raw[position : position + 4], "little")
        position += 4 + size
        name, separator, value = raw[position - size : position].partition(b"=")
        if not separator or position > len(raw):
            raise BrokenRecordError
        fields[name] = value
    return fields


def read_ros1_bag(data: Bytes, wants: Callable[[str], bool]) -> BagContent:
    """The messages whose type is wanted. Raises UnknownLogError for another version of the format."""
    view = memoryview(data)
    first_line = bytes(view[: len(MAGIC) + len(VERSION)])
    if not first_line.endswith(VERSION):
        version = first_line[len(MAGIC) :].decode("ascii", errors="replace").split("\n")[0]
        raise UnknownLogError(f"a ROS bag of version {version!r}; only 2.0 is read (rosbag fix converts others)")
    return _Scanner(data, wants).scan(len(first_line))


class _Scanner:
    def __init__(self, data: Bytes, wants: Callable[[str], bool]) -> None:
        self.data = data
        self.view = memoryview(data)
        self.wants = wants
        self.channels: dict[bytes, Channel] = {}
        self.content = BagContent()
        self.index_position = 0
        self.num_unknown = 0  # messages
        self.last_whole = 0  # where the last whole record ends, in a chunk that is not compressed also within it

    def scan(self, start: int) -> BagContent:
        position = start
        while position < len(self.view):
            try:
                record = read_record(self.view, position)
                self.last_whole = position
                self._take(record)
                if not record.is_whole:
                    raise BrokenRecordError
                position = self.last_whole = record.end
            except (BrokenRecordError, UnicodeDecodeError, struct.error):
                position = self._after_damage(position)
        if self.num_unknown:
            unknown = counted(self.num_unknown, "message")
            self.content.damages.append(f"left out {unknown} whose topic is lost")
        if self.index_position == 0:
            self.content.damages.append("the bag was never closed")
        elif self.index_position >= len(self.view) and not self.content.damages:
            self.content.damages.append(self.content.cut_at(len(self.view)))
        self.content.messages.sort(key=lambda message: message.received_ns)
        return self.content

    def _after_damage(self, position: int) -> int:
        following = self._next_chunk(position + 1)
        if following is None:
            self.content.damages.append(self.content.cut_at(self.last_whole))
            return len(self.view)
        self.content.damages.append(f"the bag is damaged at byte {position}; it goes on at byte {following}")
        return following

    def _next_chunk(self, start: int) -> int | None:
        """Where the next chunk begins."""
        found = self.data.find(CHUNK_FIELDS, start)
        while found >= 0:
            for before in CHUNK_STARTS:
                begin = found - before
                if begin >= start and self._is_chunk(begin):
                    return begin
            found = self.data.find(CHUNK_FIELDS, found + 1)
        return None

    def _is_chunk(self, begin: int) -> bool:
        try:
            return read_record(self.view, begin).op == CHUNK
        except BrokenRecordError:
            return False

    def _take(self, record: Record) -> None:
        if record.op == CHUNK:
            self._take_chunk(record)
        elif record.op == CONNECTION and record.is_whole:
            self._take_connection(record)
        elif record.op == MESSAGE and record.is_whole:
            self._take_message(record)
        elif record.op == BAG_HEADER:
            if record.fields.get(b"encryptor"):
                raise UnknownLogError("an encrypted bag")
            self.index_position = int.from_bytes(record.fields.get(b"index_pos", b""), "little")
            self._take_index()
        elif record.op not in (MESSAGE, INDEX, CHUNK_INFO, CONNECTION):
            raise BrokenRecordError

    def _take_index(self) -> None:
        """The topics that the end of the bag lists, if it is there: the chunk that lists them first may be damaged."""
        position = self.index_position
        with suppress(BrokenRecordError, UnicodeDecodeError):
            while 0 < position < len(self.view):
                record = read_record(self.view, position)
                if record.op != CONNECTION or not record.is_whole:
                    return
                self._take_connection(record)
                position = record.end

    def _take_chunk(self, chunk: Record) -> None:
        new = chunk_stream(chunk.fields.get(b"compression", b"none").decode("ascii", errors="replace"))
        data, is_whole = chunk.data, chunk.is_whole
        if new is not None:
            raw, _, is_whole = salvage(bytes(chunk.data), new)
            data = memoryview(raw)
        position = 0
        while position < len(data):
            record = read_record(data, position)
            if record.op not in (MESSAGE, CONNECTION) or not record.is_whole:
                raise BrokenRecordError
            self._take(record)
            position = record.end
            if new is None:
                self.last_whole = chunk.end - chunk.size + position
        if not is_whole:
            raise BrokenRecordError

    def _take_connection(self, record: Record) -> None:
        fields = parse_fields(bytes(record.data))
        topic = record.fields.get(b"topic", b"").decode()
        type_name = fields.get(b"type", b"").decode()
        package, _, name = type_name.partition("/")
        self.channels[record.fields.get(b"conn", b"")] = Channel(
            topic=topic,
            type_name=f"{package}/msg/{name}",
            definition=fields.get(b"message_definition", b"").decode(errors="replace"),
            md5=fields.get(b"md5sum", b"").decode(),
        )

    def _take_message(self, record: Record) -> None:
        channel = self.channels.get(record.fields.get(b"conn", b""))
        if channel is None:
            self.num_unknown += 1
            return
        key = channel.topic, channel.type_name
        self.content.counts[key] = self.content.counts.get(key, 0) + 1
        if self.wants(channel.type_name):
            seconds, nanoseconds = struct.unpack("<II", record.fields.get(b"time", b""))
            received_ns = seconds * 10**9 + nanoseconds
            self.content.messages.append(RawMessage(channel, received_ns, bytes(record.data)))
