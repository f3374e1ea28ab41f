# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Child processes that end with this one, however it ends: SIGKILL included.

Every child has a session of its own, so that Ctrl-C reaches this process alone, which
then stops its children in order. A guard process (`guard`) is started before the first
child. Each child enrols there by a pipe before it becomes another program, and so does
each worker that is forked. The guard kills what is left, with the children of children,
when this process is gone.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from signal import SIGKILL, SIGTERM
from typing import Any

GUARD = Path(__file__).with_name("guard.py")

STOP_LIMIT = 1.0
"""How long a child may take to end when it is asked to, in s."""

_pipe: list[int] = []
"""The end of the guard's pipe that is written; empty before the first child."""

_guards: list[subprocess.Popen[bytes]] = []
"""The guard of this process, once there is one."""


def popen(
    words: Sequence[str | Path], *, core: int | None = None, **options: Any
) -> subprocess.Popen[Any]:
    """Start a program, on one ``core`` if given; other options as for `Popen`."""
    prepare = _nothing if core is None else _on_core(core)
    return subprocess.Popen(words, start_new_session=True, preexec_fn=prepare, **options)


@contextmanager
def running(words: Sequence[str | Path], **options: Any) -> Iterator[subprocess.Popen[Any]]:
    """A program for the time of a block: afterwards it is asked to end, and killed if need be."""
    with popen(words, **options) as process:
        try:
            yield process
        finally:
            stop(process)


def run(
    words: Sequence[str | Path], given: str | None = None, **options: Any
) -> subprocess.CompletedProcess[str]:
    """Run a program to its end, with a text on its input; as `subprocess.run` with text.

    Output and errors are captured unless the options say otherwise. The program is
    stopped when this process is interrupted meanwhile.
    """
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    stdin = subprocess.DEVNULL if given is None else subprocess.PIPE
    with running(words, stdin=stdin, **{**pipes, **options}) as process:
        output, errors = process.communicate(given)
    return subprocess.CompletedProcess(words, process.returncode, output, errors)


def run_watched(
    words: Sequence[str | Path], taken: Callable[[str], bool], **options: Any
) -> subprocess.CompletedProcess[str]:
    """Run a program to its end as `run` does, and show each line of its output to ``taken``.

    Lines for which that is true are left out of the output. Errors are part of it.
    """
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    with running(words, stdin=subprocess.DEVNULL, **{**pipes, **options}) as process:
        assert process.stdout is not None
        output = "".join(line for line in process.stdout if not taken(line))
        process.wait()
    return subprocess.CompletedProcess(words, process.returncode, output, "")


def stop(process: subprocess.Popen[Any]) -> None:
    """Ask a program and its session to end, and kill what does not; nothing if it has ended."""
    if process.poll() is not None:
        return
    with suppress(ProcessLookupError):
        os.killpg(process.pid, SIGTERM)
    try:
        process.wait(STOP_LIMIT)
    except subprocess.TimeoutExpired:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, SIGKILL)


def _start_guard() -> None:
    """Start the guard, once in a process, before anything is forked."""
    if _pipe:
        return
    reading, writing = os.pipe()
    with open(reading, "rb") as read:
        guard = subprocess.Popen(
            [sys.executable, "-I", "-S", GUARD],
            stdin=read,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
    _guards[:] = [guard]
    _pipe.append(writing)


def _enrol() -> None:
    """In a process just forked: the guard ends it when its parent is gone.

    Only the parent keeps the pipe, so that the guard sees its end; a worker that starts
    programs gets a guard of its own.
    """
    if _pipe:
        with suppress(OSError):
            os.write(_pipe[0], f"{os.getpid()}\n".encode())
        os.close(_pipe.pop())
    _guards.clear()


def _nothing() -> None:
    """Called between fork and exec: only with such a function are the hooks below called."""


def _on_core(core: int) -> Callable[[], None]:
    return lambda: os.sched_setaffinity(0, {core})


os.register_at_fork(before=_start_guard, after_in_child=_enrol)
