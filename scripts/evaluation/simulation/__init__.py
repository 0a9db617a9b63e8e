# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulated places: the world, the robot that drives through it, its laser, and the files about them.

Frames: `map` (the hall, x right, y up, origin in its lower left corner), `robot` (a position's frame, x forward,
y left), `sub_scan` (the frame of one sweep, as the robot truly stood). Poses are arrays `[..., 3]` of x [m], y [m],
theta [rad]; a pose named `b_from_a` takes coordinates in frame a to frame b.
"""
