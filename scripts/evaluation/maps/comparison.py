# SPDX-License-Identifier: GPL-3.0-or-later
"""Two methods, or two versions of one, compared on the same data: every number is a difference over the same logs,
seeds and pairs, with its interval.

What is drawn independently is resampled: of a data set with many logs (the seeds of an arena) the logs, of a single log
its pairs of positions or its relations. Single logs stay as they are, so the interval of all says how sure the
difference is on these logs, not on others. What there is one number of per log (ATE, memory) is resampled over logs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from .paired import Difference, Sample, paired_difference, sign_test
from .results import ResultsError

Run = dict[str, Any]
FEWEST_LOGS = 4  # for an interval over logs
SAME = 1e-12


@dataclass(frozen=True)
class Row:
    """`num_a` and `num_b`: cases in which only A, or only B, is right or better. `num_left_out`: where one has no
    value."""

    score: str
    where: str
    unit: str
    num: int
    what: str
    difference: Difference
    num_a: int
    num_b: int
    p: float
    num_left_out: int = 0


@dataclass(frozen=True)
class LogScore:
    """A score with one number for a log."""

    name: str
    unit: str
    of: Callable[[Run], float | None]
    more_is_better: bool = False


def _at(*path: str) -> Callable[[Run], float | None]:
    def get(run: Run) -> float | None:
        value: Any = run
        for key in path:
            value = value.get(key) if value else None
        return value

    return get


LOG_SCORES = (
    LogScore("coverage", "", _at("coverage"), more_is_better=True),
    LogScore("ATE", "m", _at("ate", "rmse_m")),
    LogScore("RPE", "m", _at("rpe", "rmse_m")),
    LogScore("RPE over 10 m", "m", _at("rpe_10m", "rmse_m")),
    LogScore("map precision", "", _at("map_agreement", "precision"), more_is_better=True),
    LogScore("map recall", "", _at("map_agreement", "recall"), more_is_better=True),
    LogScore("CPU", "s", _at("usage", "cpu_s")),
    LogScore("memory", "MiB", _at("usage", "peak_memory_mib")),
)


def paired_runs(
    results_a: Run, results_b: Run, method_a: str, method_b: str, common_only: bool = False
) -> list[tuple[Run, Run]]:
    """The runs of both on each log. Raises ResultsError when they are not on the same data: other logs (unless only the
    common ones are asked for), other contents of a log, other limits."""
    if results_a["limits"] != results_b["limits"]:
        raise ResultsError(f"other limits: {results_a['limits']} and {results_b['limits']}")
    runs_a = {run["log"]: run for run in results_a["runs"] if run["method"] == method_a}
    runs_b = {run["log"]: run for run in results_b["runs"] if run["method"] == method_b}
    for runs, method in ((runs_a, method_a), (runs_b, method_b)):
        if not runs:
            raise ResultsError(f"no run of {method}")
    single = sorted(set(runs_a) ^ set(runs_b))
    if single and not common_only:
        raise ResultsError(f"only one of the two has {', '.join(single)}; see --common")
    both = [(runs_a[log], runs_b[log]) for log in runs_a if log in runs_b]
    if not both:
        raise ResultsError("no log in common")
    for a, b in both:
        _check_same_data(a, b)
    return both


def _check_same_data(a: Run, b: Run) -> None:
    """Raises ResultsError. Our methods draw nothing and have no seed."""
    if a["sha256"] != b["sha256"]:
        raise ResultsError(f"{a['log']}: not the same data in both")
    if None not in (a["seed"], b["seed"]) and a["seed"] != b["seed"]:
        raise ResultsError(f"{a['log']}: seed {a['seed']} and {b['seed']}")


def compare(pairs_of_runs: Sequence[tuple[Run, Run]]) -> list[Row]:
    """All scores that both have, each by data set and over all."""
    rows = [*_over_draws(pairs_of_runs, "right pairs", "", _right, True)]
    rows += _over_draws(pairs_of_runs, "error of pairs", "m", _pair_error, False)
    rows += _over_draws(pairs_of_runs, "relations", "m", _relation_error(0), False)
    rows += _over_draws(pairs_of_runs, "relations", "deg", _relation_error(1), False)
    for score in LOG_SCORES:
        rows += _over_logs(pairs_of_runs, score)
    return rows


Values = list[tuple[float, float]]  # of A and B


def _right(a: Run, b: Run) -> tuple[Values, int] | None:
    if not a["pairs"] or not b["pairs"]:
        return None
    return list(zip(a["pairs"]["right"], b["pairs"]["right"], strict=True)), 0


def _pair_error(a: Run, b: Run) -> tuple[Values, int] | None:
    """The errors of the pairs that both get right: how precise is either?"""
    if not a["pairs"] or not b["pairs"]:
        return None
    right = [k for k, both in enumerate(zip(a["pairs"]["right"], b["pairs"]["right"], strict=True)) if all(both)]
    values = [(a["pairs"]["error_m"][k], b["pairs"]["error_m"][k]) for k in right]
    return values, len(a["pairs"]["right"]) - len(values)


def _relation_error(column: int) -> Callable[[Run, Run], tuple[Values, int] | None]:
    def get(a: Run, b: Run) -> tuple[Values, int] | None:
        kinds = [kind for kind in ("scan_relations", "relations") if kind in a["relations"] and kind in b["relations"]]
        if not kinds:
            return None
        both = list(zip(a["relations"][kinds[0]]["errors"], b["relations"][kinds[0]]["errors"], strict=True))
        values = [(x[column], y[column]) for x, y in both if x is not None and y is not None]
        return values, len(both) - len(values)

    return get


def _over_draws(
    runs: Sequence[tuple[Run, Run]],
    score: str,
    unit: str,
    values_of: Callable[[Run, Run], tuple[Values, int] | None],
    more_is_better: bool,
) -> list[Row]:
    """One row for each data set, one for all when there are several."""
    by_group: dict[str, list[Values]] = {}
    left_out: dict[str, int] = {}
    for a, b in runs:
        found = values_of(a, b)
        if found is not None:
            by_group.setdefault(a["group"], []).append(found[0])
            left_out[a["group"]] = left_out.get(a["group"], 0) + found[1]
    samples = {group: _samples(logs) for group, logs in by_group.items()}
    groups = [group for group, drawn in samples.items() if drawn]
    rows = []
    for where in [[group] for group in groups] + ([groups] if len(groups) > 1 else []):
        values = [pair for group in where for log in by_group[group] for pair in log]
        name = where[0] if len(where) == 1 else "all, mean of the data sets"
        what = "relations" if score == "relations" else "pairs"
        if len(where) == 1 and len(by_group[name]) > 1:
            what += f" of {len(by_group[name])} logs"
        difference = paired_difference([samples[group] for group in where])
        rows.append(_row(score, name, unit, what, values, difference, more_is_better, sum(left_out[g] for g in where)))
    return rows


def _samples(logs: Sequence[Values]) -> list[Sample]:
    """The draws: each log where there are several, and each value of a single one."""
    draws: Sequence[Values] = [[pair] for pair in logs[0]] if len(logs) == 1 else logs
    return [Sample(sum(a for a, _ in draw), sum(b for _, b in draw), len(draw)) for draw in draws if draw]


def _over_logs(runs: Sequence[tuple[Run, Run]], score: LogScore) -> list[Row]:
    by_group: dict[str, Values] = {}
    num_left_out: dict[str, int] = {}
    for run_a, run_b in runs:
        a, b = score.of(run_a), score.of(run_b)
        by_group.setdefault(run_a["group"], [])
        if a is None or b is None:
            num_left_out[run_a["group"]] = num_left_out.get(run_a["group"], 0) + 1
        else:
            by_group[run_a["group"]].append((a, b))
    wheres = [(group, values) for group, values in by_group.items() if len(values) >= FEWEST_LOGS]
    everything = [pair for values in by_group.values() for pair in values]
    if len(by_group) > 1 and len(everything) >= FEWEST_LOGS:
        wheres.append(("all, mean of the logs", everything))
    rows = []
    for where, values in wheres:
        difference = paired_difference([[Sample(a, b, 1) for a, b in values]])
        left_out = num_left_out.get(where, 0) if where in by_group else sum(num_left_out.values())
        rows.append(_row(score.name, where, score.unit, "logs", values, difference, score.more_is_better, left_out))
    return rows


def _row(
    score: str,
    where: str,
    unit: str,
    what: str,
    values: Values,
    difference: Difference,
    more_is_better: bool,
    num_left_out: int,
) -> Row:
    sign = 1.0 if more_is_better else -1.0
    num_a = sum(sign * (a - b) > SAME for a, b in values)
    num_b = sum(sign * (b - a) > SAME for a, b in values)
    p = sign_test(num_a, num_b)
    return Row(score, where, unit, len(values), what, difference, num_a, num_b, p, num_left_out)


def as_cells(row: Row) -> list[str]:
    """The cells of a row for a table."""
    share, metres = row.unit == "", row.unit == "m"
    scale, unit, digits = (100.0, " %", 1) if share else (100.0, " cm", 1) if metres else (1.0, f" {row.unit}", 2)
    values = row.difference
    interval = "too few for one"
    if values.interval:
        interval = " to ".join(f"{scale * bound:+.{digits}f}" for bound in values.interval)
    left_out = f", {row.num_left_out} left out" if row.num_left_out else ""
    return [
        *[row.score, row.where, f"{row.num} {row.what}{left_out}"],
        *[f"{scale * values.mean_a:.{digits}f}{unit}", f"{scale * values.mean_b:.{digits}f}{unit}"],
        *[f"{scale * values.value:+.{digits}f}{unit}", interval, str(row.num_a), str(row.num_b), f"{row.p:.2g}"],
    ]


HEAD = (
    *("score", "data", "number", "A", "B", "B - A", "95 % interval of B - A", "only A right, or A better"),
    *("only B right, or B better", "p"),
)
EXPLANATION = (
    "A and B are on the same logs, seeds and pairs. The interval is a percentile bootstrap of the paired difference "
    "(4000 resamples, fixed seed): logs are resampled where a data set has several, else the pairs or relations of the "
    "one log. p is that of the exact two-sided sign test, which for right pairs is McNemar's; where fewer than five "
    "pairs decide, or there are fewer than ten logs, trust it more than the interval. No correction is made for the "
    "number of rows. Errors of pairs are over those that both get right; relations over those that both placed. A "
    "failed run gets no pair right, and is left out of the scores that need a map."
)
