# SPDX-License-Identifier: GPL-3.0-or-later
"""Relations between scans: both kinds of files, their faults by file and line, errors worked out by hand."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from evaluation.logs.datasets import DatasetError, LogSpec
from evaluation.logs.evaluation_log import load
from evaluation.logs.relations import Relation, ScanIndex, read_relations, relation_errors, summary

TIMES = [10.5, 11.5, 12.5, 13.5]
INDEX = ScanIndex(TIMES, 1, 4)


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_both_kinds_say_the_same(tmp_path: Path) -> None:
    by_time = write(tmp_path, "a.relations", "10.5 12.500001 1 2 9 9 9 0.5\n\n11.5 13.5 3 4 0 0 0 -1\n")
    by_index = write(tmp_path, "a.scan_relations", "# i j dx dy dtheta\n0 2 1 2 0.5\n1 3 3 4 -1\n")
    found = [read_relations(path, INDEX) for path in (by_time, by_index)]
    for file in found:
        assert [(r.first, r.second, r.first_from_second) for r in file.relations] == [
            (0, 2, (1.0, 2.0, 0.5)),
            (1, 3, (3.0, 4.0, -1.0)),
        ]
        assert file.num_outside == 0
    assert found[0].relations[1].where == f"{by_time}:3"


def test_relations_follow_the_scans_that_are_used(tmp_path: Path) -> None:
    path = write(tmp_path, "a.scan_relations", "0 2 1 2 0\n0 1 1 2 0\n2 3 1 2 0\n")
    file = read_relations(path, ScanIndex(TIMES, 2, 2))
    assert [(r.first, r.second) for r in file.relations] == [(0, 1)]
    assert file.num_outside == 2
    assert read_relations(path, ScanIndex(TIMES, 1, 2)).num_outside == 2, "only the first two scans"


def test_a_time_without_a_scan_is_outside(tmp_path: Path) -> None:
    path = write(tmp_path, "a.relations", "10.5 12.6 1 2 0 0 0 0\n10.5 99 1 2 0 0 0 0\n10.5 11.5 1 2 0 0 0 0\n")
    assert read_relations(path, INDEX).num_outside == 2


@pytest.mark.parametrize(
    ("name", "text", "what"),
    [
        ("a.relations", "10.5 12.5 1 2 0 0 0 0\n10.5 12.5 1 2 0 0 0\n", ":2: expected 8 finite numbers"),
        ("a.relations", "# remark\n10.5 12.5 one 2 0 0 0 0\n", ":2: could not convert"),
        ("a.scan_relations", "0 1 1 2 nan\n", ":1: expected 5 finite numbers"),
        ("a.scan_relations", "0 1 1 2 0\n\n0 4 1 2 0\n", ":3: expected a scan from 0 to 3, found 4"),
        ("a.scan_relations", "0.5 1 1 2 0\n", ":1: expected a scan"),
        ("a.scan_relations", "# nothing\n", ": no relation"),
    ],
)
def test_faults_name_file_and_line(tmp_path: Path, name: str, text: str, what: str) -> None:
    path = write(tmp_path, name, text)
    with pytest.raises(DatasetError) as caught:
        read_relations(path, INDEX)
    assert f"{path}{what}" in str(caught.value)


def test_errors_by_hand() -> None:
    """The second scan stands 3 m to the left of the first, which looks along y, and is turned by 90 degrees."""
    poses = {0: np.array([5.0, 5.0, np.pi / 2]), 1: np.array([2.0, 5.0, np.pi])}
    exact = Relation(0, 1, (0.0, 3.0, np.pi / 2), "")
    off = Relation(0, 1, (0.3, 3.4, np.pi / 2 - 0.1), "")
    back = Relation(1, 0, (-3.0, 0.0, -np.pi / 2), "")  # the second looks away from the first
    missed = Relation(0, 2, (0.0, 0.0, 0.0), "")
    errors = relation_errors([exact, off, back, missed], [poses])
    assert errors[0] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert errors[1] == pytest.approx([0.5, np.degrees(0.1)])
    assert errors[2] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert errors[3] is None


def test_scans_of_two_fragments_have_no_relation() -> None:
    relation = Relation(0, 1, (0.0, 0.0, 0.0), "")
    assert relation_errors([relation], [{0: np.zeros(3)}, {1: np.zeros(3)}]) == [None]
    assert relation_errors([relation], [{2: np.zeros(3)}, {0: np.zeros(3), 1: np.zeros(3)}]) == [[0.0, 0.0]]


def test_the_summary_is_as_published() -> None:
    found = summary([[0.1, 1.0], [0.3, 3.0], [0.8, 2.0], None])
    assert (found["num"], found["num_missed"]) == (3, 1)
    assert found["mean_m"] == pytest.approx(0.4)
    assert found["sd_m"] == pytest.approx(np.sqrt((0.09 + 0.01 + 0.16) / 3))
    assert found["mean_squared_m"] == pytest.approx((0.01 + 0.09 + 0.64) / 3)
    assert found["median_deg"] == 2.0
    assert found["share_over_half_m"] == pytest.approx(1 / 3)
    assert summary([None]) == {"num": 0, "num_missed": 1}


def test_the_files_of_a_real_log_agree(tmp_path: Path) -> None:
    folder = os.environ.get("SHAPEMAP_DATASETS")
    if not folder:
        pytest.skip("SHAPEMAP_DATASETS is not set")
    log = Path(folder) / "slam-benchmark/aces.clf.gz"
    if not log.exists():
        pytest.skip(f"no {log}")
    files = (log.with_name("aces.relations"), log.with_name("aces.scan_relations"))
    spec = LogSpec("aces", "aces", "SICK", "relations", path=log, relations=files)
    by_time, by_index = load(spec, tmp_path, Path("/no/cli")).relations
    assert len(by_time.relations) == len(by_index.relations) == 1279
    assert [(r.first, r.second) for r in by_time.relations] == [(r.first, r.second) for r in by_index.relations]
