# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of many maps."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from evaluation.common.project import PROJECT
from evaluation.figures import gallery

FAKE_CLI = """#!/usr/bin/env python3
import sys
if "bad" in sys.argv[1]:
    sys.exit("no such log")
out = sys.argv[sys.argv.index("--out") + 1]
open(out, "wb").write(b"P5\\n4 2\\n255\\n" + bytes([0, 255, 127, 127, 0, 255, 127, 127]))
"""


def test_reads_what_it_writes_row_by_row(tmp_path: Path) -> None:
    path = tmp_path / "a.pgm"
    path.write_bytes(b"P5\n3 2\n255\n" + bytes([10, 13, 32, 1, 2, 3]))
    assert gallery.read_pgm(path).tolist() == [[10, 13, 32], [1, 2, 3]]


def test_refuses_another_format(tmp_path: Path) -> None:
    path = tmp_path / "a.pgm"
    path.write_bytes(b"P2\n1 1\n255\n7\n")
    with pytest.raises(ValueError, match="not a binary"):
        gallery.read_pgm(path)


def test_cuts_off_what_few_beams_reached() -> None:
    grey = np.full((100, 200), 127, dtype=np.uint8)
    grey[20:80, 20:80] = 255
    grey[50, 80:190] = 255  # one beam that left
    part = gallery.known_part(grey, share=0.93)
    assert part.shape[1] < 100
    assert (part == 255).sum() > 2800


def test_a_map_without_anything_known_stays_whole() -> None:
    assert gallery.known_part(np.full((5, 7), 128, dtype=np.uint8)).shape == (5, 7)


def test_a_log_that_fails_is_left_out_and_said(tmp_path: Path) -> None:
    cli = tmp_path / "cli"
    cli.write_text(FAKE_CLI)
    cli.chmod(0o755)
    out = tmp_path / "maps.png"
    command = [sys.executable, str(PROJECT / "scripts/evaluate.py"), "gallery", "good.log", "bad.log"]
    run = subprocess.run([*command, "--out", str(out), "--cli", str(cli)], capture_output=True, text=True, check=False)
    assert run.returncode == 1
    assert "bad.log: exit code 1: no such log" in run.stderr
    assert out.read_bytes().startswith(b"\x89PNG")
