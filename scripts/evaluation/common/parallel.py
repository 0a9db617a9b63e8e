# SPDX-License-Identifier: GPL-3.0-or-later
"""Many calls of a function at the same time, each in a process of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from typing import Any, TypeVar

Result = TypeVar("Result")


def run_all(function: Callable[..., Result], calls: Iterable[tuple[Any, ...]], num_jobs: int) -> list[Result]:
    """The results in the order of the calls. What one of them raises ends those that have not begun."""
    with ProcessPoolExecutor(max_workers=num_jobs) as pool:
        futures = [pool.submit(function, *call) for call in calls]
        try:
            return [future.result() for future in futures]
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
