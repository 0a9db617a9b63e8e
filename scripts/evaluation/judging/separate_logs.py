# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of several logs that were mapped together a mapper joined into one piece of map, and by what."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

from evaluation.mapping.report import Report, place_in_log


@dataclass(frozen=True)
class Joint:
    """Two logs with positions in one fragment. `strengths` are those of the loops between them, strongest first; empty
    where they are joined by way of another log, or by what the report does not call a loop."""

    logs: tuple[int, int]
    fragment: int
    num_positions: tuple[int, int]
    strengths: tuple[float, ...]


def joints(report: Report) -> list[Joint]:
    """Each pair of logs in each fragment that holds positions of both."""
    between: dict[tuple[int, int], list[float]] = {}
    for loop in report["loops"]:
        one, other = sorted(place_in_log(report, loop[end])[0] for end in ("a", "b"))
        between.setdefault((one, other), []).append(float(loop["strength"]))
    found = []
    for fragment in report["components"]:
        counts = {entry["log"]: entry["num_scans"] for entry in fragment["logs"] if entry["num_scans"]}
        for one, other in combinations(sorted(counts), 2):
            strengths = tuple(sorted(between.get((one, other), []), reverse=True))
            found.append(Joint((one, other), fragment["component"], (counts[one], counts[other]), strengths))
    return found


def describe(joint: Joint, names: Sequence[str]) -> str:
    (one, other), (num_one, num_other) = joint.logs, joint.num_positions
    by = "no loop between them"
    if joint.strengths:
        by = f"loops between them: {len(joint.strengths)}, strongest {joint.strengths[0]:.1f}"
    return (
        f"{names[one]} and {names[other]} joined in fragment {joint.fragment}: "
        f"{num_one} and {num_other} positions, {by}"
    )


def halves(text: str) -> tuple[str, str]:
    """The two halves of a log of shapemap-scans or CARMEN lines, as two logs; each has all that stands before the first
    scan. Raises ValueError for a log of less than two."""
    lines = text.splitlines(keepends=True)
    starts = [k for k, line in enumerate(lines) if line.split(maxsplit=1)[:1] in (["FLASER"], ["position"])]
    if len(starts) < 2:
        raise ValueError(f"{len(starts)} scans have no two halves")
    head, cut = lines[: starts[0]], starts[num_in_first_half(len(starts))]
    return "".join(lines[:cut]), "".join(head + lines[cut:])


def num_in_first_half(num_scans: int) -> int:
    return (num_scans + 1) // 2
