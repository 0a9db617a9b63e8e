# SPDX-License-Identifier: GPL-3.0-or-later
"""Map simulated arenas with shapemap-cli and count the maps that are whole and right everywhere."""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

from evaluation.common.command_line import command_parser, require_program
from evaluation.common.files import write_json, write_whole
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
from evaluation.mapping.options import add_arena_runs, arena_mapper, run_arenas
from evaluation.simulation.arena_options import options_from
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
    mapper = arena_mapper(arguments, "--threads", "1")
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
    add_ceiling(parser)
    parser.add_argument(
        "--pictures", type=Path, metavar="DIR", help="write a picture of each map that is not whole and right"
    )
    add_arena_runs(parser, "what became of each seed, with its largest errors")
    parser.set_defaults(heading_uncertainty_deg=180.0)  # the hardest: as in the figures of the docs
    arguments = parser.parse_args(argv)
    if not arguments.ceiling:
        require_program(parser, arguments)
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    maps = run_arenas(__name__, run_seed, arguments)
    print("\n\n".join(part for part in (summary(maps), links_table(maps), not_right(maps)) if part))
    if arguments.json:
        rows = [{**asdict(one), "verdict": one.verdict} for one in maps]
        write_json(arguments.json, {"options": vars(arguments), "maps": rows})
    return 1 if any(one.fault for one in maps) else 0
