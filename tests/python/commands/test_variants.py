# SPDX-License-Identifier: GPL-3.0-or-later
"""Variants of a log whose scan k stands at (k, 0), and the program around a made-up mapper."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from evaluation.commands import variants as variants_command
from evaluation.logs.variants import VariantError, parse_variant, varied
from evaluation_support import NUM_SCANS, line_log, reporter, written_log


def ranges_of(text: str) -> list[list[str]]:
    return [line.split()[2:182] for line in text.splitlines() if line.startswith("FLASER")]


def places(log: object) -> list[float]:
    return [float(x) for x in log.reference[:, 0]]  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("variant", "expected"),
    [
        ("whole", [0, 1, 2, 3, 4, 5]),
        ("reversed", [5, 4, 3, 2, 1, 0]),
        ("mirrored", [0, 1, 2, 3, 4, 5]),
        ("every-2-0", [0, 2, 4]),
        ("every-2-1", [1, 3, 5]),
        ("every-2-0+reversed", [4, 2, 0]),
        ("reversed+every-4-1", [4, 0]),
        ("drop-0-7", [0, 1, 2, 3, 4, 5]),
    ],
)
def test_scans_and_poses_are_those_of_the_variant(tmp_path: Path, variant: str, expected: list[int]) -> None:
    whole = varied(line_log(tmp_path), "whole")
    log = varied(line_log(tmp_path), variant)
    assert places(log) == expected
    lines = [line.split() for line in log.text.splitlines() if line.startswith("FLASER")]
    assert [line[-3] for line in lines] == [f"{k}.0" for k in range(1, len(expected) + 1)]
    assert all(line[182:188] == ["0"] * 6 for line in lines)
    if "mirrored" not in variant:
        assert ranges_of(log.text) == [ranges_of(whole.text)[k] for k in expected]


def test_a_mirror_changes_left_and_right(tmp_path: Path) -> None:
    log = line_log(tmp_path)
    log.reference[:, 1:] = (0.5, 0.1)  # type: ignore[index]
    mirrored = varied(log, "mirrored")
    assert np.allclose(mirrored.reference[:, 1:], (-0.5, -0.1))
    (first, *_), (original, *_) = ranges_of(mirrored.text), ranges_of(varied(log, "whole").text)
    assert first[0] == original[0]  # at -90 degrees; at 90 degrees 180 beams have none
    assert first[1:] == original[:0:-1]
    assert ranges_of(varied(log, "mirrored+mirrored").text)[0] == original


def test_dropped_scans_are_drawn_by_seed(tmp_path: Path) -> None:
    log = line_log(tmp_path)
    kept = [places(varied(log, f"drop-50-{seed}")) for seed in range(20)]
    assert kept == [places(varied(log, f"drop-50-{seed}")) for seed in range(20)]
    assert len({tuple(one) for one in kept}) > 5
    assert 0.3 < sum(map(len, kept)) / (20 * NUM_SCANS) < 0.7


@pytest.mark.parametrize("text", ["", "every-0-1", "every-2", "drop-30", "backwards", "whole+", "drop-100-1"])
def test_what_is_no_variant_is_told(text: str) -> None:
    with pytest.raises(VariantError, match="expected one of"):
        parse_variant(text)


def test_the_program_tells_of_each_variant(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = str(written_log(tmp_path))
    change = "report['loops'] = [loop(0, 2, 2.0), loop(0, 2, 2.0, 3.0)]"
    words = [log, "--cli", str(reporter(tmp_path, change)), "--jobs", "1", "--json", str(tmp_path / "out.json")]
    assert variants_command.main([*words, "--variants", "whole,every-2-0"]) == 0
    out = capsys.readouterr().out
    assert f"| line whole | {NUM_SCANS} | {NUM_SCANS} | {NUM_SCANS - 1} of {NUM_SCANS - 1} | 2 | 1 | 0.000 m |" in out
    assert "| line every-2-0 | 3 | 3 | 0 of 2 |" in out  # the mapper has a metre between scans, the log two
    assert "2 maps: 1 right, 0 in pieces, 1 wrong, 0 no map" in out
    runs = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))["runs"]
    assert [run["num_false"] for run in runs] == [1, 2]


def test_a_mapper_that_fails_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = [str(written_log(tmp_path)), "--cli", str(reporter(tmp_path, "sys.exit('out of luck')"))]
    assert variants_command.main([*words, "--variants", "whole"]) == 1
    assert "no map: exit code 1: out of luck" in capsys.readouterr().out


def test_wrong_usage(tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match="2"):
        variants_command.main([str(written_log(tmp_path)), "--variants", "sideways"])
