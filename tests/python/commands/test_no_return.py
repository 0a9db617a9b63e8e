# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulated logs with and without levels of no return: that they are what they say, and what shapemap-cli says of them,
where it is built (build/release/bin, or the program that SHAPEMAP_CLI names)."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from evaluation.commands.no_return import (
    CODED,
    KINDS,
    Outcome,
    judged,
    moved_lines,
    num_runs,
    run_simulated,
    table,
    told_levels,
)
from evaluation.common.project import BIN
from evaluation.simulation.no_return_lasers import Laser, SensorLog
from evaluation.simulation.no_return_logs import simulate_no_return_log

CLI = Path(os.environ.get("SHAPEMAP_CLI", BIN / "shapemap-cli"))


@pytest.mark.parametrize("kind", KINDS)
def test_readings_on_levels_are_noted(kind: str) -> None:
    for sensor in simulate_no_return_log(kind, 1).sensors:
        assert len(sensor.codes) == len(sensor.on_code)
        assert bool(sensor.codes) == (kind in CODED)
        for (low, high), on_code in zip(sensor.codes, sensor.on_code):
            assert on_code.any()
            on_level = sensor.ranges[on_code]
            assert ((on_level >= low) & (on_level <= high)).all()


def test_a_log_is_the_same_each_time() -> None:
    first, second = (simulate_no_return_log("inner", 4).sensors[0].ranges for _ in range(2))
    np.testing.assert_array_equal(first, second)


def test_what_info_says_is_read() -> None:
    text = (
        "sensor      a\n  no returns  51.000 to 51.200 m: 37 000 readings, taken as no return\nsensor      b\n"
        "  no returns  0.001 m: 12 readings, taken as no return\n"
    )
    assert told_levels(text) == {"a": [(51.0, 51.2)], "b": [(0.001, 0.001)]}


def test_levels_are_judged_by_their_readings() -> None:
    ranges = np.full((80, 4), 3.0)
    ranges[:, 1] = 9.0
    sensor = SensorLog("laser", Laser(4, 90.0, 0.01, 0.01, 8.0), ranges, [(9.0, 9.0)], [ranges == 9.0])
    assert num_runs(ranges == 9.0) == 80
    assert judged("limit", 0, sensor, [(9.0, 9.0)]) == Outcome("limit", 0, 1, 1)
    assert judged("limit", 0, sensor, []) == Outcome("limit", 0, 1, 0)
    assert judged("limit", 0, sensor, [(2.9, 9.0)]) == Outcome("limit", 0, 1, 1, 0, True)
    assert "| limit | 2 | 2 | 50.0 %" in table([Outcome("limit", 0, 1, 1), Outcome("limit", 1, 1, 0)])


def test_levels_of_real_logs_are_moved(tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    path.write_text("PARAM x 1\nFLASER 3 1.5 81.83 81.83 0 0 0 0 0 0 1 h 1\n")
    assert list(moved_lines(path, (81.83, 81.83), (51.0, 51.05))) == [
        "PARAM x 1\n",
        "FLASER 3 1.5 51.000 51.050 0 0 0 0 0 0 1 h 1\n",
    ]


@pytest.mark.skipif(not os.access(CLI, os.X_OK), reason=f"{CLI} is not built")
@pytest.mark.parametrize("kind", KINDS)
def test_levels_are_found_and_surfaces_are_none(kind: str) -> None:
    for outcome in run_simulated(kind, 2, CLI):
        assert not outcome.fault
        assert not outcome.false_alarm
        assert outcome.found == outcome.levels
