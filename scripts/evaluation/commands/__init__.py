# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands of scripts/evaluate.py, a module each, which is loaded when it is asked for and imported by no other."""

from __future__ import annotations

import sys
from importlib import import_module

COMMANDS = {
    "run and judge": {
        "maps": "whole maps of all methods on all data sets, with a report",
        "logs": "is each scan of real logs placed right against the one before it?",
        "pairs": "single alignments: are they right, why not, and do they know it?",
        "arena": "how many consecutive positions of simulated arenas are aligned wrongly?",
        "arena-maps": "how many maps of simulated arenas are whole and right everywhere?",
        "variants": "real logs thinned, reversed and mirrored",
        "grounds": "simulated streets, a long corridor, an exhibition hall",
        "sweeps": "simulated walks with a laser whose sweeps are bent by motion",
        "contradictions": "are scans found that contradict the rest of the map?",
        "no-return": "are distances that mean no return found, and no surfaces taken for one?",
        "loops": "is each closed loop where the reference has it?",
        "separate-logs": "do logs of different buildings stay apart, and halves of one log join?",
        "hard-cases": "scenes that are hard for any mapper, with what is to be expected in each",
        "long-log": "how time and memory grow with a log",
    },
    "compare": {
        "compare": "two results of maps, paired over logs, seeds and pairs, with intervals and tests",
        "same": "are the results of two programs the same to the byte?",
        "ablation": "what each part of the robust method is worth",
    },
    "fit": {
        "fit-scores": "the score of a pose and the probability of an alignment, to real logs",
        "fit-edges": "how probable edges between consecutive keyframes are",
        "numbers": "all fitted weights and tolerances in tables, with what they were fitted to",
    },
    "simulate": {
        "simulate": "a rescue robot's laser log in a maze-like arena, with exact poses",
    },
    "figures": {
        "gallery": "the maps of many logs in one picture",
        "method-figures": "a figure for each stage of the robust method",
        "paper-figures": "the figures of the paper, step by step",
    },
}
USAGE = "usage: evaluate.py COMMAND [OPTIONS]\n       evaluate.py COMMAND --help"


def overview() -> str:
    """What --help says: all commands, a line each."""
    parts = [USAGE]
    for title, commands in COMMANDS.items():
        parts.append("\n".join([f"{title}:", *(f"  {name:<15} {what}" for name, what in commands.items())]))
    return "\n\n".join(parts)


def main(argv: list[str] | None = None) -> int:
    """Runs the command that the first word names. Status 2 for one that there is not."""
    words = sys.argv[1:] if argv is None else argv
    if words[:1] in (["--help"], ["-h"]):
        print(overview())
        return 0
    known = [name for commands in COMMANDS.values() for name in commands]
    if not words or words[0] not in known:
        said = f"no command '{words[0]}'" if words else "no command"
        print(f"{USAGE}\nevaluate.py: {said}; expected one of {', '.join(known)}", file=sys.stderr)
        return 2
    command = import_module(f"{__name__}.{words[0].replace('-', '_')}")
    status: int = command.main(words[1:])
    return status
