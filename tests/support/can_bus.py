# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The bus server, for tests: built when it is first needed, and started on a free port."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager

from ravenchart.running.server import running

Start = Callable[..., str]
"""Starts a bus with such words beside the port; its channel."""


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
def starter() -> Iterator[Start]:
    """A function that starts buses, which end together."""
    with ExitStack() as stack:
        yield lambda *words: stack.enter_context(started(*words))
