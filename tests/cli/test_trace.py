# SPDX-License-Identifier: GPL-3.0-or-later
"""--trace: every step that led to a map, which changes nothing about it."""
import gzip
import json

import pytest

OUTPUTS = {"--out": "map.png", "--trajectory": "map.tum", "--carmen-out": "out.log", "--rawlog-out": "out.rawlog"}


@pytest.fixture
def mapped(run, room_log, tmp_path):
    """The bytes of all outputs of a run into a folder of its own."""

    def map_room(folder, *arguments):
        (tmp_path / folder).mkdir()
        flags = [part for flag, name in OUTPUTS.items() for part in (flag, f"{folder}/{name}")]
        result = run("room.log", *flags, *arguments)
        assert result.returncode == 0, result.stderr
        return [(tmp_path / folder / name).read_bytes() for name in OUTPUTS.values()]

    return map_room


@pytest.mark.parametrize("method", ["robust", "paper"])
def test_a_trace_changes_no_byte_and_depends_on_no_thread(mapped, tmp_path, method):
    without = mapped("without", "--method", method)
    assert mapped("with", "--method", method, "--trace", "one.jsonl") == without
    assert mapped("four", "--method", method, "--threads", 4, "--trace", "four.jsonl") == without
    assert (tmp_path / "one.jsonl").read_bytes() == (tmp_path / "four.jsonl").read_bytes()


@pytest.mark.parametrize(("method", "step"), [("robust", "link"), ("paper", "alignment")])
def test_the_trace_tells_of_each_position_and_step(mapped, tmp_path, method, step):
    mapped("out", "--method", method, "--trace", "trace.jsonl.gz")
    records = [json.loads(line) for line in gzip.open(tmp_path / "trace.jsonl.gz", "rt")]
    kinds = [record["record"] for record in records]
    assert kinds[0] == "run"
    assert kinds[-1] == "end"
    assert (kinds.count("position"), kinds.count(step), kinds.count("result")) == (12, 11, 12)
    assert records[0]["options"]["method"] == method
    positions = [float(line.split()[1]) for line in (tmp_path / "out/map.tum").read_text().splitlines()]
    placed = [record["fragment_from_robot"][0] for record in records if record["record"] == "result"]
    assert placed == pytest.approx(positions, abs=1e-8)


def test_an_existing_trace_needs_force(fails, run, room_log, tmp_path):
    (tmp_path / "old.jsonl").write_text("old")
    fails(5, "room.log", "--out", "map.png", "--trace", "old.jsonl", says=["old.jsonl", "--force"])
    assert (tmp_path / "old.jsonl").read_text() == "old"
    assert run("room.log", "--out", "map.png", "--trace", "old.jsonl", "--force").returncode == 0
    assert (tmp_path / "old.jsonl").read_text().startswith('{"record":"run"')


def test_a_trace_needs_a_file_of_its_own(fails, room_log):
    fails(5, "room.log", "--out", "map.png", "--trace", "-", says=["'-'", "needs a file"])
    fails(5, "room.log", "--out", "map.png", "--trace", "no/trace.jsonl", says="no/trace.jsonl")
    fails(2, "room.log", "--out", "map.png", "--trace", "room.log", says="both input and output")


def test_a_full_disk_is_told_and_leaves_nothing(fails, room_log):
    def limit():
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

    fails(5, "room.log", "--out", "map.png", "--trace", "trace.jsonl", says="trace.jsonl", preexec_fn=limit)
