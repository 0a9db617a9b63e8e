# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of the robust method that show whole maps and what holds them together."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from evaluation.common.poses import Array

from .method_drawing import AGREE, CROSSED, dots, in_metres, lines, new_panels, show
from .method_runs import MethodRun, Runs
from .method_scans import edges_of
from .trace import Trace

SURE = 0.97  # edges as probable as this hold stretches together
WALLS = "#b8b8b8"
DEGENERATE_M = 0.5


def draw_walls(axes: Axes, run: MethodRun, stride: int = 4) -> Array:
    """The returns of all placed scans; they are returned as well."""
    points = np.concatenate([run.scan_in_map(i)[::stride] for i in run.trace.placed])
    dots(axes, points, WALLS, size=1.5)
    return points


def places(trace: Trace) -> Array:
    """`[n, 2]` of the placed scans, in order."""
    poses = trace.map_poses()
    return np.array([poses[i][:2] for i in trace.placed]).reshape(-1, 2)


def keyframes_figure(runs: Runs) -> Figure:
    """The keyframes of a recording at full rate, and the scans that are attached to them."""
    run = runs["full-rate"]
    poses = run.trace.map_poses()
    figure, panels = new_panels(1, 2)
    for axes, is_zoomed in zip(panels, (False, True)):
        walls = draw_walls(axes, run, 20)
        scans = [scan for scan in run.report["scans"] if scan["index"] in poses]
        attached = [scan for scan in scans if not scan["is_keyframe"]]
        ends = [[poses[s["index"]][:2], poses[s["alignment"]["reference"]][:2]] for s in attached]
        if is_zoomed:
            lines(axes, np.array(ends).reshape(-1, 2, 2), "tab:orange", 0.6)
        dots(axes, np.array([poses[s["index"]][:2] for s in attached]).reshape(-1, 2), "tab:orange", "attached", 5)
        keyframes = np.array([poses[s["index"]][:2] for s in scans if s["is_keyframe"]])
        dots(axes, keyframes, "tab:blue", "keyframe", 11)
        in_metres(axes, f"{len(keyframes)} keyframes, {len(attached)} attached scans")
        show(axes, np.concatenate([walls, keyframes]))
        if is_zoomed:
            middle = keyframes[len(keyframes) // 2]
            axes.set(xlim=(middle[0] - 1.5, middle[0] + 1.5), ylim=(middle[1] - 1.5, middle[1] + 1.5))
            in_metres(axes, "a part of it: each line leads to the keyframe")
    panels[0].legend(fontsize=7)
    return figure


def odometry_figure(runs: Runs) -> Figure:
    """The candidates of each odometry edge with their scores, and which of them the map takes in the end."""
    figure, panels = new_panels(1, 1, panel=(11.0, 3.8))
    axes = panels[0]
    edges = edges_of(runs["sparse"].trace)
    own: list[tuple[int, float]] = []
    lent: list[tuple[int, float]] = []
    first: list[tuple[int, float]] = []
    other: list[tuple[int, float]] = []
    for edge in edges:
        link = edge["link"]
        for k, candidate in enumerate(link["hypotheses"]):
            (own if k < link["num_own"] else lent).append((edge["query"], candidate["score"]))
        if edge["chosen"] < len(link["hypotheses"]):
            score = link["hypotheses"][edge["chosen"]]["score"]
            (first if edge["chosen"] == 0 else other).append((edge["query"], score))
    for found, marker, colour, label in (
        (own, ".", "gray", "candidate of the two scans"),
        (lent, "x", "tab:purple", "candidate by way of an earlier keyframe"),
    ):
        if found:
            axes.plot(*np.array(found).T, linestyle="none", marker=marker, markersize=5, color=colour, label=label)
    for found, colour, label in ((first, AGREE, "taken: the best by itself"), (other, CROSSED, "taken: another one")):
        rings: dict[str, Any] = {"linestyle": "none", "marker": "o", "fillstyle": "none", "markersize": 9}
        axes.plot(*np.array(found).reshape(-1, 2).T, color=colour, label=label, **rings)
    axes.set(title="candidates of each odometry edge", xlabel="edge, by its later scan", ylabel="score [log odds]")
    axes.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


def sure_stretches(trace: Trace) -> dict[int, int]:
    """For each scan the number of its stretch: edges that are at least SURE by themselves hold it together."""
    number = 0
    of_scan: dict[int, int] = {}
    for i in sorted(trace.results):
        probability = trace.results[i]["probability"]
        if of_scan and (probability is None or probability < SURE):
            number += 1
        of_scan[i] = number
    return of_scan


def submaps_figure(runs: Runs) -> Figure:
    """Stretches of sure edges, each a submap, and the map after merging them."""
    run = runs["sparse"]
    stretch, poses = sure_stretches(runs["sparse-open"].trace), run.trace.map_poses()
    figure, panels = new_panels(1, 1, panel=(7.5, 4.6))
    walls = draw_walls(panels[0], run)
    colours = colormaps["tab20"]
    for a, b in zip(run.trace.placed, run.trace.placed[1:]):
        is_sure = stretch[a] == stretch[b]
        colour: Any = colours(stretch[b] % 20) if is_sure else "black"
        width, style = (2.5, "-") if is_sure else (1.0, ":")
        lines(panels[0], np.array([[poses[a][:2], poses[b][:2]]]), colour, width, style)
    for i in run.trace.placed:
        panels[0].plot(*poses[i][:2], marker="o", markersize=4, color=colours(stretch[i] % 20))
    in_metres(panels[0], f"{len(set(stretch.values()))} submaps (colours); dotted: edges in doubt")
    show(panels[0], walls)
    return figure


def loops_figure(runs: Runs) -> Figure:
    """The same log without and with loops closed."""
    figure, panels = new_panels(1, 2, panel=(5.0, 3.6))
    for axes, name, title in zip(panels, ("sparse-open", "sparse"), ("odometry edges alone", "loops closed")):
        run = runs[name]
        walls = draw_walls(axes, run)
        axes.plot(*places(run.trace).T, "-", color="tab:blue", linewidth=0.9)
        poses = run.trace.map_poses()
        ends = [[poses[k["a"]][:2], poses[k["b"]][:2]] for k in run.report["loops"] if {k["a"], k["b"]} <= set(poses)]
        lines(axes, np.array(ends).reshape(-1, 2, 2), CROSSED, 2.0)
        told = f": {len(ends)} (red)" if ends else f", {len(poses)} of {len(run.trace.results)} scans"
        in_metres(axes, title + told)
        show(axes, walls)
    return figure


def balance(candidate: dict[str, Any]) -> float:
    """-1: all that was asked is against the candidate, 1: all is for it."""
    return float(candidate["for_it"] - candidate["against_it"]) / (candidate["for_it"] + candidate["against_it"] + 1.0)


def most_telling(trace: Trace) -> dict[str, Any]:
    """The verified edge of which the rest of the map tells most about the candidate that is taken and the one that is
    best by itself."""

    def lead(record: dict[str, Any]) -> float:
        candidates = record["hypotheses"]
        best = max(candidates, key=lambda candidate: float(candidate["score"]))
        return balance(candidates[record["alternative"]]) - balance(best)

    return max(trace.revisions.values(), key=lead)


def verification_figure(runs: Runs) -> Figure:
    """What speaks for and against each candidate of an edge that was in doubt."""
    record = most_telling(runs["sparse"].trace)
    candidates, taken = record["hypotheses"], record["alternative"]
    figure, panels = new_panels(1, 2, panel=(5.0, 3.4))
    numbers = np.arange(len(candidates))
    colours = [AGREE if k == taken else "gray" for k in numbers]
    panels[0].bar(numbers + 1, [candidate["score"] for candidate in candidates], color=colours)
    panels[0].set(title="score by the two scans alone", xlabel="candidate", ylabel="log odds")
    for axes in panels:
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    panels[1].bar(numbers + 1, [candidate["for_it"] for candidate in candidates], color=colours)
    panels[1].bar(numbers + 1, [-candidate["against_it"] for candidate in candidates], color=CROSSED, alpha=0.6)
    panels[1].set(title="all other pairs: for it (up), against it (down)", xlabel="candidate", ylabel="evidence")
    text = f"edge {record['reference']} to {record['query']}: candidate {taken + 1} is taken (green), "
    figure.suptitle(f"{text}probability {record['probability']:.2f}", fontsize=10)
    return figure


def covariance_figure(runs: Runs) -> Figure:
    """How well each scan is held by the one before it: along a corridor hardly, across it well."""
    run = runs["corridor"]
    poses, deviations = run.trace.map_poses(), []
    for scan in run.report["scans"]:
        alignment = scan["alignment"]
        if scan["index"] in poses and alignment and alignment["covariance"] is not None:
            covariance = np.array(alignment["covariance"])[:2, :2]
            deviations.append((scan["index"], *np.sqrt(np.linalg.eigvalsh(covariance))))
    figure, panels = new_panels(2, 1, panel=(9.0, 2.2))
    walls = draw_walls(panels[0], run)
    slides = [int(i) for i, _, worst in deviations if worst > DEGENERATE_M]
    held = [int(i) for i, _, worst in deviations if worst <= DEGENERATE_M]
    for chosen, colour in ((held, AGREE), (slides, CROSSED)):
        dots(panels[0], np.array([poses[i][:2] for i in chosen]).reshape(-1, 2), colour, size=8)
    in_metres(panels[0], f"a corridor; red: a direction is held worse than {DEGENERATE_M} m against the scan before")
    show(panels[0], np.concatenate([walls, places(run.trace)]))
    index, across, along = np.array(deviations).reshape(-1, 3).T
    panels[1].semilogy(index, along, ".-", color=CROSSED, label="in the direction that is held worst")
    panels[1].semilogy(index, across, ".-", color=AGREE, label="in the direction that is held best")
    panels[1].set(title="standard deviation", xlabel="scan", ylabel="[m]")
    panels[1].legend(fontsize=7)
    return figure


def culling_figure(runs: Runs) -> Figure:
    """A log that comes by the same places again: which scans are keyframes in the end."""
    run = runs["visited-again"]
    poses, scans = run.trace.map_poses(), run.report["scans"]
    figure, panels = new_panels(1, 2, panel=(5.0, 3.8))
    walls = draw_walls(panels[0], run, 10)
    kept = np.array([poses[s["index"]][:2] for s in scans if s["is_keyframe"] and s["index"] in poses])
    dots(panels[0], places(run.trace), "tab:orange", "scan", 5)
    dots(panels[0], kept, "tab:blue", "keyframe", 8)
    in_metres(panels[0], f"{len(kept)} keyframes of {len(scans)} scans")
    show(panels[0], walls)
    panels[0].legend(fontsize=7)
    for name, colour, label in (("never-culled", "gray", "without culling"), ("visited-again", "tab:blue", "culled")):
        counts = np.cumsum([bool(scan["is_keyframe"]) for scan in runs[name].report["scans"]])
        panels[1].plot(counts, color=colour, label=label)
    panels[1].legend(fontsize=7)
    panels[1].set(title="keyframes that are left", xlabel="scan", ylabel="keyframes so far")
    return figure


def grid_figure(runs: Runs) -> Figure:
    """The occupancy grid, and the scans that contradict it."""
    run = runs["crowd"]
    poses = run.trace.map_poses()
    height, width = run.grey.shape
    low, high = run.origin_m, run.origin_m + run.resolution_m * np.array([width, height])
    figure, panels = new_panels(1, 2, panel=(5.0, 3.8))
    against = [s["index"] for s in run.report["scans"] if (s["consistency"] or {}).get("contradicts_map")]
    for axes in panels:
        axes.imshow(run.grey, cmap="gray", vmin=0, vmax=255, extent=(low[0], high[0], low[1], high[1]))
    dots(panels[0], places(run.trace), "tab:blue", size=6)
    dots(panels[0], np.array([poses[i][:2] for i in against]).reshape(-1, 2), CROSSED, size=10)
    in_metres(panels[0], f"occupancy grid; {len(against)} of {len(poses)} scans contradict it (red)")
    if against:
        dots(panels[1], run.scan_in_map(against[0]), CROSSED, size=2.5)
        panels[1].plot(*poses[against[0]][:2], marker="o", color=CROSSED)
        in_metres(panels[1], f"scan {against[0]} of a crowd, on that grid")
    return figure
