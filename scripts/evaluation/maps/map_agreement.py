# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of a map is where the map at the reference poses has it.

Both maps are drawn here, from the same returns and in the same way, so that nothing but the poses differs: a cell is
occupied when a return lies in it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from evaluation.common.poses import Array, compose, transform

CELL_M = 0.05
WITHIN_M = 0.10


def occupied_cells(poses: Mapping[int, Array], points: Sequence[Array]) -> Array:
    """Centres `[n, 2]` of the cells that returns lie in, each once."""
    if not poses:
        return np.zeros((0, 2))
    returns = np.concatenate([transform(pose, points[position]) for position, pose in poses.items()])
    cells = np.unique(np.floor(returns / CELL_M).astype(np.int64), axis=0)
    return np.asarray((cells + 0.5) * CELL_M, dtype=np.float64)


def share_near(cells: Array, others: Array, within_m: float = WITHIN_M) -> float | None:
    """Share of the cells with one of the others at most so far away; None without cells."""
    if not len(cells):
        return None
    if not len(others):
        return 0.0
    distances, _ = cKDTree(others).query(cells, distance_upper_bound=within_m * (1.0 + 1e-9))
    return float(np.isfinite(distances).mean())


def map_agreement(
    reference: Array, poses: Mapping[int, Array], points: Sequence[Array], reference_from_map: Array
) -> dict[str, Any]:
    """Precision: share of the occupied cells of the map that are within 10 cm of one of the map at reference poses;
    recall: share of those found again. The map holds what is placed, the other one all positions."""
    aligned = {position: compose(reference_from_map, pose) for position, pose in poses.items()}
    found = occupied_cells(aligned, points)
    truth = occupied_cells(dict(enumerate(np.asarray(reference))), points)
    return {"precision": share_near(found, truth), "recall": share_near(truth, found), "num_cells": len(found)}
