# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether distances that mean "no return" are found, and no real surfaces taken for one: in simulated logs of many
kinds of lasers, and in real CARMEN logs whose level is moved to other distances."""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

from evaluation.common.argument_types import some_of
from evaluation.common.command_line import add_jobs, add_program, add_seeds, command_parser, require_program
from evaluation.common.parallel import run_all
from evaluation.common.programs import Failure, run_quietly
from evaluation.common.shares import Share
from evaluation.common.tables import table as markdown
from evaluation.common.tables import table_head, table_row
from evaluation.logs.reference_log import opened
from evaluation.simulation.no_return_lasers import Mask, SensorLog
from evaluation.simulation.no_return_logs import CODED, KINDS, NoReturnLog, simulate_no_return_log

EXAMPLE = """examples:
  scripts/evaluate.py no-return --seeds 0-49
  scripts/evaluate.py no-return --kinds '' --logs intel.log.gz acapulco.log.gz

A level counts as found if 99 % of its readings are taken; levels with fewer than 60 runs of neighbouring beams are told
apart. A level where there is none, or one that is wider than it is, is a false alarm.

Exit status: 0 done, 1 a log could not be read, 2 wrong usage."""

HEAD = ("kind", "logs of a sensor", "levels", "found (95 %)", "too short to tell", "false alarms (95 %)")
FOUND_SHARE = 0.99
FEWEST_RUNS = 60
PRINTED_M = 0.001  # to which shapemap-cli prints levels
MOVED_TO = ("51.15", "50.9", "23.0", "5.6", "0.001", "51.0-51.2")
LEVEL = re.compile(r"no returns +([0-9.]+)(?: to ([0-9.]+))? m")


@dataclass(frozen=True)
class Outcome:
    """What became of one log. `short` counts levels with too few runs, `fault` says why the log could not be read."""

    kind: str
    seed: int
    levels: int = 0
    found: int = 0
    short: int = 0
    false_alarm: bool = False
    fault: str = ""


def told_levels(text: str) -> dict[str, list[tuple[float, float]]]:
    """What `info` says of each sensor."""
    levels: dict[str, list[tuple[float, float]]] = {}
    label = ""
    for line in text.splitlines():
        if line.startswith("sensor "):
            label = line.split(maxsplit=1)[1]
        if match := LEVEL.search(line):
            levels.setdefault(label, []).append((float(match[1]), float(match[2] or match[1])))
    return levels


def info(cli: Path, log: Path, timeout_s: float = 600.0) -> str:
    """What the program says of a log. Raises Failure."""
    return run_quietly([cli, "info", log], timeout_s, done=(0,))


def log_text(log: NoReturnLog) -> str:
    lines = ["shapemap-scans 1", f"# {log.kind}, seed {log.seed}"]
    for sensor in log.sensors:
        laser = sensor.laser
        header = f" max_range {sensor.header_m:.6g}" if sensor.header_m > 0.0 else ""
        step_deg = laser.fov_deg / (laser.num_beams - 1)
        first_deg = -0.5 * laser.fov_deg
        lines.append(
            f"sensor {sensor.label} beams {laser.num_beams} first_angle {first_deg:.6g} "
            f"angle_step {step_deg:.9g}{header}"
        )
    for i in range(len(log.sensors[0].ranges)):
        lines.append(f"position {i}")
        for sensor in log.sensors:
            readings = ("-" if np.isnan(r) else f"{r:.6g}" for r in sensor.ranges[i])
            lines.append(f"scan {sensor.label} heading 0 ranges {' '.join(readings)}")
    return "\n".join(lines) + "\n"


def num_runs(on_code: Mask) -> int:
    """How many runs of neighbouring beams there are."""
    before = np.pad(on_code, ((0, 0), (1, 0)))[:, :-1]
    return int((on_code & ~before).sum())


def judged(kind: str, seed: int, sensor: SensorLog, told: list[tuple[float, float]]) -> Outcome:
    taken = np.zeros(sensor.ranges.shape, bool)
    for low, high in told:
        taken |= (sensor.ranges >= low - PRINTED_M) & (sensor.ranges <= high + PRINTED_M)
    levels = found = short = 0
    for on_code in sensor.on_code:
        if num_runs(on_code) < FEWEST_RUNS:
            short += 1
            continue
        levels += 1
        found += int((taken & on_code).sum() >= FOUND_SHARE * on_code.sum())
    false = [
        (low, high)
        for low, high in told
        if not any(low >= first - 2 * PRINTED_M and high <= last + 2 * PRINTED_M for first, last in sensor.codes)
    ]
    return Outcome(kind, seed, levels, found, short, bool(false))


def run_simulated(kind: str, seed: int, cli: Path) -> list[Outcome]:
    """What became of a simulated log, for each of its sensors."""
    log = simulate_no_return_log(kind, seed)
    with tempfile.TemporaryDirectory(prefix="no_return_") as name:
        path = Path(name) / "log.nist"
        path.write_text(log_text(log), encoding="utf-8")
        try:
            told = told_levels(info(cli, path))
        except Failure as failure:
            return [Outcome(kind, seed, fault=str(failure))]
    return [judged(kind, seed, sensor, told.get(sensor.label, [])) for sensor in log.sensors]


def moved_lines(path: Path, level: tuple[float, float], to: tuple[float, float]) -> Iterator[str]:
    """The log with the readings of a level moved, evenly over the new one in steps of 5 cm."""
    low, high = (f"{edge:.3f}" for edge in level)
    steps = round((to[1] - to[0]) / 0.05) + 1
    turn = 0
    with opened(path) as lines:
        for line in lines:
            words = line.split(" ")
            if words[0] not in ("FLASER", "ROBOTLASER1"):
                yield line
                continue
            at = 1 if words[0] == "FLASER" else 8
            for i in range(at + 1, at + 1 + int(words[at])):
                if float(low) <= float(words[i]) <= float(high):
                    words[i] = f"{to[0] + 0.05 * (turn % steps):.3f}"
                    turn += 1
            yield " ".join(words)


def run_moved(path: Path, cli: Path) -> list[list[str]]:
    """A row of the table for each place that the log's highest level is moved to."""
    told = told_levels(info(cli, path))
    rows = [[path.name, "as it is", texts(told)]]
    levels = [level for of_sensor in told.values() for level in of_sensor]
    if not levels:
        return rows
    for place in MOVED_TO:
        first, _, last = place.partition("-")
        to = float(first), float(last or first)
        with tempfile.TemporaryDirectory(prefix="no_return_") as name:
            moved = Path(name) / "log.log"
            moved.write_text("".join(moved_lines(path, max(levels), to)), encoding="utf-8")
            rows.append([path.name, f"{place} m", texts(told_levels(info(cli, moved)))])
    return rows


def texts(told: dict[str, list[tuple[float, float]]]) -> str:
    all_levels = sorted(level for levels in told.values() for level in levels)
    return ", ".join(f"{low:.3f}" + (f" to {high:.3f}" if high > low else "") for low, high in all_levels) or "none"


def row(kind: str, outcomes: list[Outcome]) -> list[object]:
    levels, found = sum(o.levels for o in outcomes), sum(o.found for o in outcomes)
    false = sum(o.false_alarm for o in outcomes)
    too_short = sum(o.short for o in outcomes)
    return [kind, len(outcomes), levels, Share(found, levels), too_short, Share(false, len(outcomes))]


def table(outcomes: list[Outcome]) -> str:
    kinds = dict.fromkeys(o.kind for o in outcomes)
    rows = [row(kind, [o for o in outcomes if o.kind == kind]) for kind in kinds]
    rows.append(row("all with levels", [o for o in outcomes if o.kind in CODED]))
    rows.append(row("all without", [o for o in outcomes if o.kind not in CODED]))
    return markdown(HEAD, rows)


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add = parser.add_argument
    add("--kinds", type=some_of(KINDS), default=list(KINDS), metavar="LIST", help="of simulated logs (default all)")
    add_seeds(parser, "0")
    add("--logs", type=Path, nargs="*", default=[], metavar="FILE", help="real CARMEN logs, whose level is moved")
    add_program(parser, "the program")
    add_jobs(parser, "logs")
    arguments = parser.parse_args(argv)
    require_program(parser, arguments)
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    calls = [(kind, seed, arguments.cli) for kind, seed in product(arguments.kinds, arguments.seeds)]
    outcomes = [outcome for run in run_all(run_simulated, calls, arguments.jobs) for outcome in run]
    faults = [o for o in outcomes if o.fault]
    if outcomes:
        print(table([o for o in outcomes if not o.fault]))
    for o in outcomes:
        if o.fault or o.false_alarm or o.found < o.levels:
            what = o.fault or ("a false alarm" if o.false_alarm else "not found")
            print(f"{o.kind}, seed {o.seed}: {what}", file=sys.stderr)
    if arguments.logs:
        print(table_head(("log", "level moved to", "found")))
        for path in arguments.logs:
            print("\n".join(map(table_row, run_moved(path, arguments.cli))), flush=True)
    return 1 if faults else 0
