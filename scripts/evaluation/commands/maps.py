# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluate whole maps: run methods on all data sets at hand, judge them against the references, write a report.

Every program gets logs without any pose or odometry. Results are written to --out: report.html (one file, opens
without a network), report.md, results.json (for `evaluate.py compare`), and a folder for each run.
"""

from __future__ import annotations

import argparse
import os
import shlex
import signal
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tqdm import tqdm

from evaluation.common.argument_types import name_list, number, parse_seeds
from evaluation.common.command_line import add_jobs, add_passed_on, add_program, command_parser, complain
from evaluation.common.files import plain
from evaluation.common.project import BIN, PROJECT
from evaluation.logs.datasets import DatasetError, LogSpec, read_datasets, select
from evaluation.logs.evaluation_log import EvaluationLog, load
from evaluation.logs.selection import add_datasets_argument, datasets_folder
from evaluation.maps.methods import ALL, CEILING, Method, Programs, with_feeds
from evaluation.maps.results import assemble, save
from evaluation.maps.runs import Job
from evaluation.maps.schedule import Schedule

TIMEOUT_S = 1800.0
QUICK_LOGS, QUICK_TIMEOUT_S = ["demo"], 15.0
EXAMPLE = f"""methods: {", ".join(ALL)};
  BASELINE+robust and BASELINE+paper get our estimated poses as odometry; see docs/evaluation.md

example:
  scripts/evaluate.py maps --quick
  SHAPEMAP_DATASETS=logs scripts/evaluate.py maps --jobs 2 --timeout-s 1800
  scripts/evaluate.py maps --only demo,orebro --methods robust,paper,ceiling --out results/short --resume

Exit status: 0 all runs gave a result, 1 some failed or a log asked for by --only is missing, 2 wrong usage,
3 malformed data sets, logs or references (nothing was run), 130 interrupted (what was done is reported)."""


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add = parser.add_argument
    add_datasets_argument(parser)
    add("--seeds", type=parse_seeds, metavar="LIST", help="of the arenas, instead of those in the file, such as 0-4")
    add("--methods", type=name_list, default=list(ALL), metavar="LIST", help="only these (default all, see below)")
    add("--quick", action="store_true", help="the demo log only, at most 15 s for a run: under two minutes")
    add("--out", type=Path, default=PROJECT / "results/evaluation", metavar="DIR", help="(default results/evaluation)")
    add_jobs(parser, "runs", default=os.cpu_count() or 1)
    add(
        "--timeout-s",
        type=number(0.1, 10**6),
        metavar="S",
        help=f"for one run (default {TIMEOUT_S:g}, with --quick {QUICK_TIMEOUT_S:g})",
    )
    add("--resume", action="store_true", help="keep the runs in --out that are done, if nothing about them changed")
    add_program(parser)
    add("--baselines", type=Path, default=BIN / "shapemap-baselines", metavar="FILE", help="the baselines")
    add_passed_on(parser)
    add("--baseline-arg", action="append", default=[], metavar="ARG", help="passed on to the baselines")
    add("--seed", type=number(0, 2**31 - 1, int), default=0, metavar="N", help="of the particle filter (default 0)")
    add(
        "--most-failures",
        type=number(0, 1000, int),
        default=6,
        metavar="N",
        help="pictures of failed pairs per method and data set",
    )
    add("--snapshot", type=Path, metavar="FILE.md", help="also write the tables there, with the command")
    add("--snapshot-logs", type=name_list, default=[], metavar="LIST", help="logs whose pictures go with it")
    arguments = parser.parse_args(argv)
    try:
        arguments.chosen = with_feeds(arguments.methods)
    except ValueError as error:
        parser.error(f"--methods: {error}")
    if arguments.quick:
        arguments.only = arguments.only or QUICK_LOGS
    if arguments.timeout_s is None:
        arguments.timeout_s = QUICK_TIMEOUT_S if arguments.quick else TIMEOUT_S
    return arguments


def logs_at_hand(arguments: argparse.Namespace) -> tuple[list[EvaluationLog], list[dict[str, str]]]:
    """Those that are there, and those that are not, each named. Raises DatasetError or OSError."""
    specs: list[LogSpec] = select(read_datasets(arguments.datasets, datasets_folder(), arguments.seeds), arguments.only)
    logs, skipped = [], []
    for spec in tqdm(specs, desc="reading", disable=None, leave=False):
        if spec.missing:
            why = ", ".join(str(path) for path in spec.missing)
            skipped.append({"name": spec.name, "missing": ", ".join(path.name for path in spec.missing)})
            complain(__name__, f"SKIPPED {spec.name}, missing: {why}")
        else:
            logs.append(load(spec, arguments.out / "logs", arguments.cli))
    for log in logs:
        if log.reference is None and not log.relations:
            complain(__name__, f"{log.name} has no reference: maps and timing only")
    return logs, skipped


def can_run(log: EvaluationLog, method: Method) -> bool:
    return method.is_ours or log.spec.baselines


def jobs_for(logs: Sequence[EvaluationLog], arguments: argparse.Namespace) -> list[Job]:
    programs = programs_of(arguments)
    return [
        Job(log, method, programs, arguments.timeout_s, arguments.out)
        for log in logs
        for method in arguments.chosen
        if (log.reference is not None or log.relations if method.name == CEILING else can_run(log, method))
    ]


def programs_of(arguments: argparse.Namespace) -> Programs:
    paths = arguments.cli.resolve(), arguments.baselines.resolve()
    return Programs(*paths, tuple(arguments.arg), tuple(arguments.baseline_arg), arguments.seed)


def options_of(arguments: argparse.Namespace) -> dict[str, Any]:
    return plain({key: value for key, value in vars(arguments).items() if key != "chosen"})


def evaluate(arguments: argparse.Namespace, words: Sequence[str]) -> int:
    """All of it: reads, runs, judges and reports. `words` are what was typed."""
    started = time.monotonic()
    try:
        logs, skipped = logs_at_hand(arguments)
    except (DatasetError, OSError) as error:
        complain(__name__, str(error))
        return 3
    if not logs:
        complain(__name__, "no data set at hand")
        return 1
    faults: list[str] = []
    jobs = jobs_for(logs, arguments)
    runs, complete = Schedule(jobs, arguments.jobs, arguments.resume, faults.append).run()
    about = {
        "command": shlex.join(["scripts/evaluate.py", "maps", *words]),
        "options": options_of(arguments),
        "wall_s": time.monotonic() - started,
        "complete": complete,
    }
    results = assemble(logs, skipped, arguments.chosen, programs_of(arguments), runs, about)
    save(results, arguments.out / "results.json")
    from evaluation.maps.report import write_report  # matplotlib and all that only when there is something to draw

    write_report(results, {log.name: log for log in logs}, arguments)
    print(f"{len(runs)} of {len(jobs)} runs, {len(faults)} failed; report: {arguments.out / 'report.html'}")
    if not complete:
        complain(__name__, f"interrupted; {len(runs)} of {len(jobs)} runs are done, --resume does the rest")
        return 130
    return 1 if faults or (skipped and arguments.only) else 0


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)  # ends as Ctrl-C does
    try:
        return evaluate(arguments, sys.argv[2:] if argv is None else argv)
    except KeyboardInterrupt:  # before the first run, or in the middle of the report
        complain(__name__, "interrupted; --resume keeps the runs that are done")
        return 130
    finally:
        signal.signal(signal.SIGTERM, before)
