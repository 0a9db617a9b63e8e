# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of what parts are worth, with made-up scores."""

import ablation
from evaluate_logs import LogScore


def test_a_row_is_the_mean_over_the_logs_for_each_stride(monkeypatch, tmp_path):
    asked = []

    def score(path, _cli, arguments, every):
        asked.append((path.name, every, arguments))
        return LogScore(path.name, 11, 11, 10 - every if path.name == "a" else 10, 0.02, 0.11, 80.0)

    monkeypatch.setattr(ablation, "score_log", score)
    line = ablation.row("less", ["--vote-peaks", "1"], [tmp_path / "a", tmp_path / "b"], tmp_path / "cli")
    assert line == "| less | 95.00 % | 90.00 % | 85.00 % | 10.0 ms |"
    assert asked[0] == ("a", 1, [*ablation.CHAIN_ALONE, "--vote-peaks", "1"])


def test_a_log_that_is_missing_is_an_error(capsys, tmp_path):
    assert ablation.main([str(tmp_path / "none.log"), "--cli", "/bin/true"]) == 1
    assert "ablation.py:" in capsys.readouterr().err
