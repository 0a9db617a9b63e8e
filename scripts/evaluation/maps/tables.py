# SPDX-License-Identifier: GPL-3.0-or-later
"""Results as tables of text, the ceiling beside each score."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from typing import Any

import pandas as pd

from evaluation.common.shares import Share

from .comparison import EXPLANATION, HEAD, LOG_SCORES, as_cells, compare, paired_runs
from .methods import CEILING, parse_method
from .results import ResultsError

NONE = "-"


def frame(results: dict[str, Any]) -> pd.DataFrame:
    """A row for each run, with its numbers; NaN where there is none."""
    rows = []
    for run in results["runs"]:
        right = run["pairs"]["right"] if run["pairs"] else []
        seconds = (run["usage"] or {}).get("cpu_s")
        row = {key: run[key] for key in ("group", "log", "method", "status", "reason", "num_positions", "num_placed")}
        row |= {"num_right": sum(right), "num_pairs": len(right), "median error": median_error(run)}
        row |= {score.name: score.of(run) for score in LOG_SCORES}
        row["CPU per scan"] = None if seconds is None else 1000.0 * seconds / max(1, run["num_positions"])
        row["wall"] = (run["usage"] or {}).get("wall_s")
        rows.append(row)
    data = pd.DataFrame(rows)
    numbers = ["median error", *(score.name for score in LOG_SCORES), "CPU per scan", "wall"]
    return data.astype(dict.fromkeys(numbers, float)) if rows else data


def median_error(run: dict[str, Any]) -> float | None:
    """The median over the pairs with both positions in one fragment."""
    errors = [error for error in run["pairs"]["error_m"] if error is not None] if run["pairs"] else []
    return statistics.median(errors) if errors else None


def percent(value: float) -> str:
    return NONE if pd.isna(value) else f"{100 * value:.1f} %"


def metres(value: float) -> str:
    return NONE if pd.isna(value) else f"{value:.2f} m" if value >= 1 else f"{100 * value:.1f} cm"


def with_unit(unit: str, digits: int = 0) -> Callable[[float], str]:
    return lambda value: NONE if pd.isna(value) else f"{value:.{digits}f} {unit}"


SCORE_COLUMNS: dict[str, Callable[[float], str]] = {
    "median error": metres,
    "coverage": percent,
    "ATE": metres,
    "RPE": metres,
    "RPE over 10 m": metres,
    "map precision": percent,
    "map recall": percent,
}
COST_COLUMNS = {"CPU per scan": with_unit("ms"), "wall": with_unit("s", 1), "memory": with_unit("MiB")}


def _beside(text: str, ceiling: str) -> str:
    """`87.0 % [ceiling 99.0 %]`, as far as there is one."""
    return f"{text} [{ceiling}]" if NONE not in (ceiling, text) else text


def _cells(runs: pd.DataFrame, ceiling: pd.DataFrame) -> dict[str, str]:
    """The scores of some runs; those of the ceiling on the same logs in brackets."""
    is_ceiling = bool((runs["method"] == CEILING).all())
    pairs = Share(int(runs["num_right"].sum()), int(runs["num_pairs"].sum()))
    top = Share(int(ceiling["num_right"].sum()), int(ceiling["num_pairs"].sum()))
    brackets = NONE if is_ceiling or not top.total else percent(top.value)
    cells = {"right pairs (95 %)": _beside(str(pairs), brackets)}
    for name, text in SCORE_COLUMNS.items():
        top_text = NONE if is_ceiling or not len(ceiling) else text(ceiling[name].mean())
        cells[name] = _beside(text(runs[name].mean()), top_text)
    return cells | {name: text(runs[name].mean()) for name, text in COST_COLUMNS.items()}


def summary_table(data: pd.DataFrame, by: str = "group") -> pd.DataFrame:
    """A row for each method on each data set, or each log; means over its logs."""
    rows = []
    for name in dict.fromkeys(data[by]):
        here = data[data[by] == name]
        ceiling = here[(here["method"] == CEILING) & (here["status"] == "ok")]
        for method in dict.fromkeys(here["method"]):
            runs = here[here["method"] == method]
            num_failed = int((runs["status"] != "ok").sum())
            state = "" if not num_failed else f" FAILED {num_failed} of {len(runs)}"
            rows.append({"data": name, "method": method + state, "logs": str(len(runs)), **_cells(runs, ceiling)})
    return pd.DataFrame(rows)


def cost_table(data: pd.DataFrame, results: dict[str, Any]) -> pd.DataFrame:
    """The table of the logs without any reference: what was placed and what it took."""
    without = [log["name"] for log in results["logs"] if log["reference"] == "none"]
    rows = []
    for run in data[data["log"].isin(without)].to_dict("records"):
        state = "" if run["status"] == "ok" else " FAILED"
        costs = {name: text(run[name]) for name, text in COST_COLUMNS.items()}
        placed = f"{run['num_placed']} of {run['num_positions']}"
        rows.append({"data": run["log"], "method": run["method"] + state, "placed": placed, **costs})
    return pd.DataFrame(rows)


def relations_table(results: dict[str, Any]) -> pd.DataFrame:
    """Mean and standard deviation of the absolute errors, as published for other methods."""
    rows = []
    for run in results["runs"]:
        for found in run["relations"].values():
            row = {"data": run["log"], "file": found["file"], "method": run["method"]}
            row |= {"relations": str(found["num"]), "missed": str(found["num_missed"])}
            if found["num"]:
                row["translation"] = f"{found['mean_m']:.3f} ± {found['sd_m']:.3f} m"
                row["squared"] = f"{found['mean_squared_m']:.3f} m²"
                row["rotation"] = f"{found['mean_deg']:.2f} ± {found['sd_deg']:.2f} deg"
                row["median"] = f"{found['median_m']:.3f} m, {found['median_deg']:.2f} deg"
                row["over 0.5 m"] = percent(found["share_over_half_m"])
            rows.append(row)
    return pd.DataFrame(rows).fillna(NONE)


def data_table(results: dict[str, Any]) -> pd.DataFrame:
    """One row for a data set; arenas together."""
    rows: dict[str, dict[str, Any]] = {}
    for log in results["logs"]:
        row = rows.setdefault(
            log["group"], {"data": log["group"], "logs": 0, "positions": 0, "sensor": log["sensor"], "reference": ""}
        )
        row["logs"] += 1
        row["positions"] += log["num_positions"]
        row["reference"] = log["reference_is"]
    return pd.DataFrame(rows.values()).astype(str)


def failure_table(results: dict[str, Any]) -> pd.DataFrame:
    failed = [run for run in results["runs"] if run["status"] != "ok"]
    return pd.DataFrame([{"data": run["log"], "method": run["method"], "reason": run["reason"]} for run in failed])


def questions(methods: Sequence[str]) -> list[tuple[str, str, str]]:
    """What to compare within one evaluation: title, A, B."""
    asked = []
    if "paper" in methods and "robust" in methods:
        asked.append(("Is the robust method better than the paper's?", "paper", "robust"))
    for name in methods:
        method = parse_method(name)
        if not method.feed:
            continue
        what = "our estimates with their covariances" if method.needs_covariances else "our poses as odometry"
        asked.append((f"Does {method.base} improve the map when it gets {what}?", method.feed, name))
        plain = f"{method.base}+robust"
        if method.needs_covariances and plain in methods:
            asked.append((f"Do the covariances help {method.base}?", plain, name))
        if method.base in methods:
            asked.append((f"What do our poses give to {method.base}?", method.base, name))
    return asked


def comparison_table(results: dict[str, Any], method_a: str, method_b: str) -> tuple[str, pd.DataFrame]:
    """What A and B are, and the table; empty where the two have no log in common, or one of them failed on all."""
    text = f"A is {method_a}, B is {method_b}."
    try:
        runs = paired_runs(results, results, method_a, method_b, common_only=True)
    except ResultsError as error:
        return f"{text} {error}.", pd.DataFrame()
    for count, method in enumerate((method_a, method_b)):
        num_failed = sum(pair[count]["status"] != "ok" for pair in runs)
        if num_failed == len(runs):
            return f"{text} {method} failed on all {num_failed} logs: nothing to compare.", pd.DataFrame()
        if num_failed:
            text += f" {method} FAILED on {num_failed} of {len(runs)} logs, which counts as no pair right."
    return text, pd.DataFrame([as_cells(row) for row in compare(runs)], columns=list(HEAD))


NOTES = (
    "Right pairs: consecutive positions whose relative pose is within 0.20 m and 5 degrees of the reference, of all "
    "pairs, with Wilson's interval; a position without a place fails its pairs; median error: of those placed. In "
    "square brackets: the ceiling, what the refinement of the robust method (ICP to lines) reaches when it starts at "
    "the reference pose, chained. ATE: root mean square position error after alignment in the plane. RPE: that of the "
    "motion between placed positions, and over 10 m of path; both by evo. Map precision and recall: occupied 5 cm "
    "cells within 10 cm of one of the map at reference poses, and the other way round. Scores of maps are means over "
    "the runs that gave one; CPU, wall time and memory are those of the program, with the others beside it."
)
PAIRED_NOTES = EXPLANATION
