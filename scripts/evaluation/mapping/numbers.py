# SPDX-License-Identifier: GPL-3.0-or-later
"""The mapper's fitted weights and tolerances, as `shapemap-cli numbers` prints them. None is repeated in Python."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, fields
from itertools import groupby
from pathlib import Path

import numpy as np

from evaluation.common.programs import Failure, check_program, run_quietly
from evaluation.common.tables import table

PAGE_HEAD = """# Numbers of the method

Every fitted weight and every tolerance of the robust method that is no option, by the rooms of the library. Each
stands once, in the table of its room (`libshapemap/src/<room>/<room>_numbers.hpp`), and the code reads it there. This
page is made by `scripts/evaluate.py numbers --out docs/numbers.md`; `shapemap-cli numbers` prints the same as JSON.
What users may change is in `shapemap-cli --help`.
"""


@dataclass(frozen=True)
class Number:
    """A number of the table `group` of a room; angles are radians. `fitted_to` says what it was fitted to, or why it is
    so."""

    room: str
    group: str
    title: str
    name: str
    value: float
    help: str
    fitted_to: str


@dataclass(frozen=True)
class Numbers:
    """All numbers of a mapper, in its order."""

    entries: tuple[Number, ...]

    def __call__(self, room: str, group: str, name: str) -> float:
        """The value of one. Raises Failure for one that the mapper does not know."""
        for entry in self.entries:
            if (entry.room, entry.group, entry.name) == (room, group, name):
                return entry.value
        raise Failure(f"the mapper has no number {room}.{group}.{name}: are it and the scripts of one version?")

    def of(self, room: str, group: str, names: Sequence[str]) -> tuple[float, ...]:
        """The values of several in one group."""
        return tuple(self(room, group, name) for name in names)


def parse_numbers(text: str) -> Numbers:
    """What a mapper printed. Raises Failure for anything else."""
    names = {field.name for field in fields(Number)}
    try:
        entries = [Number(**{key: entry[key] for key in names}) for entry in json.loads(text)]
    except (ValueError, TypeError, KeyError) as error:
        raise Failure(f"expected a JSON array of numbers with {', '.join(sorted(names))}: {error!r}") from None
    return Numbers(tuple(entries))


def numbers_of(cli: Path) -> Numbers:
    """Those of a program. Raises Failure when it does not tell them."""
    check_program(cli)
    try:
        return parse_numbers(run_quietly([cli, "numbers"], timeout_s=60, done=(0,)))
    except Failure as failure:
        raise Failure(f"{cli.name} numbers: {failure}") from None


def shown_value(number: Number) -> str:
    """The value, of an angle with its degrees."""
    if number.name.endswith("_rad"):
        return f"{number.value:.4g} ({np.rad2deg(number.value):.4g}°)"
    return f"{number.value:g}"


def page(numbers: Numbers) -> str:
    """All tables in Markdown."""
    parts = [PAGE_HEAD]
    for room, of_room in groupby(numbers.entries, key=lambda number: number.room):
        parts.append(f"## {room}\n")
        for (group, title), of_group in groupby(of_room, key=lambda number: (number.group, number.title)):
            rows = [[f"`{n.name}`", shown_value(n), n.help, n.fitted_to] for n in of_group]
            head = ("number", "value", "what it is", "fitted to, or why it is so")
            parts.append(f"### {title} (`{room}.{group}`)\n\n{table(head, rows)}\n")
    return "\n".join(parts)
