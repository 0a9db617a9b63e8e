#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether scans that contradict the rest of the map are found: in simulated walks of which some scans are spoilt, with
the truth beside it, and in real logs, of which only the number of them is said."""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from evaluate_arena import parse_seeds, run_mapper
from shapemap_sim.rates import wilson_interval
from shapemap_sim.spoilt_runs import KINDS, JudgedScan, judged_scans, spoilt_run
from shapemap_sim.write import nist_text
from simulate_arena import number, some_of

ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = """examples:
  scripts/evaluate_contradictions.py --seeds 0-9
  scripts/evaluate_contradictions.py --kinds '' --logs intel.log.gz orebro.log.gz

Exit status: 0 done, 1 some log gave no map, 2 wrong usage."""


@dataclass(frozen=True)
class Outcome:
    """Of one simulated walk; `fault`: why there is no map."""

    kind: str
    seed: int
    scans: list[JudgedScan]
    fault: str = ""


@dataclass(frozen=True)
class LogOutcome:
    """Of one real log. `seconds`: of the whole mapping, and of judging the scans."""

    name: str
    num_placed: int = 0
    contradicting: tuple[int, ...] = ()
    shares: tuple[float, ...] = ()
    seconds: tuple[float, float] = (0.0, 0.0)
    fault: str = ""


def mapped(cli: Path, log: Path, folder: Path, more: list[str], timeout_s: float) -> tuple[dict[str, Any] | None, str]:
    report = folder / "report.json"
    command = [str(cli), str(log), "--out", str(folder / "map.png"), "--report", str(report), "--quiet", *more]
    return run_mapper(command, report, timeout_s)


def run_simulated(kind: str, seed: int, cli: Path, more: list[str]) -> Outcome:
    run = spoilt_run(kind, seed)
    with tempfile.TemporaryDirectory(prefix=f"{kind}_") as name:
        log = Path(name) / "walk.nist"
        log.write_text(nist_text(run.simulation, f"walk with scans that are spoilt: {kind}"), encoding="utf-8")
        report, fault = mapped(cli, log, Path(name), more, 300.0)
    return Outcome(kind, seed, [], fault) if report is None else Outcome(kind, seed, judged_scans(run, report))


def run_log(log: Path, cli: Path, more: list[str]) -> LogOutcome:
    with tempfile.TemporaryDirectory(prefix="log_") as name:
        report, fault = mapped(cli, log, Path(name), more, 3600.0)
    if report is None:
        return LogOutcome(log.name, fault=fault)
    placed = [entry for entry in report["positions"] if entry["map_from_robot"]]
    found = tuple(entry["index"] for entry in placed if entry["agreement"]["contradicts_map"])
    shares = []
    for entry in placed:
        against = entry["agreement"]["through"] + entry["agreement"]["in_free"]
        shares.append(against / max(against + entry["agreement"]["agree"], 1e-9))
    seconds = (report["seconds"]["map"], report["seconds"]["agreement"])
    return LogOutcome(log.name, len(placed), found, tuple(shares), seconds)


def rate(count: int, total: int) -> str:
    if total == 0:
        return "-"
    low, high = wilson_interval(count, total)
    return f"{100 * count / total:.0f} % ({100 * low:.0f}-{100 * high:.0f})"


def simulated_row(kind: str, outcomes: list[Outcome]) -> str:
    scans = [scan for outcome in outcomes for scan in outcome.scans]
    spoilt, clean = [s for s in scans if s.spoilt], [s for s in scans if s.clean]
    hits, false = sum(s.flagged for s in spoilt), sum(s.flagged for s in clean)
    between = [s for s in scans if not s.spoilt and not s.clean]
    return (
        f"| {kind} | {len(scans)} | {len(spoilt)} | {hits} | {rate(hits, len(spoilt))} | {len(clean)} | {false} "
        f"| {rate(hits, hits + false)} | {sum(s.flagged for s in between)} of {len(between)} |"
    )


def simulated_table(outcomes: list[Outcome]) -> str:
    lines = [
        "| spoilt by | in the map | spoilt | of these found | recall (95 %) | clean | of these reported "
        "| precision (95 %) | reported of those between |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for kind in dict.fromkeys(outcome.kind for outcome in outcomes):
        lines.append(simulated_row(kind, [outcome for outcome in outcomes if outcome.kind == kind]))
    return "\n".join(lines)


def log_table(outcomes: list[LogOutcome]) -> str:
    lines = [
        "| log | in the map | contradict it | share of contradicting beams: median, 90 %, 99 % | judging, of mapping |",
        "|---|---|---|---|---|",
    ]
    for one in outcomes:
        if one.fault:
            lines.append(f"| {one.name} | no map: {one.fault} | | | |")
            continue
        ordered = sorted(one.shares)
        at = [ordered[min(len(ordered) - 1, int(q * len(ordered)))] for q in (0.5, 0.9, 0.99)]
        lines.append(
            f"| {one.name} | {one.num_placed} | {len(one.contradicting)} | {', '.join(f'{q:.3f}' for q in at)} "
            f"| {one.seconds[1]:.2f} s of {one.seconds[0]:.1f} s |"
        )
    return "\n".join(lines)


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("--kinds", type=some_of(KINDS), default=list(KINDS), metavar="LIST", help="of simulated walks (default all)")
    add("--seeds", type=parse_seeds, default=[0], metavar="LIST", help="such as 0-9 (default 0)")
    add("--logs", type=Path, nargs="*", default=[], metavar="FILE", help="real logs")
    add(
        "--option",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="of the mapper: agreement-cell-m=0.2",
    )
    add(
        "--cli",
        type=Path,
        default=ROOT / "build/release/bin/shapemap-cli",
        metavar="FILE",
        help="the mapper (default build/release/bin/shapemap-cli)",
    )
    add("--jobs", type=number(1, 256, int), default=2, metavar="N", help="walks at the same time")
    add("--json", type=Path, metavar="FILE", help="write every scan")
    arguments = parser.parse_args(argv)
    if not os.access(arguments.cli, os.X_OK):
        parser.error(f"--cli: {arguments.cli} is not a program; build it with `cmake --build --preset release`")
    arguments.cli = arguments.cli.resolve()  # a bare name would be looked up elsewhere
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    more = [f"--{option}" for option in arguments.option]
    with ProcessPoolExecutor(max_workers=arguments.jobs) as pool:
        walks = [
            pool.submit(run_simulated, kind, seed, arguments.cli, more)
            for kind in arguments.kinds
            for seed in arguments.seeds
        ]
        outcomes = [walk.result() for walk in walks]
    logs = [run_log(log, arguments.cli, more) for log in arguments.logs]
    if outcomes:
        print(simulated_table(outcomes))
    if logs:
        print(log_table(logs))
    faults = [f"{one.kind}, seed {one.seed}: no map: {one.fault}" for one in outcomes if one.fault]
    print("\n".join(faults), end="\n" if faults else "")
    if arguments.json:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
        rows = {"walks": [asdict(one) for one in outcomes], "logs": [asdict(one) for one in logs]}
        arguments.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    return 1 if faults or any(one.fault for one in logs) else 0


if __name__ == "__main__":
    sys.exit(main())
