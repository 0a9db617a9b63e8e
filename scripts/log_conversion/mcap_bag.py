# SPDX-License-Identifier: GPL-3.0-or-later
"""The messages of MCAP files, record by record from the beginning, as those of ROS 1 bags and for the same reason."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from .bag_content import BagContent, Channel, RawMessage
from .compressed import Bytes, NewStream, chunk_stream, salvage
from .model import UnknownLogError
from .sqlite_bag import unpacked

MAGIC = b"\x89MCAP0\r\n"
FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, DATA_END = 2, 3, 4, 5, 6, 15
MESSAGE_HEADER = struct.Struct("<HIQQ")  # channel, sequence, time when it came, time when it was sent
CHUNK_HEADER = struct.Struct("<QQQI")  # first and last time, size, checksum


class BrokenRecordError(ValueError):
    """There is no whole record."""


DAMAGE = (BrokenRecordError, struct.error, UnicodeDecodeError, UnknownLogError)


@dataclass(frozen=True)
class Schema:
    name: str
    definition: str


def read_mcap_bag(data: Bytes, wants: Callable[[str], bool]) -> BagContent:
    scanner = _Scanner(wants)
    view = memoryview(data)
    try:
        scanner.scan(view, len(MAGIC))
    except BrokenRecordError:
        scanner.content.damages.append(scanner.content.cut_at(scanner.position))
    scanner.content.messages.sort(key=lambda message: message.received_ns)
    return scanner.content


def records(data: memoryview, start: int) -> Iterator[tuple[int, int, memoryview, bool]]:
    """Of each record where it begins, its kind, its data, and whether they are whole."""
    position = start
    while position < len(data):
        if position + 9 > len(data):
            raise BrokenRecordError
        end = position + 9 + int.from_bytes(data[position + 1 : position + 9], "little")
        yield position, data[position], data[position + 9 : end], end <= len(data)
        position = end


def text_at(data: memoryview, start: int) -> tuple[str, int]:
    end = start + 4 + int.from_bytes(data[start : start + 4], "little")
    if end > len(data):
        raise BrokenRecordError
    return bytes(data[start + 4 : end]).decode(), end


class _Scanner:
    def __init__(self, wants: Callable[[str], bool]) -> None:
        self.wants = wants
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.content = BagContent()
        self.position = 0

    def scan(self, data: memoryview, start: int) -> None:
        """Raises BrokenRecordError where the data end too early, in the record at `position`."""
        for position, kind, body, is_whole in records(data, start):
            self.position = position
            if kind in (DATA_END, FOOTER):
                return
            try:
                if kind == CHUNK:
                    self._take_chunk(body)
                elif is_whole:
                    self._take(kind, body)
            except DAMAGE:
                if is_whole:  # the next record can be found
                    self.content.damages.append(f"the bag is damaged at byte {position}")
            if not is_whole:
                raise BrokenRecordError
        self.position = len(data)
        raise BrokenRecordError

    def _take_chunk(self, body: memoryview) -> None:
        """What is whole of a chunk, also of one that is not."""
        CHUNK_HEADER.unpack(body[: CHUNK_HEADER.size])
        compression, start = text_at(body, CHUNK_HEADER.size)
        size = int.from_bytes(body[start : start + 8], "little")
        packed = body[start + 8 : start + 8 + size]
        new = chunk_stream(compression)
        data, is_whole = (packed, True) if new is None else _decompressed(packed, new)
        for _, kind, inner, inner_is_whole in records(data, 0):
            if not inner_is_whole:
                raise BrokenRecordError
            self._take(kind, inner)
        if not is_whole:
            raise BrokenRecordError

    def _take(self, kind: int, body: memoryview) -> None:
        if kind == SCHEMA:
            name, position = text_at(body, 2)
            _, position = text_at(body, position)
            definition, _ = text_at(body, position)
            self.schemas[int.from_bytes(body[:2], "little")] = Schema(name, definition)
        elif kind == CHANNEL:
            number, schema_number = struct.unpack("<HH", body[:4])
            topic, position = text_at(body, 4)
            encoding, _ = text_at(body, position)
            schema = self.schemas.get(schema_number, Schema("", ""))
            self.channels[number] = Channel(topic, _ros2_name(schema.name), schema.definition, encoding=encoding)
        elif kind == MESSAGE:
            self._take_message(body)

    def _take_message(self, body: memoryview) -> None:
        number, _, received_ns, _ = MESSAGE_HEADER.unpack(body[: MESSAGE_HEADER.size])
        channel = self.channels.get(number)
        if channel is None:
            return
        key = channel.topic, channel.type_name
        self.content.counts[key] = self.content.counts.get(key, 0) + 1
        if self.wants(channel.type_name):
            data = unpacked(bytes(body[MESSAGE_HEADER.size :]))
            self.content.messages.append(RawMessage(channel, received_ns, data))


def _ros2_name(name: str) -> str:
    package, separator, message = name.rpartition("/")
    return name if not separator or package.endswith("/msg") else f"{package}/msg/{message}"


def _decompressed(packed: memoryview, new: NewStream) -> tuple[memoryview, bool]:
    data, _, is_whole = salvage(bytes(packed), new)
    return memoryview(data), is_whole
