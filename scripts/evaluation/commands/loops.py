# SPDX-License-Identifier: GPL-3.0-or-later
"""Map logs with shapemap-cli, which gets them without poses, and check each loop that it closes against the reference
poses of the log."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from tqdm import tqdm

from evaluation.common.argument_types import number
from evaluation.common.command_line import complain
from evaluation.common.files import write_json
from evaluation.common.programs import Failure
from evaluation.judging.loops import FALSE, IMPRECISE, CheckedLoop, Limits, check_loops, describe, num_of, table
from evaluation.logs.datasets import DatasetError
from evaluation.logs.evaluation_log import EvaluationLog
from evaluation.logs.selection import parse_with_logs, parser_for_logs, selected_logs
from evaluation.mapping.mapper import Mapper
from evaluation.mapping.options import add_mapper_arguments, mapper_from

EXAMPLE = """Most references are good to 5 to 10 cm, and wrong in places. Of a loop that is not right, the share of the
points that lie on points of the other scan is told as well, at the pose of the loop and at that of the reference. A log
that is named by its path needs reference poses in it, not odometry.

example:
  SHAPEMAP_DATASETS=logs scripts/evaluate.py loops --only intel,orebro,csail --json results/loops.json
  scripts/evaluate.py loops logs/intel-corrected.log.gz --false-m 0.5 --arg=--loop-likely-places --arg=12

Exit status: 0 no loop is false, 1 one is, or a log is missing, gave no map or has no reference, 2 wrong usage,
3 malformed data sets or logs (nothing was run)."""


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = parser_for_logs(__name__, __doc__, EXAMPLE)
    add = parser.add_argument
    limits = Limits()
    for name, default, unit, what in (
        ("--false-m", limits.false_m, "M", "a loop farther off than this is false"),
        ("--false-deg", limits.false_deg, "DEG", "or turned by more"),
        ("--imprecise-m", limits.imprecise_m, "M", "one farther off than this is imprecise"),
        ("--imprecise-deg", limits.imprecise_deg, "DEG", "or turned by more"),
    ):
        add(name, type=number(0, 1000), default=default, metavar=unit, help=f"{what} (default %(default)g)")
    add("--list-imprecise", action="store_true", help="list also those that are imprecise")
    add_mapper_arguments(parser)
    arguments = parse_with_logs(parser, argv)
    arguments.limits = Limits(arguments.false_m, arguments.false_deg, arguments.imprecise_m, arguments.imprecise_deg)
    return arguments


def checked_loops(log: EvaluationLog, mapper: Mapper, limits: Limits) -> list[CheckedLoop]:
    """Raises Failure."""
    with tempfile.TemporaryDirectory(prefix="loops_") as folder:
        report, _ = mapper.run([log.write_stripped(Path(folder))], Path(folder))
    return check_loops(log, report, limits)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    checked: dict[str, list[CheckedLoop]] = {}
    try:
        logs, num_faults = selected_logs(__name__, arguments)
    except (DatasetError, OSError) as error:
        complain(__name__, str(error))
        return 3
    for log in tqdm(logs, desc="mapping", disable=None, leave=False):
        if log.reference is None:
            complain(__name__, f"SKIPPED {log.name}, no reference poses")
            num_faults += 1
            continue
        try:
            checked[log.name] = checked_loops(log, mapper_from(arguments), arguments.limits)
        except Failure as failure:
            complain(__name__, f"{log.name}: {failure}")
            num_faults += 1
    if checked:
        print(table(checked))
    listed = (FALSE, IMPRECISE) if arguments.list_imprecise else (FALSE,)
    for name, loops in checked.items():
        for loop in loops:
            if loop.verdict in listed:
                print(describe(name, loop))
    if arguments.json:
        content = {"limits": arguments.limits, "arguments": arguments.arg, "logs": checked}
        write_json(arguments.json, content)
    num_false = sum(num_of(loops, FALSE) for loops in checked.values())
    return 1 if num_false or num_faults or not checked else 0
