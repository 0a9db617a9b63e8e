# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of failed pairs, and the reliability diagram; the only part that needs matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evaluation.common.poses import Array, transform
from evaluation.logs.reference_log import ReferenceLog

from .outcomes import PairOutcome
from .tables import ReliabilityBin

MARGIN_M = 0.5


def save_failure(folder: Path, pair: PairOutcome, log: ReferenceLog, verdict: str | None = None) -> Path:
    """Reference scan grey; query blue at its true pose, red at the pose that was found. `verdict` is for the title,
    where it is not that of the outcome."""
    reference, query = log.points[pair.reference], log.points[pair.query]
    at_truth = transform(np.array(pair.true_pose), query)
    figure = Figure(figsize=(13, 7), layout="constrained")
    left, right = figure.subplots(1, 2)
    draw(left, reference, at_truth, "#2060d0", f"reference pose{scores(pair.given_score, pair.refined_score)}")
    if pair.found_pose is None:
        draw(right, reference, at_truth[:0], "#d02020", "no pose found")
    else:
        found = transform(np.array(pair.found_pose), query)
        title = f"found: {pair.error_m:.2f} m, {pair.error_deg:.1f} deg off{scores(pair.found_score)}"
        draw(right, reference, found, "#d02020", title)
    figure.suptitle(title_of(pair, verdict), fontsize=10)
    path = folder / f"{pair.log.split('.')[0]}_gap{pair.gap}_{pair.reference:05d}.png"
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=70)
    return path


def scores(score: float | None, refined: float | None = None) -> str:
    text = "" if score is None else f", score {score:.1f}"
    return text + ("" if refined is None else f", {refined:.1f} refined")


def title_of(pair: PairOutcome, verdict: str | None) -> str:
    head = (
        f"{pair.log}: {pair.reference} and {pair.query}, overlap {pair.overlap:.2f}, turn {pair.rotation_deg:.0f} deg"
    )
    if verdict is None:
        verdict = f"{pair.failure}; {pair.status}, probability {pair.probability:.2f}"
        verdict += ", reference in doubt" if pair.in_doubt else ""
    return f"{head}\n{verdict}"


def draw(axes: Axes, reference: Array, query: Array, colour: str, title: str) -> None:
    for points, shade in ((reference, "#909090"), (query, colour)):
        axes.plot(points[:, 0], points[:, 1], ".", color=shade, markersize=3)
    axes.plot(0, 0, "+", color="#404040")
    everything = np.concatenate([reference, query, np.zeros((1, 2))])
    low, high = np.percentile(everything, 1, axis=0) - MARGIN_M, np.percentile(everything, 99, axis=0) + MARGIN_M
    axes.set_xlim(min(low[0], -MARGIN_M), max(high[0], MARGIN_M))
    axes.set_ylim(min(low[1], -MARGIN_M), max(high[1], MARGIN_M))
    axes.set_aspect("equal")
    axes.set_title(title, fontsize=9)


def save_reliability(path: Path, bins: Sequence[ReliabilityBin]) -> None:
    """How often pairs are right, against how often they say that they are."""
    used = [b for b in bins if b.right.total]
    figure = Figure(figsize=(5, 5), layout="constrained")
    axes = figure.add_subplot()
    axes.plot([0, 1], [0, 1], ":", color="#909090")
    for b in used:
        axes.plot([b.mean_probability] * 2, b.right.interval, color="#2060d0")
        axes.annotate(str(b.right.total), (b.mean_probability, b.right.value), (4, -9), textcoords="offset points")
    axes.plot([b.mean_probability for b in used], [b.right.value for b in used], "o-", color="#2060d0")
    axes.set_xlabel("probability that the program gives")
    axes.set_ylabel("share that is right, with 95 % interval and number of pairs")
    axes.set_aspect("equal")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=100)
