# SPDX-License-Identifier: GPL-3.0-or-later
"""Judge a mapper on real CARMEN logs: is each scan placed right against the scan before it?

The mapper gets the log as it is; it does not read poses (a test of the project proves that). The poses on the FLASER
lines are the reference, good to 5 to 10 cm. A pair of consecutive scans is right when both are in the map and their
relative pose is within 0.20 m and 5 degrees of the reference.
"""

from __future__ import annotations

import argparse

import numpy as np

from evaluation.common.argument_types import number
from evaluation.common.command_line import add_logs, add_method, add_passed_on, add_program, command_parser, complain
from evaluation.common.programs import Failure
from evaluation.common.project import found_log
from evaluation.common.tables import table
from evaluation.judging.consecutive_pairs import LogScore, score_log
from evaluation.mapping.mapper import METHOD_ARGUMENTS

EXAMPLE = """example:
  SHAPEMAP_DATASETS=logs scripts/evaluate.py logs carmen/intel-corrected.log.gz carmen/aces-corrected.log.gz

Exit status: 0 all logs were mapped, 1 some were not, 2 wrong usage."""
HEAD = ("log", "scans", "placed", "right pairs (95 % interval)", "median error", "CPU per scan", "memory")


def row(score: LogScore) -> list[object]:
    cost_ms = 1000 * score.cpu_s / max(1, score.num_scans)
    cells = [score.name, score.num_scans, score.num_placed, score.right, f"{100 * score.median_m:.1f} cm"]
    return [*cells, f"{cost_ms:.0f} ms", f"{score.peak_mib:.0f} MiB"]


def markdown(scores: list[LogScore]) -> str:
    """A row for each log, and the mean of the logs that have pairs."""
    mean = np.mean([score.right.value for score in scores if score.num_pairs])
    return table(HEAD, [*map(row, scores), ["mean", "", "", f"{100 * mean:.1f} %"]])


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add_logs(parser)
    add_program(parser)
    add_method(parser, more=", the paper's with rotations of -90 to 90 degrees")
    add_passed_on(parser)
    parser.add_argument("--every", type=number(1, 10**6, int), default=1, metavar="K", help="use only every K-th scan")
    return parser.parse_args(argv)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    mapper_arguments = METHOD_ARGUMENTS[arguments.method] + arguments.arg
    scores = []
    for log in map(found_log, arguments.logs):
        try:
            scores.append(score_log(log, arguments.cli.resolve(), mapper_arguments, arguments.every))
        except (Failure, OSError, ValueError) as error:
            complain(__name__, str(error))
    if scores:
        print(markdown(scores))
    return 0 if len(scores) == len(arguments.logs) else 1
