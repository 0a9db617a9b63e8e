#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Map logs with shapemap-cli, which gets them without poses, and check each loop that it closes against the reference
poses of the log."""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tqdm import tqdm

from evaluation.datasets import DatasetError
from evaluation.logs import EvaluationLog
from evaluation.loop_check import FALSE, IMPRECISE, CheckedLoop, Limits, check_loops, describe, num_of, table
from evaluation.mapping import Mapper
from evaluation.programs import Failure
from evaluation.selection import add_mapper_arguments, mapper_from, parse_with_logs, parser_for_logs, selected_logs
from shapemap_sim.write import write_whole
from simulate_arena import number

EXAMPLE = """Most references are good to 5 to 10 cm, and wrong in places. Of a loop that is not right, the share of the
points that lie on points of the other scan is told as well, at the pose of the loop and at that of the reference. A log
that is named by its path needs reference poses in it, not odometry.

example:
  SHAPEMAP_DATASETS=logs scripts/check_loops.py --only intel,orebro,csail --json results/loops.json
  scripts/check_loops.py logs/intel-corrected.log.gz --false-m 0.5 --arg=--loop-likely-places --arg=12

Exit status: 0 no loop is false, 1 one is, or a log is missing, gave no map or has no reference, 2 wrong usage,
3 malformed data sets or logs (nothing was run)."""


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = parser_for_logs(__doc__, EXAMPLE)
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


def complain(text: str) -> None:
    tqdm.write(f"check_loops.py: {text}", file=sys.stderr)


def checked_loops(log: EvaluationLog, mapper: Mapper, limits: Limits) -> list[CheckedLoop]:
    """Raises Failure."""
    with tempfile.TemporaryDirectory(prefix="loops_") as folder:
        report, _ = mapper.run([log.write_stripped(Path(folder))], Path(folder))
    return check_loops(log, report, limits)


def as_json(checked: dict[str, list[CheckedLoop]], arguments: argparse.Namespace) -> str:
    """Errors that are no numbers become null: JSON has no NaN."""

    def fields(loop: CheckedLoop) -> dict[str, Any]:
        items = asdict(loop).items()
        return {key: None if isinstance(value, float) and not math.isfinite(value) else value for key, value in items}

    content = {
        "limits": asdict(arguments.limits),
        "arguments": arguments.arg,
        "logs": {name: [fields(loop) for loop in loops] for name, loops in checked.items()},
    }
    return json.dumps(content, indent=1) + "\n"


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    checked: dict[str, list[CheckedLoop]] = {}
    try:
        logs, num_faults = selected_logs(arguments, complain)
    except (DatasetError, OSError) as error:
        complain(str(error))
        return 3
    for log in tqdm(logs, desc="mapping", disable=None, leave=False):
        if log.reference is None:
            complain(f"SKIPPED {log.name}, no reference poses")
            num_faults += 1
            continue
        try:
            checked[log.name] = checked_loops(log, mapper_from(arguments), arguments.limits)
        except Failure as failure:
            complain(f"{log.name}: {failure}")
            num_faults += 1
    if checked:
        print(table(checked))
    listed = (FALSE, IMPRECISE) if arguments.list_imprecise else (FALSE,)
    for name, loops in checked.items():
        for loop in loops:
            if loop.verdict in listed:
                print(describe(name, loop))
    if arguments.json:
        write_whole(arguments.json, as_json(checked, arguments))
    num_false = sum(num_of(loops, FALSE) for loops in checked.values())
    return 1 if num_false or num_faults or not checked else 0


if __name__ == "__main__":
    sys.exit(main())
