#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Map simulated places that offices and arenas are not like, with shapemap-cli, and compare with the exact poses:
streets between buildings, a long corridor there and back, an exhibition hall."""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from evaluate_arena import parse_seeds
from evaluation.mapping import Mapper, absolute_errors_m, placed_poses, root_mean_square
from evaluation.metrics import pairs
from evaluation.programs import Failure
from evaluation.selection import add_mapper_arguments, mapper_from
from pair_evaluation.reference_log import strip_nist
from shapemap_sim.grounds import GROUNDS, simulate_ground
from shapemap_sim.write import nist_text, tum_text, without_nan, write_whole
from simulate_arena import number, some_of

EXAMPLE = """A scan of 180 degrees each metre, without odometry. A pair of consecutive scans is right within 0.20 m and
5 degrees of the exact poses; errors of the map are those left after the planar motion that fits best.

example:
  scripts/evaluate_grounds.py --seeds 0-3 --json results/grounds.json
  scripts/evaluate_grounds.py --grounds long-corridor --seeds 7 --arg=--close-loops=false

Exit status: 0 all runs gave a map, 1 some did not, 2 wrong usage."""


@dataclass(frozen=True)
class Outcome:
    """Of one log; `fault`: why there is no map."""

    ground: str
    seed: int
    num_scans: int
    num_placed: int = 0
    num_right: int = 0
    ate_m: float = math.nan
    worst_m: float = math.nan
    num_loops: int = 0
    cpu_s: float = 0.0
    peak_memory_mib: float = 0.0
    fault: str = ""


def run(ground: str, seed: int, step_m: float, mapper: Mapper, logs: Path | None) -> Outcome:
    simulation = simulate_ground(ground, seed, step_m)
    truth = simulation.drive.map_from_robot
    text = nist_text(simulation, ground)
    if logs:
        write_whole(logs / f"{ground}-{seed}.nist", text)
        write_whole(logs / f"{ground}-{seed}.tum", tum_text(simulation))
    with tempfile.TemporaryDirectory(prefix=f"{ground}_") as name:
        log = Path(name) / "log.nist"
        log.write_text(strip_nist(text), encoding="utf-8")
        try:
            report, usage = mapper.run([log], Path(name))
        except Failure as failure:
            return Outcome(ground, seed, len(truth), fault=str(failure))
    placed = placed_poses(report)
    errors_m = absolute_errors_m(report, [truth])
    return Outcome(
        ground,
        seed,
        len(truth),
        num_placed=len(placed),
        num_right=sum(pairs(truth, [placed])["right"]),
        ate_m=root_mean_square(errors_m),
        worst_m=float(np.max(errors_m, initial=0.0)),
        num_loops=len(report["loops"]),
        cpu_s=usage.cpu_s,
        peak_memory_mib=usage.peak_memory_mib,
    )


def table(outcomes: list[Outcome]) -> str:
    lines = [
        "| ground | seed | scans | placed | right pairs | loops | ATE | worst | CPU | memory |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for one in outcomes:
        if one.fault:
            lines.append(f"| {one.ground} | {one.seed} | {one.num_scans} | no map: {one.fault} | | | | | | |")
            continue
        lines.append(
            f"| {one.ground} | {one.seed} | {one.num_scans} | {one.num_placed} "
            f"| {one.num_right} of {one.num_scans - 1} | {one.num_loops} | {one.ate_m:.3f} m | {one.worst_m:.2f} m "
            f"| {one.cpu_s:.1f} s | {one.peak_memory_mib:.0f} MiB |"
        )
    return "\n".join(lines)


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add(
        "--grounds",
        type=some_of(GROUNDS),
        default=list(GROUNDS),
        metavar="LIST",
        help=f"of {', '.join(GROUNDS)} (default all)",
    )
    add("--seeds", type=parse_seeds, default=parse_seeds("0-3"), metavar="LIST", help="such as 0-3 (default) or 1,5")
    add("--step-m", type=number(0.05, 100), default=1.0, metavar="M", help="between scans (default %(default)s)")
    add("--jobs", type=number(1, 256, int), default=2, metavar="N", help="logs at the same time (default 2)")
    add("--logs", type=Path, metavar="DIR", help="write the logs, with true poses, and these alone as TUM")
    add_mapper_arguments(parser)
    return parser.parse_args(argv)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    mapper = mapper_from(arguments)
    wanted = [(ground, seed) for ground in arguments.grounds for seed in arguments.seeds]
    with ProcessPoolExecutor(max_workers=arguments.jobs) as pool:
        futures = [pool.submit(run, *one, arguments.step_m, mapper, arguments.logs) for one in wanted]
        outcomes = [future.result() for future in futures]
    print(table(outcomes))
    if arguments.json:
        content = {"arguments": arguments.arg, "runs": [without_nan(asdict(one)) for one in outcomes]}
        write_whole(arguments.json, json.dumps(content, indent=1) + "\n")
    return 1 if any(one.fault for one in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
