# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a program and writes what it took: `launcher.py USAGE.json PROGRAM ARGUMENT...`.

A process of its own, which imports next to nothing: the kernel counts the memory of whoever starts a program as that of
the program, and the evaluation itself is larger than what it measures.
"""

import json
import os
import sys
import time


def main() -> int:
    usage_path, *command = sys.argv[1:]
    started = time.monotonic()
    pid = os.posix_spawnp(command[0], command, os.environ)
    _, status, usage = os.wait4(pid, 0)
    code = os.waitstatus_to_exitcode(status)
    taken = {
        "exit_code": code,
        "wall_s": time.monotonic() - started,
        "cpu_s": usage.ru_utime + usage.ru_stime,
        "peak_memory_mib": usage.ru_maxrss / 1024,
    }
    with open(usage_path, "w", encoding="utf-8") as file:  # noqa: PTH123 - pathlib would double what is imported
        json.dump(taken, file)
    return code if code >= 0 else 128 - code


if __name__ == "__main__":
    sys.exit(main())
