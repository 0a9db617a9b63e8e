# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 1 and 2: single scans."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from shapemap_sim.poses import Array

from .drawing import CM, QUERY, TARGET, draw_legend, draw_lines, draw_points, in_cm, new_figure, show_around
from .matches import Match
from .trace import ScanPosition

NUM_BINS = 36
NEAR_M = 0.15  # a point of one scan that is nearer to one of the other scan is on the same structure


def richest_sub_scan(position: ScanPosition) -> int:
    """The sub-scan that needs most segments."""
    return int(np.argmax([len(segments) for segments in position.segments]))


def polyline_figure(position: ScanPosition) -> Figure:
    """1a: returns of one sub-scan and the line segments that EM fits to them."""
    s = richest_sub_scan(position)
    points, segments = position.scan_points[s], position.segments[s]
    title = f"1(a) position {position.index}, sub-scan {s}: {len(points)} points, {len(segments)} segments"
    figure, axes = new_figure(title)
    draw_points(axes, points, "black", "scan points", size=4)
    draw_lines(axes, segments.reshape(-1, 2, 2), "red", 1.0, "line segments")
    ends = segments.reshape(-1, 2)
    axes.plot(*(CM * ends.T), linestyle="none", marker="|", markersize=5, color="red")
    in_cm(axes)
    show_around(axes, points)
    draw_legend(axes)
    return figure


def telling_point(position: ScanPosition, radius_m: float) -> int:
    """The shape point with most bins in use; of equals, the one with most points around it."""
    if position.histograms is None or len(position.points) == 0:
        raise ValueError("the trace has no histograms")
    places = position.points[:, :2]
    around = np.array([(np.hypot(*(places - p).T) < radius_m).sum() for p in places])
    return int(np.lexsort((around, (position.histograms > 0).sum(axis=1)))[-1])


def histogram_figure(position: ScanPosition, radius_m: float) -> Figure:
    """1b: the circular frame around a point, and what its angular histogram counts there."""
    k = telling_point(position, radius_m)
    assert position.histograms is not None  # noqa: S101 - telling_point() has refused that
    histogram, centre, places = position.histograms[k], position.points[k, :2], position.points[:, :2]
    figure = Figure(figsize=(9.0, 4.6), layout="constrained")
    figure.suptitle(f"1(b) position {position.index}, point {k}: frame of {CM * radius_m:g} cm, {NUM_BINS} bins", size=9)
    left = figure.add_subplot(1, 2, 1)
    directions = np.deg2rad(np.arange(NUM_BINS) * 360.0 / NUM_BINS)
    rim = centre + radius_m * np.stack([np.cos(directions), np.sin(directions)], axis=1)
    draw_lines(left, np.stack([np.broadcast_to(centre, rim.shape), rim], axis=1), "lightgrey", 0.5)
    left.add_patch(Circle(tuple(CM * centre), CM * radius_m, fill=False, color="grey"))
    draw_points(left, places, "black", "shape points", size=5)
    draw_points(left, places[np.hypot(*(places - centre).T) < radius_m], "blue", "in the frame", size=5)
    left.plot(*(CM * centre), linestyle="none", marker="+", markersize=9, color="red")
    in_cm(left)
    reach_m = 1.3 * radius_m
    left.set_xlim(CM * (centre[0] - reach_m), CM * (centre[0] + reach_m))
    left.set_ylim(CM * (centre[1] - reach_m), CM * (centre[1] + reach_m))
    left.legend(fontsize=7, markerscale=2)
    right = figure.add_subplot(1, 2, 2, projection="polar")
    right.bar(directions, histogram, width=2 * np.pi / NUM_BINS, align="edge", color="blue", edgecolor="white")
    right.set_rlim(0.0, 1.0)
    right.set_title(f"angular histogram: {int((histogram > 0).sum())} of {NUM_BINS} bins in use", fontsize=9)
    return figure


def shared_ratio(a: Array, b: Array) -> float:
    """Share of the points of `a` that are near one of `b`."""
    if not len(a) or not len(b):
        return 0.0
    distances = np.sqrt(((a[:, None, :] - b[None, :, :]) ** 2).sum(axis=2)).min(axis=1)
    return float((distances < NEAR_M).mean())


def two_scans_figure(match: Match, shared: float | None) -> Figure:
    """2: the two scans side by side, each in its own frame. `shared`: share of the query's points near the reference
    scan at the reference poses, if there are any."""
    figure = Figure(figsize=(10.0, 5.0), layout="constrained")
    known = "" if shared is None else f"; {100 * shared:.0f} % of {match.query}'s points lie on {match.reference}"
    figure.suptitle(f"2 consecutive scans {match.reference} and {match.query}{known}", size=9)
    both = np.concatenate([match.target_scan, match.query_scan])
    for place, (index, scan, colour) in enumerate(
        ((match.reference, match.target_scan, TARGET), (match.query, match.query_scan, QUERY)), 1
    ):
        axes = figure.add_subplot(1, 2, place)
        draw_points(axes, scan, colour, size=3)
        axes.plot(0, 0, "+", color="black")
        axes.set_title(f"scan {index}", fontsize=9)
        in_cm(axes)
        show_around(axes, both)
    return figure
