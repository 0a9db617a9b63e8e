# SPDX-License-Identifier: GPL-3.0-or-later
"""Other logs that a real one could have been: with some scans only, in the reverse order, or in a mirror."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from evaluation.common.poses import Array
from evaluation.simulation.streams import stream

from .datasets import DatasetError
from .evaluation_log import EvaluationLog

KINDS = """every-K-O  each K-th scan, from scan O on
  drop-P-S   without P % of the scans, drawn with seed S
  reversed   the last scan first
  mirrored   left and right changed
  whole      as it is"""
PATTERN = re.compile(r"whole|reversed|mirrored|every-[1-9]\d*-\d+|drop-\d{1,2}-\d+")


class VariantError(DatasetError):
    """A variant that is none, or a log that cannot have it."""


@dataclass(frozen=True)
class VariedLog:
    """`text` is the log for the program, without poses; `reference` `[p, 3]` are the poses of its scans."""

    name: str
    text: str
    reference: Array


def parse_variant(text: str) -> str:
    """Some of KINDS, joined by `+`, which are done one after the other. Raises VariantError."""
    for part in text.split("+"):
        if not PATTERN.fullmatch(part):
            raise VariantError(f"variant '{part}', expected one of:\n  {KINDS}")
    return text


def varied(log: EvaluationLog, variant: str) -> VariedLog:
    """A variant of a CARMEN log with reference poses; its scans get the times 1, 2, 3 ... s. Raises VariantError."""
    if log.reference is None or log.content.ending != ".log":
        raise VariantError(f"{log.name}: variants need a CARMEN log with reference poses")
    lines = log.content.without_poses.splitlines()
    heads = [line for line in lines if not line.startswith("FLASER")]
    scans = [line.split() for line in lines if line.startswith("FLASER")]
    kept, is_mirrored = np.arange(len(scans)), False
    for part in parse_variant(variant).split("+"):
        if part == "mirrored":
            is_mirrored = not is_mirrored
        else:
            kept = kept[_kept(part, len(kept))]
    poses = log.reference[kept]
    if is_mirrored:
        poses = poses * np.array([1.0, -1.0, -1.0])
    texts = [_flaser(scans[k], is_mirrored, number) for number, k in enumerate(kept, 1)]
    return VariedLog(f"{log.name} {variant}", "\n".join([*heads, *texts]) + "\n", poses)


def _kept(part: str, count: int) -> NDArray[np.intp]:
    kind, *numbers = part.split("-")
    if kind == "reversed":
        return np.arange(count)[::-1]
    if kind == "every":
        step, offset = map(int, numbers)
        return np.arange(offset, count, step)
    if kind == "drop":
        percent, seed = map(int, numbers)
        return np.flatnonzero(stream(seed, "dropped scans").random(count) >= 0.01 * percent)
    return np.arange(count)


def _flaser(words: list[str], is_mirrored: bool, number: int) -> str:
    count = int(words[1])
    ranges = words[2 : 2 + count]
    if is_mirrored:  # the first of 180 or 360 beams is at -90 degrees, and none at 90
        ranges = ranges[::-1] if count % 2 else [ranges[0], *ranges[:0:-1]]
    return " ".join([*words[:2], *ranges, *["0"] * 6, f"{number}.0", "host", f"{number}.0"])
