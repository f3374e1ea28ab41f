"""The bus server, for tests: built when it is first needed, and started on a free port."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import cache
from pathlib import Path

from ravenchart import bus

Start = Callable[..., str]
"""Starts a bus with such words beside the port; its channel."""


@cache
def _program() -> Path:
    """The server's program, looked after once."""
    return bus.built()


@contextmanager
def started(*words: str) -> Iterator[str]:
    """A bus server; the channel it is at."""
    with running("port=0", *words) as (server, channel):
        try:
            yield channel
        finally:
            server.terminate()
            assert server.wait(10) == 0


@contextmanager
def running(*words: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A bus server that whoever started it ends, and the channel it is at."""
    with subprocess.Popen([_program(), *words], stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        try:
            yield server, server.stdout.readline().split()[-1]
        finally:
            server.kill()


@contextmanager
def starter() -> Iterator[Start]:
    """A function that starts buses, which end together."""
    with ExitStack() as stack:
        yield lambda *words: stack.enter_context(started(*words))
