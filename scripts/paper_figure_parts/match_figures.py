# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 3 and 4: correspondences between a query scan and its target."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from shapemap_sim.poses import Array, rotate, transform

from .drawing import CM, LINK, QUERY, TARGET, draw_legend, draw_lines, draw_points, in_cm, listed, new_figure
from .drawing import show_around
from .matches import RIGHT_M, Match

FRAME_MARGIN_M = 0.2


def draw_match(axes: Axes, match: Match, stage: str) -> None:
    """Target red, query cyan and not moved yet, correspondences blue."""
    many = "scans" if len(match.targets) > 1 else "scan"
    draw_points(axes, match.target_scan, TARGET, f"{many} {listed(match.targets)}", size=2.5)
    draw_points(axes, match.query_scan, QUERY, f"scan {match.query}", size=2.5)
    draw_lines(axes, match.pairs[stage], LINK, label="correspondences")
    in_cm(axes)
    show_around(axes, np.concatenate([match.target_scan, match.query_scan]))
    draw_legend(axes)


def right_text(match: Match, stage: str, truth: Array | None) -> str:
    """How many correspondences, and how many are right when that is known."""
    count = len(match.pairs[stage])
    if truth is None:
        return f"{count} correspondences"
    return f"{match.num_right(stage, truth)} of {count} correspondences right"


def right_pairs(match: Match, truth: Array) -> Array:
    """The correspondences by LCS that join what truly is one place."""
    pairs = match.pairs["lcs"]
    at_truth = transform(truth, rotate(pairs[:, 1], -match.rotation_rad))
    return pairs[np.hypot(*(at_truth - pairs[:, 0]).T) < RIGHT_M]


def correspondence_figure(match: Match, name: str, stage: str, truth: Array | None) -> Figure:
    """3a, 4a, 4b: the correspondences at one stage."""
    stages = {"lcs": "by LCS", "segments": "after the filters"}
    figure, axes = new_figure(
        f"{name} {listed(match.targets)} and {match.query}, {stages[stage]}: {right_text(match, stage, truth)}"
    )
    draw_match(axes, match, stage)
    return figure


def partial_map_figure(match: Match, truth: Array | None) -> Figure:
    """3b: against the partial map, with a frame around the correspondences that are right, or else that are kept."""
    figure = correspondence_figure(match, "3(b)", "lcs", truth)
    framed = match.pairs["kept"] if truth is None else right_pairs(match, truth)
    if len(framed):
        low = framed.reshape(-1, 2).min(axis=0) - FRAME_MARGIN_M
        size = framed.reshape(-1, 2).max(axis=0) + FRAME_MARGIN_M - low
        figure.axes[0].add_patch(Rectangle(tuple(CM * low), *(CM * size), fill=False, color="black", linewidth=1))
    return figure


def aligned_figure(match: Match) -> Figure:
    """4c: the two scans aligned by the segment-wise translation."""
    x, y, turn = match.ref_from_query
    figure, axes = new_figure(
        f"4(c) {listed(match.targets)} and {match.query} aligned by shape: "
        f"{CM * x:.0f} cm, {CM * y:.0f} cm, {np.rad2deg(turn):.0f} deg"
    )
    draw_points(axes, match.target_scan, TARGET, f"scan {listed(match.targets)}", size=2.5)
    draw_points(axes, match.aligned_query_scan, QUERY, f"scan {match.query}", size=2.5)
    in_cm(axes)
    show_around(axes, np.concatenate([match.target_scan, match.aligned_query_scan]))
    draw_legend(axes)
    return figure
