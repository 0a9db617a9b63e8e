# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run writes, and that it comes whole or not at all."""

import json
import math
import os
import resource
import signal
import subprocess

import pytest
import synthetic_log


def read_tum(text):
    rows = [[float(v) for v in line.split()] for line in text.splitlines() if not line.startswith("#")]
    return {row[0]: (row[1], row[2], 2 * math.atan2(row[6], row[7])) for row in rows}


def relative(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    dx, dy = b[0] - a[0], b[1] - a[1]
    return c * dx + s * dy, -s * dx + c * dy, math.remainder(b[2] - a[2], 2 * math.pi)


def carmen_poses(text):
    rows = [line.split() for line in text.splitlines() if line.startswith("FLASER")]
    return [tuple(float(v) for v in row[2 + int(row[1]) : 5 + int(row[1])]) for row in rows]


@pytest.mark.parametrize("method", ["robust", "paper"])
def test_a_run_maps_the_room_and_writes_all_that_is_asked_for(run, room_log, tmp_path, method):
    result = run(
        *["--method", method],
        *["--carmen", "room.log", "--out", "map.png", "--trajectory", "map.tum", "--report", "report.json"],
        *["--carmen-out", "out.log", "--rawlog-out", "out.rawlog.gz", "--draw-path"],
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout == ""
    num_loops = "1 loop" if method == "robust" else "0 loops"
    assert f"placed 12 of 12 positions (12 keyframes, {num_loops}, 1 fragment)" in result.stderr
    assert "map.png" in result.stderr
    poses = read_tum((tmp_path / "map.tum").read_text())
    truth = synthetic_log.path(12)
    assert list(poses) == [1.0 + i for i in range(12)]
    for i in range(1, 12):
        expected, found = relative(truth[0], truth[i]), relative(poses[1.0], poses[1.0 + i])
        assert math.hypot(expected[0] - found[0], expected[1] - found[1]) < 0.1
        assert abs(expected[2] - found[2]) < math.radians(2)
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["num_placed"] == 12
    assert len(report["scans"]) == 12
    for i, (x, y, theta) in enumerate(carmen_poses((tmp_path / "out.log").read_text())):
        pose = report["scans"][i]["map_from_robot"]
        assert abs(x - pose["x_m"]) < 1e-5
        assert abs(y - pose["y_m"]) < 1e-5
        assert abs(math.degrees(theta) - pose["theta_deg"]) < 1e-3
    assert 'image: "map.png"' in (tmp_path / "map.yaml").read_text()
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "out.rawlog.gz").read_bytes().startswith(b"\x1f\x8b")


def test_the_written_logs_map_again(run, room_log, tmp_path):
    for ending, flag in (("log", "--carmen-out"), ("rawlog", "--rawlog-out")):
        assert run("room.log", "--out", f"{ending}.png", flag, f"out.{ending}").returncode == 0
        again = run(f"out.{ending}", "--out", f"{ending}-again.png", "--trajectory", "-")
        assert again.returncode == 0, again.stderr
        assert len(read_tum(again.stdout)) == 12


@pytest.mark.parametrize(("method", "num_placed"), [("robust", 8), ("paper", 5)])
def test_unplaced_positions_are_listed_and_left_out(run, tmp_path, method, num_placed):
    """Blind positions split the paper's map, and leave a gap in the other one."""
    lines = [synthetic_log.flaser(synthetic_log.scan(pose), 1.0 + i) for i, pose in enumerate(synthetic_log.path(8))]
    lines[3:3] = [synthetic_log.flaser([81.83] * 181, 100.0 + i) for i in range(25)]
    (tmp_path / "gap.log").write_text("".join(lines))
    log = ("gap.log", "--method", method)
    result = run(*log, "--out", "map.png", "--trajectory", "-", "--report", "r.json", "--carmen-out", "out.log")
    assert result.returncode == 4, result.stderr
    listed = [line for line in result.stderr.splitlines() if "not placed" in line]
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["num_placed"] == num_placed
    assert report["num_scans"] == 33
    assert len(listed) == 20
    assert f"... and {33 - num_placed - 20} more, see --report" in result.stderr
    assert len(result.stdout.splitlines()) == num_placed
    assert (tmp_path / "out.log").read_text().count("FLASER") == num_placed
    assert all(p["reason"] for p in report["scans"][3:28])
    assert "not placed" not in run(*log, "--out", "quiet.png", "--quiet").stderr
    verbose = run(*log, "--out", "verbose.png", "--verbose").stderr
    assert verbose.count("not placed") == 33 - num_placed


def test_alignments_in_doubt_are_counted_and_listed(run, room_log, tmp_path):
    """No alignment is ever certain, so that a call for certainty leaves all of them in doubt, if no loop helps."""
    (tmp_path / "long.log").write_text(room_log.read_text() * 3)
    doubtful = ("long.log", "--sure-probability", 1, "--no-close-loops")
    result = run(*doubtful, "--out", "map.png", "--report", "r.json")
    assert result.returncode == 0, result.stderr
    assert "35 of 35 alignments are uncertain: 0 with too little overlap, 35 ambiguous, 0 degenerate" in result.stderr
    assert result.stderr.count(" ambiguous: the pose is right with a probability of ") == 20
    assert "... and 15 more, see --report" in result.stderr
    positions = json.loads((tmp_path / "r.json").read_text())["scans"]
    assert {p["alignment"]["status"] for p in positions[1:]} == {"ambiguous"}
    assert all(0 < p["alignment"]["probability"] < 1 for p in positions[1:])
    assert all(p["alignment"]["ref_from_query"] for p in positions[1:])
    verbose = run(*doubtful, "--out", "verbose.png", "--verbose").stderr
    assert verbose.count(" ambiguous: ") == 35
    assert run(*doubtful, "--out", "quiet.png", "--quiet").stderr == ""
    sure = run("room.log", "--sure-probability", 0, "--max-deviation-m", 10, "--out", "sure.png").stderr
    assert "uncertain" not in sure


def test_what_loops_hold_is_not_uncertain(run, room_log, tmp_path):
    (tmp_path / "long.log").write_text(room_log.read_text() * 3)
    result = run("long.log", "--sure-probability", 1, "--out", "map.png", "--report", "r.json")
    assert result.returncode == 0, result.stderr
    report = json.loads((tmp_path / "r.json").read_text())
    doubtful = [p for p in report["scans"][1:] if p["alignment"]["status"] != "ok"]
    held = [p for p in doubtful if p["loop_constrained"]]
    assert len(doubtful) == 35
    assert len(held) > 20, "the robot comes by twice"
    uncertain = 35 - len(held)
    assert f"{uncertain} of 35 alignments are uncertain" in result.stderr
    assert f"; {len(held)} more would be, but loops hold these positions" in result.stderr
    listed = [line for line in result.stderr.splitlines() if " ambiguous: the pose" in line]
    assert [
        f"position {p['index']} " in line
        for p, line in zip((p for p in doubtful if not p["loop_constrained"]), listed, strict=True)
    ] == [True] * uncertain


def test_the_report_tells_loops_keyframes_and_stages(run, room_log, tmp_path):
    (tmp_path / "twice.log").write_text(room_log.read_text() * 2)
    still = synthetic_log.flaser(synthetic_log.scan(synthetic_log.path(1)[0]), 0.5)
    (tmp_path / "twice.log").write_text(still + (tmp_path / "twice.log").read_text())
    result = run("twice.log", "--out", "map.png", "--report", "r.json", "--verbose")
    assert result.returncode == 0, result.stderr
    report = json.loads((tmp_path / "r.json").read_text())
    positions = report["scans"]
    assert not report["interrupted"]
    assert report["loops"]
    for loop in report["loops"]:
        assert 0 <= loop["a"] < loop["b"] < 25
        assert loop["strength"] > 0
        a, b = (positions[loop[name]]["map_from_robot"] for name in "ab")
        in_map = relative(*((p["x_m"], p["y_m"], math.radians(p["theta_deg"])) for p in (a, b)))
        assert math.hypot(in_map[0] - loop["a_from_b"]["x_m"], in_map[1] - loop["a_from_b"]["y_m"]) < 0.1
    assert [p["is_keyframe"] for p in positions[:3]] == [True, False, True], "the robot stood still at first"
    assert positions[2]["alignment"]["reference"] == 0
    assert report["seconds"]["loops"] > 0
    keyframes = sum(p["is_keyframe"] for p in positions)
    assert f"({keyframes} keyframes, {len(report['loops'])} loop" in result.stderr
    assert ", loops " in result.stderr


def test_selection_keeps_count_in_the_whole_log(run, room_log, tmp_path):
    result = run("room.log", "--out", "m.png", "--skip", 2, "--every", 2, "--first", 3, "--report", "r.json")
    assert result.returncode in (0, 4), result.stderr
    report = json.loads((tmp_path / "r.json").read_text())
    assert [p["index_in_whole_log"] for p in report["scans"]] == [2, 4, 6]
    assert [p["timestamp_s"] for p in report["scans"]] == [3.0, 5.0, 7.0]


def test_a_pipe_gets_no_progress_bar_and_quiet_means_silence(run, room_log):
    result = run("room.log", "--out", "a.png")
    assert "\r" not in result.stderr
    assert "\033" not in result.stderr
    assert len(result.stderr.splitlines()) == 1
    result = run("room.log", "--out", "b.png", "--quiet")
    assert result.returncode == 0
    assert result.stderr == ""
    assert result.stdout == ""


def test_a_terminal_gets_a_progress_bar(cli_path, room_log, tmp_path):
    main, terminal = os.openpty()
    process = subprocess.Popen([cli_path, "room.log", "--out", "map.png"], cwd=tmp_path, stderr=terminal)
    os.close(terminal)
    seen = b""
    while True:
        try:
            chunk = os.read(main, 4096)
        except OSError:  # the other end is closed
            break
        if not chunk:
            break
        seen += chunk
    os.close(main)
    assert process.wait(60) == 0
    assert b"chain [" in seen and b"loops [" in seen and b"whole map " in seen
    assert b"12/12" in seen
    assert b"positions/s" in seen
    assert b"ETA" in seen


def test_existing_outputs_stay_without_force(fails, run, room_log, tmp_path):
    for name in ("map.png", "map.yaml", "map.tum"):
        (tmp_path / name).write_text("mine")
        fails(5, "room.log", "--out", "map.png", "--trajectory", "map.tum", says=[name, "--force"])
        assert (tmp_path / name).read_text() == "mine"
        (tmp_path / name).unlink()
    (tmp_path / "map.png").write_text("mine")
    assert run("room.log", "--out", "map.png", "--force").returncode == 0
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")


def test_convert_needs_force_too(fails, run, room_log, tmp_path):
    (tmp_path / "room.nist").write_text("mine")
    fails(5, "convert", "room.log", "room.nist", says="--force")
    assert run("convert", "room.log", "room.nist", "--force").returncode == 0
    assert (tmp_path / "room.nist").read_text() != "mine"


@pytest.mark.parametrize(
    "outputs",
    [
        ["--out", "missing/map.png"],
        ["--out", "map.png", "--trajectory", "missing/map.tum"],
        ["--out", "map.png", "--report", "room.log/report.json"],
        ["--out", "map.png", "--trajectory", "folder"],
        ["--out", "/proc/map.png"],
        ["--out", "map.png", "--trajectory", "/dev/full"],
        ["--out", "map.png", "--report", "/dev/full"],
        ["--out", "map.png", "--carmen-out", "/dev/full"],
    ],
)
def test_what_cannot_be_written_leaves_nothing(fails, room_log, tmp_path, outputs):
    (tmp_path / "folder").mkdir()
    fails(5, "room.log", *outputs)


def test_a_map_that_is_too_large_says_what_helps(fails, tmp_path):
    scan = [30.0 + 0.1 * r for r in synthetic_log.scan(synthetic_log.path(1)[0])]
    (tmp_path / "far.log").write_text(synthetic_log.flaser(scan, 1.0))
    fails(5, "far.log", "--out", "map.png", "--resolution-m", "0.001", says="--resolution-m")


@pytest.mark.parametrize("limit", [0, 100, 1000, 3000])
def test_a_full_disk_leaves_nothing(fails, room_log, limit):
    """A limit on file size meets every write where a full disk would."""

    def set_limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    message = fails(
        *[5, "room.log", "--out", "map.png", "--trajectory", "map.tum", "--report", "report.json"],
        *["--rawlog-out", "out.rawlog", "--carmen-out", "out.log"],
        preexec_fn=set_limit,
    )
    assert "/." not in message, "the message names the file that was asked for, not a temporary one"


@pytest.fixture
def small_file_system(tmp_path):
    folder = tmp_path / "small"
    folder.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4k", "none", str(folder)], capture_output=True)
    if mounted.returncode != 0:
        pytest.skip("cannot mount a small file system (that takes root); the file size limit is tested instead")
    try:
        yield folder
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def test_a_full_file_system_leaves_nothing(fails, room_log, small_file_system):
    probe = small_file_system / "probe"
    try:
        probe.write_bytes(bytes(65536))
        pytest.skip("this kernel does not keep tmpfs to its size; the file size limit is tested instead")
    except OSError:
        probe.unlink()
    fails(5, "room.log", "--out", "map.png", "--rawlog-out", "small/out.rawlog", says="small/out.rawlog")


def test_a_closed_pipe_is_an_output_that_cannot_be_written(cli_path, room_log, tmp_path):
    read_end, write_end = os.pipe()
    os.close(read_end)
    arguments = [cli_path, "room.log", "--out", "map.png", "--trajectory", "-"]
    result = subprocess.run(arguments, cwd=tmp_path, stdout=write_end, stderr=subprocess.PIPE, text=True, timeout=60)
    os.close(write_end)
    assert result.returncode == 5, result.stderr
    assert not (tmp_path / "map.png").exists()
