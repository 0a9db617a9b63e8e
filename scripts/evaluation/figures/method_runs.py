# SPDX-License-Identifier: GPL-3.0-or-later
"""The runs that the figures of the method are drawn from: the demo log, and simulated logs that each show one stage."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.common.files import write_whole
from evaluation.common.poses import Array, transform
from evaluation.common.programs import run_quietly
from evaluation.common.project import PROJECT
from evaluation.logs.reference_log import strip_nist
from evaluation.mapping.report import read_report
from evaluation.simulation.grounds import simulate_ground
from evaluation.simulation.long_walk import WalkOptions, simulate_walk
from evaluation.simulation.office import OfficeOptions
from evaluation.simulation.simulation import Simulation
from evaluation.simulation.spoilt_runs import spoilt_run
from evaluation.simulation.sweeps import SweepOptions, simulate_sweeps, sweep_text
from evaluation.simulation.write import nist_text

from .gallery import read_pgm
from .trace import Trace, read_trace


@dataclass(frozen=True)
class MethodRun:
    """A log as the program mapped it. `grey` is the picture of the map, row 0 at the top; `origin_m` its lower left
    corner in the frame of the map."""

    trace: Trace
    report: dict[str, Any]
    grey: np.ndarray
    origin_m: Array
    resolution_m: float

    def scan_in_map(self, index: int) -> Array:
        """The returns `[n, 2]` of a scan where the map has them."""
        corrected = self.trace.positions[index].corrected_scan(self.trace.corrections(index))
        return transform(self.trace.map_poses()[index], corrected)


@dataclass(frozen=True)
class Recipe:
    """A log, as text, and the options that it is mapped with. The runs of one log may share its text."""

    log: str
    options: Sequence[str] = field(default_factory=tuple)


def _first(simulation: Simulation, num: int) -> Simulation:
    """The same log with so many scans."""
    whole = simulation.drive
    drive = replace(
        whole,
        timestamps_s=whole.timestamps_s[:num],
        map_from_robot=whole.map_from_robot[:num],
        map_from_sub_scan=whole.map_from_sub_scan[:num],
        gradient=whole.gradient[:num],
    )
    return replace(simulation, drive=drive, ranges=simulation.ranges[:num])


def _office(num_scans: int, step_m: float, turn_deg: float, office: OfficeOptions | None = None) -> str:
    options = WalkOptions(num_scans=num_scans, step_m=step_m, turn_deg=turn_deg)
    return nist_text(simulate_walk(0, options, office), "walk")


LOGS: dict[str, Callable[[], str]] = {
    "demo": lambda: (PROJECT / "datasets/nist_arena.nist").read_text(encoding="utf-8"),
    "sweeps": lambda: sweep_text(simulate_sweeps(0, SweepOptions(yaw_deg=60.0, seconds=6.0))),
    "full-rate": lambda: _office(300, 0.05, 20.0),
    "sparse": lambda: _office(70, 2.2, 90.0),
    "visited-again": lambda: _office(600, 0.4, 20.0, OfficeOptions(size_m=(24.0, 18.0), depth_m=4.0)),
    "corridor": lambda: nist_text(_first(simulate_ground("long-corridor", 0, 1.0), 30), "corridor"),
    "crowd": lambda: nist_text(spoilt_run("crowd", 2, num_positions=40).simulation, "crowd"),
}
RECIPES = {
    "demo": Recipe("demo"),
    "sweeps-bent": Recipe("sweeps", ("--deskew", "off")),
    "sweeps-straight": Recipe("sweeps", ("--deskew", "on")),
    "full-rate": Recipe("full-rate"),
    "sparse-open": Recipe("sparse", ("--no-close-loops",)),
    "sparse": Recipe("sparse"),
    "visited-again": Recipe("visited-again", ("--settle-at", "100")),
    "never-culled": Recipe("visited-again", ("--settle-at", "0")),
    "corridor": Recipe("corridor"),
    "crowd": Recipe("crowd"),
}


def map_origin(path: Path) -> tuple[Array, float]:
    """Origin [m] and resolution [m] of a map.yaml. Raises ValueError for one without them."""
    lines = (line.partition(":") for line in path.read_text(encoding="utf-8").splitlines())
    values = {key.strip(): value.strip() for key, _, value in lines}
    try:
        x, y = (float(word) for word in values["origin"].strip("[]").split(",")[:2])
        return np.array([x, y]), float(values["resolution"])
    except (KeyError, ValueError):
        raise ValueError(f"{path}: no origin and resolution of a map") from None


class Runs:
    """Maps each log when a figure first asks for it. All files go to `folder`."""

    def __init__(self, cli: Path, folder: Path) -> None:
        self._cli, self._folder = cli, folder
        self._done: dict[str, MethodRun] = {}

    def __getitem__(self, name: str) -> MethodRun:
        """Raises Failure when the program gives no map."""
        if name not in self._done:
            self._done[name] = self._mapped(name, RECIPES[name])
        return self._done[name]

    def _mapped(self, name: str, recipe: Recipe) -> MethodRun:
        self._folder.mkdir(parents=True, exist_ok=True)
        log = self._folder / f"{recipe.log}.nist"
        if not log.exists():
            write_whole(log, strip_nist(LOGS[recipe.log]()))
        picture, trace, report = (self._folder / f"{name}.{ending}" for ending in ("pgm", "jsonl", "json"))
        outputs = ["--out", picture, "--trace", trace, "--report", report]
        run_quietly([self._cli, log, *outputs, "--force", "--quiet", *recipe.options])
        origin_m, resolution_m = map_origin(picture.with_suffix(".yaml"))
        return MethodRun(read_trace(trace), read_report(report), read_pgm(picture), origin_m, resolution_m)
