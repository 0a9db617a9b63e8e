# SPDX-License-Identifier: GPL-3.0-or-later
"""The comparison of two programs, with two that are made up."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from evaluation.commands import same as same_command
from evaluation.mapping.outputs import FILES, OUTPUTS, first_difference
from evaluation_support import program

# Writes all outputs of a log of two scans. `change` may alter the report, the files, and the names of members.
MAPPER = """import json, sys
words = sys.argv[1:]
logs = words[:words.index('--out')]
of = lambda name: words[words.index(name) + 1]
files = {of('--trajectory'): '1 0 0 0 0 0 0 1\\n2 1 0 0 0 0 0 1\\n', of('--carmen-out'): 'FLASER 0\\nFLASER 0\\n',
         of('--out'): 'picture of ' + open(logs[0]).read(), of('--out').replace('.png', '.yaml'): 'image: map.png\\n'}
pose = dict(x_m=1.0, y_m=0.0, theta_deg=0.5)
alignment = dict(status='ok', reference=0, ref_from_query=pose, probability=0.9, covariance=[1.0, 0.0, 0.1])
scans = [dict(index=k, fragment=0, starts_fragment=k == 0, map_from_robot=pose, alignment=alignment if k else None,
              reason='') for k in range(2)]
report = dict(positions=scans, fragments=[dict(fragment=0)], seconds=dict(wall=WALL), loops=[
    dict(a=0, b=1, a_from_b=pose, strength=5.0)])
CHANGE
for name, text in files.items():
    open(name, 'w').write(text)
text = json.dumps(report)
if NEW_NAMES:
    for old, new in (('positions', 'scans'), ('fragments', 'components'), ('fragment', 'component')):
        text = text.replace('"%s"' % old, '"%s"' % new)
open(of('--report'), 'w').write(text)
"""


def made_up(folder: Path, name: str, change: str = "", new_names: bool = False, wall: float = 0.5) -> str:
    body = MAPPER.replace("CHANGE", change).replace("NEW_NAMES", str(new_names)).replace("WALL", str(wall))
    return str(program(folder / name, body))


@pytest.fixture
def log(tmp_path: Path) -> str:
    (tmp_path / "a.log").write_text("of two scans", encoding="utf-8")
    return str(tmp_path / "a.log")


def cells(out: str, log: str) -> dict[str, str]:
    """The row of a log, by output."""
    line = next(line for line in out.splitlines() if line.startswith(f"| {log} |"))
    return dict(zip(OUTPUTS, [cell.strip() for cell in line.strip("|").split("|")][1:], strict=True))


def test_new_names_of_members_and_other_times_are_no_difference(
    tmp_path: Path, log: str, capsys: pytest.CaptureFixture[str]
) -> None:
    clis = [made_up(tmp_path, "before"), made_up(tmp_path, "after", new_names=True, wall=0.7)]
    assert same_command.main([*clis, log, "--jobs", "1"]) == 0
    out = capsys.readouterr().out
    assert set(cells(out, log).values()) == {"same"}
    assert out.endswith("1 of 1 logs are the same in all\n")


@pytest.mark.parametrize(
    ("change", "output", "where"),
    [
        ("files[of('--trajectory')] += '3 2 0 0 0 0 0 1\\n'", "trajectory", "from entry 2 on, 0 differ, 2 and 3"),
        ("files[of('--out')] += '!'", "picture", "23 and 24 bytes"),
        ("files[of('--out').replace('.png', '.yaml')] += 'x'", "map.yaml", "from entry 1 on"),
        ("files[of('--carmen-out')] = 'FLASER 0\\nFLASER 1\\n'", "CARMEN log", "from entry 1 on, 1 differ of 2"),
        ("alignment['ref_from_query'] = dict(pose, x_m=1.0000000000000002)", "motions", "from entry 1 on"),
        ("scans[0]['map_from_robot'] = None", "motions", "from entry 0 on, 1 differ of 2"),
        ("scans[1]['fragment'] = 1", "motions", "from entry 1 on"),
        ("alignment['probability'] = 0.8", "probabilities", "from entry 1 on"),
        ("alignment['covariance'] = None", "covariances", "from entry 1 on"),
        ("scans[1]['reason'] = 'a guess'", "reasons", "from entry 1 on"),
        ("report['loops'][0]['strength'] = 6.0", "loops", ""),
        ("report['loops'] = []", "loops", "from entry 0 on, 0 differ, 1 and 0 in all"),
    ],
)
def test_what_differs_is_named_and_nothing_else(
    tmp_path: Path, log: str, capsys: pytest.CaptureFixture[str], change: str, output: str, where: str
) -> None:
    clis = [made_up(tmp_path, "before"), made_up(tmp_path, "after", change)]
    found = tmp_path / "same.json"
    assert same_command.main([*clis, log, "--jobs", "1", "--json", str(found)]) == 1
    out = capsys.readouterr().out
    assert {name for name, verdict in cells(out, log).items() if verdict == "different"} == {output}
    assert f"{log}: {output}: {where}" in out
    differences = json.loads(found.read_text(encoding="utf-8"))["logs"][0]["differences"]
    assert [name for name, said in differences.items() if said] == [output]


def test_a_file_that_is_not_written_differs_from_one_that_is(
    tmp_path: Path, log: str, capsys: pytest.CaptureFixture[str]
) -> None:
    clis = [made_up(tmp_path, "before"), made_up(tmp_path, "after", "del files[of('--carmen-out')]")]
    assert same_command.main([*clis, log]) == 1
    assert cells(capsys.readouterr().out, log)["CARMEN log"] == "different"


def test_a_log_that_gives_no_map_is_not_the_same(tmp_path: Path, log: str, capsys: pytest.CaptureFixture[str]) -> None:
    broken = made_up(tmp_path, "broken", "sys.exit('out of luck')")
    assert same_command.main([broken, broken, log]) == 1
    out = capsys.readouterr().out
    assert f"| {log} | no map: before and after | |" in out
    assert f"{log}: after: exit code 1: out of luck" in out


def test_a_report_without_what_each_has_is_no_comparison(
    tmp_path: Path, log: str, capsys: pytest.CaptureFixture[str]
) -> None:
    other = made_up(tmp_path, "other", "for scan in scans: scan['where'] = scan.pop('map_from_robot')")
    assert same_command.main([other, other, log]) == 1
    assert "after: the scans of the report have no member map_from_robot" in capsys.readouterr().out


def test_both_programs_get_what_is_passed_on_and_logs_with_plus_together(
    tmp_path: Path, log: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "b.log").write_text("more", encoding="utf-8")
    check = "assert words[-4:] == ['--threads', '2', '--method', 'paper'] and len(logs) == 2"
    clis = [made_up(tmp_path, "before", check), made_up(tmp_path, "after", check)]
    both = f"{log}+{tmp_path / 'b.log'}"
    words = ["--arg=--threads", "--arg=2", "--args", "--method", "paper"]
    assert same_command.main([*clis, both, *words]) == 0
    assert set(cells(capsys.readouterr().out, both).values()) == {"same"}


def test_arenas_are_simulated_for_both(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    check = "files[of('--trajectory')] = open(logs[0]).read()"
    clis = [made_up(tmp_path, "before", check), made_up(tmp_path, "after", check)]
    assert same_command.main([*clis, "--arenas", "2"]) == 0
    assert capsys.readouterr().out.count("| arena ") == 2


def test_every_file_is_compared_with_its_own() -> None:
    assert set(FILES) < set(OUTPUTS)
    assert first_difference([b"a"], [b"a"]) == ""
    assert first_difference([], [b"a"]) == "from entry 0 on, 0 differ, 0 and 1 in all"


@pytest.mark.parametrize("words", [[], ["a"], ["/nowhere", "/nowhere", "a.log"], ["/bin/true", "/bin/true"]])
def test_wrong_usage(words: list[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        same_command.main(words)
