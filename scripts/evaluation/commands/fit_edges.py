# SPDX-License-Identifier: GPL-3.0-or-later
"""Fit how probable a link between consecutive keyframes is: one that no loop holds by its two scans, and one in doubt
by all scans of both sides. Links come from variants of real logs, from simulated arenas and from hard scenes; how
probable the mapper says they are is held against the truth: on logs that nothing was fitted to, a test of it. What is
fitted is printed beside the weights in use, as `shapemap-cli numbers` tells them, and belongs into
matching_numbers.hpp, graph_numbers.hpp and objective_numbers.hpp; what a parallel link says was made with the weights
in use, so that a fit of its weight is one step towards the best."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np

from evaluation.common.argument_types import name_list
from evaluation.common.command_line import add_jobs, add_seeds, complain
from evaluation.common.files import write_json
from evaluation.common.parallel import run_all
from evaluation.common.programs import Failure
from evaluation.fitting.edge_fits import (
    REVISION_TERMS,
    EdgeNumbers,
    calibration_table,
    fitted_neighbours,
    fitted_revision,
    mean_log_likelihood,
)
from evaluation.fitting.known_edges import Links, links_of_arena, links_of_scene, links_of_variant
from evaluation.logs.datasets import DatasetError
from evaluation.logs.selection import parser_for_logs, selected_variants
from evaluation.mapping.numbers import numbers_of
from evaluation.mapping.options import add_mapper_arguments, mapper_from

EXAMPLE = """example, what the weights were fitted to, and what they were tried on:
  scripts/evaluate.py fit-edges --only orebro,belgioioso,aces,csail --seeds 0-79
  scripts/evaluate.py fit-edges --scene-seeds 20-49 --shortfall-alone
  scripts/evaluate.py fit-edges --only orebro,belgioioso,aces,csail --seeds 80-159 --scene-seeds 50-69 \\
    --variants drop-30-5,drop-30-6,drop-30-7,drop-20-2,drop-25-0,mirrored+every-2-0,reversed+drop-30-8

Exit status: 0 done, 1 some runs gave no map or a log is missing, 2 wrong usage, 3 malformed data sets or logs."""
VARIANTS = "drop-30-2,drop-30-3,drop-30-4,drop-20-0,drop-20-1,drop-40-0,every-2-0+reversed,every-2-1+reversed"
SCENES_WITH_LINKS = (  # right or wrong, and not hidden by people
    "twin-rooms,half-random,half-blocks,glass-dark,tilted,laser-100-0.25-20,laser-100-2-8,laser-180-1-80,"
    "laser-180-0.1-30,laser-180-2-8,laser-240-0.35-4,laser-240-1-10,laser-360-2-6"
).split(",")


def report_on(links: list[Links], shortfall_alone: bool, numbers: EdgeNumbers) -> str:
    neighbours, revision = numbers.neighbours, numbers.revision
    of_lone, of_revised = ([2], [5]) if shortfall_alone else (range(len(neighbours)), range(len(revision)))
    lone = np.array([link for one in links for link in one.lone], float).reshape(-1, 3)
    stated = np.array([link for one in links for link in one.stated], float).reshape(-1, 2)
    revised = [link for one in links for link in one.revised]
    parts = []
    if len(lone):
        right = lone[:, 2] > 0
        found = fitted_neighbours(lone[:, 0], lone[:, 1], right, neighbours, of_lone)
        parts.append(f"{len(lone)} lone links, by their two scans:\n\n{calibration_table(lone[:, 0], right)}")
        parts.append(
            f"log odds: {found[0]:.2f} + {found[1]:.2f} of match_probability() {found[2]:+.1f} of the view shortfall "
            f"(in use: {neighbours[0]:g} + {neighbours[1]:g} {neighbours[2]:+g})"
        )
    if revised:
        weights = fitted_revision(revised, revision, of_revised)
        table = calibration_table(stated[:, 0], stated[:, 1] > 0)
        parts.append(f"{len(revised)} links in doubt, by all scans of both sides:\n\n{table}")
        rows = [
            f"  {weight:6.2f} ({used:g}) {term}"
            for weight, used, term in zip(weights, revision, REVISION_TERMS, strict=True)
        ]
        parts.append("\n".join(["weights (in use):", *rows]))
        likelihoods = [mean_log_likelihood(revised, w) for w in (weights, revision)]
        parts.append(f"mean log likelihood {likelihoods[0]:.4f} ({likelihoods[1]:.4f})")
    return "\n\n".join(parts)


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = parser_for_logs(__name__, __doc__, EXAMPLE)
    add = parser.add_argument
    add("--variants", type=name_list, default=name_list(VARIANTS), metavar="LIST", help="of logs, default %(default)s")
    add_seeds(parser, "", of="of simulated arenas, ")
    add_seeds(parser, "", option="--scene-seeds", of="of hard scenes, ")
    add("--shortfall-alone", action="store_true", help="fit what the view shortfall is worth, all else as in use")
    add_jobs(parser, "logs")
    add_mapper_arguments(parser)
    arguments = parser.parse_args(argv)
    if not (arguments.logs or arguments.only or arguments.seeds or arguments.scene_seeds):
        parser.error("no LOG, no --only, no --seeds and no --scene-seeds")
    return arguments


def called(function: Callable[..., Links], *words: Any) -> Links:
    return function(*words)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        wanted, num_missing = selected_variants(__name__, arguments)
    except (DatasetError, OSError) as error:
        complain(__name__, str(error))
        return 3
    mapper = mapper_from(arguments)
    try:
        numbers = EdgeNumbers.of(numbers_of(mapper.cli))
    except Failure as failure:
        complain(__name__, str(failure))
        return 1
    scenes = product(SCENES_WITH_LINKS, arguments.scene_seeds)
    calls: list[tuple[Any, ...]] = [(links_of_variant, log, mapper, numbers) for log in wanted]
    calls += [(links_of_arena, seed, mapper, numbers) for seed in arguments.seeds]
    calls += [(links_of_scene, name, seed, mapper, numbers) for name, seed in scenes]
    links = run_all(called, calls, arguments.jobs)
    print(report_on(links, arguments.shortfall_alone, numbers))
    faults = [one.fault for one in links if one.fault]
    for fault in faults:
        complain(__name__, fault)
    if arguments.json:
        found = [{"lone": one.lone, "stated": one.stated, "fault": one.fault} for one in links]
        write_json(arguments.json, found)
    return 1 if num_missing or faults else 0
