# SPDX-License-Identifier: GPL-3.0-or-later
"""Walks through a building in which some scans do not show it, and whether a mapper tells which."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from evaluation.common.poses import Array, best_motion, compose, pose_from, wrap_angle

from .buildings import BuildingOptions, furnished_building
from .disturbances import at_position, ranges_with_crowd, ranges_with_glass
from .raycast import RayCaster
from .robot import Drive
from .scenes import StrollOptions, laser, run_of, stroll
from .sensor import SensorOptions, exact_ranges
from .simulation import Simulation
from .streams import stream

KINDS = ("tilted", "crowd", "elsewhere", "none", "glass")
TILT_DEG = (10.0, 18.0)
CROWD_SHARE = 0.4
GLASS_STEEP_DEG = 35.0  # beams that meet glass more squarely go through most often, and others seldom
GLASS_THROUGH = (0.7, 0.05)
SPACING_M = 0.6
OFF_M = 0.3  # a beam is off when its range is wrong by more
SPOILT = 0.3  # a scan of which more is off contradicts the map; the limit of the mapper is 0.15 of what others know
CLEAN = 0.1  # and one of which less is, does not; of those between either may be said
MISPLACED_M = 0.5
MISPLACED_DEG = 10.0


@dataclass(frozen=True)
class SpoiltRun:
    """`off` `[p]`: the share of a scan's returns that are not what the building alone would give from there."""

    simulation: Simulation
    kind: str
    off: Array


def lean(drive: Drive, chosen: NDArray[np.int64], seed: int) -> Drive:
    """At the chosen positions the laser's plane leans in any direction."""
    rng, gradient = stream(seed, "lean"), drive.gradient.copy()
    for k in chosen:
        climb, towards = np.tan(np.deg2rad(rng.uniform(*TILT_DEG))), rng.uniform(-np.pi, np.pi)
        gradient[k] = climb * np.array([np.cos(towards), np.sin(towards)])
    return replace(drive, gradient=gradient)


def slants_deg(ranges: Array, sensor: SensorOptions) -> Array:
    """How far from squarely each beam meets its surface, by where the next beam meets its own."""
    following = np.concatenate([ranges[..., 1:], ranges[..., -1:]], axis=-1)
    with np.errstate(invalid="ignore"):
        slope = np.abs(following - ranges) / (ranges * np.deg2rad(sensor.angle_step_deg))
    return np.asarray(np.rad2deg(np.arctan(slope)))


def spoilt_run(kind: str, seed: int, num_positions: int = 60, share: float = 0.15) -> SpoiltRun:
    """A walk of which a `share` of the scans are spoilt, never the first: "tilted", taken in a "crowd", or taken
    "elsewhere", in another building. None is with "none", and with "glass", where beams that
    meet the walls between rooms and corridor squarely mostly go through, and others seldom: the walls are
    there for some scans and not for others, of which none is wrong."""
    world, sensor = furnished_building(seed, BuildingOptions(glass=kind == "glass")), laser(270.0, 0.5, 20.0)
    walk = stroll(seed, world.route, StrollOptions(num_positions=num_positions, spacing_m=SPACING_M))
    clean = exact_ranges(RayCaster(world), walk, sensor)
    if kind == "glass":
        behind = ranges_with_glass(world, walk, sensor, 1.0, seed)
        share_through = np.where(slants_deg(clean, sensor) < GLASS_STEEP_DEG, *GLASS_THROUGH)
        clean = np.where(stream(seed, "through glass").random(clean.shape) < share_through, behind, clean)
    exact = clean.copy()
    count = 0 if kind in ("none", "glass") else round(share * num_positions)
    chosen = 1 + stream(seed, "spoilt").permutation(num_positions - 1)[:count]
    if kind == "tilted":
        walk = lean(walk, chosen, seed)
        exact = exact_ranges(RayCaster(world), walk, sensor)
    elif kind == "crowd":
        for k in chosen:
            here = at_position(walk, int(k))
            exact[k] = ranges_with_crowd(clean[k : k + 1], here, sensor, CROWD_SHARE, seed * 1000 + int(k))[0][0]
    elif kind == "elsewhere":
        other = furnished_building(seed + 100_000, BuildingOptions())
        there = stroll(seed + 100_000, other.route, StrollOptions(num_positions=num_positions, spacing_m=SPACING_M))
        exact[chosen] = exact_ranges(RayCaster(other), there, sensor)[chosen]
    simulation = run_of(seed, world, walk, sensor, exact)
    returned = np.isfinite(simulation.ranges)
    wrong = returned & ~(np.abs(np.where(returned, simulation.ranges, 0.0) - clean) <= OFF_M)
    # Noise and mixed pixels are part of any scan.
    mixed = returned & (np.abs(np.where(returned, simulation.ranges, 0.0) - exact) > OFF_M)
    off = (wrong & ~mixed).sum(axis=(1, 2)) / np.maximum(returned.sum(axis=(1, 2)), 1)
    return SpoiltRun(simulation, kind, off)


@dataclass(frozen=True)
class JudgedScan:
    """One that is in the map. `contradicting`: of its known beams; NaN where none is known."""

    index: int
    off: float
    misplaced: bool
    flagged: bool
    known: float
    contradicting: float

    @property
    def spoilt(self) -> bool:
        return self.misplaced or self.off > SPOILT

    @property
    def clean(self) -> bool:
        return not self.misplaced and self.off < CLEAN


def misplaced(found: Array, truth: Array) -> Array:
    """`[n]` of bool, of poses `[n, 3]`, after the motion that fits most: the worst half stays out of the fit."""
    kept = np.arange(len(found))
    for _ in range(10):
        moved = compose(best_motion(found[kept], truth[kept]), found)
        errors = np.hypot(*(moved[:, :2] - truth[:, :2]).T)
        kept = np.argsort(errors, kind="stable")[: max(2, len(found) // 2)]
    turns = np.abs(np.rad2deg(wrap_angle(moved[:, 2] - truth[:, 2])))
    return np.asarray((errors > MISPLACED_M) | (turns > MISPLACED_DEG))


def judged_scans(run: SpoiltRun, report: Mapping[str, Any]) -> list[JudgedScan]:
    """All scans in the map, beside what the mapper's report says of each."""
    placed = [entry for entry in report["scans"] if entry["map_from_robot"]]
    indices = [entry["index"] for entry in placed]
    found = np.array([pose_from(entry["map_from_robot"]) for entry in placed]).reshape(-1, 3)
    wrong = misplaced(found, run.simulation.drive.map_from_robot[indices])
    scans = []
    for entry, is_wrong in zip(placed, wrong):
        said = entry["consistency"]
        against = said["through"] + said["in_free"]
        known = against + said["agree"]
        share = against / known if known > 0.0 else float("nan")
        off = float(run.off[entry["index"]])
        scans.append(JudgedScan(entry["index"], off, bool(is_wrong), said["contradicts_map"], known, share))
    return scans
