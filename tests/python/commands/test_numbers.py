# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of the mapper's numbers, by a made-up mapper; and docs/numbers.md, by shapemap-cli, where it is built
(build/release/bin, or the program that SHAPEMAP_CLI names)."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from evaluation.commands.numbers import main
from evaluation.common.programs import Failure
from evaluation.common.project import BIN, PROJECT
from evaluation.mapping.numbers import numbers_of, parse_numbers
from evaluation_support import NUMBERS, numbers_text, program, reporter

CLI = Path(os.environ.get("SHAPEMAP_CLI", BIN / "shapemap-cli"))


def test_the_page_has_each_number_with_what_it_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cli = reporter(tmp_path, "")
    assert main(["--cli", str(cli), "--out", str(tmp_path / "page.md")]) == 0
    text = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert main(["--cli", str(cli)]) == 0
    assert capsys.readouterr().out == text
    assert text.index("## matching\n") < text.index("## graph\n") < text.index("## inference\n")
    assert "\n### edge_support (`graph.edge_support`)\n" in text
    assert "\n| `residual_per_m` | -40 | x | y |\n" in text
    assert "\n| `heading_rad` | 0.17 (9.74°) | x | y |\n" in text
    num_numbers = sum(len(values) for groups in NUMBERS.values() for values in groups.values())
    assert sum(line.startswith("| `") for line in text.splitlines()) == num_numbers


def test_one_number_is_found_by_its_name() -> None:
    numbers = parse_numbers(numbers_text())
    assert numbers("graph", "edge_support", "little") == 1.5
    assert numbers.of("graph", "same_place", ("deviations", "near_m")) == (3.0, 0.1)
    with pytest.raises(Failure, match=r"no number graph\.edge_support\.much"):
        numbers("graph", "edge_support", "much")


@pytest.mark.parametrize("body", ["print('no')", "print('1')", "print('[1]')", "print('[{}]')", "raise SystemExit(2)"])
def test_a_program_that_does_not_tell_its_numbers_is_a_failure_of_one_line(
    body: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cli = program(tmp_path / "mapper", body)
    with pytest.raises(Failure, match="^mapper numbers: "):
        numbers_of(cli)
    assert main(["--cli", str(cli), "--out", str(tmp_path / "page.md")]) == 1
    told = capsys.readouterr().err
    assert told.startswith("evaluate.py numbers: mapper numbers: ")
    assert len(told.splitlines()) == 1
    assert not (tmp_path / "page.md").exists()


@pytest.mark.skipif(not os.access(CLI, os.X_OK), reason=f"{CLI} is not built")
def test_the_page_of_the_docs_is_what_the_program_tells(tmp_path: Path) -> None:
    assert main(["--cli", str(CLI), "--out", str(tmp_path / "numbers.md")]) == 0
    made = (tmp_path / "numbers.md").read_text(encoding="utf-8")
    committed = (PROJECT / "docs/numbers.md").read_text(encoding="utf-8")
    assert committed == made, "make it anew: scripts/evaluate.py numbers --out docs/numbers.md"
