# SPDX-License-Identifier: GPL-3.0-or-later
"""Sweeps that motion bent: what is done about them, and what is told of it."""

import json
import math

import pytest
import synthetic_log

NUM_BEAMS = 180
PERIOD_S = 0.1
STEP_DEG = 360.0 / NUM_BEAMS


def pose_at(time_s):
    """Swinging about its heading by 35 degrees once a second, and creeping forward."""
    return 0.5 + 0.2 * time_s, 0.5, math.radians(35.0) * math.sin(2.0 * math.pi * time_s)


def bent_text(num_sweeps, sweep_s, header=""):
    """A text log of a laser whose sweeps take `sweep_s`."""
    lines = [
        "shapemap-scans 1",
        "units m deg",
        f"sensor laser beams {NUM_BEAMS} first_angle -180 angle_step {STEP_DEG:g} max_range 20{header}",
    ]
    for i in range(num_sweeps):
        ranges = []
        for k in range(NUM_BEAMS):
            x, y, heading = pose_at(i * PERIOD_S + k * sweep_s / NUM_BEAMS)
            ranges.append(synthetic_log.cast(x, y, heading + math.radians(k * STEP_DEG - 180.0)))
        lines.append(f"position {i * PERIOD_S:.3f}")
        lines.append("scan laser heading 0 ranges " + " ".join(f"{r:.3f}" for r in ranges))
    return "\n".join(lines) + "\n"


@pytest.fixture(scope="module")
def bent():
    return bent_text(56, PERIOD_S)


@pytest.fixture
def map_of(run, tmp_path):
    """The report of a run, what it said, and how far each heading is off, in degrees."""

    def run_map(text, *arguments):
        (tmp_path / "log.nist").write_text(text)
        outputs = ("--out", "map.png", "--trajectory", "map.tum", "--report", "report.json")
        result = run("log.nist", *outputs, "--force", *arguments)
        assert result.returncode in (0, 1), result.stderr
        report = json.loads((tmp_path / "report.json").read_text())
        off = []
        for line in (tmp_path / "map.tum").read_text().splitlines():
            if not line.startswith("#"):
                time_s, *_, qz, qw = map(float, line.split())
                off.append(math.degrees(abs(math.remainder(2 * math.atan2(qz, qw) - pose_at(time_s)[2], 2 * math.pi))))
        return report, result.stderr, off

    return run_map


def test_bent_sweeps_are_straightened_and_that_is_told(map_of, bent):
    report, told, off = map_of(bent)
    sweeps = report["logs"][0]["sweeps"]
    assert sweeps["straightened"]
    assert sweeps["sweep_time_s"] == pytest.approx(PERIOD_S)
    assert sweeps["num_better"] > 0.8 * sweeps["num_judged"] > 8
    assert sweeps["misfit_after_m"] < sweeps["misfit_before_m"]
    assert "sweeps of 0.1 s straightened" in told
    assert len(off) == 56
    assert max(off) < 1.0
    _, told, off = map_of(bent, "--deskew", "off")
    assert "straightened" not in told
    assert max(off) > 1.5


def test_sweeps_that_take_no_time_are_left_as_they_are(map_of, tmp_path):
    text = bent_text(56, 0.0)
    report, told, _ = map_of(text)
    assert not report["logs"][0]["sweeps"]["straightened"]
    assert "straightened" not in told
    as_it_is = (tmp_path / "map.tum").read_bytes()
    map_of(text, "--deskew", "off")
    assert (tmp_path / "map.tum").read_bytes() == as_it_is


def test_a_sweep_time_may_be_given_and_one_that_cannot_be_is_told(map_of, bent):
    report, _, off = map_of(bent, "--sweep-time", PERIOD_S)
    assert report["logs"][0]["sweeps"]["num_judged"] == 0
    assert max(off) < 1.0
    report, told, _ = map_of(bent_text(56, PERIOD_S, " time_step 1e-9"))
    assert "sweeps are 0.1 s apart" in told
    assert not report["logs"][0]["sweeps"]["told_by_log"]


def test_pairs_are_aligned_with_straight_sweeps(run, tmp_path, bent):
    (tmp_path / "log.nist").write_text(bent)
    turned = {}
    for mode in ("auto", "off"):
        result = run("align", "log.nist", "--gap", "1", "--out", "-", "--deskew", mode)
        assert result.returncode == 0, result.stderr
        off = []
        for i, line in enumerate(result.stdout.splitlines()):
            _, _, theta_rad = json.loads(line)["hypotheses"][0]["pose"]
            truth = pose_at((i + 1) * PERIOD_S)[2] - pose_at(i * PERIOD_S)[2]
            off.append(math.degrees(abs(theta_rad - truth)))
        turned[mode] = sorted(off)[len(off) // 2]
    assert turned["auto"] < 0.3 * turned["off"]


@pytest.mark.parametrize("words", [("--deskew", "perhaps"), ("--sweep-time", "soon"), ("--sweep-time", "11")])
def test_wrong_usage(run, words):
    result = run("x.nist", "--out", "map.png", *words)
    assert result.returncode == 2
    assert words[0] in result.stderr
