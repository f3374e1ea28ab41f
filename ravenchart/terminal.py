# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Output for people: tables in at most 80 columns, and progress while they wait.

Colour is for terminals alone. https://no-color.org holds: a `NO_COLOR` that is not empty means
no colour, and no other style. So does `TERM=dumb`. Progress goes to standard error, never to
standard output. A terminal shows it at once; elsewhere a line follows each time of silence.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, Thread
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

WIDTH = 80
"""Columns of what is printed."""

SILENCE = 1.8
"""After so long without a word there is a line of progress, in s."""

SHORTEST = 0.3
"""A stage that takes less, in s, has no line of its own."""

_said = [time.monotonic()]
"""When there was a line of progress at last; at first the start of the process."""

LINES = Event()
"""Set in a process of the command line alone: a caller in Python gets no lines of progress."""


def console(width: int | None = WIDTH, *, errors: bool = False) -> Console:
    """Standard output, or error, with styles only where a terminal shall show them."""
    from rich.console import Console

    class Ours(Console):
        """Leaves a broken pipe to `start`, where rich would end with status 1."""

        def on_broken_pipe(self) -> None:
            raise

    plain = bool(os.environ.get("NO_COLOR")) or os.environ.get("TERM") == "dumb"
    return Ours(width=width, highlight=False, stderr=errors, color_system=None if plain else "auto")


@contextmanager
def progress(text: str) -> Iterator[Callable[[str], None]]:
    """Say what is going on for the time of a block; the function changes the text."""
    sys.stdout.flush()
    if sys.stderr.isatty() and os.environ.get("TERM") != "dumb":
        with console(None, errors=True).status(text) as status:
            yield lambda changed: status.update(changed)
    elif LINES.is_set():
        with _lines(text) as change:
            yield change
    else:
        yield lambda _: None


@contextmanager
def stages(text: str) -> Iterator[Callable[[str], None]]:
    """The same, where the function says how far it is."""
    with progress(text) as change:
        yield lambda stage: change(f"{text}: {stage}")


@contextmanager
def _lines(text: str) -> Iterator[Callable[[str], None]]:
    """A line with the text and the seconds so far, each time that `SILENCE` has passed.

    It counts over the blocks of a command: a sequence of short ones is not silent either.
    """
    texts = [text]
    ended = Event()
    begun = time.monotonic()

    def tell() -> None:
        while not ended.wait(max(_said[0] + SILENCE - time.monotonic(), SHORTEST)):
            _said[0] = time.monotonic()
            print(f"{texts[-1]} ({_said[0] - begun:.0f} s)", file=sys.stderr, flush=True)

    teller = Thread(target=tell, daemon=True)
    teller.start()
    try:
        yield texts.append
    finally:
        ended.set()
        teller.join()
