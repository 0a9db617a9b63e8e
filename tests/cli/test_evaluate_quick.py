# SPDX-License-Identifier: GPL-3.0-or-later
"""`evaluate.py maps --quick` with the real programs. How long a run takes is no matter here: sanitizers are slow."""

import json
import pathlib
import subprocess
import sys

import pytest

pytest.importorskip("evo", reason="evo is not installed: the evaluation needs scripts/requirements.txt")

LIMIT_S = 600


def quick(repository, cli_path, folder, *words):
    baselines = pathlib.Path(cli_path).with_name("shapemap-baselines")
    command = [sys.executable, repository / "scripts/evaluate.py", "maps", "--quick", "--out", folder, "--jobs", "1"]
    command += ["--timeout-s", "200"]
    command += ["--cli", cli_path, "--baselines", baselines, *words]
    return subprocess.run([str(w) for w in command], capture_output=True, text=True, timeout=LIMIT_S)


def test_our_methods_on_the_demo_log(repository, cli_path, tmp_path):
    result = quick(repository, cli_path, tmp_path, "--methods", "robust,paper,ceiling")
    assert result.returncode == 0, result.stderr
    assert result.stderr == "", "silent in a pipe"
    runs = {run["method"]: run for run in json.loads((tmp_path / "results.json").read_text())["runs"]}
    for method in ("robust", "paper", "ceiling"):
        assert sum(runs[method]["pairs"]["right"]) == 15, method
        assert runs[method]["ate"]["rmse_m"] < 0.10, method
        assert runs[method]["map_agreement"]["precision"] > 0.95, method
    assert (tmp_path / "report.html").stat().st_size > 50_000


def test_baselines_with_our_poses(repository, cli_path, tmp_path):
    if not pathlib.Path(cli_path).with_name("shapemap-baselines").exists():
        pytest.skip("shapemap-baselines is not built")
    result = quick(repository, cli_path, tmp_path, "--methods", "mrpt-icp,mrpt-icp+robust")
    assert result.returncode == 0, result.stderr
    runs = json.loads((tmp_path / "results.json").read_text())["runs"]
    assert [run["num_placed"] for run in runs] == [16, 16, 16]
