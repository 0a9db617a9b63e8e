# SPDX-License-Identifier: GPL-3.0-or-later
"""The log that comes with shapemap is found and mapped."""


def test_the_demo_makes_a_map(run, files_of):
    result = run("--demo", "--out", "map.png")
    assert result.returncode in (0, 4), result.stderr
    assert "of 16 positions" in result.stderr
    assert files_of() == ["map.png", "map.yaml"]
