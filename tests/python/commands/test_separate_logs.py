# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs that must stay apart, and halves that must not: made-up reports, and the program around a made-up mapper."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from evaluation.commands import separate_logs as separate_logs_command
from evaluation.judging.separate_logs import describe, halves, joints
from evaluation_support import carmen_text, reporter, written_log

NIST = "shapemap-scans 1\nunits m deg\n" + "".join(f"position {k}.0\nscan laser ranges {k}\n" for k in range(5))
# The fragment of the last log goes into that of the first, and `loops` with it.
JOIN = (
    "last = fragments.pop()\nfragments[0]['logs'] += last['logs']\nreport['loops'] = [loop(0, len(positions) - 1, 1.0)]"
)
# The second log goes on where the first one ends, but for an error in y.
GO_ON = "[p['map_from_robot'].update(x_m=p['index'], y_m=0.0) for p in positions]\n"


def report_on(fragments: list[dict[int, int]], loops: list[tuple[int, int, float]]) -> dict[str, Any]:
    """Fragments as number of positions by log; position k is of log k."""
    return {
        "scans": [{"log": k, "index_in_whole_log": 0} for k in range(4)],
        "components": [
            {"component": k, "logs": [{"log": log, "num_scans": num} for log, num in counts.items()]}
            for k, counts in enumerate(fragments)
        ],
        "loops": [{"a": a, "b": b, "strength": strength} for a, b, strength in loops],
    }


def test_fragments_of_one_log_each_are_apart() -> None:
    assert joints(report_on([{0: 5}, {1: 4}, {0: 1}], [(0, 0, 9.0)])) == []


def test_a_fragment_of_two_logs_is_a_joint_with_the_loops_between_them() -> None:
    (one,) = joints(report_on([{2: 3}, {1: 4, 0: 5}], [(1, 0, 3.0), (0, 1, 8.0), (2, 2, 20.0)]))
    assert (one.logs, one.fragment, one.num_positions, one.strengths) == ((0, 1), 1, (5, 4), (8.0, 3.0))
    text = describe(one, ["a", "b", "c"])
    assert text == "a and b joined in fragment 1: 5 and 4 positions, loops between them: 2, strongest 8.0"


def test_logs_that_are_joined_by_way_of_another_one_are_told() -> None:
    found = joints(report_on([{0: 5, 1: 4, 2: 3}], [(0, 1, 3.0), (1, 2, 8.0)]))
    assert [one.logs for one in found] == [(0, 1), (0, 2), (1, 2)]
    assert "no loop between them" in describe(found[1], ["a", "b", "c"])


@pytest.mark.parametrize(("text", "word"), [(NIST, "position"), (carmen_text(5), "FLASER")])
def test_halves_hold_each_scan_once(text: str, word: str) -> None:
    first, second = halves(text)
    assert [part.count(word) for part in (first, second)] == [3, 2]
    scans = [line for line in text.splitlines() if line.startswith(("scan", "FLASER"))]
    assert [line for part in (first, second) for line in part.splitlines() if line in scans] == scans
    assert second.startswith(text[: text.index(word)])


def test_a_single_scan_has_no_halves() -> None:
    with pytest.raises(ValueError, match="1 scans"):
        halves(carmen_text(1))


def run(tmp_path: Path, change: str, *words: str, names: str = "abc") -> tuple[int, dict[str, Any]]:
    logs = [str(written_log(tmp_path, name, 6 + k)) for k, name in enumerate(names)]
    cli = reporter(tmp_path, change)
    status = separate_logs_command.main([*logs, "--cli", str(cli), "--json", str(tmp_path / "out.json"), *words])
    return status, json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))


def test_logs_that_stay_apart_are_right(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, content = run(tmp_path, "")
    assert (status, content["runs"][0]["joined"], content["runs"][0]["num_fragments"]) == (0, [], 3)
    assert "a (6) + b (7) + c (8): nothing joined, fragments: 3" in capsys.readouterr().out


def test_a_joint_is_an_error_and_says_whose(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, content = run(tmp_path, JOIN)
    assert (status, content["runs"][0]["joined"][0]["logs"]) == (1, ["a", "c"])
    out = capsys.readouterr().out
    assert "a and c joined in fragment 0: 6 and 8 positions, loops between them: 1, strongest 5.0" in out


def test_pairs_are_runs_of_their_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, content = run(tmp_path, f"if len(logs) == 2 and 'b.log' in logs[0]:\n    exec({JOIN!r})", "--pairs")
    assert [entry["logs"] for entry in content["runs"]] == [["a", "b"], ["a", "c"], ["b", "c"]]
    assert (status, [len(entry["joined"]) for entry in content["runs"]]) == (1, [0, 0, 1])
    assert "2 of 3 runs as they should be" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "verdict", "status"),
    [
        (GO_ON + JOIN, "joined, fragments: 1", 0),
        (GO_ON + JOIN + "\npositions[-1]['map_from_robot']['y_m'] = 9.0", "joined WRONGLY", 1),
        (GO_ON, "NOT joined, fragments: 2", 1),
    ],
)
def test_halves_of_a_log_must_be_joined_rightly(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], change: str, verdict: str, status: int
) -> None:
    found, content = run(tmp_path, change, "--with-itself", names="a")
    assert (found, content["runs"][0]["right"]) == (status, status == 0)
    out = capsys.readouterr().out
    assert f"a in two halves: {verdict}" in out
    assert ("ATE 0.0 cm" in out) == (verdict != "joined WRONGLY")


def test_a_run_without_a_map_is_no_success(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, content = run(tmp_path, "sys.exit('out of luck')")
    assert (status, content["runs"][0]["fault"]) == (1, "exit code 1: out of luck")
    assert "a + b + c: no map" in capsys.readouterr().out


def test_wrong_usage_and_too_few_logs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for words in ([], ["x.log", "--pairs", "--with-itself"]):
        with pytest.raises(SystemExit, match="2"):
            separate_logs_command.main(words)
    assert separate_logs_command.main([str(written_log(tmp_path)), str(tmp_path / "none.log")]) == 1
    assert "too few logs" in capsys.readouterr().err
    (tmp_path / "bad.log").write_text("FLASER 180 1 2\n", encoding="utf-8")
    assert separate_logs_command.main([str(tmp_path / "bad.log"), str(written_log(tmp_path))]) == 3
