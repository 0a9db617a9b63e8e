# SPDX-License-Identifier: GPL-3.0-or-later
"""Compare two evaluations, or two methods of one: paired over the same logs, seeds and pairs of positions.

Each difference comes with its interval and a test; see docs/evaluation.md for what they mean. Runs on different data
are not compared.
"""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import Any

from evaluation.common.command_line import add_json, command_parser, complain
from evaluation.common.files import write_json
from evaluation.common.tables import table
from evaluation.maps.comparison import EXPLANATION, HEAD, Row, as_cells, compare, paired_runs
from evaluation.maps.results import ResultsError, load_results

EXAMPLE = """example:
  scripts/evaluate.py compare before/results.json after/results.json --methods robust
  scripts/evaluate.py compare results/evaluation/results.json results/evaluation/results.json --methods paper,robust

Exit status: 0 compared, 2 wrong usage, 3 unreadable results, or results on different data."""


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    parser.add_argument("a", type=Path, metavar="A.json", help="results.json of `evaluate.py maps`")
    parser.add_argument(
        "b", type=Path, metavar="B.json", help="another one; the same for two methods of one evaluation"
    )
    parser.add_argument(
        "--methods",
        metavar="A[,B]",
        help="the method of A.json and that of B.json; one name for both (default: each that both have, with itself)",
    )
    parser.add_argument("--common", action="store_true", help="leave out logs that only one has, and name them")
    add_json(parser, "the rows")
    arguments = parser.parse_args(argv)
    names = (arguments.methods or "").split(",")
    if len(names) > 2 or (arguments.methods is not None and not all(names)):
        parser.error("--methods: expected one name or two")
    if arguments.a == arguments.b and len(set(names)) < 2:
        parser.error("A.json and B.json are the same: name two methods")
    return arguments


def method_pairs(a: dict[str, Any], b: dict[str, Any], chosen: str | None) -> list[tuple[str, str]]:
    """Raises ResultsError when the two have no method in common."""
    if chosen:
        names = chosen.split(",")
        return [(names[0], names[-1])]
    common = [(name, name) for name in a["methods"] if name in b["methods"]]
    if not common:
        raise ResultsError("no method in common; see --methods")
    return common


def heading(
    arguments: argparse.Namespace, results: tuple[dict[str, Any], dict[str, Any]], names: tuple[str, str]
) -> str:
    sides = []
    for side, path, result, name in zip("AB", (arguments.a, arguments.b), results, names):
        changes = " with changes" if result["commit_has_changes"] else ""
        sides.append(f"{side}: {name}, {path}, commit {result['commit'][:12] or 'unknown'}{changes}")
    return "\n".join(sides)


def left_out(runs_of: tuple[dict[str, Any], dict[str, Any]], names: tuple[str, str]) -> list[str]:
    logs = [{run["log"] for run in results["runs"] if run["method"] == name} for results, name in zip(runs_of, names)]
    return sorted(logs[0] ^ logs[1])


def row_dict(row: Row, names: tuple[str, str]) -> dict[str, Any]:
    return {"method_a": names[0], "method_b": names[1], **asdict(row), "value": row.difference.value}


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    rows: list[dict[str, Any]] = []
    texts: list[str] = []
    try:
        results = load_results(arguments.a), load_results(arguments.b)
        for names in method_pairs(*results, arguments.methods):
            compared = compare(paired_runs(*results, *names, common_only=arguments.common))
            texts += [heading(arguments, results, names), table(HEAD, [as_cells(row) for row in compared])]
            rows += [row_dict(row, names) for row in compared]
            if missing := left_out(results, names):
                texts.append(f"Left out, only one of the two has them: {', '.join(missing)}")
    except (ResultsError, OSError) as error:
        complain(__name__, str(error))
        return 3
    print("\n\n".join([*texts, EXPLANATION]))
    if arguments.json:
        write_json(arguments.json, {"rows": rows})
    return 0
