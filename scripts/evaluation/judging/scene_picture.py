# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of a scene: the world with the true path, and the scans where the mapper put them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from PIL import Image

from evaluation.common.poses import Array, compose, transform
from evaluation.simulation.sensor import points_of
from evaluation.simulation.simulation import Simulation
from evaluation.simulation.world import arc_outline, face_outline

from .scene_outcomes import PairOutcome

TRUE_COLOUR, ESTIMATED_COLOUR, WORLD_COLOUR, GLASS_COLOUR = "#20a040", "#d02020", "#303030", "#50b0e0"
VERDICT_COLOURS = {"right": "#20a040", "doubted": "#e09000", "false": "#d02020"}


def estimated_poses(simulation: Simulation, outcomes: list[PairOutcome]) -> Array:
    """`[p, 3]` in the map, chained from the true first pose; NaN after a position without a place."""
    poses = [simulation.drive.map_from_robot[0]]
    for pair in outcomes:
        reference = pair.index - 1 if pair.reference is None else pair.reference
        poses.append(compose(poses[reference], pair.ref_from_query))
    return np.array(poses)


def draw_surfaces(axes: Axes, simulation: Simulation) -> None:
    height, world = simulation.options.sensor.height_m, simulation.world
    for colour, glass in ((WORLD_COLOUR, False), (GLASS_COLOUR, True)):
        lines = [face_outline(f, height) for f in world.faces if (f.kind == "glass") == glass]
        lines += [] if glass else [arc_outline(arc) for arc in world.arcs]
        if lines:
            axes.add_collection(LineCollection(lines, colors=colour, linewidths=0.8))


def draw_scans(axes: Axes, simulation: Simulation, poses: Array, size: float) -> None:
    """The scans under these poses, from the first in blue to the last in red."""
    beams, colours = simulation.options.sensor.beam_angles_rad(), Normalize(0, len(poses) - 1)
    for k, pose in enumerate(poses):
        points = transform(pose, points_of(simulation.ranges[k, 0], beams))
        axes.scatter(
            points[:, 0],
            points[:, 1],
            s=size,
            c=np.full(len(points), k),
            cmap="turbo",
            norm=colours,
            linewidths=0,
        )


def verdict_of(pair: PairOutcome) -> str:
    if pair.right:
        return "right"
    return "false" if pair.falsely_certain or pair.called_ok else "doubted"


def draw_path(axes: Axes, poses: Array, colour: str, label: str, heading_m: float) -> None:
    axes.plot(poses[:, 0], poses[:, 1], "-", color=colour, linewidth=0.9, label=label)
    ahead = poses[:, :2] + heading_m * np.stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])], axis=-1)
    axes.add_collection(LineCollection(list(np.stack([poses[:, :2], ahead], axis=1)), colors=colour, linewidths=0.9))


def draw_marks(axes: Axes, poses: Array, outcomes: list[PairOutcome]) -> None:
    """Each position that was aligned, by what became of it."""
    names = {"right": "right", "doubted": "wrong, and called so", "false": "wrong, called ok"}
    for verdict, colour in VERDICT_COLOURS.items():
        found = [pair.index for pair in outcomes if verdict_of(pair) == verdict]
        if found:
            axes.plot(poses[found, 0], poses[found, 1], "o", color=colour, markersize=4, label=names[verdict], zorder=4)


def frame(axes: Axes, simulation: Simulation, poses: Array) -> None:
    """Shows all of the world that the scans reach, and the estimated path."""
    stops, sensor = simulation.drive.map_from_robot, simulation.options.sensor
    seen = [
        transform(pose, points_of(ranges[0], sensor.beam_angles_rad()))
        for pose, ranges in zip(stops, simulation.ranges)
    ]
    shown = np.concatenate([*seen, stops[:, :2], poses[np.isfinite(poses[:, 0]), :2]])
    low, high = shown.min(axis=0) - 0.4, shown.max(axis=0) + 0.4
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    axes.tick_params(labelsize=7)


def save_scene(path: Path, title: str, simulation: Simulation, outcomes: list[PairOutcome]) -> None:
    """World and truth on one side, the estimate on the other; side by side or, for long scenes, one above the other."""
    poses, truth = estimated_poses(simulation, outcomes), simulation.drive.map_from_robot
    spread = np.ptp(truth[:, :2], axis=0) + 4.0
    wide = bool(spread[0] > 2.5 * spread[1])
    figure = Figure(figsize=(9.5, 6.0) if wide else (10.5, 4.8), layout="constrained")
    left, right = figure.subplots(2, 1) if wide else figure.subplots(1, 2)
    draw_surfaces(left, simulation)
    draw_scans(left, simulation, truth, 1.5)
    draw_path(left, truth, TRUE_COLOUR, "true path", 0.25)
    figure.suptitle(title, fontsize=10)
    left.set_title("the world, and the scans as they were", fontsize=9)
    draw_scans(right, simulation, poses, 1.5)
    draw_path(right, truth, TRUE_COLOUR, "true path", 0.25)
    draw_path(right, poses, ESTIMATED_COLOUR, "estimated path", 0.25)
    draw_marks(right, poses, outcomes)
    num_right, ok = sum(p.right for p in outcomes), sum(p.called_ok for p in outcomes)
    right.set_title(f"as mapped: {num_right} of {len(outcomes)} pairs right, {ok} called ok", fontsize=9)
    for axes in (left, right):
        frame(axes, simulation, poses)
    figure.legend(*right.get_legend_handles_labels(), loc="outside lower center", ncols=5, fontsize=8, frameon=False)
    save_small(figure, path)


@dataclass(frozen=True)
class Panel:
    title: str
    simulation: Simulation
    outcomes: list[PairOutcome]


def save_panels(path: Path, panels: list[Panel], columns: int = 4) -> None:
    """The scans of several scenes where the mapper put them."""
    rows = -(-len(panels) // columns)
    figure = Figure(figsize=(3.2 * columns, 2.9 * rows), layout="constrained")
    for axes, panel in zip(figure.subplots(rows, columns, squeeze=False).flat, panels):
        poses = estimated_poses(panel.simulation, panel.outcomes)
        draw_scans(axes, panel.simulation, poses, 0.8)
        draw_path(axes, poses, ESTIMATED_COLOUR, "estimated path", 0.25)
        draw_marks(axes, poses, panel.outcomes)
        right = sum(p.right for p in panel.outcomes)
        axes.set_title(f"{panel.title}\n{right} of {len(panel.outcomes)} pairs right", fontsize=7)
        frame(axes, panel.simulation, poses)
    save_small(figure, path)


def save_small(figure: Figure, path: Path) -> None:
    """Few colours are enough, and a third of the bytes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=80, metadata={"Software": None})
    with Image.open(path) as image:
        small = image.convert("RGB").quantize(48)
    small.save(path, optimize=True)
