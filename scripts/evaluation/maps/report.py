# SPDX-License-Identifier: GPL-3.0-or-later
"""The report: one HTML page that holds its pictures, the same as Markdown, and a snapshot for the documentation."""

from __future__ import annotations

import argparse
import base64
import html
import shutil
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from evaluation.common.files import write_whole
from evaluation.logs.evaluation_log import EvaluationLog

from . import pictures, tables
from .sections import Section, as_markdown
from .snapshot import write_snapshot

STYLE = (
    "body{font:15px/1.5 sans-serif;max-width:1200px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0;font-size:13px}td,th{border:1px solid #ccc;padding:2px 7px;"
    "text-align:left}th{background:#f0f0f0}img{max-width:100%}.failed{color:#b00000}code{background:#f4f4f4}"
)


def write_report(results: dict[str, Any], logs: dict[str, EvaluationLog], arguments: argparse.Namespace) -> None:
    """report.html, report.md and pictures/ in --out, and the snapshot if one is asked for."""
    out: Path = arguments.out
    folder = out / "pictures"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    tabled = table_sections(results)
    drawn: Counter[tuple[str, str]] = Counter()
    pictured = [section for log in logs.values() for section in log_sections(results, log, arguments, drawn)]
    title = "Evaluation" + ("" if results["complete"] else " (interrupted: not all runs are in it)")
    write_whole(out / "report.html", as_html(title, [*tabled, *pictured]))
    write_whole(out / "report.md", as_markdown(title, [*tabled, *pictured], out))
    if arguments.snapshot:
        write_snapshot(arguments.snapshot, tabled, pictured, arguments.snapshot_logs)


def table_sections(results: dict[str, Any]) -> list[Section]:
    data = tables.frame(results)
    with_reference = [log["name"] for log in results["logs"] if log["reference"] in ("exact", "slam")]
    judged = data[data["log"].isin(with_reference)] if len(data) else data
    sections = [about_section(results)]
    failed = tables.failure_table(results)
    if len(failed):
        sections.append(Section("Failed runs", [f"{len(failed)} of {len(data)} runs failed."], [failed], kind="about"))
    if len(judged):
        sections.append(Section("Scores by data set", [tables.NOTES], [tables.summary_table(judged)], kind="scores"))
    relations = tables.relations_table(results)
    if len(relations):
        text = "Relations between scans, made by hand: mean and standard deviation of the absolute errors, mean of the "
        text += "squares. The ceiling aligns the two scans of a relation, started at the relation; the rest is chains."
        sections.append(Section("Relations", [text], [relations], kind="relations"))
    sections += comparison_sections(results)
    if len(costs := tables.cost_table(data, results)):
        sections.append(Section("Logs without reference: maps and timing only", [], [costs], kind="costs"))
    if len(judged) and judged["log"].nunique() > judged["group"].nunique():
        sections.append(Section("Scores by log", [], [tables.summary_table(judged, "log")], kind="scores by log"))
    return sections


def about_section(results: dict[str, Any]) -> Section:
    machine = results["machine"]
    changes = " with changes" if results["commit_has_changes"] else ""
    text = [
        f"Made by `{results['command']}` on {results['created']}, commit {results['commit'] or 'unknown'}{changes}, in "
        f"{results['wall_s']:.0f} s with {results['options']['jobs']} runs at a time on {machine['num_cpus']} CPUs "
        f"({machine['cpu']})."
    ]
    text += [f"SKIPPED, missing: {skipped['name']}" for skipped in results["skipped"]]
    return Section("What was run", text, [tables.data_table(results)], kind="about")


def comparison_sections(results: dict[str, Any]) -> list[Section]:
    sections = [Section("Comparisons", [tables.PAIRED_NOTES])]
    for title, a, b in tables.questions(results["methods"]):
        text, compared = tables.comparison_table(results, a, b)
        known = {"question": title, "A is": a, "B is": b}
        sections.append(Section(title, [text], [compared], level=3, kind="comparison", known=known))
    return sections if len(sections) > 1 else []


def log_sections(
    results: dict[str, Any], log: EvaluationLog, arguments: argparse.Namespace, drawn: Counter[tuple[str, str]]
) -> list[Section]:
    """Trajectories, errors, maps, and pictures of pairs that failed: `drawn` counts these by data set and method."""
    folder = arguments.out / "pictures"
    runs = [run for run in results["runs"] if run["log"] == log.name]
    methods, folders = (
        results["methods"],
        {run["method"]: arguments.out / "runs" / log.name / run["method"] for run in runs},
    )
    section = Section(f"{log.name}", [f"{len(log)} positions; {log.spec.sensor}."])
    paths = {kind: folder / f"{log.name}_{kind}.png" for kind in ("trajectories", "errors", "maps")}
    if pictures.save_trajectories(paths["trajectories"], log, runs, methods):
        section.pictures.append((paths["trajectories"], f"{log.name}: trajectories (reference grey)"))
    if pictures.save_errors(paths["errors"], runs, methods):
        section.pictures.append((paths["errors"], f"{log.name}: position errors, and errors of pairs"))
    if pictures.save_maps(paths["maps"], log, runs, folders):
        section.pictures.append((paths["maps"], f"{log.name}: the maps that the programs drew"))
    if log.reference is None:
        what = "judged by relations only" if log.relations else "maps and timing only"
        section.text.append(f"No reference poses: {what}.")
    sections = [section]
    for run in runs:
        room = arguments.most_failures - drawn[log.spec.group, run["method"]]
        found = failure_sections(log, run, room, folder)
        drawn[log.spec.group, run["method"]] += sum(len(each.pictures) for each in found)
        sections += found
    return sections


def failure_sections(log: EvaluationLog, run: dict[str, Any], most: int, folder: Path) -> list[Section]:
    """None, or one with at most so many pictures."""
    sections = []
    if run["status"] == "ok" and most > 0:
        name, run_folder = f"{log.name}_{run['method']}", folder.parent / "runs" / log.name / run["method"]
        paths, num_wrong = pictures.save_failures(folder / name, log, run, most, run_folder)
        if paths:
            text = (
                f"{num_wrong} of {len(run['pairs']['right'])} pairs are wrong; the first {len(paths)} of them. Grey: "
            )
            text += "the scan before; left the reference pose, right what was found."
            shown = [(path, f"{log.name}, {run['method']}: {path.stem}") for path in paths]
            sections.append(Section(f"{log.name}: failures of {run['method']}", [text], [], shown, level=3))
    return sections


def as_html(title: str, sections: Sequence[Section]) -> str:
    parts = [f"<h1>{html.escape(title)}</h1>"]
    for section in sections:
        parts.append(f"<h{section.level}>{html.escape(section.title)}</h{section.level}>")
        parts += [f"<p{failed_class(text)}>{html.escape(text)}</p>" for text in section.text]
        parts += [data.to_html(index=False, border=0) for data in section.tables if len(data)]
        parts += [picture_html(path, caption) for path, caption in section.pictures]
    head = f'<meta charset="utf-8"><title>{html.escape(title)}</title><style>{STYLE}</style>'
    return f'<!doctype html><html lang="en"><head>{head}</head><body>\n' + "\n".join(parts) + "\n</body></html>\n"


def failed_class(text: str) -> str:
    return ' class="failed"' if text.startswith("SKIPPED") or "runs failed" in text else ""


def picture_html(path: Path, caption: str) -> str:
    data = base64.b64encode(path.read_bytes()).decode("ascii")
    caption = html.escape(caption)
    return (
        f'<figure><img alt="{caption}" src="data:image/png;base64,{data}"><figcaption>{caption}</figcaption></figure>'
    )
