# SPDX-License-Identifier: GPL-3.0-or-later
"""All figures of one run, with what each shows, and why any is left out."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from evaluation.common.poses import Array, transform
from evaluation.common.tum import tum_line

from . import map_figures, match_figures, scan_figures
from .drawing import save
from .matches import Match, filtered_pair, hard_pair, match_of, true_step
from .references import in_frame_of, position_errors_m
from .source import Source
from .trace import Trace

NO_REFERENCE = "no reference poses"
NO_PAIRS = "no trace of pairwise alignments (--method paper --target-scans 1)"
NOT_PAPER = "the trace is not of the paper's method"


@dataclass
class Album:
    """Figures by name; `facts[name]` is what a figure shows in numbers, `left_out[name]` why there is none; `texts` are
    files beside them."""

    figures: dict[str, Figure] = field(default_factory=dict)
    facts: dict[str, dict[str, Any]] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)

    def add(self, name: str, figure: Figure, **facts: Any) -> None:
        self.figures[name] = figure
        self.facts[name] = facts

    def leave_out(self, names: str, why: str) -> None:
        self.left_out.update(dict.fromkeys(names.split(), why))

    def write(self, folder: Path, head: Mapping[str, Any]) -> None:
        """All figures in all formats, and figures.json about them."""
        figures = {
            name: {"files": save(figure, folder, f"figure_{name}"), **self.facts[name]}
            for name, figure in self.figures.items()
        }
        for name, content in self.texts.items():
            (folder / name).write_text(content, encoding="utf-8")
        text = json.dumps({**head, "figures": figures, "left_out": self.left_out}, indent=1)
        (folder / "figures.json").write_text(text + "\n", encoding="utf-8")


def match_facts(match: Match, truth: Array | None) -> dict[str, Any]:
    facts: dict[str, Any] = {"targets": match.targets, "query": match.query}
    facts["num_correspondences"] = {stage: len(pairs) for stage, pairs in match.pairs.items()}
    facts["num_segments"] = len(match.segments)
    if truth is not None:
        facts["num_right"] = {stage: int(match.is_right(stage, truth).sum()) for stage in match.pairs}
        facts["error_cm"] = 100.0 * float(np.hypot(*(match.ref_from_query - truth)[:2]))
    return facts


def add_scan_figures(album: Album, trace: Trace, index: int | None) -> None:
    """1a and 1b: of the position that is asked for, else of the one with the part that has most to show."""
    positions = [position for i, position in sorted(trace.positions.items()) if index in (None, i)]
    part = scan_figures.richest_part(positions)
    if part is None:
        album.leave_out("1a 1b", "no line segment was fitted")
        return
    facts = {"position": part.position, "num_points": len(part.points), "num_segments": len(part.segments)}
    album.add("1a", scan_figures.polyline_figure(part), sub_scan=part.sub_scan, **facts)
    position = trace.positions[part.position]
    if position.histograms is None:
        album.leave_out("1b", NOT_PAPER)
        return
    radius_m = float(trace.run["options"]["histogram-radius-m"])
    point = scan_figures.telling_point(position, radius_m)
    bins = int((position.histograms[point] > 0).sum())
    album.add(
        "1b", scan_figures.histogram_figure(position, radius_m), position=position.index, point=point, num_bins=bins
    )


def checked(pairwise: Trace, query: int | None, choose: Callable[[], int | None]) -> int | None:
    """The query that is asked for, if its alignment has anything to show, else the one that `choose` finds."""
    if query is None:
        return choose()
    record = pairwise.alignments.get(query)
    return query if record is not None and record["best_rotation"] is not None else None


def add_hard_pair(album: Album, main: Trace, pairwise: Trace, reference: dict[int, Array], asked: int | None) -> None:
    """2, 3a, 3b: one query against one scan and against the partial map."""
    query = checked(pairwise, asked, lambda: hard_pair(pairwise, main, reference))
    if query is None:
        album.leave_out("2 3a 3b", "no alignment with correspondences to show")
        return
    match = match_of(pairwise, query)
    truth = true_step(reference, match.reference, match.query)
    shared = None
    if truth is not None:
        query_scan = np.concatenate(pairwise.positions[query].scan_points)
        shared = scan_figures.shared_ratio(transform(truth, query_scan), match.target_scan)
    album.add(
        "2",
        scan_figures.two_scans_figure(match, shared),
        reference=match.reference,
        query=query,
        shared_ratio=shared,
        overlap_ratio=match.overlap_ratio,
    )
    figure = match_figures.correspondence_figure(match, "3(a)", "lcs", truth)
    album.add("3a", figure, **match_facts(match, truth))
    record = main.alignments.get(query)
    if record is None or record["best_rotation"] is None:
        album.leave_out("3b", f"nothing in the partial map is like position {query}")
        return
    against_map = match_of(main, query)
    truth = true_step(reference, against_map.reference, query)
    album.add("3b", match_figures.partial_map_figure(against_map, truth), **match_facts(against_map, truth))


def add_filtered_pair(album: Album, pairwise: Trace, reference: dict[int, Array], asked: int | None) -> None:
    """4a, 4b, 4c: what the filters do."""
    query = checked(pairwise, asked, lambda: filtered_pair(pairwise, reference))
    if query is None:
        album.leave_out("4a 4b 4c", "no alignment with correspondences to show")
        return
    match = match_of(pairwise, query)
    truth = true_step(reference, match.reference, match.query)
    facts = match_facts(match, truth)
    album.add("4a", match_figures.correspondence_figure(match, "4(a)", "lcs", truth), **facts)
    album.add("4b", match_figures.correspondence_figure(match, "4(b)", "segments", truth), **facts)
    album.add("4c", match_figures.aligned_figure(match), **facts)


def add_maps(album: Album, trace: Trace, reference: dict[int, Array], baseline: dict[int, Array] | None) -> None:
    """5a to 5d, all in the frame of one position and with limits that hold ours and that of the reference."""
    poses, before = trace.map_poses(), trace.shape_poses()
    errors = position_errors_m(poses, reference)
    if not poses:
        album.leave_out("5a 5b 5c 5d 6a 6b", "no position is in the map")
        return
    first = min(errors or poses)
    poses, before = in_frame_of(first, poses), in_frame_of(first, before)
    truth = in_frame_of(first, reference) if errors else {}
    ours = map_figures.map_points(trace, poses, corrected=True)
    shown = np.concatenate([ours, map_figures.map_points(trace, truth, corrected=False)])

    def add(name: str, title: str, of: dict[int, Array], points: Array) -> None:
        title = f"5({name[1]}) {title}: {len(of)} positions"
        places = np.array([pose[:2] for pose in of.values()])
        limits = np.concatenate([shown, points]) if name == "5b" else shown
        album.add(name, map_figures.map_figure(title, points, limits, places), num_positions=len(of))

    if before:
        add("5a", "estimated poses before ICP", before, map_figures.map_points(trace, before, corrected=False))
        lines = [tum_line(trace.positions[i].timestamp_s, pose) for i, pose in before.items()]
        album.texts["before_icp.tum"] = "".join(lines)
    else:
        album.leave_out("5a", NOT_PAPER)
    if baseline:
        of = in_frame_of(first if first in baseline else min(baseline), baseline)
        add("5b", "scan matching fed with our poses", of, map_figures.map_points(trace, of, corrected=False))
    else:
        album.leave_out("5b", "no --baseline-trajectory")
    add("5c", f"our map, {trace.method} method", poses, ours)
    if not truth:
        album.leave_out("5d 6a 6b", NO_REFERENCE)
        return
    add("5d", "reference poses", truth, map_figures.map_points(trace, truth, corrected=False))
    album.add("6a", map_figures.poses_figure(poses, truth), num_positions=len(errors))
    album.add(
        "6b",
        map_figures.error_figure(errors),
        errors_cm={str(i): 100.0 * error for i, error in errors.items()},
        worst_cm=100.0 * max(errors.values()),
    )


@dataclass(frozen=True)
class Choices:
    """Which positions to show; None: chosen."""

    position: int | None = None
    hard_query: int | None = None
    filtered_query: int | None = None


def album_of(source: Source, reference: dict[int, Array], baseline: dict[int, Array] | None, choices: Choices) -> Album:
    """All figures that the source has what it takes for."""
    album = Album()
    add_scan_figures(album, source.main, choices.position)
    pairwise = source.main if source.main.is_pairwise else source.pairwise
    if pairwise is None:
        album.leave_out("2 3a 3b 4a 4b 4c", NO_PAIRS if source.main.method == "paper" else NOT_PAPER)
    else:
        add_hard_pair(album, source.main, pairwise, reference, choices.hard_query)
        add_filtered_pair(album, pairwise, reference, choices.filtered_query)
    add_maps(album, source.main, reference, baseline)
    return album
