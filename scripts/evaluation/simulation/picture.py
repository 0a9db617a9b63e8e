# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a run, drawn without a display."""

from __future__ import annotations

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from evaluation.common.poses import transform

from .sensor import points_of
from .simulation import Simulation
from .world import World, arc_outline, face_outline

COLOURS = {
    "hall": "#202020",
    "wall": "#202020",
    "odd wall": "#7a4a1e",
    "box": "#c07820",
    "rubble": "#8a8a5a",
    "board": "#d04848",
    "barrel": "#2878b8",
    "tube": "#28a0a0",
    "curved wall": "#7848b0",
    "step field": "#389048",
}


def draw_world(axes: Axes, world: World, height_m: float) -> None:
    """Every object that reaches the laser's plane in its colour, lower ones faint."""
    for kind, colour in COLOURS.items():
        lines = [(face_outline(f, height_m), f.top_m) for f in world.faces if f.kind == kind]
        lines += [(arc_outline(a), a.top_m) for a in world.arcs if a.kind == kind]
        for seen, alpha in ((True, 1.0), (False, 0.3)):
            outlines = [line for line, top in lines if (top >= height_m) == seen]
            if outlines:
                label = kind if seen else None
                axes.add_collection(LineCollection(outlines, colors=colour, linewidths=1.2, alpha=alpha, label=label))


def draw_run(axes: Axes, simulation: Simulation, scan: int) -> None:
    """Route, positions with their numbers, and one scan as it truly hit."""
    stops, world = simulation.drive.map_from_robot, simulation.world
    axes.plot(*world.route.T, ":", color="#999999", linewidth=0.8, label="route")
    axes.plot(stops[:, 0], stops[:, 1], "-", color="#e030a0", linewidth=0.8)
    axes.plot(stops[:, 0], stops[:, 1], "o", color="#e030a0", markersize=4, label="positions")
    for k, (x, y, _) in enumerate(stops):
        axes.annotate(str(k), (x, y), xytext=(3, 3), textcoords="offset points", fontsize=7, color="#a01070")
    beams = simulation.options.sensor.beam_angles_rad()
    for sub_scan, ranges in enumerate(simulation.ranges[scan]):
        points = transform(simulation.drive.map_from_sub_scan[scan, sub_scan], points_of(ranges, beams))
        label = f"scan {scan}" if sub_scan == 0 else None
        axes.plot(points[:, 0], points[:, 1], ".", color="#ff5020", markersize=1.5, label=label)


def save_picture(path: Path, simulation: Simulation, scan: int | None = None) -> None:
    """World, route and one scan (the middle one unless told) as an image."""
    figure = Figure(figsize=(10, 6.6), layout="constrained")
    axes = figure.add_subplot()
    draw_world(axes, simulation.world, simulation.options.sensor.height_m)
    draw_run(axes, simulation, len(simulation.ranges) // 2 if scan is None else scan)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    figure.legend(loc="outside lower center", ncols=7, fontsize=8, frameon=False, markerscale=2)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=90, metadata={"Software": None})
