# SPDX-License-Identifier: GPL-3.0-or-later
"""Map logs of different buildings together in one run of shapemap-cli, and check that none is joined with another.
With --with-itself the other way round: the two halves of each log, given as two logs, must become one map."""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

from tqdm import tqdm

from evaluation.common.argument_types import number
from evaluation.common.command_line import complain
from evaluation.common.files import write_json
from evaluation.common.programs import Failure
from evaluation.judging.absolute_errors import absolute_errors_m, root_mean_square
from evaluation.judging.separate_logs import describe, halves, joints, num_in_first_half
from evaluation.logs.datasets import DatasetError
from evaluation.logs.evaluation_log import EvaluationLog
from evaluation.logs.selection import parse_with_logs, parser_for_logs, selected_logs
from evaluation.mapping.mapper import Mapper
from evaluation.mapping.options import add_mapper_arguments, mapper_from

EXAMPLE = """example:
  SHAPEMAP_DATASETS=logs scripts/evaluate.py separate-logs --only intel,orebro,belgioioso,aces,csail,freiburg-079
  SHAPEMAP_DATASETS=logs scripts/evaluate.py separate-logs --only intel,orebro,csail --pairs --json results/pairs.json
  SHAPEMAP_DATASETS=logs scripts/evaluate.py separate-logs --only intel,orebro --with-itself

No two logs may be of the same place. Where a log has reference poses, --with-itself tells the root mean square error
(ATE) of the positions of both halves after one planar motion.
Exit status: 0 nothing was joined (with --with-itself: all halves were, and rightly), 1 something was (was not, or
wrongly), or a log is missing or gave no map, 2 wrong usage, 3 malformed data sets or logs (nothing was run)."""


@dataclass(frozen=True)
class Outcome:
    """What became of one run: `lines` tell people about it, `fields` tell programs."""

    is_right: bool
    lines: list[str]
    fields: dict[str, Any]


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = parser_for_logs(__name__, __doc__, EXAMPLE)
    add = parser.add_argument
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--pairs", action="store_true", help="a run for each pair of logs instead of one for all")
    how.add_argument("--with-itself", action="store_true", help="a run for each log: its two halves must be joined")
    add(
        "--most-ate-m",
        type=number(0.01, 1000),
        default=0.5,
        metavar="M",
        help="halves with a larger error are joined wrongly (default %(default)g)",
    )
    add_mapper_arguments(parser)
    return parse_with_logs(parser, argv)


def written(texts: Sequence[tuple[str, str]], folder: Path) -> list[Path]:
    """Logs by name and text, as files of these names."""
    paths = [folder / name for name, _ in texts]
    for path, (_, text) in zip(paths, texts):
        path.write_text(text, encoding="utf-8")
    return paths


def check_apart(logs: Sequence[EvaluationLog], mapper: Mapper) -> Outcome:
    """Raises Failure."""
    names = [log.name for log in logs]
    with tempfile.TemporaryDirectory(prefix="apart_") as name:
        texts = [(f"{log.name}{log.content.ending}", log.content.without_poses) for log in logs]
        report, usage = mapper.run(written(texts, Path(name)), Path(name))
    found = joints(report)
    num_fragments = len(report["components"])
    together = " + ".join(f"{log.name} ({len(log)})" for log in logs)
    verdict = f"{len(found)} JOINED" if found else "nothing joined"
    lines = [f"{together}: {verdict}, fragments: {num_fragments}, {usage.cpu_s:.0f} s of CPU time"]
    lines += [f"  {describe(joint, names)}" for joint in found]
    joined = [
        {
            "logs": [names[k] for k in joint.logs],
            "fragment": joint.fragment,
            "num_positions": joint.num_positions,
            "strengths": joint.strengths,
        }
        for joint in found
    ]
    fields = {"logs": names, "joined": joined, "num_fragments": num_fragments, "cpu_s": usage.cpu_s}
    return Outcome(not found, lines, fields)


def check_halves(log: EvaluationLog, mapper: Mapper, most_ate_m: float) -> Outcome:
    """Raises Failure, or ValueError for a log of less than two scans."""
    parts = halves(log.content.without_poses)
    names = ["first half", "second half"]
    with tempfile.TemporaryDirectory(prefix="halves_") as name:
        texts = [(f"{half.split()[0]}{log.content.ending}", text) for half, text in zip(names, parts)]
        report, usage = mapper.run(written(texts, Path(name)), Path(name))
    found, ate_m = joints(report), None
    if log.reference is not None:
        middle = num_in_first_half(len(log))
        ate_m = root_mean_square(absolute_errors_m(report, [log.reference[:middle], log.reference[middle:]]))
    is_right = bool(found) and (ate_m is None or ate_m <= most_ate_m)
    verdict = "joined" if is_right else "joined WRONGLY" if found else "NOT joined"
    error = "no reference" if ate_m is None else f"ATE {100 * ate_m:.1f} cm"
    placed = f"{report['num_placed']} of {report['num_scans']} positions"
    head = f"{log.name} in two halves: {verdict}, fragments: {len(report['components'])}"
    lines = [f"{head}, {placed} in the map, {error}, {usage.cpu_s:.0f} s of CPU time"]
    lines += [f"  {describe(joint, names)}" for joint in found]
    fields = {"log": log.name, "joined": bool(found), "right": is_right, "ate_m": ate_m}
    fields |= {"num_placed": report["num_placed"], "num_fragments": len(report["components"]), "cpu_s": usage.cpu_s}
    return Outcome(is_right, lines, fields)


def outcome_of(logs: Sequence[EvaluationLog], arguments: argparse.Namespace) -> Outcome:
    """What becomes of logs together or, of a single one, of its halves. A run that fails is an outcome, too."""
    mapper = mapper_from(arguments)
    try:
        if arguments.with_itself:
            return check_halves(logs[0], mapper, arguments.most_ate_m)
        return check_apart(logs, mapper)
    except (Failure, ValueError) as failure:
        names = [log.name for log in logs]
        return Outcome(False, [f"{' + '.join(names)}: no map: {failure}"], {"logs": names, "fault": str(failure)})


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        logs, num_missing = selected_logs(__name__, arguments)
    except (DatasetError, OSError) as error:
        complain(__name__, str(error))
        return 3
    if len(logs) < (1 if arguments.with_itself else 2):
        complain(__name__, "too few logs at hand")
        return 1
    sets: list[tuple[EvaluationLog, ...]] = [tuple(logs)]
    if arguments.pairs:
        sets = list(combinations(logs, 2))
    elif arguments.with_itself:
        sets = [(log,) for log in logs]
    outcomes = []
    for chosen in tqdm(sets, desc="mapping", disable=None, leave=False):
        outcomes.append(outcome_of(chosen, arguments))
        tqdm.write("\n".join(outcomes[-1].lines), file=sys.stdout)
        if arguments.json:  # after each: many pairs may take long
            runs = [outcome.fields for outcome in outcomes]
            write_json(arguments.json, {"arguments": arguments.arg, "runs": runs})
    num_wrong = sum(not outcome.is_right for outcome in outcomes)
    print(f"{len(outcomes) - num_wrong} of {len(outcomes)} runs as they should be")
    return 1 if num_wrong or num_missing else 0
