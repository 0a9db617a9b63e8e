# SPDX-License-Identifier: GPL-3.0-or-later
"""Which scans of several lasers were taken at the same time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .model import Moment

Times = NDArray[np.int64]


def period_ns(times_ns: Times) -> int:
    """The usual time from one scan to the next; 0 where there is none."""
    steps = np.diff(np.sort(times_ns))
    steps = steps[steps > 0]
    return int(np.median(steps)) if len(steps) else 0


def nearest(times_ns: Times, others_ns: Times) -> NDArray[np.intp]:
    """For each time the index of the nearest of the others."""
    order = np.argsort(others_ns, kind="stable")
    ordered = others_ns[order]
    after = np.clip(np.searchsorted(ordered, times_ns), 1, max(len(ordered) - 1, 1))
    before = after - 1
    after = np.minimum(after, len(ordered) - 1)
    is_after = np.abs(ordered[after] - times_ns) < np.abs(times_ns - ordered[before])
    return order[np.where(is_after, after, before)]


def pairs(first_ns: Times, second_ns: Times, most_ns: int) -> list[tuple[int, int]]:
    """Scans that are nearest to each other, and not further apart than `most_ns`."""
    if not len(first_ns) or not len(second_ns):
        return []
    forth, back = nearest(first_ns, second_ns), nearest(second_ns, first_ns)
    indices = np.arange(len(first_ns))
    is_pair = (back[forth] == indices) & (np.abs(second_ns[forth] - first_ns) <= most_ns)
    return [(int(i), int(forth[i])) for i in indices[is_pair]]


def group(times_ns: list[Times], order: list[list[int]]) -> list[Moment]:
    """The moments of several lasers, in the order in which the scans were recorded; `order[laser][scan]` tells it.

    Scans of two lasers belong together where each is the nearest to the other and they are at most half a period apart,
    by the faster laser's period. What has no partner is a moment of its own.
    """
    periods = [period_ns(times) for times in times_ns]
    groups = _grouped(times_ns, periods, [np.arange(len(times)) for times in times_ns], 0)
    moments = []
    for members in groups:
        by_time = sorted(members, key=lambda member: (times_ns[member[0]][member[1]], member))
        moments.append(Moment(tuple(by_time)))
    return sorted(moments, key=lambda moment: min(order[laser][scan] for laser, scan in moment.scans))


def _grouped(
    times_ns: list[Times], periods_ns: list[int], free: list[NDArray[np.intp]], laser: int
) -> list[list[tuple[int, int]]]:
    """Each free scan of the laser with its partners of the lasers after it, and then those of the others."""
    if laser == len(times_ns):
        return []
    groups = {int(scan): [(laser, int(scan))] for scan in free[laser]}
    left = list(free)
    for other in range(laser + 1, len(times_ns)):
        known = [p for p in (periods_ns[laser], periods_ns[other]) if p > 0]
        most_ns = min(known) // 2 if known else 0
        found = pairs(times_ns[laser][free[laser]], times_ns[other][free[other]], most_ns)
        for i, k in found:
            groups[int(free[laser][i])].append((other, int(free[other][k])))
        left[other] = np.delete(free[other], [k for _, k in found])
    return [*groups.values(), *_grouped(times_ns, periods_ns, left, laser + 1)]
