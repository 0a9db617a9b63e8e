# SPDX-License-Identifier: GPL-3.0-or-later
"""What the readers of all kinds of bags give."""

from __future__ import annotations

from dataclasses import dataclass, field

from .model import counted


@dataclass(frozen=True)
class Channel:
    """Where messages come from: their topic, and their type as ROS 2 writes it. `definition` and `md5` are those that
    the bag has."""

    topic: str
    type_name: str
    definition: str = ""
    md5: str = ""
    encoding: str = "ros1"


@dataclass(frozen=True)
class RawMessage:
    channel: Channel
    received_ns: int
    data: bytes


@dataclass
class BagContent:
    """`messages` are those of the wanted types in the order in which they came; `counts` has all of the topics."""

    messages: list[RawMessage] = field(default_factory=list)
    counts: dict[tuple[str, str], int] = field(default_factory=dict)
    damages: list[str] = field(default_factory=list)

    def cut_at(self, byte: int) -> str:
        """What to say of a bag that ends there; all before it is used."""
        return f"the bag is cut off at byte {byte}, after {counted(sum(self.counts.values()), 'message')}"
