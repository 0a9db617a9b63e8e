# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 5 and 6: maps, poses and their errors."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from evaluation.common.poses import Array, transform

from .drawing import CM, draw_points, in_cm, new_figure, show_around
from .trace import Trace

MOST_LABELS = 20


def map_points(trace: Trace, poses: Mapping[int, Array], corrected: bool) -> Array:
    """All returns `[n, 2]` of the positions in `poses`; `corrected`: with the corrections by decoupled ICP."""
    parts = [np.zeros((0, 2))]
    for index, pose in poses.items():
        position = trace.positions[index]
        corrections = trace.corrections(index) if corrected else np.zeros((len(position.scan_points), 3))
        parts.append(transform(pose, position.corrected_scan(corrections)))
    return np.concatenate(parts)


def map_figure(title: str, points: Array, shown: Array, places: Array) -> Figure:
    """5: a map as dots. The limits are those of the points `shown` and of the positions `places` `[n, 2]`, so that maps
    can be compared by eye."""
    figure, axes = new_figure(title, 7.0, 5.0)
    draw_points(axes, points, "black", size=1.2)
    in_cm(axes)
    show_around(axes, shown, places)
    return figure


def poses_figure(estimated: Mapping[int, Array], reference: Mapping[int, Array]) -> Figure:
    """6a: estimated and reference poses, both in the frame of the first."""
    figure, axes = new_figure("6(a) estimated (plus) and reference (circle) poses", 7.0, 4.0)
    both = sorted(set(estimated) & set(reference))
    few = len(both) <= 100
    for poses, marker, colour, label in (
        (estimated, "+", "blue", "estimated"),
        (reference, "o", "red", "reference"),
    ):
        places = CM * np.array([poses[i][:2] for i in both])
        axes.plot(
            *places.T, linestyle="none", marker=marker, markersize=8 if few else 3, fillstyle="none", color=colour,
            label=label,
        )  # fmt: skip
    for i in both[:: -(-len(both) // MOST_LABELS) or 1]:
        axes.annotate(str(i), tuple(CM * reference[i][:2]), (5, 5), textcoords="offset points", fontsize=7)
    in_cm(axes)
    drawn = np.array([poses[i][:2] for poses in (estimated, reference) for i in both])
    show_around(axes, drawn, drawn)
    axes.legend(fontsize=7)
    return figure


def error_figure(errors_m: Mapping[int, float]) -> Figure:
    """6b: distance between estimated and reference position, pose by pose."""
    figure, axes = new_figure("6(b) position error", 7.0, 3.5)
    marker = "o" if len(errors_m) <= 100 else ""
    axes.plot(list(errors_m), [CM * error for error in errors_m.values()], marker=marker, markersize=4, color="blue")
    axes.set_xlabel("pose")
    axes.set_ylabel("position error [cm]")
    axes.set_ylim(bottom=0.0)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.grid(alpha=0.3)
    return figure
