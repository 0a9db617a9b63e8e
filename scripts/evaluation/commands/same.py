# SPDX-License-Identifier: GPL-3.0-or-later
"""Map logs with two versions of shapemap-cli, and tell which of their outputs are the same to the byte: trajectory,
picture, map.yaml and CARMEN log, and of the report the motions, probabilities, covariances, reasons and loops."""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from evaluation.common.argument_types import number
from evaluation.common.command_line import add_jobs, add_json, add_passed_on, add_timeout, command_parser, runnable
from evaluation.common.files import write_json
from evaluation.common.parallel import run_all
from evaluation.common.programs import Failure
from evaluation.common.project import found_log
from evaluation.common.tables import table
from evaluation.mapping.mapper import Mapper
from evaluation.mapping.outputs import OUTPUTS, first_difference, outputs_of
from evaluation.simulation.arena_options import hard_arena
from evaluation.simulation.simulation import simulate
from evaluation.simulation.write import nist_text

EXAMPLE = """Names of report members that changed between versions count as the same.

example:
  scripts/evaluate.py same before/shapemap-cli build/release/bin/shapemap-cli datasets/nist_arena.nist --arenas 20
  scripts/evaluate.py same before/shapemap-cli build/release/bin/shapemap-cli intel.log.gz --args --method paper

Exit status: 0 all is the same, 1 something differs, or a log is missing or gave no map, 2 wrong usage."""
SAME, DIFFERENT = "same", "different"


@dataclass(frozen=True)
class Outcome:
    """What became of one log. `differences` says where the outputs differ, by name of the output; `faults` says by
    program why it gave no map."""

    log: str
    differences: dict[str, str] = field(default_factory=dict)
    faults: dict[str, str] = field(default_factory=dict)

    @property
    def is_same(self) -> bool:
        return not self.faults and not any(self.differences.values())


def compared(name: str, logs: list[Path], before: Mapper, after: Mapper) -> Outcome:
    """Maps logs together with both programs."""
    outputs, faults = [], {}
    for program, mapper in (("before", before), ("after", after)):
        try:
            outputs.append(outputs_of(mapper, logs))
        except Failure as failure:
            faults[program] = str(failure)
    if faults:
        return Outcome(name, faults=faults)
    return Outcome(name, {output: first_difference(outputs[0][output], outputs[1][output]) for output in OUTPUTS})


def compared_arena(seed: int, before: Mapper, after: Mapper) -> Outcome:
    with tempfile.TemporaryDirectory(prefix="arena_") as folder:
        log = Path(folder) / f"arena-{seed}.nist"
        log.write_text(nist_text(simulate(hard_arena(seed))), encoding="utf-8")
        return compared(f"arena {seed}", [log], before, after)


def compared_case(case: str | int, before: Mapper, after: Mapper) -> Outcome:
    """A LOG that was named, or the arena of a seed."""
    if isinstance(case, int):
        return compared_arena(case, before, after)
    return compared(case, logs_of(case), before, after)


def logs_of(words: str) -> list[Path]:
    """One log or, unless there is a file of that very name, several with + between."""
    whole = found_log(Path(words))
    return [whole] if whole.exists() else [found_log(Path(word)) for word in words.split("+")]


def row(outcome: Outcome) -> list[str]:
    if outcome.faults:
        return [outcome.log, f"no map: {' and '.join(outcome.faults)}"]
    return [outcome.log, *(DIFFERENT if outcome.differences[output] else SAME for output in OUTPUTS)]


def details(outcome: Outcome) -> list[str]:
    """A line for each output that differs, and for each program that failed."""
    lines = [f"{outcome.log}: {output}: {where}" for output, where in outcome.differences.items() if where]
    return lines + [f"{outcome.log}: {program}: {fault}" for program, fault in outcome.faults.items()]


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add = parser.add_argument
    add("before", type=Path, metavar="BEFORE_CLI", help="one version of shapemap-cli")
    add("after", type=Path, metavar="AFTER_CLI", help="the other version")
    add("logs", nargs="*", metavar="LOG", help="path, or path below SHAPEMAP_DATASETS; LOG+LOG are mapped together")
    add("--arenas", type=number(0, 10**6, int), default=0, metavar="N", help="so many simulated arenas (default 0)")
    add_jobs(parser, "logs")
    add_timeout(parser, 3600.0)
    add_json(parser, "where the outputs differ")
    add_passed_on(parser)
    add("--args", nargs=argparse.REMAINDER, default=[], metavar="ARG", help="all that follows is passed on as well")
    arguments = parser.parse_args(argv)
    if not arguments.logs and not arguments.arenas:
        parser.error("no LOG and no --arenas")
    arguments.before = runnable(parser, arguments.before, "BEFORE_CLI")
    arguments.after = runnable(parser, arguments.after, "AFTER_CLI")
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    passed_on = (*arguments.arg, *arguments.args)
    mappers = [Mapper(cli, passed_on, arguments.timeout_s) for cli in (arguments.before, arguments.after)]
    cases = [*arguments.logs, *range(arguments.arenas)]
    outcomes = run_all(compared_case, [(case, *mappers) for case in cases], arguments.jobs)
    print(table(("log", *OUTPUTS), map(row, outcomes)))
    lines = [line for outcome in outcomes for line in details(outcome)]
    num_same = sum(outcome.is_same for outcome in outcomes)
    print("\n".join(["", *lines, f"{num_same} of {len(outcomes)} logs are the same in all"]))
    if arguments.json:
        write_json(arguments.json, {"arguments": passed_on, "logs": outcomes})
    return 0 if num_same == len(outcomes) else 1
