# SPDX-License-Identifier: GPL-3.0-or-later
"""What beams tell to one who knows what they met, on arenas where it is known what that is."""

from __future__ import annotations

import numpy as np
import pytest

from evaluation.judging.known_surfaces import laid_together, seen_faces
from evaluation.judging.whole_maps import fragment_errors, mean_of_sub_scans
from evaluation.simulation.raycast import RayCaster
from evaluation.simulation.robot import RobotOptions
from evaluation.simulation.sensor import SensorOptions
from evaluation.simulation.simulation import Simulation, SimulationOptions, simulate


def arena(num_positions: int, noise_m: float, heading_sigma_deg: float = 0.7) -> Simulation:
    robot = RobotOptions(
        num_positions=num_positions,
        heading_uncertainty_deg=180.0,
        tilt_sigma_deg=0.0,
        sub_scan_heading_sigma_deg=heading_sigma_deg,
    )
    return simulate(SimulationOptions(3, robot=robot, sensor=SensorOptions(range_sigma_m=noise_m)))


def largest_errors(simulation: Simulation) -> tuple[float, float]:
    """Of the poses that are found, against what the true poses of the sub-scans say."""
    truth = np.array(list(mean_of_sub_scans(simulation.drive).values()))
    errors = fragment_errors(laid_together(simulation), truth)
    return float(errors.errors_m.max()), float(errors.errors_deg.max())


def test_what_a_beam_meets_is_as_far_as_the_beam_goes() -> None:
    simulation = arena(1, 0.001)
    caster, height_m = RayCaster(simulation.world), simulation.options.sensor.height_m
    origin, angles = simulation.drive.map_from_robot[0, :2], np.linspace(-np.pi, np.pi, 500)
    ranges, hit = (cast(origin, height_m, angles, np.zeros(500)) for cast in (caster.cast, caster.face_hit))
    assert (hit >= 0).sum() > 250
    for face in np.unique(hit[hit >= 0]):
        surface = simulation.world.faces[face]
        if surface.slant:
            continue
        start, end = np.array(surface.start), np.array(surface.end)
        met = origin + ranges[hit == face, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)[hit == face]
        normal = np.array([start[1] - end[1], end[0] - start[0]]) / np.hypot(*(end - start))
        assert (met - start) @ normal == pytest.approx(0.0, abs=1e-9)


def test_each_face_is_seen_by_several() -> None:
    faces = seen_faces(arena(3, 0.015))
    assert len(faces) > 10
    for views in faces:
        assert len({view.sub_scan for view in views}) == len(views) > 1


def test_without_noise_the_sub_scans_are_where_they_truly_stood() -> None:
    off_m, off_deg = largest_errors(arena(4, 1e-4))
    assert off_m < 0.004 and off_deg < 0.08


def test_noise_leaves_errors_of_its_own() -> None:
    exact, noisy = largest_errors(arena(4, 1e-4)), largest_errors(arena(4, 0.015))
    assert exact[1] < noisy[1] < 0.7, "less than the sub-scans err"
