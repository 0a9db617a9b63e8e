# SPDX-License-Identifier: GPL-3.0-or-later
"""Shares of a count with their 95 % intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


def wilson_interval(count: int, total: int, z: float = 1.959963984540054) -> tuple[float, float]:
    """Wilson's score interval of a share, 95 % unless told; (0, 1) when there is nothing to count."""
    if total == 0:
        return 0.0, 1.0
    share, zz = count / total, z * z
    centre = (share + zz / (2 * total)) / (1 + zz / total)
    half = z * np.sqrt(share * (1 - share) / total + zz / (4 * total * total)) / (1 + zz / total)
    return max(0.0, float(centre - half)), min(1.0, float(centre + half))


@dataclass(frozen=True)
class Share:
    """`count` of `total`."""

    count: int
    total: int

    @property
    def value(self) -> float:
        return self.count / self.total if self.total else float("nan")

    @property
    def interval(self) -> tuple[float, float]:
        return wilson_interval(self.count, self.total)

    def text(self, digits: int = 1) -> str:
        """`80.0 % (73.1-85.5)`; "-" where there is nothing to count."""
        if not self.total:
            return "-"
        low, high = self.interval
        return f"{100 * self.value:.{digits}f} % ({100 * low:.{digits}f}-{100 * high:.{digits}f})"

    def __str__(self) -> str:
        return self.text()


def share_of(flags: Sequence[bool]) -> Share:
    return Share(sum(flags), len(flags))
