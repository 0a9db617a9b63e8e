# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers: one independent stream per component, so that a change to one leaves the others as they were."""

from __future__ import annotations

import zlib

import numpy as np


def stream(seed: int, component: str) -> np.random.Generator:
    """The stream of a component for a seed."""
    return np.random.default_rng([seed, zlib.crc32(component.encode())])
