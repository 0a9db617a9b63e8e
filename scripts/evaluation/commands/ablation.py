# SPDX-License-Identifier: GPL-3.0-or-later
"""What each part of the robust method is worth: right pairs on real logs, with the part and without it.

Each variant changes options of shapemap-cli. Right pairs are counted as by `evaluate.py logs`, for all scans of the
logs and for every second and third of them; a figure is the mean over the logs.
"""

from __future__ import annotations

import argparse
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from evaluation.common.command_line import add_jobs, add_logs, add_program, command_parser, complain
from evaluation.common.programs import Failure
from evaluation.common.project import found_log
from evaluation.common.tables import table_head, table_row
from evaluation.judging.consecutive_pairs import LogScore, score_log

STRIDES = (1, 2, 3)
HEAD = ("variant", "all scans", "every 2nd", "every 3rd", "CPU per scan")
# The chain by itself: loops and keyframes would hide what is lost.
CHAIN_ALONE = ["--method", "robust", "--no-close-loops", "--keyframe-step-m", "0"]
VARIANTS: dict[str, list[str]] = {
    "all of it": [],
    "no companions: the scan before alone decides": ["--three-scan-weight", "0"],
    "no help from scans further back": ["--lending-keyframes", "0"],
    "neither of these": ["--three-scan-weight", "0", "--lending-keyframes", "0"],
    "companions at twice the weight": ["--three-scan-weight", "1"],
    "no translations from the LCS": ["--shape-segments", "0"],
    "more translations from the LCS": ["--shape-segments", "8"],
    "no search of all rotations": ["--all-rotations-below", "-100"],
    "all rotations when in doubt": ["--all-rotations-below", "4"],
    "half of the rotations": ["--rotation-peaks", "4"],
    "half of the votes' peaks": ["--vote-peaks", "8"],
    "half of the refined poses": ["--refined-candidates", "10"],
    "free to slide along lines": ["--line-stiffness", "0"],
    "half of the points": ["--view-max-points", "120"],
    "twice the points": ["--view-max-points", "480"],
}
EXAMPLE = """example:
  SHAPEMAP_DATASETS=logs scripts/evaluate.py ablation carmen/{intel,orebro,belgioioso}-corrected.log.gz"""


def right_share(score: LogScore) -> float:
    return score.num_right / max(1, score.num_pairs)


def row(name: str, options: list[str], logs: list[Path], cli: Path) -> list[str]:
    """A row of the table: mean share of right pairs for each stride, and CPU time for all scans."""
    cells = []
    cpu_ms = float("nan")
    for every in STRIDES:
        scores = [score_log(log, cli, [*CHAIN_ALONE, *options], every) for log in logs]
        cells.append(f"{100 * np.mean([right_share(score) for score in scores]):.2f} %")
        if every == 1:
            cpu_ms = 1000 * sum(score.cpu_s for score in scores) / sum(score.num_scans for score in scores)
    return [name, *cells, f"{cpu_ms:.1f} ms"]


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    add_logs(parser)
    add_program(parser)
    add_jobs(parser, "more than one disturbs the CPU times; variants", default=1)
    return parser.parse_args(argv)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    logs, cli = [found_log(log) for log in arguments.logs], arguments.cli.resolve()
    print(table_head(HEAD))
    try:
        with ThreadPoolExecutor(arguments.jobs) as pool:
            rows = pool.map(lambda item: row(item[0], item[1], logs, cli), VARIANTS.items())
            for cells in rows:
                print(table_row(cells), flush=True)
    except (Failure, OSError, ValueError) as error:
        complain(__name__, str(error))
        return 1
    return 0
