# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of the paper's figures, on a trace made by hand."""

from __future__ import annotations

import cmath
import gzip
import json

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.patches import Rectangle

from evaluation.figures import map_figures, match_figures, scan_figures
from evaluation.figures.album import Choices, album_of
from evaluation.figures.matches import filtered_pair, hard_pair, match_of, true_step
from evaluation.figures.references import in_frame_of, position_errors_m, reference_poses
from evaluation.figures.source import Source, sources_of
from evaluation.figures.trace import is_trace, read_trace
from paper_trace import CORNER, CORRECTION, FOUND, STEPS, TRUTH, alignment_record, run_record, small_trace, write_trace

REFERENCE = {i: np.array(pose) for i, pose in enumerate(TRUTH)}


@pytest.fixture
def trace(tmp_path):
    return read_trace(write_trace(tmp_path / "a.jsonl", small_trace()))


def links(figure):
    """How many lines of correspondences are drawn, by label."""
    collections = [c for c in figure.axes[0].collections if isinstance(c, LineCollection)]
    return {str(c.get_label()): len(c.get_segments()) for c in collections}


def test_a_trace_is_read_with_its_positions_steps_and_results(trace):
    assert trace.method == "paper"
    assert not trace.is_pairwise
    assert trace.placed == [0, 1, 2]
    assert trace.positions[2].index_in_whole_log == 12
    assert trace.positions[0].histograms[0, 3] == 1.0
    assert trace.positions[0].histograms[0, 21] == 0.5
    assert trace.positions[0].histograms.sum() == pytest.approx(10.5)
    assert trace.map_poses()[2] == pytest.approx(FOUND[2])


def test_poses_before_icp_are_the_steps_by_shape_in_a_row(trace):
    (x1, y1, t1), (x2, y2, t2) = STEPS
    expected = complex(x1, y1) + cmath.rect(1.0, t1) * complex(x2, y2)
    assert trace.shape_poses()[2] == pytest.approx([expected.real, expected.imag, t1 + t2])


def test_a_compressed_trace_is_the_same(trace, tmp_path):
    packed = tmp_path / "b.jsonl.gz"
    packed.write_bytes(gzip.compress((tmp_path / "a.jsonl").read_bytes()))
    assert is_trace(packed)
    assert read_trace(packed).results == trace.results


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda lines: lines[:-1], "has no end"),
        (lambda lines: lines[1:], ":1: a trace begins with"),
        (lambda lines: [lines[0], *lines], ":2: a trace begins with"),
        (lambda lines: [lines[0].replace("-trace", "-report")], ":1: expected shapemap-trace, version 1"),
        (lambda lines: [*lines[:3], lines[3][:40]], ":4: not a record"),
        (lambda lines: [lines[0], '{"record":"position","index":0}'], ":2: a 'position' record"),
        (lambda lines: [lines[0], '{"record":"dream"}'], ":2: 'dream' is no record"),
    ],
)
def test_what_is_no_whole_trace_is_told_with_its_line(trace, tmp_path, change, message):
    path = tmp_path / "bad.jsonl"
    path.write_text("\n".join(change(trace.path.read_text().splitlines())) + "\n")
    with pytest.raises(ValueError, match=message):
        read_trace(path)


def test_a_correspondence_has_the_coordinates_of_its_points(trace):
    match = match_of(trace, 2)
    assert match.targets == [0, 1]
    # Correspondence 6 joins point 6 of position 2, turned, and point 6 of position 1: of its second sub-scan.
    target, query = match.pairs["lcs"][6]
    assert target == pytest.approx(np.array(CORNER[1]) + CORRECTION[:2])
    turned = cmath.rect(1.0, 0.1) * complex(*CORNER[1])
    assert query == pytest.approx([turned.real, turned.imag])
    # The scans of both targets in the frame of the last.
    assert match.target_scan[0] == pytest.approx([CORNER[0][0] - 1.0, CORNER[0][1]])
    assert match.aligned_query_scan[0] - match.query_scan[0] == pytest.approx(STEPS[1][:2])


def test_right_correspondences_join_what_is_one_place_at_the_reference_poses(trace):
    match = match_of(trace, 1)
    # At the very pose that puts equal points of the first sub-scan onto each other, and only these have no correction.
    assert match.is_right("lcs", np.zeros(3)).tolist() == [True] * 7
    assert match.is_right("lcs", np.array([0.5, 0.0, 0.0])).sum() == 0
    assert match_of(trace, 2).is_right("lcs", np.zeros(3)).tolist() == [True] * 5 + [False] * 2


@pytest.mark.parametrize("truth", [None, np.zeros(3)])
def test_figures_3_and_4_draw_each_correspondence_of_the_trace_once(trace, truth):
    match = match_of(trace, 2)
    record = trace.alignments[2]
    drawn = links(match_figures.correspondence_figure(match, "4(a)", "lcs", truth))
    assert sum(drawn.values()) == len(record["lcs"]) == 7
    filtered = links(match_figures.correspondence_figure(match, "4(b)", "segments", truth))
    assert sum(filtered.values()) == sum(map(len, record["segments"])) == 5
    if truth is not None:
        assert drawn == {"wrong correspondences": 2, "right correspondences": 5}


def test_figure_3b_frames_the_right_correspondences(trace):
    match = match_of(trace, 2)
    figure = match_figures.partial_map_figure(match, np.zeros(3))
    (frame,) = [patch for patch in figure.axes[0].patches if isinstance(patch, Rectangle)]
    x, y = frame.get_xy()
    right = 100.0 * match.pairs["lcs"][:5].reshape(-1, 2)
    assert (right >= [x, y]).all()
    assert (right <= [x + frame.get_width(), y + frame.get_height()]).all()


def test_errors_do_not_depend_on_the_frame_and_equal_what_complex_numbers_say():
    estimated = {i: np.array(pose) for i, pose in enumerate(FOUND)}
    errors = position_errors_m(estimated, REFERENCE)

    def seen_from_first(poses):
        x, y, theta = poses[0]
        return [cmath.rect(1.0, -theta) * (complex(*p[:2]) - complex(x, y)) for p in poses]

    expected = [abs(a - b) for a, b in zip(seen_from_first(FOUND), seen_from_first(TRUTH))]
    assert list(errors.values()) == pytest.approx(expected)
    assert max(expected) > 0.09
    drawn = np.asarray(map_figures.error_figure(errors).axes[0].lines[0].get_xydata())
    assert drawn[:, 1] == pytest.approx(100.0 * np.array(expected))


def test_maps_have_all_returns_where_the_poses_put_them(trace):
    points = map_figures.map_points(trace, trace.map_poses(), corrected=True)
    assert len(points) == 30
    corrected = complex(*CORNER[0]) + complex(*CORRECTION[:2])
    place = complex(*FOUND[1][:2]) + cmath.rect(1.0, FOUND[1][2]) * corrected
    assert points[15] == pytest.approx([place.real, place.imag])
    drawn = map_figures.map_figure("5(c)", points, points, points[:1]).axes[0].lines[0].get_xydata()
    assert drawn == pytest.approx(100.0 * points)


def test_figure_1_shows_the_polylines_and_the_histogram_of_the_trace(trace):
    part = scan_figures.richest_part(trace.positions.values())
    assert part is not None
    drawn = links(scan_figures.polyline_figure(part))
    assert drawn == {"line segments": len(part.segments)}
    assert len(part.segments) == 2
    figure = scan_figures.histogram_figure(trace.positions[0], 0.5)
    bars = [bar.get_height() for bar in figure.axes[1].patches if isinstance(bar, Rectangle)]
    assert bars == pytest.approx(trace.positions[0].histograms[0])


def test_reference_poses_come_from_the_file_beside_the_log_by_time(trace, tmp_path):
    log = tmp_path / "some.nist"
    (tmp_path / "some.tum").write_text("# t x y z qx qy qz qw\n101.0 3 4 0 0 0 0 1\n50 0 0 0 0 0 0 1\n")
    poses = reference_poses(trace, log, None)
    assert list(poses) == [1]
    assert poses[1] == pytest.approx([3.0, 4.0, 0.0])
    (tmp_path / "bad.tum").write_text("1 2 3\n")
    with pytest.raises(ValueError, match=r"bad.tum:1: expected 8 numbers"):
        reference_poses(trace, log, tmp_path / "bad.tum")
    (tmp_path / "other.tum").write_text("7.0 3 4 0 0 0 0 1\n")
    with pytest.raises(ValueError, match="none of its timestamps"):
        reference_poses(trace, log, tmp_path / "other.tum")


def test_the_pairs_to_show_are_the_hardest_and_the_most_filtered(tmp_path):
    records = small_trace(**{"target-scans": 1})
    records[3] = {**alignment_record(1), "lcs": [[0, 0, 0]], "overlap_ratio": 0.2}
    pairwise = read_trace(write_trace(tmp_path / "p.jsonl", records))
    main = read_trace(write_trace(tmp_path / "m.jsonl", small_trace()))
    assert hard_pair(pairwise, main, {}) == 2  # 1 overlaps less, but nothing more than one scan is there to help it
    assert filtered_pair(pairwise, {}) == 2
    assert true_step(REFERENCE, 0, 9) is None


def test_a_pairwise_trace_goes_with_the_one_of_the_same_log(tmp_path):
    main = write_trace(tmp_path / "main.jsonl", small_trace())
    pairwise = write_trace(tmp_path / "pairs.jsonl", small_trace(**{"target-scans": 1}))
    (source,) = sources_of([pairwise, main], tmp_path, tmp_path, "paper", [])
    assert source.name == "main"
    assert source.pairwise is not None
    assert source.pairwise.path == pairwise
    (alone,) = sources_of([pairwise], tmp_path, tmp_path, "paper", [])
    assert alone.main.is_pairwise


def test_an_album_says_what_is_left_out_and_why(trace, tmp_path):
    album = album_of(Source("a", trace, None, None), {}, None, Choices())
    assert sorted(album.figures) == ["1a", "1b", "5a", "5c"]
    assert album.left_out["6b"] == album.left_out["5d"] == "no reference poses"
    assert "pairwise" in album.left_out["3a"]
    album.write(tmp_path / "out", {"log": "x"})
    told = json.loads((tmp_path / "out/figures.json").read_text())
    assert told["left_out"] == album.left_out
    for entry in told["figures"].values():
        assert [name.split(".")[1] for name in entry["files"]] == ["svg", "pdf", "png"]
        assert all((tmp_path / "out" / name).stat().st_size > 1000 for name in entry["files"])


def test_the_robust_method_has_no_correspondences_to_show(tmp_path):
    records = [r for r in small_trace() if r["record"] != "alignment"]
    records[0] = run_record(method="robust")
    for record in records:
        record.pop("histograms", None)
    robust = read_trace(write_trace(tmp_path / "r.jsonl", records))
    album = album_of(Source("r", robust, None, None), REFERENCE, in_frame_of(0, REFERENCE), Choices())
    assert sorted(album.figures) == ["1a", "5b", "5c", "5d", "6a", "6b"]
    assert set(album.left_out) == {"1b", "2", "3a", "3b", "4a", "4b", "4c", "5a"}
    assert album.facts["6b"]["worst_cm"] == pytest.approx(
        100 * max(position_errors_m(robust.map_poses(), REFERENCE).values())
    )
