# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of shapemap-cli, whatever the names of its members are in the version that wrote it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from evaluation.common.poses import Array, pose_from

Report = Mapping[str, Any]

# What members were called, and what they are called in all of the evaluation.
RENAMED = {
    "positions": "scans",
    "fragments": "components",
    "fragment": "component",
    "starts_fragment": "starts_component",
    "num_positions": "num_scans",
    "num_sub_scans": "num_sweeps",
    "query_from_sub_scan": "query_from_sweep",
    "held_by_loops": "loop_constrained",
    "agreement": "consistency",
}


def with_present_names(value: Any) -> Any:
    """A part of a report, with the members that have new names under these. The options keep their names."""
    if isinstance(value, dict):
        return {
            RENAMED.get(key, key): item if key == "options" else with_present_names(item) for key, item in value.items()
        }
    return [with_present_names(item) for item in value] if isinstance(value, list) else value


def read_report(path: Path) -> dict[str, Any]:
    """Raises OSError, or ValueError for what is no JSON object."""
    content = with_present_names(json.loads(path.read_text(encoding="utf-8")))
    if not isinstance(content, dict):
        raise ValueError(f"{path.name}: no JSON object")
    return content


def place_in_log(report: Report, index: int) -> tuple[int, int]:
    """Log and scan of a position, also where --every and --skip leave some out."""
    scan = report["scans"][index]
    return int(scan["log"]), int(scan["index_in_whole_log"])


def placed_poses(report: Report) -> dict[int, Array]:
    """`map_from_robot` `[3]` by index of the scan, of those in the map."""
    return {scan["index"]: pose_from(scan["map_from_robot"]) for scan in report["scans"] if scan.get("map_from_robot")}
