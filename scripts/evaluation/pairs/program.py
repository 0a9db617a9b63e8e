# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs `shapemap-cli align` on logs without poses."""

from __future__ import annotations

import json
import tempfile
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.common.programs import Failure, run_quietly
from evaluation.logs.reference_log import ReferenceLog

from .outcomes import CrossOutcome, PairOutcome, crashed, judge


@dataclass(frozen=True)
class Program:
    cli: Path
    arguments: list[str]
    timeout_s: float

    def align(self, references: ReferenceLog, queries: ReferenceLog, pair_lines: list[str]) -> list[dict[str, Any]]:
        """One answer for each line. Raises Failure."""
        with tempfile.TemporaryDirectory(prefix="pairs_") as name:
            folder = Path(name)
            logs = [folder / f"references{references.ending}", folder / f"queries{queries.ending}"]
            for path, log in zip(logs, (references, queries)):
                path.write_text(log.without_poses, encoding="utf-8")
            pairs, out = folder / "pairs.txt", folder / "out.jsonl"
            pairs.write_text("".join(f"{line}\n" for line in pair_lines), encoding="utf-8")
            command = [self.cli, "align", *(logs if queries is not references else logs[:1])]
            command += ["--pairs", pairs, "--out", out, "--quiet", *self.arguments]
            run_quietly(command, self.timeout_s, done=(0,))
            answers = [json.loads(line) for line in out.read_text(encoding="utf-8").splitlines()]
        if len(answers) != len(pair_lines):
            raise Failure(f"{len(answers)} answers to {len(pair_lines)} pairs")
        return answers


def evaluate_log(
    program: Program, log: ReferenceLog, gaps: list[int], doubt_margin: float
) -> tuple[list[PairOutcome], str]:
    """An outcome for each pair, and why there was no answer (else empty)."""
    pairs = log.pairs(gaps)
    lines = [f"{i} {j} {' '.join(repr(float(v)) for v in log.ref_from_query(i, j))}" for i, j in pairs]
    try:
        answers = program.align(log, log, lines) if lines else []
    except Failure as failure:
        return crashed(log, pairs, str(failure)), str(failure)
    return [judge(log, i, j, answer, doubt_margin) for (i, j), answer in zip(pairs, answers)], ""


def random_cross_pairs(logs: list[ReferenceLog], count: int, seed: int) -> dict[tuple[int, int], list[tuple[int, int]]]:
    """Pairs of positions by (log of the reference, log of the query), which are never the same."""
    rng = np.random.default_rng(seed)
    drawn: dict[tuple[int, int], list[tuple[int, int]]] = defaultdict(list)
    for _ in range(count if len(logs) > 1 else 0):
        a, b = (int(k) for k in rng.choice(len(logs), 2, replace=False))
        drawn[a, b].append((int(rng.integers(len(logs[a]))), int(rng.integers(len(logs[b])))))
    return drawn


def evaluate_cross(
    program: Program, logs: list[ReferenceLog], count: int, seed: int
) -> tuple[list[CrossOutcome], list[str]]:
    """Outcomes of pairs from different places, and the faults of runs without an answer."""
    outcomes, faults = [], []
    for (a, b), pairs in sorted(random_cross_pairs(logs, count, seed).items()):
        try:
            answers = program.align(logs[a], logs[b], [f"{i} {j}" for i, j in pairs])
        except Failure as failure:
            faults.append(f"{logs[a].name} against {logs[b].name}: {failure}")
            continue
        for (i, j), answer in zip(pairs, answers):
            probability = answer["probability"] or 0.0
            outcomes.append(CrossOutcome(logs[a].name, logs[b].name, i, j, answer["status"], probability))
    return outcomes, faults
