# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C at any moment: code 130, soon, with the map so far; a second one leaves no trace of the run."""

import json
import os
import re
import signal
import subprocess
import time

import patience
import pytest
import synthetic_log

OUTPUTS = ["map.json", "map.png", "map.tum", "map.yaml", "out.rawlog", "trace.jsonl"]


@pytest.fixture
def long_log(tmp_path, room_text):
    path = tmp_path / "long.log"
    path.write_text(room_text * 400)
    return path


def start(cli_path, folder, terminal=None, *more):
    arguments = [cli_path, "long.log", "--out", "map.png", "--trajectory", "map.tum", "--rawlog-out", "out.rawlog"]
    arguments += ["--trace", "trace.jsonl", "--report", "map.json", *more]
    return subprocess.Popen(arguments, cwd=folder, stderr=terminal if terminal is not None else subprocess.PIPE)


def read_until(main, text):
    seen = b""
    while text not in seen:
        seen += os.read(main, 4096)
    return seen


def start_and_wait_for_progress(cli_path, folder, *more):
    """The process, and the terminal that shows that some positions are done."""
    main, terminal = os.openpty()
    process = start(cli_path, folder, terminal, *more)
    os.close(terminal)
    read_until(main, b"/4800")
    return process, main


@pytest.mark.parametrize("which", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("method", ["robust", "paper"])
def test_an_interrupt_gives_the_map_so_far(cli_path, long_log, tmp_path, files_of, which, method):
    process, main = start_and_wait_for_progress(cli_path, tmp_path, "--method", method)
    begin = time.monotonic()
    process.send_signal(which)
    assert patience.wait(process) == 130
    assert patience.is_soon(time.monotonic() - begin, 10.0)
    seen = read_until(main, b"; map: map.png").decode()
    os.close(main)
    found = re.search(r"interrupted after (\d+) of 4800 positions; writing the map so far", seen)
    assert found, seen
    num_mapped = int(found[1])
    assert 0 < num_mapped < 4800
    assert f"placed {num_mapped} of {num_mapped} position" in seen  # one, or several
    assert "nothing written\n" not in seen
    assert files_of() == ["long.log", *OUTPUTS]
    report = json.loads((tmp_path / "map.json").read_text())
    assert report["interrupted"] is True
    assert report["num_placed"] == report["num_scans"] == num_mapped
    assert report["logs"][0]["num_scans"] == 4800
    assert len((tmp_path / "map.tum").read_text().splitlines()) == num_mapped
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    last = (tmp_path / "trace.jsonl").read_text().splitlines()[-1]
    assert json.loads(last)["num_placed"] == num_mapped


def test_a_quiet_run_tells_the_interrupt_and_no_more(cli_path, long_log, tmp_path, files_of):
    process = start(cli_path, tmp_path, None, "--quiet")
    while len(files_of()) < 2:  # the trace grows while positions are mapped
        assert process.poll() is None
        time.sleep(0.02)
    time.sleep(1.5)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert re.fullmatch(rb"shapemap-cli: interrupted after \d+ of 4800 positions; writing [^\n]*\n", errors), errors
    assert files_of() == ["long.log", *OUTPUTS]


@pytest.mark.parametrize("delay_s", [0.0, 0.05, 0.1, 0.2, 0.4])
def test_interrupt_at_any_early_moment(cli_path, long_log, tmp_path, files_of, delay_s):
    process = start(cli_path, tmp_path)
    time.sleep(delay_s)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    # Before the program has started its handlers the system's own one ends it.
    assert process.returncode in (130, -signal.SIGINT)
    if b"writing the map so far" in errors:
        assert files_of() == ["long.log", *OUTPUTS]
        return
    if process.returncode == 130:
        assert errors == b"shapemap-cli: interrupted; nothing written\n"
    assert files_of() == ["long.log"]


def test_a_second_interrupt_leaves_files_untouched(cli_path, long_log, tmp_path, files_of):
    """The first one finds the trajectory's pipe without a reader, and the run waits."""
    os.mkfifo(tmp_path / "pipe")
    for name in ("map.png", "map.yaml", "trace.jsonl"):
        (tmp_path / name).write_text("mine")
    before = files_of()
    main, terminal = os.openpty()
    arguments = [cli_path, "long.log", "--out", "map.png", "--trajectory", "pipe", "--trace", "trace.jsonl", "--force"]
    arguments += ["--fragments", "apart"]
    process = subprocess.Popen(arguments, cwd=tmp_path, stderr=terminal)
    os.close(terminal)
    read_until(main, b"/4800")
    process.send_signal(signal.SIGINT)
    read_until(main, b"writing the map so far")
    time.sleep(1.0)
    assert process.poll() is None
    assert len(files_of()) > len(before), "temporary files are there"
    assert (tmp_path / "apart").is_dir()
    begin = time.monotonic()
    process.send_signal(signal.SIGINT)
    assert patience.wait(process) == 130
    assert patience.is_soon(time.monotonic() - begin, 2.0)
    read_until(main, b"interrupted; nothing written")
    os.close(main)
    assert files_of() == before
    assert not (tmp_path / "apart").exists()
    assert [(tmp_path / name).read_text() for name in ("map.png", "map.yaml", "trace.jsonl")] == ["mine"] * 3


def test_two_interrupts_at_once_while_mapping(cli_path, long_log, tmp_path, files_of):
    process, main = start_and_wait_for_progress(cli_path, tmp_path)
    process.send_signal(signal.SIGINT)
    process.send_signal(signal.SIGTERM)
    begin = time.monotonic()
    assert patience.wait(process) == 130
    assert patience.is_soon(time.monotonic() - begin, 2.0)
    os.close(main)
    assert files_of() == ["long.log"]


def test_interrupt_while_waiting_for_a_reader(cli_path, tmp_path, files_of):
    """The trajectory goes to a pipe that nobody reads yet: the other outputs wait in temporary files."""
    (tmp_path / "room.log").write_text(synthetic_log.carmen_log(3))
    os.mkfifo(tmp_path / "pipe")
    arguments = [cli_path, "room.log", "--out", "map.png", "--trajectory", "pipe"]
    process = subprocess.Popen(arguments, cwd=tmp_path, stderr=subprocess.PIPE)
    while len(files_of()) < 4:
        assert process.poll() is None
        time.sleep(0.02)
    time.sleep(0.2)
    process.send_signal(signal.SIGINT)  # ends the wait, although there is still no reader
    _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert errors == b"shapemap-cli: interrupted; nothing written\n"
    assert files_of() == ["pipe", "room.log"]


def test_interrupt_at_any_moment_gives_all_or_nothing(cli_path, tmp_path, files_of):
    (tmp_path / "room.log").write_text(synthetic_log.carmen_log(3))
    arguments = [cli_path, "room.log", "--out", "map.png", "--trajectory", "map.tum", "--resolution-m", "0.01"]
    outputs = ["map.png", "map.tum", "map.yaml"]
    begin = time.monotonic()
    subprocess.run(arguments, cwd=tmp_path, check=True, capture_output=True)
    duration_s = time.monotonic() - begin
    for i in range(15):
        for name in outputs:
            (tmp_path / name).unlink(missing_ok=True)
        process = subprocess.Popen(arguments, cwd=tmp_path, stderr=subprocess.PIPE)
        time.sleep(duration_s * (0.4 + 0.05 * i))
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=30)
        if process.returncode == 0 or b"; map: map.png" in errors:
            assert process.returncode == 0 or b" interrupted" in errors
            assert files_of() == [*outputs, "room.log"]
        else:
            assert process.returncode in (130, -signal.SIGINT)
            assert files_of() == ["room.log"]
