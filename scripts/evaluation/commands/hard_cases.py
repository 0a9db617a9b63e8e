# SPDX-License-Identifier: GPL-3.0-or-later
"""Map scenes that are hard for any mapper, and check what is to be expected of it in each."""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.common.argument_types import some_of
from evaluation.common.command_line import add_jobs, add_json, add_program, add_seeds, command_parser, require_program
from evaluation.common.files import write_json
from evaluation.common.parallel import run_all
from evaluation.common.programs import Failure
from evaluation.common.tables import table
from evaluation.judging.hard_scenes import SCENES, Scene
from evaluation.judging.scene_outcomes import PairOutcome, pair_outcomes
from evaluation.mapping.mapper import Mapper
from evaluation.simulation.simulation import Simulation
from evaluation.simulation.write import nist_text

EXAMPLE = """example:
  scripts/evaluate.py hard-cases --pictures docs/pictures
  scripts/evaluate.py hard-cases --scenes corridor-360,crowd --seeds 0-9 --logs results/hard

Exit status: 0 every scene is as stated, 1 some are not (or gave no map), 2 wrong usage."""
HEAD = ("scene", "pairs", "overlap", "right", "called ok", "called otherwise", "wrong but sure", "verdict")


@dataclass(frozen=True)
class SceneResult:
    """One scene with one seed. `broken`: where it is not as stated."""

    scene: str
    seed: int
    outcomes: list[PairOutcome]
    broken: list[str]


def map_scene(simulation: Simulation, title: str, cli: Path, folder: Path) -> list[PairOutcome]:
    """Writes the log, maps it and reads the outcome. Raises Failure when there is no map."""
    (folder / "scene.nist").write_text(nist_text(simulation, title), encoding="utf-8")
    trajectory = ["--trajectory", folder / "path.tum"]
    report, _ = Mapper(cli, timeout_s=120.0).run([folder / "scene.nist"], folder, more=trajectory)
    return pair_outcomes(simulation, report, (folder / "path.tum").read_text(encoding="utf-8"))


def run_scene(name: str, seed: int, cli: Path, logs: Path | None = None) -> SceneResult:
    """Simulate, map and check. `logs` keeps the files of the run."""
    scene = SCENES[name]
    simulation = scene.make(seed)
    with tempfile.TemporaryDirectory(prefix=f"{name}_") as temporary:
        folder = Path(temporary) if logs is None else logs / f"{name}_{seed}"
        folder.mkdir(parents=True, exist_ok=True)
        try:
            outcomes = map_scene(simulation, scene.title, cli, folder)
        except Failure as failure:
            return SceneResult(name, seed, [], [f"no map: {failure}"])
    return SceneResult(name, seed, outcomes, scene.check(outcomes))


def save_pictures(folder: Path, results: list[SceneResult]) -> None:
    """A picture of each scene, and one of all lasers together."""
    from evaluation.judging.scene_picture import (  # matplotlib only when pictures are asked for
        Panel,
        save_panels,
        save_scene,
    )

    lasers = []
    for result in results:
        scene = SCENES[result.scene]
        if not result.outcomes:
            continue
        if scene.name.startswith("laser-"):
            lasers.append(Panel(scene.title.replace(", turns", ",\nturns"), scene.make(result.seed), result.outcomes))
        else:
            path = folder / f"hard_{scene.name.replace('-', '_')}.png"
            save_scene(path, scene.title, scene.make(result.seed), result.outcomes)
    if lasers:
        save_panels(folder / "hard_lasers.png", lasers)


def row(scene: Scene, results: list[SceneResult]) -> list[object]:
    """A row of the table: all seeds of a scene together."""
    pairs = [pair for result in results for pair in result.outcomes]
    if not pairs:
        return [scene.name, 0, *["-"] * 5, "no map"]
    right, ok = sum(p.right for p in pairs), sum(p.called_ok for p in pairs)
    false = sum(p.falsely_certain for p in pairs)
    other = sorted({p.status for p in pairs} - {"ok"})
    broken = sum(bool(result.broken) for result in results)
    verdict = "as stated" if not broken else f"not as stated with {broken} of {len(results)} seeds"
    counts = ", ".join(f"{sum(p.status == name for p in pairs)} {name}" for name in other) or "-"
    overlap = sum(p.overlap for p in pairs) / len(pairs)
    share = f"{right} ({100 * right / len(pairs):.0f} %)"
    return [scene.name, len(pairs), f"{overlap:.2f}", share, ok, counts, false, verdict]


def markdown(results: list[SceneResult]) -> str:
    """A table with a row for each scene that was tried."""
    of_scene = {name: [result for result in results if result.scene == name] for name in SCENES}
    return table(HEAD, [row(SCENES[name], own) for name, own in of_scene.items() if own])


def pair_dict(pair: PairOutcome) -> dict[str, Any]:
    return {
        "index": pair.index,
        "overlap": pair.overlap,
        "status": pair.status,
        "reason": pair.reason,
        "probability": pair.probability if np.isfinite(pair.probability) else None,
        "right": pair.right,
        "error": [float(e) for e in pair.error] if np.isfinite(pair.error_m) else None,
        "covariance": None if pair.covariance is None else pair.covariance.tolist(),
    }


def result_dict(result: SceneResult) -> dict[str, Any]:
    pairs = [pair_dict(pair) for pair in result.outcomes]
    return {"scene": result.scene, "seed": result.seed, "broken": result.broken, "pairs": pairs}


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    parser.add_argument(
        "--scenes",
        type=some_of(SCENES, at_least=1),
        default=list(SCENES),
        metavar="LIST",
        help="names of scenes (default all)",
    )
    add_seeds(parser, "0")
    add_program(parser)
    add_jobs(parser, "scenes")
    parser.add_argument("--logs", type=Path, metavar="DIR", help="keep log, map, trajectory and report of each run")
    parser.add_argument("--pictures", type=Path, metavar="DIR", help="a picture of each scene, with the first seed")
    add_json(parser, "every pair")
    arguments = parser.parse_args(argv)
    require_program(parser, arguments)
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    wanted = product(arguments.scenes, arguments.seeds)
    calls = [(name, seed, arguments.cli, arguments.logs) for name, seed in wanted]
    results = run_all(run_scene, calls, arguments.jobs)
    print(markdown(results))
    for result in results:
        for line in result.broken:
            print(f"{result.scene}, seed {result.seed}: {line}")
    if arguments.pictures:
        save_pictures(arguments.pictures, [result for result in results if result.seed == arguments.seeds[0]])
    if arguments.json:
        write_json(arguments.json, [result_dict(result) for result in results])
    return 1 if any(result.broken for result in results) else 0
