#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Map simulated arenas with shapemap-cli and count the consecutive positions that it aligns wrongly."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from shapemap_sim.pairs import PairResult, evaluate_pairs, lost_run, stages_of
from shapemap_sim.rates import Rate, all_rates, markdown, sureness
from shapemap_sim.simulation import consecutive_overlaps, simulate
from simulate_arena import add_arena_arguments, number, options_from, write_files

EXIT_OK = (0, 4)  # 4: map written, some positions not placed
ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = """example:
  scripts/evaluate_arena.py --seeds 0-39 --jobs 4 --json results/arena.json --failures results/arena_failures
  scripts/evaluate_arena.py --seeds 0,3,7 --spacing-m 2 --method paper --arg=--strict-paper

A pair fails when its pose is more than 0.30 m or 5 degrees off (wrong) or when there is none (rejected).
Exit status: 0 all runs gave a report, 1 some did not (their pairs count as rejected), 2 wrong usage."""


@dataclass(frozen=True)
class Run:
    """Results of one seed."""

    seed: int
    pairs: list[PairResult]
    fault: str  # empty when the mapper gave a report
    seconds: float | None


def parse_seeds(text: str) -> list[int]:
    """`0-39`, `1,5,8` or a mix of both; sorted, each once."""
    seeds: set[int] = set()
    for part in text.split(","):
        first, dash, last = part.partition("-")
        try:
            low = int(first)
            high = int(last) if dash else low
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{part}' is not a seed or a range such as 0-39") from None
        if high < low:
            raise argparse.ArgumentTypeError(f"'{part}' is an empty range")
        seeds.update(range(low, high + 1))
    return sorted(seeds)


def run_mapper(command: list[str], report: Path, timeout_s: float) -> tuple[dict[str, Any] | None, str]:
    """The report that the mapper wrote, or None and why there is none."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=timeout_s, check=False)
    except subprocess.TimeoutExpired:
        return None, f"no end after {timeout_s:g} s"
    if done.returncode not in EXIT_OK:
        last_line = (done.stderr.strip().splitlines() or ["no message"])[-1]
        return None, f"exit code {done.returncode}: {last_line}"
    return json.loads(report.read_text(encoding="utf-8")), ""


def save_failures(folder: Path, pairs: list[PairResult], simulation: Any, report: dict[str, Any]) -> None:
    """A picture of each pair that is not ok in the end."""
    from shapemap_sim.failure_picture import save_failure  # matplotlib only when pictures are asked for

    for pair in pairs:
        if pair.final_verdict != "ok":
            save_failure(folder / f"seed{pair.seed:03d}_pair{pair.index:02d}.png", pair, simulation, report)


def run_seed(seed: int, arguments: argparse.Namespace) -> Run:
    """Simulate, map and judge one seed in a folder of its own."""
    simulation = simulate(options_from(arguments, seed))
    overlaps = consecutive_overlaps(simulation)
    with tempfile.TemporaryDirectory(prefix=f"arena{seed}_") as name:
        folder = Path(name)
        write_files(folder / "arena", ["nist"], simulation, overlaps)
        command = [
            str(arguments.cli),
            "--nist",
            str(folder / "arena.nist"),
            "--out",
            str(folder / "map.png"),
            "--trajectory",
            str(folder / "out.tum"),
            "--report",
            str(folder / "report.json"),
            "--quiet",
            "--method",
            arguments.method,
            *arguments.arg,
        ]
        report, fault = run_mapper(command, folder / "report.json", arguments.timeout_s)
    if report is None:
        return Run(seed, lost_run(seed, overlaps, fault), fault, None)
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
        "errors": {stage: asdict(e) for stage, e in pair.errors.items()} if pair.errors else None,
    }


def rate_dict(rate: Rate) -> dict[str, Any]:
    """Medians and shares of nothing become null: JSON has no NaN."""
    fields = {**asdict(rate), "num_failures": rate.num_failures, "failure_ratio": rate.failure_ratio}
    return {key: None if isinstance(value, float) and np.isnan(value) else value for key, value in fields.items()}


def as_json(runs: list[Run], rates: list[Rate], arguments: argparse.Namespace) -> str:
    options = {key: str(value) if isinstance(value, Path) else value for key, value in vars(arguments).items()}
    stages = stages_of(pair for run in runs for pair in run.pairs)
    return (
        json.dumps(
            {
                "options": options,
                "rates": [rate_dict(rate) for rate in rates],
                "runs": [{"seed": run.seed, "fault": run.fault, "seconds": run.seconds} for run in runs],
                "pairs": [pair_dict(pair, stages) for run in runs for pair in run.pairs],
            },
            indent=1,
        )
        + "\n"
    )


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--seeds",
        type=parse_seeds,
        default=parse_seeds("0-39"),
        metavar="LIST",
        help="seeds of the arenas, such as 0-39 or 1,5,8 (default 0-39)",
    )
    parser.add_argument(
        "--cli",
        type=Path,
        default=ROOT / "build/release/bin/shapemap-cli",
        metavar="FILE",
        help="the mapper (default build/release/bin/shapemap-cli)",
    )
    parser.add_argument(
        "--method", choices=("robust", "paper"), default="robust", help="of alignment (default %(default)s)"
    )
    parser.add_argument(
        "--arg",
        action="append",
        default=[],
        metavar="ARG",
        help="passed on to the mapper; repeat for more, such as --arg=--max-shift-m --arg=3",
    )
    parser.add_argument(
        "--jobs", type=number(1, 256, int), default=2, metavar="N", help="arenas at the same time (default %(default)s)"
    )
    parser.add_argument(
        "--timeout-s",
        type=number(1, 86400),
        default=300.0,
        metavar="S",
        help="longest time for one arena (default %(default)g)",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write rates and every pair")
    parser.add_argument("--failures", type=Path, metavar="DIR", help="write a picture of each pair that failed")
    add_arena_arguments(parser)
    arguments = parser.parse_args(argv)
    if not os.access(arguments.cli, os.X_OK):
        parser.error(f"--cli: {arguments.cli} is not a program; build it with `cmake --build --preset release`")
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    with ProcessPoolExecutor(max_workers=arguments.jobs) as pool:
        futures = [pool.submit(run_seed, seed, arguments) for seed in arguments.seeds]
        try:
            runs = [future.result() for future in futures]
        except ValueError as error:
            pool.shutdown(cancel_futures=True)
            print(f"evaluate_arena.py: {error}", file=sys.stderr)
            return 2
    pairs = [pair for run in runs for pair in run.pairs]
    rates = all_rates(pairs)
    print(f"{markdown(rates)}\n\n{sureness(pairs)}")
    if arguments.json:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
        arguments.json.write_text(as_json(runs, rates, arguments), encoding="utf-8")
    for run in runs:
        if run.fault:
            print(f"evaluate_arena.py: seed {run.seed}: {run.fault}", file=sys.stderr)
    return 1 if any(run.fault for run in runs) else 0


if __name__ == "__main__":
    sys.exit(main())
