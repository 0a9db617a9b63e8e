#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Map simulated walks with a rolling laser, whose sweeps are bent by motion, with shapemap-cli, and compare with the
exact poses at the start of each sweep."""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path

import numpy as np

from evaluate_arena import parse_seeds
from evaluation.mapping import Mapper, absolute_errors_m, placed_poses, root_mean_square
from evaluation.metrics import pairs
from evaluation.programs import Failure
from evaluation.selection import add_mapper_arguments, mapper_from
from pair_evaluation.reference_log import strip_nist
from shapemap_sim.sweeps import SweepOptions, simulate_sweeps, sweep_text
from shapemap_sim.write import tum_line, without_nan, write_whole
from simulate_arena import number

EXAMPLE = """The laser is carried at 0.8 m/s through a furnished building, and sways. A pair of consecutive scans is
right within 0.20 m and 5 degrees of the exact poses; errors of the map are those left after the planar motion that
fits best.

example:
  scripts/evaluate_sweeps.py --yaw 10,20,30,60 --seeds 0-4 --json results/sweeps.json
  scripts/evaluate_sweeps.py --rate 5,10,20 --yaw 20 --arg=--deskew=off

Exit status: 0 all runs gave a map, 1 some did not, 2 wrong usage."""


@dataclass(frozen=True)
class Outcome:
    """Of one log; `fault`: why there is no map. `sweep_time_s` is what the program took, 0 for nothing."""

    rate_hz: float
    yaw_deg: float
    seed: int
    num_scans: int
    num_placed: int = 0
    num_right: int = 0
    ate_m: float = math.nan
    worst_m: float = math.nan
    sweep_time_s: float = 0.0
    cpu_s: float = 0.0
    fault: str = ""


def run(options: SweepOptions, seed: int, mapper: Mapper, logs: Path | None) -> Outcome:
    simulation = simulate_sweeps(seed, options)
    truth = simulation.map_from_laser
    text = sweep_text(simulation)
    if logs:
        name = f"sweeps-{options.rate_hz:g}hz-{options.yaw_deg:g}deg-{seed}"
        write_whole(logs / f"{name}.nist", text)
        write_whole(logs / f"{name}.tum", "".join(map(tum_line, simulation.timestamps_s, truth)))
    start = Outcome(options.rate_hz, options.yaw_deg, seed, len(truth))
    with tempfile.TemporaryDirectory(prefix="sweeps_") as folder:
        log = Path(folder) / "log.nist"
        log.write_text(strip_nist(text), encoding="utf-8")
        try:
            report, usage = mapper.run([log], Path(folder))
        except Failure as failure:
            return Outcome(**{**asdict(start), "fault": str(failure)})
    placed = placed_poses(report)
    errors_m = absolute_errors_m(report, [truth])
    found = {
        "num_placed": len(placed),
        "num_right": sum(pairs(truth, [placed])["right"]),
        "ate_m": root_mean_square(errors_m),
        "worst_m": float(np.max(errors_m, initial=0.0)),
        "sweep_time_s": (report["logs"][0].get("sweeps") or {}).get("sweep_time_s", 0.0),
        "cpu_s": usage.cpu_s,
    }
    return Outcome(**{**asdict(start), **found})


def table(outcomes: list[Outcome]) -> str:
    lines = [
        "| rate | yaw | seed | scans | placed | right pairs | ATE | worst | sweep time | CPU |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for one in outcomes:
        walk = f"| {one.rate_hz:g} Hz | {one.yaw_deg:g} deg | {one.seed} | {one.num_scans} "
        if one.fault:
            lines.append(f"{walk}| no map: {one.fault} | | | | | |")
            continue
        lines.append(
            f"{walk}| {one.num_placed} | {one.num_right} of {one.num_scans - 1} | {one.ate_m:.3f} m "
            f"| {one.worst_m:.2f} m | {one.sweep_time_s:.4f} s | {one.cpu_s:.1f} s |"
        )
    return "\n".join(lines)


def numbers(lowest: float, highest: float) -> Callable[[str], list[float]]:
    """What reads `1,2.5` as numbers between two limits."""
    one = number(lowest, highest)
    return lambda text: [one(part) for part in text.split(",")]


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--yaw", type=numbers(0, 180), default=[20.0], metavar="LIST", help="the laser sways by so many degrees")
    add("--yaw-hz", type=number(0, 10), default=1.0, metavar="HZ", help="so often (default %(default)s)")
    add("--rate", type=numbers(1, 50), default=[7.0], metavar="LIST", help="sweeps a second (default 7)")
    add("--share", type=number(0, 1), default=1.0, metavar="X", help="of its period that a sweep takes (default 1)")
    add("--seconds", type=number(1, 3600), default=40.0, metavar="S", help="of the walk at most (default 40)")
    add("--seeds", type=parse_seeds, default=parse_seeds("0-4"), metavar="LIST", help="such as 0-4 (default) or 1,5")
    add("--jobs", type=number(1, 256, int), default=2, metavar="N", help="logs at the same time (default 2)")
    add("--logs", type=Path, metavar="DIR", help="write the logs, with true poses, and these alone as TUM")
    add_mapper_arguments(parser)
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
    with ProcessPoolExecutor(max_workers=arguments.jobs) as pool:
        futures = [
            pool.submit(run, walk, seed, mapper, arguments.logs) for walk, seed in product(walks, arguments.seeds)
        ]
        outcomes = [future.result() for future in futures]
    print(table(outcomes))
    if arguments.json:
        content = {"arguments": arguments.arg, "runs": [without_nan(asdict(one)) for one in outcomes]}
        write_whole(arguments.json, json.dumps(content, indent=1) + "\n")
    return 1 if any(one.fault for one in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
