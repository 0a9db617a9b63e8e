# SPDX-License-Identifier: GPL-3.0-or-later
"""Map simulated places that offices and arenas are not like, with shapemap-cli, and compare with the exact poses:
streets between buildings, a long corridor there and back, an exhibition hall."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from itertools import product
from pathlib import Path

from evaluation.common.argument_types import number, some_of
from evaluation.common.command_line import command_parser
from evaluation.common.files import write_json, write_whole
from evaluation.common.parallel import run_all
from evaluation.common.tables import table
from evaluation.judging.map_score import MapScore, mapped_text, num_faults
from evaluation.logs.reference_log import strip_nist
from evaluation.mapping.mapper import Mapper
from evaluation.mapping.options import add_walk_arguments, mapper_from
from evaluation.simulation.grounds import GROUNDS, simulate_ground
from evaluation.simulation.write import nist_text, tum_text

EXAMPLE = """A scan of 180 degrees each metre, without odometry. A pair of consecutive scans is right within 0.20 m and
5 degrees of the exact poses; errors of the map are those left after the planar motion that fits best.

example:
  scripts/evaluate.py grounds --seeds 0-3 --json results/grounds.json
  scripts/evaluate.py grounds --grounds long-corridor --seeds 7 --arg=--close-loops=false

Exit status: 0 all runs gave a map, 1 some did not, 2 wrong usage."""
HEAD = ("ground", "seed", "scans", "placed", "right pairs", "loops", "ATE", "worst", "CPU", "memory")


def run(ground: str, seed: int, step_m: float, mapper: Mapper, logs: Path | None) -> MapScore:
    simulation = simulate_ground(ground, seed, step_m)
    text = nist_text(simulation, ground)
    if logs:
        write_whole(logs / f"{ground}-{seed}.nist", text)
        write_whole(logs / f"{ground}-{seed}.tum", tum_text(simulation))
    return mapped_text(strip_nist(text), ".nist", simulation.drive.map_from_robot, mapper)[0]


def row(ground: str, seed: int, score: MapScore) -> list[object]:
    cells: list[object] = [ground, seed, score.num_scans]
    if score.fault:
        return [*cells, f"no map: {score.fault}"]
    cells += [score.num_placed, score.right_pairs, score.num_loops, *score.errors]
    return [*cells, f"{score.cpu_s:.1f} s", f"{score.peak_memory_mib:.0f} MiB"]


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add = parser.add_argument
    add(
        "--grounds",
        type=some_of(GROUNDS),
        default=list(GROUNDS),
        metavar="LIST",
        help=f"of {', '.join(GROUNDS)} (default all)",
    )
    add("--step-m", type=number(0.05, 100), default=1.0, metavar="M", help="between scans (default %(default)s)")
    add_walk_arguments(parser, "0-3")
    return parser.parse_args(argv)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    mapper = mapper_from(arguments)
    wanted = list(product(arguments.grounds, arguments.seeds))
    calls = [(*one, arguments.step_m, mapper, arguments.logs) for one in wanted]
    scores = run_all(run, calls, arguments.jobs)
    print(table(HEAD, [row(*one, score) for one, score in zip(wanted, scores)]))
    if arguments.json:
        runs = [{"ground": ground, "seed": seed, **asdict(one)} for (ground, seed), one in zip(wanted, scores)]
        write_json(arguments.json, {"arguments": arguments.arg, "runs": runs})
    return 1 if num_faults(scores) else 0
