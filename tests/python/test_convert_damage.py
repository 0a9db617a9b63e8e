# SPDX-License-Identifier: GPL-3.0-or-later
"""Bags that are cut off or damaged: what is whole is used, and the rest is told; never more than a line, and never a
traceback."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest

import convert_logs
from conversion_support import converted, refusal, scan, transform, write_bag, write_ros2_bag

NUM_SCANS = 12
NUM_DAMAGED = 60


def messages(num: int = NUM_SCANS) -> list:
    return [transform("base_link", "laser"), *[scan(k + 1.0, [1.0 + k] * 20) for k in range(num)]]


def convert(source: Path) -> int:
    return convert_logs.main([str(source), str(source.with_name("damaged.nist"))])


@pytest.mark.parametrize("compression", ["", "bz2", "lz4"])
@pytest.mark.parametrize("is_zipped", [False, True])
def test_a_bag_that_is_cut_off(
    compression: str, is_zipped: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write_bag(tmp_path / "walk.bag", messages(60), compression, chunk_bytes=600)
    whole = bag.read_bytes()
    first, last = whole.index(b"compression="), whole.rindex(b"compression=")
    before = 0
    for share in (0.5, 0.7, 0.9):
        data = whole[: int(first + share * (last - first))]
        bag.write_bytes(gzip.compress(data) if is_zipped else data)
        log = converted(bag)
        assert [one.ranges for one in log.scans] == [[1.0 + k] * 20 for k in range(len(log.scans))]
        assert before <= len(log.scans) < 60
        before = len(log.scans)
        assert f", after {len(log.scans) + 1} messages" in capsys.readouterr().err
    assert before > 20


def test_a_chunk_that_is_cut_off_gives_its_whole_messages(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag = write_bag(tmp_path / "walk.bag", messages())
    data = bag.read_bytes()
    begin = data.rindex(np.full(20, 6.0, np.float32).tobytes())
    bag.write_bytes(data[: begin + 10])
    assert len(converted(bag).scans) == 5
    said = capsys.readouterr().err
    assert "the bag is cut off at byte" in said
    assert ", after 6 messages" in said


def test_a_bag_that_was_never_closed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag = write_bag(tmp_path / "walk.bag", messages())
    data = bag.read_bytes()
    at = data.index(b"index_pos=") + len(b"index_pos=")
    end = int.from_bytes(data[at : at + 8], "little")
    bag.write_bytes(data[:at] + bytes(8) + data[at + 8 : end])
    assert len(converted(bag).scans) == NUM_SCANS
    assert "the bag was never closed" in capsys.readouterr().err


@pytest.mark.parametrize("compression", ["", "bz2", "lz4"])
def test_reading_goes_on_after_a_damaged_chunk(
    compression: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write_bag(tmp_path / "walk.bag", messages(), compression, chunk_bytes=400)
    data = bytearray(bag.read_bytes())
    chunks = [at for at in range(len(data)) if data.startswith(b"compression=", at)]
    damaged = chunks[len(chunks) // 2]
    data[damaged + 40 : damaged + 80] = b"\xa5" * 40
    bag.write_bytes(data)
    log = converted(bag)
    found = {one.ranges[0] for one in log.scans}
    assert {1.0, float(NUM_SCANS)} <= found
    assert NUM_SCANS - 5 <= len(found) < NUM_SCANS
    assert "the bag is damaged at byte" in capsys.readouterr().err


@pytest.mark.parametrize("kind", ["bag", "bz2", "lz4", "gzip", "db3", "mcap"])
def test_no_damage_leads_to_a_traceback(kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Bytes changed, left out and cut off at random."""
    if kind in ("db3", "mcap"):
        folder = write_ros2_bag(tmp_path / "walk", messages(4), is_mcap=kind == "mcap")
        whole = next(folder.glob(f"*.{kind}")).read_bytes()
    else:
        compression = kind if kind in ("bz2", "lz4") else ""
        bag = write_bag(tmp_path / "walk.bag", messages(4), compression, chunk_bytes=300)
        whole = gzip.compress(bag.read_bytes()) if kind == "gzip" else bag.read_bytes()
    rng = np.random.default_rng(7)
    codes = []
    for _ in range(NUM_DAMAGED):
        data = bytearray(whole)
        for at in rng.integers(20, len(data), rng.integers(1, 6)):
            data[at] = rng.integers(256)
        begin = int(rng.integers(20, len(data)))
        if rng.random() < 0.3:
            del data[begin : begin + int(rng.integers(1, 40))]
        if rng.random() < 0.3:
            del data[begin:]
        source = tmp_path / "damaged"
        source.write_bytes(data)
        codes.append(convert(source))
        said = capsys.readouterr().err.splitlines()
        assert said
        assert codes[-1] == 0 or len(said) == 1
    assert set(codes) <= {0, 1}
    assert 0 in codes


@pytest.mark.parametrize("has_index", [False, True])
def test_the_chunk_that_names_the_topics_is_damaged(
    has_index: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write_bag(tmp_path / "walk.bag", messages(), "bz2", chunk_bytes=400)
    data = bytearray(bag.read_bytes())
    second = data.index(b"compression=", data.index(b"compression=") + 1)  # the scans begin there
    data[second + 60 : second + 100] = bytes(40)
    bag.write_bytes(data if has_index else data[: data.rindex(b"compression=") - 8])
    if has_index:
        assert {one.ranges[0] for one in converted(bag).scans} >= set(map(float, range(8, NUM_SCANS + 1)))
    else:
        assert "messages whose topic is lost" in refusal(bag, capsys)


def test_a_message_that_cannot_be_read_is_left_out(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag = write_bag(tmp_path / "walk.bag", messages())
    data = bag.read_bytes()
    count = (20).to_bytes(4, "little") + np.full(20, 3.0, np.float32).tobytes()
    assert data.count(count) == 1
    bag.write_bytes(data.replace(count, (10**9).to_bytes(4, "little") + count[4:]))
    assert [one.ranges[0] for one in converted(bag).scans] == [1, 2, *range(4, NUM_SCANS + 1)]
    assert "/scan: left out 1 message that cannot be read" in capsys.readouterr().err


def test_other_files_are_refused_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rng = np.random.default_rng(1)
    contents = {
        "empty": b"",
        "junk": rng.bytes(4000),
        "old.bag": b"#ROSBAG V1.2\n# nothing more\n",
        "head.bag": b"#ROSBAG V2.0\n",
        "junk.bag": b"#ROSBAG V2.0\n" + rng.bytes(4000),
        "junk.mcap": b"\x89MCAP0\r\n" + rng.bytes(4000),
        "junk.db3": b"SQLite format 3\x00" + rng.bytes(4000),
        "junk.gz": b"\x1f\x8b" + rng.bytes(4000),
        "junk.zstd": b"\x28\xb5\x2f\xfd" + rng.bytes(4000),
        "words": b"FLASER 3 1 2 3\n",
    }
    for name, content in contents.items():
        source = tmp_path / name
        source.write_bytes(content)
        refusal(source, capsys)
    (tmp_path / "folder").mkdir()
    assert "a folder without a file of a ROS 2 bag" in refusal(tmp_path / "folder", capsys)
    assert convert_logs.main([str(tmp_path / "missing"), str(tmp_path / "out")]) == 1


def test_names_in_a_database_that_are_no_text(tmp_path: Path) -> None:
    folder = write_ros2_bag(tmp_path / "walk", messages())
    data = next(folder.glob("*.db3")).read_bytes()
    (tmp_path / "bag").write_bytes(data.replace(b"/scan", b"/s\xffan"))
    assert len(converted(tmp_path / "bag").scans) == NUM_SCANS


def test_another_database_is_no_bag(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import sqlite3

    path = tmp_path / "other.db3"
    with sqlite3.connect(path) as connection:
        connection.execute("CREATE TABLE people (name TEXT)")
    connection.close()
    assert "no ROS 2 bag" in refusal(path, capsys)
