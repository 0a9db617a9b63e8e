# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs that are broken, odd or poor: one clear line, the right code, nothing half-written."""
import gzip
import os

import pytest
import synthetic_log

OUT = ["--out", "map.png", "--trajectory", "map.tum", "--report", "report.json"]


@pytest.mark.parametrize("flag", [[], ["--rawlog"], ["--carmen"], ["--nist"]])
def test_missing_file_folder_and_empty_file(fails, tmp_path, flag):
    (tmp_path / "empty").write_bytes(b"")
    (tmp_path / "folder").mkdir()
    for name in ("missing", "empty", "folder"):
        fails(3, *flag, name, *OUT, says=name)


@pytest.mark.parametrize("flag", [[], ["--rawlog"], ["--carmen"], ["--nist"]])
def test_binary_junk(fails, tmp_path, flag):
    for seed in range(3):
        (tmp_path / "junk").write_bytes(bytes((i * i * 7 + i * 13 + seed * 101) % 256 for i in range(5000)))
        fails(3, *flag, "junk", *OUT, says="junk")
        fails(3, "info", "junk", says="junk")
        fails(3, "convert", "junk", "junk.log", says="junk")


def test_unknown_format(fails, tmp_path):
    (tmp_path / "letter.txt").write_text("Dear reader,\nthis is no log.\n")
    fails(3, "letter.txt", *OUT, says="letter.txt")


def test_a_truncated_rawlog_is_used_as_far_as_it_goes(run, room_log, tmp_path):
    assert run("convert", "room.log", "room.rawlog").returncode == 0
    whole = (tmp_path / "room.rawlog").read_bytes()
    (tmp_path / "cut.rawlog").write_bytes(whole[: len(whole) * 2 // 3])
    result = run("cut.rawlog", "--out", "map.png", "--trajectory", "-")
    assert result.returncode == 0, result.stderr
    assert 6 <= len(result.stdout.splitlines()) < 12
    assert "warning: " in result.stderr
    assert "cut.rawlog" in result.stderr


def test_a_truncated_gz_is_used_as_far_as_it_goes_and_says_so(run, room_text, tmp_path):
    data = gzip.compress(room_text.encode())
    (tmp_path / "cut.log.gz").write_bytes(data[: len(data) // 2])
    result = run("cut.log.gz", "--out", "map.png", "--trajectory", "-")
    assert result.returncode == 0, result.stderr
    assert 2 <= len(result.stdout.splitlines()) < 12
    assert "warning: " in result.stderr
    assert "cut.log.gz" in result.stderr


def test_a_gz_without_content(fails, tmp_path):
    (tmp_path / "a.log.gz").write_bytes(gzip.compress(b"")[:6])
    fails(3, "a.log.gz", *OUT, says="a.log.gz")


@pytest.mark.parametrize(
    "line",
    [
        "FLASER 181 1.0 2.0 3.0",
        "FLASER 1000000000 1 2 3 0 0 0 0 0 0 1 robot 1",
        "FLASER -5 1 2 3",
        "FLASER",
        "FLASER x",
    ],
)
def test_a_carmen_line_that_is_no_scan_is_named(fails, tmp_path, room_text, line):
    (tmp_path / "bad.log").write_text(room_text.splitlines()[0] + "\n" + line + "\n" + room_text)
    fails(3, "bad.log", *OUT, says=["bad.log", "2"])


def test_odd_readings_are_no_returns(run, tmp_path):
    lines = []
    for i, pose in enumerate(synthetic_log.path(8)):
        ranges = synthetic_log.scan(pose)
        for k, odd in enumerate(["nan", "-1.0", "inf", "0.0", "-nan", "1e30", "81.83"]):
            ranges[20 + 5 * k] = odd
        lines.append(synthetic_log.flaser(ranges, 1.0 + i))
    (tmp_path / "odd.log").write_text("".join(lines))
    result = run("odd.log", "--out", "map.png")
    assert result.returncode == 0, result.stderr


def test_a_log_without_a_single_return(fails, tmp_path):
    (tmp_path / "blind.log").write_text("".join(synthetic_log.flaser([81.83] * 181, 1.0 + i) for i in range(3)))
    fails(3, "blind.log", *OUT, says=["blind.log", "nothing written"])


def test_one_scan_makes_a_map(run, tmp_path):
    (tmp_path / "one.log").write_text(synthetic_log.carmen_log(1))
    result = run("one.log", "--out", "map.png", "--trajectory", "-")
    assert result.returncode == 0, result.stderr
    assert result.stdout == "1.000000000 0.000000000 0.000000000 0 0 0 0.000000000000 1.000000000000\n"


def test_two_identical_scans_lie_on_each_other(run, tmp_path):
    scan = synthetic_log.scan(synthetic_log.path(1)[0])
    (tmp_path / "two.log").write_text(synthetic_log.flaser(scan, 1.0) + synthetic_log.flaser(scan, 2.0))
    result = run("two.log", "--out", "map.png", "--trajectory", "-")
    assert result.returncode == 0, result.stderr
    second = [float(v) for v in result.stdout.splitlines()[1].split()]
    assert abs(second[1]) < 1e-3
    assert abs(second[2]) < 1e-3
    assert abs(second[6]) < 1e-4


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_log_that_may_not_be_read(fails, room_log):
    room_log.chmod(0)
    fails(3, "room.log", *OUT, says="room.log")
