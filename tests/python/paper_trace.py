# SPDX-License-Identifier: GPL-3.0-or-later
"""A small trace made by hand, of three positions whose poses and correspondences are known."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

# Poses [x, y, theta] in the frame of position 0: as found, and by shape alone one step each.
FOUND = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [2.0, 0.2, 0.0]]
STEPS = [[1.05, 0.02, 0.1], [0.95, 0.2, -0.1]]
TRUTH = [[5.0, 5.0, np.pi / 2], [5.0, 6.0, np.pi / 2 + 0.1], [4.7, 7.0, np.pi / 2]]
CORRECTION = [0.0, 0.5, 0.0]  # of sub-scan 1 of position 1
CORNER = [[2.0, -1.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [0.0, 1.0]]


def run_record(**options: Any) -> dict[str, Any]:
    all_options = {"method": "paper", "target-scans": 3, "histogram-radius-m": 0.5, **options}
    return {
        "record": "run",
        "format": "shapemap-trace",
        "format_version": 1,
        "log": "nowhere.nist",
        "num_positions": 3,
        "histogram_scale": 252.0,
        "options": all_options,
    }


def position_record(index: int) -> dict[str, Any]:
    """Two sub-scans with the same five returns, which are the shape points as well."""
    sub_scan = {"scan_points": CORNER, "segments": [[2.0, -1.0, 2.0, 1.0], [2.0, 1.0, 0.0, 1.0]]}
    points = [[x, y, 1.57, s] for s in (0, 1) for x, y in CORNER]
    return {
        "record": "position",
        "index": index,
        "index_in_whole_log": 10 + index,
        "timestamp_s": 100.0 + index,
        "sub_scans": [sub_scan, sub_scan],
        "points": points,
        "histograms": [[3, 252, 21, 126]] + [[0, 252]] * 9,
    }


def alignment_record(query: int, rotation_rad: float = 0.1) -> dict[str, Any]:
    targets = [
        {
            "position": i,
            "ref_from_robot": [float(i - query + 1), 0.0, 0.0],
            "robot_from_sub_scan": [[0.0, 0.0, 0.0], CORRECTION if i == 1 else [0.0, 0.0, 0.0]],
        }
        for i in range(query)
    ]
    lcs = [[k, query - 1, k] for k in range(7)]
    return {
        "record": "alignment",
        "reference": query - 1,
        "query": query,
        "status": "ok",
        "targets": targets,
        "rotations": [{"rotation_rad": 0.0}, {"rotation_rad": rotation_rad}],
        "best_rotation": 1,
        "lcs": lcs,
        "spread": lcs[:6],
        "segments": [lcs[:2], lcs[3:6]],
        "kept": lcs[3:5],
        "shape_ref_from_query": STEPS[query - 1],
        "overlap_ratio": 0.5,
    }


def result_record(index: int) -> dict[str, Any]:
    return {
        "record": "result",
        "index": index,
        "fragment": 0,
        "starts_fragment": index == 0,
        "fragment_from_robot": FOUND[index],
        "robot_from_sub_scan": [[0.0, 0.0, 0.0], CORRECTION if index == 1 else [0.0, 0.0, 0.0]],
    }


def small_trace(**options: Any) -> list[dict[str, Any]]:
    return [
        run_record(**options),
        position_record(0),
        position_record(1),
        alignment_record(1),
        position_record(2),
        alignment_record(2),
        *map(result_record, range(3)),
        {"record": "end", "largest_fragment": 0},
    ]


def write_trace(path: Path, records: list[dict[str, Any]]) -> Path:
    path.write_text("".join(json.dumps(r, separators=(",", ":")) + "\n" for r in records), encoding="utf-8")
    return path
