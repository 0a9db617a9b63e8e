# SPDX-License-Identifier: GPL-3.0-or-later
"""One run of shapemap-cli on one log or several."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from evaluation.common.programs import Failure, Usage, run_measured

from .report import read_report

METHOD_ARGUMENTS = {
    "robust": ["--method", "robust"],
    # The grid of the paper is for robots that keep their heading; these turn.
    "paper": ["--method", "paper", "--rotation-range-deg", "90", "--rotation-step-deg", "2"],
}


@dataclass(frozen=True)
class Mapper:
    """`arguments` are passed on to the program."""

    cli: Path
    arguments: tuple[str, ...] = ()
    timeout_s: float = 3600.0

    def run(
        self,
        logs: Sequence[Path],
        folder: Path,
        started: Callable[[int], None] | None = None,
        more: Sequence[object] = (),
    ) -> tuple[dict[str, Any], Usage]:
        """The report and what the run took; map, report and what `more` asks for are written to the folder. `started`
        gets the process. Raises Failure."""
        report = folder / "report.json"
        command = [self.cli, *logs, "--out", folder / "map.png", "--report", report, "--quiet", "--force"]
        usage = run_measured([*command, *more, *self.arguments], folder, self.timeout_s, started)
        try:
            return read_report(report), usage
        except (OSError, ValueError) as error:
            raise Failure(f"no report: {error}") from None
