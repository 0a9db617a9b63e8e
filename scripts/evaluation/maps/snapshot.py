# SPDX-License-Identifier: GPL-3.0-or-later
"""A snapshot of a report for the documentation: a short page, and the long tables as files in a folder beside it."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from evaluation.common.files import write_whole

from .sections import Section, as_markdown

# Kinds of sections, the file that each becomes, and what is in it.
LONG_TABLES = {
    "scores": ("scores.csv", "every score of each method on each data set, the ceiling in square brackets"),
    "scores by log": ("scores_by_log.csv", "the same for each log"),
    "relations": ("relations.csv", "errors against relations between scans that were made by hand"),
    "comparison": ("comparisons.csv", "every score of two methods, paired, with intervals and tests"),
    "costs": ("costs.csv", "logs without a reference: what was placed, time and memory"),
}
WHOLE = "all, mean of"  # how rows over all data sets begin
READ_SCORES = ("right pairs", "ATE")


def value_alone(cell: str) -> str:
    """`98.2 % (96.4-99.1) [100.0 %]` is `98.2 %`."""
    return cell.split(" (")[0].split(" [")[0].split(" ± ")[0]


def side_by_side(data: pd.DataFrame, column: str) -> pd.DataFrame:
    """One column of a long table with a row for each data set and a column for each method. Runs that failed are
    named in their cell."""
    rows: dict[str, dict[str, str]] = {}
    methods = dict.fromkeys(name.split(" FAILED")[0] for name in data["method"])
    for _, line in data.iterrows():
        row = rows.setdefault(line["data"], {"data": line["data"], **dict.fromkeys(methods, "-")})
        method, failed, count = line["method"].partition(" FAILED")
        row[method] = value_alone(str(line[column])) + (f" (failed{count})" if failed else "")
    return pd.DataFrame(rows.values())


def of_kind(sections: Sequence[Section], kind: str) -> pd.DataFrame:
    """All tables of one kind below each other, with what is known of each in front."""
    parts = []
    for section in sections:
        for data in section.tables if section.kind == kind else []:
            parts.append(data.assign(**section.known)[[*section.known, *data.columns]])
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def read_sections(sections: Sequence[Section]) -> list[Section]:
    """What a person reads of the long tables."""
    chosen = []
    scores, relations = of_kind(sections, "scores"), of_kind(sections, "relations")
    for title, data, column in (
        ("Right pairs", scores, "right pairs (95 %)"),
        ("Absolute trajectory error", scores, "ATE"),
        ("Relations between scans, made by hand: mean error in metres", relations, "translation"),
        ("CPU time per scan", scores, "CPU per scan"),
    ):
        if len(data):
            chosen.append(Section(title, [], [side_by_side(data, column)]))
    compared = of_kind(sections, "comparison")
    if len(compared):
        compared = compared[compared["data"].str.startswith(WHOLE) & compared["score"].isin(READ_SCORES)]
    if len(compared):
        columns = ["A is", "B is", "score", "A", "B", "B - A", "95 % interval of B - A", "p"]
        text = "Means over all data sets, or over all logs; docs/evaluation.md says how they are compared."
        chosen.append(Section("Comparisons", [text], [compared[columns]]))
    return chosen


def write_long_tables(folder: Path, sections: Sequence[Section]) -> Section:
    """The files, and a section that lists them."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = []
    for kind, (name, what) in LONG_TABLES.items():
        data = of_kind(sections, kind)
        if not len(data):
            (folder / name).unlink(missing_ok=True)  # of a former snapshot
        else:
            write_whole(folder / name, data.to_csv(index=False, lineterminator="\n"))
            lines.append(f"- [{name}]({folder.name}/{name}): {what}")
    return Section("All numbers", ["\n".join(lines)])


def with_pictures(path: Path, sections: Sequence[Section], logs: Sequence[str]) -> list[Section]:
    """The sections of the chosen logs, with copies of their pictures in pictures/ beside the page."""
    chosen = []
    for section in sections:
        if section.title not in logs:
            continue
        copies = []
        for source, caption in section.pictures:
            copy = path.parent / "pictures" / f"results_{source.name}"
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, copy)
            copies.append((copy, caption))
        chosen.append(Section(section.title, section.text, section.tables, copies, section.level))
    missing = [name for name in logs if name not in {section.title for section in chosen}]
    if missing:
        chosen.append(Section("Not among the logs that were run", [", ".join(missing)]))
    return chosen


def write_snapshot(path: Path, tabled: Sequence[Section], pictured: Sequence[Section], logs: Sequence[str]) -> None:
    """The page, the long tables in the folder that is called as the page, and the pictures of the chosen logs (not of
    their failures) in pictures/."""
    path.parent.mkdir(parents=True, exist_ok=True)
    about = [section for section in tabled if section.kind == "about"]
    listed = write_long_tables(path.with_suffix(""), tabled)
    shown = with_pictures(path, pictured, logs)
    write_whole(path, as_markdown("Results", [*about, *read_sections(tabled), listed, *shown], path.parent))
