# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of a pair that failed: the two scans at their true and at their estimated poses."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from evaluation.common.poses import Array, compose, pose_from, transform
from evaluation.simulation.sensor import points_of
from evaluation.simulation.simulation import Simulation

from .arena_pairs import PairResult, pair_truth


def placed_points(poses: Array, points: list[Array]) -> Array:
    """Points of all sub-scans `[n, 2]`, each under its pose `[s, 3]`."""
    return np.concatenate([transform(pose, p) for pose, p in zip(poses, points)])


def found_points(alignment: Mapping[str, Any], simulation: Simulation, index: int) -> Array:
    """The query's points `[n, 2]` in the reference's frame, as the report places them."""
    truth = pair_truth(simulation, index)
    found = alignment["query_from_sweep"]
    corrections = np.array([pose_from(p) for p in found]) if found else np.zeros_like(truth.query_from_nominal)
    sub_scans = compose(corrections, truth.query_from_nominal)
    return placed_points(compose(pose_from(alignment["ref_from_query"]), sub_scans), truth.points)


def title_of(pair: PairResult) -> str:
    head = f"seed {pair.seed}, positions {pair.index - 1} and {pair.index}, overlap {pair.overlap:.2f}"
    if pair.errors is None:
        return f"{head}\nrejected: {pair.reason}"
    return head + "".join(f"\n{stage}: {e.error_m:.2f} m, {e.error_deg:.1f} deg" for stage, e in pair.errors.items())


def save_failure(path: Path, pair: PairResult, simulation: Simulation, report: Mapping[str, Any]) -> None:
    """Reference scan grey, query at its true pose blue, at its estimated pose (if there is one) red."""
    truth, beams = pair_truth(simulation, pair.index), simulation.options.sensor.beam_angles_rad()
    reference = [points_of(ranges, beams) for ranges in simulation.ranges[pair.index - 1]]
    clouds = [
        (placed_points(truth.query_from_nominal, reference), "#909090", "reference scan"),
        (placed_points(truth.ref_from_sub_scan, truth.points), "#2060d0", "query, true pose"),
    ]
    if pair.errors is not None:
        entry = next(e for e in report["scans"] if e["index"] == pair.index)
        clouds.append((found_points(entry["alignment"], simulation, pair.index), "#d02020", "query, estimated pose"))
    figure = Figure(figsize=(8, 7), layout="constrained")
    axes = figure.add_subplot()
    for points, colour, label in clouds:
        axes.plot(points[:, 0], points[:, 1], ".", color=colour, markersize=2, label=label)
    axes.set_aspect("equal")
    axes.set_title(title_of(pair), fontsize=9)
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.legend(markerscale=5, fontsize=8)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=80)
