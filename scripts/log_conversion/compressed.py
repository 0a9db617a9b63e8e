# SPDX-License-Identifier: GPL-3.0-or-later
"""Compressed data, of which all that comes before a damaged place is used."""

from __future__ import annotations

import bz2
import mmap
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .model import UnknownLogError

GZIP_MAGIC = b"\x1f\x8b"
ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"
GZIP_WINDOW = 31  # zlib reads gzip's header and checksum
COMES_WITH_ROSBAGS = "need a package that comes with the Python package rosbags (pip install rosbags)"
PIECES = (1 << 20, 1 << 10, 1)  # bytes; smaller ones where a larger piece is damaged

Bytes = bytes | mmap.mmap
# Makes an object with `decompress(data)`, `eof` and `unused_data`, as the libraries have it for streams.
NewStream = Callable[[], Any]


@dataclass(frozen=True)
class Content:
    """The bytes of a file, and what was wrong with its compression, if anything."""

    data: Bytes
    damage: str = ""


def file_content(path: Path) -> Content:
    """A file, mapped into memory, or decompressed. Raises OSError, or UnknownLogError for a file without content."""
    with path.open("rb") as file:
        head = file.read(len(ZSTD_MAGIC))
        if not head:
            raise UnknownLogError(f"{path}: empty")
        if path.is_file() and not head.startswith((GZIP_MAGIC, ZSTD_MAGIC)):
            return Content(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
        packed = head + file.read()
    if not head.startswith((GZIP_MAGIC, ZSTD_MAGIC)):
        return Content(packed)  # of a pipe
    new = gzip_stream if head.startswith(GZIP_MAGIC) else zstd_stream()
    data, end, is_whole = salvage(packed, new)
    if not data:
        raise UnknownLogError(f"{path}: the compressed data are damaged from the beginning")
    return Content(data, "" if is_whole else f"the compressed data end or are damaged at byte {end}")


def gzip_stream() -> Any:
    return zlib.decompressobj(GZIP_WINDOW)


def zstd_stream() -> NewStream:
    try:
        from backports import zstd
    except ImportError:
        raise UnknownLogError(f"zstd data {COMES_WITH_ROSBAGS}") from None
    return zstd.ZstdDecompressor


def chunk_stream(compression: str) -> NewStream | None:
    """For the chunks of ROS bags; None: stored as they are. Raises UnknownLogError."""
    if compression in ("", "none"):
        return None
    if compression == "bz2":
        return bz2.BZ2Decompressor
    if compression == "zstd":
        return zstd_stream()
    if compression == "lz4":
        try:
            from lz4.frame import LZ4FrameDecompressor  # type: ignore[import-untyped]
        except ImportError:
            raise UnknownLogError(f"lz4 data {COMES_WITH_ROSBAGS}") from None
        return LZ4FrameDecompressor
    raise UnknownLogError(f"compression '{compression[:20]}' is none of none, bz2, lz4, zstd")


def salvage(packed: bytes, new: NewStream) -> tuple[bytes, int, bool]:
    """What can be decompressed of streams that follow one another, the byte where that ends, and whether it is all."""
    parts: list[bytes] = []
    start, is_whole = 0, True
    while is_whole and start < len(packed) and packed[start : start + 2] == packed[:2]:
        data, used, is_whole = _one_stream(packed[start:] if start else packed, new)
        parts.append(data)
        start += used
    return b"".join(parts), start, is_whole


def _one_stream(packed: bytes, new: NewStream) -> tuple[bytes, int, bool]:
    fed, parts = 0, [b""]
    for size in PIECES:
        stream = new()
        try:
            parts = [stream.decompress(packed[:fed]) if fed else b""]
            while fed < len(packed) and not stream.eof:
                parts.append(stream.decompress(packed[fed : fed + size]))
                fed = min(fed + size, len(packed))
        except Exception:  # noqa: S112: each library has its own errors
            continue
        return b"".join(parts), fed - len(stream.unused_data or b""), bool(stream.eof)
    return b"".join(parts), fed, False
