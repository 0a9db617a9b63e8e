#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Map variants of real logs with shapemap-cli: with some of the scans only, reversed, mirrored. Each is a log that
might have been recorded, and tells how much of a good map was luck."""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from evaluation.datasets import DatasetError
from evaluation.loop_check import FALSE, Limits
from evaluation.mapping import Mapper, Report, absolute_errors_m, place_in_log, placed_poses, root_mean_square
from evaluation.metrics import pairs
from evaluation.programs import Failure
from evaluation.selection import (
    add_mapper_arguments,
    mapper_from,
    name_list,
    parse_with_logs,
    parser_for_logs,
    selected_logs,
)
from evaluation.variants import KINDS, VariantError, VariedLog, parse_variant, varied
from shapemap_sim.pairs import pose_error, pose_from
from shapemap_sim.poses import Array, compose, inverse
from shapemap_sim.write import without_nan, write_whole
from simulate_arena import number

EXAMPLE = f"""variants, several of which are joined by +:
  {KINDS}

A map is right when all scans are placed and the root mean square of their errors, after the planar motion that fits
best, is below the limit; in pieces when some are not placed and the others are so near; else wrong. A loop is false
when it is off by more than 1 m or 10 degrees.

example:
  scripts/evaluate_variants.py --only aces,csail --variants every-2-0,every-2-1,drop-30-1,reversed

Exit status: 0 all runs gave a map, 1 some did not or a log is missing, 2 wrong usage, 3 malformed data sets or logs."""
DEFAULT = "whole,reversed,mirrored,every-2-0,every-2-1,drop-30-0,drop-30-1"


@dataclass(frozen=True)
class Outcome:
    """Of one variant; `fault`: why there is no map."""

    log: str
    num_scans: int
    num_placed: int = 0
    num_right: int = 0
    ate_m: float = math.nan
    worst_m: float = math.nan
    num_loops: int = 0
    num_false: int = 0
    cpu_s: float = 0.0
    fault: str = ""

    def verdict(self, limit_m: float) -> str:
        if self.fault:
            return "no map"
        if not self.ate_m <= limit_m:
            return "wrong"
        return "right" if self.num_placed == self.num_scans else "in pieces"


def num_false_loops(report: Report, map_from_robot: Array) -> int:
    """Loops that are off the reference poses `[p, 3]` by more than check_loops.py allows."""
    limits = Limits()
    verdicts = []
    for loop in report["loops"]:
        a, b = (place_in_log(report, loop[end])[1] for end in ("a", "b"))
        truth = compose(inverse(map_from_robot[a]), map_from_robot[b])
        verdicts.append(limits.verdict(*pose_error(pose_from(loop["a_from_b"]), truth)))
    return verdicts.count(FALSE)


def run(log: VariedLog, mapper: Mapper) -> Outcome:
    with tempfile.TemporaryDirectory(prefix="variant_") as name:
        path = Path(name) / "log.log"
        path.write_text(log.text, encoding="utf-8")
        try:
            report, usage = mapper.run([path], Path(name))
        except Failure as failure:
            return Outcome(log.name, len(log.reference), fault=str(failure))
    placed = placed_poses(report)
    errors_m = absolute_errors_m(report, [log.reference])
    return Outcome(
        log.name,
        len(log.reference),
        num_placed=len(placed),
        num_right=sum(pairs(log.reference, [placed])["right"]),
        ate_m=root_mean_square(errors_m),
        worst_m=float(np.max(errors_m, initial=0.0)),
        num_loops=len(report["loops"]),
        num_false=num_false_loops(report, log.reference),
        cpu_s=usage.cpu_s,
    )


def table(outcomes: list[Outcome], limit_m: float) -> str:
    lines = [
        "| log | scans | placed | right pairs | loops | false | ATE | worst | CPU | map |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for one in outcomes:
        if one.fault:
            lines.append(f"| {one.log} | {one.num_scans} | | | | | | | | no map: {one.fault} |")
            continue
        lines.append(
            f"| {one.log} | {one.num_scans} | {one.num_placed} | {one.num_right} of {one.num_scans - 1} "
            f"| {one.num_loops} | {one.num_false} | {one.ate_m:.3f} m | {one.worst_m:.2f} m | {one.cpu_s:.1f} s "
            f"| {one.verdict(limit_m)} |"
        )
    counts = Counter(one.verdict(limit_m) for one in outcomes)
    summary = ", ".join(f"{counts[verdict]} {verdict}" for verdict in ("right", "in pieces", "wrong", "no map"))
    share = sum(one.num_right for one in outcomes) / max(1, sum(one.num_scans - 1 for one in outcomes))
    return "\n".join([*lines, "", f"{len(outcomes)} maps: {summary}; {100 * share:.2f} % of all pairs right"])


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = parser_for_logs(__doc__, EXAMPLE)
    add = parser.add_argument
    add("--variants", type=name_list, default=name_list(DEFAULT), metavar="LIST", help="default %(default)s")
    add("--limit-m", type=number(0, 1000), default=0.25, metavar="M", help="of a right map (default %(default)g)")
    add("--jobs", type=number(1, 256, int), default=2, metavar="N", help="logs at the same time (default 2)")
    add_mapper_arguments(parser)
    arguments = parse_with_logs(parser, argv)
    try:
        for variant in arguments.variants:
            parse_variant(variant)
    except VariantError as error:
        parser.error(str(error))
    return arguments


def complain(text: str) -> None:
    print(f"evaluate_variants.py: {text}", file=sys.stderr)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        logs, num_missing = selected_logs(arguments, complain)
        wanted = [varied(log, variant) for log in logs for variant in arguments.variants]
    except (DatasetError, VariantError, OSError) as error:
        complain(str(error))
        return 3
    mapper = mapper_from(arguments)
    with ProcessPoolExecutor(max_workers=arguments.jobs) as pool:
        outcomes = list(pool.map(run, wanted, [mapper] * len(wanted)))
    print(table(outcomes, arguments.limit_m))
    if arguments.json:
        content = {"arguments": arguments.arg, "runs": [without_nan(asdict(one)) for one in outcomes]}
        write_whole(arguments.json, json.dumps(content, indent=1) + "\n")
    return 1 if num_missing or any(one.fault for one in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
