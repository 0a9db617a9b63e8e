#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Map simulated arenas with shapemap-cli and count the maps that are whole and right everywhere."""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import Any

from evaluate_arena import ROOT, parse_seeds, run_mapper
from shapemap_sim.known_surfaces import laid_together
from shapemap_sim.poses import Array
from shapemap_sim.read import read_tum
from shapemap_sim.simulation import Simulation, simulate
from shapemap_sim.whole_maps import (
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
from shapemap_sim.write import nist_text, without_nan, write_whole
from simulate_arena import add_arena_arguments, number, options_from

EXAMPLE = """example:
  scripts/evaluate_arena_maps.py --seeds 0-39 --spacing-m 1.5 --heading-uncertainty-deg 180 --json results/maps.json
  scripts/evaluate_arena_maps.py --seeds 0-39 --arg=--split-below --arg=0.3 --pictures results/arena_maps

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
    from shapemap_sim.map_picture import save_map_picture  # matplotlib only when pictures are asked for

    judged = [fragment_errors(fragment, simulation.drive.map_from_robot) for fragment in fragments if fragment]
    save_map_picture(folder / f"seed{seed:03d}.png", simulation, fragments, judged)


def run_seed(seed: int, arguments: argparse.Namespace) -> WholeMap:
    """Simulate, map and judge one seed in a folder of its own."""
    simulation = simulate(options_from(arguments, seed))
    truth = simulation.drive.map_from_robot
    if arguments.ceiling:
        return judge(seed, truth, [CEILINGS[arguments.ceiling](simulation)])
    with tempfile.TemporaryDirectory(prefix=f"arena{seed}_") as name:
        folder = Path(name)
        write_whole(folder / "arena.nist", nist_text(simulation))
        outputs = {
            "--out": "map.png",
            "--trajectory": "map.tum",
            "--fragments": "fragments",
            "--report": "report.json",
        }
        command = [str(arguments.cli), "--nist", str(folder / "arena.nist"), "--quiet", "--threads", "1"]
        command += [part for option, file in outputs.items() for part in (option, str(folder / file))]
        command += ["--method", arguments.method, *arguments.arg]
        report, fault = run_mapper(command, folder / "report.json", arguments.timeout_s)
        if report is None:
            return lost_map(seed, len(truth), fault)
        fragments = read_fragments(folder, simulation)
    links = link_outcomes(report.get("positions", []), truth)
    result = judge(seed, truth, fragments, report.get("seconds", {}).get("wall"), links)
    if arguments.pictures and result.verdict != "right":
        save_picture(arguments.pictures, seed, simulation, fragments)
    return result


def map_dict(one: WholeMap) -> dict[str, Any]:
    return without_nan({**asdict(one), "verdict": one.verdict})


def as_json(maps: list[WholeMap], arguments: argparse.Namespace) -> str:
    options = {key: str(value) if isinstance(value, Path) else value for key, value in vars(arguments).items()}
    return json.dumps({"options": options, "maps": [map_dict(one) for one in maps]}, indent=1) + "\n"


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add(
        "--seeds",
        type=parse_seeds,
        default=parse_seeds("0-39"),
        metavar="LIST",
        help="seeds of the arenas, such as 0-39 or 1,5,8 (default 0-39)",
    )
    add(
        "--cli",
        type=Path,
        default=ROOT / "build/release/bin/shapemap-cli",
        metavar="FILE",
        help="the mapper (default build/release/bin/shapemap-cli)",
    )
    add("--method", choices=("robust", "paper"), default="robust", help="of alignment (default %(default)s)")
    add("--arg", action="append", default=[], metavar="ARG", help="passed on to the mapper; repeat for more")
    add(
        "--ceiling",
        choices=tuple(CEILINGS),
        nargs="?",
        const="sub-scans",
        help="judge what is known without finding a place, instead of a map: what the true poses of all sub-scans say "
        "(the default), or what their beams say to one who knows which of them met which upright flat face",
    )
    add("--jobs", type=number(1, 256, int), default=2, metavar="N", help="arenas at the same time (default 2)")
    add("--timeout-s", type=number(1, 86400), default=300.0, metavar="S", help="for one arena (default 300)")
    add("--json", type=Path, metavar="FILE", help="write what became of each seed, with its largest errors")
    add("--pictures", type=Path, metavar="DIR", help="write a picture of each map that is not whole and right")
    add_arena_arguments(parser)
    parser.set_defaults(heading_uncertainty_deg=180.0)  # the hardest: as in the figures of the docs
    arguments = parser.parse_args(argv)
    if not arguments.ceiling and not os.access(arguments.cli, os.X_OK):
        parser.error(f"--cli: {arguments.cli} is not a program; build it with `cmake --build --preset release`")
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    with ProcessPoolExecutor(max_workers=arguments.jobs) as pool:
        futures = [pool.submit(run_seed, seed, arguments) for seed in arguments.seeds]
        try:
            maps = [future.result() for future in futures]
        except ValueError as error:
            pool.shutdown(cancel_futures=True)
            print(f"evaluate_arena_maps.py: {error}", file=sys.stderr)
            return 2
    print("\n\n".join(part for part in (summary(maps), links_table(maps), not_right(maps)) if part))
    if arguments.json:
        write_whole(arguments.json, as_json(maps, arguments))
    return 1 if any(one.fault for one in maps) else 0


if __name__ == "__main__":
    sys.exit(main())
