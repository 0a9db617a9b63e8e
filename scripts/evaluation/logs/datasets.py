# SPDX-License-Identifier: GPL-3.0-or-later
"""What there is to evaluate on: the file of data sets, and the logs that are at hand."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from evaluation.common.argument_types import parse_seeds
from evaluation.common.project import PROJECT

MRPT_SAMPLES = Path("/usr/share/mrpt/datasets")
REFERENCES = {
    "exact": "exact poses (simulated)",
    "slam": "poses of a SLAM program that had odometry, good to 5 to 10 cm",
    "relations": "relations made by hand, no poses",
    "none": "none: maps and timing only",
}
WITH_POSES = ("exact", "slam")
ROOTS = ("datasets", "project", "mrpt")
ARENA_OPTIONS = ("positions", "spacing_m", "heading_uncertainty_deg", "clutter")
KEYS = (
    *(
        "name",
        "path",
        "root",
        "simulate",
        "seeds",
        "sensor",
        "reference",
        "reference_file",
        "relations",
        "keeps_heading",
    ),
    *("angle_step_deg", "every", "first", "baselines", *ARENA_OPTIONS),
)


class DatasetError(ValueError):
    """A file of data sets, a log or a file of references that is not what it should be; names the file and the line."""


@dataclass(frozen=True)
class LogSpec:
    """One log. `group` is its data set: the same name, but for the many arenas of one."""

    name: str
    group: str
    sensor: str
    reference: str
    path: Path | None = None
    seed: int | None = None
    reference_file: Path | None = None
    relations: tuple[Path, ...] = ()
    keeps_heading: bool = False
    angle_step_deg: float | None = None
    every: int = 1
    first: int = 0
    baselines: bool = True
    arena: dict[str, float] = field(default_factory=dict)

    @property
    def files(self) -> list[Path]:
        """All that must be there."""
        return [*(path for path in (self.path, self.reference_file) if path), *self.relations]

    @property
    def missing(self) -> list[Path]:
        return [path for path in self.files if not path.exists()]


def relations_beside(path: Path) -> tuple[Path, ...]:
    """FILE.relations and FILE.scan_relations, where they exist."""
    stem = path.name.split(".")[0]
    return tuple(p for kind in ("relations", "scan_relations") if (p := path.with_name(f"{stem}.{kind}")).exists())


def _folder(root: str, datasets: Path | None) -> Path:
    known = {"project": PROJECT, "mrpt": MRPT_SAMPLES}
    return known.get(root) or datasets or Path("SHAPEMAP_DATASETS-is-not-set")


def _check(entry: dict[str, Any], where: str) -> None:
    unknown = sorted(set(entry) - set(KEYS))
    if unknown:
        raise DatasetError(f"{where}: unknown {', '.join(unknown)}; expected some of {', '.join(KEYS)}")
    for key in ("name", "sensor", "reference"):
        if not isinstance(entry.get(key), str):
            raise DatasetError(f"{where}: no {key}")
    if entry["reference"] not in REFERENCES:
        raise DatasetError(f"{where}: reference '{entry['reference']}', expected one of {', '.join(REFERENCES)}")
    if entry.get("root", "datasets") not in ROOTS:
        raise DatasetError(f"{where}: root '{entry['root']}', expected one of {', '.join(ROOTS)}")
    if ("path" in entry) == ("simulate" in entry):
        raise DatasetError(f"{where}: expected either path or simulate")
    if "reference_file" in entry and entry["reference"] not in WITH_POSES:
        raise DatasetError(f"{where}: a reference_file, but reference is '{entry['reference']}'")
    if entry.get("simulate", "arena") != "arena":
        raise DatasetError(f"{where}: simulate '{entry['simulate']}', expected arena")


def _expand(entry: dict[str, Any], datasets: Path | None, seeds: list[int] | None) -> list[LogSpec]:
    common: dict[str, Any] = {key: entry[key] for key in ("sensor", "reference")}
    optional = ("keeps_heading", "angle_step_deg", "every", "first", "baselines")
    common |= {key: entry[key] for key in optional if key in entry}
    name = entry["name"]
    if "simulate" in entry:
        arena = {key: entry[key] for key in ARENA_OPTIONS if key in entry}
        chosen = parse_seeds(str(entry.get("seeds", "0-19"))) if seeds is None else seeds
        return [LogSpec(f"{name}-{seed:03d}", name, seed=seed, arena=arena, **common) for seed in chosen]
    folder = _folder(entry.get("root", "datasets"), datasets)
    path = folder / entry["path"]
    relations = (
        tuple(folder / other for other in entry["relations"]) if "relations" in entry else relations_beside(path)
    )
    poses = folder / entry["reference_file"] if "reference_file" in entry else None
    return [LogSpec(name, name, path=path, reference_file=poses, relations=relations, **common)]


def read_datasets(path: Path, datasets: Path | None, seeds: list[int] | None = None) -> list[LogSpec]:
    """All logs that the file declares, also those that are missing. `datasets` is the folder of the real logs, `seeds`
    replaces those of the arenas. Raises DatasetError or OSError."""
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise DatasetError(f"{path}: {error}") from None
    specs: list[LogSpec] = []
    for count, entry in enumerate(content.get("dataset", []), 1):
        _check(entry, f"{path}: data set {count} ({entry.get('name', 'without a name')})")
        specs += _expand(entry, datasets, seeds)
    names = [spec.name for spec in specs]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice or not names:
        raise DatasetError(f"{path}: " + (f"twice: {', '.join(twice)}" if twice else "no data set"))
    return specs


def select(specs: Sequence[LogSpec], only: Sequence[str]) -> list[LogSpec]:
    """Those whose name or data set is asked for; all without. Raises DatasetError for a name that there is not."""
    known = {spec.name for spec in specs} | {spec.group for spec in specs}
    unknown = [name for name in only if name not in known]
    if unknown:
        raise DatasetError(f"no data set {', '.join(unknown)}; there are {', '.join(sorted({s.group for s in specs}))}")
    return [spec for spec in specs if not only or spec.name in only or spec.group in only]
