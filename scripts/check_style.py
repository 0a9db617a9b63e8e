#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the rules of CONTRIBUTING.md that compilers and formatters do not know."""

from __future__ import annotations

import argparse
import ast
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path

# A room of the library includes only itself and those before it.
ROOMS = (
    *("core", "scan", "shape", "deskew", "motion", "grid", "paper", "matching", "graph", "loops", "inference"),
    *("localization", "mapper", "io"),
)
# A room of scripts/evaluation/ imports only itself and those before it, and a command is imported by no other module.
SCRIPT_ROOMS = (
    *("common", "simulation", "logs", "mapping", "judging", "pairs", "maps", "fitting", "figures"),
    "commands",
)
FOLDERS = (".ci", "apps", "cmake", "libshapemap", "python", "scripts", "tests")
SUFFIXES = (".cmake", ".cpp", ".hpp", ".in", ".py", ".sh")
CPP_SUFFIXES = (".cpp", ".hpp", ".hpp.in")
SPDX = "SPDX-License-Identifier: GPL-3.0-or-later"
MAX_COLUMNS = 120
MAX_LINES = 300
MAX_TEST_LINES = 400

INCLUDE = re.compile(r'^\s*#\s*include\s*(?P<quote>[<"])(?P<path>[^>"]+)[>"]')
PRINT = re.compile(r"\bstd::(cout|cerr|clog)\b|\b(f|v|vf)?printf\s*\(|\b(f?puts|putchar|perror)\s*\(|<iostream>")


@dataclass(frozen=True)
class Confinement:
    """A third-party library and the only files of libshapemap/ and apps/ that may know it."""

    library: str
    include: str  # pattern of the included path
    files: tuple[str, ...]  # patterns of the files that may include it
    max_files: int | None = None


CONFINEMENTS = (
    Confinement(
        "MRPT",
        "mrpt/*",
        (
            *("libshapemap/src/io/rawlog*.cpp", "libshapemap/src/grid/occupancy_grid.cpp"),
            "apps/shapemap-baselines/mrpt_*.cpp",
        ),
    ),
    Confinement("OpenCV", "opencv2/*", ("libshapemap/src/io/map_image.cpp",)),
    Confinement("CGAL", "CGAL/*", ("libshapemap/src/shape/simplify.cpp",)),
    Confinement("Ceres", "ceres/*", ("libshapemap/src/graph/pose_graph.cpp",)),
    Confinement(
        "nlohmann-json",
        "nlohmann/*",
        ("libshapemap/src/io/json_parts.hpp", "apps/*"),
    ),
    Confinement("nanoflann", "nanoflann*", ("libshapemap/src/*.cpp",), max_files=1),
)


@dataclass
class SourceFile:
    """A file of the project, by its path from the root with forward slashes."""

    path: str
    lines: list[str] = field(repr=False)

    @property
    def is_cpp(self) -> bool:
        return self.path.endswith(CPP_SUFFIXES)

    @property
    def room(self) -> str | None:
        """The room of libshapemap that the file lies in."""
        found = re.match(r"libshapemap/(?:include/shapemap|src)/(\w+)/", self.path)
        return found.group(1) if found else None

    @property
    def script_room(self) -> str | None:
        """The folder of scripts/evaluation/ that the file lies in."""
        found = re.match(r"scripts/evaluation/(\w+)/", self.path)
        return found.group(1) if found else None

    def imports(self) -> Iterator[tuple[int, str]]:
        """Line number and whole name of what a Python file imports, such as evaluation.logs.datasets.select."""
        package = self.path.removeprefix("scripts/").split("/")[:-1]
        for node in ast.walk(ast.parse("\n".join(self.lines), self.path)):
            if isinstance(node, ast.Import):
                yield from ((node.lineno, alias.name) for alias in node.names)
            elif isinstance(node, ast.ImportFrom):
                above = package[: len(package) + 1 - node.level] if node.level else []
                module = [*above, *([node.module] if node.module else [])]
                yield from ((node.lineno, ".".join([*module, alias.name])) for alias in node.names)

    def includes(self) -> Iterator[tuple[int, str, bool]]:
        """Line number, included path and whether it is quoted."""
        for number, line in enumerate(self.lines, 1):
            if found := INCLUDE.match(line):
                yield number, found["path"], found["quote"] == '"'


def source_files(root: Path) -> list[SourceFile]:
    paths = [root / "CMakeLists.txt"]
    for folder in FOLDERS:
        paths += sorted((root / folder).rglob("*"))
    return [
        SourceFile(path.relative_to(root).as_posix(), path.read_text(encoding="utf-8").splitlines())
        for path in paths
        if path.is_file() and is_source(path)
    ]


def is_source(path: Path) -> bool:
    return path.suffix in SUFFIXES or path.name == "CMakeLists.txt" or path.parent.name == ".ci"


def check_text(source: SourceFile) -> Iterator[str]:
    """Licence line, length of lines and of the file."""
    if not any(SPDX in line for line in source.lines[:2]):
        yield f"{source.path}:1: no '{SPDX}' in the first two lines"
    limit = MAX_TEST_LINES if source.path.startswith("tests/") else MAX_LINES
    if len(source.lines) > limit:
        yield f"{source.path}:{limit + 1}: {len(source.lines)} lines, at most {limit}"
    for number, line in enumerate(source.lines, 1):
        if len(line) > MAX_COLUMNS:
            yield f"{source.path}:{number}: {len(line)} columns, at most {MAX_COLUMNS}"


def included_room(path: str, including: str) -> str:
    """The room of a quoted include: "shapemap/grid/x.hpp", "grid/x.hpp" or, in the same folder, "x.hpp"."""
    parts = path.removeprefix("shapemap/").split("/")
    return parts[0] if len(parts) > 1 else including


def check_layers(source: SourceFile) -> Iterator[str]:
    room = source.room
    if room is None:
        return
    if room not in ROOMS:
        yield f"{source.path}:1: folder '{room}' is none of: {', '.join(ROOMS)}"
        return
    for number, path, quoted in source.includes():
        where = f"{source.path}:{number}"
        if not quoted:
            if path.startswith("shapemap/"):
                yield f"{where}: include our own '{path}' in quotes"
            continue
        other = included_room(path, room)
        if other not in ROOMS:
            yield f"{where}: '{path}' is in no room of the library"
        elif ROOMS.index(other) > ROOMS.index(room):
            yield f"{where}: '{room}' must not include '{path}', which comes after it"


def is_after(room: str, other: str) -> bool:
    """Whether the one room of scripts/evaluation/ comes after the other."""
    return room in SCRIPT_ROOMS and SCRIPT_ROOMS.index(room) > SCRIPT_ROOMS.index(other)


def check_imports(source: SourceFile, executables: set[str]) -> Iterator[str]:
    """Of the Python below scripts/: library modules know neither executables nor commands."""
    if not source.path.startswith("scripts/") or source.path.count("/") < 2 or not source.path.endswith(".py"):
        return
    if source.script_room is not None and source.script_room not in SCRIPT_ROOMS:
        yield f"{source.path}:1: folder '{source.script_room}' is none of: {', '.join(SCRIPT_ROOMS)}"
        return
    for number, name in source.imports():
        where, (top, *below) = f"{source.path}:{number}", name.split(".")
        if top in executables:
            yield f"{where}: '{top}' is an executable, which no module imports"
        elif top != "evaluation" or not below:
            continue
        elif below[0] == "commands":
            yield f"{where}: '{name}' is a command, which no module imports"
        elif source.script_room and is_after(below[0], source.script_room):
            yield f"{where}: '{source.script_room}' must not import '{name}', which comes after it"


def check_silence(source: SourceFile) -> Iterator[str]:
    if not source.path.startswith("libshapemap/") or not source.is_cpp:
        return
    for number, line in enumerate(source.lines, 1):
        if PRINT.search(line.split("//")[0]):
            yield f"{source.path}:{number}: the library never prints; tell the observer or throw"


def check_confinement(sources: list[SourceFile], rule: Confinement) -> Iterator[str]:
    users = []
    for source in sources:
        if not source.path.startswith(("libshapemap/", "apps/")):
            continue
        numbers = [number for number, path, _ in source.includes() if fnmatch(path, rule.include)]
        if not numbers:
            continue
        users.append(source.path)
        if not any(fnmatch(source.path, pattern) for pattern in rule.files):
            yield f"{source.path}:{numbers[0]}: {rule.library} is known only to {', '.join(rule.files)}"
    if rule.max_files is not None and len(users) > rule.max_files:
        used = f"{rule.library} is used in {len(users)} files, at most {rule.max_files}"
        yield f"{users[-1]}:1: {used}: {', '.join(users)}"


def violations(root: Path) -> list[str]:
    sources = source_files(root)
    executables = {Path(s.path).stem for s in sources if s.path.startswith("scripts/") and s.path.count("/") == 1}
    found: list[str] = []
    for source in sources:
        found += [*check_text(source), *check_layers(source), *check_silence(source)]
        found += check_imports(source, executables)
    for rule in CONFINEMENTS:
        found += check_confinement(sources, rule)
    return sorted(found)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent)
    root = parser.parse_args().root
    if not (root / "libshapemap").is_dir():
        parser.error(f"no libshapemap/ in {root}")
    found = violations(root)
    print("\n".join(found) if found else "style: ok")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
