# SPDX-License-Identifier: GPL-3.0-or-later
"""All fitted weights and tolerances of the mapper as tables in Markdown, with what each was fitted to."""

from __future__ import annotations

import argparse
from pathlib import Path

from evaluation.common.command_line import add_program, command_parser, complain
from evaluation.common.files import write_whole
from evaluation.common.programs import Failure
from evaluation.mapping.numbers import numbers_of, page

EXAMPLE = """example:
  scripts/evaluate.py numbers --out docs/numbers.md

Exit status: 0 done, 1 the program does not tell its numbers or the page cannot be written, 2 wrong usage."""


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    parser.add_argument("--out", type=Path, metavar="FILE", help="page to write (default: print it)")
    add_program(parser)
    return parser.parse_args(argv)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        text = page(numbers_of(arguments.cli.resolve()))
        if arguments.out:
            write_whole(arguments.out, text)
        else:
            print(text, end="")
    except (Failure, OSError) as error:
        complain(__name__, str(error))
        return 1
    return 0
