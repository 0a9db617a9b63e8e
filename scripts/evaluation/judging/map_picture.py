# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of a whole map: the world, where the positions truly are, and where the map has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from evaluation.common.poses import Array, compose, transform
from evaluation.simulation.picture import draw_world
from evaluation.simulation.sensor import points_of
from evaluation.simulation.simulation import Simulation

from .whole_maps import FragmentErrors

COLOURS = ("#d02020", "#2060d0", "#209040", "#9040c0", "#c08020")


def scan_points(simulation: Simulation, index: int, map_from_robot: Array) -> Array:
    """Points `[n, 2]` of a position where the map has it, at its nominal headings."""
    beams, drive = simulation.options.sensor.beam_angles_rad(), simulation.drive
    parts = [
        transform(np.array([0.0, 0.0, heading]), points_of(ranges, beams))
        for heading, ranges in zip(drive.nominal_headings_rad, simulation.ranges[index])
    ]
    return transform(map_from_robot, np.concatenate(parts))


def save_map_picture(
    path: Path, simulation: Simulation, fragments: Sequence[Mapping[int, Array]], judged: Sequence[FragmentErrors]
) -> None:
    """Truth grey; each fragment in a colour of its own, moved to where it fits best."""
    figure = Figure(figsize=(10, 6.6), layout="constrained")
    axes = figure.add_subplot()
    draw_world(axes, simulation.world, simulation.options.sensor.height_m)
    truth = simulation.drive.map_from_robot
    axes.plot(truth[:, 0], truth[:, 1], "o-", color="#808080", markersize=7, linewidth=0.8)
    for number, (fragment, errors) in enumerate(zip([f for f in fragments if f], judged)):
        colour = COLOURS[number % len(COLOURS)]
        for index, error_m, error_deg in zip(errors.indices, errors.errors_m, errors.errors_deg):
            pose = compose(errors.truth_from_map, fragment[index])
            points = scan_points(simulation, index, pose)
            axes.plot(points[:, 0], points[:, 1], ",", color=colour, alpha=0.5)
            axes.plot(*pose[:2], "o", color=colour, markersize=4)
            label = f"{index}: {100 * error_m:.0f} cm, {error_deg:.1f} deg"
            axes.annotate(label, pose[:2], xytext=(4, 4), textcoords="offset points", fontsize=6, color=colour)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110, metadata={"Software": None})
