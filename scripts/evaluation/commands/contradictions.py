# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether scans that contradict the rest of the map are found: in simulated walks of which some scans are spoilt, with
the truth beside it, and in real logs, of which only the number of them is said."""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from evaluation.common.argument_types import some_of
from evaluation.common.command_line import add_jobs, add_json, add_program, add_seeds, command_parser, require_program
from evaluation.common.files import write_json
from evaluation.common.parallel import run_all
from evaluation.common.programs import Failure
from evaluation.common.shares import Share
from evaluation.common.tables import table
from evaluation.mapping.mapper import Mapper
from evaluation.simulation.spoilt_runs import KINDS, JudgedScan, judged_scans, spoilt_run
from evaluation.simulation.write import nist_text

EXAMPLE = """examples:
  scripts/evaluate.py contradictions --seeds 0-9
  scripts/evaluate.py contradictions --kinds '' --logs intel.log.gz orebro.log.gz

Exit status: 0 done, 1 some log gave no map, 2 wrong usage."""
SIMULATED_HEAD = (
    *("spoilt by", "in the map", "spoilt", "of these found", "recall (95 %)", "clean", "of these reported"),
    *("precision (95 %)", "reported of those between"),
)
LOG_HEAD = (
    *("log", "in the map", "contradict it", "share of contradicting beams: median, 90 %, 99 %"),
    "judging, of mapping",
)


@dataclass(frozen=True)
class Outcome:
    """What became of one simulated walk; `fault` says why there is no map."""

    kind: str
    seed: int
    scans: list[JudgedScan]
    fault: str = ""


@dataclass(frozen=True)
class LogOutcome:
    """What became of one real log. `seconds`: of the whole mapping, and of judging the scans."""

    name: str
    num_placed: int = 0
    contradicting: tuple[int, ...] = ()
    shares: tuple[float, ...] = ()
    seconds: tuple[float, float] = (0.0, 0.0)
    fault: str = ""


def run_simulated(kind: str, seed: int, cli: Path, more: list[str]) -> Outcome:
    run = spoilt_run(kind, seed)
    with tempfile.TemporaryDirectory(prefix=f"{kind}_") as name:
        log = Path(name) / "walk.nist"
        log.write_text(nist_text(run.simulation, f"walk with scans that are spoilt: {kind}"), encoding="utf-8")
        try:
            report, _ = Mapper(cli, tuple(more), 300.0).run([log], Path(name))
        except Failure as failure:
            return Outcome(kind, seed, [], str(failure))
    return Outcome(kind, seed, judged_scans(run, report))


def run_log(log: Path, cli: Path, more: list[str]) -> LogOutcome:
    with tempfile.TemporaryDirectory(prefix="log_") as name:
        try:
            report, _ = Mapper(cli, tuple(more)).run([log], Path(name))
        except Failure as failure:
            return LogOutcome(log.name, fault=str(failure))
    placed = [entry for entry in report["scans"] if entry["map_from_robot"]]
    found = tuple(entry["index"] for entry in placed if entry["consistency"]["contradicts_map"])
    shares = []
    for entry in placed:
        against = entry["consistency"]["through"] + entry["consistency"]["in_free"]
        shares.append(against / max(against + entry["consistency"]["agree"], 1e-9))
    seconds = (report["seconds"]["map"], report["seconds"]["consistency"])
    return LogOutcome(log.name, len(placed), found, tuple(shares), seconds)


def simulated_row(kind: str, outcomes: list[Outcome]) -> list[object]:
    scans = [scan for outcome in outcomes for scan in outcome.scans]
    spoilt, clean = [s for s in scans if s.spoilt], [s for s in scans if s.clean]
    hits, false = sum(s.flagged for s in spoilt), sum(s.flagged for s in clean)
    between = [s for s in scans if not s.spoilt and not s.clean]
    recall, precision = Share(hits, len(spoilt)).text(0), Share(hits, hits + false).text(0)
    reported = f"{sum(s.flagged for s in between)} of {len(between)}"
    return [kind, len(scans), len(spoilt), hits, recall, len(clean), false, precision, reported]


def simulated_table(outcomes: list[Outcome]) -> str:
    kinds = dict.fromkeys(outcome.kind for outcome in outcomes)
    rows = [simulated_row(kind, [outcome for outcome in outcomes if outcome.kind == kind]) for kind in kinds]
    return table(SIMULATED_HEAD, rows)


def log_table(outcomes: list[LogOutcome]) -> str:
    rows: list[list[object]] = []
    for one in outcomes:
        if one.fault:
            rows.append([one.name, f"no map: {one.fault}"])
            continue
        ordered = sorted(one.shares)
        at = [ordered[min(len(ordered) - 1, int(q * len(ordered)))] for q in (0.5, 0.9, 0.99)]
        shares, seconds = ", ".join(f"{q:.3f}" for q in at), f"{one.seconds[1]:.2f} s of {one.seconds[0]:.1f} s"
        rows.append([one.name, one.num_placed, len(one.contradicting), shares, seconds])
    return table(LOG_HEAD, rows)


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add = parser.add_argument
    add("--kinds", type=some_of(KINDS), default=list(KINDS), metavar="LIST", help="of simulated walks (default all)")
    add_seeds(parser, "0")
    add("--logs", type=Path, nargs="*", default=[], metavar="FILE", help="real logs")
    add(
        "--option",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="of the mapper: agreement-cell-m=0.2",
    )
    add_program(parser)
    add_jobs(parser, "walks")
    add_json(parser, "every scan")
    arguments = parser.parse_args(argv)
    require_program(parser, arguments)
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    more = [f"--{option}" for option in arguments.option]
    calls = [(kind, seed, arguments.cli, more) for kind, seed in product(arguments.kinds, arguments.seeds)]
    outcomes = run_all(run_simulated, calls, arguments.jobs)
    logs = [run_log(log, arguments.cli, more) for log in arguments.logs]
    if outcomes:
        print(simulated_table(outcomes))
    if logs:
        print(log_table(logs))
    faults = [f"{one.kind}, seed {one.seed}: no map: {one.fault}" for one in outcomes if one.fault]
    print("\n".join(faults), end="\n" if faults else "")
    if arguments.json:
        write_json(arguments.json, {"walks": outcomes, "logs": logs})
    return 1 if faults or any(one.fault for one in logs) else 0
