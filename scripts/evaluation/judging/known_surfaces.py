# SPDX-License-Identifier: GPL-3.0-or-later
"""What scans tell to one who knows which beam met which face: all sub-scans laid together by least squares. Round
things and boards that lean are left out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from evaluation.common.poses import Array, rotate
from evaluation.simulation.raycast import RayCaster
from evaluation.simulation.simulation import Simulation

LEAST_BEAMS = 3  # of a sub-scan, to count as seeing a face
LEAST_INCIDENCE = 0.15  # sine of the angle between beam and face, below which noise is not taken to shrink any more
NEARLY_FREE = 1e-4  # information that keeps the whole map, which nothing holds, where it is
ITERATIONS = 8

Indices = NDArray[np.int64]


@dataclass(frozen=True)
class SeenFace:
    """Points `[n, 2]` of one sub-scan on one face, in the frame of its position at the nominal heading."""

    sub_scan: int
    points: Array


def seen_faces(simulation: Simulation) -> list[list[SeenFace]]:
    """For each upright flat face that several sub-scans see, what they see of it. Which beam met which face is the
    simulation's knowledge; ranges are those that the sensor gave."""
    caster, run, sensor = RayCaster(simulation.world), simulation.drive, simulation.options.sensor
    beams, faces = sensor.beam_angles_rad(), simulation.world.faces
    seen: dict[int, list[SeenFace]] = {}
    for place in np.ndindex(*run.map_from_sub_scan.shape[:2]):
        pose, ranges = run.map_from_sub_scan[place], simulation.ranges[place]
        angles = pose[2] + beams
        slopes = run.gradient[place] @ np.stack([np.cos(angles), np.sin(angles)])
        hit = np.where(np.isfinite(ranges), caster.face_hit(pose[:2], sensor.height_m, angles, slopes), -1)
        bearings = beams + run.nominal_headings_rad[place[1]]
        points = ranges[:, None] * np.stack([np.cos(bearings), np.sin(bearings)], axis=-1)
        for face in np.unique(hit[hit >= 0]):
            if faces[face].slant == 0.0 and (hit == face).sum() >= LEAST_BEAMS:
                index = int(np.ravel_multi_index(place, run.map_from_sub_scan.shape[:2]))
                seen.setdefault(int(face), []).append(SeenFace(index, points[hit == face]))
    return [views for views in seen.values() if len(views) > 1]


@dataclass
class NormalEquations:
    """Over steps of all poses: `information` `[n, n]`, `gradient` `[n]`."""

    information: Array
    gradient: Array

    def add(self, rows: Indices, jacobian: Array, residuals: Array) -> None:
        self.information[np.ix_(rows, rows)] += jacobian.T @ jacobian
        self.gradient[rows] += jacobian.T @ residuals


def fitted_line(points: Array, weights: Array) -> tuple[Array, Array]:
    """Middle and direction of the line through points `[n, 2]`."""
    middle = (points * weights[:, None]).sum(axis=0) / weights.sum()
    offsets = points - middle
    _, axes = np.linalg.eigh((offsets * weights[:, None]).T @ offsets)
    return middle, axes[:, 1]


def add_face(views: list[SeenFace], poses: Array, sigma_m: float, equations: NormalEquations) -> None:
    """All points of a face lie on one line, wherever it is: its offset and its angle are eliminated (Schur)."""
    placed = [rotate(view.points, poses[view.sub_scan][2]) + poses[view.sub_scan][:2] for view in views]
    owners = np.concatenate([np.full(len(view.points), view.sub_scan) for view in views])
    points = np.concatenate(placed)
    levers = points - poses[owners, :2]
    beams = levers / np.hypot(*levers.T)[:, None]
    weights = np.ones(len(points))
    for _ in range(3):  # noise is along the beam, so that the direction of the line weighs the points
        middle, along = fitted_line(points, weights)
        normal = np.array([-along[1], along[0]])
        sigma = sigma_m * np.maximum(np.abs(beams @ normal), LEAST_INCIDENCE)
        weights = 1.0 / sigma**2
    residuals = ((points - middle) @ normal) / sigma
    by_line = -np.stack([np.ones(len(points)), (points - middle) @ along], axis=-1) / sigma[:, None]
    turning = levers[:, 0] * normal[1] - levers[:, 1] * normal[0]
    by_pose = np.column_stack([np.tile(normal, (len(points), 1)), turning]) / sigma[:, None]
    sub_scans = np.array([view.sub_scan for view in views], dtype=np.int64)
    jacobian = np.zeros((len(points), 3 * len(views)))
    for column, sub_scan in enumerate(sub_scans):
        mine = owners == sub_scan
        jacobian[mine, 3 * column : 3 * column + 3] = by_pose[mine]
    basis, _ = np.linalg.qr(by_line)
    rows = (3 * sub_scans[:, None] + np.arange(3)).ravel()
    equations.add(rows, jacobian - basis @ (basis.T @ jacobian), residuals - basis @ (basis.T @ residuals))


def laid_together(simulation: Simulation) -> dict[int, Array]:
    """The poses of all positions, from where the robot meant to stand on."""
    run, robot = simulation.drive, simulation.options.robot
    num_positions, num_sub_scans = run.map_from_sub_scan.shape[:2]
    num = num_positions * num_sub_scans
    faces = seen_faces(simulation)
    owner = np.repeat(np.arange(num_positions), num_sub_scans)
    poses = np.concatenate([run.map_from_robot[owner], run.map_from_robot])  # sub-scans, then positions
    sigmas = [robot.sub_scan_centre_sigma_m] * 2 + [np.deg2rad(robot.sub_scan_heading_sigma_deg)]
    tie = np.diag(1.0 / np.maximum(sigmas, 1e-6))
    for _ in range(ITERATIONS):
        size = poses.size
        equations = NormalEquations(NEARLY_FREE * np.eye(size), np.zeros(size))
        for views in faces:
            add_face(views, poses, simulation.options.sensor.range_sigma_m, equations)
        for sub_scan, position in enumerate(num + owner):
            rows = np.concatenate([3 * sub_scan + np.arange(3), 3 * position + np.arange(3)])
            equations.add(rows, np.hstack([tie, -tie]), tie @ (poses[sub_scan] - poses[position]))
        poses = poses - np.linalg.solve(equations.information, equations.gradient).reshape(poses.shape)
    return dict(enumerate(poses[num:]))
