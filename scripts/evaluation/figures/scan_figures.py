# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 1 and 2: single scans."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.projections.polar import PolarAxes

from evaluation.common.poses import Array

from .drawing import CM, QUERY, TARGET, draw_legend, draw_lines, draw_points, in_cm, new_figure, show_around
from .matches import Match
from .trace import ScanPosition

NUM_BINS = 36
PART_M = 3.0
LONG_M = 0.15
NEAR_M = 0.15  # a point of one scan that is nearer to one of the other scan is on the same structure


@dataclass(frozen=True)
class ScanPart:
    """What lies within a square of PART_M around `centre_m`: `points` `[n, 2]` and `segments` `[m, 4]`."""

    position: int
    sub_scan: int
    centre_m: Array
    points: Array
    segments: Array


def part_around(position: ScanPosition, sub_scan: int, centre_m: Array) -> ScanPart:
    points, segments = position.scan_points[sub_scan], position.segments[sub_scan]
    middles = (segments[:, :2] + segments[:, 2:]) / 2
    near_points = (np.abs(points - centre_m) < PART_M / 2).all(axis=1)
    near_segments = (np.abs(middles - centre_m) < PART_M / 2).all(axis=1)
    return ScanPart(position.index, sub_scan, centre_m, points[near_points], segments[near_segments])


def richest_part(positions: Iterable[ScanPosition]) -> ScanPart | None:
    """The part with most segments that are long enough to be seen; of equals the one with most points."""

    def richness(part: ScanPart) -> tuple[int, int]:
        lengths = np.hypot(*(part.segments[:, 2:] - part.segments[:, :2]).T)
        return int((lengths > LONG_M).sum()), len(part.points)

    parts = [
        part_around(position, s, (segment[:2] + segment[2:]) / 2)
        for position in positions
        for s, segments in enumerate(position.segments)
        for segment in segments
    ]
    return max(parts, key=richness) if parts else None


def polyline_figure(part: ScanPart) -> Figure:
    """1a: returns of one sub-scan and the line segments that EM fits to them."""
    points, segments = part.points, part.segments
    figure, axes = new_figure(
        f"1(a) part of position {part.position}, sub-scan {part.sub_scan}: "
        f"{len(points)} points, {len(segments)} line segments"
    )
    draw_points(axes, points, "black", "scan points", size=4)
    draw_lines(axes, segments.reshape(-1, 2, 2), "red", 1.0, "line segments")
    ends = segments.reshape(-1, 2)
    axes.plot(*(CM * ends.T), linestyle="none", marker="|", markersize=5, color="red")
    in_cm(axes)
    show_around(axes, np.concatenate([points, segments.reshape(-1, 2)]))
    draw_legend(axes)
    return figure


def telling_point(position: ScanPosition, radius_m: float) -> int:
    """A shape point with many bins in use and many points around it."""
    if position.histograms is None or len(position.points) == 0:
        raise ValueError("the trace has no histograms")
    places = position.points[:, :2]
    around = np.array([(np.hypot(*(places - p).T) < radius_m).sum() for p in places])
    return int(np.argmax(around * (position.histograms > 0).sum(axis=1)))


def histogram_figure(position: ScanPosition, radius_m: float) -> Figure:
    """1b: the circular frame around a point, and what its angular histogram counts there."""
    k = telling_point(position, radius_m)
    assert position.histograms is not None  # noqa: S101 - telling_point() has refused that
    histogram, centre, places = position.histograms[k], position.points[k, :2], position.points[:, :2]
    figure = Figure(figsize=(9.0, 4.6), layout="compressed")
    figure.suptitle(
        f"1(b) position {position.index}, point {k}: frame of {CM * radius_m:g} cm, {NUM_BINS} bins", size=9
    )
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
    draw_legend(left)
    right = figure.add_subplot(1, 2, 2, projection="polar")
    right.bar(directions, histogram, width=2 * np.pi / NUM_BINS, align="edge", color="blue", edgecolor="white")
    right.set_ylim(0.0, 1.0)
    assert isinstance(right, PolarAxes)  # noqa: S101 - what the projection asks for
    right.set_rlabel_position(float(np.rad2deg(directions[int(np.argmin(histogram))])) + 5.0)
    right.tick_params(labelsize=7)
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
    figure = Figure(figsize=(10.0, 5.0), layout="compressed")
    known = (
        ""
        if shared is None
        else f"; {100 * shared:.0f} % of the points of {match.query} are near one of {match.reference}"
    )
    figure.suptitle(f"2: consecutive scans {match.reference} and {match.query}{known}", size=9)
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
