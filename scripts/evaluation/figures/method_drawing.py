# SPDX-License-Identifier: GPL-3.0-or-later
"""What the figures of the robust method share: panels in metres, colours, and small files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from evaluation.common.poses import Array

AGREE, CROSSED, PALE = "tab:green", "tab:red", "#9bbbd8"
PANEL = (4.2, 3.8)
DPI = 90
MARGIN_M = 0.4


def new_panels(num_rows: int, num_columns: int, panel: tuple[float, float] = PANEL) -> tuple[Figure, list[Axes]]:
    figure = Figure(figsize=(panel[0] * num_columns, panel[1] * num_rows), layout="constrained")
    panels = list(figure.subplots(num_rows, num_columns, squeeze=False).ravel())
    return figure, panels


def in_metres(axes: Axes, title: str) -> None:
    axes.set_aspect("equal", adjustable="box")
    axes.set(title=title, xlabel="x [m]", ylabel="y [m]")


def dots(axes: Axes, points: Array, colour: str, label: str | None = None, size: float = 2.0) -> None:
    style: dict[str, Any] = {"linestyle": "none", "marker": ".", "markersize": size, "markeredgewidth": 0}
    axes.plot(*points.T, color=colour, label=label, **style)


def lines(axes: Axes, ends: Array, colour: str, width: float = 1.0, style: str = "-") -> None:
    """Lines `[n, 2, 2]` between two points each."""
    axes.add_collection(LineCollection(list(ends), colors=colour, linewidths=width, linestyles=style))


def show(axes: Axes, points: Array) -> None:
    """Limits that hold all but the farthest hundredth of the points on each side."""
    low, high = np.percentile(points, 1, axis=0) - MARGIN_M, np.percentile(points, 99, axis=0) + MARGIN_M
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])


def save(figure: Figure, path: Path) -> None:
    """The same bytes for the same figure."""
    for axes in figure.axes:
        axes.tick_params(labelsize=8)
        axes.title.set_fontsize(9)
        for label in (axes.xaxis.label, axes.yaxis.label):
            label.set_fontsize(8)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=DPI, metadata={"Software": None})
