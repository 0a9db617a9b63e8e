#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Map logs with shapemap-cli and put all maps into one picture."""

from __future__ import annotations

import argparse
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
EXIT_OK = (0, 4)  # 4: map written, some positions not placed
UNKNOWN = (127, 128)
EXAMPLE = """example:
  SHAPEMAP_DATASETS=logs scripts/map_gallery.py carmen/intel-corrected.log.gz slam-benchmark/aces.clf.gz --out maps.png

Exit status: 0 all logs were mapped, 1 some were not and are left out, 2 wrong usage."""


def find_log(name: str) -> Path:
    """The log as named, or below SHAPEMAP_DATASETS."""
    below = Path(os.environ.get("SHAPEMAP_DATASETS", ".")) / name
    return Path(name) if Path(name).exists() else below


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


def mapped(cli: Path, log: Path, arguments: list[str]) -> np.ndarray | None:
    """The map of a log; None, and a line on standard error, when there is none."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "map.pgm"
        command = [str(cli), str(log), "--out", str(out), "--quiet", *arguments]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        if run.returncode not in EXIT_OK:
            print(f"map_gallery.py: {log}: {run.stderr.strip() or run.returncode}", file=sys.stderr)
            return None
        return read_pgm(out)


def draw(maps: dict[str, np.ndarray], columns: int, out: Path) -> None:
    rows = math.ceil(len(maps) / columns)
    figure, axes = plt.subplots(rows, columns, figsize=(5 * columns, 5 * rows), squeeze=False)
    for axis in axes.flat:
        axis.axis("off")
    for axis, (name, grey) in zip(axes.flat, maps.items(), strict=False):
        axis.imshow(known_part(grey), cmap="gray", vmin=0, vmax=255, interpolation="antialiased")
        axis.set_title(name)
    figure.tight_layout()
    figure.savefig(out, dpi=80)
    plt.close(figure)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, epilog=EXAMPLE, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("logs", nargs="+", metavar="LOG", help="log, or its path below SHAPEMAP_DATASETS")
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="picture to write")
    parser.add_argument("--columns", type=int, default=3)
    parser.add_argument("--cli", type=Path, default=ROOT / "build/release/bin/shapemap-cli")
    parser.add_argument("--arg", action="append", default=[], help="passed on to the mapper; repeat for more")
    options = parser.parse_args()
    if options.columns < 1:
        parser.error("--columns must be at least 1")
    maps: dict[str, np.ndarray] = {}
    for name in options.logs:
        grey = mapped(options.cli, find_log(name), options.arg)
        if grey is not None:
            maps[Path(name).name.split(".")[0]] = grey
    if maps:
        draw(maps, options.columns, options.out)
    return 0 if len(maps) == len(options.logs) else 1


if __name__ == "__main__":
    sys.exit(main())
