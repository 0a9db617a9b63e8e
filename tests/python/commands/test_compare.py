# SPDX-License-Identifier: GPL-3.0-or-later
"""Paired comparison: differences by hand, intervals against normal theory, tests against binomial tables, refusals."""

from __future__ import annotations

import json
from math import comb
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evaluation.commands import compare as compare_command
from evaluation.maps.comparison import as_cells, compare, paired_runs
from evaluation.maps.paired import Sample, paired_difference, sign_test
from evaluation.maps.results import SCHEMA, SCHEMA_VERSION, ResultsError, load_results


def run(log: str, method: str, right: list[int], **fields: Any) -> dict[str, Any]:
    errors = [0.02 if each else None for each in right]
    judged: dict[str, Any] = {
        **{"log": log, "group": fields.pop("group", log), "method": method, "sha256": f"data of {log}", "seed": None},
        **{"pairs": {"right": right, "error_m": errors}, "relations": {}, "status": "ok", "coverage": 1.0},
        **dict.fromkeys(("ate", "rpe", "rpe_10m", "map_agreement", "usage")),
    }
    return judged | fields


def results(*runs: dict[str, Any]) -> dict[str, Any]:
    return {
        **{"schema": SCHEMA, "schema_version": SCHEMA_VERSION, "limits": {"right_m": 0.2}, "commit": "c0ffee"},
        **{"commit_has_changes": False, "methods": sorted({r["method"] for r in runs}), "runs": list(runs)},
    }


def rows_of(a: dict[str, Any], b: dict[str, Any], score: str) -> dict[str, Any]:
    rows = compare(paired_runs(a, b, a["methods"][0], b["methods"][0]))
    return {row.where: row for row in rows if row.score == score}


def test_the_sign_test_is_exact() -> None:
    tail = sum(comb(12, k) for k in range(3)) / 2**12
    assert sign_test(10, 2) == pytest.approx(2 * tail)
    assert sign_test(2, 10) == sign_test(10, 2)
    assert sign_test(0, 4) == pytest.approx(0.125)
    assert sign_test(3, 3) == 1.0
    assert sign_test(0, 0) == 1.0


def test_the_interval_is_about_that_of_normal_theory_and_always_the_same() -> None:
    rng = np.random.default_rng(5)
    a = rng.normal(0.0, 1.0, 400)
    b = a + rng.normal(0.5, 0.2, 400)  # paired: most of the spread is common
    samples = [Sample(x, y, 1) for x, y in zip(a, b)]
    found = paired_difference([samples])
    assert found.value == pytest.approx(float(np.mean(b - a)))
    half = 1.96 * float(np.std(b - a)) / 20
    assert found.interval == pytest.approx((found.value - half, found.value + half), abs=0.15 * half)
    assert paired_difference([samples]) == found


def test_logs_are_drawn_as_a_whole() -> None:
    """Ten logs that are all right or all wrong are ten draws, not a hundred."""
    logs = [Sample(10.0 * (k % 2), 5.0, 10) for k in range(10)]
    pairs = [Sample(float(k % 2), 0.5, 1) for k in range(100)]
    widths = []
    for samples in (logs, pairs):
        interval = paired_difference([samples]).interval
        assert interval is not None
        widths.append(interval[1] - interval[0])
    assert widths[0] == pytest.approx(np.sqrt(10) * widths[1], rel=0.15)


def test_each_data_set_has_the_same_weight() -> None:
    small, large = [Sample(0.0, 1.0, 1)] * 4, [Sample(0.0, 0.0, 1)] * 400
    assert paired_difference([small, large]).value == 0.5
    with pytest.raises(ValueError, match="nothing"):
        paired_difference([small, []])


def test_one_draw_gives_no_interval() -> None:
    assert paired_difference([[Sample(1.0, 2.0, 1)]]).interval is None


def test_right_pairs_of_one_log_by_hand() -> None:
    a = results(run("x", "paper", [1, 1, 0, 0, 1, 0, 0, 0]))
    b = results(run("x", "robust", [1, 0, 1, 1, 1, 1, 1, 1]))
    row = rows_of(a, b, "right pairs")["x"]
    assert (row.num, row.num_a, row.num_b) == (8, 1, 5)
    assert row.difference.value == pytest.approx(4 / 8)
    assert row.p == pytest.approx(2 * (1 + 6) / 2**6)
    assert row.difference.interval is not None
    assert row.difference.interval[0] < 0.5 < row.difference.interval[1]
    assert as_cells(row)[3:6] == ["37.5 %", "87.5 %", "+50.0 %"]


def test_seeds_are_one_data_set_and_all_is_the_mean_of_the_data_sets() -> None:
    seeds_a = [run(f"arena-{k}", "paper", [0, 0], group="arena") for k in range(4)]
    seeds_b = [run(f"arena-{k}", "robust", [1, k % 2], group="arena") for k in range(4)]
    a = results(*seeds_a, run("x", "paper", [1, 1]))
    b = results(*seeds_b, run("x", "robust", [1, 1]))
    rows = rows_of(a, b, "right pairs")
    assert rows["arena"].difference.value == pytest.approx(0.75)
    assert rows["arena"].what == "pairs of 4 logs"
    assert rows["all, mean of the data sets"].difference.value == pytest.approx(0.375)


def test_precision_is_over_the_pairs_that_both_get_right() -> None:
    a, b = run("x", "paper", [1, 1, 0]), run("x", "robust", [1, 1, 1])
    b["pairs"]["error_m"] = [0.01, 0.02, 0.19]
    row = rows_of(results(a), results(b), "error of pairs")["x"]
    assert (row.num, row.num_left_out) == (2, 1)
    assert row.difference.value == pytest.approx(-0.005)
    assert (row.num_a, row.num_b) == (0, 1)


def test_relations_are_paired_and_missed_ones_left_out() -> None:
    kind = "scan_relations"
    a = run("x", "paper", [], relations={kind: {"errors": [[0.1, 1.0], [0.3, 2.0], None, [0.5, 1.0]]}}, pairs=None)
    b = run("x", "robust", [], relations={kind: {"errors": [[0.2, 1.0], [0.1, 1.0], [9.0, 9.0], None]}}, pairs=None)
    rows = [row for row in compare([(a, b)]) if row.score == "relations"]
    assert [row.unit for row in rows] == ["m", "deg"]
    assert rows[0].difference.value == pytest.approx(-0.05)
    assert (rows[0].num, rows[0].num_left_out, rows[0].num_a, rows[0].num_b) == (2, 2, 1, 1)
    assert rows[1].difference.value == pytest.approx(-0.5)


def test_what_a_log_has_one_number_of_is_compared_over_logs() -> None:
    def runs(method: str, values: list[float | None]) -> list[dict[str, Any]]:
        return [
            run(f"l{k}", method, [1], group="g", ate=None if v is None else {"rmse_m": v}) for k, v in enumerate(values)
        ]

    row = rows_of(
        results(*runs("a", [1.0, 2.0, 3.0, 4.0, None])), results(*runs("b", [0.5, 1.5, 3.5, 3.0, 1.0])), "ATE"
    )["g"]
    assert row.difference.value == pytest.approx((-0.5 - 0.5 + 0.5 - 1.0) / 4)
    assert (row.num, row.num_left_out, row.num_a, row.num_b) == (4, 1, 1, 3)
    few = rows_of(results(*runs("a", [1.0, 2.0])), results(*runs("b", [0.5, 1.5])), "ATE")
    assert few == {}, "no interval, no row"


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"sha256": "other"}, "x: not the same data"),
        ({"seed": 2}, "x: seed 1 and 2"),
        ({"log": "y"}, "only one of the two has x, y; see --common"),
        ({"method": "other"}, "no run of robust"),
    ],
)
def test_runs_on_different_data_are_refused(change: dict[str, Any], what: str) -> None:
    a = run("x", "robust", [1], seed=1)
    b = {**a, **change}
    with pytest.raises(ResultsError, match=what):
        paired_runs(results(a), results(b), "robust", "robust")


def test_other_limits_are_refused_and_common_logs_can_be_asked_for() -> None:
    a = results(run("x", "robust", [1]), run("y", "robust", [1]))
    b = results(run("x", "robust", [1]), run("z", "robust", [1]))
    assert [(one["log"], two["log"]) for one, two in paired_runs(a, b, "robust", "robust", True)] == [("x", "x")]
    with pytest.raises(ResultsError, match="other limits"):
        paired_runs(a, b | {"limits": {"right_m": 0.3}}, "robust", "robust", True)
    with pytest.raises(ResultsError, match="no log in common"):
        paired_runs(results(run("x", "robust", [1])), results(run("z", "robust", [1])), "robust", "robust", True)


def save(path: Path, content: Any) -> str:
    path.write_text(json.dumps(content), encoding="utf-8")
    return str(path)


def test_the_script_prints_a_table_and_writes_rows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    a = save(tmp_path / "a.json", results(run("x", "robust", [0, 0, 1]), run("y", "robust", [1])))
    b = save(tmp_path / "b.json", results(run("x", "robust", [1, 0, 1])))
    out = tmp_path / "rows.json"
    assert compare_command.main([a, b, "--common", "--json", str(out)]) == 0
    shown = capsys.readouterr().out
    assert "| right pairs | x | 3 pairs | 33.3 % | 66.7 % | +33.3 % |" in shown
    assert "Left out, only one of the two has them: y" in shown
    assert "McNemar" in shown
    (row, *_) = json.loads(out.read_text(encoding="utf-8"))["rows"]
    assert row["value"] == pytest.approx(1 / 3)


def test_two_methods_of_one_evaluation(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    a = save(tmp_path / "a.json", results(run("x", "paper", [0, 1]), run("x", "robust", [1, 1])))
    assert compare_command.main([a, a, "--methods", "paper,robust"]) == 0
    assert "A: paper" in capsys.readouterr().out
    for words in ([a, a], [a, a, "--methods", "robust"], [a, a, "--methods", "a,b,c"], [a, "b", "--methods", ","]):
        with pytest.raises(SystemExit):
            compare_command.main(words)


@pytest.mark.parametrize(
    ("content", "what"), [([], "no results"), ({"schema": "x"}, "no results"), ({"schema": SCHEMA}, "schema version")]
)
def test_other_files_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str], content: Any, what: str) -> None:
    path = save(tmp_path / "a.json", content)
    with pytest.raises(ResultsError, match=what):
        load_results(Path(path))
    good = save(tmp_path / "b.json", results(run("x", "robust", [1])))
    assert compare_command.main([path, good]) == 3
    (tmp_path / "a.json").write_text("{", encoding="utf-8")
    assert compare_command.main([path, good]) == 3
    assert compare_command.main([str(tmp_path / "gone.json"), good]) == 3
    assert capsys.readouterr().err.count("evaluate.py compare: ") == 3
