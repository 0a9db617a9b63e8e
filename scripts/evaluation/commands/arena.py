# SPDX-License-Identifier: GPL-3.0-or-later
"""Map simulated arenas with shapemap-cli and count the consecutive positions that it aligns wrongly."""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from evaluation.common.command_line import command_parser, complain, require_program
from evaluation.common.files import write_json, write_whole
from evaluation.common.programs import Failure
from evaluation.judging.arena_pairs import PairResult, evaluate_pairs, lost_run, stages_of
from evaluation.judging.arena_rates import Rate, all_rates, markdown, sureness
from evaluation.mapping.options import add_arena_runs, arena_mapper, run_arenas
from evaluation.simulation.arena_options import options_from
from evaluation.simulation.simulation import consecutive_overlaps, simulate
from evaluation.simulation.write import nist_text

EXAMPLE = """example:
  scripts/evaluate.py arena --seeds 0-39 --jobs 4 --json results/arena.json --failures results/arena_failures
  scripts/evaluate.py arena --seeds 0,3,7 --spacing-m 2 --method paper --arg=--strict-paper

A pair fails when its pose is more than 0.30 m or 5 degrees off (wrong) or when there is none (rejected).
Exit status: 0 all runs gave a report, 1 some did not (their pairs count as rejected), 2 wrong usage."""


@dataclass(frozen=True)
class Run:
    """Results of one seed."""

    seed: int
    pairs: list[PairResult]
    fault: str  # empty when the mapper gave a report
    seconds: float | None


def save_failures(folder: Path, pairs: list[PairResult], simulation: Any, report: dict[str, Any]) -> None:
    """A picture of each pair that is not ok in the end."""
    from evaluation.judging.failure_picture import save_failure  # matplotlib only when pictures are asked for

    for pair in pairs:
        if pair.final_verdict != "ok":
            save_failure(folder / f"seed{pair.seed:03d}_pair{pair.index:02d}.png", pair, simulation, report)


def run_seed(seed: int, arguments: argparse.Namespace) -> Run:
    """Simulate, map and judge one seed in a folder of its own."""
    simulation = simulate(options_from(arguments, seed))
    overlaps = consecutive_overlaps(simulation)
    with tempfile.TemporaryDirectory(prefix=f"arena{seed}_") as name:
        log = Path(name) / "arena.nist"
        write_whole(log, nist_text(simulation))
        try:
            report, _ = arena_mapper(arguments).run([log], Path(name))
        except Failure as failure:
            return Run(seed, lost_run(seed, overlaps, str(failure)), str(failure), None)
    pairs = evaluate_pairs(simulation, report, overlaps)
    if arguments.failures:
        save_failures(arguments.failures, pairs, simulation, report)
    seconds = report.get("seconds", {}).get("wall")
    return Run(seed, pairs, "", float(seconds) if isinstance(seconds, int | float) else None)


def pair_dict(pair: PairResult, stages: tuple[str, ...]) -> dict[str, Any]:
    return {
        "seed": pair.seed,
        "index": pair.index,
        "overlap": pair.overlap,
        "reason": pair.reason,
        "verdict": pair.final_verdict,
        "verdicts": {stage: pair.verdict(stage) for stage in stages},
        "sure": pair.sure,
        "errors": pair.errors,
    }


def content(runs: list[Run], rates: list[Rate], arguments: argparse.Namespace) -> dict[str, Any]:
    """What --json writes."""
    stages = stages_of(pair for run in runs for pair in run.pairs)
    return {
        "options": vars(arguments),
        "rates": [
            {**asdict(rate), "num_failures": rate.num_failures, "failure_ratio": rate.failure_ratio} for rate in rates
        ],
        "runs": [{"seed": run.seed, "fault": run.fault, "seconds": run.seconds} for run in runs],
        "pairs": [pair_dict(pair, stages) for run in runs for pair in run.pairs],
    }


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    parser.add_argument("--failures", type=Path, metavar="DIR", help="write a picture of each pair that failed")
    add_arena_runs(parser, "rates and every pair")
    arguments = parser.parse_args(argv)
    require_program(parser, arguments)
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    runs = run_arenas(__name__, run_seed, arguments)
    pairs = [pair for run in runs for pair in run.pairs]
    rates = all_rates(pairs)
    print(f"{markdown(rates)}\n\n{sureness(pairs)}")
    if arguments.json:
        write_json(arguments.json, content(runs, rates, arguments))
    for run in runs:
        if run.fault:
            complain(__name__, f"seed {run.seed}: {run.fault}")
    return 1 if any(run.fault for run in runs) else 0
