# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of the robust method, from runs of a made-up program."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from evaluation.commands import method_figures
from evaluation.figures import method_maps, method_runs, method_scans

# Four scans of a room of 4 x 3 m, whatever log it is given; the robot goes ahead by 0.5 m and turns by 0.1 rad.
FAKE_CLI = """#!/usr/bin/env python3
import json, math, sys
option = lambda name: sys.argv[sys.argv.index(name) + 1]
walls = [(-2 + 0.1 * k, y, t) for k in range(40) for y, t in ((-1.5, math.pi), (1.5, 0.0))]
walls += [(x, -1.5 + 0.1 * k, t) for k in range(30) for x, t in ((-2, -math.pi / 2), (2, math.pi / 2))]
poses = [(0.5 * i - 0.75, 0.0, 0.1 * i) for i in range(4)]
def seen(pose):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return [(c * (x - pose[0]) + s * (y - pose[1]), c * (y - pose[1]) - s * (x - pose[0]), t - pose[2])
            for x, y, t in walls]
step = [0.5 * math.cos(0.1), -0.5 * math.sin(0.1), 0.1]
covariance = [[0.01, 0, 0], [0, 0.0004, 0], [0, 0, 0.0001]]
def candidate(k):
    return {"pose": [step[0] + k, step[1], step[2] + k], "score": 5.0 - 4 * k, "agree": 0.8 - 0.3 * k, "crossed": 0.02,
            "for_it": 3.0 - k, "against_it": 0.5 + k, "vouched": 0.0}
candidates = [candidate(k) for k in range(3)]
records = [{"record": "run", "format": "shapemap-trace", "format_version": 1, "histogram_scale": 252,
            "log": sys.argv[1], "options": {"method": "robust"}}]
for i, pose in enumerate(poses):
    points = seen(pose)
    records.append({"record": "position", "index": i, "index_in_whole_log": i, "timestamp_s": i,
        "points": [[x, y, t % (2 * math.pi), 0] for x, y, t in points],
        "sub_scans": [{"scan_points": [p[:2] for p in points], "segments": [[-2, -1, 2, -1]]}]})
edges = [{"reference": i - 1, "query": i} for i in range(1, 4)]
records += [{"record": "link", "num_own": 3, "hypotheses": candidates, **edge} for edge in edges]
records.append({"record": "revision", "hypotheses": candidates, "in_map": 0, "alternative": 1, "probability": 0.9,
                **edges[1]})
records += [{"record": "choice", "alternative": int(e["query"] == 2), "margin": 4.0, **e} for e in edges]
for i, pose in enumerate(poses):
    records.append({"record": "result", "index": i, "fragment": 0, "starts_fragment": i == 0,
        "fragment_from_robot": pose, "ref_from_query": step if i else None, "probability": [None, 0.99, 0.5, 0.99][i],
        "robot_from_sub_scan": [[0, 0, 0]]})
records.append({"record": "end", "num_positions": 4, "num_placed": 4, "largest_fragment": 0})
open(option("--trace"), "w").write("".join(json.dumps(r) + "\\n" for r in records))
scans = [{"index": i, "is_keyframe": i != 1, "consistency": {"contradicts_map": i == 3},
          "alignment": {"reference": i - 1, "covariance": covariance} if i else None} for i in range(4)]
open(option("--report"), "w").write(json.dumps({"positions": scans, "loops": [{"a": 0, "b": 3}]}))
open(option("--out"), "wb").write(b"P5\\n40 30\\n255\\n" + bytes(1200))
open(option("--out").replace(".pgm", ".yaml"), "w").write("resolution: 0.1\\norigin: [-2.0, -1.5, 0]\\n")
"""


@pytest.fixture
def cli(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A program that maps nothing, and logs that are quick to make."""
    monkeypatch.setattr(method_runs, "LOGS", dict.fromkeys(method_runs.LOGS, lambda: "shapemap-scans 1\n"))
    path = tmp_path / "cli"
    path.write_text(FAKE_CLI, encoding="utf-8")
    path.chmod(0o755)
    return path


def test_each_stage_gets_a_small_picture(cli: Path, tmp_path: Path) -> None:
    assert method_figures.main(["--cli", str(cli), "--out", str(tmp_path / "figures")]) == 0
    written = sorted((tmp_path / "figures").iterdir())
    assert [path.name for path in written] == sorted(f"method_{name}.png" for name in method_figures.NAMES)
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in written)
    assert all(2_000 < path.stat().st_size < 150_000 for path in written)


def test_only_the_runs_that_a_figure_needs_are_made_and_kept(cli: Path, tmp_path: Path) -> None:
    runs, out = tmp_path / "runs", tmp_path / "figures"
    assert method_figures.main(["--cli", str(cli), "--only", "grid", "--runs", str(runs), "--out", str(out)]) == 0
    kept = [f"crowd.{ending}" for ending in ("json", "jsonl", "nist", "pgm", "yaml")]
    assert sorted(path.name for path in runs.iterdir()) == kept


def test_a_log_that_cannot_be_mapped_is_said(cli: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cli.write_text("#!/bin/sh\necho 'no such log' >&2; exit 3\n", encoding="utf-8")
    assert method_figures.main(["--cli", str(cli), "--only", "shape", "--out", str(tmp_path)]) == 1
    assert "method-figures: exit code 3: no such log" in capsys.readouterr().err


def test_a_figure_that_there_is_not_is_wrong_usage(cli: Path) -> None:
    with pytest.raises(SystemExit, match="2"):
        method_figures.main(["--cli", str(cli), "--only", "portrait"])


def test_the_verified_edge_that_is_shown_is_where_others_tell_most(cli: Path, tmp_path: Path) -> None:
    trace = method_runs.Runs(cli, tmp_path / "runs")["sparse"].trace
    assert method_maps.most_telling(trace)["query"] == 2
    assert method_maps.sure_stretches(trace) == {0: 0, 1: 0, 2: 1, 3: 1}


def test_points_agree_or_are_crossed_as_seen_from_the_reference() -> None:
    wall = np.array([[2.0, y] for y in np.linspace(-1.0, 1.0, 81)])
    agree, crossed = method_scans.outcomes(wall, np.array([[2.05, 0.0], [1.0, 0.0], [3.0, 0.0], [0.0, 3.0]]))
    assert agree.tolist() == [True, False, False, False]
    assert crossed.tolist() == [False, True, False, False]


def test_tangents_run_the_same_way_when_the_query_is_turned_back() -> None:
    reference = np.zeros((30, 4))
    reference[:, 2] = np.deg2rad([10.0] * 20 + [75.0] * 10)
    query = reference + np.array([0.0, 0.0, np.deg2rad(-40.0), 0.0])
    assert int(np.argmax(method_scans.tangent_correlation(reference, query))) == 40


def test_a_map_without_origin_is_refused(tmp_path: Path) -> None:
    (tmp_path / "map.yaml").write_text("resolution: 0.05\n", encoding="utf-8")
    with pytest.raises(ValueError, match="no origin"):
        method_runs.map_origin(tmp_path / "map.yaml")
