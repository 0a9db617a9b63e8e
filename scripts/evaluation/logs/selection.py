# SPDX-License-Identifier: GPL-3.0-or-later
"""Which logs a command looks at: named files, or data sets of datasets.toml."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from evaluation.common.argument_types import name_list
from evaluation.common.command_line import command_parser, complain
from evaluation.common.project import PROJECT, datasets_folder, found_log

from .datasets import DatasetError, LogSpec, read_datasets, relations_beside, select
from .evaluation_log import EvaluationLog, load
from .variants import VariedLog, varied


def add_datasets_argument(parser: argparse.ArgumentParser) -> None:
    default = PROJECT / "datasets/datasets.toml"
    parser.add_argument("--datasets", type=Path, default=default, metavar="FILE", help="what there is")
    parser.add_argument("--only", type=name_list, default=[], metavar="LIST", help="only these data sets or logs")


def parser_for_logs(module: str, description: str | None, epilog: str) -> argparse.ArgumentParser:
    """A parser of a command that knows LOG ..., --datasets and --only."""
    parser = command_parser(module, description, epilog)
    parser.add_argument("logs", nargs="*", metavar="LOG", help="path, or path below SHAPEMAP_DATASETS")
    add_datasets_argument(parser)
    return parser


def parse_with_logs(parser: argparse.ArgumentParser, argv: list[str] | None) -> argparse.Namespace:
    arguments = parser.parse_args(argv)
    if not arguments.logs and not arguments.only:
        parser.error("no LOG and no --only")
    return arguments


def named_spec(name: str) -> LogSpec:
    """What is known of a log by its path, or its path below SHAPEMAP_DATASETS; its own poses are the reference."""
    path = found_log(Path(name))
    stem = path.name.split(".")[0].removesuffix("-corrected")
    return LogSpec(stem, stem, "as the log says", "slam", path=path, relations=relations_beside(path))


def selected_logs(module: str, arguments: argparse.Namespace) -> tuple[list[EvaluationLog], int]:
    """The logs that are named, then those of --only, and how many of them are missing, which the command complains of.
    Raises DatasetError or OSError."""
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
                complain(module, f"SKIPPED {spec.name}, missing: {', '.join(str(path) for path in spec.missing)}")
            else:
                logs.append(load(spec, Path(folder), arguments.cli))
    return logs, len(specs) - len(logs)


def selected_variants(module: str, arguments: argparse.Namespace) -> tuple[list[VariedLog], int]:
    """Each variant of each selected log, and how many logs are missing. Raises DatasetError or OSError."""
    logs, num_missing = selected_logs(module, arguments)
    return [varied(log, variant) for log in logs for variant in arguments.variants], num_missing
