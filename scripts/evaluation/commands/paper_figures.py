# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the figures of "Robot Mapping for Rescue Robots" for the demo arena, or for any log or trace.

A log is mapped first, by the paper's method twice: as it is, and with each scan aligned to a single other one. Each
input gets a folder with every figure as SVG, PDF and PNG, and figures.json with what they show in numbers.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from evaluation.common.command_line import (
    add_method,
    add_passed_on,
    add_program,
    command_parser,
    complain,
    require_program,
)
from evaluation.common.programs import Failure
from evaluation.common.project import PROJECT
from evaluation.figures.references import poses_by_time, reference_poses
from evaluation.figures.source import Source, is_trace, sources_of

EXAMPLE = """examples:
  scripts/evaluate.py paper-figures
  scripts/evaluate.py paper-figures intel.log.gz --arg=--rotation-range-deg --arg=90 --arg=--first --arg=100
  shapemap-cli arena.nist --method paper --out map.png --trace arena.jsonl
  shapemap-baselines vasco arena.nist --poses results/figures/arena/before_icp.tum --trajectory vasco.tum
  scripts/evaluate.py paper-figures arena.jsonl --reference arena.tum --baseline-trajectory vasco.tum

Figures 5(d) and 6 need reference poses: --reference, else LOG.tum beside the log, else those in a text log.
Figure 5(b) needs --baseline-trajectory; before_icp.tum has the poses of 5(a), which the paper gave to its baseline.
Figures 2 to 4 of a trace need a second trace of the log, made with --target-scans 1. With reference poses the pairs
they show are chosen with them. What is left out is said, with the reason.
Exit status: 0 done, 1 a log could not be mapped, 2 wrong usage or a file that cannot be read."""


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    parser.add_argument("inputs", nargs="*", type=Path, metavar="LOG|TRACE", help="default: datasets/nist_arena.nist")
    parser.add_argument(
        "--out", type=Path, default=PROJECT / "results/figures", metavar="DIR", help="default: results/figures"
    )
    parser.add_argument("--reference", type=Path, metavar="FILE.tum", help="reference poses")
    parser.add_argument(
        "--baseline-trajectory", type=Path, metavar="FILE.tum", help="poses of the scan matcher, for figure 5(b)"
    )
    add_program(parser)
    add_method(parser, default="paper")
    add_passed_on(parser)
    parser.add_argument("--position", type=int, metavar="I", help="position of figure 1; default: the richest")
    parser.add_argument(
        "--hard-query", type=int, metavar="J", help="second position of figures 2 and 3; default: the hardest"
    )
    parser.add_argument(
        "--filtered-query", type=int, metavar="J", help="that of figure 4; default: where most is filtered out"
    )
    arguments = parser.parse_args(argv)
    arguments.inputs = arguments.inputs or [PROJECT / "datasets/nist_arena.nist"]
    if (arguments.reference or arguments.baseline_trajectory) and len(arguments.inputs) > 1:
        logs = [path for path in arguments.inputs if not is_trace(path)]
        if logs or len(arguments.inputs) > 2:
            parser.error("--reference and --baseline-trajectory are for one log")
    if not all(is_trace(path) for path in arguments.inputs):
        require_program(parser, arguments)
    return arguments


def draw(source: Source, arguments: argparse.Namespace) -> None:
    """All figures of one source, and a line about each."""
    from evaluation.figures.album import NO_REFERENCE, Choices, album_of  # matplotlib only when figures are drawn

    reference = reference_poses(source.main, source.log, arguments.reference)
    baseline = None
    if arguments.baseline_trajectory:
        baseline = poses_by_time(source.main, arguments.baseline_trajectory)
    choices = Choices(arguments.position, arguments.hard_query, arguments.filtered_query)
    album = album_of(source, reference, baseline, choices)
    folder = arguments.out / source.name
    album.write(folder, {"trace": str(source.main.path), "log": source.main.run["log"], "method": source.main.method})
    print(f"{source.name}: figures {' '.join(album.figures)} in {folder}")
    for why in dict.fromkeys(album.left_out.values()):
        names = " ".join(name for name, reason in album.left_out.items() if reason == why)
        print(f"{source.name}: left out {names}: {why}")
    if NO_REFERENCE in album.left_out.values():
        print(f"{source.name}: without reference poses no error can be told")


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        for source in sources_of(arguments.inputs, arguments.cli, arguments.out, arguments.method, arguments.arg):
            draw(source, arguments)
    except Failure as failure:
        complain(__name__, str(failure))
        return 1
    except (OSError, ValueError) as error:
        complain(__name__, str(error))
        return 2
    return 0
