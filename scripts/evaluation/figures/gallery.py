# SPDX-License-Identifier: GPL-3.0-or-later
"""The maps of many logs in one picture."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

UNKNOWN = (127, 128)


def read_pgm(path: Path) -> np.ndarray:
    """A binary 8-bit PGM, as shapemap-cli writes it: rows from the top."""
    content = path.read_bytes()
    magic, width, height, depth = content.split(maxsplit=4)[:4]
    if magic != b"P5" or depth != b"255":
        raise ValueError(f"{path}: not a binary 8-bit PGM")
    size = int(width) * int(height)
    return np.frombuffer(content[-size:], dtype=np.uint8).reshape(int(height), int(width))


def known_part(grey: np.ndarray, share: float = 0.998) -> np.ndarray:
    """The map without the far ends of the few beams that left through doors and windows."""
    known = ~np.isin(grey, UNKNOWN)
    if not known.any():
        return grey
    cut = []
    for axis in (1, 0):
        sums = np.cumsum(known.sum(axis=axis))
        low, high = (1 - share) / 2 * sums[-1], (1 + share) / 2 * sums[-1]
        cut.append(slice(int(np.searchsorted(sums, low)), int(np.searchsorted(sums, high)) + 1))
    return grey[cut[0], cut[1]]


def draw(maps: dict[str, np.ndarray], columns: int, out: Path) -> None:
    rows = math.ceil(len(maps) / columns)
    figure = Figure(figsize=(5 * columns, 5 * rows))
    axes = figure.subplots(rows, columns, squeeze=False)
    for axis in axes.flat:
        axis.axis("off")
    for axis, (name, grey) in zip(axes.flat, maps.items(), strict=False):
        axis.imshow(known_part(grey), cmap="gray", vmin=0, vmax=255, interpolation="antialiased")
        axis.set_title(name)
    figure.tight_layout()
    figure.savefig(out, dpi=80)
