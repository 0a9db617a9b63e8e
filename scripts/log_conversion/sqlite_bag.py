# SPDX-License-Identifier: GPL-3.0-or-later
"""The messages of ROS 2 bags in SQLite files (.db3), with or without the metadata that lie beside them."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from pathlib import Path
from urllib.parse import quote

from .bag_content import BagContent, Channel, RawMessage
from .compressed import ZSTD_MAGIC, salvage, zstd_stream
from .model import UnknownLogError

MAGIC = b"SQLite format 3\x00"
# SQLite's errors; damaged names come with bytes that are no text, also within errors.
DAMAGE = (sqlite3.Error, UnicodeDecodeError, OverflowError)


def read_sqlite_bag(path: Path, data: bytes | None, wants: Callable[[str], bool]) -> BagContent:
    """A file, or its bytes where it was compressed. Raises UnknownLogError where it is no bag."""
    content = BagContent()
    try:
        connection = _connection(path, data)
    except DAMAGE as error:
        raise UnknownLogError(f"an SQLite file that cannot be opened: {error}") from None
    connection.text_factory = lambda raw: raw.decode(errors="replace")
    try:
        channels = _channels(connection)
        _read_messages(connection, channels, wants, content)
    finally:
        connection.close()
    content.messages.sort(key=lambda message: message.received_ns)
    return content


def _connection(path: Path, data: bytes | None) -> sqlite3.Connection:
    if data is not None:
        connection = sqlite3.connect(":memory:")
        connection.deserialize(data)
        return connection
    # A bag that was not closed may have its last messages in a file beside it, which only SQLite can join to it.
    beside = path.with_name(path.name + "-wal")
    mode = "mode=ro" if beside.exists() else "immutable=1"
    return sqlite3.connect(f"file:{quote(str(path.resolve()))}?{mode}", uri=True)


def _channels(connection: sqlite3.Connection) -> dict[int, Channel]:
    try:
        rows = connection.execute("SELECT id, name, type, serialization_format FROM topics").fetchall()
    except DAMAGE as error:
        raise UnknownLogError(f"an SQLite file, but no ROS 2 bag: {error}") from None
    return {row[0]: Channel(str(row[1]), str(row[2]), encoding=str(row[3])) for row in rows}


def _read_messages(
    connection: sqlite3.Connection, channels: dict[int, Channel], wants: Callable[[str], bool], content: BagContent
) -> None:
    """In the order of the file: an order by time would need an index that may be damaged."""
    num_rows = 0
    try:
        for topic_id, received_ns, data in connection.execute("SELECT topic_id, timestamp, data FROM messages"):
            num_rows += 1
            channel = channels.get(topic_id)
            if channel is None or not isinstance(data, bytes) or not isinstance(received_ns, int):
                continue
            key = channel.topic, channel.type_name
            content.counts[key] = content.counts.get(key, 0) + 1
            if wants(channel.type_name):
                content.messages.append(RawMessage(channel, received_ns, unpacked(data)))
    except DAMAGE:
        content.damages.append(f"the bag is cut off or damaged after {num_rows} messages")


def unpacked(data: bytes) -> bytes:
    """A message, decompressed where the bag compresses each by itself: none begins like that otherwise."""
    return salvage(data, zstd_stream())[0] if data.startswith(ZSTD_MAGIC) else data
