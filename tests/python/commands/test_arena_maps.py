# SPDX-License-Identifier: GPL-3.0-or-later
"""Judging whole arena maps: made-up maps with known mistakes, and the program around a made-up mapper."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evaluation.commands import arena_maps as arena_maps_command
from evaluation.common.poses import Array, best_motion, compose, inverse
from evaluation.common.tum import read_tum
from evaluation.judging.whole_maps import (
    fragment_errors,
    judge,
    link_outcomes,
    links_table,
    lost_map,
    mean_of_sub_scans,
    not_right,
    summary,
)
from evaluation.simulation.robot import RobotOptions, drive
from evaluation.simulation.simulation import SimulationOptions, simulate
from evaluation.simulation.write import tum_text

ELSEWHERE = np.array([3.0, -7.0, np.deg2rad(130)])


@pytest.fixture(name="truth")
def made_up_truth() -> Array:
    rng = np.random.default_rng(1)
    return np.column_stack([np.arange(8.0), rng.uniform(-2, 2, 8), rng.uniform(-np.pi, np.pi, 8)])


def moved(poses: Array, motion: Array = ELSEWHERE) -> dict[int, Array]:
    """Those poses that are not NaN, in a frame of their own."""
    return {k: compose(motion, pose) for k, pose in enumerate(poses) if np.isfinite(pose).all()}


def test_the_best_motion_is_the_one_that_was_made(truth: Array) -> None:
    found = np.array(list(moved(truth).values()))
    assert compose(best_motion(found, truth), ELSEWHERE) == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


def test_the_best_motion_leaves_less_than_any_other(truth: Array) -> None:
    rng = np.random.default_rng(2)
    found = truth + rng.normal(0.0, 0.1, truth.shape)

    def squares(motion: Array) -> float:
        return float(((compose(motion, found)[:, :2] - truth[:, :2]) ** 2).sum())

    best = best_motion(found, truth)
    others = [squares(best + rng.normal(0.0, 0.01, 3)) for _ in range(200)]
    assert squares(best) < min(others)


def test_a_single_position_is_always_right(truth: Array) -> None:
    errors = fragment_errors({3: np.array([9.0, 9.0, 1.0])}, truth)
    assert (errors.errors_m[0], errors.errors_deg[0]) == pytest.approx((0.0, 0.0), abs=1e-9)


@pytest.mark.parametrize(
    ("change", "verdict"),
    [
        ([0.0, 0.0, 0.0], "right"),
        ([0.08, 0.0, 0.0], "right"),
        ([0.2, 0.0, 0.0], "inexact"),
        ([0.0, 0.0, np.deg2rad(0.9)], "right"),
        ([0.0, 0.0, np.deg2rad(-1.1)], "inexact"),
        ([0.0, 0.0, np.deg2rad(6.0)], "wrong"),
        ([0.0, 0.5, 0.0], "wrong"),
    ],
)
def test_one_position_that_is_off_decides(truth: Array, change: list[float], verdict: str) -> None:
    found = truth.copy()
    found[4] += change
    assert judge(0, truth, [moved(found)]).verdict == verdict


def test_pieces_are_judged_each_by_its_own_motion(truth: Array) -> None:
    whole = moved(truth)
    pieces = [{k: p for k, p in whole.items() if k < 5}, moved(truth, np.array([0.0, 0.0, 1.0]))]
    pieces[1] = {k: p for k, p in pieces[1].items() if k >= 5}
    one = judge(0, truth, pieces)
    assert (one.verdict, one.sizes, one.whole) == ("in pieces", [5, 3], False)
    assert one.max_error_m == pytest.approx(0.0, abs=1e-9)
    pieces[1][6] = pieces[1][6] + [1.0, 0.0, 0.0]
    assert judge(0, truth, pieces).verdict == "wrong"


def test_positions_without_a_place_make_no_whole_map(truth: Array) -> None:
    found = truth.copy()
    found[2] = np.nan
    assert judge(0, truth, [moved(found)]).verdict == "in pieces"


def test_the_table_counts_each_map(truth: Array) -> None:
    off = truth.copy()
    off[1, 2] += np.deg2rad(2)
    maps = [judge(0, truth, [moved(truth)]), judge(1, truth, [moved(off)]), lost_map(2, 8, "crashed")]
    counts = [int(line.split("|")[2]) for line in summary(maps).splitlines()[2:]]
    assert counts == [1, 1, 2, 0, 0, 1]
    first, second = not_right(maps).splitlines()
    assert first.startswith("seed 1: inexact, 8 of 8 positions, at most 0.000 m, 2.00 deg off")
    assert second == "seed 2: no map, none of 8 positions, crashed"


def test_trajectories_are_read_as_they_were_written(tmp_path: Path) -> None:
    simulation = simulate(SimulationOptions(seed=2, robot=RobotOptions(num_positions=3, heading_uncertainty_deg=180)))
    (tmp_path / "t.tum").write_text("# comment\n" + tum_text(simulation), encoding="utf-8")
    read = read_tum(tmp_path / "t.tum")
    assert [time for time, _ in read] == list(simulation.drive.timestamps_s)
    assert np.array([pose for _, pose in read]) == pytest.approx(simulation.drive.map_from_robot, abs=1e-6)


def test_the_ceiling_is_what_the_errors_of_four_sub_scans_leave() -> None:
    options = RobotOptions(num_positions=16, heading_uncertainty_deg=180, sub_scan_tilt_share=0.0)
    route = np.array([[0.0, 0.0], [40.0, 0.0]])
    drives = [drive(seed, route, options) for seed in range(40)]
    errors = [fragment_errors(mean_of_sub_scans(one), one.map_from_robot) for one in drives]
    root_mean_square = np.sqrt(np.mean([e.errors_deg**2 for e in errors]))
    assert root_mean_square == pytest.approx(options.sub_scan_heading_sigma_deg / 2, rel=0.1)


def made_up_mapper(folder: Path) -> Path:
    """Knows the truth from the log; turns the last position by 3 degrees, or makes a fragment of it."""
    program = folder / "mapper"
    body = f"""#!{sys.executable}
import json, math, pathlib, sys
of = lambda name: pathlib.Path(sys.argv[sys.argv.index(name) + 1])
lines = []
for line in pathlib.Path(sys.argv[1]).read_text().splitlines():
    f = line.split()
    if f and f[0] == 'position':
        x, y, deg = map(float, f[3:6])
        lines.append([float(f[1]), x, y, math.radians(deg)])
split = '--split' in sys.argv
if not split:
    lines[-1][3] += math.radians(3)
tum = lambda rows: ''.join(f'{{t}} {{x}} {{y}} 0 0 0 {{math.sin(a / 2)}} {{math.cos(a / 2)}}\\n' for t, x, y, a in rows)
of('--trajectory').write_text(tum(lines[:-1] if split else lines))
of('--fragments').mkdir()
if split:
    (of('--fragments') / 'fragment_1.tum').write_text(tum(lines[-1:]))
of('--report').write_text(json.dumps({{'seconds': {{'wall': 0.5}}}}))
"""
    program.write_text(body, encoding="utf-8")
    program.chmod(0o755)
    return program


@pytest.mark.parametrize(("extra", "verdict"), [([], "inexact"), (["--arg=--split"], "in pieces")])
def test_program_says_what_became_of_each_map(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], extra: list[str], verdict: str
) -> None:
    pytest.importorskip("matplotlib")
    arguments = ["--seeds", "5", "--positions", "4", "--jobs", "1", "--cli", str(made_up_mapper(tmp_path))]
    arguments += ["--json", str(tmp_path / "m.json"), "--pictures", str(tmp_path / "pictures"), *extra]
    assert arena_maps_command.main(arguments) == 0
    assert f"seed 5: {verdict}" in capsys.readouterr().out
    one = json.loads((tmp_path / "m.json").read_text(encoding="utf-8"))["maps"][0]
    assert (one["seed"], one["verdict"], one["seconds"]) == (5, verdict, 0.5)
    assert one["max_error_deg"] == pytest.approx(0.0 if extra else 3.0, abs=0.01)
    assert [path.name for path in (tmp_path / "pictures").iterdir()] == ["seed005.png"]


def test_the_ceiling_needs_no_mapper(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--seeds", "5", "--positions", "3", "--jobs", "1", "--heading-sigma-deg", "0", "--ceiling"]
    assert arena_maps_command.main([*arguments, "--cli", str(tmp_path / "none")]) == 0
    assert "| whole, and all within 10 cm and 1 deg | 1 |" in capsys.readouterr().out


@pytest.mark.parametrize("ceiling", ["sub-scans", "beams"])
def test_what_may_be_known_at_most_is_a_choice(ceiling: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert arena_maps_command.main(["--seeds", "5", "--positions", "3", "--jobs", "1", "--ceiling", ceiling]) == 0
    assert "| whole, and all within 30 cm and 5 deg | 1 |" in capsys.readouterr().out


def reported(truth: Array, index: int, off_deg: float, fragment: int = 0, probability: float = 0.9) -> dict[str, Any]:
    """An alignment to the position before, as a report has it."""
    pose = compose(compose(inverse(truth[index - 1]), truth[index]), np.array([0.0, 0.0, np.deg2rad(off_deg)]))
    found = {"x_m": pose[0], "y_m": pose[1], "theta_deg": np.rad2deg(pose[2])}
    alignment = {"reference": index - 1, "ref_from_query": found, "probability": probability}
    return {"index": index, "component": fragment, "alignment": alignment}


def test_links_of_the_map_are_right_or_not(truth: Array) -> None:
    positions = [{"index": 0, "component": 0, "alignment": None}, reported(truth, 1, 2.0), reported(truth, 2, 20.0)]
    positions += [reported(truth, 3, 20.0, fragment=1), {"index": 4, "component": 1, "alignment": {"reference": 3}}]
    outcomes = link_outcomes(positions, truth)
    assert outcomes == [(0.9, True), (0.9, False)], "what is not in the map does not count"
    maps = [judge(1, truth, [moved(truth)], links=outcomes), judge(2, truth, [moved(truth)], links=[(1.0, True)])]
    assert "| 0.5 to 0.92 | 2 | 1, 50.0 % | 90.0 % |" in links_table(maps)
    assert "| 0.99 to 1 | 1 | 1, 100.0 % | 100.0 % |" in links_table(maps)
    assert links_table([judge(3, truth, [moved(truth)])]) == ""


def test_program_counts_a_crashed_mapper(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "mapper"
    program.write_text(f"#!{sys.executable}\nimport sys\nsys.exit('out of luck')\n", encoding="utf-8")
    program.chmod(0o755)
    assert arena_maps_command.main(["--seeds", "5", "--positions", "3", "--jobs", "1", "--cli", str(program)]) == 1
    assert "seed 5: no map, none of 3 positions, exit code 1: out of luck" in capsys.readouterr().out
