# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's figures of the demo arena, with shapemap-cli, where it is built (build/release/bin, or the program that
SHAPEMAP_CLI names)."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import numpy as np
import pytest

from evaluation.commands import paper_figures as paper_figures_command
from evaluation.common.project import BIN, PROJECT
from evaluation.logs.reference_log import strip_nist
from paper_trace import small_trace, write_trace

CLI = Path(os.environ.get("SHAPEMAP_CLI", BIN / "shapemap-cli"))
ARENA = PROJECT / "datasets/nist_arena.nist"
NAMES = ["1a", "1b", "2", "3a", "3b", "4a", "4b", "4c", "5a", "5b", "5c", "5d", "6a", "6b"]
STARTS = {"svg": b"<?xml", "pdf": b"%PDF", "png": b"\x89PNG"}

needs_cli = pytest.mark.skipif(not CLI.is_file(), reason=f"{CLI} is not built")


@pytest.fixture(scope="module")
def arena(tmp_path_factory):
    """The folder of the arena's figures, with the reference poses in place of a baseline."""
    if not CLI.is_file():
        pytest.skip(f"{CLI} is not built")
    out = tmp_path_factory.mktemp("figures")
    arguments = ["--cli", str(CLI), "--out", str(out), "--baseline-trajectory", str(ARENA.with_suffix(".tum"))]
    assert paper_figures_command.main(arguments) == 0
    return out / "nist_arena"


def records(path):
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def test_every_figure_is_there_in_every_format(arena):
    told = json.loads((arena / "figures.json").read_text())
    assert list(told["figures"]) == NAMES
    assert told["left_out"] == {}
    for name in NAMES:
        for ending, start in STARTS.items():
            assert (arena / f"figure_{name}.{ending}").read_bytes().startswith(start)


def test_numbers_of_correspondences_are_those_of_the_trace(arena):
    told = json.loads((arena / "figures.json").read_text())["figures"]
    for name, trace in (("3a", "trace_pairwise.jsonl"), ("3b", "trace.jsonl"), ("4a", "trace_pairwise.jsonl")):
        facts = told[name]
        (record,) = [r for r in records(arena / trace) if r["record"] == "alignment" and r["query"] == facts["query"]]
        counts = facts["num_correspondences"]
        assert counts["lcs"] == len(record["lcs"]) > 0
        assert counts["segments"] == sum(map(len, record["segments"]))
        assert counts["lcs"] == record["rotations"][record["best_rotation"]]["num_lcs"]
        assert facts["targets"] == [target["position"] for target in record["targets"]]
    assert len(told["3a"]["targets"]) == 1
    assert len(told["3b"]["targets"]) == 3
    assert told["4b"]["num_right"]["segments"] / told["4b"]["num_correspondences"]["segments"] > 0.9


def test_errors_are_the_distances_of_the_two_trajectories(arena):
    told = json.loads((arena / "figures.json").read_text())["figures"]["6b"]
    found = [complex(*r["fragment_from_robot"][:2]) for r in records(arena / "trace.jsonl") if r["record"] == "result"]
    truth = np.loadtxt(ARENA.with_suffix(".tum"))
    turn = complex(truth[0, 7], -truth[0, 6]) ** 2  # of the first pose, backwards
    places = [turn * (complex(x, y) - complex(*truth[0, 1:3])) for x, y in truth[:, 1:3]]
    errors_cm = [100 * abs(a - b) for a, b in zip(found, places)]
    assert list(told["errors_cm"].values()) == pytest.approx(errors_cm, abs=1e-6)
    assert told["worst_cm"] == pytest.approx(max(errors_cm), abs=1e-6)


def test_poses_before_icp_can_be_given_to_a_baseline(arena):
    poses = np.loadtxt(arena / "before_icp.tum")
    truth = np.loadtxt(ARENA.with_suffix(".tum"))
    assert poses[:, 0] == pytest.approx(truth[:, 0])
    assert 0.0 < np.hypot(*(poses[1, 1:3])) < 2.0


@needs_cli
def test_a_log_without_reference_poses_leaves_out_what_needs_them(tmp_path, capsys):
    log = tmp_path / "bare.nist"
    log.write_text(strip_nist(ARENA.read_text(encoding="utf-8")), encoding="utf-8")
    arguments = [str(log), "--cli", str(CLI), "--out", str(tmp_path / "out"), "--arg=--first", "--arg=4"]
    assert paper_figures_command.main(arguments) == 0
    said = capsys.readouterr().out
    assert "left out 5d 6a 6b: no reference poses" in said
    assert "without reference poses no error can be told" in said
    assert "left out 5b: no --baseline-trajectory" in said
    told = json.loads((tmp_path / "out/bare/figures.json").read_text())
    assert set(told["left_out"]) == {"5b", "5d", "6a", "6b"}
    assert not (tmp_path / "out/bare/figure_6b.png").exists()
    assert (tmp_path / "out/bare/figure_4b.png").exists()


def test_figures_of_a_trace_need_no_mapper(tmp_path):
    trace = write_trace(tmp_path / "hand.jsonl", small_trace())
    assert paper_figures_command.main([str(trace), "--out", str(tmp_path), "--cli", str(tmp_path / "none")]) == 0
    assert (tmp_path / "hand/figure_5c.svg").is_file()


def test_bad_input_is_told_in_one_line(tmp_path, capsys):
    trace = write_trace(tmp_path / "hand.jsonl", small_trace())
    (tmp_path / "bad.tum").write_text("100 1 2 3\n")
    words = [str(trace), "--out", str(tmp_path), "--reference", str(tmp_path / "bad.tum")]
    assert paper_figures_command.main(words) == 2
    assert "bad.tum:1: expected 8 numbers" in capsys.readouterr().err
    mapper = tmp_path / "mapper"
    mapper.write_text(f"#!{sys.executable}\nimport sys\nsys.exit('no map today')\n")
    mapper.chmod(0o755)
    assert paper_figures_command.main([str(tmp_path / "no.log"), "--cli", str(mapper), "--out", str(tmp_path)]) == 2
    assert "no.log: no such file" in capsys.readouterr().err
    assert paper_figures_command.main([str(ARENA), "--cli", str(mapper), "--out", str(tmp_path)]) == 1
    assert "no map today" in capsys.readouterr().err
