# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw a figure for each stage of the robust method, as docs/method.md shows them.

The demo log and a few simulated logs are mapped, and what the program writes of them is drawn: traces, reports, grids.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from evaluation.common.argument_types import some_of
from evaluation.common.command_line import add_program, command_parser, complain, require_program
from evaluation.common.programs import Failure
from evaluation.common.project import PROJECT

NAMES = (
    *("sweeps", "shape", "candidates", "keyframes", "odometry", "motion", "submaps", "loops", "verification"),
    *("refinement", "covariance", "culling", "grid"),
)
EXAMPLE = """example:
  scripts/evaluate.py method-figures
  scripts/evaluate.py method-figures --only candidates,loops --out results/figures --runs results/method

Exit status: 0 done, 1 a log could not be mapped, 2 wrong usage."""


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    parser.add_argument(
        "--only",
        type=some_of(NAMES, at_least=1),
        default=list(NAMES),
        metavar="LIST",
        help=f"figures to draw, of {','.join(NAMES)} (default all)",
    )
    parser.add_argument(
        "--out", type=Path, default=PROJECT / "docs/pictures", metavar="DIR", help="default: docs/pictures"
    )
    parser.add_argument("--runs", type=Path, metavar="DIR", help="keep logs and what the program wrote there")
    add_program(parser)
    arguments = parser.parse_args(argv)
    require_program(parser, arguments)
    return arguments


def draw(names: list[str], out: Path, cli: Path, folder: Path) -> None:
    """Raises Failure."""
    from evaluation.figures import method_maps, method_scans  # matplotlib only when figures are drawn
    from evaluation.figures.method_drawing import save
    from evaluation.figures.method_runs import Runs

    runs = Runs(cli, folder)
    for name in names:
        module = method_scans if hasattr(method_scans, f"{name}_figure") else method_maps
        path = out / f"method_{name}.png"
        save(getattr(module, f"{name}_figure")(runs), path)
        print(path)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        with tempfile.TemporaryDirectory(prefix="method_") as folder:
            draw(arguments.only, arguments.out, arguments.cli, arguments.runs or Path(folder))
    except (Failure, OSError, ValueError) as error:
        complain(__name__, str(error))
        return 1
    return 0
