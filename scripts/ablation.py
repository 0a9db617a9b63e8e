#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What each part of the robust method is worth: right pairs on real logs, with the part and without it.

Each variant changes options of shapemap-cli. Right pairs are counted as evaluate_logs.py does, for all scans of the
logs and for every second and third of them; a figure is the mean over the logs.
"""

from __future__ import annotations

import argparse
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from evaluate_logs import ROOT, LogScore, score_log

STRIDES = (1, 2, 3)
# The chain by itself: loops and keyframes would hide what is lost.
CHAIN_ALONE = ["--method", "robust", "--no-close-loops", "--keyframe-step-m", "0"]
VARIANTS: dict[str, list[str]] = {
    "all of it": [],
    "no companions: the scan before alone decides": ["--companion-weight", "0"],
    "no help from scans further back": ["--more-references", "0"],
    "neither of these": ["--companion-weight", "0", "--more-references", "0"],
    "companions at twice the weight": ["--companion-weight", "1"],
    "no translations from the LCS": ["--shape-segments", "0"],
    "more translations from the LCS": ["--shape-segments", "8"],
    "no search of all rotations": ["--all-rotations-below", "-100"],
    "all rotations when in doubt": ["--all-rotations-below", "4"],
    "half of the rotations": ["--rotation-peaks", "4"],
    "half of the votes' peaks": ["--vote-peaks", "8"],
    "half of the refined poses": ["--refined-hypotheses", "10"],
    "free to slide along lines": ["--line-stiffness", "0"],
    "half of the points": ["--view-max-points", "120"],
    "twice the points": ["--view-max-points", "480"],
}
EXAMPLE = """example:
  SHAPEMAP_DATASETS=logs scripts/ablation.py carmen/{intel,orebro,belgioioso}-corrected.log.gz"""


def right_share(score: LogScore) -> float:
    return score.num_right / max(1, score.num_pairs)


def row(name: str, options: list[str], logs: list[Path], cli: Path) -> str:
    """A line of the table: mean share of right pairs for each stride, and CPU time for all scans."""
    cells = []
    cpu_ms = float("nan")
    for every in STRIDES:
        scores = [score_log(log, cli, [*CHAIN_ALONE, *options], every) for log in logs]
        cells.append(f"{100 * np.mean([right_share(score) for score in scores]):.2f} %")
        if every == 1:
            cpu_ms = 1000 * sum(score.cpu_s for score in scores) / sum(score.num_scans for score in scores)
    return f"| {name} | {' | '.join(cells)} | {cpu_ms:.1f} ms |"


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("logs", nargs="+", type=Path, metavar="LOG", help="path, or path below SHAPEMAP_DATASETS")
    parser.add_argument("--cli", type=Path, default=ROOT / "build/release/bin/shapemap-cli", metavar="FILE")
    parser.add_argument("--jobs", type=int, default=1, help="variants at a time; more than 1 disturbs the CPU times")
    arguments = parser.parse_args(argv)
    folder = Path(os.environ.get("SHAPEMAP_DATASETS", "."))
    logs = [log if log.exists() else folder / log for log in arguments.logs]
    print("| variant | all scans | every 2nd | every 3rd | CPU per scan |\n|---|---|---|---|---|")
    try:
        with ThreadPoolExecutor(arguments.jobs) as pool:
            rows = pool.map(lambda item: row(item[0], item[1], logs, arguments.cli), VARIANTS.items())
            for line in rows:
                print(line, flush=True)
    except (RuntimeError, OSError, ValueError) as error:
        print(f"ablation.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
