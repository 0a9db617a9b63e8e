# SPDX-License-Identifier: GPL-3.0-or-later
"""How long programs may take to end: longer with sanitizers, which make them slow."""

import os

SLOWDOWN = float(os.environ.get("SHAPEMAP_SLOWDOWN", "1"))


def wait(process, limit_s=30):
    """The exit code."""
    return process.wait(limit_s * SLOWDOWN)


def is_soon(duration_s, limit_s):
    return duration_s < limit_s * SLOWDOWN
