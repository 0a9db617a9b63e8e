# SPDX-License-Identifier: GPL-3.0-or-later
"""The other methods: what they write, what they are given, and what is refused."""
import itertools
import math
import os
import signal
import subprocess
import time

import mapping_checks
import patience
import pytest
import synthetic_log

METHODS = ["mrpt-icp", "mrpt-rbpf", "vasco"]
QUICK = ["--particles", 6, "--samples", 60, "--rbpf-longest-beam-m", 12]
OUT = ["--trajectory", "b.tum", "--map", "b.png"]


def poses(path):
    return [(float(v[0]), float(v[1]), float(v[2]), 2 * math.atan2(float(v[6]), float(v[7])))
            for v in map(str.split, path.read_text().splitlines())]


def errors(found, truth):
    """Metres and degrees of each consecutive motion."""
    return mapping_checks.pair_errors(dict(enumerate(truth)), {i: p[1:] for i, p in enumerate(found)})


@pytest.fixture
def our_outputs(run, room_log):
    result = run("room.log", "--out", "ours.png", "--trajectory", "ours.tum", "--motions", "ours.motions")
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize("method", METHODS)
def test_a_method_runs_without_odometry(run_baselines, room_log, tmp_path, files_of, method):
    result = run_baselines(method, "room.log", *OUT, *QUICK)
    assert result.returncode == 0, result.stderr
    assert result.stdout == ""
    assert f"{method} placed 12 of 12 positions" in result.stderr
    assert files_of() == ["b.png", "b.tum", "b.yaml", "room.log"]
    found = poses(tmp_path / "b.tum")
    assert [p[0] for p in found] == [1.0 + i for i in range(12)]
    assert found[0][1:] == (0, 0, 0)
    assert found[-1][1:] != (0, 0, 0), "it moves although the odometry does not"


def test_vasco_finds_the_room_by_itself(run_baselines, room_log, tmp_path):
    assert run_baselines("vasco", "room.log", *OUT[:2], "--map", "b.pgm").returncode == 0
    found = poses(tmp_path / "b.tum")
    assert mapping_checks.num_within(errors(found, synthetic_log.path(12)), 0.05, 1.5) == 11
    mapping_checks.check_map(tmp_path / "b.pgm", {p[0]: p[1:] for p in found})


@pytest.mark.parametrize("method", METHODS)
def test_our_poses_are_its_odometry(run_baselines, our_outputs, tmp_path, method):
    result = run_baselines(method, "room.log", *OUT, *QUICK, "--poses", "ours.tum")
    assert result.returncode == 0, result.stderr
    assert mapping_checks.num_within(errors(poses(tmp_path / "b.tum"), synthetic_log.path(12)), 0.2, 5) == 11


def test_motions_are_read_with_their_covariances(run_baselines, our_outputs, tmp_path):
    rows = [line.split() for line in (tmp_path / "ours.motions").read_text().splitlines()]
    assert rows[0] == "# timestamp_s x_m y_m theta_rad xx xy xt yy yt tt".split()
    assert [float(row[0]) for row in rows[1:]] == [1.0 + i for i in range(12)]
    assert rows[1][1:] == ["0"] * 9
    ours = poses(tmp_path / "ours.tum")
    for (a, b), row in zip(itertools.pairwise(ours), rows[2:], strict=True):
        motion = [float(v) for v in row]
        assert mapping_checks.relative(a[1:], b[1:]) == pytest.approx(motion[1:4], abs=1e-6)
        assert motion[4] > 0 and motion[7] > 0 and motion[9] > 0
    # Motions without any doubt are kept to the millimetre, whether the poses are given as well or not.
    certain = [[*row[:4], *["0"] * 6] for row in rows[1:]]
    (tmp_path / "certain.motions").write_text("".join(" ".join(row) + "\n" for row in certain))
    for more in ([], ["--poses", "ours.tum"]):
        for method in ("mrpt-rbpf", "vasco"):
            arguments = [*OUT, *QUICK, "--covariances", "certain.motions", "--force", *more]
            assert run_baselines(method, "room.log", *arguments).returncode == 0
            found = poses(tmp_path / "b.tum")
            assert mapping_checks.num_within(errors(found, [p[1:] for p in ours]), 0.002, 0.1) == 11


def test_the_seed_decides_and_the_poses_in_the_log_do_not(run_baselines, tmp_path):
    (tmp_path / "a.log").write_text(synthetic_log.carmen_log(5))
    (tmp_path / "b.log").write_text(synthetic_log.carmen_log(5, fields=lambda i: [f"{3.7 * i - k}" for k in range(6)]))

    def output(log, seed):
        result = run_baselines("mrpt-rbpf", log, *QUICK, "--trajectory", "-", "--seed", seed)
        assert result.returncode == 0, result.stderr
        return result.stdout

    first = output("a.log", 3)
    assert len(first.splitlines()) == 5
    assert output("b.log", 3) == first
    assert output("a.log", 4) != first


def test_selected_positions_with_poses_of_all(run_baselines, our_outputs, tmp_path):
    result = run_baselines("vasco", "room.log", *OUT, "--every", 3, "--skip", 1, "--poses", "ours.tum")
    assert result.returncode == 0, result.stderr
    found = poses(tmp_path / "b.tum")
    assert [p[0] for p in found] == [2, 5, 8, 11]
    assert mapping_checks.num_within(errors(found, synthetic_log.path(12)[1::3]), 0.05, 1.5) == 3


def test_when_time_is_over_the_rest_is_left_out(run_baselines, tmp_path):
    (tmp_path / "long.log").write_text(synthetic_log.carmen_log(1) * 3000)
    result = run_baselines("vasco", "long.log", *OUT, "--max-seconds", 0.5)
    assert result.returncode == 4, result.stderr
    assert "--max-seconds is over" in result.stderr
    assert 1 <= len(poses(tmp_path / "b.tum")) < 3000


def test_a_motion_beyond_all_memory_ends_the_filter(run_baselines, room_log, tmp_path):
    rows = [f"{1 + i} {0 if i < 6 else 1e6} 0 0 0 0 0 1" for i in range(12)]
    (tmp_path / "far.tum").write_text("\n".join(rows) + "\n")
    result = run_baselines("mrpt-rbpf", "room.log", *OUT[:2], *QUICK, "--poses", "far.tum")
    assert result.returncode == 4, result.stderr
    assert "6 of 12 positions are not placed: the particles' maps would need too much memory" in result.stderr
    assert len(poses(tmp_path / "b.tum")) == 6


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["guess", "room.log", *OUT], ["METHOD", "mrpt-icp, mrpt-rbpf, vasco"]),
        (["vasco", "room.log"], "--trajectory"),
        (["vasco"], "LOG"),
        ([], "METHOD"),
        (["vasco", "room.log", "--trajectory", "b.tum", "--map", "b.jpg"], ["--map", ".png"]),
        (["vasco", "room.log", "--trajectory", "b.tum", "--map", "map"], ["--map", ".png"]),
        (["vasco", "room.log", "--trajectory", "room.log"], "both input and output"),
        (["vasco", "room.log", "--trajectory", "b.png", "--map", "b.png"], "two outputs"),
        (["vasco", "room.log", *OUT, "--levels", "0"], "--levels"),
        (["vasco", "room.log", *OUT, "--particles", "x"], "--particles"),
        (["vasco", "room.log", *OUT, "--every", "0"], "--every"),
        (["vasco", "room.log", *OUT, "--skip", "12"], "--skip"),
        (["mrpt-icp", "room.log", *OUT, "--covariances", "c"], "no motion model"),
    ],
)
def test_wrong_usage_is_refused(baselines_fail, room_log, arguments, says):
    baselines_fail(2, *arguments, says=says)


@pytest.mark.parametrize("method", METHODS)
def test_bad_logs_are_refused(baselines_fail, tmp_path, method):
    (tmp_path / "empty.log").write_bytes(b"")
    (tmp_path / "junk.log").write_bytes(bytes((i * i * 7 + i * 13) % 256 for i in range(5000)))
    for name in ("missing.log", "empty.log", "junk.log"):
        baselines_fail(3, method, name, *OUT, says=name)


def test_bad_poses_and_covariances_are_refused(baselines_fail, room_log, tmp_path):
    (tmp_path / "short.tum").write_text("1 0 0 0 0 0 0 1\n2 0 0\n")
    (tmp_path / "other.tum").write_text("1 0 0 0 0 0 0 1\n1.5 0 0 0 0 0 0 1\n")
    (tmp_path / "bad.motions").write_text("1 0 0 0 1 0 0 -1 0 1\n")
    baselines_fail(3, "vasco", "room.log", *OUT, "--poses", "missing.tum", says="missing.tum")
    baselines_fail(3, "vasco", "room.log", *OUT, "--poses", "short.tum", says="short.tum:2")
    baselines_fail(3, "vasco", "room.log", *OUT, "--poses", "other.tum", says="other.tum:2")
    says = ["bad.motions:1", "covariance"]
    baselines_fail(3, "mrpt-rbpf", "room.log", *OUT, "--covariances", "bad.motions", says=says)


def test_outputs_come_together_or_not_at_all(baselines_fail, room_log, tmp_path):
    (tmp_path / "b.yaml").write_text("mine")
    baselines_fail(5, "vasco", "room.log", *OUT, says=["b.yaml", "--force"])
    baselines_fail(5, "vasco", "room.log", "--trajectory", "nowhere/b.tum", says="nowhere")
    (tmp_path / "far.tum").write_text("".join(f"{1 + i} {1e5 * i} 0 0 0 0 0 1\n" for i in range(12)))
    far = ["--poses", "far.tum", "--trajectory", "b.tum", "--map", "c.png"]
    baselines_fail(5, "vasco", "room.log", *far, says="cells")
    assert (tmp_path / "b.yaml").read_text() == "mine"


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("which", [signal.SIGINT, signal.SIGTERM])
def test_interrupt(baselines_path, tmp_path, room_text, files_of, method, which):
    (tmp_path / "long.log").write_text(room_text * 400)
    arguments = [baselines_path, method, "long.log", "--trajectory", "b.tum", "--map", "b.png"]
    main, terminal = os.openpty()
    process = subprocess.Popen(arguments, cwd=tmp_path, stderr=terminal)
    os.close(terminal)
    seen = b""
    while b"/4800" not in seen:
        seen += os.read(main, 4096)
    begin = time.monotonic()
    process.send_signal(which)
    assert patience.wait(process) == 130
    assert patience.is_soon(time.monotonic() - begin, 5.0)
    while b"nothing written" not in seen:
        seen += os.read(main, 4096)
    os.close(main)
    assert b"shapemap-baselines: interrupted; nothing written" in seen
    assert files_of() == ["long.log"]


def test_help_names_all_methods(run_baselines):
    result = run_baselines("--help")
    assert result.returncode == 0
    for word in (*METHODS, "--poses", "--covariances", "--max-seconds", "--seed", "--every"):
        assert word in result.stdout


def test_ours_refuses_motions_by_the_papers_method(fails, room_log):
    fails(2, "room.log", "--method", "paper", "--out", "m.png", "--motions", "m.motions", says="--motions")
