# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 3 and 4: correspondences between a query scan and its target."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from evaluation.common.poses import Array

from .drawing import (
    CM,
    LINK,
    QUERY,
    TARGET,
    WRONG_LINK,
    draw_legend,
    draw_lines,
    draw_points,
    in_cm,
    listed,
    new_figure,
    show_around,
)
from .matches import Match

FRAME_MARGIN_M = 0.2


def draw_scans(axes: Axes, match: Match, query_scan: Array) -> None:
    """Target red, query cyan."""
    many = "scans" if len(match.targets) > 1 else "scan"
    draw_points(axes, match.target_scan, TARGET, f"{many} {listed(match.targets)}", size=2.5)
    draw_points(axes, query_scan, QUERY, f"scan {match.query}", size=2.5)
    in_cm(axes)
    show_around(axes, np.concatenate([match.target_scan, query_scan]), match.pairs["segments"].reshape(-1, 2))


def draw_links(axes: Axes, match: Match, stage: str, truth: Array | None) -> None:
    """Correspondences blue; pale where they are known to be wrong."""
    pairs = match.pairs[stage]
    if truth is None:
        draw_lines(axes, pairs, LINK, label="correspondences")
        return
    right = match.is_right(stage, truth)
    draw_lines(axes, pairs[~right], WRONG_LINK, 0.5, label="wrong correspondences")
    draw_lines(axes, pairs[right], LINK, 0.7, label="right correspondences")


def right_text(match: Match, stage: str, truth: Array | None) -> str:
    """How many correspondences, and how many are right when that is known."""
    count = len(match.pairs[stage])
    if truth is None:
        return f"{count} correspondences"
    return f"{match.is_right(stage, truth).sum()} of {count} correspondences right"


def correspondence_figure(match: Match, name: str, stage: str, truth: Array | None) -> Figure:
    """3a, 4a, 4b: the correspondences at one stage."""
    stages = {"lcs": "by LCS", "segments": "after the filters"}
    figure, axes = new_figure(
        f"{name} scans {listed(match.targets)} and {match.query}, {stages[stage]}: {right_text(match, stage, truth)}"
    )
    draw_scans(axes, match, match.query_scan)
    draw_links(axes, match, stage, truth)
    draw_legend(axes)
    return figure


def partial_map_figure(match: Match, truth: Array | None) -> Figure:
    """3b: against the partial map, with a frame around the correspondences that are right, or else that are kept."""
    figure = correspondence_figure(match, "3(b)", "lcs", truth)
    framed = match.pairs["kept"] if truth is None else match.pairs["lcs"][match.is_right("lcs", truth)]
    if len(framed):
        low = framed.reshape(-1, 2).min(axis=0) - FRAME_MARGIN_M
        size = framed.reshape(-1, 2).max(axis=0) + FRAME_MARGIN_M - low
        figure.axes[0].add_patch(Rectangle(tuple(CM * low), *(CM * size), fill=False, color="black", linewidth=1))
    return figure


def aligned_figure(match: Match) -> Figure:
    """4c: the two scans aligned by the segment-wise translation."""
    x, y, turn = match.ref_from_query
    figure, axes = new_figure(
        f"4(c) scans {listed(match.targets)} and {match.query} aligned by shape: "
        f"{CM * x:.0f} cm, {CM * y:.0f} cm, {np.rad2deg(turn):.0f} deg"
    )
    draw_scans(axes, match, match.aligned_query_scan)
    draw_legend(axes)
    return figure
