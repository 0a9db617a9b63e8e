# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that are hard for any mapper, and what is to be expected of it in each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from evaluation.simulation.buildings import BuildingOptions, bare_corridor, furnished_building, round_room, twin_rooms
from evaluation.simulation.disturbances import lose_beams, lose_blocks, ranges_with_crowd, ranges_with_glass
from evaluation.simulation.raycast import RayCaster
from evaluation.simulation.scenes import StrollOptions, laser, run_of, stroll
from evaluation.simulation.sensor import exact_ranges
from evaluation.simulation.simulation import Simulation

from .scene_outcomes import RIGHT_DEG, RIGHT_M, SURE, PairOutcome

Check = Callable[[list[PairOutcome]], list[str]]
ALONG, ACROSS = (1.0, 0.0), (0.0, 1.0)
FREE_M = 0.5  # a direction that nothing holds is not to be called better known than this
HELD_M = 0.15  # and one that walls hold not worse
DOUBT = 0.75  # of many places that look alike none is more probable; half would be just


@dataclass(frozen=True)
class Scene:
    """`make` gives the run of a seed, `check` says in words where the outcome is not as `statement` has it."""

    name: str
    title: str
    statement: str
    make: Callable[[int], Simulation]
    check: Check


def false_certainties(outcomes: list[PairOutcome]) -> list[str]:
    return [
        f"position {p.index} is off by {p.error_m:.2f} m and {p.error_deg:.1f} deg and called {p.status}"
        for p in outcomes
        if p.falsely_certain
    ]


def mostly_right(share: float) -> tuple[str, Check]:
    """Statement and check of a scene in which the scans do tell the motion."""

    def check(outcomes: list[PairOutcome]) -> list[str]:
        right = sum(p.right for p in outcomes)
        broken = false_certainties(outcomes)
        if right < share * len(outcomes):
            wrong = ", ".join(str(p.index) for p in outcomes if not p.right)
            broken.append(f"{right} of {len(outcomes)} pairs are right, wrong at {wrong}")
        return broken

    return f"at least {100 * share:g} % of the pairs right; none that is wrong is called ok", check


def check_corridor(outcomes: list[PairOutcome]) -> list[str]:
    broken = false_certainties(outcomes)
    for p in outcomes:
        if p.status not in ("degenerate", "ambiguous"):
            broken.append(f"position {p.index} is called {p.status}")
        if p.deviation_m(ALONG) < FREE_M and not p.probability < SURE:
            broken.append(f"position {p.index} is said to be known to {p.deviation_m(ALONG):.2f} m along the corridor")
        if p.deviation_m(ACROSS) > HELD_M:
            broken.append(f"position {p.index} is said to be known to only {p.deviation_m(ACROSS):.2f} m across")
        turned = abs(p.error_deg - 180.0) if p.error_deg > 90.0 else p.error_deg  # it looks the same backwards
        if not abs(p.error[1]) <= RIGHT_M or not turned <= RIGHT_DEG:
            broken.append(f"position {p.index} is off by {abs(p.error[1]):.2f} m across and {turned:.1f} deg")
    return broken


def check_round_room(outcomes: list[PairOutcome]) -> list[str]:
    broken = false_certainties(outcomes)
    for p in outcomes:
        if p.deviation_deg > 10.0:
            continue
        if p.status not in ("degenerate", "ambiguous"):
            broken.append(f"position {p.index} is called {p.status}, its heading known to {p.deviation_deg:.1f} deg")
        elif p.probability > DOUBT:
            broken.append(f"position {p.index} has a heading like any other, and it is {p.probability:.3f} probable")
    return broken


def corridor(fov_deg: float, turn_deg: float) -> Callable[[int], Simulation]:
    def make(seed: int) -> Simulation:
        world = bare_corridor()
        walk = stroll(seed, world.route, StrollOptions(num_positions=10, turn_deg=turn_deg))
        return run_of(seed, world, walk, laser(fov_deg, 0.5, 12.0))

    return make


def rotunda(seed: int) -> Simulation:
    world = round_room()
    walk = stroll(seed, world.route, StrollOptions(num_positions=6, spacing_m=0.9, turn_deg=180.0))
    return run_of(seed, world, walk, laser(360.0, 0.5, 12.0))


def twins(between_m: float) -> Callable[[int], Simulation]:
    def make(seed: int) -> Simulation:
        world = twin_rooms(seed, between_m)
        options = StrollOptions(num_positions=9, spacing_m=0.9, spacing_jitter=0.1, turn_deg=90.0)
        return run_of(seed, world, stroll(seed, world.route, options), laser(270.0, 0.5, 12.0))

    return make


def in_building(
    fov_deg: float = 270.0, step_deg: float = 0.5, max_range_m: float = 20.0, **walk: float
) -> Callable[[int], Simulation]:
    def make(seed: int) -> Simulation:
        world = furnished_building(seed, BuildingOptions())
        options = StrollOptions(**walk)  # type: ignore[arg-type]
        return run_of(seed, world, stroll(seed, world.route, options), laser(fov_deg, step_deg, max_range_m))

    return make


def with_lost_beams(blocks: int) -> Callable[[int], Simulation]:
    def make(seed: int) -> Simulation:
        whole = in_building()(seed)
        lost = lose_blocks(whole.ranges, 0.5, blocks, seed) if blocks else lose_beams(whole.ranges, 0.5, seed)
        return Simulation(whole.options, whole.world, whole.drive, lost)

    return make


def with_crowd(seed: int) -> Simulation:
    world, sensor = furnished_building(seed, BuildingOptions()), laser(270.0, 0.5, 20.0)
    walk = stroll(seed, world.route, StrollOptions())
    exact, _ = ranges_with_crowd(exact_ranges(RayCaster(world), walk, sensor), walk, sensor, 1.0 / 3.0, seed)
    return run_of(seed, world, walk, sensor, exact)


def with_glass(through: float) -> Callable[[int], Simulation]:
    def make(seed: int) -> Simulation:
        world, sensor = furnished_building(seed, BuildingOptions(glass=True)), laser(270.0, 0.5, 20.0)
        walk = stroll(seed, world.route, StrollOptions())
        return run_of(seed, world, walk, sensor, ranges_with_glass(world, walk, sensor, through, seed))

    return make


def building_scene(name: str, title: str, make: Callable[[int], Simulation], share: float = 0.8) -> Scene:
    statement, check = mostly_right(share)
    return Scene(name, title, statement, make, check)


def sensor_scene(fov_deg: float, step_deg: float, max_range_m: float, turn_deg: float, least_deg: float = 0.0) -> Scene:
    """Lasers that see little of a room (narrow, coarse or short) may err more often."""
    modest = fov_deg < 180.0 or step_deg >= 2.0 or max_range_m < 6.0
    turns = f"turns of {least_deg:g} to {turn_deg:g} deg" if least_deg else f"turns up to {turn_deg:g} deg"
    make = in_building(fov_deg, step_deg, max_range_m, turn_deg=turn_deg, least_turn_deg=least_deg)
    name = f"laser-{fov_deg:g}-{step_deg:g}-{max_range_m:g}" + ("-turning" if least_deg else "")
    title = f"{fov_deg:g} deg in steps of {step_deg:g} deg, {max_range_m:g} m, {turns}"
    return building_scene(name, title, make, 0.8 if modest else 0.9)


CORRIDOR_STATEMENT = (
    f"degenerate or ambiguous, every pair; along the corridor not said to be known to {FREE_M:g} m; across it right, "
    f"and said to be known to {HELD_M:g} m"
)
ROUND_STATEMENT = (
    f"ambiguous or degenerate, every pair, and at most {DOUBT:g} probable, "
    "unless its heading is not said to be known to 10 deg"
)
LASERS = [
    (100.0, 0.25, 20.0, 30.0),
    (100.0, 2.0, 8.0, 30.0),
    (180.0, 1.0, 80.0, 60.0),
    (180.0, 0.1, 30.0, 60.0),
    (180.0, 2.0, 8.0, 60.0),
    (240.0, 0.35, 4.0, 90.0),
    (240.0, 1.0, 10.0, 90.0),
    (360.0, 0.1, 80.0, 180.0),
    (360.0, 1.0, 12.0, 180.0),
    (360.0, 2.0, 6.0, 180.0),
    (360.0, 1.0, 4.0, 180.0),
    (360.0, 0.5, 12.0, 180.0, 90.0),
]
ALL_SCENES = [
    Scene("corridor-180", "bare corridor, laser of 180 deg", CORRIDOR_STATEMENT, corridor(180.0, 30.0), check_corridor),
    Scene(
        "corridor-360", "bare corridor, laser of 360 deg", CORRIDOR_STATEMENT, corridor(360.0, 180.0), check_corridor
    ),
    Scene("round-room", "round room", ROUND_STATEMENT, rotunda, check_round_room),
    building_scene("twin-rooms", "two rooms alike, with a door between them", twins(0.0)),
    building_scene("twin-rooms-passage", "two rooms alike, with a passage between them", twins(2.0)),
    building_scene("half-random", "half of the beams lost, each by itself", with_lost_beams(0)),
    building_scene("half-blocks", "half of the beams lost, in four blocks", with_lost_beams(4)),
    building_scene("crowd", "people in front of a third of the beams, elsewhere each time", with_crowd),
    building_scene("glass-dark", "walls of glass that return nothing", with_glass(0.0)),
    building_scene("glass-clear", "walls of glass, most beams return from behind", with_glass(0.8)),
    building_scene("tilted", "the robot leans by up to 8 deg, so that beams hit the floor", in_building(tilt_deg=8.0)),
    *(sensor_scene(*spec) for spec in LASERS),
]
SCENES = {scene.name: scene for scene in ALL_SCENES}
