# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of made-up programs: what they get, what is measured, and how each kind of failure becomes a row."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from evaluation.common.programs import Failure, run_measured
from evaluation.common.project import PROJECT
from evaluation.maps.methods import Programs
from evaluation.maps.runs import execute, file_sha256, finished
from evaluation.maps.schedule import Schedule
from evaluation.maps.trajectories import as_lists, from_lists, read_trajectory
from evaluation_support import BASELINES, NUM_SCANS, job, line_log, mapper, program


@pytest.fixture
def programs(tmp_path: Path) -> Programs:
    return Programs(mapper(tmp_path), program(tmp_path / "baselines", BASELINES))


def run_all(jobs: list[Any], resume: bool = False, num_processes: int = 2) -> list[dict[str, Any]]:
    results, complete = Schedule(jobs, num_processes, resume, lambda reason: None).run()
    assert complete
    return results


def test_our_run_is_judged(tmp_path: Path, programs: Programs) -> None:
    result = execute(job(tmp_path, "robust", line_log(tmp_path), programs))
    assert (result["status"], result["num_placed"], result["coverage"]) == ("ok", NUM_SCANS, 1.0)
    assert result["pairs"]["right"] == [1, 1, 1, 1, 0]
    assert result["pairs"]["error_m"][4] == pytest.approx(1.0)
    assert result["ate"]["rmse_m"] > 0.1
    assert 0 < result["map_agreement"]["precision"] <= 1
    assert result["usage"]["peak_memory_mib"] < 60, "of the program, not of what started it"
    assert result["usage"]["cpu_s"] <= result["usage"]["wall_s"] * 2


def test_the_ceiling_starts_at_the_reference(tmp_path: Path, programs: Programs) -> None:
    result = execute(job(tmp_path, "ceiling", line_log(tmp_path), programs))
    assert result["pairs"]["right"] == [1] * 5
    assert result["usage"] is None


def test_the_ceiling_of_relations_starts_at_each_relation(tmp_path: Path, programs: Programs) -> None:
    relations = tmp_path / "line.scan_relations"
    relations.write_text("0 3 3.1 0 0\n1 2 1 0 0\n4 5 1 0 0\n", encoding="utf-8")
    log = line_log(tmp_path, "relations", relations=(relations,))
    ceiling, ours = (execute(job(tmp_path, m, log, programs)) for m in ("ceiling", "robust"))
    assert ceiling["relations"]["scan_relations"]["mean_m"] == pytest.approx(0.0, abs=1e-6)
    errors = ours["relations"]["scan_relations"]["errors"]
    assert [error[0] for error in errors] == pytest.approx([0.1, 0.0, 1.0], abs=1e-6)
    assert ours["pairs"] is None


def test_baselines_are_fed_after_those_that_feed_them(tmp_path: Path, programs: Programs) -> None:
    log = line_log(tmp_path)
    names = ["mrpt-icp+robust", "mrpt-rbpf+covariances", "mrpt-icp", "vasco", "robust"]
    results = run_all([job(tmp_path, name, log, programs) for name in names])
    assert [result["method"] for result in results] == names
    assert [sum(result["pairs"]["right"]) for result in results] == [4, 4, 0, 0, 4]
    assert [result["status"] for result in results] == ["ok", "ok", "ok", "failed", "ok"]
    assert results[3]["reason"] == "exit code 1: out of luck"
    assert (results[3]["num_placed"], results[3]["ate"], results[3]["pairs"]["right"]) == (0, None, [0] * 5)


def test_without_motions_the_covariances_fail_and_say_so(tmp_path: Path, programs: Programs) -> None:
    old = replace(programs, cli=mapper(tmp_path, motions=False))
    jobs = [job(tmp_path, name, line_log(tmp_path), old) for name in ("robust", "mrpt-rbpf+covariances")]
    ours, fed = run_all(jobs)
    assert ours["status"] == "ok"
    assert "no option --motions" in fed["reason"]


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ("import time\ntime.sleep(60)", "no end after 1 s"),
        ("import os\nos.kill(os.getpid(), 11)", "killed by SIGSEGV"),
        ("import sys\nsys.exit(3)", "exit code 3: no message"),
        ("pass", "wrote no out.tum"),
        ("import sys\nopen(sys.argv[4], 'w').write('1.0 0 0 0 0 0 0 1\\n2.0 0 0\\n')", "out.tum:2: no line of a tr"),
        ("import sys\nopen(sys.argv[4], 'w').write('1.0 nan 0 0 0 0 0 1\\n')", "out.tum:1: not finite"),
        ("import sys\nopen(sys.argv[4], 'w').write('7.0 0 0 0 0 0 0 1\\n')", "out.tum:1: 7 is not the time of one"),
        ("import sys\nopen(sys.argv[4], 'w').write('1.0 0 0 0 0 0 0 1\\n' * 2)", "out.tum:2: position 0 comes twice"),
    ],
)
def test_each_failure_is_a_row_with_its_reason(tmp_path: Path, programs: Programs, body: str, reason: str) -> None:
    failing = replace(programs, baselines=program(tmp_path / "failing", body))
    result = execute(job(tmp_path, "mrpt-icp", line_log(tmp_path), failing, timeout_s=1.0))
    assert result["status"] == "failed"
    assert reason in result["reason"]


def test_a_missing_program_is_a_row(tmp_path: Path, programs: Programs) -> None:
    gone = replace(programs, baselines=tmp_path / "gone")
    result = execute(job(tmp_path, "mrpt-icp", line_log(tmp_path), gone))
    assert "no program" in result["reason"]


def test_an_evaluation_that_dies_is_a_row(
    tmp_path: Path, programs: Programs, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    log = line_log(tmp_path)
    monkeypatch.setattr("evaluation.maps.runs.read_trajectory", lambda *_: os._exit(9))
    (result,) = run_all([job(tmp_path, "robust", log, programs)])
    assert result["reason"] == "the evaluation of this run ended with exit code 9"
    monkeypatch.setattr("evaluation.maps.runs.read_trajectory", lambda *_: [1 / 0])
    (result,) = run_all([job(tmp_path, "robust", log, programs)])
    assert "ZeroDivisionError" in result["reason"]
    assert capfd.readouterr().err.count("FAILED: robust on line") == 2


def test_a_program_that_is_late_takes_its_children_with_it(tmp_path: Path) -> None:
    mark = tmp_path / "mark"
    body = f"import subprocess, time\nsubprocess.Popen(['sh', '-c', 'sleep 2; touch {mark}'])\ntime.sleep(60)"
    started = time.monotonic()
    with pytest.raises(Failure, match="no end"):
        run_measured([program(tmp_path / "late", body)], tmp_path, 0.7)
    assert time.monotonic() - started < 5
    time.sleep(2)
    assert not mark.exists()


def test_what_is_done_is_kept_unless_anything_changed(tmp_path: Path, programs: Programs) -> None:
    log = line_log(tmp_path)
    jobs = [job(tmp_path, name, log, programs) for name in ("robust", "vasco")]
    first = run_all(jobs)
    again = run_all(jobs, resume=True)
    assert again[0]["process"] == first[0]["process"]
    assert again[1]["process"] != first[1]["process"], "what failed is done again"
    assert finished(jobs[0]) is not None
    for changed in (
        replace(jobs[0], programs=replace(programs, arguments=("--threads", "2"))),
        replace(jobs[0], log=line_log(tmp_path, every=2)),
        replace(jobs[0], timeout_s=21.0),
    ):
        assert finished(changed) is None
    jobs[0].result_path.write_text('{"key": "cut', encoding="utf-8")
    assert finished(jobs[0]) is None


def test_a_baseline_is_run_again_when_what_it_depends_on_changes(tmp_path: Path, programs: Programs) -> None:
    log = line_log(tmp_path)
    robust, fed, alone = (job(tmp_path, name, log, programs) for name in ("robust", "mrpt-icp+robust", "mrpt-icp"))
    run_all([robust])
    keys = [fed.key(), alone.key()]
    other = replace(programs, arguments=("--threads", "2"))
    assert [replace(one, programs=other).key() for one in (fed, alone)] == keys, "the poses are the same"
    assert replace(robust, programs=other).key() != robust.key()
    poses = robust.folder / "out.tum"
    file_sha256.cache_clear()  # as in another process
    poses.write_text(poses.read_text(encoding="utf-8") + "9 0 0 0 0 0 0 1\n", encoding="utf-8")
    assert fed.key() != keys[0]
    assert alone.key() == keys[1]
    assert replace(alone, programs=replace(programs, baseline_arguments=("--seed", "2"))).key() != keys[1]


def test_ctrl_c_leaves_what_is_done_and_ends_the_programs(tmp_path: Path, programs: Programs) -> None:
    alive = tmp_path / "alive"
    slow = f"import pathlib, time\nwhile True:\n    pathlib.Path('{alive}').touch()\n    time.sleep(0.05)"
    (tmp_path / "datasets.toml").write_text(
        "[[dataset]]\nname = 'line'\npath = 'line.log'\nsensor = 'SICK'\nreference = 'slam'\n", encoding="utf-8"
    )
    line_log(tmp_path)
    script = PROJECT / "scripts/evaluate.py"
    command = [sys.executable, script, "maps", "--datasets", tmp_path / "datasets.toml", "--out", tmp_path / "out"]
    command += ["--cli", programs.cli, "--baselines", program(tmp_path / "slow", slow)]
    command += ["--methods", "robust,mrpt-icp", "--jobs", "1"]
    environment = os.environ | {"SHAPEMAP_DATASETS": str(tmp_path)}
    process = subprocess.Popen(
        [str(w) for w in command],
        env=environment,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # jobs in the background ignore it
    )
    for _ in range(600):
        if alive.exists():
            break
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=300)  # it still writes the report
    assert process.returncode == 130, errors
    assert errors == "evaluate.py maps: interrupted; 1 of 2 runs are done, --resume does the rest\n"
    alive.unlink()
    time.sleep(0.3)
    assert not alive.exists()
    assert (tmp_path / "out/runs/line/robust/run.json").exists()
    assert not (tmp_path / "out/runs/line/mrpt-icp/run.json").exists()
    assert "interrupted" in (tmp_path / "out/report.md").read_text(encoding="utf-8")


def test_fragments_are_ordered_by_size_and_survive_json(tmp_path: Path) -> None:
    for name, times in (("a.tum", [1]), ("b.tum", [2, 3])):
        lines = [f"{time}.0 {time} 0.5 0 0 0 0 1\n" for time in times]
        (tmp_path / name).write_text("# t x y z qx qy qz qw\n" + "".join(lines), encoding="utf-8")
    fragments = read_trajectory([tmp_path / "a.tum", tmp_path / "b.tum"], 3)
    assert [sorted(fragment) for fragment in fragments] == [[1, 2], [0]]
    assert as_lists(from_lists(as_lists(fragments))) == as_lists(fragments)
