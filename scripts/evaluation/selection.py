# SPDX-License-Identifier: GPL-3.0-or-later
"""Which logs a script looks at: named files, or data sets of datasets.toml."""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Callable
from pathlib import Path

from simulate_arena import number

from .datasets import PROJECT, DatasetError, LogSpec, read_datasets, relations_beside, select
from .logs import EvaluationLog, load
from .mapping import Mapper


def name_list(text: str) -> list[str]:
    return [name for name in text.split(",") if name]


def add_datasets_argument(parser: argparse.ArgumentParser) -> None:
    default = PROJECT / "datasets/datasets.toml"
    parser.add_argument("--datasets", type=Path, default=default, metavar="FILE", help="what there is")
    parser.add_argument("--only", type=name_list, default=[], metavar="LIST", help="only these data sets or logs")


def parser_for_logs(description: str | None, example: str) -> argparse.ArgumentParser:
    """Knows LOG ..., --datasets and --only."""
    parser = argparse.ArgumentParser(
        description=description, epilog=example, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("logs", nargs="*", metavar="LOG", help="path, or path below SHAPEMAP_DATASETS")
    add_datasets_argument(parser)
    return parser


def parse_with_logs(parser: argparse.ArgumentParser, argv: list[str] | None) -> argparse.Namespace:
    arguments = parser.parse_args(argv)
    if not arguments.logs and not arguments.only:
        parser.error("no LOG and no --only")
    return arguments


def add_mapper_arguments(parser: argparse.ArgumentParser, timeout_s: float = 3600.0) -> None:
    add = parser.add_argument
    add("--cli", type=Path, default=PROJECT / "build/release/bin/shapemap-cli", metavar="FILE", help="the mapper")
    add("--arg", action="append", default=[], metavar="ARG", help="passed on to the mapper; repeat for more")
    add(
        "--timeout-s",
        type=number(0.1, 10**6),
        default=timeout_s,
        metavar="S",
        help="for one run (default %(default)g)",
    )
    add("--json", type=Path, metavar="FILE", help="write all that was found")


def mapper_from(arguments: argparse.Namespace) -> Mapper:
    return Mapper(arguments.cli.resolve(), tuple(arguments.arg), arguments.timeout_s)


def datasets_folder() -> Path | None:
    folder = os.environ.get("SHAPEMAP_DATASETS")
    return Path(folder) if folder else None


def named_spec(name: str) -> LogSpec:
    """Of a log by its path, or its path below SHAPEMAP_DATASETS; its own poses are the reference."""
    path = Path(name) if Path(name).exists() else (datasets_folder() or Path()) / name
    stem = path.name.split(".")[0].removesuffix("-corrected")
    return LogSpec(stem, stem, "as the log says", "slam", path=path, relations=relations_beside(path))


def selected_logs(arguments: argparse.Namespace, complain: Callable[[str], None]) -> tuple[list[EvaluationLog], int]:
    """Those that are named, then those of --only, and how many of them are missing. Raises DatasetError or OSError."""
    specs = [named_spec(name) for name in arguments.logs]
    if arguments.only:
        specs += select(read_datasets(arguments.datasets, datasets_folder()), arguments.only)
    names = [spec.name for spec in specs]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise DatasetError(f"twice: {', '.join(twice)}")
    logs = []
    with tempfile.TemporaryDirectory(prefix="logs_") as folder:  # for those that are simulated or converted
        for spec in specs:
            if spec.missing:
                complain(f"SKIPPED {spec.name}, missing: {', '.join(str(path) for path in spec.missing)}")
            else:
                logs.append(load(spec, Path(folder), arguments.cli))
    return logs, len(specs) - len(logs)
