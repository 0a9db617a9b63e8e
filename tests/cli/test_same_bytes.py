# SPDX-License-Identifier: GPL-3.0-or-later
"""Odometry never reaches the map, and neither threads nor a second run change a byte."""

import json

import pytest
import synthetic_log

NAMES = ("map.png", "map.yaml", "map.tum", "map.log", "map.rawlog")


@pytest.fixture
def outputs_of(run, tmp_path):
    """All outputs of a run as bytes, and its report without what may differ: costs and the log's path."""

    def outputs(folder, log, *arguments):
        (tmp_path / folder).mkdir()
        outs = {"--out": "map.png", "--trajectory": "map.tum", "--carmen-out": "map.log", "--rawlog-out": "map.rawlog"}
        flags = [part for flag, name in outs.items() for part in (flag, f"{folder}/{name}")]
        result = run(log, *flags, "--report", f"{folder}/report.json", "--draw-path", *arguments)
        assert result.returncode == 0, result.stderr
        report = json.loads((tmp_path / folder / "report.json").read_text())
        for key in ("seconds", "milestones", "peak_memory_mib"):
            del report[key]
        del report["logs"][0]["path"], report["options"]["threads"]
        return [(tmp_path / folder / name).read_bytes() for name in NAMES], report

    return outputs


GARBAGE = {
    "numbers": lambda i: [f"{(i * 7919 + k * 104729) % 1000 / 3 - 100:.4f}" for k in range(6)],
    "huge": lambda i: ["1e300", "-1e300", "1e-300", "99999999999", "-0", "7"],
    "not-numbers": lambda i: ["nan", "inf", "-inf", "nan", "nan", "-nan"],
    "text": lambda i: ["north", "a_bit", "left", "--out", "#", "\\"],
}


@pytest.mark.parametrize("method", ["robust", "paper"])
@pytest.mark.parametrize("kind", GARBAGE)
def test_odometry_in_a_carmen_log_is_ignored(outputs_of, tmp_path, kind, method):
    (tmp_path / "clean.log").write_text(synthetic_log.carmen_log())
    garbage = "PARAM robot_frontlaser_offset 0.5\nODOM " + " ".join(GARBAGE[kind](0)) + " 1 robot 1\n"
    (tmp_path / "garbage.log").write_text(garbage + synthetic_log.carmen_log(fields=GARBAGE[kind]))
    assert outputs_of("a", "clean.log", "--method", method) == outputs_of("b", "garbage.log", "--method", method)


def test_odometry_in_a_rawlog_is_ignored(run, outputs_of, tmp_path):
    """The program's own rawlogs differ in odometry only."""
    (tmp_path / "room.log").write_text(synthetic_log.carmen_log())
    assert run("convert", "room.log", "plain.rawlog").returncode == 0
    assert run("room.log", "--out", "x.png", "--rawlog-out", "poses.rawlog").returncode == 0
    plain, poses = ((tmp_path / name).read_bytes() for name in ("plain.rawlog", "poses.rawlog"))
    assert plain != poses
    assert outputs_of("a", "plain.rawlog") == outputs_of("b", "poses.rawlog")


@pytest.mark.parametrize("method", ["robust", "paper"])
def test_threads_and_runs_do_not_change_a_byte(outputs_of, tmp_path, method):
    (tmp_path / "room.log").write_text(synthetic_log.carmen_log())
    first = outputs_of("one", "room.log", "--method", method, "--threads", 1)
    assert outputs_of("again", "room.log", "--method", method, "--threads", 1) == first
    assert outputs_of("four", "room.log", "--method", method, "--threads", 4) == first


def test_the_format_recognised_is_the_format_forced(outputs_of, tmp_path):
    (tmp_path / "room.log").write_text(synthetic_log.carmen_log())
    assert outputs_of("a", "room.log") == outputs_of("b", "--carmen=room.log")
