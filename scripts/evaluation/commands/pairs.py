# SPDX-License-Identifier: GPL-3.0-or-later
"""Judge alignments pair by pair: run `shapemap-cli align` on logs whose poses are known, and count.

Logs are CARMEN logs, whose FLASER poses are the reference (good to 5 to 10 cm), or arenas of `evaluate.py simulate`
(.nist). The program gets them without any pose or odometry; the reference pose of a pair goes with its line, is judged
beside what is found and never used to find it. A pair is right when the program gives a pose for it that is within
0.20 m and 5 degrees of the reference.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from evaluation.common.argument_types import number, numbers
from evaluation.common.command_line import (
    add_json,
    add_logs,
    add_passed_on,
    add_program,
    add_timeout,
    command_parser,
    complain,
    require_program,
)
from evaluation.common.files import plain, write_json, write_whole
from evaluation.common.project import found_log
from evaluation.logs.reference_log import ReferenceLog, read_reference_log
from evaluation.pairs.outcomes import CrossOutcome, PairOutcome
from evaluation.pairs.program import Program, evaluate_cross, evaluate_log
from evaluation.pairs.tables import (
    confidence_markdown,
    confidence_rows,
    cross_markdown,
    cross_rows,
    reliability,
    reliability_markdown,
    success_markdown,
    success_tables,
)

EXAMPLE = """columns:
  refined from reference  share that is right when the refinement starts from the reference pose: a ceiling
  search, score, no pose  failures: the true pose is not among the hypotheses; it is, but not the first; it is the
                          first, but was refused, or the program crashed
  reference would win     of the failures by search, those in which the reference pose scores higher than the one found
  reference in doubt      of the failures, those within 0.5 m and 25 degrees whose pose scores higher by --doubt-margin
                          than the reference pose, as it is and, unless that takes it away, refined

example:
  SHAPEMAP_DATASETS=logs scripts/evaluate.py pairs carmen/intel-corrected.log.gz carmen/orebro-corrected.log.gz \\
      --cross 4000 --json results/pairs.json --failures results/failed_pairs --reliability results/reliability.png

Exit status: 0 all logs were judged, 1 some were missing or the program crashed (its pairs count as failures), 2 wrong
usage."""


@dataclass
class Evaluation:
    logs: list[ReferenceLog] = field(default_factory=list)
    pairs: list[PairOutcome] = field(default_factory=list)
    cross: list[CrossOutcome] = field(default_factory=list)
    faults: dict[str, str] = field(default_factory=dict)  # by log: why the program gave no answer
    complaints: list[str] = field(default_factory=list)  # logs that could not be judged at all, and other runs


def gap_list(text: str) -> list[int]:
    """`1,2,3`; sorted, each once."""
    return sorted(set(numbers(1, 10**6, int)(text)))


def read_logs(paths: Sequence[Path], evaluation: Evaluation) -> None:
    """Those that can be read; the others become complaints that name them."""
    for path in paths:
        try:
            evaluation.logs.append(read_reference_log(found_log(path)))
        except FileNotFoundError:
            evaluation.complaints.append(f"SKIPPED, missing: {path}")
        except (OSError, ValueError, IndexError, KeyError) as error:
            evaluation.complaints.append(f"SKIPPED, unreadable: {path}: {error}")


def evaluate(arguments: argparse.Namespace) -> Evaluation:
    evaluation = Evaluation()
    read_logs(arguments.logs, evaluation)
    program = Program(arguments.cli, ["--threads", str(arguments.threads), *arguments.arg], arguments.timeout_s)
    for log in evaluation.logs:
        pairs, fault = evaluate_log(program, log, arguments.gaps, arguments.doubt_margin)
        evaluation.pairs += pairs
        if fault:
            evaluation.faults[log.name] = fault
    if arguments.cross:
        cross, faults = evaluate_cross(program, evaluation.logs, arguments.cross, arguments.seed)
        evaluation.cross = cross
        evaluation.complaints += faults
        if len(evaluation.logs) < 2:
            evaluation.complaints.append("--cross needs two logs or more")
    return evaluation


def markdown(evaluation: Evaluation) -> str:
    parts = [
        success_markdown(title, rows) for title, rows in success_tables(evaluation.pairs, evaluation.faults).items()
    ]
    parts.append(confidence_markdown(confidence_rows(evaluation.pairs)))
    parts.append(reliability_markdown(reliability(evaluation.pairs)))
    if evaluation.cross:
        parts.append("Pairs from different places:\n\n" + cross_markdown(cross_rows(evaluation.cross)))
    return "\n\n".join(parts)


def content(evaluation: Evaluation, arguments: argparse.Namespace) -> dict[str, Any]:
    """What --json writes."""
    pairs = [
        {
            **plain(pair),
            "is_right": pair.is_right,
            "failure": pair.failure or None,
            "reference_would_win": pair.reference_would_win,
        }
        for pair in evaluation.pairs
    ]
    return {
        "options": vars(arguments),
        "logs": [{"name": log.name, "num_positions": len(log)} for log in evaluation.logs],
        "faults": evaluation.faults,
        "complaints": evaluation.complaints,
        "success": success_tables(evaluation.pairs, evaluation.faults),
        "confidence": confidence_rows(evaluation.pairs),
        "reliability": reliability(evaluation.pairs),
        "false_acceptance": cross_rows(evaluation.cross),
        "pairs": pairs,
        "cross": evaluation.cross,
    }


def write_pictures(evaluation: Evaluation, arguments: argparse.Namespace) -> None:
    from evaluation.pairs.pictures import save_failure, save_reliability  # matplotlib only when pictures are asked for

    if arguments.reliability:
        save_reliability(arguments.reliability, reliability(evaluation.pairs))
    logs = {log.name: log for log in evaluation.logs}
    for pair in evaluation.pairs if arguments.failures else []:
        if not pair.is_right and pair.status != "crashed":
            save_failure(arguments.failures, pair, logs[pair.log])


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add = parser.add_argument
    add_logs(parser)
    add("--gaps", type=gap_list, default=[1, 2, 3], metavar="LIST", help="positions between a pair (default 1,2,3)")
    add(
        "--cross", type=number(0, 10**7, int), default=0, metavar="N", help="random pairs of different logs (default 0)"
    )
    add("--seed", type=number(0, 2**32 - 1, int), default=0, metavar="N", help="of the random pairs (default 0)")
    add("--doubt-margin", type=number(0, 100), default=1.0, metavar="X", help="see below (default %(default)g)")
    add_program(parser, "the program")
    add_passed_on(parser)
    add("--threads", type=number(1, 256, int), default=1, metavar="N", help="of the program (default 1)")
    add_timeout(parser, 3600.0)
    add_json(parser, "all tables and every pair")
    add("--markdown", type=Path, metavar="FILE", help="write the tables, which are printed anyway")
    add("--failures", type=Path, metavar="DIR", help="write a picture of each pair that failed")
    add("--reliability", type=Path, metavar="FILE.png", help="write a diagram: how often is it right that says so?")
    arguments = parser.parse_args(argv)
    if len({log.name for log in arguments.logs}) < len(arguments.logs):
        parser.error("two logs have the same name")
    require_program(parser, arguments)
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    evaluation = evaluate(arguments)
    for complaint in [*evaluation.complaints, *(f"{log}: {fault}" for log, fault in evaluation.faults.items())]:
        complain(__name__, complaint)
    if evaluation.pairs:
        text = markdown(evaluation)
        print(text)
        if arguments.markdown:
            write_whole(arguments.markdown, text + "\n")
        if arguments.json:
            write_json(arguments.json, content(evaluation, arguments))
        if arguments.failures or arguments.reliability:
            write_pictures(evaluation, arguments)
    return 1 if evaluation.complaints or evaluation.faults or not evaluation.pairs else 0
