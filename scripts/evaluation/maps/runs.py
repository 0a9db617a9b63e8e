# SPDX-License-Identifier: GPL-3.0-or-later
"""One run: a method on a log, and everything that is measured of it, as a JSON object."""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any

from evaluation.common.files import write_whole
from evaluation.common.programs import Failure, Usage, run_measured
from evaluation.judging import consecutive_pairs
from evaluation.logs.evaluation_log import EvaluationLog
from evaluation.logs.relations import relation_errors, summary

from . import trajectory_errors
from .ceiling import ceiling_relation_errors, ceiling_trajectory
from .map_agreement import map_agreement
from .methods import CEILING, FEEDS, Method, Programs, baseline_command, our_command
from .trajectories import Fragment, as_lists, read_trajectory


@dataclass(frozen=True)
class Job:
    """`folder` is the one of this run; those of the other methods on this log lie beside it."""

    log: EvaluationLog
    method: Method
    programs: Programs
    timeout_s: float
    out: Path

    @property
    def folder(self) -> Path:
        return self.out / "runs" / self.log.name / self.method.name

    @property
    def result_path(self) -> Path:
        return self.folder / "run.json"

    @property
    def feed(self) -> Path | None:
        return self.folder.parent / self.method.feed if self.method.feed else None

    def key(self) -> str:
        """Changes with all that the result depends on: --resume does again what has another key. Of the method that
        feeds this one that is what it wrote, not how."""
        programs = self.programs
        is_cli = self.method.is_ours or self.method.name == CEILING
        used = [programs.cli] if is_cli else [programs.baselines]
        if self.feed:
            used += [self.feed / name for name in FEEDS[: 1 + self.method.needs_covariances]]
        arguments = programs.arguments if is_cli else (*programs.baseline_arguments, programs.seed)
        parts = [self.log.sha256, self.method.name, [file_sha256(path) for path in used], self.timeout_s]
        parts += [arguments, self.log.spec.keeps_heading]
        return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


@cache
def file_sha256(path: Path) -> str | None:
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else None


def execute(job: Job) -> dict[str, Any]:
    """Runs, judges and writes the result, whole or not at all. A method that fails is a result, too."""
    job.folder.mkdir(parents=True, exist_ok=True)
    for old in job.folder.iterdir():
        old.unlink()
    try:
        result = about(job) | {"status": "ok", "reason": ""} | produce(job)
    except Failure as failure:
        result = failed(job, str(failure))
    write(job, result)
    return result


def write(job: Job, result: dict[str, Any]) -> None:
    write_whole(job.result_path, json.dumps(result, allow_nan=False) + "\n")


def finished(job: Job) -> dict[str, Any] | None:
    """The result of an earlier run of the same thing, if there is one that did not fail."""
    try:
        result: dict[str, Any] = json.loads(job.result_path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return result if result.get("key") == job.key() and result.get("status") == "ok" else None


def produce(job: Job) -> dict[str, Any]:
    """Raises Failure."""
    log = job.log
    if job.method.name == CEILING:
        limits = job.programs.cli, job.timeout_s
        if log.reference is None and not log.relations:
            raise Failure("a log without reference has no ceiling")
        fragments = ceiling_trajectory(log, *limits)
        return judge(log, fragments, None, ceiling_relation_errors(log, *limits))
    stripped = log.write_stripped(job.folder)
    if job.method.is_ours:
        command = our_command(job.programs, job.method, stripped, job.folder, log.spec.keeps_heading)
    else:
        command = baseline_command(job.programs, job.method, stripped, job.folder, job.feed)
    try:
        usage = run_measured(command, job.folder, job.timeout_s)
    finally:
        stripped.unlink()
    return judge(log, read_trajectory([job.folder / "out.tum"], len(log)), usage)


def about(job: Job) -> dict[str, Any]:
    spec = job.log.spec
    seed = None if job.method.is_ours or job.method.name == CEILING else job.programs.seed
    return {
        **{"log": spec.name, "group": spec.group, "method": job.method.name, "sha256": job.log.sha256},
        **{"key": job.key(), "seed": seed, "process": os.getpid(), "num_positions": len(job.log)},
    }


def failed(job: Job, reason: str) -> dict[str, Any]:
    """A failed run places nothing and gets no pair right; what depends on a map is unknown."""
    no_map = judge(job.log, [], None)
    return about(job) | no_map | {"status": "failed", "reason": reason}


def judge(
    log: EvaluationLog,
    fragments: list[Fragment],
    usage: Usage | None,
    of_relations: list[list[list[float] | None]] | None = None,
) -> dict[str, Any]:
    """All metrics; those for which the log has no reference are None. Trajectory errors and agreement are those of the
    largest fragment. `of_relations`: errors of the relations by file, where they are not those of the trajectory."""
    largest: Fragment = fragments[0] if fragments else {}
    result: dict[str, Any] = {
        "num_placed": len(largest),
        "coverage": len(largest) / len(log) if len(log) else 0.0,
        "num_fragments": len(fragments),
        "usage": asdict(usage) if usage else None,
        "trajectory": as_lists(fragments),
        **dict.fromkeys(("pairs", "ate", "rpe", "rpe_10m", "aligned_by", "map_agreement")),
        "relations": {},
    }
    for count, file in enumerate(log.relations):
        errors = of_relations[count] if of_relations else relation_errors(file.relations, fragments)
        kind = "scan_relations" if file.name.endswith(".scan_relations") else "relations"
        result["relations"][kind] = {
            **{"file": file.name, "num_outside": file.num_outside, **summary(errors)},
            "errors": [error and [round(value, 6) for value in error] for error in errors],
        }
    if log.reference is not None:
        result["pairs"] = consecutive_pairs.pairs(log.reference, fragments)
        result |= trajectory_errors.trajectory_errors(log.reference, largest)
        if (aligned_by := trajectory_errors.alignment(log.reference, largest)) is not None:
            result["map_agreement"] = map_agreement(log.reference, largest, log.content.points, aligned_by)
    return result
