# SPDX-License-Identifier: GPL-3.0-or-later
"""Scans that do not go with the rest of the map are listed, and do not spoil it."""
import json

import pytest
import synthetic_log

CROWDED = 6


def crowded_log():
    """At one position people stand in front of half of the beams."""
    lines = []
    for i, pose in enumerate(synthetic_log.path(12)):
        ranges = synthetic_log.scan(pose)
        if i == CROWDED:
            ranges = [min(r, 0.6) if (b // 9) % 2 else r for b, r in enumerate(ranges)]
        lines.append(synthetic_log.flaser(ranges, 1.0 + i))
    return "".join(lines)


@pytest.fixture
def mapped(run, tmp_path):
    """Maps a log: the run, the picture and the report."""

    def map_log(text, *arguments):
        (tmp_path / "in.log").write_text(text)
        result = run("in.log", "--out", "map.pgm", "--report", "map.json", "--force", *arguments)
        assert result.returncode == 0, result.stderr
        return result, (tmp_path / "map.pgm").read_bytes(), json.loads((tmp_path / "map.json").read_text())

    return map_log


@pytest.mark.parametrize("method", ["robust", "paper"])
def test_a_scan_taken_in_a_crowd_is_found_reported_and_not_drawn_over_the_rest(mapped, method):
    result, picture, report = mapped(crowded_log(), "--method", method)
    assert report["num_placed"] == 12
    assert f"1 scan contradicts the rest of the map: positions {CROWDED}\n" in result.stderr
    assert report["num_contradicting"] == 1
    for position in report["scans"]:
        said = position["consistency"]
        assert said["contradicts_map"] == (position["index"] == CROWDED)
        assert 0 <= said["agree"] + said["through"] + said["in_free"] <= 1 + 1e-9
        assert said["in_free"] > 0.2 if position["index"] == CROWDED else said["agree"] > 0.8
    others, drawn, _ = mapped(crowded_log(), "--method", method, "--contradicting-scans", "as-others")
    assert "contradicts" in others.stderr, "it is said whether or not it is drawn"
    assert drawn != picture


def test_of_a_log_without_contradictions_nothing_is_said_and_the_map_is_the_same(mapped):
    result, picture, report = mapped(synthetic_log.carmen_log())
    assert "contradict" not in result.stderr
    assert report["num_contradicting"] == 0
    assert mapped(synthetic_log.carmen_log(), "--contradicting-scans", "as-others")[1] == picture


def test_the_limit_is_an_option(mapped):
    result, picture, report = mapped(crowded_log(), "--contradicting-share", "1")
    assert "contradict" not in result.stderr
    assert report["scans"][CROWDED]["consistency"]["in_free"] > 0.2, "the shares are there all the same"
    assert picture == mapped(crowded_log(), "--contradicting-scans", "as-others")[1]


def test_positions_are_those_of_the_whole_log(mapped):
    result, _, _ = mapped(crowded_log(), "--skip", "2")
    assert f"positions {CROWDED}\n" in result.stderr


def test_of_several_logs_it_says_which(run, tmp_path):
    (tmp_path / "plain.log").write_text(synthetic_log.carmen_log())
    (tmp_path / "crowd.log").write_text(crowded_log())
    result = run("plain.log", "crowd.log", "--out", "map.png")
    assert result.returncode == 0, result.stderr
    assert f"1 scan contradicts the rest of the map: crowd.log positions {CROWDED}\n" in result.stderr
