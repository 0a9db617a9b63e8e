# SPDX-License-Identifier: GPL-3.0-or-later
"""The short page of a snapshot and its long tables."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from evaluation.maps.sections import Section
from evaluation.maps.snapshot import side_by_side, value_alone, write_snapshot

SCORES = pd.DataFrame(
    [
        {"data": "a", "method": "robust", "right pairs (95 %)": "98.2 % (96-99) [100 %]", "ATE": "2 cm [4 cm]"},
        {"data": "a", "method": "paper", "right pairs (95 %)": "50.0 % (40-60)", "ATE": "1.20 m"},
        {"data": "b", "method": "robust", "right pairs (95 %)": "99.0 % (98-99)", "ATE": "-"},
    ]
).assign(**{"CPU per scan": "5 ms"})
COMPARED = pd.DataFrame(
    [
        ["right pairs", "a", "9 pairs", "50.0 %", "98.2 %", "+48.2 %", "+40 to +50", "0", "5", "0.06"],
        ["right pairs", "all, mean of the data sets", "9 pairs", "51.0 %", "98.6 %", "+47.6 %", "x", "0", "5", "0.05"],
        ["memory", "all, mean of the logs", "2 logs", "9 MiB", "8 MiB", "-1 MiB", "x", "1", "1", "1"],
    ],
    columns=["score", "data", "number", "A", "B", "B - A", "95 % interval of B - A", "only A", "only B", "p"],
)
KNOWN = {"question": "Is it better?", "A is": "paper", "B is": "robust"}


def test_a_cell_without_interval_and_ceiling() -> None:
    assert value_alone("98.2 % (96.4-99.1) [100.0 %]") == "98.2 %"
    assert value_alone("1.4 cm [2.0 cm]") == "1.4 cm"
    assert value_alone("0.037 ± 0.036 m") == "0.037"


def test_methods_stand_side_by_side_and_a_gap_stays_a_gap() -> None:
    assert side_by_side(SCORES, "ATE").values.tolist() == [["a", "2 cm", "1.20 m"], ["b", "-", "-"]]


def test_runs_that_failed_are_named() -> None:
    failed = SCORES.assign(method=["robust", "paper FAILED 1 of 3", "robust"])
    assert side_by_side(failed, "ATE").loc[0, "paper"] == "1.20 m (failed 1 of 3)"


def test_files_of_a_former_snapshot_go_and_what_cannot_be_compared_is_not_headed(tmp_path: Path) -> None:
    (tmp_path / "page").mkdir()
    for name in ("costs.csv", "remains.md"):
        (tmp_path / "page" / name).write_text("old", encoding="utf-8")
    alone = Section("Is it better?", [], [COMPARED[:1]], level=3, kind="comparison", known=KNOWN)
    write_snapshot(tmp_path / "page.md", [alone], [], [])
    assert sorted(path.name for path in (tmp_path / "page").iterdir()) == ["comparisons.csv", "remains.md"]
    assert "Comparisons" not in (tmp_path / "page.md").read_text(encoding="utf-8")


def test_the_page_is_short_and_the_files_have_all_of_it(tmp_path: Path) -> None:
    tabled = [
        Section("What was run", ["Made by hand."], kind="about"),
        Section("Scores by data set", ["notes"], [SCORES], kind="scores"),
        Section("Is it better?", ["A is paper."], [COMPARED], level=3, kind="comparison", known=KNOWN),
    ]
    write_snapshot(tmp_path / "page.md", tabled, [], [])
    text = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert "| a | 98.2 % | 50.0 % |" in text
    assert "| paper | robust | right pairs | 51.0 % | 98.6 % | +47.6 % | x | 0.05 |" in text
    assert "MiB" not in text
    assert sorted(path.name for path in (tmp_path / "page").iterdir()) == ["comparisons.csv", "scores.csv"]
    lines = (tmp_path / "page/comparisons.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 4
    assert lines[1].startswith("Is it better?,paper,robust,right pairs,a,9 pairs,")
