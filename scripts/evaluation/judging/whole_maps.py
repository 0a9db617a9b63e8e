# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether all positions of a simulated arena are where they should be, after the planar motion that fits best."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from evaluation.common.poses import Array, best_motion, compose, inverse, wrap_angle
from evaluation.common.shares import share_of
from evaluation.common.tables import table
from evaluation.simulation.robot import Drive

RIGHT_M = 0.10
RIGHT_DEG = 1.0
FAR_OFF_M = 0.30  # as for pairs: more is another place
FAR_OFF_DEG = 5.0

Fragment = Mapping[int, Array]  # pose `[3]` by index of the position

STATED = (0.0, 0.5, 0.92, 0.99, 1.0)  # bounds of the rows of `links_table`


@dataclass(frozen=True)
class FragmentErrors:
    """How far each position of a fragment, by `indices`, is from the truth: distance [m] and angle [deg]."""

    indices: list[int]
    errors_m: Array
    errors_deg: Array
    truth_from_map: Array

    def within(self, limit_m: float, limit_deg: float) -> bool:
        return bool((self.errors_m < limit_m).all() and (self.errors_deg < limit_deg).all())


def fragment_errors(fragment: Fragment, truth: Array) -> FragmentErrors:
    """`truth` `[p, 3]` has the poses of all positions."""
    indices = sorted(fragment)
    found, wanted = np.array([fragment[i] for i in indices]), truth[indices]
    motion = best_motion(found, wanted)
    moved = compose(motion, found)
    return FragmentErrors(
        indices,
        np.hypot(*(moved[:, :2] - wanted[:, :2]).T),
        np.abs(np.rad2deg(wrap_angle(moved[:, 2] - wanted[:, 2]))),
        motion,
    )


@dataclass(frozen=True)
class WholeMap:
    """What became of one seed: the map and the fragments beside it, largest first. Errors are the largest over all
    fragments, each by its own motion; NaN without any. `sizes`: positions of each fragment. `links`: of each alignment
    in the map the probability that it states, and whether it is right."""

    seed: int
    num_positions: int
    sizes: list[int]
    max_error_m: float
    max_error_deg: float
    placed_right: bool
    far_off: bool
    fault: str = ""
    seconds: float | None = None
    links: list[tuple[float, bool]] = field(default_factory=list)

    @property
    def whole(self) -> bool:
        return self.sizes == [self.num_positions]

    @property
    def verdict(self) -> str:
        """right, in pieces (each of them right), inexact (some pose beyond the limits) or wrong (far off them)."""
        if self.fault:
            return "no map"
        if self.far_off:
            return "wrong"
        if not self.placed_right:
            return "inexact"
        return "right" if self.whole else "in pieces"


def link_outcomes(scans: Sequence[Mapping[str, Any]], truth: Array) -> list[tuple[float, bool]]:
    """`scans` of a report: the probability of each alignment in the map, and whether it is the right place."""
    outcomes = []
    for scan in scans:
        alignment = scan["alignment"] or {}
        reference, pose = alignment.get("reference"), alignment.get("ref_from_query")
        if reference is None or pose is None or scans[reference]["component"] != scan["component"]:
            continue
        found = np.array([pose["x_m"], pose["y_m"], np.deg2rad(pose["theta_deg"])])
        off = compose(inverse(compose(inverse(truth[reference]), truth[scan["index"]])), found)
        right = np.hypot(*off[:2]) < FAR_OFF_M and abs(np.rad2deg(wrap_angle(off[2]))) < FAR_OFF_DEG
        outcomes.append((float(alignment["probability"]), bool(right)))
    return outcomes


def judge(
    seed: int,
    truth: Array,
    fragments: Sequence[Fragment],
    seconds: float | None = None,
    links: Sequence[tuple[float, bool]] = (),
) -> WholeMap:
    """`fragments` of one seed; those without a position do not count."""
    judged = [fragment_errors(fragment, truth) for fragment in fragments if fragment]
    return WholeMap(
        seed,
        len(truth),
        sorted((len(one.indices) for one in judged), reverse=True),
        max((float(one.errors_m.max()) for one in judged), default=float("nan")),
        max((float(one.errors_deg.max()) for one in judged), default=float("nan")),
        all(one.within(RIGHT_M, RIGHT_DEG) for one in judged),
        not all(one.within(FAR_OFF_M, FAR_OFF_DEG) for one in judged),
        seconds=seconds,
        links=list(links),
    )


def mean_of_sub_scans(drive: Drive) -> dict[int, Array]:
    """Where each position is by the true poses of its sub-scans, which is all that scans can tell of it: their errors
    are the robot's, and a map that has each of them exactly still does not know how the robot meant to stand."""
    nominal = np.zeros((len(drive.nominal_headings_rad), 3))
    nominal[:, 2] = drive.nominal_headings_rad
    stood = compose(drive.map_from_sub_scan, inverse(nominal))
    errors = compose(inverse(drive.map_from_robot)[:, None], stood).mean(axis=1)
    return dict(enumerate(compose(drive.map_from_robot, errors)))


def lost_map(seed: int, num_positions: int, fault: str) -> WholeMap:
    """What stands for a seed whose mapper gave no report."""
    nan = float("nan")
    return WholeMap(seed, num_positions, [], nan, nan, False, False, fault)


def summary(maps: Sequence[WholeMap]) -> str:
    """A table of counts, with shares and their 95 % intervals."""
    rows = [
        (f"whole, and all within {100 * RIGHT_M:g} cm and {RIGHT_DEG:g} deg", [m.verdict == "right" for m in maps]),
        ("whole or in pieces, and all so near", [m.verdict in ("right", "in pieces") for m in maps]),
        (
            f"whole, and all within {100 * FAR_OFF_M:g} cm and {FAR_OFF_DEG:g} deg",
            [m.whole and not m.far_off for m in maps],
        ),
        (f"some position more than {100 * FAR_OFF_M:g} cm or {FAR_OFF_DEG:g} deg off", [m.far_off for m in maps]),
        ("in pieces", [not m.fault and not m.whole for m in maps]),
        ("no map", [bool(m.fault) for m in maps]),
    ]
    head = (f"of {len(maps)} maps", "number", "share (95 %)")
    return table(head, [[name, sum(hits), share_of(hits)] for name, hits in rows])


def links_table(maps: Sequence[WholeMap]) -> str:
    """How many alignments are right, by what is stated of them; empty when there is none."""
    links = np.array([link for one in maps for link in one.links]).reshape(-1, 2)
    rows = []
    for low, high in pairwise(STATED):
        within = links[(links[:, 0] >= low) & ((links[:, 0] < high) | (high == STATED[-1]))]
        if len(within):
            share = f"{100 * within[:, 1].mean():.1f} %"
            mean = f"{100 * within[:, 0].mean():.1f} %"
            rows.append([f"{low:g} to {high:g}", len(within), f"{within[:, 1].sum():.0f}, {share}", mean])
    return table(("alignments stated to be right by", "number", "right", "mean stated"), rows) if rows else ""


def not_right(maps: Sequence[WholeMap]) -> str:
    """A line for each map that is not whole and right; empty when there is none."""
    lines = []
    for one in maps:
        if one.verdict == "right":
            continue
        sizes = "+".join(str(size) for size in one.sizes) or "none"
        errors = one.fault or f"at most {one.max_error_m:.3f} m, {one.max_error_deg:.2f} deg off"
        lines.append(f"seed {one.seed}: {one.verdict}, {sizes} of {one.num_positions} positions, {errors}")
    return "\n".join(lines)
