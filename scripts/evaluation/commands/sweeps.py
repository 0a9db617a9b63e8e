# SPDX-License-Identifier: GPL-3.0-or-later
"""Map simulated walks with a rolling laser, whose sweeps are bent by motion, with shapemap-cli, and compare with the
exact poses at the start of each sweep."""

from __future__ import annotations

import argparse
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path

from evaluation.common.argument_types import number, numbers
from evaluation.common.command_line import command_parser
from evaluation.common.files import write_json, write_whole
from evaluation.common.parallel import run_all
from evaluation.common.tables import table
from evaluation.common.tum import tum_line
from evaluation.judging.map_score import MapScore, mapped_text, num_faults
from evaluation.logs.reference_log import strip_nist
from evaluation.mapping.mapper import Mapper
from evaluation.mapping.options import add_walk_arguments, mapper_from
from evaluation.simulation.sweeps import SweepOptions, simulate_sweeps, sweep_text

EXAMPLE = """The laser is carried at 0.8 m/s through a furnished building, and sways. A pair of consecutive scans is
right within 0.20 m and 5 degrees of the exact poses; errors of the map are those left after the planar motion that
fits best.

example:
  scripts/evaluate.py sweeps --yaw 10,20,30,60 --seeds 0-4 --json results/sweeps.json
  scripts/evaluate.py sweeps --rate 5,10,20 --yaw 20 --arg=--deskew=off

Exit status: 0 all runs gave a map, 1 some did not, 2 wrong usage."""
HEAD = ("rate", "yaw", "seed", "scans", "placed", "right pairs", "ATE", "worst", "sweep time", "CPU")


@dataclass(frozen=True)
class Outcome:
    """What became of one log. `sweep_time_s` is what the program took for it, 0 for nothing."""

    rate_hz: float
    yaw_deg: float
    seed: int
    sweep_time_s: float
    score: MapScore


def run(options: SweepOptions, seed: int, mapper: Mapper, logs: Path | None) -> Outcome:
    simulation = simulate_sweeps(seed, options)
    truth = simulation.map_from_laser
    text = sweep_text(simulation)
    if logs:
        name = f"sweeps-{options.rate_hz:g}hz-{options.yaw_deg:g}deg-{seed}"
        write_whole(logs / f"{name}.nist", text)
        write_whole(logs / f"{name}.tum", "".join(map(tum_line, simulation.timestamps_s, truth)))
    score, report = mapped_text(strip_nist(text), ".nist", truth, mapper)
    sweeps = (report["logs"][0].get("sweeps") or {}) if report else {}
    return Outcome(options.rate_hz, options.yaw_deg, seed, sweeps.get("sweep_time_s", 0.0), score)


def row(one: Outcome) -> list[object]:
    score = one.score
    cells: list[object] = [f"{one.rate_hz:g} Hz", f"{one.yaw_deg:g} deg", one.seed, score.num_scans]
    if score.fault:
        return [*cells, f"no map: {score.fault}"]
    cells += [score.num_placed, score.right_pairs, *score.errors]
    return [*cells, f"{one.sweep_time_s:.4f} s", f"{score.cpu_s:.1f} s"]


def fields(one: Outcome) -> dict[str, object]:
    """An outcome for JSON, all on one level."""
    walk = {"rate_hz": one.rate_hz, "yaw_deg": one.yaw_deg, "seed": one.seed, "sweep_time_s": one.sweep_time_s}
    return {**walk, **asdict(one.score)}


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add = parser.add_argument
    add("--yaw", type=numbers(0, 180), default=[20.0], metavar="LIST", help="the laser sways by so many degrees")
    add("--yaw-hz", type=number(0, 10), default=1.0, metavar="HZ", help="so often (default %(default)s)")
    add("--rate", type=numbers(1, 50), default=[7.0], metavar="LIST", help="sweeps a second (default 7)")
    add("--share", type=number(0, 1), default=1.0, metavar="X", help="of its period that a sweep takes (default 1)")
    add("--seconds", type=number(1, 3600), default=40.0, metavar="S", help="of the walk at most (default 40)")
    add_walk_arguments(parser, "0-4")
    return parser.parse_args(argv)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    mapper = mapper_from(arguments)
    walks = [
        SweepOptions(
            rate_hz=rate, yaw_deg=yaw, yaw_hz=arguments.yaw_hz, seconds=arguments.seconds, sweep_share=arguments.share
        )
        for rate, yaw in product(arguments.rate, arguments.yaw)
    ]
    calls = [(walk, seed, mapper, arguments.logs) for walk, seed in product(walks, arguments.seeds)]
    outcomes = run_all(run, calls, arguments.jobs)
    print(table(HEAD, map(row, outcomes)))
    if arguments.json:
        write_json(arguments.json, {"arguments": arguments.arg, "runs": [fields(one) for one in outcomes]})
    return 1 if num_faults([one.score for one in outcomes]) else 0
