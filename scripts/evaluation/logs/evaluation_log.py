# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs as the judge sees them, with all that is known of them, and as the programs get them: readings only.

The programs get a log without any pose or odometry, whose timestamps are 1, 2, 3 ... s: some logs have one time for
all scans, and what a program places is told apart by its time.
"""

from __future__ import annotations

import argparse
import hashlib
import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from evaluation.common.files import write_whole
from evaluation.common.poses import Array
from evaluation.common.programs import Failure, run_quietly
from evaluation.common.tum import parse_tum
from evaluation.simulation.arena_options import add_arena_arguments, options_from
from evaluation.simulation.simulation import simulate
from evaluation.simulation.write import nist_text
from log_conversion.model import UnknownLogError
from log_conversion.number_lines import PoseLineOptions
from log_conversion.reading import ReadOptions, read_log
from log_conversion.text_format import text_of

from .datasets import WITH_POSES, DatasetError, LogSpec
from .reference_log import ReferenceLog, read_reference_log
from .relations import RelationFile, ScanIndex, read_relations

# What scripts/convert_logs.py reads.
RECORDINGS = (".bag", ".bag.gz", ".db3", ".mcap", ".csv", ".csv.gz", ".dat.gz", ".txt.gz", ".dat")


@dataclass(frozen=True)
class EvaluationLog:
    """`reference` are the poses `[p, 3]` to judge by, or None. `sha256` is that of the readings and the references."""

    spec: LogSpec
    content: ReferenceLog = field(repr=False)
    reference: Array | None
    relations: list[RelationFile]
    sha256: str

    def __len__(self) -> int:
        return len(self.content)

    @property
    def name(self) -> str:
        return self.spec.name

    def write_stripped(self, folder: Path) -> Path:
        """The log for the programs."""
        path = folder / f"log{self.content.ending}"
        path.write_text(self.content.without_poses, encoding="utf-8")
        return path


def load(spec: LogSpec, folder: Path, cli: Path) -> EvaluationLog:
    """Reads or makes a log; what is made is kept in `folder`. Raises DatasetError (with file and line where there is
    one) or OSError."""
    path = source_file(spec, folder, cli)
    try:
        whole = read_reference_log(path, needs_poses=spec.reference in WITH_POSES and not spec.reference_file)
    except (ValueError, IndexError, KeyError) as error:
        text = str(error)
        raise DatasetError(text if str(path.name) in text else f"{path}: {text}") from None
    times, text = renumbered(whole.without_poses, spec.every, spec.first)
    if spec.reference_file:
        whole = replace(whole, map_from_robot=read_reference_file(spec.reference_file, times))
    kept = slice(None, spec.first * spec.every if spec.first else None, spec.every)
    content = replace(
        whole,
        name=spec.name,
        without_poses=text,
        map_from_robot=whole.map_from_robot[kept],
        points=whole.points[kept],
    )
    index = ScanIndex(times, spec.every, len(content))
    relations = [read_relations(other, index) for other in spec.relations]
    reference = content.map_from_robot if spec.reference in WITH_POSES else None
    return EvaluationLog(spec, content, reference, relations, checksum(text, reference, relations))


def read_reference_file(path: Path, times: list[float]) -> Array:
    """Poses `[p, 3]` of all scans of the whole log, from TUM lines with its times. Raises DatasetError that names file
    and line, or the first scan without a pose."""
    index = ScanIndex(times, 1, len(times))
    poses = np.full((len(times), 3), np.nan)
    for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        try:
            ((time_s, pose),) = parse_tum(line).items()
        except ValueError:
            raise DatasetError(f"{path}:{number}: expected t x y z qx qy qz qw, found '{line.strip()}'") from None
        if not np.isfinite(pose).all():
            raise DatasetError(f"{path}:{number}: not finite: {line.strip()}")
        if (scan := index.scan_at(time_s)) is not None:
            poses[scan] = pose
    without = np.flatnonzero(np.isnan(poses[:, 0]))
    if len(without):
        raise DatasetError(
            f"{path}: no pose for {len(without)} scans; the first is {without[0]}, {times[without[0]]} s"
        )
    return poses


def checksum(text: str, reference: Array | None, relations: list[RelationFile]) -> str:
    """The checksum of all that results depend on: two runs are on the same data when these are the same."""
    digest = hashlib.sha256(text.encode())
    digest.update(b"" if reference is None else reference.tobytes())
    for file in relations:
        digest.update(repr([(r.first, r.second, r.first_from_second) for r in file.relations]).encode())
    return digest.hexdigest()


def renumbered(text: str, every: int = 1, first: int = 0) -> tuple[list[float], str]:
    """The times of all scans or positions, and the log of those that are used with 1, 2, 3 ... instead. What a scan
    says of the times of its beams keeps its share of the usual time between scans."""
    times: list[float] = []
    lines: list[str] = []
    num_used, used = 0, True
    for original in text.splitlines():
        line, words = original, original.split()
        if words and words[0] in _TIME_FIELDS:
            at = _TIME_FIELDS[words[0]](words)
            used = len(times) % every == 0 and (not first or num_used < first)
            times.append(float(words[at]) if at < len(words) else float(len(times)))
            if used:
                num_used += 1
                words[at:] = [f"{num_used}.0", *(["host", f"{num_used}.0"] if words[0] == "FLASER" else [])]
                line = " ".join(words)
        if used or not (words and words[0] in (*_TIME_FIELDS, "scan")):
            lines.append(line)
    steps = np.diff(np.asarray(times))
    usual_s = float(np.median(steps[steps > 0.0])) * every if (steps > 0.0).any() else 1.0
    return times, "\n".join(with_beam_times(line, usual_s) for line in lines) + "\n"


def with_beam_times(line: str, seconds: float) -> str:
    """A line of our text format with the times of beams in units of `seconds`."""
    if not line.startswith(("sensor ", "scan ")):
        return line
    return _BEAM_TIMES.sub(lambda found: f"{found[1]} {float(found[2]) / seconds:.9g}", line)


_BEAM_TIMES = re.compile(r"\b(time|time_step) ([-+.0-9eE]+)")
_TIME_FIELDS: dict[str, Callable[[list[str]], int]] = {
    "FLASER": lambda words: 2 + int(words[1]) + 6,
    "position": lambda words: 1,
}


def source_file(spec: LogSpec, folder: Path, cli: Path) -> Path:
    """A CARMEN or shapemap-scans log: the file itself, or one that is made from it or simulated."""
    if spec.path is not None and not is_foreign(spec.path):
        return spec.path
    made = folder / f"{spec.name}.nist"
    made.parent.mkdir(parents=True, exist_ok=True)
    if spec.path is None:
        simulate_log(spec, made)
    elif spec.path.name.endswith(".rawlog"):
        convert_rawlog(spec.path, made, cli)
    else:
        convert_recording(spec.path, spec.angle_step_deg, made)
    return made


def is_foreign(path: Path) -> bool:
    return path.name.endswith((".rawlog", *RECORDINGS))


def simulate_log(spec: LogSpec, made: Path) -> None:
    parser = argparse.ArgumentParser()
    add_arena_arguments(parser)
    words = [word for key, value in spec.arena.items() for word in (f"--{key.replace('_', '-')}", str(value))]
    try:
        simulation = simulate(options_from(parser.parse_args(words), spec.seed or 0))
    except ValueError as error:
        raise DatasetError(f"{spec.name}: {error}") from None
    write_whole(made, nist_text(simulation))


def convert_recording(path: Path, angle_step_deg: float | None, made: Path) -> None:
    try:
        log = read_log(path, ReadOptions(pose_lines=PoseLineOptions(angle_step_deg)))
    except UnknownLogError as error:
        raise DatasetError(str(error)) from None
    write_whole(made, text_of(replace(log, references=None), path.name))


def convert_rawlog(path: Path, made: Path, cli: Path) -> None:
    part = made.with_name(f".{made.name}")
    try:
        run_quietly([cli, "convert", path, part, "--to", "nist", "--force"], done=(0,))
    except Failure as failure:
        raise DatasetError(f"{path}: cannot be converted: {failure}") from None
    part.replace(made)
