# SPDX-License-Identifier: GPL-3.0-or-later
"""What a report is made of, and how it is written as Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from evaluation.common.tables import table


@dataclass
class Section:
    """`pictures` with their captions; `level` 2 is a chapter. Sections with the same `kind` have tables of the same
    columns; `known` is what stands in no row since it is the same in all."""

    title: str
    text: list[str] = field(default_factory=list)
    tables: list[pd.DataFrame] = field(default_factory=list)
    pictures: list[tuple[Path, str]] = field(default_factory=list)
    level: int = 2
    kind: str = ""
    known: dict[str, str] = field(default_factory=dict)


def as_markdown(title: str, sections: Sequence[Section], beside: Path) -> str:
    parts = [f"# {title}"]
    for section in sections:
        parts += [f"{'#' * section.level} {section.title}", *section.text]
        parts += [markdown_table(data) for data in section.tables if len(data)]
        parts += [f"![{caption}]({path.relative_to(beside).as_posix()})" for path, caption in section.pictures]
    return "\n\n".join(parts) + "\n"


def markdown_table(data: pd.DataFrame) -> str:
    return table(list(data.columns), [[str(cell).replace("|", "\\|") for cell in row] for row in data.values.tolist()])
