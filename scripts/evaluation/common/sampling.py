# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory and CPU time of a program while it runs, from Linux's /proc."""

from __future__ import annotations

import os
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Self

PROC = Path("/proc")


@dataclass(frozen=True)
class Sample:
    wall_s: float
    cpu_s: float
    rss_mib: float


class Sampler:
    """Looks at what a launcher started, each `every_s`, from `watch(launcher)` to the end of the `with` block."""

    def __init__(self, every_s: float = 0.25) -> None:
        self.samples: list[Sample] = []
        self._every_s = every_s
        self._ended = threading.Event()
        self._thread: threading.Thread | None = None

    def watch(self, launcher: int) -> None:
        self._thread = threading.Thread(target=self._look, args=(launcher,), daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        if self._thread is not None:
            self._thread.join()

    def _look(self, launcher: int) -> None:
        started = time.monotonic()
        while not self._ended.wait(self._every_s):
            child = child_of(launcher)
            sample = None if child is None else sample_of(child, time.monotonic() - started)
            if sample is not None:
                self.samples.append(sample)


def child_of(process: int) -> int | None:
    try:
        words = (PROC / f"{process}/task/{process}/children").read_text(encoding="ascii").split()
    except OSError:  # it ended
        return None
    return int(words[0]) if words else None


def sample_of(process: int, wall_s: float) -> Sample | None:
    """None when it ended."""
    try:
        fields = (PROC / f"{process}/stat").read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
    except OSError:
        return None
    cpu_s = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")  # utime and stime; the state is field 0
    rss_mib = int(fields[21]) * os.sysconf("SC_PAGE_SIZE") / 2**20
    return Sample(wall_s, cpu_s, rss_mib) if rss_mib > 0.0 else None  # none: it ended, and nobody waited for it yet
