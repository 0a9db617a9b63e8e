# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion of tables: messages that rostopic printed, and points one a line."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from conversion_support import converted, refusal

FIELDS = "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.angle_min,field.angle_max,"
FIELDS += "field.angle_increment,field.time_increment,field.scan_time,field.range_min,field.range_max"


def printed(num_ranges: int, num_intensities: int, rows: list[list[float]], stamp_ns: int = 10**9) -> str:
    names = [f"field.ranges{k}" for k in range(num_ranges)] + [f"field.intensities{k}" for k in range(num_intensities)]
    lines = [",".join([FIELDS, *names])]
    for k, row in enumerate(rows):
        head = f"{(50 + k) * 10**9},{k},{k * stamp_ns + stamp_ns},laser,-0.5,0.5,0.5,0.0001,0.1,0.02,5.6"
        lines.append(",".join([head, *map(str, row)]))
    return "\n".join(lines) + "\n"


def test_printed_messages(tmp_path: Path) -> None:
    path = tmp_path / "scan.csv"
    path.write_text(printed(3, 3, [[1.5, math.inf, 2.0, 7, 8, 9], [1.0, math.nan, 2.5, 7, 8, 9]]), encoding="utf-8")
    log = converted(path)
    assert log.sensors == {
        "laser": "beams 3 first_angle -0.5 angle_step 0.5 last_angle 0.5 max_range 5.6 min_range 0.02 time_step 0.0001"
    }
    assert log.times == ["1.0", "2.0"]
    assert log.scans[0].words == {"heading": "0", "ranges": "1.5 inf 2.0", "intensities": "7.0 8.0 9.0"}
    assert log.scans[1].words["ranges"] == "1.0 nan 2.5"


def test_printed_messages_of_varying_length(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = [[1.0, 2.0], [1.0, 2.0, 3.0], [], [4.0]]
    path = tmp_path / "scan.csv"
    path.write_text(printed(2, 0, rows) + "50,1,2,las", encoding="utf-8")
    assert [one.ranges for one in converted(path).scans] == rows
    assert "left out 1 line that cannot be read" in capsys.readouterr().err
    path.write_text(printed(2, 2, [[1, 2, 7, 7], [1, 2, 3, 7, 7, 7], [1, 2, 7]]), encoding="utf-8")
    assert [one.ranges for one in converted(path).scans] == [[1, 2], [1, 2, 3]]
    assert "left out 1 line that cannot be read" in capsys.readouterr().err


def test_printed_messages_without_times(tmp_path: Path) -> None:
    path = tmp_path / "scan.csv"
    path.write_text(printed(1, 0, [[1.0], [2.0]], stamp_ns=0), encoding="utf-8")
    assert converted(path).times == ["50.0", "51.0"]


def points_text(head: str, is_clockwise: bool) -> str:
    lines = [head]
    for k in range(10):
        degrees = [0.5, 120.25, 240.0, 359.5][k % 4]
        lines.append(f"{100 + 0.01 * k:.4f},{degrees if is_clockwise else 360 - degrees},{1000 + k},{k}")
    return "\n".join(lines) + "\n"


def test_points_are_cut_into_sweeps(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "points.csv"
    path.write_text(points_text("time_s,angle_deg,distance_mm,quality", True) + "100.2,1.0,bad,3\n", encoding="utf-8")
    log = converted(path)
    assert log.times == ["100.0", "100.04", "100.08"]
    assert log.scans[1].ranges == [1.004, 1.005, 1.006, 1.007]
    assert log.scans[1].words["intensities"] == "4.0 5.0 6.0 7.0"
    assert [float(w) for w in log.scans[1].words["times"].split()] == pytest.approx([0.0, 0.01, 0.02, 0.03])
    angles = np.array(log.scans[0].words["angles"].split(), dtype=float)
    np.testing.assert_allclose(np.rad2deg(angles), [-0.5, -120.25, -240.0, -359.5], atol=1e-5)
    said = capsys.readouterr().err
    assert "left out 1 line that cannot be read" in said
    assert "clockwise, as RPLidars count them" in said


def test_points_in_other_units_that_turn_the_other_way(tmp_path: Path) -> None:
    path = tmp_path / "points.csv"
    rows = [f"{10 * k},{[0.1, 3.0, 6.2][k % 3]},{2 + k}" for k in range(6)]
    path.write_text("\n".join(["Time [ms],Angle (rad),Range m", *rows]) + "\n", encoding="utf-8")
    log = converted(path, "--turn", "counterclockwise")
    assert log.times == ["0.0", "0.03"]
    assert log.scans[1].ranges == [5, 6, 7]
    assert log.scans[1].words["angles"].split() == ["0.1", "3.0", "6.2"]


@pytest.mark.parametrize("separator", [",", ";", "\t", " "])
def test_points_without_times(separator: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "points.txt"
    rows = [separator.join(map(str, row)) for row in [(0, 1000), (90, "nan"), (180, 0), (10, 1500), ("nan", 9)]]
    path.write_text("\n".join([f"# angle{separator}distance", *rows]) + "\n", encoding="utf-8")
    log = converted(path)
    assert log.times == ["0.0", "1.0"]
    assert [one.words["ranges"] for one in log.scans] == ["1.0 nan 0.0", "1.5"]
    assert all("times" not in one.words for one in log.scans)
    said = capsys.readouterr().err
    assert "left out 1 line that cannot be read" in said
    assert "a sweep is taken to last a second" in said


@pytest.mark.parametrize(
    "text",
    [
        "time_s,angle_deg,distance_mm\n",
        "angle_deg,speed\n1,2\n",
        "time_s,angle_deg,distance_mm\n1,2\n",
        "%time,field.angle_min\n1,2\n",
        printed(2, 0, [[]]),
    ],
)
def test_tables_without_scans_are_refused(text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "table.csv"
    path.write_text(text, encoding="utf-8")
    refusal(path, capsys)
