#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulate a rescue robot's laser log in a maze-like arena, in the manner of NIST's, with exact reference poses."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Collection
from pathlib import Path
from typing import Any

import numpy as np

from shapemap_sim.arena import ArenaOptions
from shapemap_sim.poses import Array
from shapemap_sim.robot import RobotOptions
from shapemap_sim.sensor import SensorOptions
from shapemap_sim.simulation import Simulation, SimulationOptions, consecutive_overlaps, simulate, travel_visible
from shapemap_sim.write import nist_text, truth_text, tum_text, write_whole

FORMATS = ("nist", "tum", "truth")
EXAMPLE = """example:
  scripts/simulate_arena.py --seed 0 --out results/arena --picture results/arena_world.png
    writes results/arena.nist (the log), results/arena.tum (reference poses) and results/arena.truth.json
    (true pose of every sub-scan); `shapemap-cli convert` makes other log formats from the .nist file"""


def number(low: float, high: float, kind: Callable[[str], Any] = float) -> Callable[[str], Any]:
    """An argparse type: a number within limits."""

    def parse(text: str) -> Any:
        value = kind(text)
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text} is not in {low} to {high}")
        return value

    parse.__name__ = "number"
    return parse


def some_of(known: Collection[str], at_least: int = 0) -> Callable[[str], list[str]]:
    """An argparse type: names with commas between, in the order given."""

    def parse(text: str) -> list[str]:
        names = [name for name in text.split(",") if name]
        unknown = sorted(set(names) - set(known))
        if unknown or len(names) < at_least:
            said = f"unknown {', '.join(unknown)}" if unknown else "nothing chosen"
            raise argparse.ArgumentTypeError(f"{said}; expected some of {', '.join(known)}")
        return names

    parse.__name__ = "list"
    return parse


def add_arena_arguments(parser: argparse.ArgumentParser) -> None:
    """The options that describe world, robot and sensor; also used by evaluate_arena.py."""
    arena, robot, sensor = ArenaOptions(), RobotOptions(), SensorOptions()
    world = parser.add_argument_group("world")
    world.add_argument(
        "--clutter",
        type=number(0, 2),
        default=arena.clutter,
        metavar="X",
        help="0 is a bare maze, 1 is full (default %(default)s)",
    )
    drive = parser.add_argument_group("robot")
    drive.add_argument(
        "--positions",
        type=number(1, 60, int),
        default=robot.num_positions,
        metavar="N",
        help="positions along the route (default %(default)s)",
    )
    drive.add_argument(
        "--spacing-m",
        type=number(0.1, 10),
        default=robot.spacing_m,
        metavar="M",
        help="distance between consecutive positions, within 10 %% (default %(default)s)",
    )
    drive.add_argument(
        "--heading-uncertainty-deg",
        type=number(0, 180),
        default=robot.heading_uncertainty_deg,
        metavar="DEG",
        help="a position's heading is within this of 0; 180: anything " "(default %(default)s)",
    )
    drive.add_argument(
        "--heading-sigma-deg",
        type=number(0, 45),
        default=robot.sub_scan_heading_sigma_deg,
        metavar="DEG",
        help="error of each sub-scan's heading (default %(default)s)",
    )
    drive.add_argument(
        "--centre-sigma-m",
        type=number(0, 1),
        default=robot.sub_scan_centre_sigma_m,
        metavar="M",
        help="error of each sub-scan's centre, in x and in y (default %(default)s)",
    )
    drive.add_argument(
        "--tilt-deg",
        type=number(0, 30),
        default=robot.tilt_sigma_deg,
        metavar="DEG",
        help="tilt of the robot about each axis, sigma (default %(default)s)",
    )
    laser = parser.add_argument_group("laser")
    laser.add_argument(
        "--noise-m",
        type=number(0, 1),
        default=sensor.range_sigma_m,
        metavar="M",
        help="range noise, sigma (default %(default)s)",
    )
    laser.add_argument(
        "--drop-outs",
        type=number(0, 1),
        default=sensor.drop_out_share,
        metavar="SHARE",
        help="beams that give no return (default %(default)s)",
    )
    laser.add_argument(
        "--mixed-pixels",
        type=number(0, 1),
        default=sensor.mixed_pixel_share,
        metavar="SHARE",
        help="beams at depth edges that report a range in between (default %(default)s)",
    )
    laser.add_argument(
        "--max-range-m",
        type=number(0.5, 1000),
        default=sensor.max_range_m,
        metavar="M",
        help="farther is no return (default %(default)s)",
    )
    laser.add_argument(
        "--laser-height-m",
        type=number(0.05, 2),
        default=sensor.height_m,
        metavar="M",
        help="height of the laser above the floor (default %(default)s)",
    )


def options_from(arguments: argparse.Namespace, seed: int) -> SimulationOptions:
    """The options of a run; those without an argument keep their defaults."""
    return SimulationOptions(
        seed=seed,
        arena=ArenaOptions(clutter=arguments.clutter),
        robot=RobotOptions(
            num_positions=arguments.positions,
            spacing_m=arguments.spacing_m,
            heading_uncertainty_deg=arguments.heading_uncertainty_deg,
            sub_scan_heading_sigma_deg=arguments.heading_sigma_deg,
            sub_scan_centre_sigma_m=arguments.centre_sigma_m,
            tilt_sigma_deg=arguments.tilt_deg,
        ),
        sensor=SensorOptions(
            range_sigma_m=arguments.noise_m,
            drop_out_share=arguments.drop_outs,
            mixed_pixel_share=arguments.mixed_pixels,
            max_range_m=arguments.max_range_m,
            height_m=arguments.laser_height_m,
        ),
    )


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--seed",
        type=number(0, 2**31 - 1, int),
        default=0,
        metavar="N",
        help="the same seed and options give the same files (default %(default)s)",
    )
    parser.add_argument("--out", type=Path, required=True, metavar="PREFIX", help="files are PREFIX.nist and so on")
    parser.add_argument(
        "--formats", default=",".join(FORMATS), metavar="LIST", help="files to write, of %(default)s (default all)"
    )
    parser.add_argument("--picture", type=Path, metavar="FILE", help="draw world, route and one scan (PNG, SVG, PDF)")
    parser.add_argument("--quiet", action="store_true", help="no summary")
    add_arena_arguments(parser)
    arguments = parser.parse_args(argv)
    arguments.formats = arguments.formats.split(",")
    unknown = sorted(set(arguments.formats) - set(FORMATS))
    if unknown:
        parser.error(f"--formats: unknown {', '.join(unknown)}; expected some of {', '.join(FORMATS)}")
    return arguments


def write_files(prefix: Path, formats: list[str], simulation: Simulation, overlaps: Array) -> list[Path]:
    """The files of a run, by format name."""
    writers = {
        "nist": (".nist", lambda: nist_text(simulation)),
        "tum": (".tum", lambda: tum_text(simulation)),
        "truth": (".truth.json", lambda: truth_text(simulation, overlaps)),
    }
    written = []
    for name in formats:
        suffix, make_text = writers[name]
        path = prefix.with_name(prefix.name + suffix)
        write_whole(path, make_text())
        written.append(path)
    return written


def summary(simulation: Simulation, overlaps: Array) -> str:
    """A few lines about the run."""
    ranges = simulation.ranges
    returned = np.isfinite(ranges).mean()
    lines = [
        f"seed {simulation.options.seed}: {ranges.shape[0]} positions x {ranges.shape[1]} sub-scans x "
        f"{ranges.shape[2]} beams, {100 * returned:.1f} % of them returned",
        f"world: {len(simulation.world.faces)} flat and {len(simulation.world.arcs)} round faces",
    ]
    if len(overlaps):
        visible = travel_visible(simulation)
        lines += [
            f"overlap with the scan before: min {overlaps.min():.2f}, mean {overlaps.mean():.2f}, "
            f"max {overlaps.max():.2f}",
            "  each: " + " ".join(f"{value:.2f}" for value in overlaps),
            f"next position in sight: {visible.sum()} of {len(visible)}",
        ]
    return "\n".join(lines)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        simulation = simulate(options_from(arguments, arguments.seed))
        overlaps = consecutive_overlaps(simulation)
        written = write_files(arguments.out, arguments.formats, simulation, overlaps)
        if arguments.picture:
            from shapemap_sim.picture import save_picture  # matplotlib only when a picture is asked for

            save_picture(arguments.picture, simulation)
            written.append(arguments.picture)
    except (ValueError, OSError) as error:
        print(f"simulate_arena.py: {error}", file=sys.stderr)
        return 1
    if not arguments.quiet:
        print(summary(simulation, overlaps))
        print("wrote " + ", ".join(str(path) for path in written))
    return 0


if __name__ == "__main__":
    sys.exit(main())
