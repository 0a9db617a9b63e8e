# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that appear whole or not at all, and results as JSON, which has neither NaN nor infinity."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any

from .shares import Share


def write_whole(path: Path, text: str) -> None:
    """The file appears whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{os.getpid()}.part")
    partial.write_text(text, encoding="utf-8")
    partial.replace(path)


def plain(value: Any) -> Any:
    """What JSON can hold: numbers that are none become null, paths text, dataclasses objects, and shares come with
    their value and interval."""
    if isinstance(value, Share):
        fields = {"count": value.count, "total": value.total}
        return {**fields, "value": plain(value.value), "interval": list(value.interval)}
    if is_dataclass(value) and not isinstance(value, type):
        return {key: plain(getattr(value, key)) for key in value.__dataclass_fields__}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, Path):
        return str(value)
    return None if isinstance(value, float) and not math.isfinite(value) else value


def write_json(path: Path, content: Any) -> None:
    """The content as `plain` JSON, whole or not at all."""
    write_whole(path, json.dumps(plain(content), indent=1, allow_nan=False) + "\n")
