# SPDX-License-Identifier: GPL-3.0-or-later
"""The ray caster of long logs against the general one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from evaluation.common.poses import Array
from evaluation.simulation.arena import ArenaOptions, build_world
from evaluation.simulation.buildings import BuildingOptions, furnished_building, round_room
from evaluation.simulation.planar_raycast import SCANS_AT_ONCE, PlanarCaster
from evaluation.simulation.raycast import RayCaster
from evaluation.simulation.world import World

HEIGHT_M = 0.35


WORLDS: dict[str, Callable[[], World]] = {
    "building": lambda: furnished_building(3, BuildingOptions()),
    "arena with leaning boards and curved walls": lambda: build_world(4, ArenaOptions()),
    "inside of a circle": round_room,
    "nothing": lambda: World((5.0, 5.0)),
}


def random_poses(world: World, num: int) -> Array:
    rng = np.random.default_rng(7)
    return np.column_stack([rng.uniform([0.0, 0.0], world.size_m, (num, 2)), rng.uniform(-9.0, 9.0, num)])


@pytest.mark.parametrize("name", list(WORLDS))
@pytest.mark.parametrize(("first_deg", "step_deg", "num"), [(-90.0, 2.0, 91), (-179.0, 5.0, 72)])
def test_it_is_as_exact_as_the_general_one(name: str, first_deg: float, step_deg: float, num: int) -> None:
    world = WORLDS[name]()
    poses = random_poses(world, SCANS_AT_ONCE + 5)
    first, step = np.deg2rad(first_deg), np.deg2rad(step_deg)
    general = RayCaster(world)
    beams = first + step * np.arange(num)
    expected = [general.cast(pose[:2], HEIGHT_M, pose[2] + beams, np.zeros(num)) for pose in poses]
    found = PlanarCaster(world, HEIGHT_M).cast(poses, first, step, num)
    # A beam that grazes the end of a face may meet it by one and miss it by the other.
    assert (~np.isclose(found, np.array(expected), rtol=0.0, atol=1e-9)).mean() < 1e-4
