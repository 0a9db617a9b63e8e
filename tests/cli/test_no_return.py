# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances that mean "no return": what the program says of them, how they are overridden, and that they last."""
import json
import math
import random

import pytest
import synthetic_log

SEEN_M = 3.5
CODES_M = [51.0, 51.05, 51.1]


def walk_log(codes_m=CODES_M, num_positions=60):
    """Lost beams get one of the codes; also how many there are."""
    rng = random.Random(1)
    lines, num_lost = [], 0
    for i in range(num_positions):
        pose = (0.5 + 1.5 * math.cos(0.7 * i), 0.5 + math.sin(0.45 * i), 0.2 * i)
        ranges = []
        for range_m in synthetic_log.scan(pose):
            lost = range_m > SEEN_M
            num_lost += lost
            ranges.append(rng.choice(codes_m) if lost else range_m + rng.gauss(0.0, 0.01))
        lines.append(synthetic_log.flaser(ranges, 1.0 + i))
    return "".join(lines), num_lost


def lines_of(result):
    assert result.returncode == 0, result.stderr
    return [" ".join(line.split()) for line in result.stdout.splitlines()]


@pytest.fixture
def log(tmp_path):
    text, num_lost = walk_log()
    (tmp_path / "walk.log").write_text(text)
    return "walk.log", num_lost


def test_info_tells_the_level(run, log):
    name, num_lost = log
    lines = lines_of(run("info", name))
    number = f"{num_lost:,}".replace(",", " ")
    assert f"no returns 51.000 to 51.100 m: {number} readings, taken as no return" in lines
    assert "max. range 51 m" in lines


def test_the_report_lists_the_level(run, log, tmp_path):
    name, num_lost = log
    result = run(name, "--first", "5", "--out", "map.png", "--report", "report.json")
    assert result.returncode in (0, 4), result.stderr
    levels = json.loads((tmp_path / "report.json").read_text())["logs"][0]["no_returns"]
    assert [level["label"] for level in levels] == ["FLASER"]
    assert levels[0]["from_m"] == pytest.approx(51.0)
    assert levels[0]["to_m"] == pytest.approx(51.1)
    assert levels[0]["num_readings"] == num_lost  # of the whole log, whatever part of it is mapped


@pytest.mark.parametrize("ending", ["log", "nist", "rawlog"])
def test_a_converted_log_has_the_same_hits(run, log, ending):
    name, _ = log
    returns = [line for line in lines_of(run("info", name)) if line.startswith(("returns", "max. range"))]
    assert run("convert", name, f"again.{ending}").returncode == 0
    again = lines_of(run("info", f"again.{ending}"))
    assert [line for line in again if line.startswith(("returns", "max. range"))] == returns


def test_the_user_says_the_levels(run, log):
    name, num_lost = log
    none = lines_of(run("info", name, "--no-return-m", "none"))
    assert not [line for line in none if line.startswith("no returns")]
    assert any(line.startswith("returns 100.0 %") for line in none)
    given = lines_of(run("info", name, "--no-return-m", "50.99-51.11"))
    assert any(line.startswith("no returns 51.000 to 51.100 m") for line in given)


def test_levels_that_make_no_sense_are_named(fails, log):
    fails(2, "info", log[0], "--no-return-m", "51.2-51.0", says=["--no-return-m", "'51.2-51.0'", "51.0-51.2"])


def test_a_header_that_surfaces_contradict_is_not_used(run, log, tmp_path):
    text = "PARAM robot_front_laser_max 1.5 host 1\n" + (tmp_path / "walk.log").read_text()
    (tmp_path / "param.log").write_text(text)
    result = run("info", "param.log")
    assert "max. range 51 m" in lines_of(result)
    assert "maximum range of 1.5 m" in result.stderr
