# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of the robust method that show single scans and pairs of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from evaluation.common.poses import Array, compose, transform, wrap_angle

from .method_drawing import AGREE, CROSSED, PALE, dots, in_metres, lines, new_panels, show
from .method_runs import Runs
from .trace import ScanPosition, Trace

AGREE_M = 0.10  # a point this near to a point of the other scan is drawn as agreeing
SEE_THROUGH_M = 0.20  # one so far in front of what the other scan saw in its direction is drawn as crossed
BINS = 360
CERTAIN = 0.98


def all_points(position: ScanPosition) -> Array:
    return np.concatenate(position.scan_points)


def sharpest_turn(trace: Trace) -> int:
    """The scan before and after which the robot turns most, so that its sweep is bent most."""
    poses = trace.map_poses()
    inner = [i for i in poses if i - 1 in poses and i + 1 in poses]
    return max(inner, key=lambda i: abs(float(wrap_angle(poses[i + 1][2] - poses[i - 1][2]))))


def sweeps_figure(runs: Runs) -> Figure:
    """Three sweeps that follow each other, as recorded and straightened, both at the poses of the straightened run."""
    straight, bent = runs["sweeps-straight"].trace, runs["sweeps-bent"].trace
    middle = sharpest_turn(straight)
    poses = straight.map_poses()
    figure, panels = new_panels(1, 2)
    for axes, trace, title in ((panels[0], bent, "as recorded"), (panels[1], straight, "straightened")):
        drawn = []
        for i, colour in zip((middle - 1, middle, middle + 1), ("tab:blue", "tab:orange", "tab:green")):
            drawn.append(transform(poses[i], all_points(trace.positions[i])))
            dots(axes, drawn[-1], colour, f"sweep {i}", size=3)
        in_metres(axes, title)
    for axes in panels:  # the same part of the building
        show(axes, np.concatenate(drawn))
    panels[0].legend(fontsize=7, markerscale=3)
    return figure


def shape_figure(runs: Runs) -> Figure:
    """A scan: its returns and polylines, the shape points with their tangents, and the histogram of tangents."""
    position = runs["demo"].trace.positions[0]
    figure, panels = new_panels(1, 3)
    points, shape = all_points(position), position.points
    dots(panels[0], points, "black", size=2)
    for segments in position.segments:
        lines(panels[0], segments.reshape(-1, 2, 2), "tab:red", 1.2)
    in_metres(panels[0], "returns (black) and polylines (red)")
    ticks = 0.15 * np.stack([np.cos(shape[:, 2]), np.sin(shape[:, 2])], axis=-1)
    lines(panels[1], np.stack([shape[:, :2], shape[:, :2] + ticks], axis=1), "tab:blue", 0.9)
    dots(panels[1], shape[:, :2], "black", size=3)
    in_metres(panels[1], f"{len(shape)} shape points with tangents")
    for axes in panels[:2]:
        show(axes, shape[:, :2])
    panels[2].hist(np.rad2deg(shape[:, 2]) % 360.0, bins=72, range=(0.0, 360.0), color="tab:blue")
    panels[2].set(title="histogram of tangents", xlabel="tangent [deg]", ylabel="shape points")
    panels[2].set_xticks(range(0, 361, 90))
    return figure


def tangent_correlation(reference: Array, query: Array) -> Array:
    """For each degree that the query is turned by: how many tangents of the two scans then run the same way."""
    histograms = []
    for points in (reference, query):
        counts, _ = np.histogram(np.rad2deg(points[:, 2]) % 360.0, bins=BINS, range=(0.0, 360.0))
        histograms.append(np.convolve(np.tile(counts, 3), np.hanning(9), "same")[BINS : 2 * BINS])
    correlation = [float(histograms[0] @ np.roll(histograms[1], shift)) for shift in range(BINS)]
    return np.array(correlation) / max(correlation)


def closest_call(trace: Trace) -> dict[str, Any]:
    """The edge of which the best candidate leads least among those with three of its own."""
    links = [link for link in trace.links.values() if link["num_own"] >= 3]
    return min(links, key=lambda link: float(link["hypotheses"][0]["score"]))


def outcomes(reference: Array, query: Array) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which points of a placed query agree with the reference, and which lie in the way of its beams, as seen from the
    robot of the reference. A sketch of what the program does with polylines, for the eye."""
    distances = np.hypot(*(query[:, None, :] - reference[None, :, :]).transpose(2, 0, 1))
    agree = distances.min(axis=1) < AGREE_M
    bearing = {}
    for which, points in (("reference", reference), ("query", query)):
        bearing[which] = (np.rad2deg(np.arctan2(points[:, 1], points[:, 0])).round().astype(int)) % BINS
    nearest = np.full(BINS, -np.inf)
    ranges = np.hypot(*reference.T)
    for bin_index in np.unique(bearing["reference"]):
        nearest[bin_index] = ranges[bearing["reference"] == bin_index].min()
    crossed = ~agree & (np.hypot(*query.T) < nearest[bearing["query"]] - SEE_THROUGH_M)
    return agree, crossed


def draw_candidate(axes: Axes, reference: Array, query: Array, candidate: dict[str, Any], rank: int) -> None:
    placed = transform(np.array(candidate["pose"]), query)
    agree, crossed = outcomes(reference, placed)
    dots(axes, reference, PALE, "reference", size=2)
    dots(axes, placed[~agree & ~crossed], "gray", "neither", size=2)
    dots(axes, placed[crossed], CROSSED, "crossed", size=3)
    dots(axes, placed[agree], AGREE, "agree", size=3)
    shares = f"agree {100 * candidate['agree']:.0f} %, crossed {100 * candidate['crossed']:.0f} %"
    in_metres(axes, f"candidate {rank + 1}: score {candidate['score']:.1f}\n{shares}")
    show(axes, np.concatenate([reference, placed]))


def candidates_figure(runs: Runs) -> Figure:
    """Which rotations bring tangents together, and three candidates of the edge that is the hardest of the log."""
    trace = runs["demo"].trace
    link = closest_call(trace)
    reference, query = trace.positions[link["reference"]], trace.positions[link["query"]]
    figure, panels = new_panels(2, 2)
    found = np.rad2deg([candidate["pose"][2] for candidate in link["hypotheses"][: link["num_own"]]])
    correlation = np.roll(tangent_correlation(reference.points, query.points), BINS // 2)
    panels[0].plot(np.arange(BINS) - BINS // 2, correlation, color="tab:blue")
    for k, angle in enumerate(found):
        at = float(np.rad2deg(wrap_angle(np.deg2rad(angle))))
        panels[0].axvline(at, color=AGREE if k == 0 else "gray", linestyle="-" if k == 0 else ":")
    panels[0].set(
        title=f"scans {link['reference']} and {link['query']}: tangents that run the same way\n"
        "(lines: rotations of the candidates, green the best)",
        xlabel="rotation of the query [deg]",
        ylabel="correlation",
        xticks=range(-180, 181, 90),
    )
    for k, axes in enumerate(panels[1:]):
        draw_candidate(axes, all_points(reference), all_points(query), link["hypotheses"][k], k)
    panels[1].legend(fontsize=7, markerscale=3)
    return figure


def edges_of(trace: Trace) -> list[dict[str, Any]]:
    """Of each edge that the map takes a candidate of: that candidate, its probability, and its two scans."""
    found = []
    for query, link in sorted(trace.links.items()):
        source = trace.revisions.get(query, link)
        if query not in trace.choices or not source["hypotheses"]:
            continue
        chosen = trace.choices[query]["alternative"]
        taken = trace.results[query]["ref_from_query"]
        found.append(
            {
                "reference": link["reference"],
                "query": query,
                "link": link,
                "chosen": chosen,
                "pose": np.array(taken) if taken else None,
                "probability": trace.results[query]["probability"],
            }
        )
    return found


def motion_figure(runs: Runs) -> Figure:
    """The motions that the prior is learned from: those of edges that are as good as certain."""
    sure = [edge for edge in edges_of(runs["sparse"].trace) if (edge["probability"] or 0.0) >= CERTAIN]
    steps = np.array([edge["pose"] for edge in sure if edge["pose"] is not None]).reshape(-1, 3)
    figure, panels = new_panels(1, 3)
    dots(panels[0], steps[:, :2], "tab:blue", size=7)
    panels[0].plot(0.0, 0.0, marker=(3, 0, -90), markersize=12, color="black")
    in_metres(panels[0], "places of the next keyframe\n(triangle: the robot, looking along x)")
    panels[1].hist(np.hypot(*steps[:, :2].T), bins=20, color="tab:blue")
    panels[1].set(title="length of the step", xlabel="step [m]", ylabel="edges")
    panels[2].hist(np.rad2deg(steps[:, 2]), bins=36, range=(-180.0, 180.0), color="tab:blue")
    panels[2].set(title="turn", xlabel="turn [deg]", ylabel="edges", xticks=range(-180, 181, 90))
    return figure


def refinement_figure(runs: Runs) -> Figure:
    """Walls of the demo log, with the sweeps of each scan at their nominal headings and at their refined poses."""
    trace = runs["demo"].trace
    poses = trace.map_poses()
    figure, panels = new_panels(1, 2)
    centre = np.mean([pose[:2] for pose in poses.values()], axis=0)
    richest = min(poses, key=lambda i: float(np.hypot(*(poses[i][:2] - centre))))
    for axes, refined in zip(panels, (False, True)):
        for i, pose in poses.items():
            corrections = trace.corrections(i)
            if not refined:
                corrections = np.zeros_like(corrections)
            for part, correction in zip(trace.positions[i].scan_points, corrections):
                dots(axes, transform(compose(pose, correction), part), "black", size=1.5)
        in_metres(axes, "sweeps at their refined poses" if refined else "sweeps at their nominal headings")
        middle = poses[richest][:2]
        axes.set(xlim=(middle[0] - 1.0, middle[0] + 1.0), ylim=(middle[1] - 1.0, middle[1] + 1.0))
    return figure

