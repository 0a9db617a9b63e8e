# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges between consecutive keyframes whose truth is known: from variants of real logs, simulated arenas and scenes."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.common.files import write_whole
from evaluation.common.poses import Array, compose, inverse, pose_from
from evaluation.common.programs import Failure
from evaluation.judging.hard_scenes import SCENES
from evaluation.logs.variants import VariedLog
from evaluation.mapping.mapper import Mapper
from evaluation.simulation.arena_options import hard_arena
from evaluation.simulation.simulation import Simulation, simulate
from evaluation.simulation.write import nist_text

from .edge_fits import Candidates, EdgeNumbers, is_place, slides_to

ALL_STAY = ("--verify-below", "0", "--split-below", "0")


@dataclass(frozen=True)
class Links:
    """The links of one log: lone ones as `(stated, view shortfall, right)`, and revised ones with what was stated of
    the best."""

    lone: list[tuple[float, float, bool]] = field(default_factory=list)
    revised: list[Candidates] = field(default_factory=list)
    stated: list[tuple[float, bool]] = field(default_factory=list)
    fault: str = ""


def view_shortfalls(trace: Path) -> dict[tuple[int, int], float]:
    """The view shortfall by the positions of a link; one whose keyframes in between were let go is missing, and
    certain."""
    with trace.open(encoding="utf-8") as lines:
        records = [json.loads(line) for line in lines if line.startswith('{"record":"link"')]
    return {(record["reference"], record["query"]): float(record["view_shortfall"]) for record in records}


def lone_links(
    report: Mapping[str, Any], shortfall: Mapping[tuple[int, int], float], truth: Array, numbers: EdgeNumbers
) -> list[tuple[float, float, bool]]:
    links = []
    for position in report["scans"]:
        alignment = position["alignment"] or {}
        if not position["is_keyframe"] or position["loop_constrained"] or not alignment.get("ref_from_query"):
            continue
        step = compose(inverse(truth[alignment["reference"]]), truth[position["index"]])
        found = pose_from(alignment["ref_from_query"])
        lacking = shortfall.get((alignment["reference"], position["index"]), 0.0)
        links.append((float(alignment["probability"]), lacking, is_place(found, step, numbers)))
    return links


def true_step(revision: Mapping[str, Any], truth: Array) -> Array:
    return compose(inverse(truth[revision["reference"]]), truth[revision["query"]])


def best_is_right(revision: Mapping[str, Any], truth: Array, numbers: EdgeNumbers) -> bool:
    """Up to how far it may slide, which its probability allows for."""
    best, step = revision["hypotheses"][revision["alternative"]], true_step(revision, truth)
    pose = np.array(best["pose"])
    return is_place(pose, step, numbers) or slides_to(pose, np.array(best["covariance"]), step, numbers)


def candidates_of(
    revision: Mapping[str, Any], view_shortfall: float, truth: Array, numbers: EdgeNumbers
) -> Candidates:
    step = true_step(revision, truth)
    hypotheses = revision["hypotheses"]
    poses = np.array([hypothesis["pose"] for hypothesis in hypotheses])

    def column(name: str) -> Array:
        return np.array([float(hypothesis[name]) for hypothesis in hypotheses])

    right = np.array([is_place(pose, step, numbers) for pose in poses])
    covariances = np.array([hypothesis["covariance"] for hypothesis in hypotheses])
    deviations_m = np.sqrt(np.maximum(0.0, np.linalg.eigvalsh(covariances[:, :2, :2])[:, 0]))
    return Candidates(
        poses=poses,
        scores=column("score"),
        for_it=column("for_it"),
        against_it=column("against_it"),
        in_map=revision["in_map"],
        right=right,
        deviations_m=deviations_m,
        vouched=column("vouched"),
        numbers=numbers,
        view_shortfall=view_shortfall,
    )


def links_of(write: Callable[[Path], Path], truth: Array, mapper: Mapper, numbers: EdgeNumbers) -> Links:
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
        links = Links(lone_links(bare_report, shortfall, truth, numbers))
        for line in trace.open(encoding="utf-8"):
            if not line.startswith('{"record":"revision"'):
                continue
            revision = json.loads(line)
            lacking = shortfall.get((revision["reference"], revision["query"]), 0.0)
            links.revised.append(candidates_of(revision, lacking, truth, numbers))
            links.stated.append((float(revision["probability"]), best_is_right(revision, truth, numbers)))
        return links


def links_of_variant(log: VariedLog, mapper: Mapper, numbers: EdgeNumbers) -> Links:
    def write(folder: Path) -> Path:
        (folder / "log.log").write_text(log.text, encoding="utf-8")
        return folder / "log.log"

    return links_of(write, log.reference, mapper, numbers)


def links_of_arena(seed: int, mapper: Mapper, numbers: EdgeNumbers) -> Links:
    return links_of_simulation(simulate(hard_arena(seed)), mapper, numbers)


def links_of_scene(name: str, seed: int, mapper: Mapper, numbers: EdgeNumbers) -> Links:
    return links_of_simulation(SCENES[name].make(seed), mapper, numbers)


def links_of_simulation(simulation: Simulation, mapper: Mapper, numbers: EdgeNumbers) -> Links:
    def write(folder: Path) -> Path:
        write_whole(folder / "walk.nist", nist_text(simulation))
        return folder / "walk.nist"

    return links_of(write, simulation.drive.map_from_robot, mapper, numbers)
