# SPDX-License-Identifier: GPL-3.0-or-later
"""Loops against references: made-up reports of a log whose scan k stands at (k, 0)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evaluation.commands import loops as loops_command
from evaluation.judging.loops import Limits, describe, table
from evaluation.judging.loops import check_loops as judged
from evaluation_support import line_log, reporter, written_log


def report_on(loops: list[dict[str, Any]], scans: list[int]) -> dict[str, Any]:
    positions = [{"log": 0, "index_in_whole_log": scan} for scan in scans]
    return {"scans": positions, "loops": loops}


def loop(a: int, b: int, *pose: float) -> dict[str, Any]:
    return {"a": a, "b": b, "a_from_b": dict(zip(("x_m", "y_m", "theta_deg"), pose)), "strength": 4.0}


@pytest.mark.parametrize(
    ("pose", "verdict"),
    [
        ((4.0, 0.0, 0.0), "right"),
        ((4.2, -0.2, 2.9), "right"),
        ((4.0, 0.31, 0.0), "imprecise"),
        ((4.0, 0.0, -3.1), "imprecise"),
        ((4.0, 1.01, 0.0), "false"),
        ((4.0, 0.0, 10.1), "false"),
        ((4.0, 0.0, 359.0), "right"),
        ((-4.0, 0.0, 180.0), "false"),
        ((float("nan"), 0.0, 0.0), "false"),
    ],
)
def test_the_worse_of_place_and_heading_decides(tmp_path: Path, pose: tuple[float, ...], verdict: str) -> None:
    (one,) = judged(line_log(tmp_path), report_on([loop(1, 5, *pose)], list(range(6))), Limits())
    assert one.verdict == verdict
    assert (one.agree_loop is None) == (verdict == "right")


def test_limits_are_those_that_are_given(tmp_path: Path) -> None:
    report = report_on([loop(1, 5, 4.2, 0.0, 0.0)], list(range(6)))
    (one,) = judged(line_log(tmp_path), report, Limits(false_m=0.15))
    assert one.verdict == "false"
    assert (one.error_m, one.error_deg) == pytest.approx((0.2, 0.0))


def test_positions_are_those_of_the_log_where_some_are_left_out(tmp_path: Path) -> None:
    (one,) = judged(line_log(tmp_path), report_on([loop(0, 2, 4.0, 0.0, 0.0)], [1, 3, 5]), Limits())
    assert (one.a, one.b, one.verdict) == (1, 5, "right")


def test_agreement_tells_that_the_reference_is_wrong(tmp_path: Path) -> None:
    log = line_log(tmp_path)
    log.content.points[:] = [np.array([[1.0, 2.0], [3.0, 5.0]]) for _ in log.content.points]  # all see the same
    (one,) = judged(log, report_on([loop(1, 5, 0.0, 0.0, 0.0)], list(range(6))), Limits())
    assert (one.verdict, one.agree_loop, one.agree_reference) == ("false", 1.0, 0.0)
    assert "points on points: 1.00 at the loop, 0.00 at the reference" in describe("line", one)


def test_a_log_without_loops_has_a_row() -> None:
    assert table({"bare": []}).splitlines()[-1] == "| bare | 0 | 0 | 0 | - | - |"


LOOPS = "report['loops'] = [loop(1, 5, 4.0), loop(0, 3, 3.5), loop(0, 4, *map(float, passed_on))]"


@pytest.mark.parametrize(("y_m", "status"), [("0.1", 0), ("2", 1)])
def test_the_program_lists_what_is_false(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], y_m: str, status: int
) -> None:
    arguments = [str(written_log(tmp_path)), "--cli", str(reporter(tmp_path, LOOPS)), "--arg=4", f"--arg={y_m}"]
    assert loops_command.main([*arguments, "--json", str(tmp_path / "out.json")]) == status
    out = capsys.readouterr().out
    assert f"| line | 3 | {status} | 1 |" in out
    assert ("line: false: 0 - 4, off by 2.00 m and 0.0 deg, strength 5.0" in out) == bool(status)
    assert "imprecise:" not in out
    loops = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))["logs"]["line"]
    assert [one["verdict"] for one in loops] == ["right", "imprecise", "false" if status else "right"]


def test_imprecise_ones_are_listed_on_demand(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cli = reporter(tmp_path, "report['loops'] = [loop(0, 3, 3.5)]")
    assert loops_command.main([str(written_log(tmp_path)), "--cli", str(cli), "--list-imprecise"]) == 0
    assert "line: imprecise: 0 - 3, off by 0.50 m" in capsys.readouterr().out


def test_what_cannot_be_checked_is_no_success(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cli = reporter(tmp_path, "if 'crash' in passed_on: sys.exit('out of luck')")
    log = written_log(tmp_path)
    assert loops_command.main([str(log), str(tmp_path / "none.log"), "--cli", str(cli)]) == 1
    assert "SKIPPED none, missing" in capsys.readouterr().err
    assert loops_command.main([str(log), "--cli", str(cli), "--arg=crash"]) == 1
    assert "line: exit code 1: out of luck" in capsys.readouterr().err
    declared = tmp_path / "datasets.toml"
    entry = f'[[dataset]]\nname = "bare"\nsensor = "SICK"\nreference = "none"\npath = "{log}"\n'
    declared.write_text(entry, encoding="utf-8")
    assert loops_command.main(["--only", "bare", "--datasets", str(declared), "--cli", str(cli)]) == 1
    assert "bare, no reference poses" in capsys.readouterr().err


def test_wrong_usage_and_malformed_logs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        loops_command.main([])
    (tmp_path / "bad.log").write_text("no scans\n", encoding="utf-8")
    assert loops_command.main([str(tmp_path / "bad.log")]) == 3
    log = str(written_log(tmp_path))
    assert loops_command.main([log, log]) == 3
    assert "twice: line" in capsys.readouterr().err
