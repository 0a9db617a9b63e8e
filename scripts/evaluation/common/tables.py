# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables in Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np


def table_row(cells: Sequence[object]) -> str:
    """`| a | b |`; an empty cell takes one space."""
    texts = [str(cell) for cell in cells]
    return "|" + "|".join(f" {text} " if text else " " for text in texts) + "|"


def table_head(head: Sequence[str]) -> str:
    """The two lines above the rows."""
    return f"{table_row(head)}\n|{'---|' * len(head)}"


def table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A row with fewer cells than the head is filled up with empty ones."""
    filled = ([*row, *[""] * (len(head) - len(row))] for row in rows)
    return "\n".join([table_head(head), *map(table_row, filled)])


def percent(value: float) -> str:
    return "-" if np.isnan(value) else f"{100 * value:.1f} %"
