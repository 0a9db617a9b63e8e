# SPDX-License-Identifier: GPL-3.0-or-later
"""Methods that can be evaluated, by name, and the commands that run them.

robust, paper               shapemap itself
mrpt-icp, mrpt-rbpf, vasco  baselines that get nothing but the scans
BASELINE+robust, +paper     the same with our estimated poses as odometry
mrpt-rbpf+covariances       the particle filter with the robust method's motions and covariances as its motion model
ceiling                     consecutive scans aligned by the refinement of the robust method, started at the
                            reference pose; needs reference poses
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from evaluation.common.programs import Failure, has_option
from evaluation.mapping.mapper import METHOD_ARGUMENTS

OURS = ("robust", "paper")
BASELINES = ("mrpt-icp", "mrpt-rbpf", "vasco")
COVARIANCES = "covariances"
WITH_COVARIANCES = ("mrpt-rbpf", "vasco")  # they have a motion model
CEILING = "ceiling"
FEEDS = ("out.tum", "motions.txt")  # what the baselines are fed with, in the folder of the method that feeds them
ALL = (
    *(*OURS, CEILING, "mrpt-icp", "mrpt-icp+robust", "mrpt-rbpf", "mrpt-rbpf+robust", f"mrpt-rbpf+{COVARIANCES}"),
    *("vasco", "vasco+robust"),
)


@dataclass(frozen=True)
class Method:
    """`feed` is what a baseline gets as odometry: empty, or one of ours; `needs_covariances` comes with robust."""

    name: str
    base: str
    feed: str = ""
    needs_covariances: bool = False

    @property
    def is_ours(self) -> bool:
        return self.base in OURS


def parse_method(name: str) -> Method:
    """Raises ValueError for a name that there is not."""
    base, plus, feed = name.partition("+")
    if not plus and base in (*OURS, *BASELINES, CEILING):
        return Method(name, base)
    if base in BASELINES and feed in OURS:
        return Method(name, base, feed)
    if base in WITH_COVARIANCES and feed == COVARIANCES:
        return Method(name, base, "robust", True)
    raise ValueError(
        f"no method '{name}'; there are {', '.join(ALL)}, vasco+covariances, and each +robust with +paper instead"
    )


def with_feeds(names: list[str]) -> list[Method]:
    """The methods, each once, with those that they are fed by, in the order of tables."""
    methods: dict[str, Method] = {}
    for name in names:
        method = parse_method(name)
        if method.feed:
            methods.setdefault(method.feed, parse_method(method.feed))
        methods.setdefault(name, method)
    return sorted(methods.values(), key=lambda method: ALL.index(method.name) if method.name in ALL else len(ALL))


@dataclass(frozen=True)
class Programs:
    """`arguments` are passed on to shapemap-cli, `baseline_arguments` to shapemap-baselines."""

    cli: Path
    baselines: Path
    arguments: tuple[str, ...] = ()
    baseline_arguments: tuple[str, ...] = ()
    seed: int = 0


def mapper_arguments(base: str, keeps_heading: bool) -> list[str]:
    """The paper's own grid of rotations is for robots that keep their heading."""
    return ["--method", "paper"] if base == "paper" and keeps_heading else METHOD_ARGUMENTS[base]


def our_command(programs: Programs, method: Method, log: Path, folder: Path, keeps_heading: bool) -> list[object]:
    """Also writes what baselines need, as far as the program can."""
    command: list[object] = [programs.cli, log, "--out", folder / "map.png", "--trajectory", folder / "out.tum"]
    command += ["--report", folder / "report.json", "--quiet"]
    if method.base == "robust" and has_option(programs.cli, "--motions"):
        command += ["--motions", folder / "motions.txt"]
    return [*command, *mapper_arguments(method.base, keeps_heading), *programs.arguments]


def baseline_command(programs: Programs, method: Method, log: Path, folder: Path, feed: Path | None) -> list[object]:
    """`feed` is the folder with the results of the method that feeds this one. Raises Failure when something lacks."""
    command: list[object] = [programs.baselines, method.base, log, "--trajectory", folder / "out.tum"]
    command += ["--map", folder / "map.png", "--seed", programs.seed]
    if feed is not None:
        poses = feed / FEEDS[0]
        if not poses.exists():
            raise Failure(f"{method.feed} gave no poses to start from")
        command += ["--poses", poses]
    if feed is not None and method.needs_covariances:
        motions = feed / FEEDS[1]
        if not motions.exists():
            raise Failure(f"no covariances: {programs.cli.name} has no option --motions")
        command += ["--covariances", motions]
    return [*command, *programs.baseline_arguments]
