# SPDX-License-Identifier: GPL-3.0-or-later
"""Each rule of scripts/check_style.py: what it catches and what it lets pass."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

CHECK_STYLE = Path(__file__).resolve().parents[2] / "scripts" / "check_style.py"
SPDX = "// SPDX-License-Identifier: GPL-3.0-or-later\n"


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    write(tmp_path, "CMakeLists.txt", "# SPDX-License-Identifier: GPL-3.0-or-later\n")
    write(tmp_path, "libshapemap/src/core/clean.cpp", SPDX + '#include "shapemap/core/clean.hpp"\n#include <vector>\n')
    return tmp_path


def write(root: Path, path: str, text: str) -> None:
    file = root / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")


def check(root: Path) -> tuple[int, str]:
    run = subprocess.run([sys.executable, CHECK_STYLE, root], capture_output=True, text=True, check=False)
    return run.returncode, run.stdout + run.stderr


def test_a_clean_tree_passes(tree: Path) -> None:
    assert check(tree) == (0, "style: ok\n")


def test_a_folder_that_is_not_the_project_is_wrong_usage(tmp_path: Path) -> None:
    status, output = check(tmp_path)
    assert status == 2
    assert "no libshapemap/" in output


@pytest.mark.parametrize(
    ("path", "text", "complaint"),
    [
        ("libshapemap/src/scan/a.cpp", '#include "shapemap/io/x.hpp"', "a.cpp:2: 'scan' must not include"),
        ("libshapemap/src/matching/a.cpp", '#include "mapper/x.hpp"', "a.cpp:2: 'matching' must not include"),
        ("libshapemap/include/shapemap/core/a.hpp", '#include "shapemap/scan/x.hpp"', "'core' must not include"),
        ("libshapemap/src/scan/a.cpp", "#include <shapemap/core/x.hpp>", "in quotes"),
        ("libshapemap/src/scan/a.cpp", '#include "../core/x.hpp"', "in no room"),
        ("libshapemap/src/util/a.cpp", "", "folder 'util' is none of"),
        ("libshapemap/src/io/tum.cpp", "#include <mrpt/obs/CRawlog.h>", "tum.cpp:2: MRPT is known only to"),
        ("libshapemap/include/shapemap/io/rawlog.hpp", "#include <mrpt/obs/CRawlog.h>", "MRPT is known only to"),
        ("apps/shapemap-cli/main.cpp", "#include <opencv2/core.hpp>", "OpenCV is known only to"),
        ("libshapemap/src/shape/shape.cpp", "#include <CGAL/Point_2.h>", "CGAL is known only to"),
        ("libshapemap/src/mapper/a.cpp", "#include <nlohmann/json.hpp>", "nlohmann-json is known only to"),
        ("libshapemap/include/shapemap/core/a.hpp", "#include <nanoflann.hpp>", "nanoflann is known only to"),
        ("libshapemap/src/mapper/a.cpp", 'void f() { std::cerr << "x"; }', "a.cpp:2: the library never prints"),
        ("libshapemap/src/mapper/a.cpp", 'void f() { std::printf("x"); }', "the library never prints"),
        ("libshapemap/src/mapper/a.cpp", "#include <iostream>", "the library never prints"),
        ("libshapemap/src/mapper/a.cpp", "// " + 118 * "x", "a.cpp:2: 121 columns, at most 120"),
        ("libshapemap/src/mapper/a.cpp", 300 * "\n", "301 lines, at most 300"),
        ("tests/unit/map/a_test.cpp", 400 * "\n", "401 lines, at most 400"),
    ],
)
def test_a_broken_rule_is_named(tree: Path, path: str, text: str, complaint: str) -> None:
    write(tree, path, SPDX + text)
    status, output = check(tree)
    assert status == 1
    assert complaint in output
    assert output.count("\n") == 1, output


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("libshapemap/src/io/a.cpp", '#include "shapemap/core/x.hpp"\n#include "a_parts.hpp"'),
        ("libshapemap/include/shapemap/shapemap.hpp", '#include "shapemap/io/x.hpp"'),
        ("libshapemap/src/io/rawlog_reader.cpp", "#include <mrpt/obs/CRawlog.h>"),
        ("libshapemap/src/io/map_image.cpp", "#include <opencv2/imgcodecs.hpp>"),
        ("apps/shapemap-cli/report.cpp", "#include <nlohmann/json.hpp>"),
        ("tests/unit/io/a_test.cpp", "#include <mrpt/obs/CRawlog.h>"),
        ("libshapemap/src/mapper/a.cpp", '// std::cout is for others\nvoid f(char* s) { std::snprintf(s, 1, ""); }'),
        ("libshapemap/src/mapper/a.cpp", "// " + 117 * "\u00e4"),
        ("libshapemap/src/mapper/a.cpp", 299 * "\n"),
        ("tests/unit/map/a_test.cpp", 399 * "\n"),
        ("datasets/a.py", 200 * "x"),
    ],
)
def test_what_keeps_the_rules_passes(tree: Path, path: str, text: str) -> None:
    write(tree, path, SPDX + text)
    assert check(tree) == (0, "style: ok\n")


PYTHON_SPDX = "# SPDX-License-Identifier: GPL-3.0-or-later\n"
LOGS, COMMAND = "scripts/evaluation/logs/a.py", "scripts/evaluation/commands/a.py"


@pytest.mark.parametrize(
    ("path", "text", "complaint"),
    [
        (LOGS, "from evaluation.commands.maps import main", "a.py:2: 'evaluation.commands.maps.main' is a command"),
        (LOGS, "import evaluation.commands.maps", "'evaluation.commands.maps' is a command"),
        (LOGS, "from evaluation import commands", "'evaluation.commands' is a command"),
        (LOGS, "from ..commands import maps", "'evaluation.commands.maps' is a command"),
        (LOGS, "from .. import commands", "'evaluation.commands' is a command"),
        (LOGS, "def f():\n    from evaluation.commands import maps", "a.py:3: 'evaluation.commands.maps' is a command"),
        (LOGS, "from evaluation import (\n    commands,\n)", "a.py:2: 'evaluation.commands' is a command"),
        (LOGS, "from evaluate import main", "'evaluate' is an executable"),
        (LOGS, "import convert_logs", "'convert_logs' is an executable"),
        ("scripts/log_conversion/a.py", "import evaluate", "'evaluate' is an executable"),
        (LOGS, "from evaluation.maps.runs import Job", "'logs' must not import 'evaluation.maps.runs.Job'"),
        (LOGS, "from ..judging.loops import Limits", "'logs' must not import 'evaluation.judging.loops.Limits'"),
        (COMMAND, "from evaluation.commands.maps import main", "is a command"),
        (COMMAND, "from .maps import main", "'evaluation.commands.maps.main' is a command"),
        (COMMAND, "from . import maps", "'evaluation.commands.maps' is a command"),
        ("scripts/evaluation/util/a.py", "", "folder 'util' is none of"),
    ],
)
def test_a_module_imports_what_comes_before_it(tree: Path, path: str, text: str, complaint: str) -> None:
    for executable in ("evaluate", "convert_logs"):
        write(tree, f"scripts/{executable}.py", PYTHON_SPDX + "from evaluation.commands import main\n")
    write(tree, path, PYTHON_SPDX + text)
    status, output = check(tree)
    assert status == 1
    assert complaint in output
    assert output.count("\n") == 1, output


@pytest.mark.parametrize(
    ("path", "text"),
    [
        (LOGS, "from evaluation.common.files import write_whole\nfrom .datasets import select\nfrom . import datasets"),
        (LOGS, "from ..simulation.read import read_scan_log\nfrom log_conversion.model import LaserLog\nimport json"),
        (COMMAND, "from evaluation.maps.runs import Job\nfrom evaluation.figures import album"),
        ("scripts/evaluate.py", "from evaluation.commands import main"),
        ("tests/python/commands/test_a.py", "from evaluation.commands import maps\nimport convert_logs"),
    ],
)
def test_imports_of_what_comes_before_pass(tree: Path, path: str, text: str) -> None:
    write(tree, path, PYTHON_SPDX + text)
    assert check(tree) == (0, "style: ok\n")


@pytest.mark.parametrize("path", ["apps/a/main.cpp", "scripts/a.py", "scripts/a.sh", ".ci/run", "tests/CMakeLists.txt"])
def test_every_source_names_its_licence(tree: Path, path: str) -> None:
    write(tree, path, "\n\n# SPDX-License-Identifier: GPL-3.0-or-later\n")
    status, output = check(tree)
    assert status == 1
    assert output.startswith(f"{path}:1: no 'SPDX")


def test_nanoflann_lives_in_one_file(tree: Path) -> None:
    write(tree, "libshapemap/src/matching/a.cpp", SPDX + "#include <nanoflann.hpp>\n")
    assert check(tree)[0] == 0
    write(tree, "libshapemap/src/align/b.cpp", SPDX + "#include <nanoflann.hpp>\n")
    status, output = check(tree)
    assert status == 1
    assert "nanoflann is used in 2 files, at most 1" in output
