# SPDX-License-Identifier: GPL-3.0-or-later
"""Types of command-line arguments: numbers within limits, and lists of names, numbers and seeds."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Collection
from typing import Any


def number(low: float, high: float, kind: Callable[[str], Any] = float) -> Callable[[str], Any]:
    """An argparse type: a number within limits."""

    def parse(text: str) -> Any:
        value = kind(text)
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text} is not in {low} to {high}")
        return value

    parse.__name__ = "number"
    return parse


def numbers(low: float, high: float, kind: Callable[[str], Any] = float) -> Callable[[str], list[Any]]:
    """An argparse type: numbers within limits, such as `1,2.5`."""
    one = number(low, high, kind)

    def parse(text: str) -> list[Any]:
        return [one(part) for part in text.split(",")]

    parse.__name__ = "list of numbers"
    return parse


def name_list(text: str) -> list[str]:
    """Any names with commas between, in the order given."""
    return [name for name in text.split(",") if name]


def some_of(known: Collection[str], at_least: int = 0) -> Callable[[str], list[str]]:
    """An argparse type: names out of those known with commas between, in the order given."""

    def parse(text: str) -> list[str]:
        names = name_list(text)
        unknown = sorted(set(names) - set(known))
        if unknown or len(names) < at_least:
            said = f"unknown {', '.join(unknown)}" if unknown else "nothing chosen"
            raise argparse.ArgumentTypeError(f"{said}; expected some of {', '.join(known)}")
        return names

    parse.__name__ = "list"
    return parse


def parse_seeds(text: str) -> list[int]:
    """`0-39`, `1,5,8` or a mix of both; sorted, each once."""
    seeds: set[int] = set()
    for part in text.split(","):
        first, dash, last = part.partition("-")
        try:
            low = int(first)
            high = int(last) if dash else low
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{part}' is not a seed or a range such as 0-39") from None
        if high < low:
            raise argparse.ArgumentTypeError(f"'{part}' is an empty range")
        seeds.update(range(low, high + 1))
    return sorted(seeds)
