# SPDX-License-Identifier: GPL-3.0-or-later
"""What nothing ties to the map gets maps of its own."""

import json
import resource
import signal

import pytest
import synthetic_log


@pytest.fixture
def split_log(tmp_path):
    """The paper's chain starts anew after each blind position: fragments of 5, 1 and 2 positions."""
    lines = [synthetic_log.flaser(synthetic_log.scan(pose), 1.0 + i) for i, pose in enumerate(synthetic_log.path(8))]
    lines.insert(6, synthetic_log.flaser([81.83] * 181, 101.0))
    lines.insert(5, synthetic_log.flaser([81.83] * 181, 100.0))
    (tmp_path / "split.log").write_text("".join(lines))
    return "split.log", "--method", "paper", "--out", "map.png", "--fragments", "apart"


def fragment_files(folder):
    return sorted(path.name for path in folder.iterdir())


ALL = [f"fragment_{i}.{end}" for i in (1, 2) for end in ("png", "tum", "yaml")]


def test_each_fragment_but_the_map_is_written(run, split_log, tmp_path):
    result = run(*split_log, "--report", "r.json", "--verbose")
    assert result.returncode == 4, result.stderr
    assert fragment_files(tmp_path / "apart") == ALL
    fragments = json.loads((tmp_path / "r.json").read_text())["components"]
    assert [f["num_scans"] for f in fragments] == [5, 1, 2]
    assert [f["is_map"] for f in fragments] == [True, False, False]
    for i in (1, 2):
        times = [line.split()[0] for line in (tmp_path / "apart" / f"fragment_{i}.tum").read_text().splitlines()]
        assert len(times) == fragments[i]["num_scans"]
        assert f"fragment_{i}.png" in (tmp_path / "apart" / f"fragment_{i}.yaml").read_text()
        assert (tmp_path / "apart" / f"fragment_{i}.png").read_bytes().startswith(b"\x89PNG")
    assert "fragment 2 is apart from the map: 2 positions, position 8 to position 9" in result.stderr
    first, *others = (tmp_path / "apart" / "fragment_2.tum").read_text().splitlines()
    assert first.split()[1:] == ["0.000000000"] * 2 + ["0", "0", "0", "0.000000000000", "1.000000000000"]
    assert len(others) == 1


def test_a_map_in_one_piece_has_no_fragments(run, room_log, tmp_path):
    result = run("room.log", "--out", "map.png", "--fragments", "apart/")
    assert result.returncode == 0, result.stderr
    assert fragment_files(tmp_path / "apart") == []


def test_fragments_of_a_former_run_go_with_force_only(run, fails, split_log, tmp_path):
    (tmp_path / "apart").mkdir()
    for name in ("fragment_1.png", "fragment_7.tum", "fragment_7.robot.tum", "fragment_x.png", "notes.txt"):
        (tmp_path / "apart" / name).write_text("mine")
    fails(5, *split_log, says=["fragment_1.png", "--force"])
    assert run(*split_log, "--force").returncode == 4
    assert fragment_files(tmp_path / "apart") == [*ALL, "fragment_x.png", "notes.txt"]
    assert (tmp_path / "apart" / "fragment_1.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("code", "folder", "says"),
    [
        (5, "no/such/folder", "no/such"),
        (5, "split.log", "no folder"),
        (5, "/proc/apart", "/proc"),
        (2, "map.png", "map.png"),
    ],
)
def test_a_folder_that_cannot_be_is_refused_first(fails, split_log, code, folder, says):
    fails(code, *split_log[:-1], folder, says=says)


def test_an_output_that_could_be_a_fragment_is_refused(fails, split_log, tmp_path):
    (tmp_path / "apart").mkdir()
    fails(2, *split_log, "--trajectory", "apart/fragment_1.tum", says="fragment_1.tum")
    fails(2, *split_log[:-1], ".", "--trajectory", "fragment_1.tum", says="fragment_1.tum")


def test_a_full_disk_leaves_no_fragments_and_no_folder(fails, split_log, tmp_path):
    def set_limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300))

    fails(5, *split_log, preexec_fn=set_limit)
    assert not (tmp_path / "apart").exists()
