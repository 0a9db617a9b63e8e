# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of data sets, and what programs and judge get of a log."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evaluation.common.project import PROJECT
from evaluation.logs.datasets import DatasetError, LogSpec, read_datasets, select
from evaluation.logs.evaluation_log import load, renumbered
from evaluation.maps.methods import ALL, parse_method, with_feeds
from evaluation_support import ODOMETRY, carmen_text, line_log

NO_CLI = Path("/no/cli")


def declare(folder: Path, text: str) -> Path:
    path = folder / "datasets.toml"
    path.write_text(text, encoding="utf-8")
    return path


def entry(**fields: object) -> str:
    values = {"name": "a", "path": "a.log", "sensor": "SICK", "reference": "slam"} | fields
    lines = [f"{key} = {value!r}".replace("True", "true") for key, value in values.items() if value is not None]
    return "[[dataset]]\n" + "\n".join(lines) + "\n"


def test_the_projects_own_file_is_valid_and_its_demo_there() -> None:
    specs = read_datasets(PROJECT / "datasets/datasets.toml", None)
    (demo,) = select(specs, ["demo"])
    assert not demo.missing
    assert len(select(specs, ["arena"])) == 20
    assert [spec.name for spec in select(specs, ["arena-003"])] == ["arena-003"]
    missing = [spec.name for spec in specs if spec.missing]
    assert "intel" in missing
    assert "demo" not in missing


def test_seeds_and_folder_are_given(tmp_path: Path) -> None:
    arena = entry(name="b", path=None, simulate="arena", seeds="0-4", spacing_m=2.0)
    specs = read_datasets(declare(tmp_path, entry() + arena), tmp_path / "logs", [7, 9])
    assert [spec.name for spec in specs] == ["a", "b-007", "b-009"]
    assert specs[0].path == tmp_path / "logs/a.log"
    assert specs[1].arena == {"spacing_m": 2.0}
    assert {spec.group for spec in specs[1:]} == {"b"}


def test_relations_beside_a_log_are_found(tmp_path: Path) -> None:
    (tmp_path / "a.relations").touch()
    text = entry(path="a.clf.gz", reference="relations")
    (spec,) = read_datasets(declare(tmp_path, text), tmp_path)
    assert spec.relations == (tmp_path / "a.relations",)
    assert spec.missing == [tmp_path / "a.clf.gz"]
    (named,) = read_datasets(declare(tmp_path, text + "relations = ['b.relations']\n"), tmp_path)
    assert named.missing == [tmp_path / "a.clf.gz", tmp_path / "b.relations"]


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("[[dataset]\n", "datasets.toml"),
        ("", "no data set"),
        (entry() + entry(), "twice: a"),
        (entry(reference="good"), "data set 1 (a): reference 'good'"),
        (entry(sensor=None), "data set 1 (a): no sensor"),
        (entry(spacing=2), "unknown spacing"),
        (entry(path=None), "expected either path or simulate"),
        (entry(path=None, simulate="maze"), "simulate 'maze', expected arena"),
        (entry(root="home"), "root 'home'"),
        (entry(reference="none", reference_file="a.tum"), "a reference_file, but reference is 'none'"),
    ],
)
def test_a_wrong_file_of_data_sets_is_refused(tmp_path: Path, text: str, what: str) -> None:
    with pytest.raises(DatasetError) as caught:
        read_datasets(declare(tmp_path, text), None)
    assert what in str(caught.value)
    assert "datasets.toml" in str(caught.value)


def test_a_name_that_there_is_not_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="no data set x; there are a"):
        select(read_datasets(declare(tmp_path, entry()), None), ["x"])


def test_programs_get_no_pose_no_odometry_and_times_of_their_own(tmp_path: Path) -> None:
    log = line_log(tmp_path)
    text = log.write_stripped(tmp_path).read_text(encoding="utf-8")
    assert ODOMETRY not in text
    assert "ODOM" not in text
    assert [line.split()[182:] for line in text.splitlines()] == [
        [*["0"] * 6, f"{k}.0", "host", f"{k}.0"] for k in range(1, 7)
    ]
    assert log.reference is not None
    assert list(log.reference[:, 0]) == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]


def test_a_log_without_reference_gives_none_although_it_has_poses(tmp_path: Path) -> None:
    assert line_log(tmp_path, "none").reference is None


def test_every_second_scan_and_the_first_so_many(tmp_path: Path) -> None:
    log = line_log(tmp_path, every=2, first=2)
    assert log.reference is not None
    assert list(log.reference[:, 0]) == [0.0, 2.0]
    assert len(log.content.points) == 2
    assert log.content.without_poses.count("FLASER") == 2
    times, text = renumbered(log.content.without_poses)
    assert times == [1.0, 2.0]
    assert text == log.content.without_poses


def test_positions_of_a_scan_log_are_left_out_with_their_scans() -> None:
    text = "shapemap-scans 1\nsensor s\nposition 5.5\nscan a\nscan b\nposition 6.5\nscan c\nscan d\n"
    times, kept = renumbered(text, 1, 1)
    assert times == [5.5, 6.5]
    assert kept == "shapemap-scans 1\nsensor s\nposition 1.0\nscan a\nscan b\n"


def test_times_of_beams_keep_their_share_of_the_time_between_scans() -> None:
    scans = "".join(f"position {0.2 * i}\nscan ring heading 0 time 0.02 ranges 1 2\n" for i in range(4))
    text = f"shapemap-scans 2\nsensor ring beams 2 angle_step 1 time_step 0.001\n{scans}"
    _, kept = renumbered(text)
    assert "time_step 0.005\n" in kept
    assert kept.count(" time 0.1 ranges 1 2\n") == 4
    _, thinned = renumbered(text, 2)
    assert "time_step 0.0025\n" in thinned


def test_the_checksum_is_that_of_readings_and_references(tmp_path: Path) -> None:
    log = line_log(tmp_path)
    again = line_log(tmp_path)
    assert log.sha256 == again.sha256
    assert line_log(tmp_path, "none").sha256 != log.sha256
    path = tmp_path / "line.log"
    for old, new in ((" 2.05 ", " 2.06 "), (" 3.0 0.0 0.0 ", " 3.0 0.1 0.0 ")):
        path.write_text(carmen_text().replace(old, new), encoding="utf-8")
        assert load(log.spec, tmp_path, NO_CLI).sha256 != log.sha256


@pytest.mark.parametrize(("old", "new"), [(" 3.0 0.0 0.0 ", " 3.0 x 0.0 "), (" 3.0 0.0 0.0 ", " 3.0 nan 0.0 ")])
def test_a_malformed_reference_names_file_and_line(tmp_path: Path, old: str, new: str) -> None:
    log = line_log(tmp_path)
    (tmp_path / "line.log").write_text(carmen_text().replace(old, new), encoding="utf-8")
    with pytest.raises(DatasetError, match=r"line\.log:8: "):
        load(log.spec, tmp_path, NO_CLI)


def test_a_malformed_reference_of_a_scan_log_names_file_and_line(tmp_path: Path) -> None:
    path = tmp_path / "a.nist"
    sensor = "sensor laser beams 2 first_angle 0 angle_step 90 max_range 20"
    for position in ("position 1 reference 1 2", "position 1 reference 1 2 x", "position 1 reference 1 2 inf"):
        text = f"shapemap-scans 1\nunits m deg\n{sensor}\n{position}\nscan laser heading 0 ranges 1 2\n"
        path.write_text(text, encoding="utf-8")
        with pytest.raises(DatasetError, match=r"a\.nist:4: "):
            load(LogSpec("a", "a", "", "exact", path=path), tmp_path, NO_CLI)


def test_references_may_be_in_a_file_of_their_own(tmp_path: Path) -> None:
    path = tmp_path / "poses.tum"
    lines = [f"{k + 10}.5 {k} 7 0 0 0 {np.sin(0.3)} {np.cos(0.3)}\n" for k in reversed(range(6))]
    path.write_text("# t x y z qx qy qz qw\n" + "".join(lines), encoding="utf-8")
    log = line_log(tmp_path, reference_file=path, every=2)
    assert log.reference == pytest.approx(np.array([[0.0, 7.0, 0.6], [2.0, 7.0, 0.6], [4.0, 7.0, 0.6]]))
    assert log.content.ref_from_query(0, 1)[2] == pytest.approx(0.0)
    for text, what in (
        ("".join(lines[1:]), ": no pose for 1 scans; the first is 5, 15.5 s"),
        ("".join(lines) + "1 2 3\n", ":7: expected t x y z qx qy qz qw"),
        ("".join(lines) + "1 nan 0 0 0 0 0 1\n", ":7: not finite"),
    ):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(DatasetError) as caught:
            line_log(tmp_path, reference_file=path)
        assert f"{path}{what}" in str(caught.value)


def test_an_arena_is_simulated_with_its_options(tmp_path: Path) -> None:
    spec = LogSpec("x-003", "x", "", "exact", seed=3, arena={"positions": 3, "heading_uncertainty_deg": 180})
    log = load(spec, tmp_path, NO_CLI)
    assert log.reference is not None
    assert len(log) == 3
    assert np.ptp(log.reference[:, 2]) > 0.2, "headings are anything"
    assert "reference" not in log.content.without_poses
    assert load(replace(spec, seed=4), tmp_path, NO_CLI).sha256 != log.sha256


def test_methods_come_with_those_that_feed_them() -> None:
    assert [m.name for m in with_feeds(["vasco+paper", "mrpt-icp"])] == ["paper", "mrpt-icp", "vasco+paper"]
    assert [m.name for m in with_feeds(["mrpt-rbpf+covariances"])] == ["robust", "mrpt-rbpf+covariances"]
    assert [m.name for m in with_feeds(list(reversed(ALL)))] == list(ALL)
    assert parse_method("mrpt-rbpf+covariances").needs_covariances
    for name in ("best", "robust+paper", "mrpt-icp+covariances", "vasco+", "+robust", ""):
        with pytest.raises(ValueError, match="no method"):
            parse_method(name)
