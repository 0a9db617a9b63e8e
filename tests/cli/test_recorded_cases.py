# SPDX-License-Identifier: GPL-3.0-or-later
"""Logs of other programs through scripts/convert_logs.py and the mapper. The files lie beside the real logs: a walk of
150 scans in a made-up building, recorded in ways that other readers of bags stumble over."""
import gzip
import os
import pathlib
import subprocess
import sys
import tarfile

import numpy as np
import patience
import pytest
from mapping_checks import poses_by_time, read_tum

pytest.importorskip("rosbags")

CONVERTER = pathlib.Path(__file__).parents[2] / "scripts" / "convert_logs.py"
WALK = "bag-variable-beam-counts.tum"  # the same walk in all of them
SOME_NOT_PLACED = 4  # exit code
REAR = ("--mount", "scan_front=0,0,0,0,0,0", "--mount", "scan_rear=0,0,0,180,0,0")


@pytest.fixture
def case(tmp_path):
    """A case by name, decompressed unless it ends with .gz."""
    folder = os.environ.get("SHAPEMAP_DATASETS")
    if not folder or not (pathlib.Path(folder).parent / "cases").is_dir():
        pytest.skip("no folder `cases` beside SHAPEMAP_DATASETS, so logs of other programs are not tested")

    def find(name):
        zipped = pathlib.Path(folder).parent / "cases" / f"{name.removesuffix('.gz')}.gz"
        path = tmp_path / name
        path.write_bytes(zipped.read_bytes() if name.endswith(".gz") else gzip.decompress(zipped.read_bytes()))
        return path

    return find


def convert(log, *options):
    """The converted log, and what was said."""
    out = log.with_name("converted.nist")
    done = subprocess.run(
        [sys.executable, CONVERTER, *options, log, out], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    return out, done.stderr


def ate_m(truth, found):
    """Root mean square of the distances after the rigid fit, over the times that both have."""
    times = sorted(set(truth) & set(found))
    wanted, got = (np.array([poses[t][:2] for t in times]) for poses in (truth, found))
    wanted, got = wanted - wanted.mean(0), got - got.mean(0)
    u, _, vt = np.linalg.svd(got.T @ wanted)
    turn = u @ np.diag([1.0, np.linalg.det(u @ vt)]) @ vt
    return float(np.sqrt(((got @ turn - wanted) ** 2).sum(1).mean()))


def by_rounded_time(path):
    return {round(time, 3): pose for time, pose in poses_by_time(read_tum(path)).items()}


def check_walk(run, case, log, num_placed, max_ate_m, code=0, walk=WALK):
    done = run(log, "--out", "map.png", "--trajectory", "walk.tum")
    assert done.returncode == code, done.stderr
    truth_path = case(walk)
    found, truth = by_rounded_time(truth_path.with_name("walk.tum")), by_rounded_time(truth_path)
    assert len(found) == num_placed
    assert len(set(found) & set(truth)) >= num_placed - 1  # points have times of their own
    assert ate_m(truth, found) < max_ate_m


@patience.without_sanitizers
@pytest.mark.parametrize(
    ("name", "options", "num_placed", "max_ate_m", "says"),
    [
        ("bag-variable-beam-counts.bag", (), 150, 0.03, "150 scans of 340 to 380 beams"),
        ("bag-variable-beam-counts.bag.gz", (), 150, 0.03, "150 scans of 340 to 380 beams"),
        ("bag-angle-min-varies.bag", (), 150, 0.03, "the first angle varies from scan to scan"),
        ("bag-empty-scan.bag", (), 146, 0.03, "4 of them without readings"),
        ("bag-cut-off.bag", (), 100, 0.03, "the bag is cut off at byte 158952, after 100 messages"),
        ("bag-range-max-inf.bag", (), 150, 0.03, "150 of 150 have no maximum range"),
        ("bag-range-max-zero.bag", (), 150, 0.03, "150 of 150 have no maximum range"),
        ("bag-stamps-zero.bag", (), 60, 0.03, "the times at which the messages were received are used"),
        ("bag-upside-down.bag", ("--mount", "scan=0,0,0,0,0,180"), 150, 0.03, "150 scans of 360 beams"),
        ("bag-two-lasers.bag", REAR, 100, 0.03, "200 scans of 2 lasers make 100 positions"),
        ("bag-multi-echo.bag", (), 50, 0.03, "the first counts"),
        ("bag-outlier-900m.bag", (), 80, 0.03, "80 scans of 360 beams"),
        ("csv-rostopic-echo.csv", (), 100, 0.03, "100 scans of 360 beams"),
        ("csv-rplidar-points.csv", (), 60, 0.03, "60 scans of 301 to 320 beams"),
    ],
)
def test_a_recorded_walk_is_mapped_right(run, case, name, options, num_placed, max_ate_m, says):
    log, said = convert(case(name), *options)
    assert says in said
    check_walk(run, case, log, num_placed, max_ate_m, SOME_NOT_PLACED if "without readings" in said else 0)


@patience.without_sanitizers
@pytest.mark.parametrize("is_folder", [True, False])
def test_a_ros2_bag_is_mapped_right(run, case, tmp_path, is_folder):
    with tarfile.open(case("ros2-bag-db3.tar")) as archive:
        archive.extractall(tmp_path, filter="data")
    folder = tmp_path / "ros2_db3"
    log, said = convert(folder if is_folder else folder / "ros2_db3.db3")
    assert "60 scans of 360 beams" in said
    check_walk(run, case, log, 60, 0.03)


@patience.without_sanitizers
def test_a_walk_whose_sweeps_are_bent_is_straightened(run, case):
    log, _ = convert(case("bag-handheld-sweep-distortion.bag"))
    check_walk(run, case, log, 283, 0.015, walk="bag-handheld-sweep-distortion.tum")


@patience.without_sanitizers
def test_a_code_for_no_return_is_no_wall(run, case):
    log = case("carmen-no-return-65.533.log")
    assert "no returns  65.533 m" in run("info", log).stdout
    check_walk(run, case, log, 300, 0.06, walk="carmen-no-return.tum")


@patience.without_sanitizers
def test_one_false_reading_does_not_make_a_large_picture(run, case, tmp_path):
    log, _ = convert(case("bag-outlier-900m.bag"))
    assert "1 of 28587 returns lies outside of the picture" in run(log, "--out", "map.pgm").stderr
    width, height = (int(number) for number in (tmp_path / "map.pgm").read_bytes().split(maxsplit=3)[1:3])
    assert width < 400 and height < 400
