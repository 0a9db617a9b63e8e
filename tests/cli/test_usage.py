# SPDX-License-Identifier: GPL-3.0-or-later
"""What is typed: help, flags and the options file."""

import re
import subprocess
import tomllib

import pytest


def options_of(text):
    return tomllib.loads(text)


@pytest.mark.parametrize("command", [[], ["info"], ["convert"], ["align"]])
def test_help_has_groups_examples_and_exit_codes(run, command):
    result = run(*command, "--help")
    assert result.returncode == 0
    assert result.stderr == ""
    assert "Examples:" in result.stdout
    assert "Exit codes:" in result.stdout
    assert "--sensor-label" in result.stdout


@pytest.mark.parametrize("arguments", [["--help"], ["info", "--help"], ["--version"], ["--dump-config"]])
def test_text_that_cannot_be_printed_is_a_failure(cli_path, arguments):
    with open("/dev/full", "w") as full:
        result = subprocess.run([cli_path, *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
    assert result.returncode == 5
    assert result.stderr == "shapemap-cli: cannot write to standard output: No space left on device\n"


def test_help_tells_range_and_default_of_every_option(run):
    text = re.sub(r"\s+", " ", run("--help").stdout)
    for name, value in options_of(run("--dump-config").stdout).items():
        if isinstance(value, bool):
            typed = f"--{name}" if value else f"--no-{name}"
        else:
            typed = f"--{name} {value if value != '' else chr(39) * 2}"
        assert f"default: {typed}" in text or isinstance(value, float), name
        assert f"default: --{name}" in text or f"default: --no-{name}" in text, name
    assert "(0.001 to 10; default: --resolution-m 0.05)" in text


def test_version_names_what_it_is_built_on(run):
    result = run("--version")
    assert result.returncode == 0
    assert re.match(r"shapemap-cli \d+\.\d+\.\d+\n", result.stdout)
    for name in ("MRPT", "OpenCV", "CGAL", "Eigen"):
        assert name in result.stdout


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["room.log"],
        ["--out", "map.png"],
        ["room.log", "--out", "map.jpg"],
        ["room.log", "--out", "map"],
        ["room.log", "--out", ".png"],
        ["room.log", "--out", "folder/.png"],
        ["room.log", "./room.log", "--out", "map.png"],
        ["room.log", "--carmen", "room.log", "--out", "map.png"],
        ["[room.log]", "--out", "map.png"],
        ["room.log", "--demo", "--out", "map.png"],
        ["room.log", "--out", "map.png", "--no-such-option"],
        ["room.log", "--out", "map.png", "--method", "guess"],
        ["room.log", "--out", "map.png", "--threads", "-1"],
        ["room.log", "--out", "map.png", "--threads", "two"],
        ["room.log", "--out", "map.png", "--threads", "1.5"],
        ["room.log", "--out", "map.png", "--resolution-m", "nan"],
        ["room.log", "--out", "map.png", "--resolution-m", "0.05x"],
        ["room.log", "--out", "map.png", "--max-mount-tilt-deg", "90"],
        ["room.log", "--out", "map.png", "--quiet", "--verbose"],
        ["room.log", "--out", "map.png", "--skip", "12"],
        ["room.log", "--out", "map.png", "--trajectory", "./map.png"],
        ["room.log", "--out", "map.png", "--report", "map.yaml"],
        ["room.log", "--out", "map.png", "--carmen-out", "room.log", "--force"],
        ["info"],
        ["convert", "room.log"],
        ["convert", "room.log", "room.unknown"],
        ["convert", "room.log", "room.rawlog", "--to", "bag"],
    ],
)
def test_wrong_usage_is_one_line_and_code_2(fails, room_log, arguments):
    fails(2, *arguments)


def test_messages_name_option_value_and_range(fails, room_log):
    fails(2, room_log, "--out", "map.png", "--resolution-m", "11", says=["--resolution-m", "'11'", "0.001 to 10"])
    fails(2, room_log, "--out", "map.png", "--method", "guess", says=["--method", "guess", "paper"])


def test_options_file_round_trips(run, tmp_path):
    first = run("--dump-config")
    assert first.returncode == 0
    assert first.stderr == ""
    (tmp_path / "a.toml").write_text(first.stdout)
    assert run("--config", "a.toml", "--dump-config").stdout == first.stdout


def test_options_file_round_trips_after_every_change(run, tmp_path):
    label = 'odd "#name", \\ [x] = é\t'
    arguments = ["--sensor-label", label, "--resolution-m", "0.0123456789012345", "--fov-deg", "100.1"]
    arguments += ["--draw-path", "--max-mount-tilt-deg", "12.3456789"]
    arguments += ["--sub-scan-turn-deg", "-90.7", "--range-unit", "cm"]
    text = run(*arguments, "--dump-config").stdout
    (tmp_path / "b.toml").write_text(text)
    assert run("--config", "b.toml", "--dump-config").stdout == text
    values = options_of(text)
    assert values["sensor-label"] == label
    assert values["resolution-m"] == 0.0123456789012345
    assert values["fov-deg"] == 100.1
    assert values["max-mount-tilt-deg"] == 12.3456789
    assert values["sub-scan-turn-deg"] == -90.7
    assert values["draw-path"] is True
    assert values["range-unit"] == "cm"


def test_names_that_options_had_before_are_accepted_and_not_shown(run, tmp_path):
    assert options_of(run("--settle-at", 5, "--dump-config").stdout)["cull-at"] == 5
    (tmp_path / "old.toml").write_text("settle-at = 7\n")
    assert options_of(run("--config", "old.toml", "--dump-config").stdout)["cull-at"] == 7
    both = run("--settle-at", 5, "--cull-at", 6, "--dump-config")
    assert both.returncode == 2
    assert "--cull-at" in both.stderr
    (tmp_path / "twice.toml").write_text("settle-at = 7\ncull-at = 8\n")
    twice = run("--config", "twice.toml", "--dump-config")
    assert twice.returncode == 2
    assert "twice.toml:2" in twice.stderr
    help_text = run("--help").stdout
    assert "--cull-at" in help_text
    assert "settle-at" not in help_text


def test_any_angle_in_degrees_comes_back_as_it_was_typed(run):
    options = ("--fov-deg", "--max-mount-tilt-deg", "--sub-scan-turn-deg")
    for i in range(12):
        typed = f"{0.1 + i * 7.3:.6g}"
        text = run(*(word for option in options for word in (option, typed)), "--dump-config").stdout
        for option in options:
            assert f"\n{option[2:]} = {typed}\n" in text


def test_strict_paper_first_then_file_then_flags(run, tmp_path):
    strict = options_of(run("--strict-paper", "--dump-config").stdout)
    default = options_of(run("--dump-config").stdout)
    assert strict != default, "the literal readings are not all the defaults"
    name = next(n for n in strict if strict[n] != default[n])
    value = str(default[name]).lower() if isinstance(default[name], bool) else repr(default[name])
    (tmp_path / "c.toml").write_text(f"{name} = {value}\nthreads = 3\nresolution-m = 0.1 # coarse\n")
    values = options_of(run("--strict-paper", "--config", "c.toml", "--threads", "4", "--dump-config").stdout)
    assert values[name] == default[name]
    assert values["threads"] == 4
    assert values["resolution-m"] == 0.1


def test_a_switch_can_be_turned_off_again(run, tmp_path):
    (tmp_path / "d.toml").write_text("draw-path = true\n")
    assert options_of(run("--config", "d.toml", "--dump-config").stdout)["draw-path"] is True
    assert options_of(run("--config", "d.toml", "--no-draw-path", "--dump-config").stdout)["draw-path"] is False


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("\nno-such-key = 1\n", ["bad.toml:2", "no-such-key"]),
        ("x\n", ["bad.toml:1"]),
        ("threads = 1\nthreads = 2\n", ["bad.toml:2", "threads", "twice"]),
        ("threads = \n", ["bad.toml:1", "threads"]),
        ("threads = '1'\n", ["bad.toml:1", "threads"]),
        ("threads = 1 2\n", ["bad.toml:1", "threads"]),
        ("threads = 1e99\n", ["bad.toml:1", "--threads"]),
        ("sensor-label = left\n", ["bad.toml:1", "sensor-label", "quotes"]),
        ('sensor-label = "left\n', ["bad.toml:1", "quote"]),
        ('sensor-label = "left" right\n', ["bad.toml:1", "sensor-label"]),
        ("draw-path = yes\n", ["bad.toml:1", "--draw-path", "true or false"]),
        ("resolution-m = 1000\n", ["bad.toml:1", "--resolution-m", "0.001 to 10"]),
        ('method = "guess"\n', ["bad.toml:1", "--method", "paper"]),
        ("[map]\nresolution-m = 0.1\n", ["bad.toml:1", "tables"]),
        ("out = 'map.png'\n", ["bad.toml:1", "out"]),
    ],
)
def test_a_bad_options_file_is_refused(fails, room_log, tmp_path, text, says):
    (tmp_path / "bad.toml").write_text(text)
    fails(2, room_log, "--out", "map.png", "--config", "bad.toml", says=says)


def test_a_missing_options_file_is_refused(fails, room_log, tmp_path):
    fails(2, room_log, "--out", "map.png", "--config", "missing.toml", says="missing.toml")
    fails(2, room_log, "--out", "map.png", "--config", ".", says="'.'")
