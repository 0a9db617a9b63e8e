# SPDX-License-Identifier: GPL-3.0-or-later
"""One run of shapemap-cli on one log or several, and what its report says of them."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from shapemap_sim.pairs import pose_from
from shapemap_sim.poses import Array
from shapemap_sim.whole_maps import fragment_errors

from .programs import Failure, Usage, run_measured

Report = Mapping[str, Any]


@dataclass(frozen=True)
class Mapper:
    """`arguments` are passed on to the program."""

    cli: Path
    arguments: tuple[str, ...]
    timeout_s: float

    def run(
        self, logs: Sequence[Path], folder: Path, started: Callable[[int], None] | None = None
    ) -> tuple[dict[str, Any], Usage]:
        """The report and what the run took; `started` gets the process. Raises Failure."""
        report = folder / "report.json"
        command = [self.cli, *logs, "--out", folder / "map.png", "--report", report, "--quiet", "--force"]
        usage = run_measured([*command, *self.arguments], folder, self.timeout_s, started)
        try:
            content: dict[str, Any] = json.loads(report.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise Failure(f"no report: {error}") from None
        return content, usage


def place_in_log(report: Report, index: int) -> tuple[int, int]:
    """Log and scan of a position, also where --every and --skip leave some out."""
    position = report["positions"][index]
    return int(position["log"]), int(position["index_in_whole_log"])


def placed_poses(report: Report) -> dict[int, Array]:
    """`map_from_robot` `[3]` by index of the position, of those in the map."""
    return {p["index"]: pose_from(p["map_from_robot"]) for p in report["positions"] if p["map_from_robot"]}


def absolute_errors_m(report: Report, references: Sequence[Array]) -> Array:
    """Of each position in the map, after the planar motion that fits all of them best; `references[log]` `[p, 3]`."""
    poses = placed_poses(report)
    if not poses:
        return np.empty(0)
    truth = np.full((len(report["positions"]), 3), np.nan)
    for index in poses:
        log, scan = place_in_log(report, index)
        truth[index] = references[log][scan]
    return fragment_errors(poses, truth).errors_m


def root_mean_square(values: Array) -> float:
    """NaN of nothing."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else float("nan")
