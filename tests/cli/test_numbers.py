# SPDX-License-Identifier: GPL-3.0-or-later
"""What `shapemap-cli numbers` tells of the method's weights and tolerances."""

import json
import re

import pytest

KEYS = ["room", "group", "title", "name", "value", "help", "fitted_to"]
ROOMS = ["matching", "graph", "loops", "inference", "localization", "mapper"]


@pytest.fixture
def numbers(run):
    result = run("numbers")
    assert result.returncode == 0
    assert result.stderr == ""
    return json.loads(result.stdout)


def test_each_number_says_what_it_is_and_what_it_was_fitted_to(numbers):
    assert len(numbers) > 150
    for number in numbers:
        assert list(number) == KEYS
        assert isinstance(number["value"], int | float)
        for key in ("title", "help", "fitted_to"):
            assert len(number[key]) > 3, number
            assert not number[key].endswith("."), number
        assert re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", number["name"]), number


def test_names_are_unique_and_rooms_stand_in_their_order(numbers):
    names = [(number["room"], number["group"], number["name"]) for number in numbers]
    assert len(set(names)) == len(names)
    assert list(dict.fromkeys(number["room"] for number in numbers)) == ROOMS
    groups = [(number["room"], number["group"], number["title"]) for number in numbers]
    assert len(set(groups)) == len({group[:2] for group in groups}), "a group has one title"
    assert groups == sorted(groups, key=list(dict.fromkeys(groups)).index), "a group stands in one piece"


def test_weights_that_were_fitted_name_the_command(numbers):
    for name in ("fit-scores", "fit-edges"):
        assert any(f"scripts/evaluate.py {name}" in number["fitted_to"] for number in numbers)


def test_it_takes_no_arguments(fails):
    fails(2, "numbers", "room.log")
    fails(2, "numbers", "--out", "numbers.json")


def test_its_help_has_examples_and_exit_codes(run):
    result = run("numbers", "--help")
    assert result.returncode == 0
    assert "Examples:" in result.stdout
    assert "Exit codes:" in result.stdout
    assert "shapemap-cli numbers" in run("--help").stdout
