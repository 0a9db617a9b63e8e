# SPDX-License-Identifier: GPL-3.0-or-later
"""What keeps a laser from measuring the walls: beams that are lost, people that walk about, glass."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from evaluation.common.poses import Array

from .raycast import RayCaster
from .robot import Drive
from .sensor import SensorOptions, exact_ranges
from .streams import stream
from .world import Arc, World

PERSON_RADIUS_M = 0.25


def lose_beams(readings: Array, share: float, seed: int) -> Array:
    """Each beam is lost by itself."""
    return np.where(stream(seed, "lost beams").random(readings.shape) < share, np.nan, readings)


def lose_blocks(readings: Array, share: float, num_blocks: int, seed: int) -> Array:
    """In every sweep `num_blocks` runs of neighbouring beams are lost, together a `share` of them."""
    rng, beams = stream(seed, "lost blocks"), readings.shape[-1]
    kept = readings.copy()
    for index in np.ndindex(*readings.shape[:-1]):
        # The beams that stay are dealt out to the gaps between the blocks.
        lengths = np.diff(np.concatenate([[0], np.sort(rng.integers(0, round(share * beams), num_blocks - 1))]))
        lengths = np.append(lengths, round(share * beams) - lengths.sum())
        starts = np.sort(rng.integers(0, beams - lengths.sum() + 1, num_blocks))
        for start, before, length in zip(starts, np.cumsum(lengths) - lengths, lengths):
            kept[index][start + before : start + before + length] = np.nan
    return kept


def at_position(drive: Drive, index: int) -> Drive:
    """The drive's one position, by itself."""
    one = slice(index, index + 1)
    return replace(
        drive,
        timestamps_s=drive.timestamps_s[one],
        map_from_robot=drive.map_from_robot[one],
        map_from_sub_scan=drive.map_from_sub_scan[one],
        gradient=drive.gradient[one],
    )


def ranges_with_crowd(
    exact: Array, drive: Drive, sensor: SensorOptions, share: float, seed: int
) -> tuple[Array, list[list[Arc]]]:
    """`exact` with people in front of `share` of the beams that met anything, or up to 0.05 more; and the people: at
    each position others, 0.6 m to 4 m away and nowhere behind a wall."""
    ranges, crowds = exact.copy(), []
    rng = stream(seed, "crowd")
    for k, pose in enumerate(drive.map_from_robot):
        people: list[Arc] = []
        seen, here = np.isfinite(exact[k]), at_position(drive, k)
        for _ in range(1000):
            sub_scan, beam = (int(rng.integers(0, n)) for n in exact[k].shape)
            away = rng.uniform(0.6, 4.0)
            if away + PERSON_RADIUS_M > exact[k, sub_scan, beam]:
                continue
            angle = drive.map_from_sub_scan[k, sub_scan, 2] + sensor.beam_angles_rad()[beam]
            centre = pose[:2] + away * np.array([np.cos(angle), np.sin(angle)])
            person = Arc((float(centre[0]), float(centre[1])), PERSON_RADIUS_M, top_m=1.8, kind="person")
            caster = RayCaster(World((0.0, 0.0), arcs=[person]))
            nearer = np.minimum(ranges[k], exact_ranges(caster, here, sensor)[0])
            hidden = (nearer < exact[k])[seen].mean()
            if hidden <= share + 0.05:
                ranges[k] = nearer
                people.append(person)
            if share <= hidden <= share + 0.05:
                break
        crowds.append(people)
    return ranges, crowds


def ranges_with_glass(world: World, drive: Drive, sensor: SensorOptions, through: float, seed: int) -> Array:
    """Exact ranges in a world with faces of kind "glass". A beam that meets one comes back from behind it with
    probability `through`, and otherwise not at all."""
    hard = replace(world, faces=[face for face in world.faces if face.kind != "glass"])
    behind = exact_ranges(RayCaster(hard), drive, sensor)
    met: NDArray[np.bool_] = exact_ranges(RayCaster(world), drive, sensor) < behind
    passed = stream(seed, "glass").random(met.shape) < through
    return np.where(met & ~passed, np.inf, behind)
