# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs jobs on several processes, each in a process of its own: one that dies takes no other with it, and Ctrl-C leaves
what is done."""

from __future__ import annotations

import contextlib
import json
import multiprocessing
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess
from typing import Any

from tqdm import tqdm

from .runs import Job, execute, failed, finished, write

GRACE_S = 5.0
LOOK_UP_S = 1.0  # a signal that comes just before a system call that waits is seen only after it
ENDING = (signal.SIGINT, signal.SIGTERM)
tqdm.monitor_interval = 0  # its thread and forked processes do not go together
FORK = multiprocessing.get_context("fork")  # children share the logs that are read already


@contextlib.contextmanager
def _no_signals() -> Iterator[None]:
    """Ctrl-C and SIGTERM wait until the end."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _work(job: Job) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # ends the program that runs, on the way out
    signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)
    try:
        execute(job)
    except Exception as error:  # whatever it is, it costs one run and is said
        write(job, failed(job, f"the evaluation of this run failed: {type(error).__name__}: {error}"))


class Schedule:
    """`fault` is told of each run that fails."""

    def __init__(self, jobs: Sequence[Job], num_processes: int, resume: bool, fault: Callable[[str], None]) -> None:
        self._waiting = list(jobs)
        self._num_processes, self._resume, self._fault = num_processes, resume, fault
        self._running: dict[BaseProcess, Job] = {}
        self._results: dict[tuple[str, str], dict[str, Any]] = {}
        self._bar = tqdm(total=len(jobs), unit="run", disable=None, file=sys.stderr, dynamic_ncols=True)

    def run(self) -> tuple[list[dict[str, Any]], bool]:
        """The results in the order of the jobs, and whether all were done: not after Ctrl-C."""
        order = [(job.log.name, job.method.name) for job in self._waiting]
        complete = True
        try:
            while self._waiting or self._running:
                self._start()
                self._collect()
        except KeyboardInterrupt:
            complete = False
            self._stop()
        finally:
            self._bar.close()
        return [self._results[name] for name in order if name in self._results], complete

    def _start(self) -> None:
        """As many as there is room for; a job waits for the one that feeds it."""
        for job in list(self._waiting):
            if len(self._running) >= self._num_processes:
                return
            if job.method.feed and (job.log.name, job.method.feed) not in self._results:
                continue
            self._waiting.remove(job)
            if self._resume and (earlier := finished(job)):
                self._done(job, earlier)
                continue
            process = FORK.Process(target=_work, args=(job,))
            job.result_path.unlink(missing_ok=True)
            with _no_signals():  # a process that was started is known, or Ctrl-C would not end it
                process.start()
                self._running[process] = job

    def _collect(self) -> None:
        if not self._running:
            return
        ready = wait([process.sentinel for process in self._running], LOOK_UP_S)
        for process in [process for process in self._running if process.sentinel in ready]:
            job = self._running.pop(process)
            process.join()
            self._resume_or_fail(job, process.exitcode)

    def _resume_or_fail(self, job: Job, exit_code: int | None) -> None:
        result = read(job)
        if result is None:
            result = failed(job, f"the evaluation of this run ended with exit code {exit_code}")
            write(job, result)
        self._done(job, result)

    def _done(self, job: Job, result: dict[str, Any]) -> None:
        self._results[job.log.name, job.method.name] = result
        self._bar.set_postfix_str(f"{job.log.name} {job.method.name}", refresh=False)
        self._bar.update()
        if result["status"] != "ok":
            tqdm.write(f"FAILED: {job.method.name} on {job.log.name}: {result['reason']}", file=sys.stderr)
            self._fault(result["reason"])

    def _stop(self) -> None:
        for process in self._running:
            process.terminate()
        for process in self._running:
            process.join(GRACE_S)
            if process.is_alive():
                process.kill()
                process.join()
        self._running.clear()


def read(job: Job) -> dict[str, Any] | None:
    """What the job wrote."""
    if not job.result_path.exists():
        return None
    result: dict[str, Any] = json.loads(job.result_path.read_text(encoding="utf-8"))
    return result
