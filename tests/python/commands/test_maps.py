# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole of scripts/evaluate.py on a made-up log with made-up programs."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from evaluation.commands import maps as maps_command
from evaluation.maps import pictures
from evaluation.maps.results import load_results
from evaluation_support import BASELINES, carmen_text, mapper, program

DATASETS = """
[[dataset]]
name = "line"
path = "line.log"
sensor = "SICK"
reference = "slam"
[[dataset]]
name = "bare"
path = "line.log"
sensor = "SICK"
reference = "none"
[[dataset]]
name = "gone"
path = "gone.log"
sensor = "SICK"
reference = "slam"
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "line.log").write_text(carmen_text(), encoding="utf-8")
    (tmp_path / "datasets.toml").write_text(DATASETS, encoding="utf-8")
    mapper(tmp_path)
    program(tmp_path / "baselines", BASELINES)
    monkeypatch.setenv("SHAPEMAP_DATASETS", str(tmp_path))
    return tmp_path


def run(folder: Path, *words: str) -> int:
    programs = ["--cli", str(folder / "mapper"), "--baselines", str(folder / "baselines")]
    where = ["--datasets", str(folder / "datasets.toml"), "--out", str(folder / "out"), "--jobs", "2"]
    return maps_command.main([*where, *programs, *words])


def report(folder: Path) -> str:
    return (folder / "out/report.md").read_text(encoding="utf-8")


def test_all_methods_on_all_that_is_there(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert run(folder) == 1, "vasco fails"
    shown = capfd.readouterr()
    assert "19 of 19 runs, 4 failed" in shown.out
    assert f"SKIPPED gone, missing: {folder / 'gone.log'}" in shown.err
    assert "bare has no reference: maps and timing only" in shown.err
    assert "run/s" not in shown.err, "no progress bar in a pipe"
    text = report(folder)
    assert "SKIPPED, missing: gone" in text
    assert "| line | vasco | exit code 1: out of luck |" in text
    assert "| line | robust | 1 | 80.0 % (37.6-96.4) [100.0 %] |" in text
    assert "| line | vasco FAILED 1 of 1 | 1 | 0.0 % (0.0-43.4) [100.0 %] | - |" in text
    assert "| bare | robust | 6 of 6 |" in text
    assert "No reference poses: maps and timing only." in text
    assert "vasco failed on all 2 logs: nothing to compare." in text
    assert "| right pairs | line | 5 pairs | 0.0 % | 80.0 % | +80.0 % |" in text, "mrpt-icp with our poses"


def test_no_baseline_is_run_where_the_data_set_wants_none(folder: Path) -> None:
    text = DATASETS.replace('path = "line.log"', 'path = "line.log"\nbaselines = false', 1)
    (folder / "datasets.toml").write_text(text, encoding="utf-8")
    run(folder, "--only", "line,bare", "--methods", "robust,ceiling,vasco,vasco+robust")
    runs = load_results(folder / "out/results.json")["runs"]
    methods = {(run["log"], run["method"]) for run in runs}
    assert methods == {
        *(("line", "robust"), ("line", "ceiling")),
        *(("bare", "robust"), ("bare", "vasco"), ("bare", "vasco+robust")),
    }


def test_the_page_needs_no_network_and_has_its_pictures(folder: Path) -> None:
    run(folder, "--methods", "robust,ceiling")
    page = (folder / "out/report.html").read_text(encoding="utf-8")
    assert page.count('src="data:image/png;base64,') == len(re.findall(r"<img ", page)) >= 4
    assert not re.search(r"https?://|<script|<link|url\(", page)
    assert "failures of robust" in page
    for path in re.findall(r"\]\((\S+\.png)\)", report(folder)):
        assert (folder / "out" / path).read_bytes().startswith(b"\x89PNG")


def test_the_results_say_what_they_are_of(folder: Path) -> None:
    run(folder, "--only", "line", "--methods", "mrpt-icp+robust", "--seed", "3", "--arg=--threads", "--arg=2")
    found = load_results(folder / "out/results.json")
    assert found["methods"] == ["robust", "mrpt-icp+robust"]
    assert found["machine"]["num_cpus"] >= 1
    assert found["options"]["arg"] == ["--threads", "2"]
    assert [r["seed"] for r in found["runs"]] == [None, 3]
    assert found["runs"][0]["sha256"] == found["logs"][0]["sha256"]
    assert len(found["programs"]["cli"]["sha256"]) == 64
    assert json.loads((folder / "out/runs/line/robust/run.json").read_text(encoding="utf-8")) == found["runs"][0]


def test_most_failures_limits_the_pictures_and_says_so(folder: Path) -> None:
    run(folder, "--only", "line", "--methods", "mrpt-icp", "--most-failures", "2")
    assert "5 of 5 pairs are wrong; the first 2 of them." in report(folder)
    assert len(list((folder / "out/pictures/line_mrpt-icp").iterdir())) == 2


def test_pictures_say_how_sure_the_program_was() -> None:
    alignment = {"status": "ambiguous", "probability": 0.714}
    assert pictures._what_it_said({"alignment": alignment}) == "; called ambiguous, probability 0.71"
    assert pictures._what_it_said({"alignment": {"status": "ok", "probability": None}}) == "; called ok"
    assert pictures._what_it_said({"alignment": None}) == ""


def test_a_snapshot_has_tables_chosen_pictures_and_the_command(folder: Path) -> None:
    snapshot = folder / "docs/results.md"
    options = ["--snapshot", str(snapshot), "--snapshot-logs", "line,absent"]
    assert run(folder, "--only", "line", "--methods", "robust,ceiling", *options) == 0
    text = snapshot.read_text(encoding="utf-8")
    assert "scripts/evaluate.py maps --datasets" in text
    assert "--snapshot-logs line,absent" in text
    assert "failures of" not in text
    assert "| data | robust | ceiling |" in text, "one column for each method"
    assert "[scores.csv](results/scores.csv)" in text
    assert len(text.splitlines()) < 60, "the long tables are files"
    scores = (folder / "docs/results/scores.csv").read_text(encoding="utf-8").splitlines()
    assert scores[0].startswith("data,method,logs,right pairs (95 %),median error,coverage,ATE,")
    assert [line.split(",")[:2] for line in scores[1:]] == [["line", "robust"], ["line", "ceiling"]]
    pictures = re.findall(r"\]\((\S+\.png)\)", text)
    assert "pictures/results_line_maps.png" not in pictures, "the made-up mapper draws none"
    assert pictures == ["pictures/results_line_trajectories.png", "pictures/results_line_errors.png"]
    assert all((snapshot.parent / path).exists() for path in pictures)
    assert "absent" in text


def test_malformed_relations_stop_it_before_anything_runs(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "line.scan_relations").write_text("0 1 1 0 0\n0 99 1 0 0\n", encoding="utf-8")
    assert run(folder) == 3
    assert f"{folder / 'line.scan_relations'}:2: expected a scan from 0 to 5, found 99" in capsys.readouterr().err
    assert not (folder / "out/runs").exists()


def test_a_missing_program_is_failed_rows(folder: Path) -> None:
    (folder / "mapper").unlink()
    (folder / "baselines").unlink()
    assert run(folder, "--only", "line") == 1
    text = report(folder)
    assert text.count("is it built?") >= 4
    assert "| line | vasco+robust | robust gave no poses to start from |" in text


def test_a_picture_that_is_none_costs_no_report(folder: Path) -> None:
    body = BASELINES.replace("num = sum", "open(option('--map'), 'w').write('no picture')\nnum = sum")
    program(folder / "baselines", body)
    assert run(folder, "--only", "line", "--methods", "mrpt-icp") == 0
    assert "line_maps.png" in report(folder)


def test_a_data_set_asked_for_by_name_must_be_there(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(folder, "--only", "line,gone", "--methods", "robust") == 1
    assert run(folder, "--only", "gone") == 1
    assert "no data set at hand" in capsys.readouterr().err
    assert run(folder, "--only", "nowhere") == 3


@pytest.mark.parametrize("words", [["--methods", "best"], ["--jobs", "0"], ["--timeout-s", "0"], ["--seeds", "x"]])
def test_wrong_usage_is_refused(folder: Path, words: list[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        run(folder, *words)
    assert caught.value.code == 2


def test_quick_is_the_demo_only_and_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    arguments: Any = maps_command.parse_arguments(["--quick"])
    assert arguments.only == ["demo"]
    fed_or_bare = [method for method in arguments.chosen if method.name != "ceiling"]
    assert arguments.timeout_s * len(fed_or_bare) <= 150, "one after the other, each to its limit"
