# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs programs with a limit on time, and says what they took or why they failed."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

LAUNCHER = Path(__file__).resolve().parent / "launcher.py"
DONE = (0, 4)  # 4: map written, some positions not placed


class Failure(Exception):  # noqa: N818
    """A run that gave no result; says why."""


@dataclass(frozen=True)
class Usage:
    wall_s: float
    cpu_s: float
    peak_memory_mib: float


def check_program(path: Path) -> None:
    """Raises Failure."""
    if not os.access(path, os.X_OK) or path.is_dir():
        raise Failure(f"no program {path}: is it built?")


@cache
def has_option(program: Path, option: str) -> bool:
    """Whether the program's help knows an option. Raises Failure without a program."""
    check_program(program)
    done = subprocess.run([str(program), "--help"], capture_output=True, text=True, check=False, timeout=60)
    return option in (done.stdout + done.stderr).replace(",", " ").split()


def last_line(text: str) -> str:
    """What a program said last on standard error."""
    return (text.strip().splitlines() or ["no message"])[-1][-400:]


def run_quietly(command: Sequence[object], timeout_s: float | None = None, done: Sequence[int] = DONE) -> str:
    """What a program writes on standard output. Raises Failure with its last line when it ends with another status
    than those of `done`, with the reason when it cannot be started or takes too long."""
    words = [str(word) for word in command]
    try:
        run = subprocess.run(words, capture_output=True, text=True, timeout=timeout_s, check=False)
    except subprocess.TimeoutExpired:
        raise Failure(f"no end after {timeout_s:g} s") from None
    except OSError as error:
        raise Failure(f"could not be started: {error}") from None
    if run.returncode not in done:
        raise Failure(f"exit code {run.returncode}: {last_line(run.stderr)}")
    return run.stdout


def run_measured(
    command: Sequence[object], folder: Path, timeout_s: float, started: Callable[[int], None] | None = None
) -> Usage:
    """Runs a program to its end, in a group of its own that ends with it; `started` gets the process that starts it.
    Raises Failure."""
    check_program(Path(str(command[0])))
    usage_path = folder / "usage.json"
    whole = [sys.executable, "-I", "-S", str(LAUNCHER), str(usage_path), *(str(word) for word in command)]
    with (folder / "stderr.txt").open("w+", encoding="utf-8", errors="replace") as errors:
        process = subprocess.Popen(whole, stdout=subprocess.DEVNULL, stderr=errors, start_new_session=True)
        try:
            if started is not None:
                started(process.pid)
            process.wait(timeout=timeout_s)
        except subprocess.TimeoutExpired:
            raise Failure(f"no end after {timeout_s:g} s") from None
        finally:
            _end_group(process)
        errors.seek(0)
        said = last_line(errors.read())
    if not usage_path.exists():
        raise Failure(f"could not be started: {said}")
    taken = json.loads(usage_path.read_text(encoding="utf-8"))
    code = taken.pop("exit_code")
    if code < 0:
        raise Failure(f"killed by {signal.Signals(-code).name}: {said}")
    if code not in DONE:
        raise Failure(f"exit code {code}: {said}")
    return Usage(**taken)


def _end_group(process: subprocess.Popen[bytes]) -> None:
    """The program and whatever it started, if they still run."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
