# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion of foreign logs, from made-up ones of each kind."""

from __future__ import annotations

import gzip
import os
import threading
from pathlib import Path

import numpy as np
import pytest

import convert_logs
from evaluation.simulation.read import ScanLog, read_scan_log


def converted(source: Path, tmp_path: Path, *options: str) -> ScanLog:
    out = tmp_path / "out.nist"
    assert convert_logs.main([*options, str(source), str(out)]) == 0
    return read_scan_log(out)


def test_tiny_slam_log(tmp_path: Path) -> None:
    head = ["0"] * 24
    ranges = ["0", "7", "19", "20", *["1500"] * 677, "4000"]
    text = "\n".join(" ".join([str(time), *head, "", *ranges]) for time in (5_000_000, 5_100_000)) + "\n"
    source = tmp_path / "lab.dat.gz"
    source.write_bytes(gzip.compress(text.encode()))
    log = converted(source, tmp_path)
    np.testing.assert_allclose(log.timestamps_s, [0.0, 0.1])
    assert log.map_from_robot is None
    assert log.ranges.shape == (2, 1, 682)
    assert np.isnan(log.ranges[0, 0, :3]).all()  # error codes
    np.testing.assert_allclose(log.ranges[0, 0, [3, 4, 681]], [0.02, 1.5, 4.0])
    assert np.rad2deg(log.beam_angles_rad[[0, -1]]) == pytest.approx([-119.707, 119.707], abs=0.001)


def test_poses_become_references_and_a_line_cut_short_is_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = tmp_path / "vacuum.txt"
    source.write_text("1000 -2000 1.5 0 500 6003\n1100 -2000 1.4 400 500 600\n1200 -2000 1.4 40\n", encoding="utf-8")
    log = converted(source, tmp_path, "--angle-step-deg=-0.5")
    assert "left out 1 line that" in capsys.readouterr().err
    assert log.map_from_robot is not None
    np.testing.assert_allclose(log.map_from_robot, [[1.0, -2.0, 1.5], [1.1, -2.0, 1.4]], atol=1e-6)
    np.testing.assert_allclose(np.rad2deg(log.beam_angles_rad), [0.5, 0.0, -0.5])  # clockwise
    np.testing.assert_array_equal(log.ranges[:, 0], [[np.nan, 0.5, np.nan], [0.4, 0.5, 0.6]])


def test_a_log_from_a_pipe(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    writer = threading.Thread(target=pipe.write_text, args=("1000 0 0 500 600\n",))
    writer.start()
    assert converted(pipe, tmp_path, "--angle-step-deg=1").ranges.shape == (1, 1, 2)
    writer.join()


@pytest.mark.parametrize("text", ["", "FLASER 3 1 2 3\n", "1 2 3 4 5\n"])
def test_other_files_are_refused(text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "other.txt"
    source.write_text(text, encoding="utf-8")
    assert convert_logs.main([str(source), str(tmp_path / "out.nist")]) == 1
    assert "other.txt" in capsys.readouterr().err
    assert not (tmp_path / "out.nist").exists()
