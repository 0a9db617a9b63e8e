# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the figures come from: traces that exist, or a log that is mapped for them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from evaluation.common.programs import Failure, run_quietly
from evaluation.common.project import found_log

from .trace import Trace, is_trace, read_trace


@dataclass(frozen=True)
class Source:
    """A run, the same run with each scan aligned to a single other one if there is that, and the log if it is known."""

    name: str
    main: Trace
    pairwise: Trace | None
    log: Path | None


def stem(path: Path) -> str:
    return path.name.split(".")[0]


def run_cli(cli: Path, log: Path, trace: Path, arguments: list[str]) -> Trace:
    """Raises Failure with the program's last line when it gives no map."""
    trace.parent.mkdir(parents=True, exist_ok=True)
    command = [cli, log, "--out", trace.with_name(f"{stem(trace)}.map.png"), "--trace", trace, "--force", "--quiet"]
    try:
        run_quietly([*command, *arguments])
    except Failure as failure:
        raise Failure(f"{log.name}: {failure}") from None
    return read_trace(trace)


def map_log(cli: Path, log: Path, folder: Path, method: str, arguments: list[str]) -> Source:
    """Maps a log, with the paper's method also pairwise, and keeps the traces in `folder`."""
    main = run_cli(cli, log, folder / "trace.jsonl", ["--method", method, *arguments])
    pairwise = None
    if method == "paper":
        one = ["--method", method, *arguments, "--target-scans", "1"]
        pairwise = run_cli(cli, log, folder / "trace_pairwise.jsonl", one)
    return Source(stem(log), main, pairwise, log)


def sources_of(inputs: list[Path], cli: Path, folder: Path, method: str, arguments: list[str]) -> list[Source]:
    """One source for each log and for each trace. A trace of pairwise alignments goes with another trace of the same
    log, wherever there is one."""
    sources, traces = [], []
    for given in inputs:
        path = found_log(given)
        if not path.is_file():
            raise ValueError(f"{given}: no such file")
        if is_trace(path):
            traces.append(read_trace(path))
        else:
            sources.append(map_log(cli, path, folder / stem(path), method, arguments))
    pairwise = {trace.run["log"]: trace for trace in traces if trace.is_pairwise}
    for trace in traces:
        of_same_log = [other for other in traces if other.run["log"] == trace.run["log"] and not other.is_pairwise]
        if trace.is_pairwise and of_same_log:
            continue
        companion = pairwise.get(trace.run["log"]) if trace.method == "paper" else None
        log = Path(trace.run["log"])
        sources.append(Source(stem(trace.path), trace, companion, log if log.is_file() else None))
    return sources
