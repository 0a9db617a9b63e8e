# SPDX-License-Identifier: GPL-3.0-or-later
"""The one entry: which commands there are, how they are told apart, and what is loaded for each."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib import import_module

import pytest

from evaluation.commands import COMMANDS, main
from evaluation.common.project import PROJECT

NAMES = [name for commands in COMMANDS.values() for name in commands]


def test_every_command_is_listed_once_with_a_line() -> None:
    modules = {path.stem for path in (PROJECT / "scripts/evaluation/commands").glob("*.py")} - {"__init__"}
    assert sorted(NAMES) == sorted(module.replace("_", "-") for module in modules)
    assert all(0 < len(what) <= 90 for commands in COMMANDS.values() for what in commands.values())


def test_help_lists_all_commands_in_their_groups(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for title, commands in COMMANDS.items():
        start = lines.index(f"{title}:") + 1
        listed = [line.split()[0] for line in lines[start : start + len(commands)]]
        assert listed == list(commands)


@pytest.mark.parametrize("name", NAMES)
def test_a_command_shows_its_own_options(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="0"):
        main([name, "--help"])
    shown = capsys.readouterr().out
    assert shown.startswith(f"usage: evaluate.py {name} ")
    assert f"scripts/evaluate.py {name}" in shown, "an example"


@pytest.mark.parametrize(("words", "said"), [([], "no command;"), (["logz"], "no command 'logz'"), (["--x"], "'--x'")])
def test_what_is_no_command_is_wrong_usage(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 2
    told = capsys.readouterr().err
    assert said in told
    assert "expected one of maps, logs, " in told


def test_wrong_options_of_a_command_are_wrong_usage(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["arena", "--seeds", "x"])
    assert "evaluate.py arena: error: argument --seeds: 'x' is not a seed" in capsys.readouterr().err


def test_the_list_of_commands_loads_none_of_them() -> None:
    code = "import sys; from evaluation.commands import main; main(['--help']); print(*sorted(sys.modules))"
    environment = os.environ | {"PYTHONPATH": str(PROJECT / "scripts")}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    loaded = done.stdout.splitlines()[-1].split()
    assert "evaluation.commands" in loaded
    assert not {"numpy", "matplotlib", "tqdm", "evaluation.commands.maps"} & set(loaded)


def test_without_matplotlib_every_command_can_be_loaded() -> None:
    code = "import sys; sys.modules['matplotlib'] = None\nfrom importlib import import_module\n"
    code += f"for name in {NAMES}: import_module('evaluation.commands.' + name.replace('-', '_'))"
    environment = os.environ | {"PYTHONPATH": str(PROJECT / "scripts")}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_the_entry_is_a_program() -> None:
    words = [sys.executable, str(PROJECT / "scripts/evaluate.py"), "logs", "/no/such.log", "--cli", "/bin/false"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr == "evaluate.py logs: such.log: exit code 1: no message\n"
    assert os.access(PROJECT / "scripts/evaluate.py", os.X_OK)


@pytest.mark.parametrize("name", NAMES)
def test_a_command_can_be_run_from_python(name: str) -> None:
    assert callable(import_module(f"evaluation.commands.{name.replace('-', '_')}").main)
