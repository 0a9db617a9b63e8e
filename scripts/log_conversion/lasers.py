# SPDX-License-Identifier: GPL-3.0-or-later
"""The lasers of a log among each other: where each sits on the robot, and whether two of them are one."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

from .model import Laser, Mount, UnknownLogError, printable
from .transforms import FixedTransforms

TWIN_SHARE = 0.5  # of the scans of the rarer one that have the time of one of the other


def mount_as_given(lasers: list[Laser], given: Mapping[str, Mount]) -> None:
    """By the name of the laser, also with the slash of its topic. Raises UnknownLogError for a mount of no laser."""
    by_name = {name.removeprefix("/"): mount for name, mount in given.items()}
    known = [laser.name for laser in lasers]
    for name in by_name:
        if name not in known:
            names = ", ".join(map(printable, known))
            raise UnknownLogError(f"--mount {printable(name)}: no such laser; there is {names}")
    for laser in lasers:
        laser.mount = by_name.get(laser.name, laser.mount)


def mount_by_transforms(lasers: list[Laser], fixed: FixedTransforms) -> list[str]:
    """The lasers that are not mounted yet; what to tell the user."""
    notes = []
    waiting = [laser for laser in lasers if laser.mount is None]
    base, by_frame = fixed.mounts([laser.frame for laser in waiting])
    for laser in waiting:
        name = printable(laser.name)
        laser.mount = by_frame.get(laser.frame)
        if laser.mount is None:
            option = f"--mount {name}=x,y,z,yaw,pitch,roll (metres, degrees)"
            danger = ", and the map is wrong if it is not" if len(lasers) > 1 else ""
            notes.append(f"{name}: no transform tells its mount, which is taken as zero{danger}; {option} tells it")
        else:
            notes.append(f"{name}: mounted as the transform from {printable(base)} tells")
    return notes


def twin_notes(lasers: list[Laser]) -> list[str]:
    """Topics of which one seems to be made from the other, as filters do it: in the same frame, with the same times."""
    notes = []
    for first, second in combinations(lasers, 2):
        stamps = [{scan.stamp_ns for scan in laser.scans if scan.stamp_ns} for laser in (first, second)]
        fewest = min(map(len, stamps))
        if first.frame == second.frame and fewest and len(stamps[0] & stamps[1]) > TWIN_SHARE * fewest:
            names = f"{printable(first.name)} and {printable(second.name)}"
            notes.append(f"{names} have the same frame and times, as if from one laser; --topic chooses")
    return notes
