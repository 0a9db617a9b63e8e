#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fit how probable a link between consecutive keyframes is: one that no loop holds by its two scans, and one in doubt
by all scans of both sides. Links come from variants of real logs, from simulated arenas and from hard scenes; how
probable the mapper says they are is held against the truth: on logs that nothing was fitted to, a test of it. What is
fitted belongs into probability_of_neighbours() and link_revision.cpp; what a parallel link says was made with the
weights in use, so that a fit of its weight is one step towards the best."""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from evaluate_arena import parse_seeds
from evaluation.datasets import DatasetError
from evaluation.link_fits import (
    NEIGHBOURS,
    REVISION,
    REVISION_TERMS,
    Candidates,
    calibration_table,
    fitted_neighbours,
    fitted_revision,
    is_place,
    mean_log_likelihood,
    slides_to,
)
from evaluation.mapping import Mapper
from evaluation.programs import Failure
from evaluation.selection import add_mapper_arguments, mapper_from, name_list, parser_for_logs, selected_logs
from evaluation.variants import VariantError, VariedLog, varied
from shapemap_sim.hard_scenes import SCENES
from shapemap_sim.pairs import pose_from
from shapemap_sim.poses import Array, compose, inverse
from shapemap_sim.robot import RobotOptions
from shapemap_sim.simulation import Simulation, SimulationOptions, simulate
from shapemap_sim.write import nist_text, write_whole
from simulate_arena import number

EXAMPLE = """example, what the weights were fitted to, and what they were tried on:
  scripts/fit_links.py --only orebro,belgioioso,aces,csail --seeds 0-79
  scripts/fit_links.py --scene-seeds 20-49 --shortfall-alone
  scripts/fit_links.py --only orebro,belgioioso,aces,csail --seeds 80-159 --scene-seeds 50-69 \\
    --variants drop-30-5,drop-30-6,drop-30-7,drop-20-2,drop-25-0,mirrored+every-2-0,reversed+drop-30-8

Exit status: 0 done, 1 some runs gave no map or a log is missing, 2 wrong usage, 3 malformed data sets or logs."""
VARIANTS = "drop-30-2,drop-30-3,drop-30-4,drop-20-0,drop-20-1,drop-40-0,every-2-0+reversed,every-2-1+reversed"
SCENES_WITH_LINKS = (  # right or wrong, and not hidden by people
    "twin-rooms,half-random,half-blocks,glass-dark,tilted,laser-100-0.25-20,laser-100-2-8,laser-180-1-80,"
    "laser-180-0.1-30,laser-180-2-8,laser-240-0.35-4,laser-240-1-10,laser-360-2-6"
).split(",")
ALL_STAY = ("--revise-below", "0", "--split-below", "0")


@dataclass(frozen=True)
class Links:
    """Of one log. Lone ones as `(stated, view shortfall, right)`, revised ones with what was stated of the best."""

    lone: list[tuple[float, float, bool]] = field(default_factory=list)
    revised: list[Candidates] = field(default_factory=list)
    stated: list[tuple[float, bool]] = field(default_factory=list)
    fault: str = ""


def view_shortfalls(trace: Path) -> dict[tuple[int, int], float]:
    """By the positions of a link; one whose keyframes in between were let go is missing, and certain."""
    with trace.open(encoding="utf-8") as lines:
        records = [json.loads(line) for line in lines if line.startswith('{"record":"link"')]
    return {(record["reference"], record["query"]): float(record["view_shortfall"]) for record in records}


def lone_links(
    report: Mapping[str, Any], shortfall: Mapping[tuple[int, int], float], truth: Array
) -> list[tuple[float, float, bool]]:
    links = []
    for position in report["positions"]:
        alignment = position["alignment"] or {}
        if not position["is_keyframe"] or position["held_by_loops"] or not alignment.get("ref_from_query"):
            continue
        step = compose(inverse(truth[alignment["reference"]]), truth[position["index"]])
        found = pose_from(alignment["ref_from_query"])
        lacking = shortfall.get((alignment["reference"], position["index"]), 0.0)
        links.append((float(alignment["probability"]), lacking, is_place(found, step)))
    return links


def true_step(revision: Mapping[str, Any], truth: Array) -> Array:
    return compose(inverse(truth[revision["reference"]]), truth[revision["query"]])


def best_is_right(revision: Mapping[str, Any], truth: Array) -> bool:
    """Up to how far it may slide, which its probability allows for."""
    best, step = revision["hypotheses"][revision["alternative"]], true_step(revision, truth)
    pose = np.array(best["pose"])
    return is_place(pose, step) or slides_to(pose, np.array(best["covariance"]), step)


def candidates_of(revision: Mapping[str, Any], view_shortfall: float, truth: Array) -> Candidates:
    step = true_step(revision, truth)
    hypotheses = revision["hypotheses"]
    poses = np.array([hypothesis["pose"] for hypothesis in hypotheses])

    def column(name: str) -> Array:
        return np.array([float(hypothesis[name]) for hypothesis in hypotheses])

    right = np.array([is_place(pose, step) for pose in poses])
    covariances = np.array([hypothesis["covariance"] for hypothesis in hypotheses])
    deviations_m = np.sqrt(np.maximum(0.0, np.linalg.eigvalsh(covariances[:, :2, :2])[:, 0]))
    said = column("for_it"), column("against_it")
    of_them = revision["in_map"], right, deviations_m, column("vouched")
    return Candidates(poses, column("score"), *said, *of_them, view_shortfall)


def links_of(write: Callable[[Path], Path], truth: Array, mapper: Mapper) -> Links:
    """`write` puts the log into a folder."""
    with tempfile.TemporaryDirectory(prefix="links_") as name:
        folder = Path(name)
        log, trace = write(folder), folder / "trace.jsonl"
        bare = Mapper(mapper.cli, (*mapper.arguments, *ALL_STAY), mapper.timeout_s)
        whole = Mapper(mapper.cli, (*mapper.arguments, "--trace", str(trace)), mapper.timeout_s)
        try:
            bare_report = bare.run([log], folder)[0]
            whole.run([log], folder)
        except Failure as failure:
            return Links(fault=str(failure))
        shortfall = view_shortfalls(trace)
        links = Links(lone_links(bare_report, shortfall, truth))
        for line in trace.open(encoding="utf-8"):
            if not line.startswith('{"record":"revision"'):
                continue
            revision = json.loads(line)
            lacking = shortfall.get((revision["reference"], revision["query"]), 0.0)
            links.revised.append(candidates_of(revision, lacking, truth))
            links.stated.append((float(revision["probability"]), best_is_right(revision, truth)))
        return links


def links_of_variant(log: VariedLog, mapper: Mapper) -> Links:
    def write(folder: Path) -> Path:
        (folder / "log.log").write_text(log.text, encoding="utf-8")
        return folder / "log.log"

    return links_of(write, log.reference, mapper)


def links_of_arena(seed: int, mapper: Mapper) -> Links:
    """16 positions, 1.5 m apart, unknown headings."""
    robot = RobotOptions(num_positions=16, spacing_m=1.5, heading_uncertainty_deg=180.0)
    return links_of_simulation(simulate(SimulationOptions(seed=seed, robot=robot)), mapper)


def links_of_scene(name: str, seed: int, mapper: Mapper) -> Links:
    return links_of_simulation(SCENES[name].make(seed), mapper)


def links_of_simulation(simulation: Simulation, mapper: Mapper) -> Links:
    def write(folder: Path) -> Path:
        write_whole(folder / "walk.nist", nist_text(simulation))
        return folder / "walk.nist"

    return links_of(write, simulation.drive.map_from_robot, mapper)


def report_on(links: list[Links], shortfall_alone: bool) -> str:
    of_lone, of_revised = ([2], [5]) if shortfall_alone else (range(len(NEIGHBOURS)), range(len(REVISION)))
    lone = np.array([link for one in links for link in one.lone], float).reshape(-1, 3)
    stated = np.array([link for one in links for link in one.stated], float).reshape(-1, 2)
    revised = [link for one in links for link in one.revised]
    parts = []
    if len(lone):
        right = lone[:, 2] > 0
        found = fitted_neighbours(lone[:, 0], lone[:, 1], right, of_lone)
        parts.append(f"{len(lone)} lone links, by their two scans:\n\n{calibration_table(lone[:, 0], right)}")
        parts.append(
            f"log odds: {found[0]:.2f} + {found[1]:.2f} of match_probability() {found[2]:+.1f} of the view shortfall "
            f"(in use: {NEIGHBOURS[0]:g} + {NEIGHBOURS[1]:g} {NEIGHBOURS[2]:+g})"
        )
    if revised:
        weights = fitted_revision(revised, of_revised)
        table = calibration_table(stated[:, 0], stated[:, 1] > 0)
        parts.append(f"{len(revised)} links in doubt, by all scans of both sides:\n\n{table}")
        rows = [
            f"  {weight:6.2f} ({used:g}) {term}"
            for weight, used, term in zip(weights, REVISION, REVISION_TERMS, strict=True)
        ]
        parts.append("\n".join(["weights (in use):", *rows]))
        likelihoods = [mean_log_likelihood(revised, w) for w in (weights, REVISION)]
        parts.append(f"mean log likelihood {likelihoods[0]:.4f} ({likelihoods[1]:.4f})")
    return "\n\n".join(parts)


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = parser_for_logs(__doc__, EXAMPLE)
    add = parser.add_argument
    add("--variants", type=name_list, default=name_list(VARIANTS), metavar="LIST", help="of logs, default %(default)s")
    add("--seeds", type=parse_seeds, default=[], metavar="LIST", help="of simulated arenas, such as 0-79")
    add("--scene-seeds", type=parse_seeds, default=[], metavar="LIST", help="of hard scenes, such as 20-49")
    add("--shortfall-alone", action="store_true", help="fit what the view shortfall is worth, all else as in use")
    add("--jobs", type=number(1, 256, int), default=2, metavar="N", help="logs at the same time (default 2)")
    add_mapper_arguments(parser)
    arguments = parser.parse_args(argv)
    if not (arguments.logs or arguments.only or arguments.seeds or arguments.scene_seeds):
        parser.error("no LOG, no --only, no --seeds and no --scene-seeds")
    return arguments


def complain(text: str) -> None:
    print(f"fit_links.py: {text}", file=sys.stderr)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        logs, num_missing = selected_logs(arguments, complain)
        wanted = [varied(log, variant) for log in logs for variant in arguments.variants]
    except (DatasetError, VariantError, OSError) as error:
        complain(str(error))
        return 3
    mapper = mapper_from(arguments)
    with ProcessPoolExecutor(max_workers=arguments.jobs) as pool:
        futures = [pool.submit(links_of_variant, log, mapper) for log in wanted]
        futures += [pool.submit(links_of_arena, seed, mapper) for seed in arguments.seeds]
        for name in SCENES_WITH_LINKS:
            futures += [pool.submit(links_of_scene, name, seed, mapper) for seed in arguments.scene_seeds]
        links = [future.result() for future in futures]
    print(report_on(links, arguments.shortfall_alone))
    faults = [one.fault for one in links if one.fault]
    for fault in faults:
        complain(fault)
    if arguments.json:
        found = [{"lone": one.lone, "stated": one.stated, "fault": one.fault} for one in links]
        write_whole(arguments.json, json.dumps(found, indent=1) + "\n")
    return 1 if num_missing or faults else 0


if __name__ == "__main__":
    sys.exit(main())
