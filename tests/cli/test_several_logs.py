# SPDX-License-Identifier: GPL-3.0-or-later
"""Several logs, one map: what each gets, what is said of it, and what is refused."""

import json
import math

import pytest
import synthetic_log


def walk(first, last, first_s=1.0):
    """A part of the way through the room, as a log of its own whose times begin anew."""
    poses = synthetic_log.path(last)[first:]
    return "".join(synthetic_log.flaser(synthetic_log.scan(p), first_s + i) for i, p in enumerate(poses))


def read_tum(path):
    rows = [[float(v) for v in line.split()] for line in path.read_text().splitlines()]
    return [(row[0], row[1], row[2], 2 * math.atan2(row[6], row[7])) for row in rows]


@pytest.fixture
def robots(run, tmp_path):
    """Two robots in the same room at the same times: one log is CARMEN, the other a rawlog."""
    (tmp_path / "robot1.log").write_text(walk(0, 9))
    (tmp_path / "robot2.log").write_text(walk(4, 14))
    assert run("convert", "robot2.log", "robot2.rawlog").returncode == 0
    (tmp_path / "robot2.log").unlink()
    return "robot1.log", "robot2.rawlog"


def test_two_robots_make_one_map(run, robots, tmp_path, files_of):
    before = set(files_of())
    result = run(
        *[*robots, "--out", "map.png", "--trajectory", "map.tum", "--motions", "map.motions", "--report", "r.json"],
        *["--carmen-out", "map.log.gz", "--rawlog-out", "all.rawlog", "--trace", "trace.jsonl"],
    )
    assert result.returncode == 0, result.stderr
    per_log = [
        f"{stem}.{robot}.{end}"
        for robot in ("robot1", "robot2")
        for stem, end in (("map", "tum"), ("map", "motions"), ("map", "log.gz"), ("all", "rawlog"))
    ]
    assert set(files_of()) - before == {"map.png", "map.yaml", "r.json", "trace.jsonl", *per_log}
    assert "robot1.log: placed 9 of 9 positions" in result.stderr
    assert "robot2.rawlog: placed 10 of 10 positions" in result.stderr

    truth = synthetic_log.path(14)
    one, two = read_tum(tmp_path / "map.robot1.tum"), read_tum(tmp_path / "map.robot2.tum")
    assert [row[0] for row in one] == [1.0 + i for i in range(9)]
    assert [row[0] for row in two] == [1.0 + i for i in range(10)], "times of the two logs are the same"
    heading = truth[0][2] - one[0][3]
    for row, (x, y, theta) in zip(one + two, truth[:9] + truth[4:], strict=True):
        dx, dy = row[1] - one[0][1], row[2] - one[0][2]
        in_room = (
            truth[0][0] + math.cos(heading) * dx - math.sin(heading) * dy,
            truth[0][1] + math.sin(heading) * dx + math.cos(heading) * dy,
        )
        assert math.dist(in_room, (x, y)) < 0.05
        assert abs(math.remainder(row[3] + heading - theta, 2 * math.pi)) < math.radians(1)
    for robot, count in (("robot1", 9), ("robot2", 10)):
        lines = [line for line in (tmp_path / f"map.{robot}.motions").read_text().splitlines() if line[0] != "#"]
        assert len(lines) == count
        assert lines[0].split()[1:] == ["0"] * 9, "the first motion of each log is none"
        again = run(f"all.{robot}.rawlog", "--out", f"{robot}.png", "--quiet")
        assert again.returncode == 0, again.stderr


def test_the_report_and_the_trace_tell_which_position_is_whose(run, robots, tmp_path):
    result = run(*robots, "--out", "map.png", "--skip", 1, "--every", 2, "--report", "r.json", "--trace", "t.jsonl")
    assert result.returncode in (0, 4), result.stderr
    report = json.loads((tmp_path / "r.json").read_text())
    logs = report["logs"]
    assert [(log["path"], log["format"]) for log in logs] == [("robot1.log", "carmen"), ("robot2.rawlog", "rawlog")]
    assert [(log["first_index"], log["num_scans"]) for log in logs] == [(0, 4), (4, 5)], "each is selected from"
    positions = report["scans"]
    assert [p["log"] for p in positions] == [0] * 4 + [1] * 5
    assert [p["index_in_whole_log"] for p in positions] == [1, 3, 5, 7, 1, 3, 5, 7, 9]
    assert [p["index"] for p in positions] == list(range(9))
    assert positions[4]["alignment"] is None, "nothing is before the first position of a log"
    for fragment in report["components"]:
        assert sum(log["num_scans"] for log in fragment["logs"]) == fragment["num_scans"]
    records = [json.loads(line) for line in (tmp_path / "t.jsonl").read_text().splitlines()]
    assert records[0]["log"] == "robot1.log"
    assert records[0]["logs"] == [{"path": log["path"], "first_index": log["first_index"]} for log in logs]
    traced = [record for record in records if record["record"] == "position"]
    places = [(p["log"], p["index_in_whole_log"]) for p in positions]
    assert [(record["log"], record["index_in_whole_log"]) for record in traced] == places


def test_messages_say_whose_position_it_is(run, room_log, tmp_path):
    (tmp_path / "blind.log").write_text(walk(0, 9) + synthetic_log.flaser([81.83] * 181, 50.0))
    result = run("room.log", "blind.log", "--out", "map.png")
    assert result.returncode == 4
    assert "position 9 of blind.log not placed: only 0 shape points" in result.stderr
    assert "of room.log not placed" not in result.stderr


def test_a_log_of_another_place_stays_apart(run, room_log, repository, tmp_path):
    """The room and the arena have nothing in common: nothing may tie them."""
    arena = repository / "datasets" / "nist_arena.rawlog"
    result = run(arena, "room.log", "--out", "map.png", "--trajectory", "t.tum", "--fragments", "apart", "--verbose")
    assert result.returncode == 4, result.stderr
    assert "room.log: nothing ties it to the map, none of 12 positions placed" in result.stderr
    assert "is apart from the map: 12 positions, position 0 of room.log to position 11 of room.log" in result.stderr
    assert len(read_tum(tmp_path / "t.nist_arena.tum")) == 16
    assert (tmp_path / "t.room.tum").read_text() == ""
    assert [p.name for p in sorted((tmp_path / "apart").iterdir())] == [
        "fragment_1.png",
        "fragment_1.room.tum",
        "fragment_1.yaml",
    ]


def test_logs_of_one_name_get_outputs_of_two(run, room_text, tmp_path):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "run.log").write_text(room_text)
    result = run("a/run.log", "--carmen", "b/run.log", "--out", "map.png", "--trajectory", "x.y/../t")
    assert result.returncode == 5, "there is no folder x.y"
    result = run("a/run.log", "--carmen", "b/run.log", "--out", "map.png", "--trajectory", "t", "--quiet")
    assert result.returncode == 0, result.stderr
    assert result.stderr == "" == result.stdout
    assert (tmp_path / "t.run").exists() and (tmp_path / "t.run-2").exists()


def test_one_log_keeps_the_exact_names(run, room_log, files_of):
    assert run("room.log", "--out", "map.png", "--trajectory", "map.tum").returncode == 0
    assert files_of() == ["map.png", "map.tum", "map.yaml", "room.log"]


def test_the_order_of_flags_is_the_order_of_logs(run, robots, tmp_path):
    """However a log is named, the map has the frame of the first one."""
    one, two = robots
    for arguments in (
        ["--carmen", one, two, "--out", "x.png", "--force"],
        [one, "--rawlog", two, "--out", "x.png", "--force"],
        ["--out", "x.png", one, "--force", "--rawlog", two],
    ):
        result = run(*arguments, "--report", "-")
        assert result.returncode == 0, result.stderr
        assert [log["path"] for log in json.loads(result.stdout)["logs"]] == list(robots)


@pytest.mark.parametrize(
    ("code", "arguments", "says"),
    [
        (2, ["room.log", "room.log"], "given twice"),
        (2, ["room.log", "link.log"], ["'link.log' is given twice", "also as 'room.log'"]),
        (2, ["room.log", "--carmen", "./room.log"], "given twice"),
        (2, ["room.log", "--demo"], "not both"),
        (2, ["room.log", "other.log", "--method", "paper"], "--method robust"),
        (2, ["room.log", "other.log", "--trajectory", "-"], ["--trajectory '-'", "several logs"]),
        (2, ["room.log", "other.log", "--motions", "/dev/null"], "--motions '/dev/null'"),
        (2, ["room.log", "other.log", "--trajectory", "t.tum", "--report", "t.other.tum"], "t.other.tum"),
        (2, ["room.log", "other.log", "--carmen-out", "x.log", "--report", "other.log", "--force"], "other.log"),
        (2, ["room.log", "short.log", "--skip", "5"], ["short.log: --skip 5", "3 positions"]),
        (3, ["room.log", "missing.log"], "missing.log"),
        (3, ["room.log", "junk.log"], "junk.log"),
        (3, ["room.log", "."], "."),
        (3, ["blind.log", "blind2.log"], ["'blind.log' and 1 more", "none of their 2 positions"]),
        (5, ["room.log", "other.log", "--trajectory", "old.tum"], ["old.other.tum", "--force"]),
    ],
)
def test_what_is_wrong_with_one_of_them_is_told(fails, room_log, room_text, tmp_path, code, arguments, says):
    (tmp_path / "other.log").write_text(room_text)
    (tmp_path / "short.log").write_text(walk(0, 3))
    (tmp_path / "junk.log").write_bytes(bytes(range(256)) * 8)
    (tmp_path / "link.log").symlink_to("room.log")
    (tmp_path / "old.other.tum").write_text("mine")
    for name in ("blind.log", "blind2.log"):
        (tmp_path / name).write_text(synthetic_log.flaser([81.83] * 181, 1.0))
    fails(code, *arguments, "--out", "map.png", says=says)
    assert (tmp_path / "old.other.tum").read_text() == "mine"
