# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of what parts are worth, with made-up scores."""

from evaluation.commands import ablation as ablation_command
from evaluation.common.tables import table_row
from evaluation.judging.consecutive_pairs import LogScore


def test_a_row_is_the_mean_over_the_logs_for_each_stride(monkeypatch, tmp_path):
    asked = []

    def score(path, _cli, arguments, every):
        asked.append((path.name, every, arguments))
        return LogScore(path.name, 11, 11, 10 - every if path.name == "a" else 10, 0.02, 0.11, 80.0)

    monkeypatch.setattr(ablation_command, "score_log", score)
    cells = ablation_command.row("less", ["--vote-peaks", "1"], [tmp_path / "a", tmp_path / "b"], tmp_path / "cli")
    assert table_row(cells) == "| less | 95.00 % | 90.00 % | 85.00 % | 10.0 ms |"
    assert asked[0] == ("a", 1, [*ablation_command.CHAIN_ALONE, "--vote-peaks", "1"])


def test_a_log_that_is_missing_is_an_error(capsys, tmp_path):
    assert ablation_command.main([str(tmp_path / "none.log"), "--cli", "/bin/true"]) == 1
    assert "evaluate.py ablation:" in capsys.readouterr().err
