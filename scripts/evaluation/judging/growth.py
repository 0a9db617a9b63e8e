# SPDX-License-Identifier: GPL-3.0-or-later
"""What mapping takes as a log grows: runs on its first scans, on more of them, and so on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from evaluation.common.sampling import Sample
from evaluation.common.tables import table as markdown

FAR_OFF_M = 0.5
HEAD = (
    *("scans", "keyframes", "placed", "ATE", "worst", "CPU", "CPU per scan", "CPU per scan more"),
    *("wall", "memory"),
)


@dataclass(frozen=True)
class Stretch:
    """Scans one after the other that are far off; the worst of them by `worst_m`."""

    first: int
    last: int
    worst_m: float


@dataclass(frozen=True)
class Growth:
    """A run on the first `num_scans`. Times are those of the program; `ate_m` and `worst_m` are of the positions in
    the map, after the planar motion that fits best. `fault`: why there was no map."""

    num_scans: int
    fault: str = ""
    cpu_s: float = 0.0
    wall_s: float = 0.0
    peak_memory_mib: float = 0.0
    num_keyframes: int = 0
    num_placed: int = 0
    ate_m: float = float("nan")
    worst_m: float = float("nan")
    far_off: list[Stretch] = field(default_factory=list)
    stages_s: dict[str, float] = field(default_factory=dict)
    milestones: list[dict[str, float]] = field(default_factory=list, repr=False)
    samples: list[Sample] = field(default_factory=list, repr=False)


def stretches(errors_m: Mapping[int, float], limit_m: float = FAR_OFF_M) -> list[Stretch]:
    """Those of the scans with errors above the limit."""
    found: list[Stretch] = []
    for scan in sorted(scan for scan, error in errors_m.items() if error > limit_m):
        before = found[-1] if found and found[-1].last == scan - 1 else None
        if before is None:
            found.append(Stretch(scan, scan, errors_m[scan]))
        else:
            found[-1] = Stretch(before.first, scan, max(before.worst_m, errors_m[scan]))
    return found


def wrong_places(run: Growth) -> str:
    """A line for each stretch; empty without."""
    return "\n".join(
        f"of {run.num_scans} scans, {one.first} to {one.last} are up to {one.worst_m:.2f} m off" for one in run.far_off
    )


def prefixes(num_scans: int, last: int) -> list[int]:
    """1, 2, 5, 10, ... times a thousand, and with the log's end what it takes to tell its first `last` scans from the
    last ones."""
    steps = [digit * 10**power for power in range(3, 9) for digit in (1, 2, 5)]
    wanted = {*(step for step in steps if step < num_scans), last, num_scans - last, num_scans}
    return sorted(number for number in wanted if 0 < number <= num_scans)


def ms_per_scan(before: Growth | None, after: Growth) -> float:
    """CPU time of each scan that the longer run has more."""
    cpu_s, num = (0.0, 0) if before is None else (before.cpu_s, before.num_scans)
    return 1000.0 * (after.cpu_s - cpu_s) / (after.num_scans - num)


def table(runs: Sequence[Growth]) -> str:
    """A row for each run."""
    rows: list[list[object]] = []
    before: Growth | None = None
    for run in runs:
        if run.fault:
            rows.append([run.num_scans, f"no map: {run.fault}"])
            continue
        row: list[object] = [run.num_scans, run.num_keyframes, run.num_placed]
        row += [f"{100 * run.ate_m:.1f} cm", f"{100 * run.worst_m:.1f} cm", f"{run.cpu_s:.1f} s"]
        row += [f"{ms_per_scan(None, run):.1f} ms", f"{ms_per_scan(before, run):.1f} ms"]
        rows.append([*row, f"{run.wall_s:.1f} s", f"{run.peak_memory_mib:.0f} MiB"])
        before = run
    return markdown(HEAD, rows)


def first_and_last(runs: Sequence[Growth], last: int) -> str:
    """One line: what the last scans take against the first; empty where a run for it is missing."""
    by_scans = {run.num_scans: run for run in runs if not run.fault}
    whole = max(by_scans, default=0)
    if whole < 2 * last or not {last, whole - last} <= by_scans.keys():
        return ""
    first_ms = ms_per_scan(None, by_scans[last])
    last_ms = ms_per_scan(by_scans[whole - last], by_scans[whole])
    grown_mib = by_scans[whole].peak_memory_mib - by_scans[last].peak_memory_mib
    return (
        f"first {last} scans: {first_ms:.1f} ms of CPU time each; last {last} of {whole}: {last_ms:.1f} ms, "
        f"{last_ms / first_ms:.2f} times as much; memory: {grown_mib:+.0f} MiB from {last} scans to {whole}"
    )


def milestone_table(run: Growth) -> str:
    """What reading the log took, about each thousand scans: the final solving is not in it. Empty for a short log."""
    if not run.milestones:
        return ""
    rows = []
    num, cpu_s = 0.0, 0.0
    for milestone in run.milestones:
        per_scan_ms = 1000.0 * (milestone["cpu_s"] - cpu_s) / (milestone["num_scans"] - num)
        num, cpu_s = milestone["num_scans"], milestone["cpu_s"]
        rows.append([f"{num:.0f}", f"{per_scan_ms:.1f} ms", f"{milestone['peak_memory_mib']:.0f} MiB"])
    return markdown(("scans read", "CPU per scan since the line before", "memory"), rows)


def quarters(run: Growth) -> str:
    """One line: CPU time per scan of each quarter of the reading; empty without four milestones."""
    marks = [{"num_scans": 0.0, "cpu_s": 0.0}, *run.milestones]
    if len(marks) < 5:
        return ""
    at = [marks[round(k * (len(marks) - 1) / 4)] for k in range(5)]
    costs = [1000.0 * (b["cpu_s"] - a["cpu_s"]) / (b["num_scans"] - a["num_scans"]) for a, b in pairwise(at)]
    return "CPU time per scan in the four quarters of the log: " + ", ".join(f"{cost:.1f}" for cost in costs) + " ms"


def memory_line(run: Growth, parts: int = 10) -> str:
    """Memory over the time of a run; empty where it was too short to look."""
    if not run.samples:
        return ""
    last = len(run.samples) - 1
    values = [run.samples[round(k * last / parts)].rss_mib for k in range(parts + 1)]
    listed = ", ".join(f"{value:.0f}" for value in values)
    return f"memory of the run on {run.num_scans} scans, at each {100 // parts} % of its time: {listed} MiB"
