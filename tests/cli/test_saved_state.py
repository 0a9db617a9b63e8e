# SPDX-License-Identifier: GPL-3.0-or-later
"""--save-state and --resume: however a run ends, what was aligned is not lost, and the map is the same in the end."""
import ctypes
import os
import re
import signal
import subprocess
import time

import patience
import pytest
import synthetic_log

OUTPUTS = {"--out": "map.png", "--trajectory": "map.tum", "--motions": "map.motions", "--trace": "map.jsonl"}
# Each position a keyframe, and a coarse search: many alignments that take little time.
OPTIONS = ["--keyframe-step-m", "0", "--first", "40", "--rotation-peaks", "3", "--refined-candidates", "5"]
STATE = ["--save-state", "run.state"]
RECORD = 8 + 24  # bytes of an alignment without hypotheses


@pytest.fixture(scope="module")
def walk_text():
    """Back and forth through the room: loops to close."""
    poses = synthetic_log.path(11)
    lines = [synthetic_log.flaser(synthetic_log.scan(pose), i) for i, pose in enumerate((poses + poses[::-1]) * 2)]
    return "".join(lines)


@pytest.fixture
def walk_log(tmp_path, walk_text):
    (tmp_path / "walk.log").write_text(walk_text)
    return tmp_path / "walk.log"


@pytest.fixture
def command(walk_log, tmp_path):
    """The arguments of a run into a folder of its own."""

    def arguments(folder, *more):
        (tmp_path / folder).mkdir(exist_ok=True)
        outputs = [part for flag, name in OUTPUTS.items() for part in (flag, f"{folder}/{name}")]
        return [walk_log.name, *outputs, *OPTIONS, *more]

    return arguments


@pytest.fixture
def bytes_of(tmp_path):
    return lambda folder: {name: (tmp_path / folder / name).read_bytes() for name in OUTPUTS.values()}


@pytest.fixture(scope="module")
def finished(cli_path, walk_text, tmp_path_factory):
    """The outputs of a run that was never cut short, and its state."""
    folder = tmp_path_factory.mktemp("finished")
    (folder / "walk.log").write_text(walk_text)
    (folder / "out").mkdir()
    outputs = [part for flag, name in OUTPUTS.items() for part in (flag, f"out/{name}")]
    subprocess.run([cli_path, "walk.log", *outputs, *OPTIONS, *STATE], cwd=folder, check=True, capture_output=True)
    written = {name: (folder / "out" / name).read_bytes() for name in OUTPUTS.values()}
    return written, (folder / "run.state").read_bytes()


@pytest.fixture
def never_cut(finished):
    return finished[0]


@pytest.fixture
def saved(finished):
    return finished[1]


@pytest.fixture
def state_file(tmp_path, saved):
    (tmp_path / "run.state").write_bytes(saved)
    return tmp_path / "run.state"


def header_size(state):
    return 12 + 8 + int.from_bytes(state[16:20], "little") + 4


def num_resumed(result):
    return int(re.search(r"resumed 'run.state' with (\d+) alignments", result.stderr)[1])


def size_of(path):
    return path.stat().st_size if path.exists() else 0


def kill_at(cli_path, folder, arguments, size):
    """Runs until the state has `size` bytes, then kills; whether it came so far."""
    process = subprocess.Popen([cli_path, *arguments], cwd=folder, stderr=subprocess.PIPE)
    while process.poll() is None and size_of(folder / "run.state") < size:
        time.sleep(0.002)
    process.kill()
    process.communicate(timeout=30)
    return process.returncode == -signal.SIGKILL


def test_saving_changes_no_byte_of_the_outputs(run, command, saved, never_cut, bytes_of):
    assert run(*command("without")).returncode == 0
    assert bytes_of("without") == never_cut
    assert len(saved) > 100 * RECORD


@pytest.mark.parametrize("share", [0.02, 0.3, 0.7, 0.95])
def test_killed_and_resumed_is_as_never_killed(cli_path, run, command, bytes_of, saved, never_cut, tmp_path, share):
    assert kill_at(cli_path, tmp_path, command("out", *STATE), share * len(saved))
    assert not (tmp_path / "out/map.tum").exists()
    result = run(*command("out", *STATE, "--resume"))
    assert result.returncode == 0, result.stderr
    assert num_resumed(result) > 0
    assert bytes_of("out") == never_cut


@patience.without_sanitizers
def test_killed_again_and_again(cli_path, run, command, bytes_of, saved, never_cut, tmp_path):
    num_killed = 0
    arguments = command("out", *STATE)
    for part in range(1, 8):
        if kill_at(cli_path, tmp_path, arguments, part / 8 * len(saved)):
            num_killed += 1
        arguments = command("out", *STATE, "--resume", "--force", "--threads", 1 + part % 3)
        arguments = [str(argument) for argument in arguments]
    assert num_killed >= 5
    assert run(*arguments).returncode == 0
    assert bytes_of("out") == never_cut


def test_ctrl_c_leaves_a_state_to_resume(cli_path, run, command, bytes_of, saved, never_cut, tmp_path):
    process = subprocess.Popen([cli_path, *command("out", *STATE)], cwd=tmp_path, stderr=subprocess.PIPE)
    while size_of(tmp_path / "run.state") < len(saved) // 4:
        assert process.poll() is None
        time.sleep(0.002)
    process.terminate()
    process.communicate(timeout=60)
    result = run(*command("out", *STATE, "--resume", "--force"))
    assert result.returncode == 0, result.stderr
    assert num_resumed(result) > 0
    assert bytes_of("out") == never_cut


def test_a_finished_run_is_resumed_for_other_outputs(run, command, bytes_of, saved, state_file):
    """Options that alignments do not depend on may change, and the map is that of the new ones."""
    assert run(*command("plain", "--no-close-loops")).returncode == 0
    result = run(*command("again", *STATE, "--resume", "--no-close-loops"))
    assert result.returncode == 0, result.stderr
    assert bytes_of("again") == bytes_of("plain")
    assert state_file.read_bytes() == saved


def cut_points(state):
    header = header_size(state)
    first = header + 8 + int.from_bytes(state[header : header + 4], "little")
    return {
        "empty": 0, "magic": 5, "header": header // 2, "after header": header, "head": header + 3, "body": header + 40,
        "after first": first, "head of second": first + 8, "middle": len(state) // 2, "last byte": len(state) - 1,
    }  # fmt: skip


@patience.without_sanitizers
def test_cut_off_anywhere_is_resumed(run, command, bytes_of, saved, never_cut, tmp_path):
    for name, size in cut_points(saved).items():
        (tmp_path / "run.state").write_bytes(saved[:size])
        result = run(*command("out", *STATE, "--resume", "--force"))
        assert result.returncode == 0, (name, result.stderr)
        assert bytes_of("out") == never_cut, name
        at_border = name in ("after header", "after first")
        assert ("warning: 'run.state'" in result.stderr) == (not at_border), (name, result.stderr)
        assert len((tmp_path / "run.state").read_bytes()) == len(saved), name


@pytest.mark.parametrize("share", [0.0, 0.4, 0.99])
def test_a_flipped_byte_costs_what_comes_after_it(run, command, bytes_of, saved, never_cut, tmp_path, share):
    header = header_size(saved)
    damaged = bytearray(saved)
    at = header + int(share * (len(saved) - header))
    damaged[at] ^= 0x10
    (tmp_path / "run.state").write_bytes(damaged)
    result = run(*command("out", *STATE, "--resume"))
    assert result.returncode == 0, result.stderr
    assert "warning: 'run.state' is damaged or cut off at byte " in result.stderr
    assert bytes_of("out") == never_cut
    assert len((tmp_path / "run.state").read_bytes()) == len(saved)


@pytest.mark.parametrize(("at", "says"), [(2, "not a state"), (13, "has format"), (17, "damaged"), (200, "damaged")])
def test_a_flipped_byte_in_the_header_is_told(fails, command, saved, tmp_path, at, says):
    damaged = bytearray(saved)
    damaged[at] ^= 0x10
    (tmp_path / "run.state").write_bytes(damaged)
    fails(3, *command("out", *STATE, "--resume"), says=["run.state", says])
    assert (tmp_path / "run.state").read_bytes() == damaged


def test_what_differs_is_named_and_nothing_lost(fails, command, saved, state_file, tmp_path, room_text):
    def refused(*arguments, says):
        fails(3, *arguments, "--resume", "--force", says=["cannot resume 'run.state'", says])
        assert state_file.read_bytes() == saved

    refused(*command("out", *STATE, "--agree-m", "0.2"), says="--agree-m 0.1 instead of 0.2")
    refused(*command("out", *STATE, "--every", "2"), says="of 40, not 22")
    refused(*command("out", *STATE, "--max-range", "5"), says="--max-range 0 instead of 5")
    (tmp_path / "walk.log").write_text(room_text * 4)
    refused(*command("out", *STATE), says="just as many")


def test_usage(fails, command, saved, state_file):
    fails(5, *command("out", *STATE), says=["run.state", "exists already", "--resume", "--force"])
    fails(3, *command("out", "--save-state", "none.state", "--resume"), says=["none.state", "no state"])
    fails(3, *command("out", "--save-state", "none.state", "--resume", "--force"), says=["none.state", "no state"])
    fails(2, *command("out", "--resume"), says=["--resume", "--save-state"])
    fails(2, *command("out", "--save-state", "out/map.tum"), says="two outputs")
    fails(2, *command("out", "--save-state", "walk.log", "--force"), says="both input and output")
    fails(5, *command("out", "--save-state", "-"), says="needs a file")
    fails(5, *command("out", "--save-state", "no/run.state"), says="no folder")
    fails(5, *command("out", "--save-state", "out"), says="it is a folder")
    fails(2, "walk.log", "--out", "a.png", "--save-state", "b.state", "--method", "paper", says="--method robust")
    assert state_file.read_bytes() == saved


def test_force_begins_anew(run, command, bytes_of, saved, never_cut, tmp_path):
    (tmp_path / "run.state").write_text("something else")
    assert run(*command("out", *STATE, "--force")).returncode == 0
    assert bytes_of("out") == never_cut
    assert len((tmp_path / "run.state").read_bytes()) == len(saved)


def test_a_state_belongs_to_one_run_at_a_time(cli_path, fails, command, tmp_path):
    process = subprocess.Popen([cli_path, *command("out", *STATE)], cwd=tmp_path, stderr=subprocess.PIPE)
    while size_of(tmp_path / "run.state") < 5000:
        assert process.poll() is None
        time.sleep(0.002)
    process.send_signal(signal.SIGSTOP)  # stopped, so that it does not end meanwhile
    for more in (["--resume"], ["--force"]):
        assert "another run has it open" in fails(5, *command("other", *STATE, *more))
    process.kill()
    process.communicate(timeout=30)


def as_anyone():
    """Root may write anywhere, unless it gives that up."""
    drop_from_bounding_set, dac_override = 24, 1
    if os.geteuid() == 0 and ctypes.CDLL(None).prctl(drop_from_bounding_set, dac_override, 0, 0, 0) != 0:
        raise OSError("root cannot give up that it may write anywhere")


def test_what_must_not_be_written_is_told(fails, command, state_file, tmp_path):
    (tmp_path / "closed").mkdir(mode=0o500)
    closed = command("out", "--save-state", "closed/run.state")
    fails(5, *closed, says=["closed/run.state", "Permission denied"], preexec_fn=as_anyone)
    state_file.chmod(0o400)
    fails(5, *command("out", *STATE, "--resume"), says=["run.state", "Permission denied"], preexec_fn=as_anyone)


def limit_to(size):
    def limit():
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


def test_a_full_disk_is_told_and_what_was_saved_can_be_resumed(run, command, bytes_of, saved, never_cut, tmp_path):
    arguments = [part for part in command("out", *STATE) if part not in ("--trace", "out/map.jsonl")]
    result = run(*arguments, preexec_fn=limit_to(len(saved) // 3))
    assert result.returncode == 5
    assert result.stderr.splitlines() == ["shapemap-cli: cannot write 'run.state': File too large"]
    assert list((tmp_path / "out").iterdir()) == []
    result = run(*command("out", *STATE, "--resume"))
    assert result.returncode == 0, result.stderr
    assert "warning" not in result.stderr
    assert num_resumed(result) > 0
    assert bytes_of("out") == never_cut


def test_a_disk_that_is_full_from_the_start_leaves_nothing(fails, command):
    arguments = [part for part in command("out", *STATE) if part not in ("--trace", "out/map.jsonl")]
    fails(5, *arguments, says=["run.state", "File too large"], preexec_fn=limit_to(100))
    for more in ([], ["--force"], ["--resume"]):
        fails(5, *command("out", "--save-state", "/dev/full", *more), says=["/dev/full", "needs a file"])
