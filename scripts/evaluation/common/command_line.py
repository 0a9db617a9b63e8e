# SPDX-License-Identifier: GPL-3.0-or-later
"""What the commands of scripts/evaluate.py have in common: how they name themselves, complain and take options.

A command is a module, and says which by its `__name__`: `evaluation.commands.arena_maps` is `evaluate.py arena-maps`.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from .argument_types import number, parse_seeds
from .project import BIN

METHODS = ("robust", "paper")


def command_name(module: str) -> str:
    return f"evaluate.py {module.rpartition('.')[2].replace('_', '-')}"


def command_parser(module: str, description: str | None, epilog: str) -> argparse.ArgumentParser:
    """A parser that shows description and epilog as they are written."""
    return argparse.ArgumentParser(
        prog=command_name(module),
        description=description,
        epilog=epilog,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def complain(module: str, text: str) -> None:
    """A line on standard error, above a progress bar if there is one."""
    from tqdm import tqdm

    tqdm.write(f"{command_name(module)}: {text}", file=sys.stderr)


def add_program(parser: argparse.ArgumentParser, what: str = "the mapper") -> None:
    """--cli, the program that is judged."""
    parser.add_argument(
        "--cli",
        type=Path,
        default=BIN / "shapemap-cli",
        metavar="FILE",
        help=f"{what} (default build/release/bin/shapemap-cli)",
    )


def runnable(parser: argparse.ArgumentParser, path: Path, what: str) -> Path:
    """The absolute path of a program, as a bare name would be looked up elsewhere. Wrong usage if it cannot be run."""
    if not os.access(path, os.X_OK) or path.is_dir():
        parser.error(f"{what}: {path} is not a program; build it with `cmake --build --preset release`")
    return path.resolve()


def require_program(parser: argparse.ArgumentParser, arguments: argparse.Namespace) -> None:
    """Makes --cli absolute. Wrong usage unless it can be run."""
    arguments.cli = runnable(parser, arguments.cli, "--cli")


def add_passed_on(parser: argparse.ArgumentParser) -> None:
    """--arg, for options of the program that is run."""
    parser.add_argument(
        "--arg",
        action="append",
        default=[],
        metavar="ARG",
        help="passed on to the mapper; repeat for more, such as --arg=--max-shift-m --arg=3",
    )


def add_method(parser: argparse.ArgumentParser, default: str = "robust", more: str = "") -> None:
    text = f"of alignment{more} (default %(default)s)"
    parser.add_argument("--method", choices=METHODS, default=default, help=text)


def add_jobs(parser: argparse.ArgumentParser, what: str, default: int = 2) -> None:
    """--jobs; `what` is done at the same time."""
    text = f"{what} at the same time (default %(default)s)"
    parser.add_argument("--jobs", type=number(1, 256, int), default=default, metavar="N", help=text)


def add_timeout(parser: argparse.ArgumentParser, default_s: float) -> None:
    text = "the longest that one run may take (default %(default)g)"
    parser.add_argument("--timeout-s", type=number(0.1, 10**6), default=default_s, metavar="S", help=text)


def add_seeds(parser: argparse.ArgumentParser, default: str, option: str = "--seeds", of: str = "") -> None:
    """A list or range of seeds; an empty default is none."""
    seeds = parse_seeds(default) if default else []
    text = f"{of}such as 0-39 or 1,5,8 (default {default or 'none'})"
    parser.add_argument(option, type=parse_seeds, default=seeds, metavar="LIST", help=text)


def add_json(parser: argparse.ArgumentParser, what: str = "all that was found") -> None:
    parser.add_argument("--json", type=Path, metavar="FILE", help=f"write {what}")


def add_logs(parser: argparse.ArgumentParser) -> None:
    """LOG ..., at least one; each is looked up by `found_log`."""
    parser.add_argument("logs", nargs="+", type=Path, metavar="LOG", help="path, or path below SHAPEMAP_DATASETS")
