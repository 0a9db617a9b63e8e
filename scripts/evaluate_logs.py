#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Judge a mapper on real CARMEN logs: is each scan placed right against the scan before it?

The mapper gets the log as it is; it does not read poses (a test of the project proves that). The poses on the FLASER
lines are the reference, good to 5 to 10 cm. A pair of consecutive scans is right when both are in the map and their
relative pose is within 0.20 m and 5 degrees of the reference.
"""

from __future__ import annotations

import argparse
import gzip
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from shapemap_sim.poses import compose, inverse
from shapemap_sim.rates import wilson_interval

ROOT = Path(__file__).resolve().parent.parent
MAX_ERROR_M, MAX_ERROR_DEG = 0.20, 5.0
METHOD_ARGUMENTS = {
    "robust": ["--method", "robust"],
    # The grid of the paper is for robots that keep their heading; these turn.
    "paper": ["--method", "paper", "--rotation-range-deg", "90", "--rotation-step-deg", "2"],
}
EXAMPLE = """example:
  SHAPEMAP_DATASETS=logs scripts/evaluate_logs.py carmen/intel-corrected.log.gz carmen/aces-corrected.log.gz
"""


@dataclass(frozen=True)
class LogScore:
    name: str
    num_scans: int
    num_placed: int
    num_right: int
    median_m: float
    cpu_s: float
    peak_mib: float

    @property
    def num_pairs(self) -> int:
        return max(0, self.num_scans - 1)


def reference_poses(path: Path) -> list[np.ndarray]:
    """x [m], y [m], heading [rad] of each FLASER line."""
    poses = []
    opener = gzip.open if path.suffix == ".gz" else open
    with opener(path, "rt", encoding="utf-8", errors="replace") as lines:
        for line in lines:
            words = line.split()
            if words and words[0] == "FLASER":
                first = 2 + int(words[1])
                poses.append(np.array([float(word) for word in words[first : first + 3]]))
    return poses


def pair_errors(reference: list[np.ndarray], placed: dict[int, np.ndarray]) -> list[tuple[float, float]]:
    """Error of each consecutive pair in metres and degrees; infinite when one of the two is not in the map."""
    errors = []
    for i in range(1, len(reference)):
        if i not in placed or i - 1 not in placed:
            errors.append((float("inf"), float("inf")))
            continue
        truth = compose(inverse(reference[i - 1]), reference[i])
        found = compose(inverse(placed[i - 1]), placed[i])
        error = compose(inverse(truth), found)
        errors.append((float(np.hypot(error[0], error[1])), float(abs(np.degrees(error[2])))))
    return errors


def score_log(path: Path, cli: Path, arguments: list[str], every: int = 1) -> LogScore:
    """Map every so manieth scan of one log. Raises RuntimeError with the mapper's last line when it gives no map."""
    with tempfile.TemporaryDirectory() as folder:
        report_path = Path(folder) / "report.json"
        command = [cli, "--carmen", path, "--out", Path(folder) / "map.png", "--report", report_path, "--quiet"]
        command += ["--every", every, *arguments]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
        if done.returncode not in (0, 4):
            raise RuntimeError(f"{path.name}: {(done.stderr.strip().splitlines() or ['no message'])[-1]}")
        report = json.loads(report_path.read_text(encoding="utf-8"))
    placed = {}
    for position in report["positions"]:
        pose = position.get("map_from_robot")
        if pose:
            placed[position["index"]] = np.array([pose["x_m"], pose["y_m"], np.radians(pose["theta_deg"])])
    reference = reference_poses(path)[::every]
    errors = pair_errors(reference, placed)
    right = [m for m, deg in errors if m < MAX_ERROR_M and deg < MAX_ERROR_DEG]
    return LogScore(
        path.name,
        len(reference),
        len(placed),
        len(right),
        float(np.median(right)) if right else float("nan"),
        float(report["seconds"]["cpu"]),
        float(report["peak_memory_mib"]),
    )


def markdown(scores: list[LogScore]) -> str:
    lines = [
        "| log | scans | placed | right pairs (95 % interval) | median error | CPU per scan | memory |",
        "|---|---|---|---|---|---|---|",
    ]
    for score in scores:
        low, high = wilson_interval(score.num_right, score.num_pairs)
        share = score.num_right / score.num_pairs if score.num_pairs else float("nan")
        lines.append(
            f"| {score.name} | {score.num_scans} | {score.num_placed} | {100 * share:.1f} % "
            f"({100 * low:.1f}-{100 * high:.1f}) | {100 * score.median_m:.1f} cm "
            f"| {1000 * score.cpu_s / max(1, score.num_scans):.0f} ms | {score.peak_mib:.0f} MiB |"
        )
    mean = np.mean([score.num_right / score.num_pairs for score in scores if score.num_pairs])
    lines.append(f"| mean | | | {100 * mean:.1f} % | | | |")
    return "\n".join(lines)


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("logs", nargs="+", type=Path, metavar="LOG", help="path, or path below SHAPEMAP_DATASETS")
    parser.add_argument("--cli", type=Path, default=ROOT / "build/release/bin/shapemap-cli", metavar="FILE")
    parser.add_argument(
        "--method",
        choices=tuple(METHOD_ARGUMENTS),
        default="robust",
        help="of alignment, the paper's with rotations of -90 to 90 degrees (default %(default)s)",
    )
    parser.add_argument(
        "--arg", action="append", default=[], metavar="ARG", help="one more argument for the mapper, repeatable"
    )
    parser.add_argument("--every", type=int, default=1, metavar="K", help="use only every K-th scan")
    arguments = parser.parse_args(argv)
    folder = Path(os.environ.get("SHAPEMAP_DATASETS", "."))
    scores, status = [], 0
    for log in arguments.logs:
        path = log if log.exists() else folder / log
        try:
            mapper_arguments = METHOD_ARGUMENTS[arguments.method] + arguments.arg
            scores.append(score_log(path, arguments.cli, mapper_arguments, arguments.every))
        except (RuntimeError, OSError, ValueError) as error:
            print(f"evaluate_logs.py: {error}", file=sys.stderr)
            status = 1
    if scores:
        print(markdown(scores))
    return status


if __name__ == "__main__":
    sys.exit(main())
