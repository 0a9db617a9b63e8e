# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulate a rescue robot's laser log in a maze-like arena, in the manner of NIST's, with exact reference poses."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from evaluation.common.argument_types import number, some_of
from evaluation.common.command_line import command_parser, complain
from evaluation.common.files import write_whole
from evaluation.common.poses import Array
from evaluation.simulation.arena_options import add_arena_arguments, options_from
from evaluation.simulation.simulation import Simulation, consecutive_overlaps, simulate, travel_visible
from evaluation.simulation.write import nist_text, truth_text, tum_text

FORMATS = ("nist", "tum", "truth")
EXAMPLE = """example:
  scripts/evaluate.py simulate --seed 0 --out results/arena --picture results/arena_world.png
    writes results/arena.nist (the log), results/arena.tum (reference poses) and results/arena.truth.json
    (true pose of every sub-scan); `shapemap-cli convert` makes other log formats from the .nist file"""


def parse_arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = command_parser(__name__, __doc__, EXAMPLE)
    parser.add_argument(
        "--seed",
        type=number(0, 2**31 - 1, int),
        default=0,
        metavar="N",
        help="the same seed and options give the same files (default %(default)s)",
    )
    parser.add_argument("--out", type=Path, required=True, metavar="PREFIX", help="files are PREFIX.nist and so on")
    parser.add_argument(
        "--formats",
        type=some_of(FORMATS, at_least=1),
        default=list(FORMATS),
        metavar="LIST",
        help=f"files to write, of {','.join(FORMATS)} (default all)",
    )
    parser.add_argument("--picture", type=Path, metavar="FILE", help="draw world, route and one scan (PNG, SVG, PDF)")
    parser.add_argument("--quiet", action="store_true", help="no summary")
    add_arena_arguments(parser)
    return parser.parse_args(argv)


def write_files(prefix: Path, formats: list[str], simulation: Simulation, overlaps: Array) -> list[Path]:
    """The files of a run, by format name."""
    writers = {
        "nist": (".nist", lambda: nist_text(simulation)),
        "tum": (".tum", lambda: tum_text(simulation)),
        "truth": (".truth.json", lambda: truth_text(simulation, overlaps)),
    }
    written = []
    for name in formats:
        suffix, make_text = writers[name]
        path = prefix.with_name(prefix.name + suffix)
        write_whole(path, make_text())
        written.append(path)
    return written


def summary(simulation: Simulation, overlaps: Array) -> str:
    """A few lines about the run."""
    ranges = simulation.ranges
    returned = np.isfinite(ranges).mean()
    lines = [
        f"seed {simulation.options.seed}: {ranges.shape[0]} positions x {ranges.shape[1]} sub-scans x "
        f"{ranges.shape[2]} beams, {100 * returned:.1f} % of them returned",
        f"world: {len(simulation.world.faces)} flat and {len(simulation.world.arcs)} round faces",
    ]
    if len(overlaps):
        visible = travel_visible(simulation)
        lines += [
            f"overlap with the scan before: min {overlaps.min():.2f}, mean {overlaps.mean():.2f}, "
            f"max {overlaps.max():.2f}",
            "  each: " + " ".join(f"{value:.2f}" for value in overlaps),
            f"next position in sight: {visible.sum()} of {len(visible)}",
        ]
    return "\n".join(lines)


def main(argv: list[str] | None = None) -> int:
    arguments = parse_arguments(argv)
    try:
        simulation = simulate(options_from(arguments, arguments.seed))
        overlaps = consecutive_overlaps(simulation)
        written = write_files(arguments.out, arguments.formats, simulation, overlaps)
        if arguments.picture:
            from evaluation.simulation.picture import save_picture  # matplotlib only when a picture is asked for

            save_picture(arguments.picture, simulation)
            written.append(arguments.picture)
    except (ValueError, OSError) as error:
        complain(__name__, str(error))
        return 1
    if not arguments.quiet:
        print(summary(simulation, overlaps))
        print("wrote " + ", ".join(str(path) for path in written))
    return 0
