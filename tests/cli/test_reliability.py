# SPDX-License-Identifier: GPL-3.0-or-later
"""Inputs and surroundings that once brought the program down, hung it or cost a file."""

import gzip
import os
import pathlib
import resource
import struct
import subprocess
import tempfile
import threading

import patience
import pytest
import synthetic_log

RANGES = " ".join(f"{2.0 + 0.1 * i:.1f}" for i in range(20))
OUT = ["--out", "map.png"]


def robot_laser(step, start="0", fov="3"):
    return f"ROBOTLASER1 0 {start} {fov} {step} 81 0 0 20 {RANGES} 0 0 0 0 0 0 0 0 0 0 0 0 0 h 0\n"


def nist(sensor, label="a", heading="0"):
    scan = f"scan {label} heading {heading} ranges {RANGES}\n"
    return f"shapemap-scans 1\nunits m rad\nsensor {label} beams 20 {sensor}\nposition 1\n{scan}"


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (robot_laser("1e12", fov="0"), ["x.log:1:", "neither the angular resolution nor the field of view"]),
        (robot_laser("1e308", fov="1e308"), ["x.log:1:", "neither the angular resolution nor the field of view"]),
        (robot_laser("0.01", "-1e9"), ["x.log:1:", "first_angle of -1e+09 rad"]),
        (robot_laser("1e-300"), ["x.log:1:", "angle_step of 1e-300 rad"]),
        (nist("angle_step 1e12"), ["x.log:5:", "neither angle_step nor last_angle", "at most a full turn"]),
        (nist("angle_step 1e308"), ["x.log:5:", "neither angle_step nor last_angle"]),
        (nist("angle_step 0.1 first_angle 2147483648"), ["x.log:5:", "first_angle of 2.14748e+09 rad"]),
        (nist("angle_step 0.1 mount -3.05e207 0 0 0 0 0"), ["x.log:3:", "mount", "-3.05e+207 m", "at most 100 m"]),
        (nist("angle_step 0.1", heading="1e200"), ["x.log:5:", "heading of 1e+200 rad"]),
        (nist("angle_step 0.1").replace("position 1", "position 1e300"), ["x.log:4:", "timestamp of 1e+300 s"]),
        ("# shapemap mount 1e5 0 0 0 0 0\n" + robot_laser("0.1"), ["x.log:2:", "a mount's x of 100000 m"]),
    ],
)
def test_a_header_that_no_sensor_has_is_an_error_with_its_place(fails, tmp_path, content, says):
    (tmp_path / "x.log").write_text(content)
    fails(3, "x.log", *OUT, says=says)
    fails(3, "info", "x.log", says=says)


@pytest.mark.parametrize("step", ["1e12", "1e308"])
def test_an_impossible_resolution_gives_way_to_the_field_of_view(run, tmp_path, step):
    (tmp_path / "x.log").write_text(robot_laser(step))
    result = run("x.log", *OUT)
    assert result.returncode == 0, result.stderr
    assert "warning: x.log:1: field of view and angular resolution contradict each other" in result.stderr


def rawlog_with_wide_apertures(run, folder, wide):
    """Three scans of which some are said to span a million radians: one bit of a float has flipped."""
    (folder / "walk.log").write_text(synthetic_log.carmen_log(3))
    assert run("convert", "walk.log", "walk.rawlog").returncode == 0
    content = gzip.decompress((folder / "walk.rawlog").read_bytes())
    name = b"CObservation2DRangeScan"
    at = -1
    for i in range(3):
        at = content.index(name, at + 1)
        if i not in wide:
            continue
        where = at + len(name) + 1
        (aperture,) = struct.unpack_from("<f", content, where)
        assert aperture == pytest.approx(3.14159, abs=1e-4)
        (bits,) = struct.unpack_from("<I", content, where)
        content = content[:where] + struct.pack("<I", bits ^ (1 << 29)) + content[where + 4 :]
    (folder / "x.rawlog").write_bytes(content)


def test_a_flipped_bit_in_a_rawlog_leaves_one_scan_out(run, tmp_path):
    rawlog_with_wide_apertures(run, tmp_path, [1])
    result = run("x.rawlog", *OUT, "--trajectory", "-")
    assert result.returncode == 0, result.stderr
    assert len(result.stdout.splitlines()) == 2
    for word in ["warning: x.rawlog: 1 scan is left out: ", "rad, expected at most", "(the first at offset "]:
        assert word in result.stderr


def test_a_rawlog_without_a_possible_scan_is_an_error(fails, run, tmp_path):
    rawlog_with_wide_apertures(run, tmp_path, [0, 1, 2])
    fails(3, "x.rawlog", *OUT, says=["x.rawlog: 3 scans are left out: ", "(the first at offset "])


def harmless(text):
    return all(c == "\n" or " " <= c < "\x7f" or c > "\x9f" for c in text)


@pytest.mark.parametrize("kind", ["nist", "rawlog"])
def test_text_of_a_log_reaches_the_terminal_only_escaped(run, tmp_path, kind):
    label = "\x1b[31mred\x1b[0m\x1b]0;title\x07\u009b2J"
    (tmp_path / "x.nist").write_text(nist("angle_step 0.1", label))
    if kind == "rawlog":
        assert run("convert", "x.nist", "x.rawlog").returncode == 0
    result = run("info", f"x.{kind}")
    assert result.returncode == 0
    assert "\\x1b[31mred\\x1b[0m" in result.stdout
    assert harmless(result.stdout), result.stdout
    result = run(f"x.{kind}", *OUT, "--verbose", "--force")
    assert result.returncode == 0
    assert "\\x1b[31mred" in result.stderr
    assert harmless(result.stderr), result.stderr
    result = run("info", f"x.{kind}", "--sensor-label", "other")
    assert result.returncode == 3
    assert "\\x1b[31mred" in result.stderr
    assert harmless(result.stderr), result.stderr


def test_long_names_are_cut(run, tmp_path):
    (tmp_path / "x.nist").write_text(nist("angle_step 0.1", "long" + "g" * 50_000))
    result = run("info", "x.nist")
    assert result.returncode == 0
    assert "longgg" in result.stdout
    assert len(result.stdout) < 1000
    (tmp_path / "x.nist").write_text("shapemap-scans 1\n" + "w" * 50_000 + "\n")
    result = run("info", "x.nist")
    assert result.returncode == 3
    assert len(result.stderr) < 2000
    assert "is no statement; expected units" in result.stderr


def closing(*descriptors):
    """What a shell does for `>&-`."""

    def close():
        for descriptor in descriptors:
            os.close(descriptor)

    return close


def without(cli_path, folder, descriptors, *arguments):
    command = [cli_path, *arguments]
    return subprocess.run(command, cwd=folder, preexec_fn=closing(*descriptors), timeout=300, check=False).returncode


@pytest.mark.parametrize("descriptors", [[2], [1, 2], [0, 1, 2], [0, 2]])
def test_messages_never_reach_a_file_that_has_a_closed_descriptor(cli_path, run, tmp_path, room_log, descriptors):
    assert run("room.log", *OUT, "--save-state", "run.state", "--first", "4").returncode == 0
    before = (tmp_path / "run.state").read_bytes()
    more = ["--save-state", "run.state", "--first", "4", "--resume", "--force", "--trace", "trace.jsonl"]
    assert without(cli_path, tmp_path, descriptors, "room.log", *OUT, *more) == 0
    assert (tmp_path / "run.state").read_bytes() == before
    result = run("room.log", *OUT, *more)
    assert result.returncode == 0
    assert "resumed 'run.state' with" in result.stderr


def test_a_closed_standard_output_is_an_output_that_cannot_be_written(cli_path, tmp_path, room_log, files_of):
    assert without(cli_path, tmp_path, [1], "info", "room.log") == 5
    assert without(cli_path, tmp_path, [1, 2], "room.log", *OUT, "--trajectory", "-", "--first", "2") == 5
    assert files_of() == ["room.log"]


@pytest.mark.parametrize("command", [["room.log", *OUT, "--report"], ["align", "room.log", "--gap", "1", "--out"]])
def test_the_options_file_is_never_an_output(fails, tmp_path, room_log, command):
    (tmp_path / "o.toml").write_text("threads = 1\n")
    fails(2, *command, "o.toml", "--config", "o.toml", "--force", says="'o.toml' is both input and output")
    assert (tmp_path / "o.toml").read_text() == "threads = 1\n"


def test_a_state_is_never_the_options_file(fails, tmp_path, room_log):
    (tmp_path / "o.toml").write_text("threads = 1\n")
    fails(2, "room.log", *OUT, "--save-state", "o.toml", "--config", "o.toml", "--force", says="o.toml")


def test_a_scan_of_one_beam_survives_carmen(run, tmp_path):
    (tmp_path / "one.nist").write_text("shapemap-scans 1\nsensor a beams 1\nposition 1\nscan a heading 0 ranges 2\n")
    assert run("convert", "one.nist", "one.log").returncode == 0
    result = run("info", "one.log")
    assert result.returncode == 0, result.stderr
    assert "beams       1 over" in result.stdout


@patience.without_sanitizers
def test_too_many_scans_are_refused_before_the_memory_is_gone(cli_path, tmp_path):
    with gzip.open(tmp_path / "bomb.gz", "wb", compresslevel=1) as file:
        for _ in range(60):
            file.write(b"1 1\n" * 100_000)
    limit = (3 << 30, resource.RLIM_INFINITY)
    result = subprocess.run(
        [cli_path, "bomb.gz", "--fov-deg", "180", "--first", "10", *OUT],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, limit),
        check=False,
    )
    assert result.returncode == 3, result.stderr
    assert "bomb.gz:5000001: more than 5000000 scans" in result.stderr


@patience.without_sanitizers  # their own memory has no place beside such stacks
def test_without_a_thread_to_be_had_one_does_all(cli_path, tmp_path, room_log, files_of):
    """No thread has room for a stack as large as this."""
    limit = 1 << 47
    if resource.getrlimit(resource.RLIMIT_STACK)[1] != resource.RLIM_INFINITY:
        pytest.skip("the limit of stacks may not be raised")
    result = subprocess.run(
        [cli_path, "room.log", *OUT, "--threads", "8", "--trace", "trace.jsonl", "--first", "4"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_STACK, (limit, resource.RLIM_INFINITY)),
        check=False,
    )
    assert result.returncode == 0, result.stderr
    assert files_of() == ["map.png", "map.yaml", "room.log", "trace.jsonl"]


def test_two_runs_with_one_output_do_not_mix(cli_path, tmp_path, room_log):
    for _ in range(4):
        for name in ("map.png", "map.yaml"):
            (tmp_path / name).unlink(missing_ok=True)
        codes = {}

        def start(resolution, codes=codes):
            command = [cli_path, "room.log", *OUT, "--first", "3", "--threads", "1", "--resolution-m", resolution]
            codes[resolution] = subprocess.run(command, cwd=tmp_path, capture_output=True, check=False).returncode

        runs = [threading.Thread(target=start, args=[resolution]) for resolution in ("0.05", "0.1")]
        for run in runs:
            run.start()
        for run in runs:
            run.join()
        assert sorted(codes.values()) == [0, 5]
        winner = next(resolution for resolution, code in codes.items() if code == 0)
        assert f"resolution: {winner}" in (tmp_path / "map.yaml").read_text()
        width = struct.unpack(">I", (tmp_path / "map.png").read_bytes()[16:20])[0]
        assert (width > 150) == (winner == "0.05")


as_root = pytest.mark.skipif(os.geteuid() != 0, reason="needs a second user, which only root can be")


def as_nobody(cli_path, folder, *arguments):
    def become_nobody():
        os.setgroups([])
        os.setgid(65534)
        os.setuid(65534)

    command = [cli_path, *arguments]
    result = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=300, preexec_fn=become_nobody, check=False
    )
    if "Permission denied" in result.stderr and result.returncode not in (3, 5):
        pytest.skip("another user may not start the program here")
    return result


@pytest.fixture
def open_folder(room_text):
    """For everybody, as far as the system's own folders for temporary files are."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o1777)
        (folder / "room.log").write_text(room_text)
        yield folder


@as_root
def test_when_one_file_cannot_be_replaced_all_stay(cli_path, open_folder):
    (open_folder / "map.tum").write_text("OLD\n")  # of another user, in a folder where that protects it
    for name in ("map.png", "map.yaml"):
        (open_folder / name).write_text("OLD\n")
        os.chown(open_folder / name, 65534, 65534)
    before = sorted(os.listdir(open_folder))
    arguments = ["room.log", "--first", "3", *OUT, "--trajectory", "map.tum", "--force"]
    result = as_nobody(cli_path, open_folder, *arguments)
    assert result.returncode == 5, result.stderr
    assert "map.tum" in result.stderr
    for name in ("map.png", "map.yaml", "map.tum"):
        assert (open_folder / name).read_text() == "OLD\n"
    assert sorted(os.listdir(open_folder)) == before


@as_root
def test_a_folder_that_may_not_be_entered_is_named(cli_path, open_folder):
    (open_folder / "closed").mkdir()
    (open_folder / "closed").chmod(0o666)
    result = as_nobody(cli_path, open_folder, "room.log", "--out", "closed/map.png")
    assert result.returncode == 5, result.stderr
    assert "cannot write 'closed/map.png': Permission denied" in result.stderr
