# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulate a robot that goes round the same office again and again, map the first scans of its log, more of them, and
so on with shapemap-cli, and tell how CPU time per scan and memory grow, and how good the map is."""

from __future__ import annotations

import argparse
import math
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from tqdm import tqdm

from evaluation.common.argument_types import number
from evaluation.common.command_line import command_parser, complain
from evaluation.common.files import write_json, write_whole
from evaluation.common.programs import Failure
from evaluation.common.sampling import Sampler
from evaluation.judging.absolute_errors import absolute_errors_m, root_mean_square
from evaluation.judging.growth import (
    Growth,
    first_and_last,
    memory_line,
    milestone_table,
    prefixes,
    quarters,
    stretches,
    table,
    wrong_places,
)
from evaluation.logs.reference_log import strip_nist
from evaluation.mapping.mapper import Mapper
from evaluation.mapping.options import add_mapper_arguments, mapper_from
from evaluation.mapping.report import placed_poses
from evaluation.simulation.long_walk import WalkOptions, simulate_walk
from evaluation.simulation.simulation import Simulation
from evaluation.simulation.write import nist_text, tum_text

EXAMPLE = """The office is 40 x 25 m, with rooms on both sides of a corridor all around; each lap is somewhat different,
the robot goes into some of the rooms and turns back at times. The laser has 181 beams and noise; there is no odometry.

What a part of the log takes to read is told of the longest run, and of all of it, with the final solving, by the
differences between runs: measure on an idle machine.

example:
  scripts/evaluate.py long-log --scans 20000 --prefixes 20000 --json results/long.json
  scripts/evaluate.py long-log --scans 4000 --step-m 0.05 --last 500 --log results/walk.nist

Exit status: 0 all runs gave a map, 1 some did not, 2 wrong usage."""


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    walk = WalkOptions()
    add = parser.add_argument
    for name, kind, default, metavar, what in (
        ("--scans", number(1, 10**6, int), walk.num_scans, "N", "scans of the whole log"),
        ("--step-m", number(0.001, 10), walk.step_m, "M", "between scans, give or take a quarter"),
        ("--turn-deg", number(0.1, 180), walk.turn_deg, "DEG", "a scan is taken at the latest after such a turn"),
        ("--last", number(1, 10**6, int), 1000, "N", "so many scans at the end are compared with those at the start"),
        ("--seed", number(0, 2**31 - 1, int), 0, "N", "of office, furniture, walk and noise"),
    ):
        add(name, type=kind, default=default, metavar=metavar, help=f"{what} (default %(default)s)")
    add("--prefixes", metavar="LIST", help="lengths to map, such as 1000,2000,4000 (default 1, 2, 5, 10 ... thousand)")
    add("--log", type=Path, metavar="FILE.nist", help="write the log, with true poses; and FILE.tum, those alone")
    add("--no-mapping", action="store_true", help="only make the log")
    add_mapper_arguments(parser, timeout_s=86400.0)
    arguments = parser.parse_args(argv)
    try:
        words = arguments.prefixes.split(",") if arguments.prefixes else prefixes(arguments.scans, arguments.last)
        arguments.lengths = sorted({int(word) for word in words})
    except ValueError:
        parser.error(f"--prefixes: expected numbers such as 1000,2000, found {arguments.prefixes}")
    if not 0 < arguments.lengths[0] <= arguments.lengths[-1] <= arguments.scans:
        parser.error(f"--prefixes: expected lengths from 1 to --scans ({arguments.scans})")
    return arguments


def first_scans(simulation: Simulation, num: int) -> Simulation:
    run = simulation.drive
    part = replace(
        run,
        timestamps_s=run.timestamps_s[:num],
        map_from_robot=run.map_from_robot[:num],
        map_from_sub_scan=run.map_from_sub_scan[:num],
        gradient=run.gradient[:num],
    )
    return replace(simulation, drive=part, ranges=simulation.ranges[:num])


@contextmanager
def written(simulation: Simulation) -> Iterator[Path]:
    """A folder with the log, without poses."""
    with tempfile.TemporaryDirectory(prefix="long_") as name:
        (Path(name) / "walk.nist").write_text(strip_nist(nist_text(simulation, "walk")), encoding="utf-8")
        yield Path(name)


def measured(simulation: Simulation, mapper: Mapper) -> Growth:
    num = len(simulation.ranges)
    with written(simulation) as folder, Sampler() as sampler:
        try:
            report, usage = mapper.run([folder / "walk.nist"], folder, sampler.watch)
        except Failure as failure:
            return Growth(num, str(failure))
    errors_m = absolute_errors_m(report, [simulation.drive.map_from_robot])
    return Growth(
        num,
        cpu_s=usage.cpu_s,
        wall_s=usage.wall_s,
        peak_memory_mib=usage.peak_memory_mib,
        num_keyframes=sum(position["is_keyframe"] for position in report["scans"]),
        num_placed=report["num_placed"],
        ate_m=root_mean_square(errors_m),
        worst_m=float(errors_m.max()) if len(errors_m) else math.nan,
        far_off=stretches(dict(zip(sorted(placed_poses(report)), errors_m.tolist()))),
        stages_s=report["seconds"],
        milestones=report.get("milestones", []),
        samples=sampler.samples,
    )


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    options = WalkOptions(num_scans=arguments.scans, step_m=arguments.step_m, turn_deg=arguments.turn_deg)
    simulation = simulate_walk(arguments.seed, options)
    if arguments.log:
        write_whole(arguments.log, nist_text(simulation, "walk"))
        write_whole(arguments.log.with_suffix(".tum"), tum_text(simulation))
    if arguments.no_mapping:
        return 0
    runs: list[Growth] = []
    for num in tqdm(arguments.lengths, desc="mapping", disable=None, leave=False):
        runs.append(measured(first_scans(simulation, num), mapper_from(arguments)))
        if runs[-1].fault:
            complain(__name__, f"{num} scans: {runs[-1].fault}")
        if arguments.json:  # after each: the longer ones may take hours
            about = {"walk": options, "seed": arguments.seed, "arguments": arguments.arg}
            write_json(arguments.json, {**about, "runs": runs})
    lines = [
        table(runs),
        "\n".join(filter(None, map(wrong_places, runs))),
        first_and_last(runs, arguments.last),
        milestone_table(runs[-1]),
        quarters(runs[-1]),
        memory_line(runs[-1]),
    ]
    print("\n\n".join(line for line in lines if line))
    return 1 if any(run.fault for run in runs) else 0
