# SPDX-License-Identifier: GPL-3.0-or-later
"""Made-up logs, data sets and programs for the tests of scripts/evaluation/."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from evaluation.logs.datasets import LogSpec
from evaluation.logs.evaluation_log import EvaluationLog, load
from evaluation.mapping.numbers import Numbers, parse_numbers
from evaluation.maps.methods import Programs, parse_method
from evaluation.maps.runs import Job

NUM_SCANS = 6
ODOMETRY = "7.125"  # stands in every odometry field

# Places position k at (k, 0), but the last one a metre too far. Knows --help, mapping and `align`.
MAPPER = f"""import json, sys
words = sys.argv[1:]
if '--help' in words:
    print('  --motions FILE  the motions' if MOTIONS else '  --out FILE')
    sys.exit()
log = open(words[1] if words[0] == 'align' else words[0]).read()
if '{ODOMETRY}' in log or ' reference ' in log:
    sys.exit('got odometry or poses')
num = sum(line.startswith(('FLASER', 'position')) for line in log.splitlines())
if words[0] == 'align':
    answers = []
    for line in open(words[words.index('--pairs') + 1]):
        i, j, *pose = line.split()
        refined = dict(pose=[float(p) for p in pose], score=1)
        answers.append(dict(reference=int(i), query=int(j), status='ok', reason='', probability=1, hypotheses=[],
                            given=refined, refined=refined))
    open(words[words.index('--out') + 1], 'w').writelines(json.dumps(a) + chr(10) for a in answers)
    sys.exit()
with open(words[words.index('--trajectory') + 1], 'w') as out:
    for k in range(num):
        out.write(f'{{k + 1}}.0 {{k + (k == num - 1)}} 0 0 0 0 0 1' + chr(10))
if '--motions' in words:
    open(words[words.index('--motions') + 1], 'w').write('motions')
"""

# Gives back the poses it is fed with, or stands still; vasco fails.
BASELINES = """import sys
words = sys.argv[1:]
def option(name):
    return words[words.index(name) + 1] if name in words else None
if words[0] == 'vasco':
    sys.exit('out of luck')
if option('--covariances') and open(option('--covariances')).read() != 'motions':
    sys.exit('no motions')
num = sum(line.startswith(('FLASER', 'position')) for line in open(words[1]))
still = ''.join(f'{k + 1}.0 0 0 0 0 0 0 1' + chr(10) for k in range(num))
open(option('--trajectory'), 'w').write(open(option('--poses')).read() if option('--poses') else still)
"""


def program(path: Path, body: str) -> Path:
    path.write_text(f"#!{sys.executable}\n{body}\n", encoding="utf-8")
    path.chmod(0o755)
    return path


def mapper(folder: Path, motions: bool = True) -> Path:
    return program(folder / "mapper", f"MOTIONS = {motions}\n{MAPPER}")


def carmen_text(num_scans: int = NUM_SCANS) -> str:
    """Scans of a wall, 1 m apart along x, with times 10.5, 11.5, ... s."""
    lines = []
    for k in range(num_scans):
        ranges = " ".join(f"{2 + 0.01 * (beam + k):.2f}" for beam in range(180))
        pose = f"{k}.0 0.0 0.0 {ODOMETRY} {ODOMETRY} {ODOMETRY}"
        lines += [f"ODOM {k}.0 {ODOMETRY} 0 0 0 0 {k} robot {k}", f"FLASER 180 {ranges} {pose} {k + 10}.5 robot {k}.5"]
    return "\n".join(lines) + "\n"


def line_log(folder: Path, reference: str = "slam", **fields: object) -> EvaluationLog:
    path = written_log(folder)
    spec = LogSpec("line", "line", "SICK", reference, path=path, **fields)  # type: ignore[arg-type]
    return load(spec, folder / "logs", Path("/no/cli"))


def job(folder: Path, method: str, log: EvaluationLog, programs: Programs, timeout_s: float = 20.0) -> Job:
    return Job(log, parse_method(method), programs, timeout_s, folder / "out")


def straight(num: int, step_m: float = 1.0) -> np.ndarray:
    return np.array([[k * step_m, 0.0, 0.0] for k in range(num)])


# What a made-up mapper answers to `numbers`: not what the real one has in use.
NUMBERS: Mapping[str, Mapping[str, Mapping[str, float]]] = {
    "matching": {
        "score": {
            **{"agree": 7.0, "cross_agree": 1.5, "crossed": -3.0, "residual_per_m": -40.0},
            **{"agree_offset": 0.05, "cross_agree_offset": 0.06, "crossed_offset": 0.03, "unclear_share": 0.5},
        },
        "match_probability": {
            **{"constant": -0.5, "per_margin": 0.7, "per_log_margin": 0.2, "per_score": 0.5, "per_log_agree": 1.0},
            **{"agree_offset": 0.04, "least_margin": 0.1, "full_margin": 15.0},
        },
        "odometry_probability": {"constant": 2.5, "per_log_odds": 0.6, "per_insufficient_view": -10.0},
    },
    "graph": {
        "steps": {"usual_slip_m": 0.5},
        "same_place": {"near_m": 0.1, "heading_rad": 0.17, "deviations": 3.0},
        "edge_support": {"little": 1.5},
    },
    "inference": {
        "agreement": {"same_candidate_m": 0.4, "same_candidate_rad": 0.14},
        "verification_weights": {
            **{"per_score": 0.7, "by_others": 3.0, "of_map": 1.0, "none_of_them": -5.0, "least_score": -12.0},
            **{"none_per_insufficient_view": 20.0, "per_log_deviation": -0.4, "by_parallel": 0.6},
        },
    },
}


def numbers_text() -> str:
    """NUMBERS as `shapemap-cli numbers` prints them."""
    entries = [
        {"room": room, "group": group, "title": group, "name": name, "value": value, "help": "x", "fitted_to": "y"}
        for room, groups in NUMBERS.items()
        for group, values in groups.items()
        for name, value in values.items()
    ]
    return json.dumps(entries)


def numbers() -> Numbers:
    return parse_numbers(numbers_text())


# Tells NUMBERS, or writes a report: of each log a fragment whose position k is at (k, 0). `change` may alter it, and
# knows the words that were passed on.
REPORTER = f"""import json, math, sys
words = sys.argv[1:]
if words == ['numbers']:
    print({json.dumps(numbers_text())})
    sys.exit()
logs, passed_on = words[:words.index('--out')], words[words.index('--force') + 1:]
positions, fragments = [], []
for log, path in enumerate(logs):
    text = open(path).read()
    if (not text.startswith('shapemap-scans') and '{ODOMETRY}' in text) or ' reference ' in text:
        sys.exit('got odometry or poses')
    num = sum(line.startswith(('FLASER', 'position')) for line in text.splitlines())
    fragments.append(dict(fragment=log, logs=[dict(log=log, num_positions=num)]))
    for k in range(num):
        positions.append(dict(index=len(positions), log=log, index_in_whole_log=k, is_keyframe=k % 2 == 0,
                              map_from_robot=dict(x_m=k, y_m=0.0, theta_deg=0.0)))
def loop(a, b, x_m, y_m=0.0, theta_deg=0.0, strength=5.0):
    return dict(a=a, b=b, a_from_b=dict(x_m=x_m, y_m=y_m, theta_deg=theta_deg), strength=strength)
report = dict(positions=positions, fragments=fragments, loops=[], num_positions=len(positions),
              num_placed=len(positions), seconds=dict(loops=0.5))
CHANGE
open(words[words.index('--report') + 1], 'w').write(json.dumps(report))
"""


def reporter(folder: Path, change: str) -> Path:
    """A mapper that writes reports of logs like `carmen_text()`."""
    return program(folder / "reporter", REPORTER.replace("CHANGE", change))


def written_log(folder: Path, name: str = "line", num_scans: int = NUM_SCANS) -> Path:
    path = folder / f"{name}.log"
    path.write_text(carmen_text(num_scans), encoding="utf-8")
    return path
