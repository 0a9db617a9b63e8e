# SPDX-License-Identifier: GPL-3.0-or-later
"""All that the mapper writes of a log, in pieces that can be held against those of another version of the program."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from evaluation.common.programs import Failure

from .mapper import Mapper
from .report import Report

Pieces = list[bytes]  # the lines of a file, the whole of a picture, or the entries of a part of a report

FILES = {"trajectory": "map.tum", "picture": "map.png", "map.yaml": "map.yaml", "CARMEN log": "map.log"}
SCANS = {
    "motions": (
        *("index", "log", "index_in_whole_log", "component", "starts_component", "map_from_robot"),
        *("status", "reference", "ref_from_query", "query_from_sweep"),
    ),
    "probabilities": ("probability",),
    "covariances": ("covariance",),
    "reasons": ("reason", "why_not_in_map"),
}
REQUIRED = ("index", "component", "map_from_robot", "alignment", "reason")  # each scan has them, if only as null
LOOPS = ("a", "b", "a_from_b", "strength")
OUTPUTS = (*FILES, *SCANS, "loops")


def outputs_of(mapper: Mapper, logs: Sequence[Path]) -> dict[str, Pieces]:
    """Maps logs together, and gives what OUTPUTS names. Raises Failure without a map."""
    with tempfile.TemporaryDirectory(prefix="same_") as name:
        folder = Path(name)
        more = ["--trajectory", folder / FILES["trajectory"], "--carmen-out", folder / FILES["CARMEN log"]]
        report, _ = mapper.run(logs, folder, more=more)
        return {**files_in(folder), **parts_of(report)}


def files_in(folder: Path) -> dict[str, Pieces]:
    """The contents of the files; no piece of one that is missing."""
    found: dict[str, Pieces] = {}
    for output, name in FILES.items():
        content = (folder / name).read_bytes() if (folder / name).exists() else None
        is_text = output != "picture"
        found[output] = [] if content is None else content.splitlines(keepends=True) if is_text else [content]
    return found


def parts_of(report: Report) -> dict[str, Pieces]:
    """The parts of a report that say where scans are, how sure that is, and why. A member of a scan may stand in its
    alignment. Raises Failure for a report that lacks what each has: nothing is not the same as nothing."""
    lacking = [member for member in REQUIRED if any(member not in scan for scan in report["scans"])]
    if lacking:
        raise Failure(f"the scans of the report have no member {', '.join(lacking)}")
    scans = [{**(scan.get("alignment") or {}), **scan} for scan in report["scans"]]
    parts = {output: [entry(scan, members) for scan in scans] for output, members in SCANS.items()}
    return {**parts, "loops": [entry(loop, LOOPS) for loop in report["loops"]]}


def entry(fields: Mapping[str, Any], members: Sequence[str]) -> bytes:
    """The chosen members, of which one that is missing counts as null."""
    return json.dumps([fields.get(member) for member in members]).encode()


def first_difference(before: Pieces, after: Pieces) -> str:
    """Where two outputs differ, in words; empty where they are the same."""
    if before == after:
        return ""
    if len(before) == len(after) == 1:
        return f"{len(before[0])} and {len(after[0])} bytes"
    common = zip(before, after)
    first = next((k for k, (one, other) in enumerate(common) if one != other), min(len(before), len(after)))
    num = sum(one != other for one, other in zip(before, after))
    lengths = f", {len(before)} and {len(after)} in all" if len(before) != len(after) else f" of {len(before)}"
    return f"from entry {first} on, {num} differ{lengths}"
