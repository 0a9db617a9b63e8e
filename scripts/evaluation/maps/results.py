# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of an evaluation as one JSON object, with all that is needed to compare it with another one."""

from __future__ import annotations

import json
import os
import platform
import subprocess
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from evaluation.common.files import write_whole
from evaluation.common.project import PROJECT
from evaluation.judging.consecutive_pairs import MAX_ERROR_DEG, MAX_ERROR_M
from evaluation.logs.datasets import REFERENCES
from evaluation.logs.evaluation_log import EvaluationLog

from .map_agreement import CELL_M, WITHIN_M
from .methods import Method, Programs
from .runs import file_sha256

SCHEMA = "shapemap-evaluation"
SCHEMA_VERSION = 1


class ResultsError(ValueError):
    """A file that holds no results that this version can read, or two that cannot be compared."""


def git(*words: str) -> str:
    """What git says of the project; empty outside of a checkout."""
    command = ["git", "-C", str(PROJECT), *words]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError:
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def machine() -> dict[str, Any]:
    cpu = platform.processor()
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [
            line.split(":", 1)[1].strip() for line in info.read_text().splitlines() if line.startswith("model name")
        ]
        cpu = names[0] if names else cpu
    memory_mib = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20
    return {
        **{"system": platform.platform(), "cpu": cpu, "num_cpus": os.cpu_count(), "memory_mib": memory_mib},
        "python": platform.python_version(),
    }


def program_info(path: Path) -> dict[str, Any]:
    return {"path": str(path), "sha256": file_sha256(path)}


def assemble(
    logs: Sequence[EvaluationLog],
    skipped: Sequence[dict[str, str]],
    methods: Sequence[Method],
    programs: Programs,
    runs: Sequence[dict[str, Any]],
    about: dict[str, Any],
) -> dict[str, Any]:
    """The whole; `about` has the command, the options, the wall time and whether all was done."""
    return {
        "schema": SCHEMA,
        "schema_version": SCHEMA_VERSION,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "commit": git("rev-parse", "HEAD"),
        "commit_has_changes": bool(git("status", "--porcelain", "--untracked-files=no")),
        **about,
        "machine": machine(),
        "programs": {"cli": program_info(programs.cli), "baselines": program_info(programs.baselines)},
        "limits": {"right_m": MAX_ERROR_M, "right_deg": MAX_ERROR_DEG, "cell_m": CELL_M, "within_m": WITHIN_M},
        "methods": [method.name for method in methods],
        "logs": [describe(log) for log in logs],
        "skipped": list(skipped),
        "runs": list(runs),
    }


def describe(log: EvaluationLog) -> dict[str, Any]:
    spec = log.spec
    return {
        **{"name": spec.name, "group": spec.group, "sensor": spec.sensor, "num_positions": len(log)},
        **{"reference": spec.reference, "reference_is": REFERENCES[spec.reference], "seed": spec.seed},
        **{"sha256": log.sha256, "every": spec.every, "first": spec.first},
        "relations": [{"file": f.name, "num": len(f.relations), "num_outside": f.num_outside} for f in log.relations],
    }


def save(results: dict[str, Any], path: Path) -> None:
    write_whole(path, json.dumps(results, indent=None, allow_nan=False) + "\n")


def load_results(path: Path) -> dict[str, Any]:
    """Raises ResultsError that names the file; OSError."""
    try:
        results = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ResultsError(f"{path}: no JSON: {error}") from None
    if not isinstance(results, dict) or results.get("schema") != SCHEMA:
        raise ResultsError(f"{path}: no results of `evaluate.py maps`")
    if results.get("schema_version") != SCHEMA_VERSION:
        raise ResultsError(f"{path}: schema version {results.get('schema_version')}, expected {SCHEMA_VERSION}")
    return results
