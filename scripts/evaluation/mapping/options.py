# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of commands that run the mapper on whole logs, and the mapper that they ask for."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from evaluation.common.command_line import (
    add_jobs,
    add_json,
    add_method,
    add_passed_on,
    add_program,
    add_seeds,
    add_timeout,
    complain,
)
from evaluation.common.parallel import run_all
from evaluation.simulation.arena_options import add_arena_arguments

from .mapper import Mapper

Result = TypeVar("Result")


def add_mapper_arguments(parser: argparse.ArgumentParser, timeout_s: float = 3600.0) -> None:
    """--cli, --arg, --timeout-s and --json."""
    add_program(parser)
    add_passed_on(parser)
    add_timeout(parser, timeout_s)
    add_json(parser)


def add_walk_arguments(parser: argparse.ArgumentParser, seeds: str) -> None:
    """The options of commands that simulate a log for each seed and map it."""
    add_seeds(parser, seeds)
    add_jobs(parser, "logs")
    parser.add_argument(
        "--logs", type=Path, metavar="DIR", help="write the logs, with true poses, and these alone as TUM"
    )
    add_mapper_arguments(parser)


def add_arena_runs(parser: argparse.ArgumentParser, written: str) -> None:
    """The options of commands that map an arena for each seed; `written` says what --json holds."""
    add_seeds(parser, "0-39", of="seeds of the arenas, ")
    add_program(parser)
    add_method(parser)
    add_passed_on(parser)
    add_jobs(parser, "arenas")
    add_timeout(parser, 300.0)
    add_json(parser, written)
    add_arena_arguments(parser)


def arena_mapper(arguments: argparse.Namespace, *more: str) -> Mapper:
    return Mapper(arguments.cli, (*more, "--method", arguments.method, *arguments.arg), arguments.timeout_s)


def run_arenas(module: str, run: Callable[..., Result], arguments: argparse.Namespace) -> list[Result]:
    """What `run(seed, arguments)` gives for each seed. Wrong usage for options that no arena can be made with."""
    try:
        return run_all(run, [(seed, arguments) for seed in arguments.seeds], arguments.jobs)
    except ValueError as error:
        complain(module, str(error))
        raise SystemExit(2) from None


def mapper_from(arguments: argparse.Namespace) -> Mapper:
    return Mapper(arguments.cli.resolve(), tuple(arguments.arg), arguments.timeout_s)
