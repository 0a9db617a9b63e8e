# SPDX-License-Identifier: GPL-3.0-or-later
"""What all figures share: axes in centimetres as in the paper, colours, and files."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from evaluation.common.poses import Array

CM = 100.0  # the paper's axes are in centimetres, all our numbers in metres
TARGET, QUERY, LINK = "red", "darkturquoise", "blue"  # as in the paper
WRONG_LINK = "#a0a0d8"  # where it is known which are wrong
ENDINGS = ("svg", "pdf", "png")
DPI = 200
MOST_VECTOR_POINTS = 60_000  # more would make vector files that no program opens gladly
MARGIN_M = 0.3


def new_figure(title: str, width: float = 6.0, height: float = 5.0) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.add_subplot()
    axes.set_title(title, fontsize=9)
    return figure, axes


def in_cm(axes: Axes) -> None:
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel("x [cm]")
    axes.set_ylabel("y [cm]")


def draw_points(axes: Axes, points_m: Array, colour: str, label: str | None = None, size: float = 1.5) -> None:
    """Dots; as pixels within the vector file when there are very many."""
    axes.plot(
        *(CM * points_m.T),
        linestyle="none",
        marker=".",
        markersize=size,
        markeredgewidth=0,
        color=colour,
        label=label,
        rasterized=len(points_m) > MOST_VECTOR_POINTS,
    )


def draw_lines(axes: Axes, lines_m: Array, colour: str, width: float = 0.6, label: str | None = None) -> None:
    """Lines `[n, 2, 2]` between two points each."""
    axes.add_collection(LineCollection(list(CM * lines_m), colors=colour, linewidths=width, label=label))


def show_around(axes: Axes, points_m: Array, all_of_m: Array | None = None) -> None:
    """Limits that hold all but the farthest hundredth of the points on each side, and `all_of_m` whole."""
    low, high = np.percentile(points_m, 1, axis=0), np.percentile(points_m, 99, axis=0)
    if all_of_m is not None and len(all_of_m):
        low, high = np.minimum(low, all_of_m.min(axis=0)), np.maximum(high, all_of_m.max(axis=0))
    low, high = low - MARGIN_M, high + MARGIN_M
    axes.set_xlim(CM * low[0], CM * high[0])
    axes.set_ylim(CM * low[1], CM * high[1])


def draw_legend(axes: Axes) -> None:
    legend = axes.legend(fontsize=7, framealpha=0.9)
    for handle in legend.legend_handles:
        if isinstance(handle, Line2D):
            handle.set_markersize(5)


def save(figure: Figure, folder: Path, name: str) -> list[str]:
    """The figure in all formats, the same bytes for the same figure; the names of the files."""
    folder.mkdir(parents=True, exist_ok=True)
    names = [f"{name}.{ending}" for ending in ENDINGS]
    undated: dict[str, dict[str, None]] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {}}
    with mpl.rc_context({"svg.hashsalt": name}):
        for ending, file in zip(ENDINGS, names):
            figure.savefig(folder / file, dpi=DPI, metadata=undated[ending], bbox_inches="tight")
    return names


def listed(indices: Iterable[int]) -> str:
    return "-".join(str(i) for i in indices)
