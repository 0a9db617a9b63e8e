# SPDX-License-Identifier: GPL-3.0-or-later
"""The command-line options that describe a simulated arena, its robot and its laser."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

from evaluation.common.argument_types import number

from .arena import ArenaOptions
from .robot import RobotOptions
from .sensor import SensorOptions
from .simulation import SimulationOptions

Option = tuple[str, Callable[[str], Any], Any, str, str]  # name, type, default, metavar, help


def hard_arena(seed: int) -> SimulationOptions:
    """16 positions, 1.5 m apart, whose headings are unknown."""
    robot = RobotOptions(num_positions=16, spacing_m=1.5, heading_uncertainty_deg=180.0)
    return SimulationOptions(seed=seed, robot=robot)


def option_groups() -> dict[str, list[Option]]:
    """The options by the title of their group; each has the default of what it sets."""
    arena, robot, sensor = ArenaOptions(), RobotOptions(), SensorOptions()
    turn = robot.heading_uncertainty_deg
    error_deg, error_m = robot.sub_scan_heading_sigma_deg, robot.sub_scan_centre_sigma_m
    world: list[Option] = [("--clutter", number(0, 2), arena.clutter, "X", "0 is a bare maze, 1 is full")]
    drive: list[Option] = [
        ("--positions", number(1, 60, int), robot.num_positions, "N", "positions along the route"),
        ("--spacing-m", number(0.1, 10), robot.spacing_m, "M", "between consecutive positions, within 10 %%"),
        ("--heading-uncertainty-deg", number(0, 180), turn, "DEG", "a heading is within this of 0; 180: anything"),
        ("--heading-sigma-deg", number(0, 45), error_deg, "DEG", "error of each sub-scan's heading"),
        ("--centre-sigma-m", number(0, 1), error_m, "M", "error of each sub-scan's centre, in x and in y"),
        ("--tilt-deg", number(0, 30), robot.tilt_sigma_deg, "DEG", "tilt of the robot about each axis, sigma"),
    ]
    mixed = "beams at depth edges that report a range in between"
    laser: list[Option] = [
        ("--noise-m", number(0, 1), sensor.range_sigma_m, "M", "range noise, sigma"),
        ("--drop-outs", number(0, 1), sensor.drop_out_share, "SHARE", "beams that give no return"),
        ("--mixed-pixels", number(0, 1), sensor.mixed_pixel_share, "SHARE", mixed),
        ("--max-range-m", number(0.5, 1000), sensor.max_range_m, "M", "farther is no return"),
        ("--laser-height-m", number(0.05, 2), sensor.height_m, "M", "height of the laser above the floor"),
    ]
    return {"world": world, "robot": drive, "laser": laser}


def add_arena_arguments(parser: argparse.ArgumentParser) -> None:
    """The options that describe world, robot and sensor, in three groups."""
    for title, options in option_groups().items():
        group = parser.add_argument_group(title)
        for name, kind, default, metavar, what in options:
            text = f"{what} (default %(default)s)"
            group.add_argument(name, type=kind, default=default, metavar=metavar, help=text)


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
