# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports of versions whose members have other names."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evaluation.mapping.report import place_in_log, placed_poses, read_report

POSE = {"x_m": 1.0, "y_m": 2.0, "theta_deg": 90.0}
OLD = {
    "positions": [
        {"index": 0, "log": 1, "index_in_whole_log": 7, "fragment": 0, "starts_fragment": True, "map_from_robot": POSE},
        {"index": 1, "log": 1, "index_in_whole_log": 8, "fragment": -1, "map_from_robot": None},
    ],
    "fragments": [{"fragment": 0, "logs": [{"log": 1, "num_positions": 1}]}],
    "num_positions": 2,
    "options": {"fragments": "folder"},
}
NEW = {
    "scans": [
        {"index": 0, "log": 1, "index_in_whole_log": 7, "component": 0, "starts_component": True}
        | {"map_from_robot": POSE},
        {"index": 1, "log": 1, "index_in_whole_log": 8, "component": -1, "map_from_robot": None},
    ],
    "components": [{"component": 0, "logs": [{"log": 1, "num_scans": 1}]}],
    "num_scans": 2,
    "options": {"fragments": "folder"},
}


@pytest.mark.parametrize("written", [OLD, NEW])
def test_members_have_the_names_of_today(tmp_path: Path, written: dict[str, Any]) -> None:
    (tmp_path / "report.json").write_text(json.dumps(written), encoding="utf-8")
    report = read_report(tmp_path / "report.json")
    assert report == NEW
    assert place_in_log(report, 1) == (1, 8)
    assert list(placed_poses(report)) == [0]
    assert placed_poses(report)[0] == pytest.approx(np.array([1.0, 2.0, np.pi / 2]))


@pytest.mark.parametrize("text", ["", "{", "[]", "3"])
def test_what_is_no_report_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "report.json").write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=r"report\.json: no JSON object|Expecting"):
        read_report(tmp_path / "report.json")
