# SPDX-License-Identifier: GPL-3.0-or-later
"""How long programs may take to end: longer with sanitizers, which make them slow."""

import os

import pytest

SLOWDOWN = float(os.environ.get("SHAPEMAP_SLOWDOWN", "1"))

# What is long, and asks what comes out rather than of new code: other tests run the same code with sanitizers.
without_sanitizers = pytest.mark.skipif(SLOWDOWN > 1, reason="takes too long with sanitizers")


def wait(process, limit_s=30):
    """The exit code."""
    return process.wait(limit_s * SLOWDOWN)


def is_soon(duration_s, limit_s):
    return duration_s < limit_s * SLOWDOWN
