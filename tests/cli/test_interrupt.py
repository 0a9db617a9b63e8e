# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C at any moment: code 130, soon, and no trace of the run."""
import os
import signal
import subprocess
import time

import pytest
import synthetic_log


@pytest.fixture
def long_log(tmp_path, room_text):
    path = tmp_path / "long.log"
    path.write_text(room_text * 400)
    return path


def start(cli_path, folder, terminal=None):
    arguments = [cli_path, "long.log", "--out", "map.png", "--trajectory", "map.tum", "--rawlog-out", "out.rawlog"]
    arguments += ["--trace", "trace.jsonl"]
    return subprocess.Popen(arguments, cwd=folder, stderr=terminal if terminal is not None else subprocess.PIPE)


def wait_for_progress(main):
    """Reads the terminal until the bar shows that some positions are done."""
    seen = b""
    while b"/4800" not in seen:
        seen += os.read(main, 4096)
    return seen


@pytest.mark.parametrize("which", [signal.SIGINT, signal.SIGTERM])
def test_interrupt_while_mapping(cli_path, long_log, tmp_path, files_of, which):
    main, terminal = os.openpty()
    process = start(cli_path, tmp_path, terminal)
    os.close(terminal)
    wait_for_progress(main)
    begin = time.monotonic()
    process.send_signal(which)
    assert process.wait(30) == 130
    assert time.monotonic() - begin < 5.0
    seen = b""
    while b"nothing written" not in seen:
        seen += os.read(main, 4096)
    os.close(main)
    assert b"shapemap-cli: interrupted; nothing written" in seen
    assert files_of() == ["long.log"]


@pytest.mark.parametrize("delay_s", [0.05, 0.1, 0.2, 0.4])
def test_interrupt_at_any_early_moment(cli_path, long_log, tmp_path, files_of, delay_s):
    process = start(cli_path, tmp_path)
    time.sleep(delay_s)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    # Before the program has started its handlers the system's own one ends it.
    assert process.returncode in (130, -signal.SIGINT)
    if process.returncode == 130:
        assert errors == b"shapemap-cli: interrupted; nothing written\n"
    assert files_of() == ["long.log"]


def test_interrupt_while_writing(cli_path, tmp_path, files_of):
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
        process.communicate(timeout=30)
        if process.returncode == 0:
            assert files_of() == [*outputs, "room.log"]
        else:
            assert process.returncode in (130, -signal.SIGINT)
            assert files_of() == ["room.log"]
