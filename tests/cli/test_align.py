# SPDX-License-Identifier: GPL-3.0-or-later
"""Aligning single pairs: what is written, which pairs are taken, and what is refused."""

import json
import math
import os
import signal
import subprocess
import time
import tomllib

import patience
import pytest
import synthetic_log

SHARES = ("agree", "crossed", "hidden", "unclear", "outside")


def relative(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    dx, dy = b[0] - a[0], b[1] - a[1]
    return c * dx + s * dy, -s * dx + c * dy, math.remainder(b[2] - a[2], 2 * math.pi)


def is_near(pose, truth):
    return math.hypot(pose[0] - truth[0], pose[1] - truth[1]) < 0.05 and abs(
        math.remainder(pose[2] - truth[2], 2 * math.pi)
    ) < math.radians(1)


def objects(text):
    return [json.loads(line) for line in text.splitlines()]


@pytest.fixture
def align(run):
    """The objects that a run writes to standard output."""

    def run_align(*arguments):
        result = run("align", *arguments, "--out", "-")
        assert result.returncode == 0, result.stderr
        return objects(result.stdout)

    return run_align


def test_every_pair_of_a_gap_is_found(align, room_log):
    truth = synthetic_log.path(12)
    pairs = align("room.log", "--gap", 2)
    assert [(p["reference"], p["query"]) for p in pairs] == [(i, i + 2) for i in range(10)]
    for pair in pairs:
        assert pair["status"] == "ok"
        assert pair["reason"] == ""
        assert 0.95 <= pair["probability"] <= 1
        assert len(pair["covariance"]) == 3
        assert all(pair["covariance"][i][i] > 0 for i in range(3))
        best = pair["hypotheses"][0]
        assert is_near(best["pose"], relative(truth[pair["reference"]], truth[pair["query"]]))
        assert math.isclose(sum(best[name] for name in SHARES), 1, abs_tol=1e-9)
        assert 0.5 < best["cross_agree"] <= 1
        assert 0 <= best["rms_m"] < 0.05
        assert best["partners"] > 50
        scores = [hypothesis["score"] for hypothesis in pair["hypotheses"]]
        assert scores == sorted(scores, reverse=True)
        assert not {"seconds", "given", "refined"} & set(pair)


def test_a_given_pose_is_judged_and_not_used(align, tmp_path, room_log):
    truth = synthetic_log.path(12)
    x, y, theta = relative(truth[3], truth[5])
    (tmp_path / "bare.txt").write_text("3 5\n")
    (tmp_path / "good.txt").write_text(f"# where they stood\n\n3 5 {x} {y} {theta}\r\n")
    (tmp_path / "near.txt").write_text(f"3 5 {x + 0.1} {y} {theta} # a little off\n")
    (tmp_path / "wrong.txt").write_text("3 5 +2 -2 0.5\n")
    bare, good, near, wrong = (
        align("room.log", "--pairs", name)[0] for name in ("bare.txt", "good.txt", "near.txt", "wrong.txt")
    )
    for pair in (good, near, wrong):
        assert {name: pair[name] for name in bare} == bare
    assert good["given"]["pose"] == [x, y, theta]
    assert good["given"]["agree"] > 0.8
    assert near["given"]["score"] < good["given"]["score"]
    assert is_near(near["refined"]["pose"], (x, y, theta))
    assert near["refined"]["score"] > near["given"]["score"]
    assert wrong["given"]["score"] < good["given"]["score"] - 5
    assert wrong["given"]["crossed"] + wrong["given"]["hidden"] > 0.2


def test_queries_may_be_of_another_log(align, tmp_path, room_log):
    truth = synthetic_log.path(12)
    lines = room_log.read_text().splitlines(keepends=True)
    (tmp_path / "late.log").write_text("".join(lines[8:]))
    (tmp_path / "pairs.txt").write_text("7 0\n10 3\n")
    pairs = align("room.log", "late.log", "--pairs", "pairs.txt")
    assert [pair["status"] for pair in pairs] == ["ok", "ok"]
    assert is_near(pairs[0]["hypotheses"][0]["pose"], relative(truth[7], truth[8]))
    assert is_near(pairs[1]["hypotheses"][0]["pose"], relative(truth[10], truth[11]))


def test_indices_count_the_selected_positions(align, room_log):
    truth = synthetic_log.path(12)
    pairs = align("room.log", "--gap", 1, "--skip", 1, "--every", 3, "--first", 3)
    assert [(p["reference"], p["query"]) for p in pairs] == [(0, 1), (1, 2)]
    assert is_near(pairs[1]["hypotheses"][0]["pose"], relative(truth[4], truth[7]))


def test_scans_without_shape_say_so(align, tmp_path):
    blind, seeing = synthetic_log.flaser([81.83] * 181, 1.0), synthetic_log.carmen_log(1)
    (tmp_path / "half.log").write_text(seeing + blind)
    (tmp_path / "pairs.txt").write_text("0 1 1 0 0\n1 0\n")
    first, second = align("half.log", "--pairs", "pairs.txt")
    assert first["status"] == second["status"] == "no-shape"
    assert "query" in first["reason"]
    assert "reference" in second["reason"]
    for name in ("probability", "covariance", "given", "refined"):
        assert first[name] is None
    assert first["hypotheses"] == []


def test_threads_and_runs_do_not_change_a_byte(run, tmp_path):
    (tmp_path / "long.log").write_text(synthetic_log.carmen_log(40))
    for name, threads in (("one", 1), ("again", 1), ("four", 4)):
        result = run("align", "long.log", "--gap", 1, "--out", f"{name}.jsonl", "--threads", threads)
        assert result.returncode == 0, result.stderr
    first = (tmp_path / "one.jsonl").read_bytes()
    assert len(first.splitlines()) == 39
    assert (tmp_path / "again.jsonl").read_bytes() == first
    assert (tmp_path / "four.jsonl").read_bytes() == first


def test_poses_in_the_log_are_ignored(run, tmp_path):
    (tmp_path / "a.log").write_text(synthetic_log.carmen_log(4))
    (tmp_path / "b.log").write_text(synthetic_log.carmen_log(4, fields=lambda i: [f"{3.7 * i - k}" for k in range(6)]))
    a, b = (run("align", name, "--gap", 1, "--out", "-").stdout for name in ("a.log", "b.log"))
    assert a
    assert a == b


def test_timings_summary_and_silence(run, align, room_log):
    assert all(pair["seconds"] > 0 for pair in align("room.log", "--gap", 5, "--timings"))
    result = run("align", "room.log", "--gap", 5, "--out", "p.jsonl")
    assert result.stdout == ""
    assert "aligned 7 pairs" in result.stderr
    assert "p.jsonl" in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert run("align", "room.log", "--gap", 5, "--out", "-", "--quiet").stderr == ""


def test_options_files_of_both_commands_fit(run, align, tmp_path, room_log):
    text = run("align", "--kept-candidates", 1, "--dump-config").stdout
    values = tomllib.loads(text)
    assert values["kept-candidates"] == 1
    assert "threads" in values
    assert "method" not in values
    assert "resolution-m" not in values
    (tmp_path / "pairs.toml").write_text(text)
    (tmp_path / "map.toml").write_text(run("--kept-candidates", 1, "--dump-config").stdout)
    for name in ("pairs.toml", "map.toml"):
        assert all(len(pair["hypotheses"]) == 1 for pair in align("room.log", "--gap", 1, "--config", name))
    assert tomllib.loads(run("--config", "pairs.toml", "--dump-config").stdout)["kept-candidates"] == 1


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["room.log"],
        ["room.log", "--out", "p.jsonl"],
        ["room.log", "--gap", "1"],
        ["--gap", "1", "--out", "p.jsonl"],
        ["room.log", "--gap", "0", "--out", "p.jsonl"],
        ["room.log", "--gap", "-1", "--out", "p.jsonl"],
        ["room.log", "--gap", "12", "--out", "p.jsonl"],
        ["room.log", "--gap", "1.5", "--out", "p.jsonl"],
        ["room.log", "--gap", "1", "--pairs", "pairs.txt", "--out", "p.jsonl"],
        ["room.log", "room.log", "--gap", "1", "--out", "p.jsonl"],
        ["room.log", "room.log", "room.log", "--pairs", "pairs.txt", "--out", "p.jsonl"],
        ["room.log", "--gap", "1", "--out", "room.log", "--force"],
        ["room.log", "--pairs", "pairs.txt", "--out", "pairs.txt", "--force"],
        ["room.log", "--gap", "1", "--out", "p.jsonl", "--from", "bag"],
        ["room.log", "--gap", "1", "--out", "p.jsonl", "--threads", "-1"],
        ["room.log", "--gap", "1", "--out", "p.jsonl", "--lcs-band", "3"],
    ],
)
def test_wrong_usage_is_one_line_and_code_2(fails, tmp_path, room_log, arguments):
    (tmp_path / "pairs.txt").write_text("0 1\n")
    fails(2, "align", *arguments)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("0 1\n0\n", ["bad.txt:2", "found 1 values"]),
        ("0 1 2\n", ["bad.txt:1", "found 3 values"]),
        ("0 1 2 3 4 5\n", ["bad.txt:1", "found 6 values"]),
        ("# a\n\n0 12\n", ["bad.txt:3", "query is '12'", "0 to 11"]),
        ("-1 0\n", ["bad.txt:1", "reference is '-1'"]),
        ("0 1.0\n", ["bad.txt:1", "query is '1.0'"]),
        ("0 99999999999999999999\n", ["bad.txt:1", "query"]),
        ("0 1 nan 0 0\n", ["bad.txt:1", "x_m is 'nan'"]),
        ("0 1 0 1e999 0\n", ["bad.txt:1", "y_m"]),
        ("0 1 0 0 left\n", ["bad.txt:1", "theta_rad is 'left'"]),
        ("# nothing\n", ["bad.txt", "no pair"]),
        ("", ["bad.txt"]),
    ],
)
def test_a_bad_file_of_pairs_is_named_with_its_line(fails, tmp_path, room_log, text, says):
    (tmp_path / "bad.txt").write_text(text)
    fails(3, "align", "room.log", "--pairs", "bad.txt", "--out", "p.jsonl", says=says)


def test_what_cannot_be_read_or_written_leaves_nothing(fails, tmp_path, room_log):
    (tmp_path / "mine.jsonl").write_text("mine")
    fails(3, "align", "missing.log", "--gap", "1", "--out", "p.jsonl", says="missing.log")
    fails(3, "align", "room.log", "--pairs", "missing.txt", "--out", "p.jsonl", says="missing.txt")
    fails(5, "align", "room.log", "--gap", "1", "--out", "missing/p.jsonl", says="missing")
    fails(5, "align", "room.log", "--gap", "1", "--out", "/dev/full", says="/dev/full")
    fails(5, "align", "room.log", "--gap", "1", "--out", "mine.jsonl", says="--force")
    assert (tmp_path / "mine.jsonl").read_text() == "mine"


def test_a_terminal_gets_a_bar_and_an_interrupt_leaves_nothing(cli_path, tmp_path, room_text, files_of):
    (tmp_path / "long.log").write_text(room_text * 400)
    main, terminal = os.openpty()
    command = [cli_path, "align", "long.log", "--gap", "1", "--out", "p.jsonl"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=terminal)
    os.close(terminal)
    seen = b""
    while b"/4799" not in seen or b"pairs/s" not in seen:
        seen += os.read(main, 4096)
    begin = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert patience.wait(process) == 130
    assert patience.is_soon(time.monotonic() - begin, 5.0)
    while b"nothing written" not in seen:
        seen += os.read(main, 4096)
    os.close(main)
    assert files_of() == ["long.log"]
