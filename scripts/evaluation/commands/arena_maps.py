# SPDX-License-Identifier: GPL-3.0-or-later
"""Map simulated arenas with shapemap-cli and count the maps that are whole and right everywhere."""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

from evaluation.common.command_line import (
    add_jobs,
    add_json,
    add_method,
    add_passed_on,
    add_program,
    add_seeds,
    add_timeout,
    command_parser,
    complain,
    require_program,
)
from evaluation.common.files import write_json, write_whole
from evaluation.common.parallel import run_all
from evaluation.common.poses import Array
from evaluation.common.programs import Failure
from evaluation.common.tum import read_tum
from evaluation.judging.known_surfaces import laid_together
from evaluation.judging.whole_maps import (
    WholeMap,
    fragment_errors,
    judge,
    link_outcomes,
    links_table,
    lost_map,
    mean_of_sub_scans,
    not_right,
    summary,
)
from evaluation.mapping.mapper import Mapper
from evaluation.simulation.arena_options import add_arena_arguments, options_from
from evaluation.simulation.simulation import Simulation, simulate
from evaluation.simulation.write import nist_text

EXAMPLE = """example:
  scripts/evaluate.py arena-maps --seeds 0-39 --spacing-m 1.5 --heading-uncertainty-deg 180 --json results/maps.json
  scripts/evaluate.py arena-maps --seeds 0-39 --arg=--split-below --arg=0.3 --pictures results/arena_maps

Errors of a map, and of each fragment beside it, are those left after the planar motion that fits its positions best.
Exit status: 0 all runs gave a map, 1 some did not, 2 wrong usage."""


CEILINGS: dict[str, Callable[[Simulation], dict[int, Array]]] = {
    "sub-scans": lambda simulation: mean_of_sub_scans(simulation.drive),
    "beams": laid_together,
}


def read_fragments(folder: Path, simulation: Simulation) -> list[dict[int, Array]]:
    """The map, then the fragments beside it, as poses by index of the position."""
    index_of = {round(float(time), 3): k for k, time in enumerate(simulation.drive.timestamps_s)}
    paths = [folder / "map.tum", *sorted((folder / "fragments").glob("fragment_*.tum"))]
    return [{index_of[round(time, 3)]: pose for time, pose in read_tum(path)} for path in paths]


def save_picture(folder: Path, seed: int, simulation: Simulation, fragments: list[dict[int, Array]]) -> None:
    """Where the positions are in the world, and where the map has them."""
    from evaluation.judging.map_picture import save_map_picture  # matplotlib only when pictures are asked for

    judged = [fragment_errors(fragment, simulation.drive.map_from_robot) for fragment in fragments if fragment]
    save_map_picture(folder / f"seed{seed:03d}.png", simulation, fragments, judged)


def run_seed(seed: int, arguments: argparse.Namespace) -> WholeMap:
    """Simulate, map and judge one seed in a folder of its own."""
    simulation = simulate(options_from(arguments, seed))
    truth = simulation.drive.map_from_robot
    if arguments.ceiling:
        return judge(seed, truth, [CEILINGS[arguments.ceiling](simulation)])
    passed_on = ("--threads", "1", "--method", arguments.method, *arguments.arg)
    mapper = Mapper(arguments.cli, passed_on, arguments.timeout_s)
    with tempfile.TemporaryDirectory(prefix=f"arena{seed}_") as name:
        folder = Path(name)
        write_whole(folder / "arena.nist", nist_text(simulation))
        outputs = ["--trajectory", folder / "map.tum", "--fragments", folder / "fragments"]
        try:
            report, _ = mapper.run([folder / "arena.nist"], folder, more=outputs)
        except Failure as failure:
            return lost_map(seed, len(truth), str(failure))
        fragments = read_fragments(folder, simulation)
    links = link_outcomes(report.get("scans", []), truth)
    result = judge(seed, truth, fragments, report.get("seconds", {}).get("wall"), links)
    if arguments.pictures and result.verdict != "right":
        save_picture(arguments.pictures, seed, simulation, fragments)
    return result


def add_ceiling(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--ceiling",
        choices=tuple(CEILINGS),
        nargs="?",
        const="sub-scans",
        help="judge what is known without finding a place, instead of a map: what the true poses of all sub-scans say "
        "(the default), or what their beams say to one who knows which of them met which upright flat face",
    )


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add_seeds(parser, "0-39", of="seeds of the arenas, ")
    add_program(parser)
    add_method(parser)
    add_passed_on(parser)
    add_ceiling(parser)
    add_jobs(parser, "arenas")
    add_timeout(parser, 300.0)
    add_json(parser, "what became of each seed, with its largest errors")
    parser.add_argument(
        "--pictures", type=Path, metavar="DIR", help="write a picture of each map that is not whole and right"
    )
    add_arena_arguments(parser)
    parser.set_defaults(heading_uncertainty_deg=180.0)  # the hardest: as in the figures of the docs
    arguments = parser.parse_args(argv)
    if not arguments.ceiling:
        require_program(parser, arguments)
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        maps = run_all(run_seed, [(seed, arguments) for seed in arguments.seeds], arguments.jobs)
    except ValueError as error:
        complain(__name__, str(error))
        return 2
    print("\n\n".join(part for part in (summary(maps), links_table(maps), not_right(maps)) if part))
    if arguments.json:
        rows = [{**asdict(one), "verdict": one.verdict} for one in maps]
        write_json(arguments.json, {"options": vars(arguments), "maps": rows})
    return 1 if any(one.fault for one in maps) else 0
