# SPDX-License-Identifier: GPL-3.0-or-later
"""Map variants of real logs with shapemap-cli: with some of the scans only, reversed, mirrored. Each is a log that
might have been recorded, and tells how much of a good map was luck."""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import asdict, dataclass

from evaluation.common.argument_types import name_list, number
from evaluation.common.command_line import add_jobs, complain
from evaluation.common.files import write_json
from evaluation.common.parallel import run_all
from evaluation.common.tables import table
from evaluation.judging.loops import false_loops
from evaluation.judging.map_score import MapScore, mapped_text
from evaluation.logs.datasets import DatasetError
from evaluation.logs.selection import parse_with_logs, parser_for_logs, selected_variants
from evaluation.logs.variants import KINDS, VariantError, VariedLog, parse_variant
from evaluation.mapping.mapper import Mapper
from evaluation.mapping.options import add_mapper_arguments, mapper_from

EXAMPLE = f"""variants, several of which are joined by +:
  {KINDS}

A map is right when all scans are placed and the root mean square of their errors, after the planar motion that fits
best, is below the limit; in pieces when some are not placed and the others are so near; else wrong. A loop is false
when it is off by more than 1 m or 10 degrees.

example:
  scripts/evaluate.py variants --only aces,csail --variants every-2-0,every-2-1,drop-30-1,reversed

Exit status: 0 all runs gave a map, 1 some did not or a log is missing, 2 wrong usage, 3 malformed data sets or logs."""
DEFAULT = "whole,reversed,mirrored,every-2-0,every-2-1,drop-30-0,drop-30-1"
HEAD = ("log", "scans", "placed", "right pairs", "loops", "false", "ATE", "worst", "CPU", "map")
VERDICTS = ("right", "in pieces", "wrong", "no map")


@dataclass(frozen=True)
class Outcome:
    """What became of one variant. `num_false` counts the loops that are false."""

    log: str
    num_false: int
    score: MapScore

    def verdict(self, limit_m: float) -> str:
        if self.score.fault:
            return "no map"
        if not self.score.ate_m <= limit_m:
            return "wrong"
        return "right" if self.score.num_placed == self.score.num_scans else "in pieces"


def run(log: VariedLog, mapper: Mapper) -> Outcome:
    score, report = mapped_text(log.text, ".log", log.reference, mapper)
    return Outcome(log.name, false_loops(report, log.reference) if report else 0, score)


def row(one: Outcome, limit_m: float) -> list[object]:
    score = one.score
    cells: list[object] = [one.log, score.num_scans]
    if score.fault:
        return [*cells, *[""] * (len(HEAD) - 3), f"no map: {score.fault}"]
    cells += [score.num_placed, score.right_pairs, score.num_loops, one.num_false, *score.errors]
    return [*cells, f"{score.cpu_s:.1f} s", one.verdict(limit_m)]


def summary(outcomes: list[Outcome], limit_m: float) -> str:
    counts = Counter(one.verdict(limit_m) for one in outcomes)
    listed = ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS)
    num_pairs = sum(one.score.num_scans - 1 for one in outcomes)
    share = sum(one.score.num_right for one in outcomes) / max(1, num_pairs)
    return f"{len(outcomes)} maps: {listed}; {100 * share:.2f} % of all pairs right"


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = parser_for_logs(__name__, __doc__, EXAMPLE)
    add = parser.add_argument
    add("--variants", type=name_list, default=name_list(DEFAULT), metavar="LIST", help="default %(default)s")
    add("--limit-m", type=number(0, 1000), default=0.25, metavar="M", help="of a right map (default %(default)g)")
    add_jobs(parser, "logs")
    add_mapper_arguments(parser)
    arguments = parse_with_logs(parser, argv)
    try:
        for variant in arguments.variants:
            parse_variant(variant)
    except VariantError as error:
        parser.error(str(error))
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        wanted, num_missing = selected_variants(__name__, arguments)
    except (DatasetError, OSError) as error:
        complain(__name__, str(error))
        return 3
    mapper = mapper_from(arguments)
    outcomes = run_all(run, [(log, mapper) for log in wanted], arguments.jobs)
    print(table(HEAD, [row(one, arguments.limit_m) for one in outcomes]))
    print(f"\n{summary(outcomes, arguments.limit_m)}")
    if arguments.json:
        runs = [{"log": one.log, "num_false": one.num_false, **asdict(one.score)} for one in outcomes]
        write_json(arguments.json, {"arguments": arguments.arg, "runs": runs})
    return 1 if num_missing or any(one.score.fault for one in outcomes) else 0
