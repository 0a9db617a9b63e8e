#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Map scenes that are hard for any mapper, and check what is to be expected of it in each."""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from evaluate_arena import parse_seeds, run_mapper
from shapemap_sim.hard_scenes import SCENES, Scene
from shapemap_sim.outcomes import PairOutcome, pair_outcomes
from shapemap_sim.simulation import Simulation
from shapemap_sim.write import nist_text
from simulate_arena import number, some_of

ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = """example:
  scripts/hard_cases.py --pictures docs/pictures
  scripts/hard_cases.py --scenes corridor-360,crowd --seeds 0-9 --logs results/hard

Exit status: 0 every scene is as stated, 1 some are not (or gave no map), 2 wrong usage."""


@dataclass(frozen=True)
class SceneResult:
    """One scene with one seed. `broken`: where it is not as stated."""

    scene: str
    seed: int
    outcomes: list[PairOutcome]
    broken: list[str]


def map_scene(simulation: Simulation, title: str, cli: Path, folder: Path) -> list[PairOutcome]:
    """Writes the log, maps it and reads the outcome. Raises RuntimeError when there is no map."""
    (folder / "scene.nist").write_text(nist_text(simulation, title), encoding="utf-8")
    command = [str(cli), "--nist", str(folder / "scene.nist"), "--out", str(folder / "map.png"), "--quiet", "--force"]
    command += ["--trajectory", str(folder / "path.tum"), "--report", str(folder / "report.json")]
    report, fault = run_mapper(command, folder / "report.json", timeout_s=120.0)
    if report is None:
        raise RuntimeError(fault)
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
        except RuntimeError as error:
            return SceneResult(name, seed, [], [f"no map: {error}"])
    return SceneResult(name, seed, outcomes, scene.check(outcomes))


def save_pictures(folder: Path, results: list[SceneResult]) -> None:
    """A picture of each scene, and one of all lasers together."""
    from shapemap_sim.scene_picture import Panel, save_panels, save_scene  # matplotlib only when pictures are asked for

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


def row(scene: Scene, results: list[SceneResult]) -> str:
    """A line of the table: all seeds of a scene together."""
    pairs = [pair for result in results for pair in result.outcomes]
    if not pairs:
        return f"| {scene.name} | 0 | - | - | - | - | - | no map |"
    right, ok = sum(p.right for p in pairs), sum(p.called_ok for p in pairs)
    false = sum(p.falsely_certain for p in pairs)
    other = sorted({p.status for p in pairs} - {"ok"})
    broken = sum(bool(result.broken) for result in results)
    verdict = "as stated" if not broken else f"not as stated with {broken} of {len(results)} seeds"
    counts = ", ".join(f"{sum(p.status == name for p in pairs)} {name}" for name in other) or "-"
    overlap = sum(p.overlap for p in pairs) / len(pairs)
    return (
        f"| {scene.name} | {len(pairs)} | {overlap:.2f} | {right} ({100 * right / len(pairs):.0f} %) | {ok} | {counts} "
        f"| {false} | {verdict} |"
    )


def markdown(results: list[SceneResult]) -> str:
    lines = [
        "| scene | pairs | overlap | right | called ok | called otherwise | wrong but sure | verdict |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for name, scene in SCENES.items():
        own = [result for result in results if result.scene == name]
        if own:
            lines.append(row(scene, own))
    return "\n".join(lines)


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


def as_json(results: list[SceneResult]) -> str:
    rows = [
        {"scene": r.scene, "seed": r.seed, "broken": r.broken, "pairs": [pair_dict(p) for p in r.outcomes]}
        for r in results
    ]
    return json.dumps(rows, indent=1) + "\n"


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--scenes",
        type=some_of(SCENES, at_least=1),
        default=list(SCENES),
        metavar="LIST",
        help="names of scenes (default all)",
    )
    parser.add_argument("--seeds", type=parse_seeds, default=[0], metavar="LIST", help="such as 0-9 (default 0)")
    parser.add_argument(
        "--cli",
        type=Path,
        default=ROOT / "build/release/bin/shapemap-cli",
        metavar="FILE",
        help="the mapper (default build/release/bin/shapemap-cli)",
    )
    parser.add_argument("--jobs", type=number(1, 256, int), default=2, metavar="N", help="scenes at the same time")
    parser.add_argument("--logs", type=Path, metavar="DIR", help="keep log, map, trajectory and report of each run")
    parser.add_argument("--pictures", type=Path, metavar="DIR", help="a picture of each scene, with the first seed")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every pair")
    arguments = parser.parse_args(argv)
    if not os.access(arguments.cli, os.X_OK):
        parser.error(f"--cli: {arguments.cli} is not a program; build it with `cmake --build --preset release`")
    return arguments


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    with ProcessPoolExecutor(max_workers=arguments.jobs) as pool:
        futures = [
            pool.submit(run_scene, name, seed, arguments.cli, arguments.logs)
            for name in arguments.scenes
            for seed in arguments.seeds
        ]
        results = [future.result() for future in futures]
    print(markdown(results))
    for result in results:
        for line in result.broken:
            print(f"{result.scene}, seed {result.seed}: {line}")
    if arguments.pictures:
        save_pictures(arguments.pictures, [result for result in results if result.seed == arguments.seeds[0]])
    if arguments.json:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
        arguments.json.write_text(as_json(results), encoding="utf-8")
    return 1 if any(result.broken for result in results) else 0


if __name__ == "__main__":
    sys.exit(main())
