# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of commands that run the mapper on whole logs."""

from __future__ import annotations

import argparse

from evaluation.common.command_line import add_json, add_passed_on, add_program, add_timeout

from .mapper import Mapper


def add_mapper_arguments(parser: argparse.ArgumentParser, timeout_s: float = 3600.0) -> None:
    """--cli, --arg, --timeout-s and --json."""
    add_program(parser)
    add_passed_on(parser)
    add_timeout(parser, timeout_s)
    add_json(parser)


def mapper_from(arguments: argparse.Namespace) -> Mapper:
    return Mapper(arguments.cli.resolve(), tuple(arguments.arg), arguments.timeout_s)
