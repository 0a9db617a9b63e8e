# SPDX-License-Identifier: GPL-3.0-or-later
import os
import pathlib
import subprocess
import sys

import pytest

sys.path.insert(0, os.path.dirname(__file__))
import synthetic_log


def program_path(variable, name):
    path = os.environ.get(variable)
    if not path:
        pytest.fail(f"set {variable} to the path of {name}")
    return path


def runner(path, folder):
    """Runs a program in the test's own folder."""

    def run_program(*arguments, **keywords):
        command = [path, *map(str, arguments)]
        return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300, **keywords)

    return run_program


def failing(run_program, name, files_of):
    """Checks that a run fails with one line and leaves nothing behind."""

    def check(code, *arguments, says=(), **keywords):
        before = files_of()
        result = run_program(*arguments, **keywords)
        assert result.returncode == code, result.stderr
        assert result.stdout == ""
        lines = result.stderr.splitlines()
        assert len(lines) == 1, result.stderr
        assert lines[0].startswith(f"{name}: ")
        for word in [says] if isinstance(says, str) else says:
            assert word in lines[0]
        assert files_of() == before
        return lines[0]

    return check


@pytest.fixture(scope="session")
def cli_path():
    return program_path("SHAPEMAP_CLI", "shapemap-cli")


@pytest.fixture(scope="session")
def baselines_path():
    return program_path("SHAPEMAP_BASELINES", "shapemap-baselines")


@pytest.fixture
def run(cli_path, tmp_path):
    return runner(cli_path, tmp_path)


@pytest.fixture
def run_baselines(baselines_path, tmp_path):
    return runner(baselines_path, tmp_path)


@pytest.fixture(scope="session")
def room_text():
    return synthetic_log.carmen_log()


@pytest.fixture
def room_log(tmp_path, room_text):
    path = tmp_path / "room.log"
    path.write_text(room_text)
    return path


@pytest.fixture
def files_of(tmp_path):
    """Names of all files in the test's folder, hidden and temporary ones too."""
    return lambda: sorted(str(p.relative_to(tmp_path)) for p in tmp_path.rglob("*") if not p.is_dir())


@pytest.fixture
def fails(run, files_of):
    return failing(run, "shapemap-cli", files_of)


@pytest.fixture
def baselines_fail(run_baselines, files_of):
    return failing(run_baselines, "shapemap-baselines", files_of)


@pytest.fixture(scope="session")
def repository():
    return pathlib.Path(__file__).resolve().parents[2]
