# SPDX-License-Identifier: GPL-3.0-or-later
"""Map logs with shapemap-cli and put all maps into one picture."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from evaluation.common.argument_types import number
from evaluation.common.command_line import add_logs, add_passed_on, add_program, command_parser, complain
from evaluation.common.programs import Failure, run_quietly
from evaluation.common.project import found_log

EXAMPLE = """example:
  SHAPEMAP_DATASETS=logs scripts/evaluate.py gallery carmen/intel-corrected.log.gz slam-benchmark/aces.clf.gz \\
      --out maps.png

Exit status: 0 all logs were mapped, 1 some were not and are left out, 2 wrong usage."""


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add_logs(parser)
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="picture to write")
    parser.add_argument("--columns", type=number(1, 1000, int), default=3, metavar="N", help="(default %(default)s)")
    add_program(parser)
    add_passed_on(parser)
    return parser.parse_args(argv)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    from evaluation.figures.gallery import draw, read_pgm  # matplotlib only when there is something to draw

    maps = {}
    for log in map(found_log, arguments.logs):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "map.pgm"
            try:
                run_quietly([arguments.cli.resolve(), log, "--out", out, "--quiet", *arguments.arg])
            except Failure as failure:
                complain(__name__, f"{log}: {failure}")
                continue
            maps[log.name.split(".")[0]] = read_pgm(out)
    if maps:
        draw(maps, arguments.columns, arguments.out)
    return 0 if len(maps) == len(arguments.logs) else 1
