# SPDX-License-Identifier: GPL-3.0-or-later
"""Where things lie: the checkout, the programs that it builds, and the logs of the person who runs this."""

from __future__ import annotations

import os
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[3]
BIN = PROJECT / "build/release/bin"


def datasets_folder() -> Path | None:
    """The folder of real logs that SHAPEMAP_DATASETS names, or None where it is not set."""
    name = os.environ.get("SHAPEMAP_DATASETS")
    return Path(name) if name else None


def found_log(path: Path) -> Path:
    """The path itself where there is such a file, else the path below SHAPEMAP_DATASETS."""
    return path if path.exists() else (datasets_folder() or Path()) / path
