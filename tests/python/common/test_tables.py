# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables, shares and files that all commands share."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass
from pathlib import Path

import pytest

from evaluation.common.files import plain, write_json, write_whole
from evaluation.common.parallel import run_all
from evaluation.common.programs import Failure, run_quietly
from evaluation.common.project import found_log
from evaluation.common.shares import Share, share_of
from evaluation.common.tables import percent, table


def test_a_short_row_is_filled_up() -> None:
    lines = table(("log", "map", "time"), [["a", 1, "2 s"], ["b", "no map"], ["", "mean"]]).splitlines()
    assert lines == ["| log | map | time |", "|---|---|---|", "| a | 1 | 2 s |", "| b | no map | |", "| | mean | |"]


def test_a_share_says_its_interval_to_as_many_digits_as_asked() -> None:
    assert str(Share(1, 2)) == "50.0 % (9.5-90.5)"
    assert Share(1, 2).text(0) == "50 % (9-91)"
    assert str(share_of([])) == "-"
    assert (percent(0.5), percent(float("nan"))) == ("50.0 %", "-")


@dataclass(frozen=True)
class Found:
    where: Path
    errors: tuple[float, ...]
    right: Share


def test_json_has_neither_nan_nor_infinity(tmp_path: Path) -> None:
    found = Found(Path("a/b"), (1.5, float("nan"), float("inf")), Share(1, 4))
    write_json(tmp_path / "new" / "found.json", {"found": [found], 3: None})
    content = json.loads((tmp_path / "new/found.json").read_text(encoding="utf-8"))
    right = {"count": 1, "total": 4, "value": 0.25, "interval": list(Share(1, 4).interval)}
    assert content == {"found": [{"where": "a/b", "errors": [1.5, None, None], "right": right}], "3": None}
    assert plain(Share(0, 0))["value"] is None


def test_a_file_is_replaced_as_a_whole(tmp_path: Path) -> None:
    write_whole(tmp_path / "a.txt", "before")
    write_whole(tmp_path / "a.txt", "after")
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]
    assert (tmp_path / "a.txt").read_text(encoding="utf-8") == "after"


def difference(minuend: int, subtrahend: int) -> int:
    if minuend < subtrahend:
        raise ValueError(f"{minuend} is less than {subtrahend}")
    time.sleep(0.01 * (5 - minuend))  # the first to begin is the last to end
    return minuend - subtrahend


def test_results_come_in_the_order_of_the_calls() -> None:
    assert run_all(difference, [(k, 1) for k in range(1, 5)], 3) == [0, 1, 2, 3]
    with pytest.raises(ValueError, match="0 is less than 1"):
        run_all(difference, [(1, 0), (0, 1)], 2)


def test_a_program_that_fails_says_why_with_its_last_line() -> None:
    assert run_quietly(["/bin/sh", "-c", "echo said; exit 4"]) == "said\n"
    for words, said in (
        (["/bin/sh", "-c", "echo one >&2; echo two >&2; exit 3"], "exit code 3: two"),
        (["/bin/false"], "exit code 1: no message"),
        (["/no/program"], "could not be started"),
        (["/bin/sleep", "9"], "no end after 0.1 s"),
    ):
        with pytest.raises(Failure, match=said):
            run_quietly(words, timeout_s=0.1)
    with pytest.raises(Failure, match="exit code 4"):
        run_quietly(["/bin/sh", "-c", "exit 4"], done=(0,))


def test_a_log_is_looked_for_below_the_folder_of_data_sets(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SHAPEMAP_DATASETS", raising=False)
    assert found_log(Path("a/no.log")) == Path("a/no.log")
    monkeypatch.setenv("SHAPEMAP_DATASETS", str(tmp_path))
    assert found_log(Path("a/no.log")) == tmp_path / "a/no.log"
    assert found_log(tmp_path) == tmp_path
