# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the report: trajectories, errors along the way, maps, failed pairs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure
from matplotlib.image import imread

from evaluation.common.poses import Array, compose, inverse
from evaluation.logs.evaluation_log import EvaluationLog
from evaluation.mapping.report import read_report
from evaluation.pairs.outcomes import PairOutcome, about_pair
from evaluation.pairs.pictures import save_failure

from .map_agreement import occupied_cells
from .methods import CEILING
from .trajectories import Fragment, from_lists

Run = dict[str, Any]
COLUMNS = 3
DPI = 80
MAX_MAP_PX = 700


def colour_of(method: str, methods: Sequence[str]) -> Any:
    return colormaps["tab10" if len(methods) <= 10 else "tab20"](list(methods).index(method))


def _largest(run: Run) -> Fragment:
    fragments = from_lists(run["trajectory"])
    return fragments[0] if fragments else {}


def _in_reference(run: Run) -> Array:
    """Positions `[n, 2]` in order; in the frame of the reference where there is one."""
    poses = _largest(run)
    placed = np.array([poses[k] for k in sorted(poses)]).reshape(-1, 3)
    return (compose(np.array(run["aligned_by"]), placed) if run["aligned_by"] else placed)[:, :2]


def save_trajectories(path: Path, log: EvaluationLog, runs: Sequence[Run], methods: Sequence[str]) -> bool:
    """One panel for each method: its path over the reference. False when nothing was placed."""
    drawn = [run for run in runs if len(_largest(run)) > 1]
    if not drawn:
        return False
    num_rows = -(-len(drawn) // COLUMNS)
    figure = Figure(figsize=(4 * COLUMNS, 3.4 * num_rows), layout="constrained")
    panels = figure.subplots(num_rows, COLUMNS, squeeze=False).ravel()
    for axes, run in zip(panels, drawn):
        if log.reference is not None:
            axes.plot(log.reference[:, 0], log.reference[:, 1], "-", color="#b0b0b0", linewidth=3)
        path_xy = _in_reference(run)
        axes.plot(
            path_xy[:, 0], path_xy[:, 1], ".-", color=colour_of(run["method"], methods), markersize=2, linewidth=1
        )
        error = f", ATE {run['ate']['rmse_m']:.2f} m" if run["ate"] else ""
        axes.set_title(f"{run['method']}{error}", fontsize=9)
        axes.set_aspect("equal", adjustable="datalim")
        axes.tick_params(labelsize=7)
    for axes in panels[len(drawn) :]:
        axes.set_axis_off()
    figure.supxlabel("x [m]", fontsize=8)
    figure.supylabel("y [m]", fontsize=8)
    figure.savefig(path, dpi=DPI)
    return True


def save_errors(path: Path, runs: Sequence[Run], methods: Sequence[str]) -> bool:
    """Position error after alignment, along the way, and the errors of pairs in order of size. False without any."""
    judged = [run for run in runs if run["ate"]]
    if not judged:
        return False
    figure = Figure(figsize=(12, 3.6), layout="constrained")
    along, sorted_pairs = figure.subplots(1, 2)
    for run in judged:
        colour = colour_of(run["method"], methods)
        style = "--" if run["method"] == CEILING else "-"
        errors = np.array(run["ate"]["error_m"])
        along.plot(errors[:, 0], errors[:, 1], style, color=colour, linewidth=1, label=run["method"])
        pair_errors = [np.inf if e is None else max(e, 1e-4) for e in run["pairs"]["error_m"]]
        share = np.arange(1, len(pair_errors) + 1) / len(pair_errors)
        sorted_pairs.plot(np.sort(pair_errors), share, style, color=colour, linewidth=1)
    along.set_xlabel("position")
    along.set_ylabel("position error after alignment [m]")
    along.set_yscale("log")
    along.legend(fontsize=7, ncols=2)
    sorted_pairs.axvline(0.20, color="#b0b0b0", linewidth=1)
    sorted_pairs.set_xscale("log")
    sorted_pairs.set_xlabel("position error of a pair [m]")
    sorted_pairs.set_ylabel("share of pairs up to it")
    figure.savefig(path, dpi=DPI)
    return True


def save_maps(path: Path, log: EvaluationLog, runs: Sequence[Run], folder_of_run: dict[str, Path]) -> bool:
    """The maps that the programs drew, side by side, each to its own scale, and the cells that are occupied at the
    reference poses. False without any map."""
    with_map = [run for run in runs if (folder_of_run[run["method"]] / "map.png").exists()]
    if not with_map:
        return False
    num_panels = len(with_map) + (log.reference is not None)
    num_rows = -(-num_panels // COLUMNS)
    figure = Figure(figsize=(4 * COLUMNS, 3.6 * num_rows), layout="constrained")
    panels = figure.subplots(num_rows, COLUMNS, squeeze=False).ravel()
    for axes in panels:
        axes.set_axis_off()
    for axes, run in zip(panels, with_map):
        try:
            image = imread(folder_of_run[run["method"]] / "map.png")
            axes.imshow(shrunk(image[..., 0] if image.ndim == 3 else image), cmap="gray", vmin=0, vmax=1)
            axes.set_title(run["method"], fontsize=9)
        except (OSError, SyntaxError, ValueError):  # the baselines' own pictures cost no report
            axes.set_title(f"{run['method']}: unreadable map", fontsize=9)
    if log.reference is not None:
        cells = occupied_cells(dict(enumerate(log.reference)), log.content.points)
        axes = panels[len(with_map)]
        axes.plot(cells[:, 0], cells[:, 1], ",", color="black")
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_title("returns at the reference poses", fontsize=9)
    figure.savefig(path, dpi=DPI)
    return True


def shrunk(image: Array) -> Array:
    """Walls stay black: of each block of pixels the darkest."""
    step = max(1, -(-max(image.shape) // MAX_MAP_PX))
    if step == 1:
        return image
    padded = np.pad(image, [(0, -side % step) for side in image.shape], constant_values=1.0)
    blocks = padded.reshape(padded.shape[0] // step, step, padded.shape[1] // step, step)
    return blocks.min(axis=(1, 3))


def save_failures(folder: Path, log: EvaluationLog, run: Run, most: int, run_folder: Path) -> tuple[list[Path], int]:
    """Pictures of the first pairs that are placed wrongly, at most so many, and how many there are."""
    if not run["pairs"]:
        return [], 0
    wrong = [k for k, right in enumerate(run["pairs"]["right"]) if not right]
    report = run_folder / "report.json"
    positions = read_report(report)["scans"] if report.exists() else []
    paths = []
    for k in wrong[:most]:
        outcome = _outcome(log, run, k)
        said = _what_it_said(positions[k + 1]) if k + 1 < len(positions) else ""
        paths.append(save_failure(folder, outcome, log.content, f"{run['method']}: {outcome.status}{said}"))
    return paths, len(wrong)


def _what_it_said(position: dict[str, Any]) -> str:
    """How sure shapemap's report is of a position's alignment."""
    alignment = position.get("alignment") or {}
    probability = alignment.get("probability")
    sure = "" if probability is None else f", probability {probability:.2f}"
    return f"; called {alignment['status']}{sure}" if "status" in alignment else ""


def _outcome(log: EvaluationLog, run: Run, reference: int) -> PairOutcome:
    poses = next((f for f in from_lists(run["trajectory"]) if reference in f and reference + 1 in f), None)
    about = about_pair(log.content, reference, reference + 1)
    if poses is None:
        return PairOutcome(**about, status="not both placed")
    found = compose(inverse(poses[reference]), poses[reference + 1])
    error = {key: run["pairs"][key][reference] for key in ("error_m", "error_deg")}
    return PairOutcome(**about, status="placed", found_pose=tuple(float(value) for value in found), **error)
